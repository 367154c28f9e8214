"""Every number of the demonstration that can be tuned; `inhand demo` shows what they come to."""

from dataclasses import dataclass


@dataclass(frozen=True)
class DemonstrationParameters:
    """Who is simulated to be learned from, and who is met afterwards."""

    seed: int = 7
    """Seed of the simulated people."""
    trained_participants: int = 12
    """Number of people who are learned from: as many as are learned within seconds."""
    trained_frames: int = 360
    """Number of frames that each of them is learned from: 12 s, the paper's length of a
    sequence."""
    unseen_participant: int = 100
    """The number of the person who is tracked: beyond those of the people who are learned from."""
    picture_candidates: int = 30
    """Number of frames, from the one of the median error on, among which one is looked for that was
    recorded with its image and its skeletons."""


DEFAULT_DEMONSTRATION = DemonstrationParameters()
