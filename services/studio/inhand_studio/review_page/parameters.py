"""Every number of the review page that can be tuned."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ReviewParameters:
    """Decides how a recording is played, and how its errors are drawn."""

    tick_s: float = 0.01
    """Seconds between two looks at whether another frame is wanted, and the tab is ready for it."""
    idle_s: float = 0.05
    """The same while nothing plays: a slider that is dragged is followed twenty times a second."""
    progress_s: float = 0.5
    """Seconds between two writings of how far something is that takes long."""
    columns: int = 600
    """Number of columns of the plot: the greatest error of the frames of each is drawn."""
    plot_share: float = 0.98
    """Share of the errors that the plot's height holds: a lost track must not flatten the rest."""
    least_height_m: float = 0.02
    """Metres of error that the plot's height holds at the least."""
    frames_at_once: int = 4096
    """Number of frames whose errors are computed at once, to bound the memory."""


DEFAULT_REVIEW = ReviewParameters()
