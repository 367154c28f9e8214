"""BlazePose: a detector that finds somebody, and landmarks that follow their region from picture to
picture (Bazarevsky et al. 2020)."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

from inhand_capture.estimation.detector import PersonDetector
from inhand_capture.estimation.facing import FollowedRegion, agreement, begun_with
from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.landmarks import POINTS, LandmarkNetwork, Landmarks
from inhand_capture.estimation.parameters import DEFAULT_BLAZEPOSE, BlazePoseParameters
from inhand_capture.estimation.regions import Region, whole_picture
from inhand_capture.estimation.weights import (
    DETECTOR,
    LANDMARKS,
    require_weights,
)

SHARES: dict[Joint, dict[int, float]] = {
    Joint.HEAD: {7: 0.5, 8: 0.5},
    Joint.SHOULDER_LEFT: {11: 1.0},
    Joint.SHOULDER_RIGHT: {12: 1.0},
    Joint.ELBOW_LEFT: {13: 1.0},
    Joint.ELBOW_RIGHT: {14: 1.0},
    Joint.WRIST_LEFT: {15: 1.0},
    Joint.WRIST_RIGHT: {16: 1.0},
    Joint.HAND_LEFT: {17: 0.5, 19: 0.5},
    Joint.HAND_RIGHT: {18: 0.5, 20: 0.5},
    Joint.HIP_LEFT: {23: 1.0},
    Joint.HIP_RIGHT: {24: 1.0},
    Joint.KNEE_LEFT: {25: 1.0},
    Joint.KNEE_RIGHT: {26: 1.0},
    Joint.ANKLE_LEFT: {27: 1.0},
    Joint.ANKLE_RIGHT: {28: 1.0},
    Joint.FOOT_LEFT: {31: 1.0},
    Joint.FOOT_RIGHT: {32: 1.0},
}
"""What each joint is of the network's points: ears for the head, knuckles of the little and the
index finger for the hand, the tip of the foot."""
SHOULDERS, HIPS = (11, 12), (23, 24)


def _mixture() -> Floats:
    """Return the joints' shares (20, 33) of the network's points."""
    mixture = np.zeros((len(Joint), POINTS))
    for joint, shares in SHARES.items():
        for point, share in shares.items():
            mixture[joint, point] = share
    return mixture


_MIXTURE = _mixture()
_KNOWN = np.array([joint in SHARES for joint in Joint])


def person_of(landmarks: Landmarks) -> FoundPerson:
    """Make our joints of the network's points."""
    return FoundPerson(
        pixels=np.where(_KNOWN[:, None], _MIXTURE @ landmarks.pixels, np.nan),
        depths=np.where(_KNOWN, _MIXTURE @ landmarks.places[:, 2], np.nan),
        visibilities=np.where(_KNOWN, _MIXTURE @ landmarks.visibilities, 0.0),
    )


class BlazePose:
    """Follows people's regions, and looks for others once in a while.

    The detector sees one person at a time: those who are followed already are painted over, and it
    looks at the whole picture and at its ends by turns.
    """

    def __init__(
        self,
        network: str,
        folder: Path,
        parameters: BlazePoseParameters = DEFAULT_BLAZEPOSE,
    ) -> None:
        """Load a network by its name in ``LANDMARKS``; raises WeightsError, or SettingsError where
        LiteRT is not installed."""
        self._landmarks = LandmarkNetwork(require_weights(LANDMARKS[network], folder), parameters)
        self._detector = PersonDetector(require_weights(DETECTOR, folder), parameters)
        self._parameters = parameters
        self._followed: list[FollowedRegion] = []
        self._pictures = self._searches = 0

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find the people in a picture (H, W, 3) RGB."""
        people, followed = self._find_again(colour)
        if self._searches_now(len(people)):
            found = self._search(colour, people)
            if found is not None and not _is_one_of(found, people, self._parameters.same_person):
                people.append(found)
                followed.append(begun_with(found))
        self._pictures += 1
        self._followed = followed
        return [person_of(one) for one in people]

    def _find_again(
        self, colour: NDArray[np.uint8]
    ) -> tuple[list[Landmarks], list[FollowedRegion]]:
        """Find those again who were found before, each once."""
        people: list[Landmarks] = []
        followed: list[FollowedRegion] = []
        for before in self._followed:
            one = self._look(colour, before)
            if self._believes(one) and not _is_one_of(one, people, self._parameters.same_person):
                people.append(one)
                followed.append(before.after(one, self._parameters.facing_share))
        return people, followed

    def _look(self, colour: NDArray[np.uint8], before: FollowedRegion) -> Landmarks:
        """Look where somebody was, and twice where they seem to have turned round since.

        Nobody does so between two pictures. The second look is at the mirror image of a closer
        region: a network that takes left for right in one seldom does so in the other.
        """
        parameters = self._parameters
        first = self._landmarks.find(colour, before.region)
        if agreement(first, before) >= parameters.facing_agreement:
            return first
        closer = before.region.scaled(parameters.second_look)
        second = self._landmarks.find(colour, closer, mirrored=True)
        if not self._believes(second) or agreement(second, before) <= agreement(first, before):
            return first
        return replace(second, next_region=first.next_region, score=first.score)

    def _searches_now(self, people: int) -> bool:
        parameters = self._parameters
        if people >= parameters.most_people:
            return False
        period = parameters.search_period if people else parameters.empty_period
        return self._pictures % period == 0

    def _search(self, colour: NDArray[np.uint8], people: list[Landmarks]) -> Landmarks | None:
        """Look for somebody else than these people in one of the picture's views."""
        height, width = colour.shape[:2]
        views = _views(width, height)
        view = views[self._searches % len(views)]
        self._searches += 1
        region = self._detector.detect(_painted_over(colour, people), view)
        if region is None:
            return None
        found = self._landmarks.find(colour, region)
        return found if self._believes(found) else None

    def _believes(self, one: Landmarks) -> bool:
        return one.score >= self._parameters.person_score and one.next_region.side > 1.0


def _views(width: int, height: int) -> list[Region]:
    """Return what the detector looks at by turns: all of a picture, one end, all, the other end."""
    whole = whole_picture(width, height)
    side = float(min(width, height))
    ends = [
        Region(0.5 * side, 0.5 * side, side),
        Region(width - 0.5 * side, height - 0.5 * side, side),
    ]
    return [whole, ends[0], whole, ends[1]]


def _painted_over(colour: NDArray[np.uint8], people: Sequence[Landmarks]) -> NDArray[np.uint8]:
    """Return the picture with a grey box over each person's points."""
    if not people:
        return colour
    painted = colour.copy()
    height, width = colour.shape[:2]
    for one in people:
        low = np.clip(one.pixels.min(axis=0), 0, (width, height)).astype(int)
        high = np.clip(one.pixels.max(axis=0), 0, (width, height)).astype(int)
        cv2.rectangle(painted, low.tolist(), high.tolist(), (128, 128, 128), cv2.FILLED)
    return painted


def _is_one_of(one: Landmarks, others: Sequence[Landmarks], nearness: float) -> bool:
    """Whether somebody's joints lie where those of one of the others do."""
    return any(
        np.median(np.linalg.norm(one.pixels - other.pixels, axis=1))
        < nearness * max(_trunk_length(one), _trunk_length(other))
        for other in others
    )


def _trunk_length(one: Landmarks) -> float:
    """Length from the middle of the shoulders to that of the hips, pixels."""
    shoulders, hips = (one.pixels[list(pair)].mean(axis=0) for pair in (SHOULDERS, HIPS))
    return float(np.linalg.norm(shoulders - hips))
