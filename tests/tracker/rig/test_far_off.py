"""A camera metres from where it is said to be is found, and makes nobody a second person."""

from collections.abc import Callable

import numpy as np
import pytest
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.rig.people_fusing import PeopleFuser
from inhand_tracker.rig.sightings import CameraPeople
from people import FRAME_NS
from rig_people import PLACES, person_seen, standing_at

Walk = Callable[[float], np.ndarray]


def walking(seconds: float) -> np.ndarray:
    """Joints (20, 3) of somebody who walks to and fro and waves a hand."""
    joints = standing_at(0.3 * np.sin(1.5 * seconds))
    joints[8:12, 1] += 0.2 * np.sin(4.0 * seconds)
    return joints


def standing(_seconds: float) -> np.ndarray:
    return standing_at(0.0)


def bumped(place: Placement, metres: float) -> Placement:
    """Where a camera truly is that was bumped, and turned by half a radian."""
    turn = rotations.from_vector(np.array([0.0, 0.5, 0.0]))
    moved = place.translation + np.array([metres, 0.0, 0.0])
    return Placement(moved, rotations.multiply(turn, place.rotation))


def watched(
    walks: dict[str, Walk],
    truly: dict[str, Placement],
    seconds: float,
    fuser: PeopleFuser | None = None,
    since: float = 0.0,
) -> tuple[PeopleFuser, int]:
    """The fuser after what cameras saw from where they truly are, ``since`` some second on, and how
    many people there are at last."""
    fuser = fuser or PeopleFuser(PLACES)
    people, random = [], np.random.default_rng(5)
    for frame in range(*(round(time * 1e9 / FRAME_NS) for time in (since, since + seconds))):
        time_ns = FRAME_NS * (frame + 1)
        seen = []
        for camera, walk in walks.items():
            joints = walk(time_ns / 1e9) + random.normal(0.0, 0.02, (20, 3))
            seen.append(CameraPeople(camera, time_ns, [person_seen(joints, truly[camera], 0)]))
        people = fuser.fuse(seen, time_ns)
    return fuser, len(people)


@pytest.mark.parametrize("cameras", [("front", "left"), ("front", "left", "right")])
@pytest.mark.parametrize("metres", [0.8, 3.0])
def test_a_camera_far_from_its_place_is_left_out_and_its_person_is_no_second_one(
    cameras: tuple[str, ...], metres: float
) -> None:
    truly = {**PLACES, "left": bumped(PLACES["left"], metres)}
    fuser, people = watched(dict.fromkeys(cameras, walking), truly, 8.0)
    assert list(fuser.left_out) == ["left"]
    assert fuser.left_out["left"] > 0.5
    assert people == 1


def test_the_first_camera_is_left_out_where_two_others_agree() -> None:
    truly = {**PLACES, "front": bumped(PLACES["front"], 2.0)}
    fuser, people = watched(dict.fromkeys(PLACES, walking), truly, 8.0)
    assert list(fuser.left_out) == ["front"]
    assert people == 1


@pytest.mark.parametrize("walk", [standing, lambda seconds: walking(1.7 * seconds + 1.0)])
def test_two_people_each_before_a_camera_of_their_own_stay_two(walk: Walk) -> None:
    truly = {**PLACES, "left": bumped(PLACES["left"], 2.0)}
    for first in (walking, standing):
        fuser, people = watched({"front": first, "left": walk}, truly, 12.0)
        assert not fuser.left_out
        assert people == 2


def test_a_camera_that_is_back_in_its_place_counts_again() -> None:
    truly = {**PLACES, "left": bumped(PLACES["left"], 2.0)}
    fuser, _ = watched(dict.fromkeys(("front", "left"), walking), truly, 8.0)
    assert fuser.left_out
    watched(dict.fromkeys(("front", "left"), walking), PLACES, 5.3, fuser, since=8.0)
    assert not fuser.left_out
