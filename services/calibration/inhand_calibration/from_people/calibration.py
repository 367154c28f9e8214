"""Where the cameras of a rig are and how far their clocks are apart, from a person who walks about.

calibration = calibrate_from_people([front, left, right], reference="front")
calibration.cameras["left"].rig_from_camera       # a Pose
calibration.cameras["left"].clock_offset_ns       # to add to the left camera's times
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
from inhand_runtime.rig_calibration import CameraCalibration, RigCalibration
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Pose

from inhand_calibration.arrays import Array, Flags
from inhand_calibration.errors import CalibrationError
from inhand_calibration.floor import Floor
from inhand_calibration.from_people.chain import chain_of_pairs
from inhand_calibration.from_people.estimate import CameraEstimate, estimate_of
from inhand_calibration.from_people.parameters import (
    DEFAULT_PEOPLE_CALIBRATION,
    AcceptanceParameters,
    PeopleCalibrationParameters,
    RefinementParameters,
)
from inhand_calibration.from_people.refinement import EstimatePrior, Refined, refine
from inhand_calibration.from_people.rig_frame import floor_frame, frame_in_words
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_calibration.from_people.standing_floor import find_standing_floor
from inhand_calibration.from_people.tracks import Track, find_tracks
from inhand_calibration.rigid import rigid, to_pose

_OFFSET, _DRIFT = 6, 7


@dataclass(frozen=True)
class PosePrior:
    """What is known before of a camera, as from a board: its pose in the reference camera's frame.

    ``covariance`` (6, 6) is of the translation, metres, and the rotation vector, radians, both
    along the axes of the reference camera's frame.
    """

    reference_from_camera: Pose
    covariance: Array


@dataclass(frozen=True)
class PeopleCalibratedCamera:
    """One camera as people showed it.

    ``covariance`` (6, 6) is of the translation, metres, and the rotation vector, radians, along
    the rig's axes, relative to the reference camera (whose own is 0). ``clock_offset_ns`` is what
    to ADD to the camera's times to have the reference's, in the middle of the recording; it grows
    by ``clock_drift_ppm`` of the time since. ``residual_m`` is the median distance of its people's
    joints from other cameras', 0 where it shares none; ``moments`` is the number of moments, a
    tenth of a second apart, that it shares with others. ``scale`` is the size of its people over
    that in the other cameras.
    """

    rig_from_camera: Pose
    covariance: Array
    clock_offset_ns: int
    clock_deviation_ns: int
    clock_drift_ppm: float
    clock_drift_deviation_ppm: float
    residual_m: float
    moments: int
    scale: float


@dataclass(frozen=True)
class PeopleCalibration:
    """A rig's cameras by name, the ``floor`` in the reference camera's frame, None where feet were
    not seen to rest, and ``warnings``: sentences on what does not fit.

    With a floor the rig's frame has z up and its origin on the floor below the reference camera,
    or below where the user said, x the way that camera looks; without one its axes are the
    reference camera's. ``frame`` says so in words. ``made_at_ns`` is the time by the reference's
    clock for which the clock offsets hold.
    """

    reference: str
    cameras: Mapping[str, PeopleCalibratedCamera]
    floor: Floor | None
    warnings: tuple[str, ...]
    frame: str
    made_at_ns: int

    def rig_calibration(self, made: datetime) -> RigCalibration:
        """Return what is written to a rig's file, made at that time."""
        cameras = {name: _for_file(camera, made) for name, camera in self.cameras.items()}
        return RigCalibration(cameras, self.frame)


def _for_file(camera: PeopleCalibratedCamera, made: datetime) -> CameraCalibration:
    deviations = [float(value) for value in np.sqrt(np.diag(camera.covariance))]
    return CameraCalibration(
        camera.rig_from_camera,
        (deviations[0], deviations[1], deviations[2]),
        (deviations[3], deviations[4], deviations[5]),
        "people",
        made,
        camera.clock_offset_ns,
        camera.clock_deviation_ns,
    )


def calibrate_from_people(
    cameras: Sequence[CameraSkeletons],
    reference: str,
    origin: Array | None = None,
    priors: Mapping[str, PosePrior] | None = None,
    clocks_within_s: float = np.inf,
    parameters: PeopleCalibrationParameters = DEFAULT_PEOPLE_CALIBRATION,
) -> PeopleCalibration:
    """Find where two or more cameras are, and how far their clocks are apart.

    ``origin`` (3,), a point in the reference camera's frame, has the rig's origin on the floor
    below it in place of the camera; without a floor it is the rig's origin itself. ``priors`` are
    by camera name. Clocks are known to be within ``clocks_within_s`` seconds of each other; that
    helps where people do the same over and over. Raises CalibrationError where it cannot be known,
    with what to do.
    """
    ordered = _ordered(cameras, reference)
    tracks = [_tracks_of(one, parameters) for one in ordered]
    names = [one.name for one in ordered]
    # Since the first camera's begin: seconds since the epoch are exact to a microsecond only.
    begins = [1e-9 * int(one.times_ns[0] - ordered[0].times_ns[0]) for one in ordered]
    estimates = chain_of_pairs(names, tracks, parameters, begins, clocks_within_s)
    known = {
        names.index(name): EstimatePrior(estimate_of(prior.reference_from_camera), prior.covariance)
        for name, prior in (priors or {}).items()
        if name in names[1:]
    }
    refined = refine(tracks, estimates, parameters, known)
    _require_certain(names, refined, parameters.acceptance)
    clocks = _clock_deviations(ordered, refined, parameters.refinement)
    floor = find_standing_floor(tracks, refined.estimates, parameters.floor)
    rig = floor_frame(floor, origin)
    calibrated = {
        name: _calibrated(ordered, camera, refined, rig, clocks[camera])
        for camera, name in enumerate(names)
    }
    middle = ordered[0].times_ns[0] + round(1e9 * refined.estimates[0].middle)
    warnings = _warnings(calibrated, floor, parameters.acceptance)
    frame = frame_in_words(reference, floor, origin)
    return PeopleCalibration(reference, calibrated, floor, warnings, frame, int(middle))


def _ordered(cameras: Sequence[CameraSkeletons], reference: str) -> list[CameraSkeletons]:
    """The cameras, the reference first."""
    names = [camera.name for camera in cameras]
    if len(cameras) < 2 or len(set(names)) < len(names):
        raise CalibrationError(
            f"a calibration from people takes two cameras or more, each once, not {len(cameras)} "
            f"({', '.join(names) or 'none'})"
        )
    if reference not in names:
        raise CalibrationError(
            f"the reference {reference} is none of the cameras {', '.join(names)}: name one"
        )
    return sorted(cameras, key=lambda camera: camera.name != reference)


def _tracks_of(skeletons: CameraSkeletons, parameters: PeopleCalibrationParameters) -> list[Track]:
    """One camera's movements; raises CalibrationError where they are too short."""
    tracks = find_tracks(skeletons, parameters.movement)
    seconds = sum(track.end - track.start for track in tracks)
    least = parameters.acceptance.least_s
    if not tracks:
        raise CalibrationError(
            f"{skeletons.name} followed nobody for two seconds: walk about where it sees you from "
            "head to foot (in an image that is upside down some trackers find nobody: write "
            "rotate = 180 in its settings)"
        )
    if seconds < least:
        raise CalibrationError(
            f"{skeletons.name} saw people for {seconds:.0f} s, and {least:.0f} s are needed: walk "
            "about for a minute where all cameras see you"
        )
    return tracks


def _require_certain(
    names: Sequence[str], refined: Refined, acceptance: AcceptanceParameters
) -> None:
    """Raise CalibrationError for a camera whose clock or pose stays unknown."""
    for camera, name in enumerate(names[1:], start=1):
        deviations = np.sqrt(np.diag(refined.covariance_of(camera)))
        if deviations[_OFFSET] > acceptance.most_clock_s:
            raise CalibrationError(
                f"people moved too little to say how far the clocks of {names[0]} and {name} are "
                f"apart (deviation {1e3 * deviations[_OFFSET]:.0f} ms): walk about for a minute"
            )
        place, turn = deviations[:3].max(), deviations[3:6].max()
        if place > acceptance.most_translation_m or turn > acceptance.most_rotation_rad:
            raise CalibrationError(
                f"where {name} is stays uncertain ({100 * place:.0f} cm, {np.degrees(turn):.1f}°): "
                f"walk about all of the room that {name} and another camera see"
            )


def _clock_deviations(
    cameras: Sequence[CameraSkeletons], refined: Refined, parameters: RefinementParameters
) -> list[float]:
    """Deviations of all clock offsets, seconds: filters delay by frames, and rates differ."""
    periods = [float(np.median(np.diff(np.unique(one.times_ns)))) * 1e-9 for one in cameras]
    deviations = [0.0]
    for camera, period in enumerate(periods[1:], start=1):
        seen = float(np.sqrt(refined.covariance_of(camera)[_OFFSET, _OFFSET]))
        delay = parameters.delay_share * (period - periods[0])
        deviations.append(float(np.linalg.norm([seen, delay, parameters.clock_s])))
    return deviations


def _calibrated(
    cameras: Sequence[CameraSkeletons],
    camera: int,
    refined: Refined,
    rig: CameraEstimate,
    clock_deviation: float,
) -> PeopleCalibratedCamera:
    """One camera's result in the frame of the rig: ``rig`` is rig_from_reference."""
    estimate, covariance = refined.estimates[camera], refined.covariance_of(camera)
    turn = np.kron(np.eye(2), rig.rotation)
    deviations = np.sqrt(np.diag(covariance))
    # The first frames of both clocks are 0 s: what is between them belongs to the offset.
    begin = int(cameras[0].times_ns[0]) - int(cameras[camera].times_ns[0])
    distances, counts, scales = _shared(camera, refined)
    return PeopleCalibratedCamera(
        to_pose(rigid(rig.rotation @ estimate.rotation, rig.apply(estimate.translation))),
        turn @ covariance[:6, :6] @ turn.T,
        begin + round(1e9 * estimate.offset),
        round(1e9 * clock_deviation),
        1e6 * estimate.drift,
        1e6 * float(deviations[_DRIFT]),
        float(np.median(distances)) if len(distances) else 0.0,
        counts,
        float(np.median(scales)) if len(scales) else 1.0,
    )


def _shared(camera: int, refined: Refined) -> tuple[Array, int, Array]:
    """Distances of a camera's joints from others', the number of moments that it shares, and the
    sizes of its people over those in other cameras."""
    distances, scales = [np.zeros(0)], [np.zeros(0)]
    moments: set[int] = set()
    for pair, agreement in refined.agreements.items():
        if camera not in pair:
            continue
        first, second = agreement.first, agreement.second
        both = (first.support > 0.0) & (second.support > 0.0)
        own, other = (
            refined.estimates[one].seen_through(side.positions)
            for one, side in zip(pair, (first, second), strict=True)
        )
        distances.append(np.linalg.norm(own - other, axis=2)[both])
        ratio = _sizes(first.positions, both) / _sizes(second.positions, both)
        ratio = ratio[np.isfinite(ratio)]
        scales.append(ratio if camera == pair[0] else 1.0 / ratio)
        moments |= set(agreement.moments.tolist())
    return np.concatenate(distances), len(moments), np.concatenate(scales)


def _sizes(joints: Array, known: Flags) -> Array:
    """Sizes (M,) of bodies: from the hips' middle to the head and to both ankles; NaN where one of
    them is not known."""
    ends = (Joint.HEAD, Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT)
    ways = joints[:, ends] - joints[:, [Joint.HIP_CENTER]]
    size = np.linalg.norm(ways, axis=2).sum(axis=1)
    return np.where(known[:, (*ends, Joint.HIP_CENTER)].all(axis=1), size, np.nan)


def _warnings(
    cameras: Mapping[str, PeopleCalibratedCamera],
    floor: Floor | None,
    acceptance: AcceptanceParameters,
) -> tuple[str, ...]:
    """Sentences on sizes that differ, and on a floor that was not seen."""
    warnings = [
        f"{name} sees people {100 * abs(camera.scale - 1):.1f} % "
        f"{'larger' if camera.scale > 1 else 'smaller'} than the other cameras: check its "
        "intrinsics and its depth scale"
        for name, camera in cameras.items()
        if abs(camera.scale - 1.0) > acceptance.scale_share
    ]
    if floor is None:
        warnings.append(
            "no feet were seen to rest on the floor: the rig's frame is the reference camera's"
        )
    return tuple(warnings)
