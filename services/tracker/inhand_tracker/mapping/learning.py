"""Learning from labelled sequences (Darby et al. 2014, TR1 to TR3).

Each training frame is measured: how much the object's pose varies among frames of like body pose
(a low variation is a good moment to re-initialise), and how stable and how close the object is
relative to each of the 19 parts.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Literal

import numpy as np
from inhand_runtime.wording import counted

from inhand_tracker.body.convention_table import shared_convention
from inhand_tracker.body.skeleton import (
    body_pose,
    part_bases,
    pelvis_basis,
    stature_of,
)
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.mapping.measures import Measures, RelativePoses, measure_sequence
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING, MappingParameters
from inhand_tracker.mapping.radii import cluster_radii

Stage = Literal["relative poses", "cluster radii", "clusters"]
STAGES: tuple[Stage, ...] = ("relative poses", "cluster radii", "clusters")
"""The stages of learning, in their order; each goes through all sequences."""

PIECE = 8192
"""Number of frames that are made relative to the parts at once, to bound the memory."""


class UnusableSequenceError(ValueError):
    """A sequence, or a set of them, that nothing can be learned from."""


def learn(
    sequences: Sequence[LabelledSequence],
    mirror_normal: Array,
    on_sequence: Callable[[Stage], None] = lambda stage: None,
    parameters: MappingParameters = DEFAULT_MAPPING,
    absent_joints: tuple[int, ...] = (),
) -> Mapping:
    """Learn a mapping; left-handed people are mirrored, so that every mapping is right-handed.

    ``mirror_normal`` (3,) is the object's (``ObjectShape``); ``on_sequence`` is called when a
    stage is done with a sequence. ``absent_joints`` are those that have stand-ins in all sequences.
    Raises UnusableSequenceError.

    Time and memory grow with the number of frames. Exact up to 20,000 frames in sequences of up
    to 2,048 (``parameters``); beyond, radii and clusters come from a part of the frames
    (``cluster_radii``, ``stretches``).
    """
    if len(sequences) < 2:
        raise UnusableSequenceError(
            f"learning compares sequences, and there is {len(sequences)}: two are the least"
        )
    participants = tuple(sequence.participant for sequence in sequences)
    poses, starts = _relative_poses(sequences, mirror_normal, on_sequence)
    radii = cluster_radii(
        poses.body_poses, starts, participants, lambda: on_sequence("cluster radii"), parameters
    )
    longest = parameters.longest_stretch
    measures = _measures(poses, starts, radii, longest, lambda: on_sequence("clusters"))
    return Mapping(
        participants=participants,
        starts=starts,
        radii=radii,
        body_poses=poses.body_poses,
        translations=poses.translations,
        rotations=poses.rotations,
        absent_joints=absent_joints,
        convention=shared_convention(sequence.convention for sequence in sequences),
        **vars(measures),
    )


def _relative_poses(
    sequences: Sequence[LabelledSequence],
    mirror_normal: Array,
    on_sequence: Callable[[Stage], None],
) -> tuple[RelativePoses, Indices]:
    """TR1 of all usable frames, one sequence after the other, and the starts (S + 1,)."""
    poses = RelativePoses.empty(sum(len(sequence.joints) for sequence in sequences))
    starts, end = [0], 0
    for sequence in sequences:
        for piece in _pieces(sequence, mirror_normal):
            start, end = end, end + len(piece.body_poses)
            poses.put(slice(start, end), piece)
        starts.append(end)
        on_sequence("relative poses")
    return poses.rows(slice(0, end)), np.array(starts)


def _pieces(sequence: LabelledSequence, mirror_normal: Array) -> Iterator[RelativePoses]:
    """TR1 of the usable frames of a sequence, in pieces that need little memory."""
    sequence = sequence.right_handed(mirror_normal)
    joints, translations = sequence.joints, sequence.translations
    height = stature_of(joints)
    with np.errstate(invalid="ignore", divide="ignore"):
        pelvis = pelvis_basis(joints)
    poses = body_pose(joints, pelvis, height)
    usable = np.flatnonzero(
        np.isfinite(poses).all(axis=1)
        & np.isfinite(pelvis.rotations).all(axis=1)
        & np.isfinite(translations).all(axis=1)
        & np.isfinite(sequence.rotations).all(axis=1)
    )
    if len(usable) < 2:
        raise UnusableSequenceError(
            f"a sequence of participant {sequence.participant!r} has "
            f"{counted(len(usable), 'frame')} in which the whole body and the "
            "object's label are known: two are the least"
        )
    consecutive = np.append(np.diff(usable) == 1, False)
    for start in range(0, len(usable), PIECE):
        frames = usable[start : start + PIECE]
        bases = part_bases(joints[frames], pelvis_basis(joints[frames]))
        relative_translations, relative_rotations = bases.from_camera(
            translations[frames, None, :], sequence.rotations[frames, None, :]
        )
        yield RelativePoses(
            poses[frames],
            relative_translations / height,
            relative_rotations,
            consecutive[start : start + PIECE],
        )


def _measures(
    poses: RelativePoses,
    starts: Indices,
    radii: Array,
    longest_stretch: int,
    on_sequence: Callable[[], None],
) -> Measures:
    """TR2 and TR3 of all frames."""
    measures = Measures.empty(len(poses.body_poses))
    for (start, end), radius in zip(pairwise(starts), radii, strict=True):
        sequence = poses.rows(slice(start, end))
        for rows, of_stretch in measure_sequence(sequence, radius, longest_stretch):
            measures.put(slice(start + rows.start, start + rows.stop), of_stretch)
        on_sequence()
    return measures
