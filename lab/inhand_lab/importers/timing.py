"""Times of an import's frames."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from inhand_lab.datasets.dataset import START_NS, DatasetError


@dataclass(frozen=True)
class Timing:
    """Every ``step``-th of the frames that were recorded at ``recorded_rate`` Hz."""

    recorded_rate: float
    step: int

    @property
    def frame_rate(self) -> float:
        """Rate of the frames that are kept, in Hz."""
        return self.recorded_rate / self.step

    def time_ns(self, index: int) -> int:
        """Return when the kept frame of that index was taken, to the nanosecond below."""
        return START_NS + int(index * self.step * 1_000_000_000 / Fraction(self.recorded_rate))


def thin(source: Path, recorded_rate: float, frame_rate: float) -> Timing:
    """Keep every k-th frame, to get ``frame_rate`` Hz; nothing is interpolated.

    Raises DatasetError when that cannot be done.
    """
    step = round(recorded_rate / frame_rate) if frame_rate > 0.0 else 0
    if step < 1 or abs(recorded_rate - step * frame_rate) > 1e-6 * recorded_rate:
        raise DatasetError(
            f"{source} was recorded at {recorded_rate:g} Hz, and no whole number of its frames "
            f"makes {frame_rate:g} Hz: give --frame-rate {recorded_rate:g}, or a half of it, or a "
            "third, …"
        )
    return Timing(recorded_rate, step)
