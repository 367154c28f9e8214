"""The recordings that a model was learned from, kept so that it can be adapted to a user's own."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any

import numpy as np

from inhand_tracker.geometry.arrays import Array, Flags, Indices, Singles
from inhand_tracker.mapping.labelled_sequence import LabelledSequence


@dataclass(frozen=True)
class TaughtRecordings:
    """Frames (N,) of S recordings, one after the other; recording s is starts[s]:starts[s+1].

    ``joints`` (N, 20, 3), ``translations`` (N, 3) and ``rotations`` (N, 4) are those of
    ``LabelledSequence``, in single precision. ``left_handed`` and ``frame_rates`` are (S,), and
    ``names`` (S, 3) participants, recordings and conventions, "" where not said.
    """

    starts: Indices
    joints: Singles
    translations: Singles
    rotations: Singles
    left_handed: Flags
    frame_rates: Array
    names: Any

    @staticmethod
    def of(sequences: Sequence[LabelledSequence]) -> "TaughtRecordings":
        """Keep sequences."""
        lengths = [len(sequence.joints) for sequence in sequences]
        return TaughtRecordings(
            np.concatenate(([0], np.cumsum(lengths))),
            np.concatenate([one.joints for one in sequences]).astype(np.float32),
            np.concatenate([one.translations for one in sequences]).astype(np.float32),
            np.concatenate([one.rotations for one in sequences]).astype(np.float32),
            np.array([sequence.left_handed for sequence in sequences]),
            np.array([sequence.frame_rate for sequence in sequences]),
            np.array([[s.participant, s.recording, s.convention or ""] for s in sequences]),
        )

    def sequences(self) -> list[LabelledSequence]:
        """Give the sequences back, none of them as the user's own."""
        return [
            LabelledSequence(
                str(participant),
                bool(self.left_handed[number]),
                self.joints[start:end].astype(np.float64),
                self.translations[start:end].astype(np.float64),
                self.rotations[start:end].astype(np.float64),
                float(self.frame_rates[number]),
                str(convention) or None,
                str(recording),
            )
            for number, ((start, end), (participant, recording, convention)) in enumerate(
                zip(pairwise(self.starts), self.names, strict=True)
            )
        ]

    def arrays(self) -> dict[str, Any]:
        """Give the arrays by name, for a model's file."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @staticmethod
    def from_arrays(arrays: dict[str, Any]) -> "TaughtRecordings":
        """Put together what ``arrays`` took apart."""
        return TaughtRecordings(**arrays)
