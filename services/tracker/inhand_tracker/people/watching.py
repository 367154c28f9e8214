"""Watches what one person uses: objects that are given, or whichever is recognised."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.recognition import Recognition

OnFailure = Callable[[str, Exception], None]
"""Takes the name of what failed, and the error."""


@dataclass(frozen=True)
class CameraFrame:
    """A frame of a camera without the people in it: when, the image and the camera, if known.

    ``effort``, above 0 and up to 1, is the share of the trackers' usual work that it is worth;
    ``convention`` names whose joints the people in it have, None where that is not said.

    Where the camera is not the one in whose frame people and poses are, it stands at
    ``view_from_reference`` from that.
    """

    time_ns: int
    image: Image | None = None
    camera: Intrinsics | None = None
    effort: float = 1.0
    convention: str | None = None
    view_from_reference: Placement | None = None

    def seen(self, estimate: Estimate) -> Estimate:
        """Return an estimate in the frame of this camera."""
        place = self.view_from_reference
        return estimate if place is None else estimate.seen_from(place)


@dataclass(frozen=True)
class WatchedObject:
    """One object of one person in one frame; ``outline`` (B, 2) is its boundary in the image."""

    name: str
    estimate: Estimate = LOST
    outline: Array | None = None
    class_probabilities: dict[str, float] = field(default_factory=dict)


class Watcher(ABC):
    """Watches which objects one person uses, of those that ``names`` lists.

    ``needs_hips`` is false where all was learned from people whose hips are never seen.
    """

    def __init__(self, names: Sequence[str], *, needs_hips: bool = True) -> None:
        self.names = tuple(names)
        self.needs_hips = needs_hips

    @property
    @abstractmethod
    def trouble(self) -> str | None:
        """What is wrong with the convention of the person's joints; None where nothing is."""

    @abstractmethod
    def restart(self) -> None:
        """Forget the person and the objects: somebody else is watched from here on."""

    @abstractmethod
    def see(
        self, joints: Array | None, frame: CameraFrame, on_failure: OnFailure
    ) -> list[WatchedObject]:
        """Watch a frame with the person's joints (20, 3), None while the person is out of view.

        The result has each object of ``names`` once. What fails is lost in this frame, starts
        afresh, and is reported to ``on_failure``; it stops nothing else.
        """

    @abstractmethod
    def considered(self) -> dict[str, Considered]:
        """What the poses in the last frame were chosen from, by object."""

    @abstractmethod
    def remember(self, joints: Array, time_ns: int, on_failure: OnFailure) -> None:
        """Take a frame that is skipped: what the person's joints (20, 3) did counts later."""


class GivenObjects(Watcher):
    """Watches objects that are all in use; each has its own tracker, by its name."""

    def __init__(self, trackers: Mapping[str, ObjectTracker], *, needs_hips: bool = True) -> None:
        super().__init__(tuple(trackers), needs_hips=needs_hips)
        self._trackers = trackers

    @property
    def trouble(self) -> str | None:
        troubles = (tracker.trouble for tracker in self._trackers.values())
        return next((trouble for trouble in troubles if trouble is not None), None)

    def restart(self) -> None:
        for tracker in self._trackers.values():
            tracker.restart()

    def see(
        self, joints: Array | None, frame: CameraFrame, on_failure: OnFailure
    ) -> list[WatchedObject]:
        objects = []
        for name, tracker in self._trackers.items():
            try:
                objects.append(_track(name, tracker, joints, frame))
            except Exception as error:  # noqa: BLE001 - one object must not stop the others
                on_failure(name, error)
                tracker.restart()
                objects.append(WatchedObject(name))
        return objects

    def considered(self) -> dict[str, Considered]:
        every = {name: tracker.considered() for name, tracker in self._trackers.items()}
        return {name: one for name, one in every.items() if one is not None}

    def remember(self, joints: Array, time_ns: int, on_failure: OnFailure) -> None:
        for name, tracker in self._trackers.items():
            try:
                tracker.remember_joints(joints, time_ns)
            except Exception as error:  # noqa: BLE001 - one object must not stop the others
                on_failure(name, error)
                tracker.restart()


def _track(
    name: str, tracker: ObjectTracker, joints: Array | None, frame: CameraFrame
) -> WatchedObject:
    tracker.effort = frame.effort
    tracker.convention = frame.convention
    estimate = tracker.step(joints, frame.time_ns, frame.image)
    outline = None if frame.camera is None else tracker.outline(frame.seen(estimate), frame.camera)
    return WatchedObject(name, frame.seen(estimate), outline)


class RecognisedObjects(Watcher):
    """Watches objects of which at most one is in use; ``objects`` are those of the cascade's
    actions, in their order. One object may serve several actions."""

    def __init__(self, cascade: Cascade, objects: Sequence[str]) -> None:
        super().__init__(tuple(dict.fromkeys(objects)))
        self._cascade = cascade
        self._objects = tuple(objects)

    @property
    def trouble(self) -> str | None:
        return self._cascade.trouble

    def restart(self) -> None:
        self._cascade.restart()

    def see(
        self, joints: Array | None, frame: CameraFrame, on_failure: OnFailure
    ) -> list[WatchedObject]:
        self._cascade.effort = frame.effort
        self._cascade.convention = frame.convention
        try:
            recognition = self._cascade.step(joints, frame.time_ns, frame.image, frame.camera)
            recognition = replace(recognition, estimate=frame.seen(recognition.estimate))
            outline = None
            if frame.camera is not None:
                outline = self._cascade.outline(recognition, frame.camera)
        except Exception as error:  # noqa: BLE001 - one person must not stop the others
            on_failure(", ".join(self.names), error)
            self._cascade.restart()
            return [WatchedObject(name) for name in self.names]
        return self._objects_of(recognition, outline)

    def considered(self) -> dict[str, Considered]:
        considered = self._cascade.considered()
        return {} if considered is None else {self._objects[considered[0]]: considered[1]}

    def remember(self, joints: Array, time_ns: int, on_failure: OnFailure) -> None:
        try:
            self._cascade.remember(joints, time_ns)
        except Exception as error:  # noqa: BLE001 - one person must not stop the others
            on_failure(", ".join(self.names), error)
            self._cascade.restart()

    def _objects_of(self, recognition: Recognition, outline: Array | None) -> list[WatchedObject]:
        """All objects with their probabilities; the one in use has a pose."""
        probabilities = dict.fromkeys(self.names, 0.0)
        for name, probability in zip(self._objects, recognition.probabilities, strict=True):
            probabilities[name] = min(probabilities[name] + float(probability), 1.0)
        used = None if recognition.used is None else self._objects[recognition.used]
        return [
            WatchedObject(name, recognition.estimate, outline, probabilities)
            if name == used
            else WatchedObject(name, class_probabilities=probabilities)
            for name in self.names
        ]
