"""What people can do: every interaction with its object."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array

from inhand_lab.motions import (
    answer_phone,
    drink_from_mug,
    hammer_nail,
    hit_golf_ball,
    hit_tennis_ball,
    lift_weights,
    magnify_text,
    paint_wall,
    play_flute,
    pour_cream,
    put_on_glasses,
    put_on_shoe,
    record_video,
    shake_vinegar,
    sweep_floor,
)
from inhand_lab.motions.performance import Performance
from inhand_lab.objects.barbell import barbell
from inhand_lab.objects.broom import broom
from inhand_lab.objects.camera import camera
from inhand_lab.objects.flute import flute
from inhand_lab.objects.glasses import glasses
from inhand_lab.objects.golf_club import golf_club
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.jug import jug
from inhand_lab.objects.magnifier import magnifier
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import mug
from inhand_lab.objects.paint_brush import paint_brush
from inhand_lab.objects.phone import phone
from inhand_lab.objects.racket import racket
from inhand_lab.objects.shoe import shoe
from inhand_lab.objects.vinegar_bottle import vinegar_bottle
from inhand_lab.people.person import SimulatedPerson


@dataclass(frozen=True)
class Interaction:
    """Something people do with an object."""

    object_model: Callable[[], ObjectModel]
    perform: Callable[[SimulatedPerson, Array, np.random.Generator], Performance]


INTERACTIONS = {
    "pourCream": Interaction(jug, pour_cream.perform),
    "answerPhone": Interaction(phone, answer_phone.perform),
    "drinkFromMug": Interaction(mug, drink_from_mug.perform),
    "recordVideo": Interaction(camera, record_video.perform),
    "liftWeights": Interaction(barbell, lift_weights.perform),
    "playFlute": Interaction(flute, play_flute.perform),
    "hitTennisBall": Interaction(racket, hit_tennis_ball.perform),
    "hammerNail": Interaction(hammer, hammer_nail.perform),
    "paintWall": Interaction(paint_brush, paint_wall.perform),
    "putOnGlasses": Interaction(glasses, put_on_glasses.perform),
    "shakeVinegar": Interaction(vinegar_bottle, shake_vinegar.perform),
    "magnifyText": Interaction(magnifier, magnify_text.perform),
    "putOnShoe": Interaction(shoe, put_on_shoe.perform),
    "sweepFloor": Interaction(broom, sweep_floor.perform),
    "hitGolfBall": Interaction(golf_club, hit_golf_ball.perform),
}
"""What people can do, by name."""
