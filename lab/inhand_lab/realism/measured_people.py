"""Measures real and simulated people alike, each by skeletons, depth and returning poses.

The real ones are those of UTD-MHAD; the simulated ones are seen with the Kinect preset.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from inhand_tracker.geometry.arrays import Array
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.geometry.transforms import Transform
from inhand_lab.importers import utd_mhad
from inhand_lab.realism.depth_properties import DepthMeasures, DepthPair, measure_pair
from inhand_lab.realism.parameters import DEFAULT_REALISM
from inhand_lab.realism.repeatability import body_pose_sequence, return_distance_by_joint
from inhand_lab.realism.skeleton_properties import FRAME_RATE, ObservedSkeletons
from inhand_lab.sensing.render import ROOM
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import Simulation, simulate


@dataclass(frozen=True)
class MeasuredPerson:
    """What was measured of one person.

    ``again`` (20,) is how nearly each joint comes back, in statures, in movements of the arms
    alone.
    """

    skeletons: list[ObservedSkeletons]
    depth: list[DepthMeasures]
    again: Array


def real_people(folder: Path) -> list[MeasuredPerson]:
    """Measure the people of UTD-MHAD's recordings; raises DatasetError where there are none."""
    files = sorted(folder.glob(f"*{utd_mhad.SKELETON_SUFFIX}"))
    if not files:
        raise DatasetError(f"{folder} has no recordings of UTD-MHAD: name their folder with --data")
    trials = [utd_mhad.read_trial(file) for file in files]
    names = sorted({trial.participant for trial in trials})
    return [_real_person([one for one in trials if one.participant == name]) for name in names]


def simulated_people(seed: int, participants: int) -> list[MeasuredPerson]:
    """Measure the people of a seed's world, who all do everything.

    Of depth about as many frames are measured as there are real ones.
    """
    return [_simulated_person(seed, number) for number in range(participants)]


def _real_person(trials: Sequence[utd_mhad.UtdMhadTrial]) -> MeasuredPerson:
    return MeasuredPerson(
        [ObservedSkeletons.of(trial.joints_in_camera) for trial in trials],
        [measure_pair(pair) for trial in trials for pair in _real_pairs(trial)],
        _return_distances([one for one in trials if one.interaction in DEFAULT_REALISM.mimed]),
    )


def _simulated_person(seed: int, number: int) -> MeasuredPerson:
    done = [simulate(interaction, number, seed) for interaction in INTERACTIONS]
    step = DEFAULT_REALISM.simulated_depth_step
    return MeasuredPerson(
        [ObservedSkeletons.of(one.joints_in_camera) for one in done],
        [measure_pair(pair) for one in done[number % step :: step] for pair in _pairs_of(one)],
        _return_distances([one for one in done if one.interaction in DEFAULT_REALISM.worked]),
    )


def _return_distances(recordings: Sequence[utd_mhad.UtdMhadTrial] | Sequence[Simulation]) -> Array:
    """Measure how nearly each joint (20,) of one person comes back in doing the same."""
    actions = sorted({one.interaction for one in recordings})
    distances = [
        return_distance_by_joint(
            [
                body_pose_sequence("", FRAME_RATE, "right", one.joints_in_camera)
                for one in recordings
                if one.interaction == action
            ]
        )
        for action in actions
    ]
    return np.mean(distances, axis=0)


def _real_pairs(trial: utd_mhad.UtdMhadTrial) -> Iterator[DepthPair]:
    """Yield the pairs of depth frames of a recording that are measured."""
    if trial.depth_file is None:
        return
    depth, joints = utd_mhad.read_depth(trial.depth_file), trial.joints_in_camera
    count = min(len(depth), len(joints))
    centre = (utd_mhad.WIDTH - 1 - utd_mhad.MIRRORED_CX, utd_mhad.CY)
    for frame in range(DEFAULT_REALISM.first_depth_frame, count - 1, DEFAULT_REALISM.depth_step):
        yield DepthPair(
            (depth[frame], depth[frame + 1]),
            (joints[frame], joints[frame + 1]),
            utd_mhad.FOCAL_LENGTH,
            centre,
        )


def _pairs_of(simulation: Simulation) -> Iterator[DepthPair]:
    """Yield the pairs of simulated depth frames that are measured.

    They are without object and furniture, for the real people mime.
    """
    behind = Transform(np.array([0.0, 0.0, -9.0]), np.eye(3)).repeated(simulation.frames)
    simulation = replace(simulation, camera_from_object=behind, furniture=())
    intrinsics, joints = simulation.intrinsics, simulation.joints_in_camera
    for frame in DEFAULT_REALISM.simulated_depth_frames:
        yield DepthPair(
            (_person_alone(simulation, frame), _person_alone(simulation, frame + 1)),
            (joints[frame], joints[frame + 1]),
            0.5 * intrinsics.fx,
            (0.5 * intrinsics.cx, 0.5 * intrinsics.cy),
        )


def _person_alone(simulation: Simulation, frame: int) -> NDArray[np.uint16]:
    """Draw the person at half the resolution, cut out by depth as the recordings are."""
    drawing, seen = simulation.draw(frame), simulation.render(frame)
    true_depth = drawing.canvas.depth_in_millimetres()
    person = drawing.canvas.labels > ROOM
    behind = true_depth[person].max() + DEFAULT_REALISM.cut_out_mm
    near = binary_dilation(person, iterations=DEFAULT_REALISM.cut_out_pixels)
    return np.where(near & (seen.depth < behind), seen.depth, 0)[::2, ::2].astype(np.uint16)
