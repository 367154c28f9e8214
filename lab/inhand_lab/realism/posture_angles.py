"""Measures postures by angles between limbs, at every joint of the body.

Sources of skeletons agree on shoulders, elbows, wrists, head, hips, knees and ankles, so angles
between these compare people. Where the middle of the trunk, hands and feet lie is each source's own
convention: angles there compare sources too, and stand in a group of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.geometry.arrays import Array

from inhand_lab.realism.parameters import DEFAULT_REALISM, RealismParameters

LIMBS, CONVENTION = "limbs", "trunk, hands and feet"
"""Groups of angles: what every source measures alike, and what each places in its own way."""

Place = tuple[Joint, ...]
"""A point of the body: the middle of these joints."""
Direction = tuple[Place, Place]
"""From one point of the body to another."""

_SHOULDERS = (Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT)
_HIPS = (Joint.HIP_LEFT, Joint.HIP_RIGHT)
_DOWN: Direction = (_SHOULDERS, _HIPS)
_TO_HEAD: Direction = (_SHOULDERS, (Joint.HEAD,))


@dataclass(frozen=True)
class PostureAngle:
    """An angle between two directions in the body, its name, and the group that it belongs to."""

    name: str
    group: str
    one: Direction
    other: Direction

    def of(self, joints: Array) -> Array:
        """Measure it (T,) in degrees in joints (T, 20, 3); NaN where a joint is missing."""
        one, other = (
            joints[:, end].mean(axis=1) - joints[:, start].mean(axis=1)
            for start, end in (self.one, self.other)
        )
        across = np.linalg.norm(np.cross(one, other), axis=1)
        return np.asarray(np.degrees(np.arctan2(across, np.sum(one * other, axis=1))))


@dataclass(frozen=True)
class ObservedPostures:
    """Somebody's recording: joints (T, 20, 3) in metres, right-handed, NaN where missing."""

    participant: str
    interaction: str
    joints: Array

    @classmethod
    def of(
        cls, participant: str, interaction: str, joints: Array, handedness: str
    ) -> ObservedPostures:
        """Take a recording; left-handed people are mirrored."""
        if handedness == "left":
            joints = mirror_joints(joints)
        return cls(participant, interaction, joints)


@dataclass(frozen=True)
class AngleSpread:
    """How an angle is spread over frames, in degrees.

    ``lowest`` and ``highest`` hold all but a share of the frames between them; ``between_people``
    is the standard deviation of people's medians, NaN of a single person. All are NaN where the
    angle was never seen.
    """

    lowest: float
    median: float
    highest: float
    between_people: float


def spread_of(
    angle: PostureAngle,
    recordings: Sequence[ObservedPostures],
    parameters: RealismParameters = DEFAULT_REALISM,
) -> AngleSpread:
    """Measure how an angle is spread over recordings."""
    by_person: dict[str, list[Array]] = {}
    for one in recordings:
        seen = angle.of(one.joints)
        by_person.setdefault(one.participant, []).append(seen[np.isfinite(seen)])
    people = [np.concatenate(parts) for parts in by_person.values()]
    people = [values for values in people if len(values)]
    if not people:
        return AngleSpread(np.nan, np.nan, np.nan, np.nan)
    aside = 0.5 * (1.0 - parameters.usual_share)
    lowest, median, highest = np.quantile(np.concatenate(people), (aside, 0.5, 1.0 - aside))
    medians = [float(np.median(values)) for values in people]
    between = float(np.std(medians, ddof=1)) if len(medians) > 1 else np.nan
    return AngleSpread(float(lowest), float(median), float(highest), between)


def share_within(
    angle: PostureAngle, recordings: Sequence[ObservedPostures], spread: AngleSpread
) -> float:
    """Give the share of frames in which an angle is within a spread; NaN where it is never seen."""
    values = np.concatenate([angle.of(one.joints) for one in recordings])
    seen = values[np.isfinite(values)]
    if not len(seen) or not np.isfinite(spread.median):
        return np.nan
    return float(np.mean((spread.lowest <= seen) & (seen <= spread.highest)))


def _joint(name: str, side: Literal["LEFT", "RIGHT"]) -> Place:
    return (Joint[f"{name}_{side}"],)


def _limb_angles(side: Literal["LEFT", "RIGHT"]) -> list[PostureAngle]:
    """Angles of one side between joints that all sources measure alike."""
    shoulder, elbow, wrist = (_joint(name, side) for name in ("SHOULDER", "ELBOW", "WRIST"))
    hip, knee, ankle = (_joint(name, side) for name in ("HIP", "KNEE", "ANKLE"))
    upper, fore, thigh, shank = (shoulder, elbow), (elbow, wrist), (hip, knee), (knee, ankle)
    other = _joint("SHOULDER", "LEFT" if side == "RIGHT" else "RIGHT")
    aside = (other, shoulder)
    name = side.lower()
    return [
        PostureAngle(f"{name} elbow, bend", LIMBS, upper, fore),
        PostureAngle(f"{name} upper arm from hanging", LIMBS, upper, _DOWN),
        PostureAngle(f"{name} upper arm from sideways", LIMBS, upper, aside),
        PostureAngle(f"{name} upper arm from the head", LIMBS, upper, _TO_HEAD),
        PostureAngle(f"{name} forearm from hanging", LIMBS, fore, _DOWN),
        PostureAngle(f"{name} forearm from sideways", LIMBS, fore, aside),
        PostureAngle(f"{name} thigh from the trunk's line", LIMBS, thigh, _DOWN),
        PostureAngle(f"{name} knee, bend", LIMBS, thigh, shank),
    ]


def _convention_angles(side: Literal["LEFT", "RIGHT"]) -> list[PostureAngle]:
    """Angles of one side at joints that each source places in its own way."""
    names = ("SHOULDER", "ELBOW", "WRIST", "HAND", "HIP", "KNEE", "ANKLE", "FOOT")
    shoulder, elbow, wrist, hand, hip, knee, ankle, foot = (_joint(one, side) for one in names)
    neck, spine, centre = (Joint.SHOULDER_CENTER,), (Joint.SPINE,), (Joint.HIP_CENTER,)
    pairs = (
        ("shoulder from Spine at ShoulderCenter", (neck, shoulder), (neck, spine)),
        ("hip from Spine at HipCenter", (centre, hip), (centre, spine)),
        ("wrist, bend", (elbow, wrist), (wrist, hand)),
        ("ankle, bend", (knee, ankle), (ankle, foot)),
    )
    return [PostureAngle(f"{side.lower()} {name}", CONVENTION, *pair) for name, *pair in pairs]


def _between(name: str, group: str, at: Place, one: Place, other: Place) -> PostureAngle:
    return PostureAngle(name, group, (at, one), (at, other))


def _middle_angles() -> list[PostureAngle]:
    neck, spine, centre = (Joint.SHOULDER_CENTER,), (Joint.SPINE,), (Joint.HIP_CENTER,)
    head = (Joint.HEAD,)
    sides = ((Joint.SHOULDER_LEFT,), (Joint.SHOULDER_RIGHT,))
    hips = ((Joint.HIP_LEFT,), (Joint.HIP_RIGHT,))
    return [
        PostureAngle("head from the trunk's line", LIMBS, _TO_HEAD, (_HIPS, _SHOULDERS)),
        PostureAngle("shoulders turned against hips", LIMBS, sides, hips),
        _between("between Spine and ShoulderCenter at HipCenter", CONVENTION, centre, spine, neck),
        PostureAngle("Spine, bend", CONVENTION, (centre, spine), (spine, neck)),
        PostureAngle("ShoulderCenter, bend", CONVENTION, (spine, neck), (neck, head)),
        _between("between the shoulders at ShoulderCenter", CONVENTION, neck, *sides),
        _between("between the hips at HipCenter", CONVENTION, centre, *hips),
    ]


_MIDDLE = _middle_angles()
POSTURE_ANGLES = (
    *_limb_angles("RIGHT"),
    *_limb_angles("LEFT"),
    *(one for one in _MIDDLE if one.group == LIMBS),
    *(one for one in _MIDDLE if one.group == CONVENTION),
    *_convention_angles("RIGHT"),
    *_convention_angles("LEFT"),
)
"""All angles that are compared, group by group."""
