"""Simulated acts of all uses before one camera, as the messages of a tracker that errs."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from inhand_lab.geometry.transforms import Transform
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import Simulation, simulate
from inhand_runtime.pixels import encode_depth
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, RgbdFrame, Skeletons
from msgspec.structs import replace
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

FRAMES = 360
PLACE_M, TURN_RAD, LASTS_S = 0.015, np.radians(5.0), 0.3
"""What a tracker errs by in place and turn, and for how long it errs alike."""
SIZE, FOCAL = (640, 480), 525.0
FURTHEST_M = 6.0


@dataclass(frozen=True)
class Act:
    """A performance of one interaction, seen by a camera that stands elsewhere than its own."""

    simulation: Simulation
    camera_from_world: Transform

    @cached_property
    def name(self) -> str:
        """The object's name."""
        return self.simulation.object_model.name

    @cached_property
    def seconds(self) -> float:
        """How long it is."""
        return self.simulation.frames / self.simulation.frame_rate

    @cached_property
    def _to_camera(self) -> Transform:
        return self.camera_from_world @ self.simulation.camera_from_world.inverse()

    def messages(
        self, start_ns: int, person: int, first: int
    ) -> Iterator[tuple[Skeletons, ObjectPose]]:
        """The frames in order, numbered from ``first``: the person, and where the object is."""
        simulation, moved = self.simulation, self._to_camera
        places, turns = self._errors()
        true = moved @ simulation.camera_from_object
        rotations = turns * Rotation.from_matrix(true.rotation)
        deviations = np.repeat([PLACE_M / 3**0.5, TURN_RAD / 3**0.5], 3)
        covariance = tuple(np.diag(deviations**2).ravel().tolist())
        for frame in range(simulation.frames):
            number = first + frame
            time_ns = start_ns + round(frame * 1e9 / simulation.frame_rate)
            said = person_message(simulation, frame)
            joints = moved.apply(np.array(said.joints)).tolist()
            shown = replace(said, id=person, joints=tuple((x, y, z) for x, y, z in joints))
            x, y, z = (true.translation[frame] + places[frame]).tolist()
            i, j, k, w = rotations[frame].as_quat().tolist()
            yield (
                Skeletons(sequence=number, time_ns=time_ns, people=(shown,)),
                ObjectPose(
                    sequence=number,
                    time_ns=time_ns,
                    object=self.name,
                    camera="front",
                    state="tracked",
                    confidence=0.9,
                    person=person,
                    camera_from_object=Pose((x, y, z), (w, i, j, k)),
                    covariance=covariance,
                    class_probabilities={self.name: 0.9},
                ),
            )

    def _errors(self) -> tuple[NDArray[np.float64], Rotation]:
        """Errors of places (T, 3) and turns (T), alike for a while."""
        simulation = self.simulation
        random = np.random.default_rng([simulation.seed, simulation.participant])
        stays = np.exp(-1.0 / (simulation.frame_rate * LASTS_S))
        steps = random.standard_normal((simulation.frames, 6))
        steps[1:] *= np.sqrt(1.0 - stays**2)
        for frame in range(1, len(steps)):
            steps[frame] += stays * steps[frame - 1]
        steps /= 3**0.5
        return PLACE_M * steps[:, :3], Rotation.from_rotvec(TURN_RAD * steps[:, 3:])


def rounds_of_acts(seeds: Sequence[int]) -> list[list[Act]]:
    """A round for each seed with an act of each interaction, all before one camera; the rounds'
    people alternate."""
    rounds = [
        [simulate(interaction, number % 2, seed, FRAMES) for interaction in INTERACTIONS]
        for number, seed in enumerate(seeds)
    ]
    camera = rounds[0][0].camera_from_world
    return [[Act(one, camera) for one in acts] for acts in rounds]


def camera_info() -> CameraInfo:
    """How the camera sees."""
    (width, height), middle = SIZE, (SIZE[0] / 2 - 0.5, SIZE[1] / 2 - 0.5)
    cx, cy = middle
    return CameraInfo(
        sequence=0, time_ns=0, width=width, height=height, fx=FOCAL, fy=FOCAL, cx=cx, cy=cy
    )


def floor_frame(act: Act, sequence: int, time_ns: int) -> RgbdFrame:
    """What the camera sees of an empty room: its floor."""
    info, camera = camera_info(), act.camera_from_world
    v, u = np.mgrid[0 : info.height, 0 : info.width]
    rays = np.stack([(u - info.cx) / info.fx, (v - info.cy) / info.fy, np.ones(u.shape)], axis=-1)
    up = camera.rotation[:, 2]
    with np.errstate(divide="ignore"):
        depth = (up @ camera.translation) / (rays @ up)
    seen = (depth > 0.0) & (depth < FURTHEST_M)
    pixels = np.where(seen, np.rint(1000.0 * depth), 0.0).astype(np.uint16)
    return RgbdFrame(sequence=sequence, time_ns=time_ns, depth=encode_depth(pixels))


def write_models(acts: Sequence[Act], folder: Path) -> list[Path]:
    """Write as much of a model of each act's object as tells its mesh and what it is used for."""
    paths = []
    for act in acts:
        model = act.simulation.object_model
        said = json.dumps({"object": act.name, "interaction": act.simulation.interaction})
        paths.append(folder / f"{act.name}.model")
        with paths[-1].open("wb") as file:
            np.savez(
                file,
                **{
                    "model": np.array(said),
                    "shape.vertices": np.asarray(model.vertices, np.float64),
                    "shape.faces": np.asarray(model.faces, np.int64),
                },
            )
    return paths
