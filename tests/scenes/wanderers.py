"""Somebody who wanders about a room, seen by cameras that err a little: quick, and fully known."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from inhand_calibration.arrays import Array
from inhand_calibration.from_people.calibration import PeopleCalibration
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_lab.geometry.transforms import Transform
from inhand_lab.world.wanderer_views import WandererCamera, wander_at
from inhand_schemas.messages import Pose
from scipy.spatial.transform import Rotation

SECONDS = 24.0
EPOCH_NS = 1_700_000_000_000_000_000
FRONT = WandererCamera("front", 0.0, 3.4, 1.4, frame_rate=15.0)
LEFT = WandererCamera("left", 1.4, 3.8, 1.9, frame_rate=15.0, offset_s=0.3)
BACK = WandererCamera("back", 3.0, 3.6, 1.1, frame_rate=15.0, offset_s=-2.0, dropped_share=0.05)
NODE_S = 1.0 / 30.0
"""Time between the moments of which the true movement is made."""


@dataclass(frozen=True)
class Errors:
    """A camera's errors relative to the reference: metres, degrees, seconds."""

    translation: float
    rotation: float
    clock: float


@cache
def true_movement(seed: int, seconds: float = SECONDS) -> Array:
    """True joints (T, 20, 3) in the world, each thirtieth of a second."""
    return wander_at(0, seed, seconds, np.arange(int(seconds / NODE_S)) * NODE_S).joints


def still_movement(seed: int, seconds: float = SECONDS) -> Array:
    """Joints of somebody who stands as they stood at first."""
    first = true_movement(seed)[:1]
    return np.repeat(first, int(seconds / NODE_S), axis=0)


def circling_movement(seconds: float = SECONDS) -> Array:
    """Joints of somebody who goes round and round, a round in four seconds, and is stiff."""
    angle = 2.0 * np.pi * np.arange(int(seconds / NODE_S)) * NODE_S / 4.0
    turn = Rotation.from_euler("z", angle[:, None]).as_matrix()
    body = true_movement(1)[0]
    body = body - body[0] * [1.0, 1.0, 0.0] + [0.9, 0.0, 0.0]
    return np.einsum("tij,kj->tki", turn, body)


def pacing_movement(seconds: float = SECONDS) -> Array:
    """Joints of somebody who goes to and fro on the same way, six seconds each time."""
    way = true_movement(1)[: int(3.0 / NODE_S)]
    round_trip = np.concatenate([way, way[::-1]])
    return np.tile(round_trip, (int(seconds / 6.0), 1, 1))


def watch(
    camera: WandererCamera, movement: Array, seed: int = 0, noise: float = 0.004, person: int = 0
) -> CameraSkeletons:
    """What a camera sees of one person's movement (T, 20, 3); each joint wanders from the truth by
    ``noise`` metres, anew each second."""
    random = np.random.default_rng([seed, round(1e3 * camera.around), person])
    seconds = len(movement) * NODE_S
    first = (random.uniform(0.0, 1.0) / camera.frame_rate - camera.offset_s) / (1.0 + camera.drift)
    said = first + np.arange(int(seconds * camera.frame_rate)) / camera.frame_rate
    said = said[camera.true_times(said) < seconds - 2.0 * NODE_S]
    said = said[random.random(len(said)) >= camera.dropped_share]
    at = camera.true_times(said) / NODE_S
    node, share = at.astype(int), (at % 1.0)[:, None, None]
    true = (1.0 - share) * movement[node] + share * movement[node + 1]
    knots = random.normal(size=(int(seconds) + 3, 20, 3))
    steps = at * NODE_S
    knot, part = steps.astype(int), (steps % 1.0)[:, None, None]
    error = np.sqrt(1.0 - part) * knots[knot] + np.sqrt(part) * knots[knot + 1]
    joints = camera.world_from_camera.inverse().apply(true + noise * error)
    return CameraSkeletons(
        camera.name,
        EPOCH_NS + np.rint(1e9 * said).astype(np.int64),
        np.full(len(said), person),
        joints,
        np.full((len(said), 20), 0.9),
    )


def together(*seen: CameraSkeletons) -> CameraSkeletons:
    """What one camera sees of several people."""
    order = np.argsort(np.concatenate([one.times_ns for one in seen]), kind="stable")
    return CameraSkeletons(
        seen[0].name,
        *(
            np.concatenate([getattr(one, name) for one in seen])[order]
            for name in ("times_ns", "people", "joints", "confidences")
        ),
    )


def part_of(seen: CameraSkeletons, first: float, last: float) -> CameraSkeletons:
    """What a camera saw from one share of its frames to another."""
    rows = slice(int(first * len(seen.times_ns)), int(last * len(seen.times_ns)))
    return CameraSkeletons(
        seen.name, seen.times_ns[rows], seen.people[rows], seen.joints[rows], seen.confidences[rows]
    )


def with_joints(seen: CameraSkeletons, joints: Array) -> CameraSkeletons:
    """The same with other joints (N, 20, 3)."""
    return replace(seen, joints=joints)


def errors_of(
    calibration: PeopleCalibration, reference: WandererCamera, camera: WandererCamera
) -> Errors:
    """A camera's errors, where both clocks do not drift."""
    found = calibration.cameras[camera.name]
    reference_from_camera = transform_of(
        calibration.cameras[reference.name].rig_from_camera
    ).inverse() @ transform_of(found.rig_from_camera)
    truth = reference.world_from_camera.inverse() @ camera.world_from_camera
    turn = Rotation.from_matrix(reference_from_camera.rotation.T @ truth.rotation)
    offset = camera.offset_s - reference.offset_s
    return Errors(
        float(np.linalg.norm(reference_from_camera.translation - truth.translation)),
        float(np.degrees(turn.magnitude())),
        abs(1e-9 * found.clock_offset_ns - offset),
    )


def within_aims(errors: Sequence[Errors]) -> bool:
    """Whether all are within 1.5 cm, 0.5° and 5 ms."""
    return all(e.translation < 0.015 and e.rotation < 0.5 and e.clock < 0.005 for e in errors)


def transform_of(pose: Pose) -> Transform:
    """A pose as a transform."""
    rotation = Rotation.from_quat(pose.rotation, scalar_first=True).as_matrix()
    return Transform(np.array(pose.translation), rotation)
