"""Every number of a report's pictures that can be tuned: sizes and spacing, for reading comfort.

`inhand evaluate DATASET --report DIR` shows what they come to.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class ReportParameters:
    """The layout of pictures and plots."""

    dots_per_inch: int = 120
    """Resolution of plots and of tiled frames."""

    tile_columns: int = 4
    """Number of tracked frames side by side, as in the paper's figure 13."""
    tile_rows: int = 2
    """Number of rows of tracked frames."""
    tile_inches: float = 4.5
    """Length of a frame's longer side in inches."""
    heading_inches: float = 0.25
    """Height of a line of heading in inches."""
    margin_pixels: int = 25
    """Margin that is shown around body and object, in pixels of the camera."""
    paper_grey: int = 40
    """Grey level that is drawn on where a recording has no pixels, of 255."""
    jpeg_quality: int = 85
    """Quality of the JPEG file of tracked frames, of 100."""

    enlargement: int = 2
    """Factor by which an image is enlarged before it is drawn on."""
    sharp_edge_deg: float = 30.0
    """Angle in degrees between two faces beyond which the edge between them is drawn."""


DEFAULT_REPORT = ReportParameters()
