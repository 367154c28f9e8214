"""What hands do that use nothing: they hang, gesture or fidget, while the body stands about."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.geometry.transforms import Transform, rotation_from_axes
from inhand_lab.motions.performance import Stance, feet_apart, hanging_hands, stand
from inhand_lab.motions.timeline import Key, drift, move_through
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import Trunk, place_body, place_trunk
from inhand_lab.people.person import SimulatedPerson
from inhand_lab.world.parameters import DEFAULT_IDLE_HANDS

GESTURES = {
    "hips": ((0.20, 0.03, -0.38), (-0.6, 0.3, -0.7)),
    "crossed": ((-0.10, 0.20, -0.20), (-1.0, 0.1, 0.2)),
    "head": ((0.10, 0.04, 0.24), (-0.5, -0.2, 0.8)),
    "face": ((0.04, 0.14, 0.12), (-0.4, -0.3, 0.9)),
    "watch": ((-0.02, 0.28, -0.12), (-1.0, 0.2, 0.1)),
    "belly": ((0.00, 0.16, -0.34), (-1.0, 0.2, -0.1)),
}
"""Where a right hand goes, in the chest's frame of a person of 1.75 m, metres, and where its
fingers point. A gesture is of one hand or of both."""

Keys = tuple[list[Key], list[Key]]
"""Where the right and the left hand are at some times."""


@dataclass(frozen=True)
class Standing:
    """Somebody who stands about, at times (T,): the trunk, and both hands as they hang."""

    person: SimulatedPerson
    times: Array
    trunk: Trunk
    hanging: tuple[Transform, Transform]

    def hand_at(self, place: Array, fingers: Array, hand: int) -> Transform:
        """Hand 0, the right, or 1 at a place (3,) of the chest's frame, its fingers pointing."""
        pose = Transform(
            place * self.person.height / 1.75,
            rotation_from_axes(fingers, np.array([0.0, 0.4, 0.9])),
        ).repeated(len(self.times))
        return self.trunk.world_from_chest @ (pose if hand == 0 else pose.mirrored())


MoveHands = Callable[[Standing, np.random.Generator], Keys]


def stand_about(
    person: SimulatedPerson, times: Array, random: np.random.Generator, move: MoveHands
) -> BodyMotion:
    """Stand and shift about a little, with hands that move in some way."""
    right, left = feet_apart(person, len(times))
    still = np.zeros((len(times), 3))
    turn = drift(times, random, 0.08, 6.0)
    weight = np.stack(
        [drift(times, random, 0.02, 6.0), np.zeros(len(times)), np.zeros(len(times))], axis=1
    )
    glances = np.stack(
        [drift(times, random, 0.10, 4.0), np.zeros(len(times)), drift(times, random, 0.3, 4.0)],
        axis=1,
    )
    posture = stand(person, times, random, Stance(right, left, turn, weight, still, glances))
    trunk = place_trunk(person, posture)
    standing = Standing(person, times, trunk, hanging_hands(person, trunk, random))
    hands = [move_through(times, keys) for keys in move(standing, random)]
    return place_body(person, posture, hands[0], hands[1])


def still_hands(standing: Standing, _: np.random.Generator) -> Keys:
    """Both hands hang."""
    return [Key(0.0, standing.hanging[0])], [Key(0.0, standing.hanging[1])]


def gesturing_hands(standing: Standing, random: np.random.Generator) -> Keys:
    """One or both hands make one gesture after the other."""
    usual, times, hanging = DEFAULT_IDLE_HANDS, standing.times, standing.hanging
    keys = still_hands(standing, random)
    now = float(random.uniform(*usual.hanging_s))
    while now < times[-1]:
        place, fingers = GESTURES[str(random.choice(list(GESTURES)))]
        lasts = float(random.uniform(*usual.gesture_s))
        both, side = random.random() < usual.both_hands, int(random.integers(2))
        for hand in (0, 1):
            if both or hand == side:
                pose = standing.hand_at(np.array(place), np.array(fingers), hand)
                keys[hand].extend(
                    [
                        Key(now, hanging[hand]),
                        Key(now + usual.way_s, pose),
                        Key(now + usual.way_s + lasts, pose),
                        Key(now + 2.0 * usual.way_s + lasts, hanging[hand]),
                    ]
                )
        now += 2.0 * usual.way_s + lasts + float(random.uniform(*usual.hanging_s))
    return keys


def fidgeting_hands(standing: Standing, random: np.random.Generator) -> Keys:
    """Each hand goes anywhere by itself, and hangs in between."""
    usual = DEFAULT_IDLE_HANDS
    keys: Keys = ([], [])
    for hand, hanging in enumerate(standing.hanging):
        now = float(random.uniform(*usual.hanging_s))
        keys[hand].append(Key(now, hanging))
        while now < standing.times[-1]:
            for _ in range(int(random.integers(1, usual.fidgets + 1))):
                place = random.uniform(usual.fidget_low, usual.fidget_high)
                pose = standing.hand_at(place, random.normal(size=3), hand)
                reached = now + float(random.uniform(*usual.fidget_way_s))
                now = reached + float(random.uniform(*usual.fidget_s))
                keys[hand].extend([Key(reached, pose), Key(now, pose)])
            now += usual.way_s
            keys[hand].append(Key(now, hanging))
            now += float(random.uniform(*usual.hanging_s))
            keys[hand].append(Key(now, hanging))
    return keys
