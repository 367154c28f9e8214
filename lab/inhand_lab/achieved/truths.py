"""What was truly achieved, by the interaction."""

from collections.abc import Callable, Mapping

from inhand_lab.achieved.at_head import (
    true_calls,
    true_filming,
    true_playing,
    true_reading,
    true_wearing,
)
from inhand_lab.achieved.drinking import true_sips
from inhand_lab.achieved.hammering import true_hammering
from inhand_lab.achieved.lifting import true_lifting
from inhand_lab.achieved.painting import true_painting
from inhand_lab.achieved.pouring import true_pours
from inhand_lab.achieved.shaking import true_shaking
from inhand_lab.achieved.shoes import true_shoes
from inhand_lab.achieved.sweeping import true_sweeping
from inhand_lab.achieved.swinging import true_golf, true_tennis
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.world.simulation import Simulation

TRUTHS: Mapping[str, Callable[[Simulation], list[TrueAchievement]]] = {
    "answerPhone": true_calls,
    "drinkFromMug": true_sips,
    "hammerNail": true_hammering,
    "hitGolfBall": true_golf,
    "hitTennisBall": true_tennis,
    "liftWeights": true_lifting,
    "magnifyText": true_reading,
    "paintWall": true_painting,
    "playFlute": true_playing,
    "pourCream": true_pours,
    "putOnGlasses": true_wearing,
    "putOnShoe": true_shoes,
    "recordVideo": true_filming,
    "shakeVinegar": true_shaking,
    "sweepFloor": true_sweeping,
}
"""Truths by the interaction's name."""
