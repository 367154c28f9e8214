"""Where the simulated skeleton tracker's noise is set.

The sizes of errors were fitted so that simulated people resemble the eight people of UTD-MHAD, who
were filmed by a Kinect (`inhand simulate --realism` prints both side by side). Their recordings
hold no confidences and no losses: what is assumed of these is in ``SkeletonReadingNoise``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

Four = tuple[float, float, float, float]


@dataclass(frozen=True)
class PerJoint:
    """A number for each of the twenty joints, the same on both sides.

    ``trunk`` is hip centre, spine, shoulder centre and head; ``arm`` goes from shoulder to hand and
    ``leg`` from hip to foot.
    """

    trunk: Four
    arm: Four
    leg: Four

    @property
    def column(self) -> Array:
        """The numbers (20, 1) in the order of Joint."""
        numbers = [*self.trunk, *self.arm, *self.arm, *self.leg, *self.leg]
        return np.array(numbers, float)[:, None]


@dataclass(frozen=True)
class PoseMistakes:
    """What a tracker takes joints wrongly by in the same way whenever the pose is the same."""

    deviations_mm: PerJoint = PerJoint((0, 5, 10, 0.8), (1.1, 20, 1.1, 13), (7.2, 13, 10, 6.3))
    """Deviation, along each axis and over all poses, of where a joint is taken to be,
    millimetres."""
    similar: PerJoint = PerJoint(
        (0.085, 0.096, 0.16, 0.18), (0.092, 0.051, 0.035, 0.04), (0.11, 0.005, 0.026, 0.04)
    )
    """Way that a joint must go, from the hips' point of view, to be mistaken otherwise, metres."""
    across: float = 0.10
    """Share of a hand's mistake that is across its bone: it is seen too short or too long rather
    than turned."""
    waves: int = 12
    """Number of random waves that a mistake is made of."""


@dataclass(frozen=True)
class WanderingErrors:
    """Errors that come and go with movement, in calm spells and busy ones."""

    deviations_mm: PerJoint = PerJoint(
        (5.5, 5.8, 16.5, 7.5), (10, 18.5, 6.7, 15.3), (8.3, 19, 10, 2.8)
    )
    """Deviation of a joint's error along each axis in movement, millimetres."""
    shared: float = 0.52
    """Share of the mean of all joints' movement that stirs each one."""
    most_stirred: float = 1.55
    """Speed that no joint seems to go beyond, m/s."""
    at_rest: float = 0.023
    """Share of its deviation that an error has at rest."""
    in_movement: float = 0.103
    """Speed at which an error has all of its deviation, m/s."""
    way: float = 4.6
    """Way over which an error is forgotten, metres."""
    creep: float = 0.043
    """Speed at which the tracker begins to take notice, m/s: slower counts for less."""
    memory_at_rest: float = 10.0
    """Time in which the error of a joint at rest is forgotten, seconds."""
    spell: float = 0.083
    """Correlation time of busy spells, seconds."""
    busyness: float = 7.0
    """Deviation of the logarithm of how fast errors are forgotten, relative to the median: they are
    calm or very busy, and hardly ever in between."""
    tails: float = 3.0
    """Degrees of freedom of Student's t, by which errors take steps: these have long tails."""
    inherited: PerJoint = PerJoint(
        (0, 0.25, 0.099, 0.33), (0.13, 0.16, 0.39, 0.25), (0.27, 0.25, 0.13, 0.39)
    )
    """Share of its parent's error that a joint has as well."""
    aside: PerJoint = PerJoint(
        (1.0, 0.028, 0.034, 0.16), (0.068, 0.052, 2, 0.57), (0.042, 0.047, 0.39, 0.18)
    )
    """Share of an error that is left across the bone: joints slide along limbs rather than off
    them, but for wrists."""


@dataclass(frozen=True)
class EndMisreadings:
    """How hands or feet, small as they are, are now and then seen turned or cut short."""

    rate: float
    """Number of misreadings a second."""
    turn: float
    """Deviation of the turn about each axis, radians."""
    stretch: float
    """Deviation of the logarithm of the bone's stretching."""
    stay: float = 0.04
    """Chance that one lasts on to the next frame."""


@dataclass(frozen=True)
class EpisodeNoise:
    """Errors that begin and end: ends misread, hands flipped, wrists lost."""

    hand: EndMisreadings = EndMisreadings(rate=5.3, turn=0.08, stretch=0.38)
    """Misreadings of hands."""
    foot: EndMisreadings = EndMisreadings(rate=8.4, turn=0.30, stretch=0.14)
    """Misreadings of feet."""
    flip_rate: float = 0.09
    """Number of flips a second of a hand at rest."""
    flip_rate_moving: float = 0.28
    """Number of flips a second that each metre a second of the hand adds."""
    flip_stay: float = 0.22
    """Chance that a flip lasts on to the next frame."""
    failure_rate: float = 2.4
    """Number of failures of a wrist a second, for each metre a second above ``calm``."""
    calm: float = 0.2
    """Speed of a wrist below which it never fails, m/s."""
    wild: float = 0.6
    """Speed of a wrist above which it fails no more often, m/s."""
    failure_stay: float = 0.5
    """Chance that a failure lasts on to the next frame."""
    stuck_share: float = 0.4
    """Share of failures in which the wrist stays behind; in the others it leaves the arm."""
    astray: float = 0.115
    """Deviation along each axis of a wrist that has left its arm, metres."""


@dataclass(frozen=True)
class SkeletonReadingNoise:
    """What a tracker guesses, loses and believes; assumed, for no recording shows it."""

    seen_hand: float = 0.85
    """Share of the way from wrist to palm at which a hand is put: short of the palm."""
    seen_foot: float = 0.5
    """Share of the way from ankle to ball at which a foot is put: on the instep."""
    guess_factor: float = 3.0
    """Factor on the error of an inferred joint."""
    hesitation: float = 0.08
    """Time constant of going over from seeing to guessing, seconds."""
    clearance: float = 0.05
    """Distance in front of a joint from which a limb hides it, metres."""
    cover: float = 0.8
    """Share of a limb's radius within which it hides what is behind it."""
    seconds_between_losses: float = 120.0
    """Mean time between losses of the whole person, seconds."""
    seconds_lost: float = 0.25
    """Mean time for which the person is lost, seconds."""
    confidence: float = 0.95
    """Mean confidence of a joint that is seen where it is."""
    confidence_less_guessed: float = 0.40
    """Confidence that an inferred joint loses."""
    confidence_less_surprise: float = 0.35
    """Confidence that a joint with an error of ``surprise`` or more loses."""
    surprise: float = 0.05
    """Error that the tracker is most surprised by, metres."""
    confidence_deviation: float = 0.08
    """Deviation of confidences from what the error is worth."""
    least_confidence: float = 0.05
    """Confidence below which none falls while the person is seen."""


@dataclass(frozen=True)
class SkeletonFilter:
    """The usual settings of Microsoft's filter (Azimi, 2012; see skeleton_filter.py)."""

    smoothing: float = 0.5
    """Share of the predicted joint in the filtered one."""
    correction: float = 0.5
    """Share of the newest step in the trend."""
    prediction: float = 0.5
    """Number of frames that is predicted ahead."""
    jitter_radius: float = 0.05
    """Deviation within which the filter is reluctant, metres; twice as much for an inferred joint,
    as is ``deviation_radius``."""
    deviation_radius: float = 0.04
    """Distance of a filtered joint from the measured one at the most, metres."""


@dataclass(frozen=True)
class SkeletonNoise:
    """All that a simulated skeleton tracker does to true joints."""

    mistakes: PoseMistakes = PoseMistakes()
    wandering: WanderingErrors = WanderingErrors()
    episodes: EpisodeNoise = EpisodeNoise()
    reading: SkeletonReadingNoise = SkeletonReadingNoise()
    filter: SkeletonFilter = SkeletonFilter()
