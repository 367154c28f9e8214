"""Keyframes are on the disk at once, and one tab or studio alone writes them."""

import multiprocessing
import os
import signal
import sys
from pathlib import Path

import pytest
from inhand_lab.labelling.keyframes import LabellingError, load_keyframes
from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.autosave import KeptKeyframes, keyframes_path
from inhand_studio.labelling_page.claim import claim, lock_path
from inhand_studio.labelling_page.editing import Editing
from keyframed import file_of, key, pose


def _kept(folder: Path) -> KeptKeyframes:
    return KeptKeyframes(keyframes_path(folder / "wave.mcap", "box"), file_of())


def _edited(kept: KeptKeyframes, frame: int) -> Editing:
    return kept.save(edits.with_keyframe(kept.load(), key(frame, pose(0.1 * frame))))


def test_each_change_is_on_the_disk_at_once_and_is_opened_again(tmp_path: Path) -> None:
    kept = _kept(tmp_path)
    first = _edited(kept, 3)
    assert not first.unsaved
    assert load_keyframes(kept.path).keyframes == first.keyframes
    kept.close()
    assert _kept(tmp_path).load().keyframes == first.keyframes


def test_the_second_is_read_only_until_it_takes_over_and_then_the_first_is(tmp_path: Path) -> None:
    first, second = _kept(tmp_path), _kept(tmp_path)
    assert (first.claimed, second.claimed) == (True, False)
    _edited(first, 1)
    with pytest.raises(LabellingError, match="take over first"):
        _edited(second, 2)
    second.take_over()
    assert (first.claimed, second.claimed) == (False, True)
    with pytest.raises(LabellingError, match="has taken over"):
        _edited(first, 3)
    assert [one.frame for one in _edited(second, 2).keyframes] == [1, 2]
    first.close()
    assert second.claimed
    second.close()
    assert not lock_path(second.path).exists()
    assert _kept(tmp_path).claimed


def _claim_and_wait(path: Path, ready: "multiprocessing.synchronize.Event") -> None:
    kept = claim(path)
    assert kept is not None
    ready.set()
    signal.pause()


def test_who_is_killed_leaves_no_claim(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    path = tmp_path / "keyframes.json"
    other = context.Process(target=_claim_and_wait, args=(path, ready))
    other.start()
    assert ready.wait(60)
    assert claim(path) is None
    assert other.pid is not None
    os.kill(other.pid, signal.SIGKILL)
    other.join()
    mine = claim(path)
    assert mine is not None
    assert mine.mine


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux's")
def test_a_full_disk_is_reported_and_what_was_done_is_written_when_there_is_room(
    tmp_path: Path,
) -> None:
    kept = _kept(tmp_path)
    part = kept.path.with_name(kept.path.name + ".part")
    part.symlink_to("/dev/full")
    editing = _edited(kept, 3)
    assert editing.unsaved
    assert kept.trouble is not None
    assert "No space left" in kept.trouble
    # What could not be written took the symbolic link away: there is room again.
    again = kept.save(editing)
    assert kept.trouble is None
    assert load_keyframes(kept.path).keyframes == again.keyframes == editing.keyframes


def test_keyframes_of_another_camera_are_refused(tmp_path: Path) -> None:
    kept = _kept(tmp_path)
    _edited(kept, 1)
    kept.close()
    other = KeptKeyframes(kept.path, file_of(camera="other"))
    with pytest.raises(LabellingError, match="in camera camera, and not of box in other"):
        other.load()
