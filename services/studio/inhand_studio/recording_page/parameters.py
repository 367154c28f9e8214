"""Every number of the recording page that can be tuned; all were set by hand."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RecordingPageParameters:
    """Decides how a recording is begun and told of."""

    period_s: float = 0.2
    """Seconds between two looks at what is missing and at what the recording says."""
    lines_shown: int = 8
    """Number of newest lines of the recording that are shown."""
    countdown_s: float = 5.0
    """Seconds of the countdown, unless another number is set: to walk into the picture."""
    seconds: float = 20.0
    """Seconds of a recording, unless another number is set: an action done a few times."""
    longest_s: float = 3600.0
    """Seconds that can be set at the most for countdown and recording."""


DEFAULT_RECORDING_PAGE = RecordingPageParameters()
