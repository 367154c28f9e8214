"""Our own cascade: recognition over time says which objects to follow, each likely one has a
tracker of the default method, and what these see says whether it is their object at all.

While an object is not sure others take their turns: each is looked for in some frames, so that one
is found that the movement does not tell, as where it lies untouched. Nothing is known while no
object is seen, or somebody does what nobody taught. The object that was used last is followed on,
so that it is found again where it is, and its tracker forgets nothing of it while recognition
wavers.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from inhand_tracker.body.reader import BodyReader
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.recognition.answer import Recognition, boxes_around, known_action
from inhand_tracker.recognition.presence import Looks
from inhand_tracker.recognition.recogniser import LearnedCascade, MovementRecogniser
from inhand_tracker.sight.support import Support

FOLLOWED = 2
"""So many actions' objects are tracked at a time at most, the likeliest, beside the one that was
used last."""
WORTH_FOLLOWING = 0.2
"""Of the probability of all actions, the share from which a second action's object is tracked."""
TURN = 3
"""So many frames one after the other another object is looked for, beside the followed ones."""
SURE = 0.9
"""From this probability on an object is sure, and others are looked for but seldom."""
SELDOM = 8
"""One turn in so many."""
UNSEEN_NS = 1_000_000_000
"""After so long without an image only the movement speaks, and has to say more."""


class Cascade:
    """Follows whatever one person uses: ``trackers`` in the order of the recogniser's actions, each
    of one object."""

    def __init__(
        self,
        recogniser: LearnedCascade,
        trackers: Sequence[ObjectTracker],
        *,
        left_handed: bool = False,
    ) -> None:
        self._learned = recogniser
        self._left_handed = left_handed
        self._recogniser = MovementRecogniser(recogniser.movements, recogniser.temper)
        self._trackers = trackers
        self._looks = Looks(recogniser.presence)
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._reader = BodyReader(self._learned, left_handed=self._left_handed)
        self._recogniser.restart()
        self._looks.restart()
        for tracker in self._trackers:
            tracker.restart()
        self._last = Recognition(np.zeros(len(self._trackers)))
        self._used: int | None = None
        self._frames = 0
        self._seen_ns: int | None = None

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
        if image is None:
            probabilities = self._recogniser.step(time_ns, body, self._seen({}, time_ns))[:-1]
            followed = self._followed(probabilities)
        else:
            followed = self._followed(self._last.probabilities)
            followed += self._turn(followed)
        estimates = {
            action: self._trackers[action].step_body(body, time_ns, image) for action in followed
        }
        if image is not None:
            supports = {action: self._trackers[action].support for action in followed}
            probabilities = self._recogniser.step(time_ns, body, self._seen(supports, time_ns))[:-1]
        known = known_action(probabilities)
        if known is not None:
            self._used = known
            if known not in estimates:
                estimates[known] = self._trackers[known].step_body(body, time_ns, image)
        for action, tracker in enumerate(self._trackers):
            if action not in estimates:
                tracker.remember(body, time_ns)
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
        known = known_action(probabilities)
        used = self._used if known is None else known
        likely = worth_following(probabilities)
        return likely if used is None or used in likely else [*likely, used]

    def _turn(self, followed: Sequence[int]) -> list[int]:
        """The action whose object is looked for as well in this frame, if any."""
        turn = self._frames // TURN
        self._frames += 1
        if self._last.probabilities.max(initial=0.0) >= SURE:
            turn, others_turn = divmod(turn, SELDOM)
            if others_turn:
                return []
        others = [action for action in range(len(self._trackers)) if action not in followed]
        return [others[turn % len(others)]] if others else []

    def _seen(self, supports: Mapping[int, Support | None], time_ns: int) -> Array | None:
        """What images say, (K + 1,), with the last one's supports; None where none said anything
        for a second."""
        told = {action: support for action, support in supports.items() if support is not None}
        if told:
            self._seen_ns = time_ns
            self._looks.add(time_ns, told)
        if self._seen_ns is None or not 0 <= time_ns - self._seen_ns < UNSEEN_NS:
            return None
        return self._looks.evidence(time_ns)

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
