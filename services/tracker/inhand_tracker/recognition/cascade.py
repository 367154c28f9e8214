"""Our own cascade: recognition over time chooses which objects are tracked, and what their trackers
see says whether each object is there at all.

The likely objects are tracked with the default method. While no object is sure the others take
turns: each is looked for in some frames, so that an object is found that the movement does not
show, as one that lies untouched. Nothing is recognised while no object is seen, or somebody does
what nobody taught. The object that was used last is tracked on, so that it is found again where it
is, and its tracker forgets nothing of it while recognition wavers.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from inhand_tracker.body.convention_table import shared_convention
from inhand_tracker.body.reader import Body
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.recognition.object_recogniser import ObjectRecogniser
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION, RecognitionParameters
from inhand_tracker.recognition.presence import Looks
from inhand_tracker.recognition.recogniser import LearnedCascade, MovementRecogniser
from inhand_tracker.recognition.recognition import Recognition, outline_boxes, recognised_action


class Cascade(ObjectRecogniser):
    """Follows whatever one person uses: ``trackers`` in the order of the recogniser's actions, each
    of one object. ``effort`` is theirs, above 0 and up to 1."""

    def __init__(
        self,
        recogniser: LearnedCascade,
        trackers: Sequence[ObjectTracker],
        *,
        left_handed: bool = False,
        parameters: RecognitionParameters = DEFAULT_RECOGNITION,
    ) -> None:
        super().__init__(
            recogniser,
            len(trackers),
            left_handed=left_handed,
            learned_as=shared_convention(tracker.learned_as for tracker in trackers),
        )
        self._parameters = parameters
        self._movement = MovementRecogniser(recogniser.movements, recogniser.temper, parameters)
        self._looks = Looks(recogniser.presence, parameters)
        self._trackers = trackers
        self.effort = 1.0
        self.restart()

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        super().restart()
        self._movement.restart()
        self._looks.restart()
        for tracker in self._trackers:
            tracker.restart()
        self._used: int | None = None
        self._frames = 0
        self._seen_ns: int | None = None

    def remember(self, joints: Array, time_ns: int) -> None:
        """Take a frame in which nothing is looked for: joints (20, 3) in the camera frame."""
        body = self._reader.read(joints, self.convention)
        if body is not None:
            self._movement.remember(time_ns, body)
            self._remember({}, body, time_ns)

    def outline(self, recognition: Recognition, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object in use; None where none is."""
        if recognition.used is None:
            return None
        return self._trackers[recognition.used].outline(recognition.estimate, camera)

    def considered(self) -> tuple[int, Considered] | None:
        """The action in use, and what its object's pose was chosen from."""
        if (used := self._last.used) is None:
            return None
        considered = self._trackers[used].considered()
        return None if considered is None else (used, considered)

    def _recognise(
        self, body: Body, time_ns: int, image: Image | None, camera: Intrinsics | None
    ) -> Recognition:
        if image is None:
            probabilities = self._probabilities(body, time_ns)
            estimates = self._track(self._followed(probabilities), body, time_ns, None)
        else:
            followed = self._followed(self._last.probabilities)
            estimates = self._track([*followed, *self._turn(followed)], body, time_ns, image)
            self._look(estimates, time_ns)
            probabilities = self._probabilities(body, time_ns)
        known = recognised_action(probabilities, self._parameters.recognised_probability)
        if known is not None:
            self._used = known
            if known not in estimates:
                estimates |= self._track([known], body, time_ns, image)
        self._remember(estimates, body, time_ns)
        doubted = self._doubted(probabilities) if known is None else None
        there = doubted if known is None else known
        estimate = LOST if there is None else estimates[there]
        box = None if camera is None else self._box(estimates, probabilities, camera)
        return Recognition(probabilities, known, estimate, box, doubted)

    def _without_body(self, time_ns: int, image: Image | None) -> Recognition:
        """The object that is used is followed by what the image shows, or ages until it is lost."""
        last = self._last
        if last.used is None:
            return replace(last, estimate=LOST)
        estimate = self._trackers[last.used].step(None, time_ns, image)
        if estimate.translation is None:
            return replace(last, known=None, doubted=None, estimate=estimate)
        return replace(last, estimate=estimate)

    def _doubted(self, probabilities: Array) -> int | None:
        """The action that was recognised last, where it is not unlikely by probabilities (K,)."""
        least = self._parameters.doubted_probability
        return self._used if self._used is not None and probabilities[self._used] >= least else None

    def _probabilities(self, body: Body, time_ns: int) -> Array:
        """Probabilities (K,) of the actions, by the movement and by the last looks."""
        seen_ns = self._seen_ns
        seeing = seen_ns is not None and 0 <= time_ns - seen_ns < self._parameters.unseen_ns
        looks = self._looks.evidence(time_ns) if seeing else None
        return self._movement.step(time_ns, body, looks)[:-1]

    def _followed(self, probabilities: Array) -> list[int]:
        """The actions whose objects are tracked: the likely ones, and the last recognised one."""
        known = recognised_action(probabilities, self._parameters.recognised_probability)
        used = self._used if known is None else known
        likely = worth_following(probabilities, self._parameters)
        return likely if used is None or used in likely else [*likely, used]

    def _turn(self, followed: Sequence[int]) -> list[int]:
        """The action whose object is looked for as well in this frame, if any."""
        parameters = self._parameters
        turn = self._frames // parameters.turn_frames
        self._frames += 1
        if self._last.probabilities.max(initial=0.0) >= parameters.sure_probability:
            turn, others_turn = divmod(turn, parameters.sure_turns)
            if others_turn:
                return []
        others = [action for action in range(len(self._trackers)) if action not in followed]
        return [others[turn % len(others)]] if others else []

    def _track(
        self, actions: Iterable[int], body: Body, time_ns: int, image: Image | None
    ) -> dict[int, Estimate]:
        estimates = {}
        for action in actions:
            self._trackers[action].effort = self.effort
            estimates[action] = self._trackers[action].step_body(body, time_ns, image)
        return estimates

    def _look(self, actions: Iterable[int], time_ns: int) -> None:
        """Take what the image says for the objects that were tracked in it."""
        supports = {action: self._trackers[action].support for action in actions}
        seen = {action: support for action, support in supports.items() if support is not None}
        if seen:
            self._seen_ns = time_ns
            self._looks.add(time_ns, seen)

    def _remember(self, tracked: Mapping[int, Estimate], body: Body, time_ns: int) -> None:
        """Let the trackers that are not in use remember what the body did."""
        for action, tracker in enumerate(self._trackers):
            if action not in tracked:
                tracker.remember(body, time_ns)

    def _box(
        self, estimates: Mapping[int, Estimate], probabilities: Array, camera: Intrinsics
    ) -> Array | None:
        """The box (4,) of the object that is most probably there.

        Its action's probability counts, to which the last recognised one adds that of none, and
        its tracker's confidence. No mean of boxes: between two there is neither object.
        """
        there = probabilities.copy()
        if self._used is not None:
            there[self._used] += 1.0 - probabilities.sum()
        outlines = {a: self._trackers[a].outline(e, camera) for a, e in estimates.items()}
        placed = {action: outline for action, outline in outlines.items() if outline is not None}
        if not placed:
            return None
        surest = max(placed, key=lambda action: there[action] * estimates[action].confidence)
        return outline_boxes(placed[surest][None])[0]


def worth_following(
    probabilities: Array, parameters: RecognitionParameters = DEFAULT_RECOGNITION
) -> list[int]:
    """Give the likeliest action, by probabilities (K,), and the next that are likely enough."""
    order = np.argsort(-probabilities)[: parameters.followed]
    least = parameters.worth_following * probabilities.sum()
    return [int(a) for rank, a in enumerate(order) if rank == 0 or probabilities[a] >= least]
