"""The daemon's own work, with a daemon that only remembers; the real one is in tests/e2e."""

import logging
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.messages import CameraInfo, Message, ObjectPose, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS, AnyTopic
from inhand_tracker.body import skeleton as body
from inhand_tracker.loading import load_models, new_trackers
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.model.model import ModelError
from inhand_tracker.model.model_file import save_model
from inhand_tracker.people.watching import GivenObjects
from inhand_tracker.service import TrackerService
from inhand_tracker.settings import TrackerSettings
from people import FRAME_NS, unseen_wave, wave_model
from pydantic import ValidationError
from simulated_daemon import SimulatedDaemon

PUBLISHED = "gd-fallback"
FRAMES = 5
INFO_MESSAGE = CameraInfo(
    sequence=0, time_ns=0, width=64, height=48, fx=52.0, fy=52.0, cx=31.5, cy=23.5
)


Sent = tuple[AnyTopic, Message]


def rig(*messages: Sent) -> SimulatedDaemon:
    """A daemon to which frames come one after the other, each with all that is of it."""
    return SimulatedDaemon(
        *((message.sequence * FRAME_NS / 1e9, topic, message) for topic, message in messages)
    )


class Broken(ParticleTracker):
    """Fails on its second frame, and only then."""

    steps = 0

    def step(self, *arguments: object, **options: object) -> object:
        self.steps += 1
        if self.steps == 2:
            raise ZeroDivisionError("a bug")
        return super().step(*arguments, **options)


def tracker(kind: type[ParticleTracker] = ParticleTracker) -> ParticleTracker:
    return kind(wave_model(), VARIANTS[PUBLISHED])


def somebody(joints: np.ndarray) -> Person:
    return Person(
        id=4,
        joints=tuple(map(tuple, joints.tolist())),
        states=("tracked",) * 20,
        confidences=(1.0,) * 20,
    )


def skeletons() -> list[Sent]:
    return [
        (SKELETONS, Skeletons(sequence=n, time_ns=(n + 1) * FRAME_NS, people=(somebody(joints),)))
        for n, joints in enumerate(unseen_wave(FRAMES))
    ]


def run(daemon: SimulatedDaemon, trackers: dict[str, ParticleTracker], **settings: object) -> None:
    chosen = TrackerSettings(**settings)
    TrackerService(daemon, chosen, lambda: GivenObjects(trackers), daemon.clock).run()


def places(poses: Sequence[ObjectPose]) -> list[tuple[float, float, float]]:
    return [pose.camera_from_object.translation for pose in poses]


def test_each_object_is_tracked_on_its_own_key_as_if_it_were_alone() -> None:
    together, alone = rig(*skeletons()), rig(*skeletons())
    run(together, {"mug": tracker(), "pan": tracker()})
    run(alone, {"mug": tracker()})
    assert set(together.poses) == {"mug", "pan"}
    for name, poses in together.poses.items():
        assert [pose.object for pose in poses] == [name] * FRAMES
        assert [pose.sequence for pose in poses] == list(range(FRAMES))
        assert places(poses) == places(alone.poses["mug"])


def test_an_object_that_fails_is_lost_for_a_frame_and_stops_no_other(
    caplog: pytest.LogCaptureFixture,
) -> None:
    daemon = rig(*skeletons())
    with caplog.at_level(logging.ERROR):
        run(daemon, {"mug": tracker(Broken), "pan": tracker()})
    assert [pose.state for pose in daemon.poses["mug"]] == ["tracked", "lost", *["tracked"] * 3]
    assert [pose.state for pose in daemon.poses["pan"]] == ["tracked"] * FRAMES
    assert daemon.health.report().last_error == "cannot track mug: ZeroDivisionError: a bug"
    assert len(caplog.records) == 1


def test_a_failure_that_lasts_is_told_once(caplog: pytest.LogCaptureFixture) -> None:
    always = tracker()
    always.step = lambda *_: 1 / 0
    daemon = rig(*skeletons())
    with caplog.at_level(logging.ERROR):
        run(daemon, {"mug": always})
    assert [pose.state for pose in daemon.poses["mug"]] == ["lost"] * FRAMES
    assert len(caplog.records) == 1


def frames(**pixels: object) -> list[Sent]:
    return [
        (RGBD, RgbdFrame(sequence=n, time_ns=(n + 1) * FRAME_NS, **pixels)) for n in range(FRAMES)
    ]


def seen(monkeypatch: pytest.MonkeyPatch, **settings: object) -> list[tuple[bool, bool, bool]]:
    """Whether the trackers got luminance, depth and colour, per frame; pixels come first."""
    colour = encode_colour(np.full((48, 64, 3), 90, np.uint8))
    depth = encode_depth(np.full((48, 64), 2500, np.uint16))
    bodies, pixels = skeletons(), frames(colour=colour, depth=depth)
    both = [message for pair in zip(pixels, bodies, strict=True) for message in pair]
    images = []
    step = ParticleTracker.step
    monkeypatch.setattr(
        ParticleTracker,
        "step",
        lambda self, j, t, image: images.append(image) or step(self, j, t, image),
    )
    run(rig((INFO, INFO_MESSAGE), *both), {"mug": tracker(), "pan": tracker()}, **settings)
    assert images[::2] == images[1::2]
    assert all(first is second for first, second in zip(images[::2], images[1::2], strict=True))
    return [
        (
            image is not None and image.grey is not None,
            image is not None and image.depth is not None,
            image is not None and image.colour is not None,
        )
        for image in images[::2]
    ]


@pytest.mark.parametrize(
    ("method", "likelihood", "expected"),
    [
        (PUBLISHED, None, (True, False, False)),
        (PUBLISHED, ("edges",), (True, False, False)),
        (PUBLISHED, ("depth",), (False, True, False)),
        (PUBLISHED, ("edges", "depth"), (True, True, False)),
        (PUBLISHED, (), (False, False, False)),
        ("fusion", None, (False, True, True)),
        ("fusion", ("region",), (False, True, True)),
        ("fusion", (), (False, False, False)),
    ],
)
def test_pixels_are_decoded_once_a_frame_and_only_those_that_weigh(
    monkeypatch: pytest.MonkeyPatch,
    method: str,
    likelihood: tuple[str, ...] | None,
    expected: tuple[bool, bool, bool],
) -> None:
    assert seen(monkeypatch, method=method, likelihood=likelihood) == [expected] * FRAMES


def test_pixels_are_not_asked_for_when_none_weigh() -> None:
    blind, seeing = rig(), rig()
    run(blind, {"mug": tracker()}, likelihood=())
    run(seeing, {"mug": tracker()})
    assert RGBD not in blind.subscribed
    assert RGBD in seeing.subscribed


# --- Settings


def load_trackers(settings: TrackerSettings) -> dict[str, ObjectTracker]:
    return new_trackers(load_models("mug", settings), settings)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "wave.model"
    save_model(wave_model(), path)
    return path


def test_one_model_or_a_list_of_them(model: Path) -> None:
    for settings in (TrackerSettings(model=model), TrackerSettings(models=(model,))):
        assert list(load_trackers(settings)) == ["wedge"]


@pytest.mark.parametrize(
    ("named", "line"),
    [
        ({}, r"\[tracker.mug\] names no model: write model = "),
        ({"model": 1, "models": 1}, r"\[tracker.mug\] has model and models"),
        ({"models": 2}, r"\[tracker.mug\] has two models of 'wedge'"),
    ],
)
def test_models_that_cannot_be_meant_are_refused(
    model: Path, named: dict[str, int], line: str
) -> None:
    values = {k: model if k == "model" else (model,) * count for k, count in named.items()}
    with pytest.raises(SettingsError, match=line):
        load_trackers(TrackerSettings(**values))


def test_only_terms_that_there_are_can_weigh() -> None:
    with pytest.raises(ValidationError, match="'edges', 'region', 'interior' or 'depth'"):
        TrackerSettings(likelihood=("colour",))


def test_a_term_that_the_method_does_not_know_is_refused(model: Path) -> None:
    settings = TrackerSettings(model=model, method=PUBLISHED, likelihood=("depth", "region"))
    with pytest.raises(SettingsError, match="gd-fallback does not weigh 'region'; it knows: edges"):
        load_trackers(settings)


def test_a_model_that_learned_no_prior_is_refused_for_the_default_method(tmp_path: Path) -> None:
    old = replace(wave_model(), prior=None)
    save_model(old, tmp_path / "old.model")
    with pytest.raises(ModelError, match=r"wedge is of an older release .* train it again"):
        load_trackers(TrackerSettings(model=tmp_path / "old.model"))
    settings = TrackerSettings(model=tmp_path / "old.model", method=PUBLISHED)
    assert list(load_trackers(settings)) == ["wedge"]


def test_a_left_handed_person_is_a_setting(model: Path) -> None:
    """The mirror image of a right-handed person's skeleton gives the mirrored place."""
    places = []
    for left in (False, True):
        (one,) = load_trackers(TrackerSettings(model=model, left_handed=left)).values()
        joints = unseen_wave(1)[0]
        estimate = one.step(body.mirror_joints(joints) if left else joints, FRAME_NS)
        places.append(estimate.translation)
    np.testing.assert_allclose(places[1], places[0] * [-1.0, 1.0, 1.0], atol=1e-9)
