"""People who differ as people do: stature, proportions, handedness and manner of moving.

Statures follow ANSUR II (Gordon et al., 2014: women 1.628 +- 0.064 m, men 1.756 +- 0.069 m)
within 1.50 to 1.95 m. Segment lengths are fractions of stature after Drillis & Contini (1966), as
tabled in Winter, *Biomechanics and Motor Control of Human Movement*. Where a Kinect joint is not
an anatomical landmark (hip centre, spine, shoulder centre, palm) the fraction is the mean over
the eight people of UTD-MHAD. One person in ten is left-handed (Papadatou-Pastou et al., 2020).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import Literal, get_args

import numpy as np

from inhand_lab.people.parameters import (
    DEFAULT_CARRIAGES,
    USUAL_MANNERS,
    VARIED_MANNERS,
    CarriageSpread,
    MannerSpread,
    Spread,
)

People = Literal["usual", "varied"]
PEOPLE: tuple[People, ...] = get_args(People)
"""Kinds of simulated people: those who carry themselves alike and use a thing without a break, and
those who differ in that, too."""
USUAL_PEOPLE: People = "usual"
"""People of a world that names none."""

HEIGHT_MEAN_AND_DEVIATION = {"female": (1.628, 0.064), "male": (1.756, 0.069)}
"""Mean and deviation of statures, metres."""
HEIGHT_RANGE = (1.50, 1.95)
"""Statures that occur, metres."""
LEFT_HANDED_SHARE = 0.1
"""Share of people who are left-handed."""
SEGMENT_DEVIATION = 0.035
"""Deviation of a segment's length from its fraction of stature, as a share of it."""
HEAD_REFERENCE, HEAD_CONSTANCY = 1.70, 0.7
"""Heads differ less than statures: their fractions hold at 1.70 m and fall with taller people."""


@dataclass(frozen=True)
class Proportions:
    """Lengths in metres; the defaults are fractions of stature and make a person of 1 m."""

    upper_arm: float = 0.186
    forearm: float = 0.146
    palm: float = 0.045
    """Wrist to the middle of the palm, where a Kinect sees the hand."""
    thigh: float = 0.245
    shank: float = 0.246
    ankle: float = 0.039
    """Height of the ankle above the floor."""
    foot: float = 0.095
    """Ankle to the ball of the foot, along the floor."""
    hip_half_width: float = 0.052
    hip_drop: float = 0.040
    """Hip joints below the hip centre."""
    spine: float = 0.050
    """Hip centre to spine."""
    chest: float = 0.222
    """Spine to shoulder centre."""
    shoulder_half_width: float = 0.108
    shoulder_drop: float = 0.022
    """Shoulder joints below the shoulder centre."""
    neck: float = 0.112
    """Shoulder centre to the middle of the head."""
    head_half_width: float = 0.043
    head_half_depth: float = 0.056
    head_half_height: float = 0.068


@dataclass(frozen=True)
class Manner:
    """How somebody moves and holds things: constant within a person, different between people."""

    tempo: float
    """Speed of movement; 1 is average."""
    amplitude: float
    """Size of free gestures; 1 is average."""
    stoop: float
    """Habitual forward lean of the trunk, radians."""
    head_pitch: float
    """Habitual pitch of the head, radians, positive up."""
    elbow_flare: float
    """Preferred swivel of the elbow away from hanging straight down, radians."""
    sway: float
    """Standard deviation of postural sway at the hips, metres."""
    restlessness: float
    """Size of pauses and of differences between repetitions; 1 is average."""
    grip_slide: float
    """Where along a handle the hand takes hold, -1 to 1."""
    grip_turn: float
    """Turn of a held object about its handle, radians: no skeleton shows it."""
    grip_tilt: float
    """Oblique angle of a handle across the palm, radians."""


@dataclass(frozen=True)
class Carriage:
    """How somebody holds the body, constant within a person; the defaults are usual people's."""

    head_aside: float = 0.0
    """Habitual tilt of the head to the right, radians."""
    head_forward: float = 0.0
    """Habitual lean of the neck forward, beyond the usual, radians."""
    shoulders_up: float = 0.0
    """Height at which shoulders are carried above the usual, in statures."""
    shoulders_forward: float = 0.0
    """Distance by which shoulders are carried forward, in statures."""
    stance_width: float = 1.0
    """Distance of the feet over what is usual for the task."""
    toes_out: float = 0.15
    """Turn of each foot outwards, radians."""
    foot_ahead: float = 0.0
    """Distance by which the right foot is ahead of the left, in statures."""
    weight_aside: float = 0.0
    """Distance by which the hips are nearer to the right foot, in statures."""


@dataclass(frozen=True)
class SimulatedPerson:
    """One participant: body, handedness and manner; girth scales every thickness, 1 is average."""

    sex: Literal["female", "male"]
    height: float
    handedness: Literal["left", "right"]
    proportions: Proportions
    girth: float
    manner: Manner
    appearance: int
    """Seed of skin, hair and clothes."""
    carriage: Carriage = Carriage()
    varied: bool = False
    """Whether they are of the varied people."""


def sample_person(seed: int, participant: int, people: People = USUAL_PEOPLE) -> SimulatedPerson:
    """The participant of that number in the world of that seed: always the same person.

    The body is the same in all kinds of people.
    """
    varied = people == "varied"
    random = np.random.default_rng([seed, participant, 0x9E12])
    sex: Literal["female", "male"] = "female" if random.random() < 0.5 else "male"
    mean, deviation = HEIGHT_MEAN_AND_DEVIATION[sex]
    height = float(np.clip(random.normal(mean, deviation), *HEIGHT_RANGE))
    return SimulatedPerson(
        sex=sex,
        height=height,
        handedness="left" if random.random() < LEFT_HANDED_SHARE else "right",
        proportions=_sample_proportions(height, random),
        girth=float(np.clip(random.normal(1.0, 0.1), 0.8, 1.25)),
        manner=_sample_manner(random, VARIED_MANNERS if varied else USUAL_MANNERS),
        appearance=int(random.integers(2**31)),
        carriage=_sample_carriage(np.random.default_rng([seed, participant, 0x4AB17]))
        if varied
        else Carriage(),
        varied=varied,
    )


def _sample_proportions(height: float, random: np.random.Generator) -> Proportions:
    """Varied segments, brought to the stature: the vertical chain must add up to the height."""
    varied = {
        name: fraction * float(np.clip(random.normal(1.0, SEGMENT_DEVIATION), 0.9, 1.1))
        for name, fraction in vars(Proportions()).items()
    }
    for name in ("head_half_width", "head_half_depth", "head_half_height"):
        varied[name] *= (HEAD_REFERENCE / height) ** HEAD_CONSTANCY
    relative = Proportions(**varied)
    scale = height / stature_of(relative)
    return Proportions(**{name: fraction * scale for name, fraction in varied.items()})


def _sample_manner(random: np.random.Generator, spread: MannerSpread) -> Manner:
    around = partial(_around, random)

    return Manner(
        tempo=math.exp(around(spread.tempo)),
        amplitude=math.exp(around(spread.amplitude)),
        stoop=around(spread.stoop),
        head_pitch=around(spread.head_pitch),
        elbow_flare=around(spread.elbow_flare),
        sway=abs(around(spread.sway)),
        restlessness=math.exp(around(spread.restlessness)),
        grip_slide=around(spread.grip_slide),
        grip_turn=around(spread.grip_turn),
        grip_tilt=around(spread.grip_tilt),
    )


def _sample_carriage(
    random: np.random.Generator, spread: CarriageSpread = DEFAULT_CARRIAGES
) -> Carriage:
    around = partial(_around, random)
    return Carriage(
        head_aside=around(spread.head_aside),
        head_forward=around(spread.head_forward),
        shoulders_up=around(spread.shoulders_up),
        shoulders_forward=around(spread.shoulders_forward),
        stance_width=math.exp(around(spread.stance_width)),
        toes_out=around(spread.toes_out),
        foot_ahead=around(spread.foot_ahead),
        weight_aside=around(spread.weight_aside),
    )


def _around(random: np.random.Generator, spread: Spread) -> float:
    """A habit drawn by its spread."""
    mean, deviation = spread
    return mean + deviation * float(np.clip(random.normal(), -2.0, 2.0))


def stature_of(proportions: Proportions) -> float:
    """Stature in metres of a body of these proportions standing straight."""
    return (
        hip_height(proportions)
        + proportions.hip_drop
        + proportions.spine
        + proportions.chest
        + proportions.neck
        + proportions.head_half_height
    )


def hip_height(proportions: Proportions) -> float:
    """Height in metres of the hip joints above the floor with straight legs."""
    return proportions.ankle + proportions.shank + proportions.thigh
