"""A person before a wall, as depth alone, whose joints are known; and a network that sees them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.lifting import DepthPicture, joint_radii
from inhand_capture.estimation.limbs import DERIVED, LIMBS
from inhand_capture.estimation.parameters import DEFAULT_LIFTING
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

INFO = CameraInfo(
    sequence=0, time_ns=0, width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5
)
LENS = Pinhole(525.0, 525.0, 319.5, 239.5, 640, 480)
WALL_M = 3.5
KNOWN = np.array([joint not in DERIVED for joint in Joint])


def standing(x: float = 0.0, z: float = 2.5) -> NDArray[np.float64]:
    """Joints (20, 3) of somebody who faces the camera at a place, as a network sees them."""
    joints = np.full((20, 3), np.nan)
    joints[Joint.HEAD] = (0.0, -0.72, 0.0)
    for side, left in (("LEFT", 1.0), ("RIGHT", -1.0)):
        joints[Joint[f"SHOULDER_{side}"]] = (0.17 * left, -0.45, 0.0)
        joints[Joint[f"ELBOW_{side}"]] = (0.25 * left, -0.17, 0.0)
        joints[Joint[f"WRIST_{side}"]] = (0.27 * left, 0.09, -0.04)
        joints[Joint[f"HAND_{side}"]] = (0.27 * left, 0.17, -0.05)
        joints[Joint[f"HIP_{side}"]] = (0.09 * left, 0.05, 0.0)
        joints[Joint[f"KNEE_{side}"]] = (0.10 * left, 0.48, 0.0)
        joints[Joint[f"ANKLE_{side}"]] = (0.11 * left, 0.88, 0.02)
        joints[Joint[f"FOOT_{side}"]] = (0.13 * left, 0.94, -0.12)
    return joints + np.array([x, 0.0, z])


def pixels_of(joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pixels (20, 2) of joints."""
    return joints[:, :2] / joints[:, 2:] * [LENS.fx, LENS.fy] + [LENS.cx, LENS.cy]


def seen(joints: NDArray[np.float64], *, depths: bool = True) -> FoundPerson:
    """What a network says that sees joints exactly, with their depths or without."""
    hips = joints[[Joint.HIP_LEFT, Joint.HIP_RIGHT], 2].mean()
    relative = joints[:, 2] - hips if depths else np.full(20, np.nan)
    return FoundPerson(pixels_of(joints), relative, KNOWN.astype(float))


def depth_of(*people: NDArray[np.float64]) -> NDArray[np.uint16]:
    """Depth (480, 640), millimetres, of people of balls and of trunks, before a wall."""
    depth = np.full((LENS.height, LENS.width), 1000 * WALL_M)
    radii = joint_radii(DEFAULT_LIFTING)
    for joints in people:
        parts = [(joints[joint], 1.2 * radii[joint]) for joint in Joint if KNOWN[joint]]
        for limb in LIMBS:
            for inner, outer in pairwise(limb):
                for share in np.linspace(0.1, 0.9, 9):
                    place = (1 - share) * joints[inner] + share * joints[outer]
                    parts.append((place, 1.2 * min(radii[inner], radii[outer])))
        corners = (
            joints[[Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT]],
            joints[[Joint.HIP_LEFT, Joint.HIP_RIGHT]],
        )
        for down in np.linspace(0.0, 1.0, 12):
            for across in np.linspace(0.0, 1.0, 6):
                ends = (1 - down) * corners[0] + down * corners[1]
                parts.append(((1 - across) * ends[0] + across * ends[1], 0.08))
        for place, radius in parts:
            draw_ball(depth, place, radius)
    return depth.astype(np.uint16)


def draw_ball(depth: NDArray[np.float64], place: NDArray[np.float64], radius: float) -> None:
    """Draw the front of a ball at a place (3,) into depth in millimetres."""
    x, y = place[:2] / place[2] * LENS.fx + [LENS.cx, LENS.cy]
    reach = radius / place[2] * LENS.fx + 1.0
    left, right = (int(np.clip(x + side * reach, 0, LENS.width)) for side in (-1, 1))
    top, bottom = (int(np.clip(y + side * reach, 0, LENS.height)) for side in (-1, 1))
    v, u = np.mgrid[top:bottom, left:right]
    aside, below = (u - x) / LENS.fx * place[2], (v - y) / LENS.fy * place[2]
    rest = radius**2 - aside**2 - below**2
    front = 1000 * (place[2] - np.sqrt(np.maximum(rest, 0.0)))
    there = depth[top:bottom, left:right]
    np.copyto(there, front, where=(rest > 0) & (front < there))


def picture(*people: NDArray[np.float64]) -> DepthPicture:
    """The depth of people, as the lifter takes it."""
    return DepthPicture(depth_of(*people), 0.001)


@dataclass
class ToldNetwork:
    """Finds who it is told to find, picture by picture; the last again and again."""

    script: list[Sequence[FoundPerson]]
    looked: list[int] = field(default_factory=list)

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find the next people."""
        self.looked.append(len(self.looked))
        return self.script.pop(0) if len(self.script) > 1 else self.script[0]
