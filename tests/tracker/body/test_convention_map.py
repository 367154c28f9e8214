"""Joints of one convention mapped to another one, by a table or by what a person shows."""

import numpy as np
import pytest
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.convention_map import (
    ConventionMap,
    canonical_joints,
    measure_bodies,
)
from inhand_tracker.body.convention_table import MEASURES, OF_THE_TRUNK, PEOPLE_DIFFER, STAY, TABLE
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.skeleton import LEG_SHARE, TRUNK_SHARE, part_lengths, stature_of

SOME_SECONDS = 90
TRUNK = slice(0, OF_THE_TRUNK)
HAND = MEASURES.index("hand")
MOVED = np.delete(np.arange(len(MEASURES)), STAY)
HEIGHT = 1.7
ARM = ("Shoulder", "Elbow", "Wrist", "Hand")


def person(measures: np.ndarray = TABLE["simulated"]) -> np.ndarray:
    """Somebody of some measures who is ``HEIGHT`` tall and stands, arms down."""
    hip_up, spine_up, spine_ahead, chest_up, shoulders_up = measures[:5]
    shoulders, hips, neck, forearm, hand, thigh, foot = measures[5:]
    trunk = np.hypot(spine_up - hip_up, spine_ahead) + np.hypot(chest_up - spine_up, spine_ahead)
    leg = TRUNK_SHARE + LEG_SHARE - trunk - neck
    places = {
        "HipCenter": (0.0, hip_up, 0.0),
        "Spine": (0.0, spine_up, spine_ahead),
        "ShoulderCenter": (0.0, chest_up, 0.0),
        "Head": (0.0, chest_up + neck, 0.0),
    }
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for joint, down in zip(ARM, np.cumsum([0.0, 0.19, forearm, hand]), strict=True):
            places[joint + side] = (sign * shoulders, shoulders_up - down, 0.0)
        for joint, down in (("Hip", 0.0), ("Knee", thigh), ("Ankle", leg)):
            places[joint + side] = (sign * hips, -down, 0.0)
        places[f"Foot{side}"] = (sign * hips, -leg, foot)
    left_up_ahead = np.array([places[name] for name in JOINT_NAMES])
    return HEIGHT * left_up_ahead * [1.0, -1.0, -1.0] + [0.0, 0.0, 2.5]


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


def is_canonical(joints: np.ndarray) -> None:
    np.testing.assert_allclose(measures(joints)[MOVED], TABLE["simulated"][MOVED], atol=4e-3)


@pytest.mark.parametrize("name", ["simulated", None, "my_sensor"])
def test_joints_of_the_convention_that_was_learned_stay_as_they_are(name: str | None) -> None:
    stranger = person(TABLE["kinect_v1"])
    assert shown(new_map(name), stranger, name) is stranger


def test_a_tabulated_convention_is_mapped_from_the_first_frame() -> None:
    kinect = person(TABLE["kinect_v1"])
    first = new_map().apply(kinect, "kinect_v1")
    is_canonical(first)
    assert np.abs(measures(kinect) - TABLE["simulated"]).max() > 0.05


@pytest.mark.parametrize("source", [None, "my_sensor"])
def test_any_other_convention_is_read_from_whoever_stands(source: str | None) -> None:
    kinect = person(TABLE["kinect_v1"])
    mapped = new_map()
    np.testing.assert_array_equal(mapped.apply(kinect, source), kinect)
    given = shown(mapped, kinect, source)
    is_canonical(given)


def test_a_model_that_names_none_is_mapped_to_by_the_bodies_it_keeps() -> None:
    kinect = person(TABLE["kinect_v1"])
    given = new_map(None).apply(kinect, "kinect_v1")
    is_canonical(given)


def test_a_person_of_one_s_own_proportions_is_no_convention() -> None:
    random = np.random.default_rng(2)
    for _ in range(5):
        somebody = person(TABLE["simulated"] + PEOPLE_DIFFER * random.normal(size=12))
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
    kinect = np.repeat(person(TABLE["kinect_v1"])[None], 3, axis=0)
    given = canonical_joints(kinect, "kinect_v1")
    is_canonical(given[0])
    for same in ("simulated", "my_sensor", None):
        assert canonical_joints(kinect, same) is kinect
