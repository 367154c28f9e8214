"""Simulated people for the lab's tests, and plain geometry to judge them by."""

from functools import cache

import numpy as np
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import Performance
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body
from inhand_lab.people.person import USUAL_PEOPLE, People, SimulatedPerson, sample_person
from inhand_lab.people.solids import head_radii
from inhand_lab.world.interactions import INTERACTIONS
from inhand_tracker.geometry.arrays import Array
from solids import placed

SEED = 20
FRAME_RATE = 15.0


@cache
def performed(
    interaction: str, participant: int
) -> tuple[SimulatedPerson, Performance, BodyMotion]:
    """12 s of an interaction at 15 Hz, in the person's world."""
    return perform(interaction, participant, SEED, FRAME_RATE)


def perform(
    interaction: str,
    participant: int,
    seed: int,
    frame_rate: float,
    people: People = USUAL_PEOPLE,
) -> tuple[SimulatedPerson, Performance, BodyMotion]:
    """12 s of an interaction at some frame rate, in the world of a seed's person."""
    person = sample_person(seed, participant, people)
    times = np.arange(0.0, 12.0, 1.0 / frame_rate)
    random = np.random.default_rng([seed, participant])
    performance = INTERACTIONS[interaction].perform(person, times, random)
    posture, right, left = performance.posture, performance.right_hand, performance.left_hand
    return person, performance, place_body(person, posture, right, left)


def object_points(interaction: str, world_from_object: Transform) -> Array:
    """The object's vertices (T, V, 3) in the world."""
    return placed(world_from_object, INTERACTIONS[interaction].object_model().vertices)


def angles_at(joints: Array, first: int, middle: int, last: int) -> Array:
    """The angle (T,) in degrees between the bones that meet at the middle joint."""
    one, other = joints[:, first] - joints[:, middle], joints[:, last] - joints[:, middle]
    cosine = np.sum(one * other, axis=1)
    cosine /= np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def depth_in_head(person: SimulatedPerson, body: BodyMotion, points: Array) -> Array:
    """How far (T, V) points (T, V, 3) are inside the head's ellipsoid, metres, along the ray."""
    offset = points - body.from_head.translation[:, None]
    local = offset @ body.from_head.rotation
    level = np.linalg.norm(local / head_radii(person), axis=2)
    return np.asarray((1.0 / level - 1.0) * np.linalg.norm(local, axis=2))
