"""Measures what a frame costs the tracker by the numbers of objects and people that it watches.

It is what the daemon does with a decoded frame: who is who, each object of each person, outlines.
One simulated person is in the images, with one of the objects. The second one stands beside, as a
skeleton that the images do not show, so that objects are looked for where nothing of them is.
"""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product

import msgspec
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import Person
from inhand_tracker.methods.registry import DEFAULT_METHOD, METHODS, new_tracker
from inhand_tracker.model.model_file import load_model
from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.people.watching import CameraFrame, GivenObjects, Watcher

from inhand_lab.benchmarks.learned_objects import LearnedObjects
from inhand_lab.benchmarks.parameters import FrameCostParameters
from inhand_lab.datasets.observations import observe
from inhand_lab.datasets.recorded_frames import load_frames


@dataclass(frozen=True)
class WatchingCost:
    """Median milliseconds of processor time that a frame takes, and the cores that are busy with
    it at the camera's frame rate."""

    objects: int
    people: int
    ms: float
    cores: float


def measure_watching(
    learned: LearnedObjects, parameters: FrameCostParameters
) -> Iterator[WatchingCost]:
    """Measure every number of people with every number of objects."""
    models = [load_model(file) for file in learned.models]
    left_handed = learned.stranger.handedness == "left"

    def new_watcher(objects: int) -> Watcher:
        trackers = {
            model.shape.name: new_tracker(model, left_handed=left_handed)
            for model in models[:objects]
        }
        return GivenObjects(trackers)

    for people, objects in product(parameters.people_counts, parameters.object_counts):
        watched = PeopleWatched(partial(new_watcher, objects), people)
        took = [
            _watch_ms(watched, shown[:people], frame)
            for shown, frame in _frames(learned, parameters.aside_m)
        ]
        ms = float(np.median(took[parameters.first_frames :]))
        yield WatchingCost(objects, people, ms, ms * parameters.frame_rate / 1e3)


def _watch_ms(watched: PeopleWatched, shown: Sequence[Person], frame: CameraFrame) -> float:
    began = time.process_time_ns()
    watched.see(shown, frame, _fail)
    return (time.process_time_ns() - began) / 1e6


def _fail(name: str, error: Exception) -> None:
    raise InhandError(f"cannot track {name}: {type(error).__name__}: {error}") from error


def _frames(
    learned: LearnedObjects, aside_m: float
) -> Iterator[tuple[tuple[Person, ...], CameraFrame]]:
    """Yield the stranger's frames: the person, the same one ``aside_m`` to the right, the image."""
    method = METHODS[DEFAULT_METHOD]
    frames = load_frames(learned.recording, learned.stranger.object)
    seen = observe(learned.recording, frames, method.needs(method.usual_terms))
    for recorded, one in zip(frames, seen, strict=True):
        (person,) = recorded.people
        yield (
            (person, _moved(person, aside_m)),
            CameraFrame(one.time_ns, one.image, None if one.image is None else one.image.camera),
        )


def _moved(person: Person, aside_m: float) -> Person:
    joints = tuple((x + aside_m, y, z) for x, y, z in person.joints)
    return msgspec.structs.replace(person, id=person.id + 1, joints=joints)
