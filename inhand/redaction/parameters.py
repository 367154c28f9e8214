"""Every number by which people are hidden in recordings that can be tuned.

``python tests/scenes/redacted_people.py`` shows what they do on simulated people.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class RedactionParameters:
    """Decides how much about a skeleton is hidden, for how long, and what may be somebody."""

    head_m: float = 0.26
    """Radius of what is hidden about a head, metres, as all of the following."""
    trunk_m: float = 0.20
    """About the lines between shoulders and hips, and all between them."""
    arm_m: float = 0.15
    leg_m: float = 0.18
    hand_m: float = 0.22
    """About hands and feet, in which things are held and worn."""
    beside_m: float = 0.25
    """How much farther about all of these that is hidden which is as far away as the trunk, since
    networks take the wrong place for a limb that something hides."""
    trunk_depth_m: float = 0.5
    """How much nearer or farther than the trunk that may be."""
    around_s: float = 0.15
    """Seconds before and after a picture whose people are hidden in it, too."""
    held_s: float = 1.0
    """Seconds before and after it instead, where somebody is found then who is not found in it."""
    samples: int = 40
    """Pictures of a camera, the most, by which its background is known."""
    behind: float = 0.75
    """Share of the distances that were measured in a pixel, without people, which lie before its
    background."""
    measured: float = 0.25
    """Share of the samples in which it was measured, from which it counts as measured."""
    margin_m: float = 0.05
    """How far before the background, in metres, something is new at the least."""
    margin_per_m2: float = 0.012
    """What comes to that with the distance's square, as the noise of depth does, per metre."""
    speckle: int = 5
    """Pixels of which something new is high and wide at the least."""
    new_m2: float = 0.02
    """Square metres from which something new may be of somebody: a hand and a wrist."""
    somebody_m2: float = 0.1
    """Square metres from which it may show a face, of somebody who was not found: a head and a
    chest."""
    unmeasured_m: float = 2.0
    """Distance of what nothing is known of, metres."""
    edge: float = 1.0 / 128.0
    """Widths of the picture by which all that is hidden is widened, as edges of depth and colour
    lie apart."""
    section_frames: int = 300
    """Pictures of a camera after which what was found in them, or their redacted copies, are
    brought to the disk, so that an interruption costs no more: half a minute's work."""


DEFAULT_REDACTION = RedactionParameters()
