"""Whether two people who hand something over and pass each other keep their numbers in a rig.

Cameras number people by themselves, and anew where they come back from behind somebody; the rig's
numbers are those of ``PeopleFuser``.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.rig.people_fusing import PeopleFuser
from inhand_tracker.rig.sightings import CameraPeople

from inhand_lab.benchmarks.rig_tracking import nearest_frames, placement_of
from inhand_lab.workers import in_processes
from inhand_lab.world.handover import HandoverSimulation, simulate_handover
from inhand_lab.world.rigs import RigSimulation

USUAL_FRAMES = 450
"""Frames of a whole handover."""


@dataclass(frozen=True)
class HandoverIds:
    """The numbers that a rig of so many ``cameras`` gave to giver and taker of a seed, with the
    number of frames of each; ``frames`` in which any camera saw somebody, those with a third
    person, and how far fused joints are from true ones, in metres: the mean, and the largest mean
    of a person and frame. ``camera_numbers`` is how many numbers each camera gave to both."""

    seed: int
    frames: int
    numbers: tuple[Mapping[int, int], Mapping[int, int]]
    with_a_third: int
    mean_m: float
    largest_m: float
    camera_numbers: Mapping[str, int]

    @property
    def unseen(self) -> int:
        """Number of times that one of both is nobody in a frame."""
        return 2 * self.frames - sum(sum(own.values()) for own in self.numbers)

    @property
    def right(self) -> bool:
        """Whether both have one number each, never the other's, and there is nobody else."""
        giver, taker = self.numbers
        alone = len(giver) == len(taker) == 1 and giver.keys() != taker.keys()
        return alone and self.with_a_third == 0


def check_handovers(
    seeds: Sequence[int],
    cameras: int,
    processes: int,
    on_done: Callable[[], None] = lambda: None,
) -> list[HandoverIds]:
    """Check a handover of each seed; ``on_done`` is called after each. Raises ValueError for a
    number of cameras that no rig has."""
    check = partial(check_handover, cameras=cameras)
    return in_processes(check, list(seeds), processes, lambda _: on_done())


def check_handover(seed: int, cameras: int, frames: int = USUAL_FRAMES) -> HandoverIds:
    """Simulate a handover and fuse its people, frame by frame of the first camera."""
    handover = simulate_handover(seed, cameras, frames)
    rig = handover.rig
    places = zip(rig.names, map(placement_of, rig.rig_from_camera), strict=True)
    fuser = PeopleFuser(dict(places))
    truth = _true_joints(rig)
    numbers: tuple[Counter[int], Counter[int]] = (Counter(), Counter())
    seen_frames, with_a_third, errors = 0, 0, []
    # The others take their last frame before the first one does.
    for tick in range(rig.cameras[0].frames - 1):
        seen = [
            CameraPeople(rig.names[camera], time_ns, handover.people(camera, frame))
            for camera, frame, time_ns in nearest_frames(rig, tick)
        ]
        if not seen:
            continue
        people = fuser.fuse(seen, seen[0].time_ns)
        seen_frames += 1
        with_a_third += len(people) > len(truth)
        for person in people:
            away = [
                float(np.nanmean(np.linalg.norm(person.joints - joints[tick], axis=1)))
                for joints in truth
            ]
            role = int(np.argmin(away))
            numbers[role][person.identity] += 1
            errors.append(away[role])
    return HandoverIds(
        seed,
        seen_frames,
        (dict(numbers[0]), dict(numbers[1])),
        with_a_third,
        float(np.mean(errors)),
        float(np.max(errors)),
        _camera_numbers(handover),
    )


def _true_joints(rig: RigSimulation) -> tuple[Array, Array]:
    """True joints (T, 20, 3) of giver and taker in the rig's frame, at the first camera's times."""
    first, rig_from_first = rig.cameras[0], rig.rig_from_camera[0]
    giver, taker = first.body_in_camera, first.others[0].body_in_camera
    return rig_from_first.apply(giver.joints), rig_from_first.apply(taker.joints)


def _camera_numbers(handover: HandoverSimulation) -> dict[str, int]:
    return {
        name: len(set(numbers[numbers >= 0].tolist()))
        for name, numbers in zip(handover.rig.names, handover.numbers, strict=True)
    }
