"""Every number of the evaluation of recognition that can be tuned.

`inhand recognise DATASET` shows the measures that they define, with `--false-objects` those of
people who use nothing.
"""

from dataclasses import dataclass

from inhand_lab.world.idle_people import Idleness


@dataclass(frozen=True)
class RecognitionEvaluationParameters:
    """On whom false objects are counted, how boxes are measured, and how confusions are drawn."""

    idle_kinds: tuple[Idleness, ...] = ("stand", "walkOnSpot", "walkAbout", "gesture")
    """Kinds of people who use nothing, on whom false objects are counted."""
    idle_seed: int = 900
    """Seed of these people; others than those whom every recogniser learns from."""
    idle_people_by_movement: int = 10
    """Number of them, of each kind, where there are no images."""
    idle_people_with_images: int = 1
    """Number of them, of each kind, for each unseen participant, where there are images; each costs
    as long as a recording does."""

    moved_m: float = 0.12
    """Metres that an elbow or wrist moves against the hips where somebody is no longer still."""

    least_box_pixels: float = 8.0
    """Width and height in pixels to which a smaller first box is widened, because some adaptive
    trackers refuse one."""
    tall_quantile: float = 0.9
    """Quantile of a person's heights in the image that counts as the person's own: people stoop,
    and a few frames are wrong."""

    dots_per_inch: int = 120
    """Resolution of a picture of confusions."""
    frame_inches: float = 1.8
    """Length in inches of a matrix's side that titles and names take."""
    cell_inches: float = 0.62
    """Length of a cell's side in inches."""
    gap_inches: float = 0.12
    """Distance in inches between matrices."""
    least_shown_share: float = 0.005
    """Share of confusions from which it is written into its cell."""
    dark_share: float = 0.5
    """Share of confusions above which it is written in white on a dark cell."""


DEFAULT_RECOGNITION_EVALUATION = RecognitionEvaluationParameters()
