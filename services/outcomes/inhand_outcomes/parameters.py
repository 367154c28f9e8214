"""The numbers by which messages are gathered; those of the measures stand beside them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GatheringParameters:
    """How much is kept of what comes, and what of it counts as seen."""

    least_confidence: float = 0.3
    """Confidence of a pose below which it is no evidence."""
    window_s: float = 60.0
    """Seconds of a track that the measures see at once: longer than any single act."""
    forgotten_at_once_s: float = 10.0
    """Seconds by which a track outgrows its window before what is too old is forgotten."""
    longest_gap_s: float = 3.0
    """Seconds without a pose after which a track ends: a tracker that lives says each frame how an
    object is, lost or not."""
    settle_s: float = 1.5
    """Seconds after its end at which an achievement is final: what comes later no longer changes
    it."""
    handed_within_m: float = 0.5
    """Distance between the last place in one person's hands and the first in another's up to which
    one handed it to the other, metres."""
    piece_s: float = 20.0
    """Seconds of what goes on after which they are counted, so that windows stay short."""
    frames_that_wait: int = 600
    """Number of frames whose people wait for the poses of the objects in their hands."""


DEFAULT_GATHERING = GatheringParameters()
