"""Which keys patterns choose."""

from pathlib import Path

import pytest
from inhand_recorder.topic_patterns import Chosen, checked_patterns
from inhand_schemas.keys import Site
from inhand_schemas.topics import INFO, POSE, RGBD, TOPICS
from running_recorder import frames_in, numbers, recordings, start_recorder
from running_rig import RunningRig, eventually


def test_a_key_is_chosen_that_a_pattern_matches_and_none_excludes() -> None:
    chosen = Chosen(("rgbd/front_*", "pose", "inf*/*_left"), ("*/front_door",))
    site = Site()
    assert chosen.holds(RGBD.key(site, "front_left"))
    assert not chosen.holds(RGBD.key(site, "back_left"))
    assert not chosen.holds(RGBD.key(site, "front_door"))
    assert chosen.holds(POSE.key(site, "mug"))
    assert chosen.holds(INFO.key(site, "back_left"))
    assert not chosen.holds("something/else")


def test_only_what_is_chosen_is_asked_for_and_nothing_twice() -> None:
    chosen = Chosen(("rgbd/front", "rgbd/back", "pose/m*", "pose/mug", "info", "label"), ("label",))
    assert chosen.subscriptions() == {RGBD: ("back", "front"), POSE: (None,), INFO: (None,)}
    assert set(Chosen(("*",)).subscriptions()) == set(TOPICS.values())


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        ("poses", r"no stream 'poses' \(did you mean pose\?\)"),
        ("rgdb/*", r"no stream 'rgdb' \(did you mean rgbd\?\)"),
        ("x*", r"no stream 'x\*' \(there are: "),
        ("[rp]gbd", "no stream"),
        ("rgbd/Front", r"no name is like 'Front'.*did you mean front\?"),
        ("rgbd/a/b", r"no name is like 'a/b'.*did you mean a_b\?"),
        ("rgbd/", "no name is like ''"),
        ("pose/" + 65 * "a", "64 letters at the most"),
    ],
)
def test_a_pattern_that_can_match_nothing_is_told_with_what_was_meant(
    pattern: str, words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        checked_patterns((pattern,))


@pytest.mark.long
def test_what_is_excluded_is_neither_recorded_nor_counted(rig: RunningRig) -> None:
    recorder = start_recorder(rig, 'streams = ["rgbd/fr*", "pose", "info"]\nexclude = ["*/m*"]')
    rig.publisher("--frames", "20")
    eventually("20 frames on the disk", lambda: frames_in(rig) == 20)
    health = rig.health("disk")
    assert not any("/pose/" in key for key in health["topics"])
    assert recorder.stop() == 0
    paths: list[Path] = recordings(rig)
    assert numbers(paths, POSE.key(Site(), "mug")) == []
    assert numbers(paths, INFO.key(Site(), "front")) == [0]
