"""What is expected of an object's pose in a frame, before its image is looked at."""

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.pose_gaussian import PoseGaussian

from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.parameters import LabellingParameters


def given_by_person(pose: Pose, parameters: LabellingParameters) -> PoseGaussian:
    """Return what a keyframe says: its pose, with a person's inaccuracy."""
    return expected_at(pose, parameters.keyframe_m, parameters.keyframe_rad)


def expected_at(pose: Pose, metres: float, radians: float) -> PoseGaussian:
    """Expect the object at a pose, within these root mean squares."""
    return PoseGaussian(*pose, _covariance(metres, radians))


def along_way(
    last: PoseGaussian, ways: tuple[Pose, Pose], seconds: float, parameters: LabellingParameters
) -> PoseGaussian:
    """Expect the object to move from where it was last as the way does between two frames, which it
    leaves slowly."""
    root = np.sqrt(seconds)
    drift = _drift(root * parameters.drift_m, root * parameters.drift_rad, parameters)
    pose = carried((last.centre, last.rotation), *ways)
    return PoseGaussian(*pose, last.covariance + drift)


def near_way(
    pose: Pose, since_s: float, until_s: float, parameters: LabellingParameters
) -> PoseGaussian:
    """Expect the object near an interpolated pose, seconds after and before keyframes: the farther
    from both, the wider."""
    root = np.sqrt(since_s * until_s / (since_s + until_s))
    known = _covariance(parameters.keyframe_m, parameters.keyframe_rad)
    return PoseGaussian(
        *pose, known + _drift(root * parameters.near_m, root * parameters.near_rad, parameters)
    )


def wider(expected: PoseGaussian, factor: float) -> PoseGaussian:
    """Expect the same with a multiple of its standard deviations."""
    return PoseGaussian(expected.centre, expected.rotation, factor**2 * expected.covariance)


def carried(pose: Pose, way_from: Pose, way_to: Pose) -> Pose:
    """Move a pose as another one moves from ``way_from`` to ``way_to``, in the camera's frame."""
    turn = rotations.multiply(way_to[1], rotations.conjugate(way_from[1]))
    return pose[0] + way_to[0] - way_from[0], rotations.multiply(turn, pose[1])


def fused(first: PoseGaussian, second: PoseGaussian) -> tuple[PoseGaussian, float]:
    """Multiply two distributions; returns the product, and how far apart the means are, in standard
    deviations, the root mean square over six dimensions.

    Where they disagree by more than their covariances say, these are widened until they do not.
    """
    off = first.deviations(second.centre[None], second.rotation[None])[0]
    both = first.covariance + second.covariance
    square = float(off @ np.linalg.solve(both, off)) / len(off)
    gain = first.covariance @ np.linalg.inv(both)
    step = gain @ off
    covariance = max(square, 1.0) * (first.covariance - gain @ first.covariance)
    rotation = rotations.multiply(rotations.from_vector(step[3:]), first.rotation)
    product = PoseGaussian(first.centre + step[:3], rotation, 0.5 * (covariance + covariance.T))
    return product, float(np.sqrt(square))


def _drift(metres: float, radians: float, parameters: LabellingParameters) -> Array:
    """Return the covariance (6, 6) of what an object does beside the way, of which less is along
    the line of sight where its depth is not measured."""
    covariance = _covariance(metres, radians)
    covariance[2, 2] *= parameters.sight_share**2
    return covariance


def _covariance(metres: float, radians: float) -> Array:
    """Return the covariance (6, 6) of root mean squares of a translation and of a rotation."""
    return np.diag(np.repeat([metres**2, radians**2], 3) / 3.0)
