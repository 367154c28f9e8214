"""Our own cascade: recognition over time says which objects to follow, and each likely one has a
tracker of the default method.

Nothing is known while nobody uses anything, or does what nobody taught. Most often the object that
was used last has been put down then: it is followed on, so that it is found again where it is, and
its tracker forgets nothing of it while recognition wavers.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inhand_tracker.body_reader import BodyReader
from inhand_tracker.camera import Intrinsics
from inhand_tracker.estimate import LOST, Estimate
from inhand_tracker.image import Image
from inhand_tracker.recogniser import MovementRecogniser, Recogniser
from inhand_tracker.recognition import Recognition, boxes_around, known_action
from inhand_tracker.trackers import ObjectTracker

Array = NDArray[np.float64]

FOLLOWED = 2
"""So many actions' objects are tracked at a time at most, the likeliest, beside the one that was
used last."""
WORTH_FOLLOWING = 0.2
"""Of the probability of all actions, the share from which a second action's object is tracked."""


class Cascade:
    """Follows whatever one person uses: ``trackers`` in the order of the recogniser's actions, each
    of one object."""

    def __init__(
        self,
        recogniser: Recogniser,
        trackers: Sequence[ObjectTracker],
        *,
        left_handed: bool = False,
    ) -> None:
        self._learned = recogniser
        self._left_handed = left_handed
        self._recogniser = MovementRecogniser(recogniser.movements, recogniser.temper)
        self._trackers = trackers
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._reader = BodyReader(self._learned, left_handed=self._left_handed)
        self._recogniser.restart()
        for tracker in self._trackers:
            tracker.restart()
        self._last = Recognition(np.zeros(len(self._trackers)))
        self._used: int | None = None

    def step(
        self,
        joints: Array | None,
        time_ns: int,
        image: Image | None = None,
        camera: Intrinsics | None = None,
    ) -> Recognition:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        ``camera`` is for the box where there is no image. While the body is not seen, the object
        that was known coasts as its tracker does.
        """
        if image is not None:
            camera = image.camera
        body = None if joints is None else self._reader.read(joints)
        if body is None:
            return self._coast(time_ns)
        probabilities = self._recogniser.step(time_ns, body)[:-1]
        known = known_action(probabilities)
        if known is not None:
            self._used = known
        estimates = {
            action: self._trackers[action].step(joints, time_ns, image)
            for action in self._followed(probabilities)
        }
        self._last = Recognition(
            probabilities,
            known,
            LOST if known is None else estimates[known],
            None if camera is None else self._box(estimates, probabilities, camera),
        )
        return self._last

    def outline(self, recognition: Recognition, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object that is known; None where none is."""
        if recognition.known is None:
            return None
        return self._trackers[recognition.known].outline(recognition.estimate, camera)

    def _followed(self, probabilities: Array) -> list[int]:
        """The actions whose objects are tracked: the likely ones, and the last that was known."""
        likely = worth_following(probabilities)
        if self._used is None or self._used in likely:
            return likely
        return [*likely, self._used]

    def _coast(self, time_ns: int) -> Recognition:
        known = self._last.known
        if known is None:
            return Recognition(self._last.probabilities, None, LOST, self._last.box)
        estimate = self._trackers[known].step(None, time_ns)
        if estimate.translation is None:
            known = None
        return Recognition(self._last.probabilities, known, estimate, self._last.box)

    def _box(
        self, estimates: dict[int, Estimate], probabilities: Array, camera: Intrinsics
    ) -> Array | None:
        """The box (4,) of the object that is most probably there: by its action, of which the last
        that was known has what none has, and by what its tracker says of its pose.

        No mean of boxes: between two there is neither object.
        """
        there = probabilities.copy()
        if self._used is not None:
            there[self._used] += 1.0 - probabilities.sum()
        outlines = {a: self._trackers[a].outline(e, camera) for a, e in estimates.items()}
        placed = {action: outline for action, outline in outlines.items() if outline is not None}
        if not placed:
            return None
        surest = max(placed, key=lambda action: there[action] * estimates[action].confidence)
        return boxes_around(placed[surest][None])[0]


def worth_following(probabilities: Array) -> list[int]:
    """The likeliest action, of probabilities (K,), and the next ones that are likely enough."""
    order = np.argsort(-probabilities)[:FOLLOWED]
    least = WORTH_FOLLOWING * probabilities.sum()
    return [int(a) for rank, a in enumerate(order) if rank == 0 or probabilities[a] >= least]
