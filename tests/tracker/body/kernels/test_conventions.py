"""Measures of conventions, and joints moved by them, against plain definitions."""

import numpy as np
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.convention_map import measure_bodies, move_joints
from inhand_tracker.body.convention_table import MEASURES, STAY
from people import STANDING

HEIGHT = 1.7


def place(joints: np.ndarray, name: str) -> np.ndarray:
    """A joint, or the middle of a pair."""
    if name in JOINT_NAMES:
        return joints[JOINT_NAMES.index(name)]
    return 0.5 * (place(joints, f"{name}Left") + place(joints, f"{name}Right"))


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def trunk(joints: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    up = unit(place(joints, "Shoulder") - place(joints, "Hip"))
    left = sum(unit(place(joints, f"{n}Left") - place(joints, f"{n}Right")) for n in SIDEWAYS)
    left = unit(left - left @ up * up)
    return left, up, np.cross(left, up)


SIDEWAYS = ("Shoulder", "Hip")


def measured(joints: np.ndarray) -> np.ndarray:
    left, up, ahead = trunk(joints)
    hips = place(joints, "Hip")

    def length(first: str, second: str) -> float:
        ways = [place(joints, second + s) - place(joints, first + s) for s in ("Left", "Right")]
        return float(np.mean(np.linalg.norm(ways, axis=1)))

    shoulders = place(joints, "ShoulderLeft") - place(joints, "ShoulderRight")
    return (
        np.array(
            [
                (place(joints, "HipCenter") - hips) @ up,
                (place(joints, "Spine") - hips) @ up,
                (place(joints, "Spine") - hips) @ ahead,
                (place(joints, "ShoulderCenter") - hips) @ up,
                (place(joints, "Shoulder") - hips) @ up,
                0.5 * shoulders @ left,
                0.5 * (place(joints, "HipLeft") - place(joints, "HipRight")) @ left,
                np.linalg.norm(place(joints, "Head") - place(joints, "ShoulderCenter")),
                length("Elbow", "Wrist"),
                length("Wrist", "Hand"),
                length("Hip", "Knee"),
                length("Ankle", "Foot"),
            ]
        )
        / HEIGHT
    )


def person(seed: int) -> np.ndarray:
    """Somebody who stands, arms down, somewhere and turned somehow."""
    random = np.random.default_rng(seed)
    joints = STANDING + 0.01 * random.normal(size=(20, 3))
    for end, drop in (("ElbowRight", 0.25), ("WristRight", 0.45), ("HandRight", 0.53)):
        joints[JOINT_NAMES.index(end)] = joints[JOINT_NAMES.index("ShoulderRight")] + [0, drop, 0]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return joints @ (turn * np.sign(np.linalg.det(turn))).T + random.normal(size=3)


def test_the_measures_are_those_of_the_plain_definition() -> None:
    for seed in range(5):
        joints = person(seed)
        np.testing.assert_allclose(measure_bodies(joints, HEIGHT), measured(joints), atol=1e-12)


def test_moved_joints_have_measures_that_differ_by_what_they_were_moved() -> None:
    differences = 0.01 * np.random.default_rng(3).normal(size=len(MEASURES))
    expected = differences.copy()
    expected[STAY] = 0.0
    for seed in range(5):
        joints = person(seed)
        moved = move_joints(joints, differences, HEIGHT)
        np.testing.assert_allclose(measured(moved) - measured(joints), expected, atol=2e-4)
        for part in ("Shoulder", "Hip", "Wrist", "Ankle"):
            for joint in (JOINT_NAMES.index(part + side) for side in ("Left", "Right")):
                np.testing.assert_array_equal(moved[joint], joints[joint])


def test_a_missing_joint_takes_nothing_else_with_it_and_is_not_made_up() -> None:
    joints = person(0)
    moved = move_joints(joints, np.full(len(MEASURES), 0.02), HEIGHT)
    for missing in range(20):
        some = joints.copy()
        some[missing] = np.nan
        given = move_joints(some, np.full(len(MEASURES), 0.02), HEIGHT)
        assert np.isfinite(np.delete(given, missing, axis=0)).all()
        assert np.isnan(given[missing]).all()
    assert np.abs(moved - joints).max() > 0.02
