"""What a rig's cameras capture of a moment becomes one frame, by places that are learned."""

import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image, OtherView, ViewPull
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.rig.placing import PlaceDeviation
from inhand_tracker.rig.rig_frames import Capture, RigFrame, RigFrames
from people import FRAME_NS
from rig_people import MIDDLE, PLACES, person_seen, standing_at

CAMERA = Intrinsics(50.0, 50.0, 15.5, 15.5, 32, 32)
LOW = np.array([0.0, 0.02, 0.0])
"""Metres by which the left camera is lower than it is said to be."""
SURE = np.diag([1e4] * 3 + [1e2] * 3)


def frames(deviation: PlaceDeviation | None = None) -> RigFrames:
    rig = RigFrames(PLACES)
    for camera, place in PLACES.items():
        rig.place(camera, place, deviation)
    return rig


def joined(rig: RigFrames, number: int, seen: np.ndarray | None = None) -> RigFrame:
    """A frame of the rig before a person, whom the left camera has higher than they are."""
    captures = []
    for camera, place in PLACES.items():
        joints = standing_at(0.0) - (LOW if camera == "left" else 0.0)
        people = [] if seen is None else [person_seen(joints, place)]
        picture = Image(None, CAMERA, np.ones((32, 32), np.float32))
        captures.append(Capture(camera, (number + 1) * FRAME_NS, people, picture))
    return rig.join(captures)


def left_of(frame: RigFrame) -> OtherView:
    assert frame.image is not None
    return next(one for one in frame.image.others if one.image.source == "left")


def tell(frame: RigFrame, off: np.ndarray) -> None:
    """Say what trackers do of something that the left camera has elsewhere than the others."""
    assert frame.image is not None
    assert frame.image.on_pulls is not None
    found = left_of(frame).view_from_reference.inverse()
    said = PLACES["left"]
    seen = said.inverse().points(MIDDLE - off)
    ways = {"front": np.zeros(3), "left": found.points(seen) - MIDDLE, "right": np.zeros(3)}
    frame.image.on_pulls(
        [
            ViewPull(camera, MIDDLE, np.concatenate((way, np.zeros(3))), SURE)
            for camera, way in ways.items()
        ]
    )


def test_a_camera_is_looked_by_from_where_objects_show_it_to_be() -> None:
    rig = frames(PlaceDeviation(0.01, 0.005))
    before = left_of(joined(rig, 0))
    for number in range(1, 60):
        tell(joined(rig, number), LOW)
    after = left_of(joined(rig, 60))
    seen = PLACES["left"].inverse().points(MIDDLE - LOW)
    assert after.view_from_reference.inverse().points(seen) == pytest.approx(MIDDLE, abs=0.003)
    assert after.place_covariance is not None
    assert before.place_covariance is not None
    assert np.trace(after.place_covariance) < np.trace(before.place_covariance)
    assert rig.rig_from("front").translation == pytest.approx(PLACES["front"].translation)
    assert not rig.misplaced


def test_people_who_stand_aside_in_one_camera_show_where_it_is_too() -> None:
    rig = frames(PlaceDeviation(0.01, 0.005))
    for number in range(30):
        (person,) = joined(rig, number, MIDDLE).people
    off = rig.rig_from("left").points(PLACES["left"].inverse().points(MIDDLE)) - MIDDLE
    assert 0.5 * LOW[1] < off[1] < LOW[1]
    assert np.abs(person.joints - standing_at(0.0)).max() < 0.5 * LOW[1]


def test_what_a_calibration_does_not_allow_is_told() -> None:
    rig = frames(PlaceDeviation(0.001, 0.0005))
    for number in range(60):
        tell(joined(rig, number), 3.0 * LOW)
    assert list(rig.misplaced) == ["left"]
    assert 0.02 < rig.misplaced["left"] < 0.07
    moved = Placement(PLACES["left"].translation + 3.0 * LOW, PLACES["left"].rotation)
    rig.place("left", moved, PlaceDeviation(0.001, 0.0005))
    assert not rig.misplaced
    assert rig.rig_from("left").translation == pytest.approx(moved.translation)
