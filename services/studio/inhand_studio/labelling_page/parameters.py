"""Every number of the labelling page that can be tuned."""

from dataclasses import dataclass


@dataclass(frozen=True)
class LabellingPageParameters:
    """Decides how an object is moved by hand, and how it is shown."""

    fine_m: float = 0.001
    """Metres that a fine step moves the object: less than a pixel."""
    coarse_m: float = 0.01
    """Metres that a coarse step moves it."""
    fine_deg: float = 1.0
    """Degrees that a fine step turns it: less can hardly be seen."""
    coarse_deg: float = 10.0
    """Degrees that a coarse step turns it."""
    surface_m: float = 0.02
    """Metres that depth has to be before the object's surface to hide it: its own depth has noise,
    and a pose that is set by hand is a little off."""
    zoom_reach: float = 2.0
    """Part of a picture that is zoomed in: number of the object's radii above and below it."""
    deepest_m: float = 4.0
    """Depth in metres that has the last of the false colours; people stand nearer."""
    cloud_step: int = 2
    """Pixels from one point of the cloud to the next: all of them take seconds to send."""
    beside: float = 0.6
    """Angle in radians by which the 3-D view is turned about the object at first."""
    handles: float = 1.6
    """Size of the handles about the object in its radii."""
    retry_s: float = 2.0
    """Seconds until keyframes that could not be written are written again."""
    tick_s: float = 0.25
    """Seconds between looks at what others do, and at what runs in the background."""
    play_s: float = 0.01
    """Seconds between looks at the clock while it plays."""


DEFAULT_PAGE = LabellingPageParameters()
