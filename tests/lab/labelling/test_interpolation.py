"""Poses between keyframes."""

import numpy as np
import pytest
from inhand_lab.labelling.body_parts import filled, part_of
from inhand_lab.labelling.interpolation import Interpolated, interpolate
from inhand_lab.labelling.keyframes import Keyframe
from inhand_schemas.messages import Pose
from inhand_tracker.body.anchors import ANCHORS
from inhand_tracker.geometry import rotations
from inhand_tracker.shape.shape import Symmetry
from keyframed import FRAMES, key, pose
from waving import FRAME_NS, START_NS, waving

TIMES = START_NS + FRAME_NS * np.arange(FRAMES)
JOINTS, PLACES, TURNS = waving(FRAMES, 0)
QUARTER = Pose((0.0, 0.0, 2.0), (float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5))))
WRIST = 10


def found(*keyframes: Keyframe, times: np.ndarray = TIMES, **others: object) -> Interpolated:
    joints = others.pop("joints", JOINTS)
    return interpolate(keyframes, times, joints, **others)  # type: ignore[arg-type]


def labelled(result: Interpolated) -> list[int]:
    return np.flatnonzero(np.isfinite(result.translations[:, 0])).tolist()


def test_an_object_moves_and_turns_evenly_from_one_keyframe_to_the_next() -> None:
    turned = Pose((0.3, 0.0, 2.0), QUARTER.rotation)
    result = found(key(10, pose()), key(20, turned))
    assert labelled(result) == list(range(10, 21))
    np.testing.assert_allclose(result.translations[13], [0.09, 0.0, 2.0])
    angle = rotations.angle_between(result.rotations[13], np.array([1.0, 0.0, 0.0, 0.0]))
    assert np.rad2deg(angle) == pytest.approx(27.0)


def test_it_turns_the_shorter_way_whatever_the_signs_of_quaternions() -> None:
    minus = Pose((0.0, 0.0, 2.0), tuple(-one for one in QUARTER.rotation))  # type: ignore[arg-type]
    turns = [found(key(0, pose()), key(30, end)).rotations[15] for end in (QUARTER, minus)]
    assert float(rotations.angle_between(*turns)) < 1e-6


def test_the_way_is_by_time_not_by_frames() -> None:
    times = TIMES.copy()
    times[6:] += 4 * FRAME_NS  # four frames were lost
    keyframes = [
        Keyframe(frame=frame, time_ns=int(times[frame]), camera_from_object=pose(x=x))
        for frame, x in ((0, 0.0), (10, 1.4))
    ]
    result = found(*keyframes, times=times)
    np.testing.assert_allclose(result.translations[[5, 6], 0], [0.5, 1.0], atol=1e-6)


def test_relative_to_a_body_part_the_object_moves_with_it() -> None:
    ends = [Pose(tuple(PLACES[frame].tolist()), tuple(TURNS[frame].tolist())) for frame in (0, 12)]
    errors = {}
    for part in (None, "right forearm"):
        result = found(key(0, ends[0], relative_to=part), key(12, ends[1]))
        errors[part] = np.linalg.norm(result.translations[:13] - PLACES[:13], axis=1).max()
        np.testing.assert_allclose(result.translations[[0, 12]], PLACES[[0, 12]], atol=1e-9)
    assert errors["right forearm"] < 0.02 < 0.04 < errors[None]


def test_a_part_that_is_missing_between_keyframes_is_taken_from_the_frames_around() -> None:
    joints = JOINTS.copy()
    joints[4:6, WRIST] = np.nan
    ends = key(0, pose(), relative_to="right forearm"), key(10, pose())
    whole, gap = found(*ends), found(*ends, joints=joints)
    assert labelled(gap) == list(range(11))
    assert gap.notes == ()
    assert np.linalg.norm(whole.translations[4] - gap.translations[4]) < 0.05


def test_a_part_that_is_missing_at_a_keyframe_is_said() -> None:
    joints = JOINTS.copy()
    joints[10, WRIST] = np.nan
    ends = key(0, pose(), relative_to="right forearm"), key(10, pose(x=0.2))
    result = found(*ends, joints=joints)
    (note,) = result.notes
    assert note.startswith("frames 0 to 10 are interpolated in the camera's frame: the right for")
    np.testing.assert_allclose(result.translations, found(key(0, pose()), ends[1]).translations)


@pytest.mark.parametrize("part", ANCHORS)
def test_a_part_without_its_joints_is_missing(part: str) -> None:
    joints = JOINTS.copy()
    joints[3] = np.nan
    basis = part_of(joints, part)
    assert np.flatnonzero(np.isnan(basis.origins[:, 0])).tolist() == [3]
    assert np.isfinite(filled(basis, TIMES).rotations).all()


def test_the_pose_that_looks_the_same_and_is_nearest_is_taken() -> None:
    axis = Symmetry((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 0)
    result = found(key(0, pose()), key(10, QUARTER), key(20, pose()), symmetries=(axis,))
    angles = rotations.angle_between(result.rotations[:21], np.array([1.0, 0.0, 0.0, 0.0]))
    assert angles.max() < 1e-6


def test_frames_before_the_first_keyframe_and_after_the_last_get_nothing() -> None:
    result = found(key(5, pose()), key(9, pose()))
    assert labelled(result) == [5, 6, 7, 8, 9]
    assert not result.absent.any()


def test_one_keyframe_labels_its_own_frame() -> None:
    assert labelled(found(key(7, pose()))) == [7]


def test_no_keyframe_labels_nothing() -> None:
    assert labelled(found()) == []


def test_between_two_keyframes_that_say_so_the_object_is_absent() -> None:
    marks = key(0, pose()), key(5, pose()), key(8, None), key(12, None), key(15, pose())
    result = found(*marks)
    assert labelled(result) == [*range(6), 15]
    assert np.flatnonzero(result.absent).tolist() == [8, 9, 10, 11, 12]


def test_a_lone_absence_is_of_its_own_frame() -> None:
    result = found(key(5, pose()), key(8, None), key(12, pose()))
    assert labelled(result) == [5, 12]
    assert np.flatnonzero(result.absent).tolist() == [8]


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (10**9, "1.0 s are missing before frame 6; put a keyframe on either side of the gap"),
        (-(10**8), "time stands still or runs backwards at frame 6; put a keyframe"),
    ],
    ids=["gap", "backwards"],
)
def test_across_a_break_in_time_nothing_is_known(change: int, line: str) -> None:
    times = TIMES.copy()
    times[6:] += change
    result = found(key(0, pose()), key(10, pose()), times=times)
    assert labelled(result) == [0, 10]
    (note,) = result.notes
    assert note.startswith("frames 1 to 9 get no label: ")
    assert line in note
    beside = found(*(key(frame, pose()) for frame in (0, 5, 6, 10)), times=times)
    assert labelled(beside) == list(range(11))
    assert [(one.first, one.last) for one in beside.stretches] == [(0, 5), (6, 10)]
    assert beside.notes == ()
