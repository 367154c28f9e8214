"""Every number of the studio that can be tuned."""

from dataclasses import dataclass


@dataclass(frozen=True)
class StudioParameters:
    """Decides how a rig is shown in a browser."""

    eye_height: int = 600
    """Number of pixels from top to bottom of what a browser gets of a camera's image."""
    jpeg_quality: int = 85
    """Quality, to 100, of the images that browsers get; beyond it they only get larger."""
    pivot_m: float = 2.0
    """Distance in metres of the point about which a whole view turns: people stand about there."""
    same_place_m: float = 1e-3
    """Metres from the camera within which a browser looks through it."""
    same_direction_rad: float = 1e-3
    """Angle in radians from the camera's view of the same: a pixel or less."""
    same_aspect: float = 0.01
    """Share by which a window's form may change until the image is cut anew."""
    answer_s: float = 5.0
    """Seconds without a browser's answer after which it gets another picture all the same."""
    answers_apart: float = 1.5
    """Times that a browser's answer took, from one picture to the next: it unpacks meanwhile."""
    unseen_turn: float = 2e-5
    """Share by which a browser's angle of view is changed to make it answer: a hundredth of a
    pixel, and twice what is taken for no change."""
    unmeasured_m: float = 100.0
    """Depth in metres, beyond any room, of pixels for which none was measured."""


DEFAULT_STUDIO = StudioParameters()
