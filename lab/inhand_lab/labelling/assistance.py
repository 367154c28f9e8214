"""Poses between two keyframes that are refined by the images.

The object is followed from both keyframes towards each other. Each frame then weighs its image
against what both directions expect of it without that image, and all frames are smoothed together.
To look at every frame once more with what the smoothed others make one expect was tried: it gains
nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import PoseGaussian
from inhand_tracker.sight.view import SightView

from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.expectations import (
    along_way,
    carried,
    fused,
    given_by_person,
    near_way,
    wider,
)
from inhand_lab.labelling.looking import Look, Looker, unseen
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters
from inhand_lab.labelling.smoothing import Smoothed, Way, smooth
from inhand_lab.labelling.stretch_views import Backwards


@dataclass(frozen=True)
class Shown:
    """The T frames of a stretch, keyframes first and last: the interpolated ``way``, what each
    image shows (None: nothing), and the pixels that a metre has in it, (T,)."""

    way: Way
    views: Sequence[SightView | None]
    pixels_per_m: Array

    @property
    def poses(self) -> list[Pose]:
        """The way's poses."""
        return list(zip(self.way.translations, self.way.rotations, strict=True))

    def reversed(self) -> "Shown":
        """Return the same, from the last frame to the first."""
        way = self.way
        back = Way(way.translations[::-1], way.rotations[::-1], way.times_s[::-1])
        return Shown(back, Backwards(self.views), self.pixels_per_m[::-1])


@dataclass(frozen=True)
class Assisted:
    """Poses of a stretch with covariances (T, 6, 6), and by how many standard deviations (T,) what
    was expected of a frame from both sides disagrees."""

    way: Way
    covariances: Array
    disagreements: Array


class StretchRefiner:
    """Refines the poses between keyframes of one object."""

    def __init__(self, looker: Looker, parameters: LabellingParameters = DEFAULT_LABELLING) -> None:
        self._looker = looker
        self._parameters = parameters

    def refine(self, shown: Shown) -> Assisted:
        """Refine a stretch; what is found for its keyframes is for its neighbours' sake alone."""
        random = np.random.default_rng(0)
        there = self._follow(shown, random)
        back = self._follow(shown.reversed(), random)[::-1]
        looks, disagreements = self._meet(shown, there, back, random)
        smoothed = self._smooth(looks, shown)
        return Assisted(smoothed.way, smoothed.covariances, disagreements)

    def _follow(self, shown: Shown, random: np.random.Generator) -> list[Look]:
        """Follow the object from the first frame to the last."""
        poses, times = shown.poses, np.abs(shown.way.times_s - shown.way.times_s[0])
        given = given_by_person(poses[0], self._parameters)
        looks = [self._looker.look([given], [], shown.views[0], 1.0, random)]
        for frame in range(1, len(poses) - 1):
            seconds = float(times[frame] - times[frame - 1])
            last = looks[-1].believed
            ways = poses[frame - 1], poses[frame]
            until_s = float(times[-1] - times[frame])
            near = near_way(poses[frame], times[frame], until_s, self._parameters)
            far = wider(near, self._parameters.far_factor)
            along = along_way(last, ways, seconds, self._parameters)
            expected = [fused(along, near)[0], near, fused(along, far)[0], far]
            if frame > 1:
                expected.append(fused(self._going_on(looks, along), far)[0])
            sharpness = self._sharpness(shown, frame, expected[0], last)
            looks.append(self._looker.look(expected, [], shown.views[frame], sharpness, random))
        return [*looks, unseen(given_by_person(poses[-1], self._parameters))]

    def _going_on(self, looks: Sequence[Look], usual: PoseGaussian) -> PoseGaussian:
        """Expect the object to move on as it moved, as surely as is usual."""
        before, last = looks[-2].believed, looks[-1].believed
        pose = last.centre, last.rotation
        return PoseGaussian(
            *carried(pose, (before.centre, before.rotation), pose), usual.covariance
        )

    def _meet(
        self,
        shown: Shown,
        there: Sequence[Look],
        back: Sequence[Look],
        random: np.random.Generator,
    ) -> tuple[list[Look], Array]:
        """Look at each frame with what is expected of it from both sides."""
        looks, disagreements = [there[0]], np.zeros(len(there))
        for frame in range(1, len(there) - 1):
            sides = there[frame], back[frame]
            both, disagreements[frame] = fused(sides[0].expected, sides[1].expected)
            expected = [both]
            if disagreements[frame] > self._parameters.most_disagreement:
                expected += [sides[0].expected, sides[1].expected]
            starts = [sides[0].believed, sides[1].believed]
            sharpness = self._sharpness(shown, frame, both, looks[-1].believed)
            looks.append(self._looker.look(expected, starts, shown.views[frame], sharpness, random))
        return [*looks, back[-1]], disagreements

    def _smooth(self, looks: Sequence[Look], shown: Shown) -> Smoothed:
        """Find the likeliest way by all looks together."""
        believed = [look.believed for look in looks]
        way = Way(
            np.array([one.centre for one in believed]),
            np.array([one.rotation for one in believed]),
            shown.way.times_s,
        )
        information = np.array([look.information for look in looks])
        for end in (0, -1):
            information[end] = np.linalg.inv(looks[end].believed.covariance)
        return smooth(way, shown.way, information, self._parameters)

    def _sharpness(
        self, shown: Shown, frame: int, here: PoseGaussian, before: PoseGaussian
    ) -> float:
        """Return how sharp an object is in a frame, from 0 to 1, by how far it went."""
        gone = float(np.linalg.norm(here.centre - before.centre)) * shown.pixels_per_m[frame]
        return float(1.0 / (1.0 + (gone / self._parameters.blurred_pixels) ** 2))
