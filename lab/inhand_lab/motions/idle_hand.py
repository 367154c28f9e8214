"""What one hand does while the other uses a thing: two things at once."""

from __future__ import annotations

import numpy as np

from inhand_lab.geometry.transforms import Transform, rotation_from_axes
from inhand_lab.motions.parameters import DEFAULT_VARIETY
from inhand_lab.motions.script import Script
from inhand_lab.motions.timeline import Key, move_through
from inhand_lab.people.kinematics import Trunk

BESIDE_USE = {
    "hip": ((0.20, 0.03, -0.38), (-0.6, 0.3, -0.7)),
    "ear": ((0.13, 0.05, 0.22), (-0.5, -0.2, 0.8)),
    "explain": ((0.26, 0.30, -0.16), (-0.3, 0.9, 0.3)),
    "greet": ((0.30, 0.20, 0.06), (-0.2, 0.6, 0.8)),
}
"""Where a right hand goes, in the chest's frame of a person of usual stature, metres, and where its
fingers point: aside of where the other hand is at work."""
THUMB = np.array([0.0, 0.4, 0.9])
"""Where the thumb points, as far as the fingers let it."""


def idle_left_hand(script: Script, trunk: Trunk, rest: Transform) -> Transform:
    """A left hand that hangs, world_from_hand (T); a varied person's gestures now and then.

    Its time is the clock's: who stops with one hand may go on with the other.
    """
    if not script.person.varied:
        return rest
    usual, random = DEFAULT_VARIETY, script.apart
    keys, now = [Key(0.0, rest)], 0.0
    for _ in range(int(random.poisson(usual.gestures))):
        place, fingers = BESIDE_USE[str(random.choice(list(BESIDE_USE)))]
        right = Transform(script.size * np.array(place), rotation_from_axes(fingers, THUMB))
        pose = trunk.world_from_chest @ right.mirrored()
        starts = now + float(random.uniform(*usual.between_gestures_s))
        arrives = starts + usual.gesture_way_s
        leaves = arrives + float(random.uniform(*usual.gesture_s))
        now = leaves + usual.gesture_way_s
        keys += [Key(starts, rest), Key(arrives, pose), Key(leaves, pose), Key(now, rest)]
    return move_through(script.clock, keys)
