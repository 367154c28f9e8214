"""A learned mapping from body poses to object poses."""

from dataclasses import dataclass

import numpy as np

from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING


@dataclass(frozen=True)
class Mapping:
    """Training frames of S sequences, one after the other; sequence s is starts[s]:starts[s+1].

    ``participants`` (S,), ``starts`` (S + 1,), ``radii`` δ (S,), ``body_poses`` b (N, 60), the
    object relative to each part, in body heights, ``translations`` (N, 19, 3) and ``rotations``
    (N, 19, 4); ``translation_variation`` φᵉ and ``rotation_variation`` φᶿ (N,); and the parts
    that minimise ψᵉ, ψᶿ and ψ'ᵉ, each (N,). Everything is as of right-handed people.
    ``absent_joints`` were in no recording, and have stand-ins (``body.stand_ins``).
    ``convention`` names whose joints the bodies have; None where that was not said.
    """

    participants: tuple[str, ...]
    starts: Indices
    radii: Array
    body_poses: Array
    translations: Array
    rotations: Array
    translation_variation: Array
    rotation_variation: Array
    stable_translation_part: Indices
    stable_rotation_part: Indices
    proximate_part: Indices
    absent_joints: tuple[int, ...] = ()
    convention: str | None = None

    def sequence_of(self, frames: Indices) -> Indices:
        """The sequences that training frames belong to."""
        return np.searchsorted(self.starts, frames, side="right") - 1


def stretches(frames: int, longest: int = DEFAULT_MAPPING.longest_stretch) -> Indices:
    """The starts of the stretches of a sequence with a number of frames, and its end, (K + 1,).

    A frame's cluster is looked for in its own stretch: the whole sequence, where it is no longer
    than the longest, and otherwise one of equal parts. So a cluster stays small where somebody
    pauses for long, and is found as quickly in an hour as in a minute.
    """
    count = -(-frames // longest)
    return np.arange(count + 1) * frames // count
