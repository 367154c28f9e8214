"""Conventions of other skeletons as tables: where each of our twenty joints lies by theirs.

An entry is a weighted mean of joints of the convention, or a place ahead of one. Both move with the
body as its joints do: however somebody stands or is turned, they are the same place in them.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray

from inhand_lab.importers.parameters import DEFAULT_IMPORT

States = NDArray[np.uint8]
MISSING, INFERRED, TRACKED = 0, 1, 2
NAVEL_SHARE = 1.0 / 3.0
"""Place of a navel on the way from the pelvis to the neck, in the skeleton that ZED's SDK fits;
Azure Kinect's is like it."""


@dataclass(frozen=True)
class JointMean:
    """A place in the body: joints by name, with weights that sum to 1.

    It is as well tracked as the worst of its joints. Where ``inferred`` it is at the best inferred:
    the convention lacks the joint, and others stand in for it.
    """

    weights: Mapping[str, float]
    inferred: bool = False


@dataclass(frozen=True)
class JointAhead:
    """A place ahead of a joint, as the body faces, by a share of the trunk; always inferred.

    ``hips`` and ``shoulders`` are the convention's names, left before right.
    """

    joint: str
    share: float
    hips: tuple[str, str]
    shoulders: tuple[str, str]


Place = JointMean | JointAhead
Candidates = tuple[Place, ...]
"""Places for one joint; the first whose joints are all there is taken."""


@dataclass(frozen=True)
class JointTable:
    """A convention: its ``name``, its joints in the order of its files, and ours by them.

    A joint of ours that has no candidates is always missing. From the first place of ``front`` to
    the second is forwards. ``convention`` is its name in messages.
    """

    name: str
    convention: str
    joints: tuple[str, ...]
    candidates: Mapping[Joint, Candidates]
    front: tuple[JointMean, JointMean]


@dataclass(frozen=True)
class JointSets:
    """Joints of N bodies: ``places`` (N, J, 3), NaN where missing; states, confidences (N, J)."""

    places: Array
    states: States
    confidences: Array

    def chosen(self, bodies: NDArray[np.bool_]) -> "JointSets":
        """Return those of the bodies (N,) that are true."""
        return JointSets(self.places[bodies], self.states[bodies], self.confidences[bodies])


def at(name: str) -> Candidates:
    """The joint of that name, as it is."""
    return (JointMean({name: 1.0}),)


def middle(first: str, second: str) -> Candidates:
    """The middle between two joints."""
    return (JointMean({first: 0.5, second: 0.5}),)


def along_trunk(share: float, pelvis: str, spine: str, spine_share: float) -> Candidates:
    """The place at a share of the way from the hips to the base of the neck.

    ``pelvis`` lies between the hips, ``spine`` at ``spine_share`` of that way.
    """
    weight = share / spine_share
    return (JointMean({pelvis: 1.0 - weight, spine: weight}),)


def trunk(pelvis: str, spine: str, neck: str, spine_share: float) -> dict[Joint, Candidates]:
    """The trunk's three middle joints by a pelvis, one joint of the spine and the neck's base."""
    hip_centre, back = DEFAULT_IMPORT.hip_centre_share, DEFAULT_IMPORT.spine_share
    return {
        Joint.HIP_CENTER: along_trunk(hip_centre, pelvis, spine, spine_share),
        Joint.SPINE: along_trunk(back, pelvis, spine, spine_share),
        Joint.SHOULDER_CENTER: at(neck),
    }


def limbs(name_of: Callable[[str, str], str]) -> dict[Joint, Candidates]:
    """Joints of both sides that the convention has as we do.

    ``name_of`` makes the convention's name of a joint and a side, as of SHOULDER and LEFT.
    """
    joints = ("SHOULDER", "ELBOW", "WRIST", "HAND", "HIP", "KNEE", "ANKLE", "FOOT")
    return {
        Joint[f"{joint}_{side}"]: at(name_of(joint, side))
        for side in ("LEFT", "RIGHT")
        for joint in joints
    }


def limb_names(name_of: Callable[[str, str], str]) -> tuple[str, ...]:
    """Names of the limbs' joints, in the order of those conventions that begin an arm at the
    clavicle; ``name_of`` as in ``limbs``."""
    arm = ("CLAVICLE", "SHOULDER", "ELBOW", "WRIST", "HAND", "HANDTIP", "THUMB")
    leg = ("HIP", "KNEE", "ANKLE", "FOOT")
    sides = ("LEFT", "RIGHT")
    return tuple(name_of(joint, side) for limb in (arm, leg) for side in sides for joint in limb)


def feet(name_of: Callable[[str, str], str]) -> tuple[JointMean, JointMean]:
    """The front of a convention with feet: from the middle of the ankles to that of the feet."""
    ankles, toes = (
        JointMean({name_of(joint, side): 0.5 for side in ("LEFT", "RIGHT")})
        for joint in ("ANKLE", "FOOT")
    )
    return ankles, toes


def our_joints(table: JointTable, theirs: JointSets) -> JointSets:
    """Give our twenty joints of N bodies whose joints are in the order of the table's."""
    count = len(theirs.places)
    ours = JointSets(
        np.full((count, len(Joint), 3), np.nan),
        np.zeros((count, len(Joint)), np.uint8),
        np.zeros((count, len(Joint))),
    )
    for joint, candidates in table.candidates.items():
        _take_first(ours, joint, [_place(table, theirs, one) for one in candidates])
    return ours


def forward_directions(table: JointTable, theirs: JointSets) -> Array:
    """Return (N, 3) directions that point forwards of N bodies, NaN where they are not seen."""
    behind, before = (_mean(table, theirs, place).places for place in table.front)
    return before - behind


def _mean(table: JointTable, theirs: JointSets, mean: JointMean) -> JointSets:
    columns = [table.joints.index(name) for name in mean.weights]
    weights = np.array(list(mean.weights.values()))
    places = np.einsum("j,njk->nk", weights, theirs.places[:, columns])
    states = theirs.states[:, columns].min(axis=1)
    states[~np.isfinite(places).all(axis=1)] = MISSING
    if mean.inferred:
        states = np.minimum(states, INFERRED)
    return JointSets(places, states.astype(np.uint8), theirs.confidences[:, columns].min(axis=1))


def _place(table: JointTable, theirs: JointSets, place: Place) -> JointSets:
    return (
        _mean(table, theirs, place)
        if isinstance(place, JointMean)
        else _ahead(table, theirs, place)
    )


def _ahead(table: JointTable, theirs: JointSets, ahead: JointAhead) -> JointSets:
    hips, shoulders = (
        theirs.places[:, [table.joints.index(name) for name in pair]]
        for pair in (ahead.hips, ahead.shoulders)
    )
    upwards = shoulders.mean(axis=1) - hips.mean(axis=1)
    left = shoulders[:, 0] - shoulders[:, 1] + hips[:, 0] - hips[:, 1]
    forwards = np.cross(left, upwards)
    with np.errstate(invalid="ignore", divide="ignore"):  # of a body of no width: NaN is missing
        forwards /= np.linalg.norm(forwards, axis=1, keepdims=True)
    trunk_length = np.linalg.norm(upwards, axis=1, keepdims=True)
    joint = _mean(table, theirs, JointMean({ahead.joint: 1.0}, inferred=True))
    places = joint.places + ahead.share * trunk_length * forwards
    states = np.where(np.isfinite(places).all(axis=1), joint.states, MISSING).astype(np.uint8)
    return JointSets(places, states, joint.confidences)


def _take_first(ours: JointSets, joint: Joint, candidates: Sequence[JointSets]) -> None:
    """Set one of our joints to the first candidate that is not missing, body by body."""
    for candidate in reversed(candidates):
        there = candidate.states != MISSING
        ours.places[there, joint] = candidate.places[there]
        ours.states[there, joint] = candidate.states[there]
        ours.confidences[there, joint] = candidate.confidences[there]
