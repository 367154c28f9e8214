"""A sight of which the likelihood is known: the likelier a pose, the nearer it is to the truth."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture
from inhand_tracker.sight.colours import Colours
from inhand_tracker.sight.frame import SightFrame
from inhand_tracker.sight.light import LightWatch
from inhand_tracker.sight.refinement import Refined

TRUE = PoseGaussian(
    np.array([0.05, -0.03, 1.5]), np.array([1.0, 0.0, 0.0, 0.0]), np.diag([1e-4] * 3 + [1e-2] * 3)
)
TRAINED = Colours(np.full(8, 0.125, np.float32), None)
LEARNED = np.full(8, 0.25, np.float32)
"""Colours of the object after training, which say 1 more of its interior."""


@dataclass
class GaussianSight:
    """In place of ``Sight``: what it is asked is counted. The truth is ``bonus`` times (log)
    likelier than no object; refinement reaches it where it ``refines``."""

    bonus: float = 20.0
    refines: bool = True
    weighed: int = 0
    learned: list[np.ndarray] = field(default_factory=list)
    trusts: list[float] = field(default_factory=list)
    frames: list[SightFrame] = field(default_factory=list)
    usual_light: tuple[float, float] = (math.nan, math.nan)

    def start(self) -> Colours:
        return TRAINED

    def watch_light(self) -> LightWatch:
        return LightWatch(self.usual_light)

    def view(self, frame: Any, colours: Colours, joints: Any) -> "View":
        self.frames.append(frame)
        return View(frame, colours)

    def compare_unseen(self, weighed: Any, view: "View", trust: float) -> "View":
        self.trusts.append(trust)
        return view

    def weigh(
        self, origins: np.ndarray, turns: np.ndarray, view: "View", *, quickly: bool = False
    ) -> np.ndarray:
        """The likelihoods (P, 1) themselves are what poses weigh here."""
        return self.log_likelihood(origins, turns, view)[:, None]

    def log_likelihood_by(self, weighed: np.ndarray, view: "View") -> np.ndarray:
        return weighed[:, 0]

    def log_likelihood(self, origins: np.ndarray, turns: np.ndarray, view: "View") -> np.ndarray:
        self.weighed += len(origins)
        return self._likelihoods(origins, turns)

    def log_likelihoods_by_term(
        self, origins: np.ndarray, turns: np.ndarray, view: "View"
    ) -> dict[str, np.ndarray]:
        whole = self.log_likelihood(origins, turns, view)
        recoloured = float(view.colours.of_object is LEARNED)
        shares = {"edges": 0.1, "region": 0.2, "interior": 0.3, "depth": 0.4}
        terms = {term: share * whole for term, share in shares.items()}
        return terms | {"interior": terms["interior"] + recoloured}

    def refine(
        self, origins: np.ndarray, turns: np.ndarray, view: "View", prior: Any, trust: float
    ) -> Refined:
        count = len(origins)
        information = np.tile(trust * np.linalg.inv(TRUE.covariance), (count, 1, 1))
        if not self.refines:
            return Refined(origins, turns, information, self._likelihoods(origins, turns))
        moved = np.tile(TRUE.centre, (count, 1)), np.tile(TRUE.rotation, (count, 1))
        return Refined(*moved, information, self._likelihoods(*moved))

    def _likelihoods(self, origins: np.ndarray, turns: np.ndarray) -> np.ndarray:
        return self.bonus + _log_density(origins, turns) - _log_density(*pose(TRUE))

    def learn(
        self,
        colours: Colours,
        frame: Any,
        origin: np.ndarray,
        turn: np.ndarray,
        *,
        of_object: float = 0.0,
        around: float = 0.0,
    ) -> Colours:
        if of_object == 0.0:
            return colours
        self.learned.append(origin)
        return Colours(LEARNED, None)


@dataclass(frozen=True)
class View:
    frame: Any
    colours: Colours


def pose(one: PoseGaussian) -> tuple[np.ndarray, np.ndarray]:
    """The mean as arrays of one pose, (1, 3) and (1, 4)."""
    return one.centre[None], one.rotation[None]


def alone(one: PoseGaussian) -> PoseMixture:
    """The mixture of one distribution."""
    return PoseMixture((one,), np.ones(1))


def _log_density(centres: np.ndarray, turns: np.ndarray) -> np.ndarray:
    densities: np.ndarray = alone(TRUE).log_densities(centres, turns)[0]
    return densities
