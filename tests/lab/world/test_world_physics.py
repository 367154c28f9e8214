"""A world that could be: nothing goes through anything, and the truth is what the picture shows."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import Performance
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.person import PEOPLE, People, SimulatedPerson
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate
from inhand_schemas.joints import Joint
from performers import angles_at, perform
from silhouettes import silhouette
from solids import (
    depth_in_limbs,
    depth_in_trunk_and_head,
    forearm_and_hand,
    placed,
    surface_points,
    upper_arm,
)

SEED = 61
FRAME_RATE = 30.0
EVERY = 3
"""Solids are compared in every third frame."""
TOLERANCE = 0.01
LONGEST_STEP = 0.15
FAST_SWINGS = {"hitTennisBall": 0.60, "hitGolfBall": 0.90}
"""Longest steps in metres of an object's middle at 30 Hz where it is swung fast."""

WEARING = {"putOnShoe": (Joint.ANKLE_RIGHT, Joint.FOOT_RIGHT)}
"""The limbs, by their further joint, that an object goes round; everybody is right-handed here."""
FREE = 0.95
"""Share of an object that is seen where hardly anything hides it."""

crowds = pytest.mark.parametrize(
    "participants",
    [
        pytest.param(range(4), id="4 people"),
        pytest.param(range(4, 104), id="100 people", marks=pytest.mark.long),
    ],
)
interactions = pytest.mark.parametrize("interaction", INTERACTIONS)
kinds = pytest.mark.parametrize("people", PEOPLE)


@crowds
@kinds
@interactions
def test_the_world_keeps_its_laws(interaction: str, people: People, participants: range) -> None:
    broken = []
    for participant in participants:
        person, performance, body = perform(interaction, participant, SEED, FRAME_RATE, people)
        sampled = slice(None, None, EVERY)
        placed_object = performance.world_from_object[sampled]
        broken += [
            f"participant {participant}: {what}"
            for what in (
                *arms_in_the_body(person, body[sampled]),
                *object_in_the_body(interaction, person, placed_object, body[sampled]),
                *bent_too_far(body),
                *jumps(interaction, performance),
            )
        ]
    assert not broken, "\n".join(broken)


def arms_in_the_body(person: SimulatedPerson, body: BodyMotion) -> list[str]:
    """Upper arms, forearms and palms that go through head or trunk."""
    broken = []
    for side in ("right", "left"):
        for name, part in (("upper arm", upper_arm), ("forearm", forearm_and_hand)):
            centres, radii = part(person, body, side)
            for solid, depth in depth_in_trunk_and_head(person, body, centres).items():
                deepest = (depth + radii).max()
                if deepest > TOLERANCE:
                    broken.append(f"the {side} {name} is {100 * deepest:.1f} cm in the {solid}")
    return broken


def object_in_the_body(
    interaction: str,
    person: SimulatedPerson,
    world_from_object: Transform,
    body: BodyMotion,
) -> list[str]:
    """An object that goes through anything but what holds or wears it."""
    points = placed(world_from_object, surface_points(interaction))
    depths = depth_in_trunk_and_head(person, body, points)
    depths |= depth_in_limbs(person, body, points)
    for limb in WEARING.get(interaction, ()):
        del depths[limb.name]
    return [
        f"the object is {100 * depth.max():.1f} cm in {solid}"
        for solid, depth in depths.items()
        if depth.max(initial=0.0) > TOLERANCE
    ]


def bent_too_far(body: BodyMotion) -> list[str]:
    """Joints beyond their limits, in degrees."""
    broken = []
    for shoulder in (Joint.SHOULDER_RIGHT, Joint.SHOULDER_LEFT):
        elbow = angles_at(body.joints, shoulder, shoulder + 1, shoulder + 2)
        wrist = angles_at(body.joints, shoulder + 1, shoulder + 2, shoulder + 3)
        if elbow.min() < 29.9 or elbow.max() > 172.1 or wrist.min() < 104.9:
            broken.append(f"{shoulder.name}: elbow {elbow.min():.0f} to {elbow.max():.0f} degrees")
    for hip in (Joint.HIP_RIGHT, Joint.HIP_LEFT):
        knee = angles_at(body.joints, hip, hip + 1, hip + 2)
        if knee.min() < 29.9 or knee.max() > 178.1:
            broken.append(f"{hip.name}: knee {knee.min():.0f} to {knee.max():.0f} degrees")
    return broken


def jumps(interaction: str, performance: Performance) -> list[str]:
    """Steps of the object's middle that are longer than one sees from frame to frame."""
    middle = surface_points(interaction).mean(axis=0)
    steps = np.diff(performance.world_from_object.apply(middle), axis=0)
    longest = np.linalg.norm(steps, axis=1).max()
    if longest <= FAST_SWINGS.get(interaction, LONGEST_STEP):
        return []
    return [f"the object jumps by {100 * longest:.0f} cm"]


@pytest.mark.parametrize("participant", range(3))
@interactions
def test_the_true_pose_covers_the_pixels_that_show_the_object(
    interaction: str, participant: int
) -> None:
    simulation = simulate(interaction, participant, seed=SEED)
    frames = [f for f in range(0, 360, 12) if simulation.visible_fraction(f) >= FREE]
    for frame in frames[:: max(len(frames) // 4, 1)]:
        expected, drawing = silhouette(simulation, frame), simulation.draw(frame)
        found = drawing.object_mask
        overlap = np.count_nonzero(expected & found) / np.count_nonzero(expected | found)
        assert overlap >= 0.95 * drawing.visible_fraction, f"frame {frame}"


@interactions
def test_the_visible_fraction_is_what_the_picture_shows(interaction: str) -> None:
    simulation = simulate(interaction, 1, seed=SEED)
    for frame in range(0, 360, 45):
        quick, drawn = simulation.visible_fraction(frame), simulation.draw(frame)
        assert quick == pytest.approx(drawn.visible_fraction, abs=1e-9)
        expected = np.count_nonzero(silhouette(simulation, frame))
        shown = np.count_nonzero(drawn.object_mask)
        assert quick == pytest.approx(shown / expected, abs=0.06)


@interactions
def test_every_interaction_shows_its_object_free_and_in_contact(interaction: str) -> None:
    simulations = [simulate(interaction, participant, seed=SEED) for participant in range(5)]
    assert any(s.visible_fraction(f) >= FREE for s in simulations for f in range(0, 360, 30))
    assert all(len(np.unique(s.contact)) > 1 for s in simulations)
