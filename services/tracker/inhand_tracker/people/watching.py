"""What one person uses, frame by frame: objects that are given, or whichever is recognised."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.recognition.cascade import Cascade

OnFailure = Callable[[str, Exception], None]


@dataclass(frozen=True)
class Seen:
    """One object of one person in one frame; ``outline`` (B, 2) is its boundary in the image."""

    name: str
    estimate: Estimate
    outline: Array | None = None
    class_probabilities: dict[str, float] = field(default_factory=dict)


class Watcher(Protocol):
    """Watches one person."""

    @property
    def names(self) -> tuple[str, ...]:
        """The objects that may be seen."""

    def restart(self) -> None:
        """Somebody else is watched from here on."""

    def see(
        self,
        joints: Array | None,
        time_ns: int,
        image: Image | None,
        camera: Intrinsics | None,
        on_failure: OnFailure,
    ) -> list[Seen]:
        """One frame: each object of ``names`` once; what fails is lost and told."""


class GivenObjects:
    """Every object is in use, and is tracked by itself; ``trackers`` go by object."""

    def __init__(self, trackers: Mapping[str, ObjectTracker]) -> None:
        self._trackers = trackers

    @property
    def names(self) -> tuple[str, ...]:
        """The objects."""
        return tuple(self._trackers)

    def restart(self) -> None:
        """Somebody else is watched from here on."""
        for tracker in self._trackers.values():
            tracker.restart()

    def see(
        self,
        joints: Array | None,
        time_ns: int,
        image: Image | None,
        camera: Intrinsics | None,
        on_failure: OnFailure,
    ) -> list[Seen]:
        """One frame; an object that fails stops no other."""
        found = []
        for name, tracker in self._trackers.items():
            try:
                estimate = tracker.step(joints, time_ns, image)
                outline = None if camera is None else tracker.outline(estimate, camera)
                found.append(Seen(name, estimate, outline))
            except Exception as error:  # noqa: BLE001 - one object must not stop the others
                on_failure(name, error)
                tracker.restart()
                found.append(Seen(name, LOST))
        return found


class RecognisedObjects:
    """At most one object is in use; ``objects`` are those of the cascade's actions, in order."""

    def __init__(self, cascade: Cascade, objects: Sequence[str]) -> None:
        self._cascade = cascade
        self._objects = tuple(objects)

    @property
    def names(self) -> tuple[str, ...]:
        """The objects, each once."""
        return tuple(dict.fromkeys(self._objects))

    def restart(self) -> None:
        """Somebody else is watched from here on."""
        self._cascade.restart()

    def see(
        self,
        joints: Array | None,
        time_ns: int,
        image: Image | None,
        camera: Intrinsics | None,
        on_failure: OnFailure,
    ) -> list[Seen]:
        """One frame: the object that is known has a pose, and all tell the probabilities."""
        try:
            recognition = self._cascade.step(joints, time_ns, image, camera)
            outline = None if camera is None else self._cascade.outline(recognition, camera)
        except Exception as error:  # noqa: BLE001 - one person must not stop the others
            on_failure(", ".join(self.names), error)
            self._cascade.restart()
            return [Seen(name, LOST) for name in self.names]
        probabilities = dict.fromkeys(self.names, 0.0)
        for name, probability in zip(self._objects, recognition.probabilities, strict=True):
            probabilities[name] = min(probabilities[name] + float(probability), 1.0)
        known = None if recognition.known is None else self._objects[recognition.known]
        return [
            Seen(name, recognition.estimate, outline, probabilities)
            if name == known
            else Seen(name, LOST, None, probabilities)
            for name in self.names
        ]
