"""Measures how well cameras are placed, and their clocks set, by a person who walks about."""

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_calibration.from_people.calibration import (
    PeopleCalibratedCamera,
    PeopleCalibration,
    calibrate_from_people,
)
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_schemas.messages import Pose
from scipy.spatial.transform import Rotation

from inhand_lab.benchmarks.parameters import (
    DEFAULT_PEOPLE_CALIBRATION_CHECK,
    PeopleCalibrationCheckParameters,
)
from inhand_lab.geometry.transforms import Transform
from inhand_lab.world.wanderer_views import WandererCamera, WandererView, watch_wanderer


@dataclass(frozen=True)
class CameraErrors:
    """One camera's errors relative to the reference: place, rotation and clock, the deviations
    that the calibration gives them, and the squared error of the pose over its covariance, divided
    by 6, which is 1 on average where the covariance is right."""

    seed: int
    name: str
    translation_mm: float
    rotation_deg: float
    clock_ms: float
    translation_deviation_mm: float
    rotation_deviation_deg: float
    clock_deviation_ms: float
    consistency: float


@dataclass(frozen=True)
class RigErrors:
    """Errors of all cameras but the reference; of the floor, where it was found: the tilt of up and
    the height; and the processor time that calibration took, seconds."""

    cameras: tuple[CameraErrors, ...]
    tilt_deg: float | None
    floor_mm: float | None
    seconds: float


@dataclass(frozen=True)
class PeopleCalibrationSummary:
    """Medians and the worst of all cameras' errors, and the share of cameras within all aims."""

    cameras: int
    translation_mm: float
    worst_translation_mm: float
    rotation_deg: float
    worst_rotation_deg: float
    clock_ms: float
    worst_clock_ms: float
    within_aims: float


def measure_people_calibration(
    parameters: PeopleCalibrationCheckParameters = DEFAULT_PEOPLE_CALIBRATION_CHECK,
) -> Iterator[RigErrors]:
    """Yield each seed's errors; raises CalibrationError where a calibration fails."""
    for seed in parameters.seeds:
        cameras = _cameras(seed, parameters)
        views = watch_wanderer(0, seed, parameters.seconds, cameras)
        skeletons = [skeletons_of(view) for view in views]
        began = time.process_time()
        calibration = calibrate_from_people(skeletons, cameras[0].name)
        yield _errors(seed, cameras, calibration, time.process_time() - began)


def summed_up(
    rigs: list[RigErrors],
    parameters: PeopleCalibrationCheckParameters = DEFAULT_PEOPLE_CALIBRATION_CHECK,
) -> PeopleCalibrationSummary:
    """Sum up the errors of one rig or more."""
    errors = np.array(
        [
            (camera.translation_mm, camera.rotation_deg, camera.clock_ms)
            for rig in rigs
            for camera in rig.cameras
        ]
    )
    aims = (parameters.aim_mm, parameters.aim_deg, parameters.aim_ms)
    medians, worst = np.median(errors, axis=0), errors.max(axis=0)
    return PeopleCalibrationSummary(
        len(errors),
        float(medians[0]),
        float(worst[0]),
        float(medians[1]),
        float(worst[1]),
        float(medians[2]),
        float(worst[2]),
        float((errors <= aims).all(axis=1).mean()),
    )


def skeletons_of(view: WandererView) -> CameraSkeletons:
    """Return what a camera saw of a wanderer as calibration takes it."""
    alone = np.zeros(len(view.said_s), np.int64)
    return CameraSkeletons(view.camera.name, view.stamps_ns, alone, view.joints, view.confidences)


def _cameras(seed: int, parameters: PeopleCalibrationCheckParameters) -> list[WandererCamera]:
    """Cameras that nobody chose; the first's clock is right."""
    random = np.random.default_rng([seed, 0xCA11])
    return [
        WandererCamera(
            name=f"camera{number}",
            around=float(np.radians(random.uniform(*around))),
            distance=float(random.uniform(*parameters.distance_m)),
            height=float(random.uniform(*parameters.height_m)),
            frame_rate=frame_rate,
            offset_s=float(random.uniform(-1.0, 1.0)) * parameters.offset_s * (number > 0),
            drift=1e-6 * float(random.uniform(-1.0, 1.0)) * parameters.drift_ppm * (number > 0),
            dropped_share=parameters.dropped_share,
        )
        for number, (around, frame_rate) in enumerate(
            zip(parameters.around_deg, parameters.frame_rates, strict=True)
        )
    ]


def _errors(
    seed: int, cameras: list[WandererCamera], calibration: PeopleCalibration, seconds: float
) -> RigErrors:
    reference = cameras[0]
    found = calibration.cameras[reference.name].rig_from_camera
    # The calibration's frame is compared where it is given: at the reference camera.
    rig_from_world = _transform(found) @ reference.world_from_camera.inverse()
    up = rig_from_world.rotation[:, 2]
    origin = rig_from_world.inverse().translation
    floor = calibration.floor is not None
    return RigErrors(
        tuple(
            _camera_errors(
                seed, camera, calibration.cameras[camera.name], rig_from_world, calibration
            )
            for camera in cameras[1:]
        ),
        float(np.degrees(np.arccos(min(float(up[2]), 1.0)))) if floor else None,
        1e3 * abs(float(origin[2])) if floor else None,
        seconds,
    )


def _camera_errors(
    seed: int,
    camera: WandererCamera,
    found: PeopleCalibratedCamera,
    rig_from_world: Transform,
    calibration: PeopleCalibration,
) -> CameraErrors:
    pose, truth = _transform(found.rig_from_camera), rig_from_world @ camera.world_from_camera
    shift = pose.translation - truth.translation
    turn = Rotation.from_matrix(pose.rotation @ truth.rotation.T).as_rotvec()
    error = np.concatenate([shift, turn])
    deviations = np.sqrt(np.diag(found.covariance))
    # The reference's clock is right: what it says is the true time.
    said = (1e-9 * calibration.made_at_ns - camera.offset_s) / (1.0 + camera.drift)
    true_offset = 1e-9 * calibration.made_at_ns - said
    return CameraErrors(
        seed,
        camera.name,
        1e3 * float(np.linalg.norm(shift)),
        float(np.degrees(np.linalg.norm(turn))),
        1e3 * abs(1e-9 * found.clock_offset_ns - true_offset),
        1e3 * float(np.linalg.norm(deviations[:3])),
        float(np.degrees(np.linalg.norm(deviations[3:]))),
        1e-6 * found.clock_deviation_ns,
        float(error @ np.linalg.solve(found.covariance, error)) / len(error),
    )


def _transform(pose: Pose) -> Transform:
    rotation = Rotation.from_quat(pose.rotation, scalar_first=True).as_matrix()
    return Transform(np.array(pose.translation), rotation)
