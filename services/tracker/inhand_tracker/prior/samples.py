"""Samples that a prior is learned from: described bodies, and the object in each anchor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inhand_tracker.body.anchors import ANCHORS, Anchors, find_anchors
from inhand_tracker.body.skeleton import has_pelvis, stature_of
from inhand_tracker.body.window import (
    VIEWS,
    describe_bodies,
    earlier_frames,
    remember_places,
    trunk_places,
)
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags, Indices, Singles
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.shape.shape import ObjectShape


@dataclass(frozen=True)
class Samples:
    """The usable frames (N,) of all sequences; those of one of ``groups`` are held out together.

    ``centres`` (N, 3) and ``rotations`` (N, 3, 3) of the object are in the camera frame of
    right-handed people, ``times`` (N,) in seconds from the sequence's start; ``own`` (N,) flags
    those by which a model of others is adapted.
    """

    descriptions: list[Singles]
    targets: Singles
    anchors: Anchors
    heights: Array
    centres: Array
    rotations: Array
    groups: Indices
    sequences: Indices
    times: Array
    own: Flags

    def weights(self) -> Array:
        """Give each sample (N,) its weight in a mean; they sum to 1. Where some are the user's
        ``own``, these weigh as much as all others: one person of theirs says as much of the next
        real one as all simulated people."""
        count = int(self.own.sum())
        if count in (0, len(self.own)):
            return np.full(len(self.own), 1.0 / len(self.own))
        return np.where(self.own, 0.5 / count, 0.5 / (len(self.own) - count))

    @staticmethod
    def joined(parts: "Sequence[Samples]") -> "Samples":
        """The samples of parts, one after the other."""
        return Samples(
            descriptions=[
                np.concatenate([part.descriptions[view] for part in parts]) for view in range(VIEWS)
            ],
            anchors=Anchors(
                np.concatenate([part.anchors.origins for part in parts]),
                np.concatenate([part.anchors.axes for part in parts]),
            ),
            **{name: np.concatenate([getattr(part, name) for part in parts]) for name in _ROWS},
        )

    def take(self, rows: Indices) -> "Samples":
        """The samples with these indices, in this order."""
        return Samples(
            descriptions=[description[rows] for description in self.descriptions],
            anchors=Anchors(self.anchors.origins[rows], self.anchors.axes[rows]),
            **{name: getattr(self, name)[rows] for name in _ROWS},
        )


_ROWS = ("targets", "heights", "centres", "rotations", "groups", "sequences", "times", "own")
"""Names of the samples' plain arrays."""


def units_of(sequences: Sequence[LabelledSequence]) -> int:
    """Count what differs as the next one to be followed will: people, or of one person recordings.

    Stretches of one recording are one: nobody knows of it how another begins.
    """
    people = {sequence.participant for sequence in sequences}
    if len(people) > 1:
        return len(people)
    named = {sequence.recording for sequence in sequences if sequence.recording}
    return len(named) + sum(not sequence.recording for sequence in sequences)


def samples_of(
    sequences: Sequence[LabelledSequence], shape: ObjectShape, centre: Array, groups: int
) -> Samples:
    """Take the samples of sequences of an object whose marked vertices have a ``centre`` (3,)."""
    names = dict.fromkeys(sequence.participant for sequence in sequences)
    owners = {name: number for number, name in enumerate(names)}
    parts = []
    for number, sequence in enumerate(sequences):
        group = (number if len(owners) == 1 else owners[sequence.participant]) % groups
        parts.append(_samples_of(sequence, shape, centre, group, number))
    return Samples.joined(parts)


def _samples_of(
    sequence: LabelledSequence, shape: ObjectShape, centre: Array, group: int, number: int
) -> Samples:
    """The usable frames of the sequence of a number, which is held out with a group."""
    usable = _usable_frames(sequence)
    right_handed = sequence.right_handed(shape.mirror_normal)
    joints = right_handed.joints[usable]
    height = stature_of(joints)
    turns = rotations.to_matrix(right_handed.rotations[usable])
    centres = right_handed.translations[usable] + turns @ centre
    anchors = find_anchors(joints)
    times = usable / sequence.frame_rate
    remembered = remember_places(trunk_places(joints, height), times, 1.0 / sequence.frame_rate)
    earlier = joints[earlier_frames(usable, sequence.frame_rate)]
    return Samples(
        describe_bodies(joints, earlier, remembered, height),
        _targets(anchors, centres, turns, height),
        anchors,
        np.full(len(usable), height),
        centres,
        turns,
        np.full(len(usable), group),
        np.full(len(usable), number),
        times,
        np.full(len(usable), sequence.own),
    )


def _usable_frames(sequence: LabelledSequence) -> Indices:
    """The frames in which the whole body and the object's label are known."""
    return np.flatnonzero(
        np.isfinite(sequence.joints).all(axis=(1, 2))
        & np.isfinite(sequence.translations).all(axis=1)
        & np.isfinite(sequence.rotations).all(axis=1)
        & (np.linalg.norm(sequence.rotations, axis=1) > 0.0)
        & np.array([has_pelvis(frame) for frame in sequence.joints])
    )


def _targets(anchors: Anchors, centres: Array, turns: Array, height: float) -> Singles:
    """What regressions shall predict, (N, A * 12): the object in each anchor."""
    away = np.einsum("taji,taj->tai", anchors.axes, centres[:, None] - anchors.origins) / height
    within = np.swapaxes(anchors.axes, -1, -2) @ turns[:, None]
    targets = np.concatenate([away, within.reshape(len(turns), len(ANCHORS), 9)], axis=-1)
    return targets.reshape(len(turns), -1).astype(np.float32)
