"""The numbers of capture that were chosen, but for those of its sources, estimation and faces."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PreviewParameters:
    """Decides how small previews are, and how many of them there are.

    A picture of 320 × 240 is 8 kB: at 5 Hz a viewer takes 40 kB/s, where frames take 5 MB/s.
    """

    longest_side: int = 320
    """Longest side of a preview at the most, pixels."""
    period_s: float = 0.2
    """Time between previews at the least, seconds."""
    quality: int = 75
    """Quality of its JPEG, 1 to 100."""


DEFAULT_PREVIEW = PreviewParameters()
