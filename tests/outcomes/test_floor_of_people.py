"""Floors from skeletons of people who stand, walk or sit, placed by hand."""

import numpy as np
from inhand_outcomes.floor_of_people import find_floor_of_people
from inhand_schemas.joints import Joint
from scipy.spatial.transform import Rotation

TURN = Rotation.from_euler("xz", [-75.0, 12.0], degrees=True)
UP = TURN.apply([0.0, 0.0, 1.0])
HIGH = 1.2
"""The rig's origin is this high above the floor."""


def person(places, *, knees_ahead=0.0, hip=0.92, lean_deg=0.0):
    """Joints (N, 20, 3) in the rig of somebody whose middle is at places (N, 2) of the floor."""
    joints = np.full((len(places), 20, 3), np.nan)
    top = [0.0, np.sin(np.radians(lean_deg)) * 0.5, hip + np.cos(np.radians(lean_deg)) * 0.5]
    parts = {Joint.SHOULDER_CENTER: top, Joint.HIP_CENTER: [0.0, 0.0, hip]}
    for side, names in ((-0.1, ("LEFT",)), (0.1, ("RIGHT",))):
        for name in names:
            parts[Joint["HIP_" + name]] = [side, 0.0, hip]
            parts[Joint["KNEE_" + name]] = [side, knees_ahead, 0.075 + 0.5 * (hip - 0.075)]
            parts[Joint["ANKLE_" + name]] = [side, 0.0, 0.075]
    for joint, place in parts.items():
        joints[:, joint] = np.column_stack([places, np.zeros(len(places))]) + place
    noise = np.random.default_rng(2).normal(0.0, 0.008, joints.shape)
    return TURN.apply((joints + noise).reshape(-1, 3)).reshape(joints.shape) - HIGH * UP


def found(joints, people=None):
    times = np.arange(len(joints)) / 30.0
    who = np.zeros(len(joints), np.int64) if people is None else people
    return find_floor_of_people(times, joints, who)


def test_people_who_stand_about_tell_floor_and_up():
    places = np.repeat([[0.0, 2.0], [1.0, 2.5], [-0.8, 3.0]], 40, axis=0)
    floor = found(person(places))
    assert floor is not None
    assert np.degrees(np.arccos(floor.up @ UP)) < 1.0
    assert abs(floor.height + HIGH) < 0.03
    assert 0.0 < floor.up_deviation_deg < 5.0


def test_feet_in_many_places_correct_a_person_who_leans():
    corners = np.array([[-1.5, 1.5], [1.5, 1.5], [1.5, 4.0], [-1.5, 4.0], [0.0, 2.5]])
    leaning = person(np.repeat(corners, 30, axis=0), lean_deg=14.0)
    floor = found(leaning)
    still = found(leaning[:30])
    assert floor is not None
    assert still is not None
    assert np.degrees(np.arccos(floor.up @ UP)) < 1.5 < np.degrees(np.arccos(still.up @ UP))
    assert floor.up_deviation_deg < still.up_deviation_deg


def test_people_who_sit_stoop_or_are_seen_too_shortly_say_nothing():
    places = np.tile([[0.0, 2.0]], (60, 1))
    assert found(person(places, knees_ahead=0.3, hip=0.6)) is None
    assert found(person(places, lean_deg=50.0)) is None
    assert found(person(places)[:10]) is None
    assert found(np.full((60, 20, 3), np.nan)) is None
