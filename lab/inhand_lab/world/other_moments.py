"""What is enacted, at other moments than those of its frames: for cameras with own clocks.

Places follow cubic splines, rotations the smooth ones of scipy, so that nothing is slower or
stiffer between frames than at them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from inhand_tracker.geometry.arrays import Array
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline

from inhand_lab.geometry.transforms import Transform
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.world.enactment import Enactment


def enactment_at(enacted: Enactment, frame_rate: float, times: Array) -> Enactment:
    """What is enacted at times (T,), in seconds from its first frame and none after its last.

    A contact lasts from its frame to the next.
    """
    body, knots = enacted.body, np.arange(len(enacted.contact)) / frame_rate

    def at(transform: Transform) -> Transform:
        turning = RotationSpline(knots, Rotation.from_matrix(transform.rotation))
        place = CubicSpline(knots, transform.translation)
        return Transform(place(times), turning(times).as_matrix())

    return replace(
        enacted,
        body=BodyMotion(
            CubicSpline(knots, body.joints)(times),
            at(body.from_pelvis),
            at(body.from_chest),
            at(body.from_head),
            at(body.from_right_hand),
            at(body.from_left_hand),
        ),
        world_from_object=at(enacted.world_from_object),
        contact=enacted.contact[np.floor(times * frame_rate).astype(np.int64)],
    )
