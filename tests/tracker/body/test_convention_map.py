"""Joints of one convention mapped to another one, by a table or by what a person shows."""

import numpy as np
import pytest
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.convention_map import (
    ConventionMap,
    canonical_joints,
    measure_bodies,
    move_joints,
)
from inhand_tracker.body.convention_table import MEASURES, OF_THE_TRUNK, PEOPLE_DIFFER, TABLE
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.skeleton import part_lengths, stature_of
from people import STANDING

SOME_SECONDS = 90
TRUNK = slice(0, OF_THE_TRUNK)
HAND = MEASURES.index("hand")


def person(differences: np.ndarray | float = 0.0) -> np.ndarray:
    """Somebody of simulated proportions who stands, arms down, but for differences."""
    joints = STANDING.copy()
    for name, side in (("Right", -1.0), ("Left", 1.0)):
        for part, down in (("Elbow", 0.31), ("Wrist", 0.56), ("Hand", 0.63)):
            shoulder = joints[JOINT_NAMES.index(f"Shoulder{name}")]
            joints[JOINT_NAMES.index(part + name)] = shoulder + np.array([0.01 * side, down, 0.0])
    for _ in range(20):
        height = stature_of(joints[None])
        away = TABLE["simulated"] - measure_bodies(joints, height)
        joints = move_joints(joints, away, height)
    return move_joints(joints, np.broadcast_to(differences, 12), stature_of(joints[None]))


LEARNED = np.repeat(person()[None], 60, axis=0) / stature_of(person()[None])


def new_map(name: str | None = "simulated", learned: np.ndarray = LEARNED) -> ConventionMap:
    return ConventionMap(name, learned.reshape(-1, 60), part_lengths(person()))


def shown(mapped: ConventionMap, joints: np.ndarray, source: str | None) -> np.ndarray:
    """The joints of somebody who was seen for some seconds."""
    for _ in range(SOME_SECONDS):
        given = mapped.apply(joints, source)
    return given


def measures(joints: np.ndarray) -> np.ndarray:
    return measure_bodies(joints, stature_of(joints[None]))


@pytest.mark.parametrize("name", ["simulated", None, "my_sensor"])
def test_joints_of_the_convention_that_was_learned_stay_as_they_are(name: str | None) -> None:
    stranger = person(TABLE["kinect_v1"] - TABLE["simulated"])
    assert shown(new_map(name), stranger, name) is stranger


def test_a_tabulated_convention_is_mapped_from_the_first_frame() -> None:
    kinect = person(TABLE["kinect_v1"] - TABLE["simulated"])
    first = new_map().apply(kinect, "kinect_v1")
    np.testing.assert_allclose(measures(first), TABLE["simulated"], atol=4e-3)
    assert np.abs(measures(kinect) - TABLE["simulated"]).max() > 0.05


@pytest.mark.parametrize("source", [None, "my_sensor"])
def test_any_other_convention_is_read_from_whoever_stands(source: str | None) -> None:
    kinect = person(TABLE["kinect_v1"] - TABLE["simulated"])
    mapped = new_map()
    np.testing.assert_array_equal(mapped.apply(kinect, source), kinect)
    given = shown(mapped, kinect, source)
    np.testing.assert_allclose(measures(given), TABLE["simulated"], atol=4e-3)


def test_a_model_that_names_none_is_mapped_to_by_the_bodies_it_keeps() -> None:
    kinect = person(TABLE["kinect_v1"] - TABLE["simulated"])
    given = new_map(None).apply(kinect, "kinect_v1")
    np.testing.assert_allclose(measures(given), TABLE["simulated"], atol=4e-3)


def test_a_person_of_one_s_own_proportions_is_no_convention() -> None:
    random = np.random.default_rng(2)
    for _ in range(5):
        somebody = person(PEOPLE_DIFFER * random.normal(size=12))
        np.testing.assert_array_equal(shown(new_map(), somebody, None), somebody)


@pytest.mark.parametrize("angle", [0.7, -0.7])
def test_whoever_leans_shows_a_posture_and_no_convention(angle: float) -> None:
    """Only the lengths of limbs, which no posture changes, are read from them."""
    somebody = person()
    hips = somebody[[JOINT_NAMES.index("HipLeft"), JOINT_NAMES.index("HipRight")]].mean(axis=0)
    cosine, sine = np.cos(angle), np.sin(angle)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    upper = [j for j, name in enumerate(JOINT_NAMES) if "Hip" not in name and j < 12]
    leaning = somebody.copy()
    leaning[upper] = hips + (somebody[upper] - hips) @ turn.T
    assert np.isnan(measures(leaning)[TRUNK]).all()
    np.testing.assert_array_equal(shown(new_map(), leaning, None), leaning)
    longer = leaning.copy()
    for wrist, hand in ((6, 7), (10, 11)):
        longer[hand] += 0.08 * (leaning[hand] - leaning[wrist]) / 0.07
    given = shown(new_map(), longer, "my_sensor")
    hands = np.linalg.norm(given[[7, 11]] - given[[6, 10]], axis=1) / stature_of(given[None])
    np.testing.assert_allclose(hands, TABLE["simulated"][HAND], atol=2e-3)
    np.testing.assert_array_equal(given[:3], longer[:3])


def test_a_named_convention_that_nobody_shows_is_a_trouble_until_somebody_does() -> None:
    seated = person()
    seated[12:] = np.nan
    mapped = new_map()
    for _ in range(DEFAULT_BODY.patience):
        mapped.apply(seated, "my_sensor")
    assert mapped.trouble is not None
    assert "'my_sensor'" in mapped.trouble
    assert "\n" not in mapped.trouble
    shown(mapped, person(), "my_sensor")
    assert mapped.trouble is None
    for source in (None, "simulated", "kinect_v1"):
        for _ in range(DEFAULT_BODY.patience):
            mapped.apply(seated, source)
        assert mapped.trouble is None


def test_training_takes_bodies_of_tabulated_conventions_as_canonical() -> None:
    kinect = np.repeat(person(TABLE["kinect_v1"] - TABLE["simulated"])[None], 3, axis=0)
    given = canonical_joints(kinect, "kinect_v1")
    np.testing.assert_allclose(measures(given[0]), TABLE["simulated"], atol=4e-3)
    for same in ("simulated", "my_sensor", None):
        assert canonical_joints(kinect, same) is kinect
