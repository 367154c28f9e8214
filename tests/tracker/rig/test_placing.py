"""Where a rig's cameras truly stand is learned from what each of them shows of the same things."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.image import ViewPull
from inhand_tracker.geometry.placement import HERE, Placement
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters
from inhand_tracker.rig.placing import PlaceDeviation, Placing
from people import FRAME_NS
from rig_people import MIDDLE, PLACES

SAID = PlaceDeviation(0.01, 0.005)
SURE = np.diag([1e4] * 3 + [1e2] * 3)
"""Information of an image that shows a thing to within 1 cm and 6°."""


def moved(place: Placement, shift: tuple[float, float, float], degrees: float) -> Placement:
    """A camera elsewhere than that, and turned about its vertical."""
    turn = rotations.from_vector(np.array([0.0, np.radians(degrees), 0.0]))
    return Placement(place.translation + np.array(shift), rotations.multiply(turn, place.rotation))


TRUE = {
    "front": HERE,
    "left": moved(PLACES["left"], (0.012, -0.02, 0.008), 0.4),
    "right": moved(PLACES["right"], (-0.01, 0.015, 0.01), -0.3),
}
"""Where cameras are that are said to be at ``PLACES``."""


def placing(said: PlaceDeviation = SAID, parameters: RigParameters = DEFAULT_RIG) -> Placing:
    learner = Placing("front", parameters)
    for camera, place in PLACES.items():
        learner.place(camera, place, said)
    return learner


Spoil = Callable[[np.random.Generator, str, np.ndarray], np.ndarray]


def honest(_: np.random.Generator, __: str, deviation: np.ndarray) -> np.ndarray:
    return deviation


def watch(
    learner: Placing,
    times: int,
    *,
    true: Mapping[str, Placement] = TRUE,
    spoil: Spoil = honest,
    first: int = 0,
    seed: int = 0,
) -> None:
    """Let a thing be seen as it is carried about, to within the information of its images."""
    random = np.random.default_rng(seed)
    for time in range(first, first + times):
        thing = MIDDLE + 0.6 * np.sin(time / np.array([17.0, 29.0, 41.0]))
        pulls = []
        for camera, place in true.items():
            believed = learner.found(camera).points(place.inverse().points(thing))
            noise = random.normal(0.0, 1.0, 6) / np.sqrt(np.diag(SURE))
            deviation = np.concatenate((believed - thing, np.zeros(3))) + noise
            pulls.append(ViewPull(camera, thing, spoil(random, camera, deviation), SURE))
        learner.note(pulls, (time + 1) * 3 * FRAME_NS)
        learner.settle()


def off_m(learner: Placing, camera: str, true: Mapping[str, Placement] = TRUE) -> float:
    """How far a thing in the middle is from where a camera has it."""
    seen = true[camera].inverse().points(MIDDLE)
    return float(np.linalg.norm(learner.found(camera).points(seen) - MIDDLE))


@pytest.mark.parametrize("camera", ["left", "right"])
def test_a_camera_is_found_that_is_elsewhere_than_it_is_said_to_be(camera: str) -> None:
    learner = placing()
    unsure = np.trace(learner.covariance(camera)[:3, :3])
    before = off_m(learner, camera)
    watch(learner, 60)
    assert before > 0.012
    assert off_m(learner, camera) < 0.3 * before
    assert np.trace(learner.covariance(camera)[:3, :3]) < 0.5 * unsure
    assert not learner.misplaced


def test_the_first_camera_is_where_the_rigs_frame_is() -> None:
    learner = placing()
    watch(learner, 60)
    assert learner.found("front") is PLACES["front"]
    assert not learner.covariance("front").any()


def test_cameras_that_do_not_show_the_same_thing_teach_nothing() -> None:
    learner = placing()
    watch(learner, 30, true={"left": TRUE["left"]})
    np.testing.assert_array_equal(learner.found("left").translation, PLACES["left"].translation)


def test_places_that_are_right_stay_right_long_after_all_of_it_was_forgotten_once() -> None:
    learner, worst = placing(parameters=replace(DEFAULT_RIG, place_memory_s=20.0)), 0.0
    for part in range(12):
        watch(learner, 100, true=PLACES, first=100 * part, seed=part)
        worst = max(worst, off_m(learner, "left", PLACES), off_m(learner, "right", PLACES))
    assert worst < 0.006


def test_a_false_image_moves_a_camera_no_farther_than_its_calibration_allows() -> None:
    def aside(_: np.random.Generator, camera: str, deviation: np.ndarray) -> np.ndarray:
        return deviation + (camera == "left") * np.array([0.0, 0.1, 0.0, 0.0, 0.0, 0.0])

    learner = placing(PlaceDeviation(0.002, 0.001))
    for part in range(5):
        watch(learner, 100, true=PLACES, spoil=aside, first=100 * part)
    shift = learner.found("left").translation - PLACES["left"].translation
    turn = rotations.angle_between(learner.found("left").rotation, PLACES["left"].rotation)
    most = DEFAULT_RIG.place_most
    # The first camera's own deviations count as well.
    away = float(np.linalg.norm(PLACES["left"].translation))
    assert np.linalg.norm(shift) < most * np.hypot(np.sqrt(2.0) * 0.002, 0.001 * away)
    assert turn < most * np.sqrt(2.0) * 0.001
    assert learner.misplaced["left"] > 0.02
    assert off_m(learner, "right", PLACES) < 0.01


def test_an_image_that_is_off_wherever_it_is_looked_at_does_not_move_its_camera_for_ever() -> None:
    """The left one says each time that all is 1 cm off from where it was just found to be."""
    learner, off = placing(PlaceDeviation(0.002, 0.001)), []
    for part in range(5):
        for time in range(100 * part, 100 * part + 100):
            pulls = [
                ViewPull(camera, MIDDLE, np.eye(6)[1] * (0.01 * (camera == "left")), SURE)
                for camera in PLACES
            ]
            learner.note(pulls, (time + 1) * 3 * FRAME_NS)
            learner.settle()
        off.append(off_m(learner, "left", PLACES))
    assert max(off) < 0.06
    assert off[-1] == pytest.approx(off[-2], abs=0.001)


def test_wrong_poses_hardly_teach() -> None:
    """One camera takes another thing for the object now and then, far off and ever elsewhere."""

    def now_and_then(random: np.random.Generator, camera: str, deviation: np.ndarray) -> np.ndarray:
        wrong = camera == "left" and random.random() < 0.2
        return deviation + wrong * np.array([0.15, 0.1, 0.0, 0.0, 0.0, 0.0])

    learner, fooled = placing(), placing()
    watch(learner, 100)
    watch(fooled, 100, spoil=now_and_then)
    assert off_m(fooled, "left") < off_m(learner, "left") + 0.004


def test_what_several_things_show_at_once_is_of_where_cameras_were_believed_to_be() -> None:
    one, several = placing(), placing()
    for learner, things in ((one, 1), (several, 5)):
        for time in range(1, 31):
            seen = [TRUE[camera].inverse().points(MIDDLE) for camera in TRUE]
            pulls = []
            for camera, point in zip(TRUE, seen, strict=True):
                way = learner.found(camera).points(point) - MIDDLE
                pulls.append(ViewPull(camera, MIDDLE, np.append(way, np.zeros(3)), SURE))
            for _ in range(things):
                learner.note(pulls, time * 3 * FRAME_NS)
            learner.settle()
    assert off_m(several, "left") < off_m(one, "left") < 0.005


def test_people_teach_no_more_than_one_sight_of_them_however_long_they_stay() -> None:
    learner = placing()
    information = np.diag([DEFAULT_RIG.body_place_m**-2.0] * 3 + [0.0] * 3)
    sure = []
    for time in range(200):
        pulls = [
            ViewPull(
                camera,
                MIDDLE,
                np.concatenate(
                    (
                        learner.found(camera).points(place.inverse().points(MIDDLE)) - MIDDLE,
                        np.zeros(3),
                    )
                ),
                information,
            )
            for camera, place in TRUE.items()
        ]
        learner.note_person(pulls, (time + 1) * 3 * FRAME_NS)
        learner.settle()
        sure.append(np.trace(learner.covariance("left")))
    assert off_m(learner, "left") < 0.6 * 0.026
    assert sure[-1] == pytest.approx(sure[0], rel=0.05)


def test_a_camera_with_a_new_place_is_learned_anew() -> None:
    learner = placing()
    watch(learner, 60)
    learner.place("left", PLACES["left"], SAID)
    assert off_m(learner, "left") < 0.005
    learner.place("left", TRUE["left"], SAID)
    np.testing.assert_array_equal(learner.found("left").rotation, TRUE["left"].rotation)
    np.testing.assert_array_equal(learner.found("right").translation, PLACES["right"].translation)
