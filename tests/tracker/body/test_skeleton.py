from itertools import pairwise

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from hypothesis.extra.numpy import arrays
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body import skeleton as body
from people import (
    KINECT_TREE,
    STANDING,
    STANDING_HEIGHT,
    move,
    quaternion_of,
    same_rotation,
    scipy_rotation,
    waving,
)
from scipy.spatial.transform import Rotation

rotation_vectors = arrays(float, 3, elements=st.floats(-1.7, 1.7))
shifts = arrays(float, 3, elements=st.floats(-5, 5))


def bases_of(joints: np.ndarray) -> tuple[body.Bases, body.Bases]:
    pelvis = body.pelvis_basis(joints)
    return pelvis, body.part_bases(joints, pelvis)


def matrix(bases: body.Bases) -> np.ndarray:
    return scipy_rotation(bases.rotations).as_matrix()


def test_the_parts_are_every_joint_but_the_first_with_its_parent() -> None:
    assert list(zip(body.PARENT_JOINTS, body.CHILD_JOINTS, strict=True)) == KINECT_TREE
    assert body.PARTS[body.RIGHT_HAND] == "HandRight"
    assert body.PARTS[body.LEFT_HAND] == "HandLeft"


def test_the_pelvis_of_someone_who_faces_the_camera() -> None:
    pelvis = body.pelvis_basis(STANDING)
    # x to the person's left (+x), y up (-y), z out of the belly (towards the camera, -z).
    np.testing.assert_allclose(matrix(pelvis), np.diag([1.0, -1.0, -1.0]), atol=1e-12)
    np.testing.assert_array_equal(pelvis.origins, [0.0, 0.0, 2.5])


@given(st.integers(0, 10_000))
def test_the_pelvis_basis_is_the_one_of_the_paper(seed: int) -> None:
    joints = STANDING + 0.05 * np.random.default_rng(seed).normal(size=(20, 3))
    axes = matrix(body.pelvis_basis(joints))
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    x = joints[12] - joints[16]
    z = np.cross(x, joints[1] - joints[0])
    y = np.cross(z, x)
    for column, axis in enumerate((x, y, z)):
        np.testing.assert_allclose(axes[:, column], axis / np.linalg.norm(axis), atol=1e-9)


def rodrigues(pelvis: np.ndarray, along: np.ndarray) -> np.ndarray:
    """H_l by the spec's words: turn about z × λ by θ = acos(λ̂·ẑ)."""
    z = pelvis[:, 2]
    unit = along / np.linalg.norm(along)
    axis = np.cross(z, unit)
    angle = np.arccos(np.clip(z @ unit, -1, 1))
    return Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix() @ pelvis


@given(st.integers(0, 10_000), rotation_vectors)
def test_part_predictors_are_the_pelvis_turned_by_the_shortest_way_along_the_part(
    seed: int, turn: np.ndarray
) -> None:
    joints = STANDING + 0.05 * np.random.default_rng(seed).normal(size=(20, 3))
    joints = move(Rotation.from_rotvec(turn), np.zeros(3), joints)
    pelvis, parts = bases_of(joints)
    assert parts.origins.shape == (19, 3)
    for part, (parent, child) in enumerate(KINECT_TREE):
        np.testing.assert_array_equal(parts.origins[part], joints[parent])
        along = joints[child] - joints[parent]
        axes = matrix(parts)[part]
        np.testing.assert_allclose(axes[:, 2], along / np.linalg.norm(along), atol=1e-9)
        np.testing.assert_allclose(axes, rodrigues(matrix(pelvis), along), atol=1e-6)


def with_forearm(direction: np.ndarray) -> np.ndarray:
    """The standing person with the right hand's part along a direction, 8 cm long or less."""
    joints = STANDING.copy()
    joints[11] = joints[10] + 0.08 * direction
    return joints


def hand_basis(direction: np.ndarray) -> np.ndarray:
    return matrix(bases_of(with_forearm(direction))[1])[body.RIGHT_HAND]


FORWARDS = np.array([0.0, 0.0, -1.0])  # the pelvis' z axis, in the camera frame
AROUND = [(np.cos(a), np.sin(a), 0.0) for a in np.linspace(0, 2 * np.pi, 9)]


def test_a_part_along_the_pelvis_z_axis_keeps_the_pelvis_directions() -> None:
    np.testing.assert_allclose(hand_basis(FORWARDS), np.diag([1.0, -1.0, -1.0]), atol=1e-12)


@pytest.mark.parametrize("tilt", [1e-3, 1e-6, 1e-9, 1e-12])
def test_parts_that_nearly_point_forwards_change_smoothly(tilt: float) -> None:
    for aside in AROUND:
        axes = hand_basis(FORWARDS + tilt * np.array(aside))
        np.testing.assert_allclose(axes, np.diag([1.0, -1.0, -1.0]), atol=2 * tilt + 1e-9)


@pytest.mark.parametrize("tilt", [1e-1, 1e-3, 1e-5, 1e-8, 1e-10, 1e-12, 0.0])
def test_parts_that_nearly_point_backwards_have_a_proper_basis(tilt: float) -> None:
    for aside in AROUND:
        direction = -FORWARDS + tilt * np.array(aside)
        axes = hand_basis(direction)
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-9)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        np.testing.assert_allclose(axes[:, 2], direction / np.linalg.norm(direction), atol=1e-6)


@pytest.mark.parametrize("aside", AROUND)
def test_predictors_turn_evenly_as_a_part_swings_from_front_to_back(
    aside: tuple[float, float, float],
) -> None:
    angles = np.linspace(0.0, np.pi - 1e-4, 200)
    swing = [
        Rotation.from_matrix(hand_basis(np.cos(a) * FORWARDS + np.sin(a) * np.array(aside)))
        for a in angles
    ]
    steps = [(a.inv() * b).magnitude() for a, b in pairwise(swing)]
    np.testing.assert_allclose(steps, angles[1] - angles[0], rtol=1e-3)


def test_a_part_of_no_length_keeps_the_pelvis_directions() -> None:
    np.testing.assert_allclose(hand_basis(np.zeros(3)), np.diag([1.0, -1.0, -1.0]), atol=1e-12)


def test_a_missing_joint_spoils_only_the_parts_that_it_ends() -> None:
    joints = STANDING.copy()
    joints[10] = np.nan
    _, parts = bases_of(joints)
    broken = [index for index, ends in enumerate(KINECT_TREE) if 10 in ends]
    spoilt = ~np.isfinite(parts.rotations).all(axis=1)
    assert np.flatnonzero(spoilt).tolist() == broken


def test_a_basis_takes_poses_to_the_camera_and_back() -> None:
    random = np.random.default_rng(1)
    turns = Rotation.from_rotvec(random.normal(size=(4, 3)))
    inner = Rotation.from_rotvec(random.normal(size=(4, 3)))
    origins, shifted = random.normal(size=(2, 4, 3))
    bases = body.Bases(origins, quaternion_of(turns))
    translations, orientations = bases.to_camera(shifted, quaternion_of(inner))
    np.testing.assert_allclose(translations, origins + turns.apply(shifted), atol=1e-12)
    assert same_rotation(orientations, quaternion_of(turns * inner))
    back, back_turned = bases.from_camera(translations, orientations)
    np.testing.assert_allclose(back, shifted, atol=1e-12)
    assert same_rotation(back_turned, quaternion_of(inner))


def pose_of(joints: np.ndarray, height: float) -> np.ndarray:
    return body.body_pose(joints, body.pelvis_basis(joints), height)


def test_the_body_pose_is_the_joints_in_the_pelvis_basis_in_body_heights() -> None:
    expected = (STANDING - [0.0, 0.0, 2.5]) * [1.0, -1.0, -1.0] / 1.6
    np.testing.assert_allclose(pose_of(STANDING, 1.6).reshape(20, 3), expected, atol=1e-12)


@given(rotation_vectors, shifts)
def test_the_body_pose_does_not_change_when_the_scene_moves(
    turn: np.ndarray, shift: np.ndarray
) -> None:
    moved = move(Rotation.from_rotvec(turn), shift, STANDING)
    np.testing.assert_allclose(pose_of(moved, 1.7), pose_of(STANDING, 1.7), atol=1e-9)


@given(st.floats(0.3, 3.0))
def test_the_body_pose_does_not_change_with_the_persons_size(scale: float) -> None:
    grown = scale * STANDING
    height = body.stature(body.part_lengths(grown))
    own = body.stature(body.part_lengths(STANDING))
    assert height == pytest.approx(scale * own)
    np.testing.assert_allclose(pose_of(grown, height), pose_of(STANDING, own), atol=1e-9)


def test_body_poses_of_many_frames_are_those_of_each() -> None:
    joints = waving(5)
    heights = np.linspace(1.5, 1.9, 5)
    many = body.body_pose(joints, body.pelvis_basis(joints), heights)
    for frame in range(5):
        np.testing.assert_allclose(many[frame], pose_of(joints[frame], heights[frame]), atol=1e-12)


def test_part_lengths_are_the_distances_of_their_ends() -> None:
    lengths = body.part_lengths(STANDING)
    for part, (parent, child) in enumerate(KINECT_TREE):
        assert lengths[part] == pytest.approx(np.linalg.norm(STANDING[child] - STANDING[parent]))


def test_standing_height_of_a_known_person() -> None:
    height = body.stature(body.part_lengths(STANDING))
    assert height == pytest.approx(STANDING_HEIGHT)


def bent() -> np.ndarray:
    """The person with the trunk bent forwards by 80° and both knees by 90°."""
    joints = STANDING.copy()
    fold = Rotation.from_euler("x", 80, degrees=True)
    joints[1:12] = joints[0] + fold.apply(joints[1:12] - joints[0])
    shin = Rotation.from_euler("x", -90, degrees=True)
    for knee in (13, 17):
        joints[knee + 1 : knee + 3] = joints[knee] + shin.apply(
            joints[knee + 1 : knee + 3] - joints[knee]
        )
    return joints


def test_a_person_who_bends_does_not_shrink() -> None:
    assert np.ptp(bent()[:, 1]) < 0.75 * np.ptp(STANDING[:, 1])
    assert body.stature(body.part_lengths(bent())) == pytest.approx(STANDING_HEIGHT)
    running = body.RunningHeight()
    for _ in range(5):
        running.update(STANDING)
    for _ in range(50):
        assert running.update(bent()) == pytest.approx(STANDING_HEIGHT)


def test_wild_frames_do_not_change_the_height() -> None:
    random = np.random.default_rng(2)
    running = body.RunningHeight()
    for frame in range(100):
        joints = STANDING + 0.001 * random.normal(size=(20, 3))
        if frame % 3 == 2:
            joints = joints + random.normal(size=(20, 3))
        height = running.update(joints)
    assert height == pytest.approx(STANDING_HEIGHT, rel=0.005)


def test_the_running_height_follows_the_last_frames_only() -> None:
    running = body.RunningHeight()
    for _ in range(300):
        running.update(STANDING)
    for _ in range(300):
        height = running.update(0.5 * STANDING)
    assert height == pytest.approx(0.5 * STANDING_HEIGHT)


def without(*names: str) -> np.ndarray:
    joints = STANDING.copy()
    joints[[JOINT_NAMES.index(name) for name in names]] = np.nan
    return joints


LEFT_LEG = ("HipLeft", "KneeLeft", "AnkleLeft", "FootLeft")
RIGHT_LEG = ("HipRight", "KneeRight", "AnkleRight", "FootRight")


@pytest.mark.parametrize("unseen", [LEFT_LEG, RIGHT_LEG, ("AnkleLeft",), ("FootLeft", "FootRight")])
def test_one_leg_counts_for_both(unseen: tuple[str, ...]) -> None:
    height = body.stature(body.part_lengths(without(*unseen)))
    assert height == pytest.approx(STANDING_HEIGHT)


def test_both_legs_count_by_their_mean() -> None:
    joints = STANDING.copy()
    joints[14:16, 1] += 0.10  # the left shin is 10 cm longer
    height = body.stature(body.part_lengths(joints))
    assert height == pytest.approx(STANDING_HEIGHT + 0.05 / 0.896)


def test_the_trunk_does_where_no_leg_was_seen() -> None:
    height = body.stature(body.part_lengths(without(*LEFT_LEG, *RIGHT_LEG)))
    assert height == pytest.approx(0.728 / 0.405)


def test_legs_that_were_seen_once_stay_known() -> None:
    running = body.RunningHeight()
    running.update(STANDING)
    assert running.update(without(*LEFT_LEG, *RIGHT_LEG)) == pytest.approx(STANDING_HEIGHT)


def test_without_a_trunk_the_height_is_unknown() -> None:
    assert np.isnan(body.stature(body.part_lengths(without("Head"))))
    assert np.isnan(body.stature(body.typical_lengths(np.full((3, 19), np.nan))))
    running = body.RunningHeight()
    assert np.isnan(running.update(without("Head")))
    assert running.update(STANDING) == pytest.approx(STANDING_HEIGHT)


def test_a_pelvis_needs_its_four_joints_apart_and_not_in_a_line() -> None:
    assert body.has_pelvis(STANDING)
    assert body.has_pelvis(without("Head", "HandLeft"))
    for name in ("HipCenter", "Spine", "HipLeft", "HipRight"):
        assert not body.has_pelvis(without(name))
    assert not body.has_pelvis(np.zeros((20, 3)))
    in_a_line = STANDING.copy()
    in_a_line[1] = in_a_line[0] + [0.2, 0.0, 0.0]
    assert not body.has_pelvis(in_a_line)


mirrors = np.diag([-1.0, 1.0, 1.0])


def test_a_mirror_shows_the_left_hand_as_the_right_one() -> None:
    mirrored = body.mirror_joints(STANDING)
    for index, name in enumerate(JOINT_NAMES):
        other = name.replace("Left", "@").replace("Right", "Left").replace("@", "Right")
        expected = STANDING[JOINT_NAMES.index(other)] * [-1.0, 1.0, 1.0]
        np.testing.assert_array_equal(mirrored[index], expected)


@given(arrays(float, (3, 20, 3), elements=st.floats(-10, 10)))
def test_mirroring_joints_twice_changes_nothing(joints: np.ndarray) -> None:
    np.testing.assert_array_equal(body.mirror_joints(body.mirror_joints(joints)), joints)


@given(rotation_vectors, shifts, rotation_vectors)
def test_mirroring_a_pose_twice_changes_nothing(
    turn: np.ndarray, shift: np.ndarray, towards: np.ndarray
) -> None:
    quaternion = quaternion_of(Rotation.from_rotvec(turn))
    normal = Rotation.from_rotvec(towards).apply([0.0, 0.0, 1.0])
    once = body.mirror_pose(shift, quaternion, normal)
    translation, rotation = body.mirror_pose(*once, normal)
    np.testing.assert_allclose(translation, shift, atol=1e-12)
    assert same_rotation(rotation, quaternion)


@given(rotation_vectors, shifts, rotation_vectors, st.integers(0, 100))
def test_the_mirrored_pose_places_a_symmetric_object_where_the_mirror_shows_it(
    turn: np.ndarray, shift: np.ndarray, towards: np.ndarray, seed: int
) -> None:
    normal = Rotation.from_rotvec(towards).apply([0.0, 0.0, 1.0])
    half = np.random.default_rng(seed).normal(size=(5, 3))
    other_half = half - 2 * np.outer(half @ normal, normal)
    placed = Rotation.from_rotvec(turn).apply(half) + shift
    translation, rotation = body.mirror_pose(
        shift, quaternion_of(Rotation.from_rotvec(turn)), normal
    )
    shown = scipy_rotation(rotation).apply(other_half) + translation
    np.testing.assert_allclose(shown, placed @ mirrors, atol=1e-9)


def test_the_mirrored_body_has_the_same_pose_with_its_sides_exchanged() -> None:
    pose = pose_of(STANDING, 1.7).reshape(20, 3)
    mirrored = pose_of(body.mirror_joints(STANDING), 1.7).reshape(20, 3)
    np.testing.assert_allclose(mirrored, body.mirror_joints(pose), atol=1e-12)
