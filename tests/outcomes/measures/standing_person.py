"""Somebody who stands and faces y, and the tracks of things that move about them."""

import numpy as np
from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.track import Track
from inhand_schemas.joints import Joint
from scipy.spatial.transform import Rotation

HEAD = np.array([0.0, 0.0, 1.65])
MOUTH = np.array([0.0, 0.09, 1.59])
EYES = np.array([0.0, 0.09, 1.66])
FOOT = np.array([0.1, 0.06, 0.05])
"""The right instep."""
PLACES = {
    Joint.HIP_CENTER: (0.0, 0.0, 1.0),
    Joint.SPINE: (0.0, 0.0, 1.09),
    Joint.SHOULDER_CENTER: (0.0, 0.0, 1.45),
    Joint.HEAD: tuple(HEAD),
    Joint.SHOULDER_LEFT: (-0.19, 0.0, 1.41),
    Joint.SHOULDER_RIGHT: (0.19, 0.0, 1.41),
    Joint.ANKLE_RIGHT: (0.1, 0.0, 0.08),
    Joint.FOOT_RIGHT: (0.1, 0.12, 0.02),
    Joint.ANKLE_LEFT: (-0.1, 0.0, 0.08),
    Joint.FOOT_LEFT: (-0.1, 0.12, 0.02),
}


def rotations_of(track: Track) -> Rotation:
    """The object's T rotations."""
    return Rotation.from_quat(track.poses[:, 3:], scalar_first=True)


def frame_times(seconds: float, rate: float = 20.0) -> Array:
    """Times (T,) of a camera's frames."""
    return np.arange(round(seconds * rate)) / rate


def going(times: Array, *keys: tuple[float, object]) -> Array:
    """Values (T, ...) through keys (time, value), straight in between."""
    at = [time for time, _ in keys]
    values = np.array([value for _, value in keys], float)
    flat = values.reshape(len(keys), -1)
    columns = [np.interp(times, at, column) for column in flat.T]
    return np.stack(columns, axis=1).reshape(len(times), *values.shape[1:])


def beside(place: Array, *way: float) -> Array:
    """A place (3,) that lies x, y, z metres from another."""
    return np.asarray(place + np.array(way))


def turns(axis: str, degrees: Array) -> Rotation:
    """Turns about an axis, x, y or z, by degrees (T,)."""
    return Rotation.from_rotvec(np.outer(np.radians(degrees), np.eye(3)["xyz".index(axis)]))


def track_of(
    times: Array,
    places: Array,
    rotations: Rotation | None = None,
    hands: Array | None = None,
    seen: Flags | None = None,
) -> Track:
    """A thing at places (T, 3), the right hand at ``hands`` (T, 3), or else at the thing."""
    count = len(times)
    joints = np.full((count, 20, 3), np.nan)
    for joint, place in PLACES.items():
        joints[:, joint] = place
    joints[:, Joint.HAND_RIGHT] = places if hands is None else hands
    turned = Rotation.identity(count) if rotations is None else rotations
    covariance = np.diag([0.01**2] * 3 + [np.radians(3.0) ** 2] * 3)
    return Track(
        times,
        np.hstack([places, turned.as_quat(canonical=True, scalar_first=True)]),
        np.tile(covariance, (count, 1, 1)),
        np.ones(count, bool) if seen is None else seen,
        joints,
    )


def elsewhere(track: Track, seconds: float, heading: float, kept: Flags) -> Track:
    """The kept frames (T,) of the same act, later, in a room that is turned about the vertical."""
    turn = Rotation.from_euler("z", heading)
    matrix = turn.as_matrix()
    both = np.kron(np.eye(2), matrix)
    rotations = (turn * rotations_of(track)).as_quat(canonical=True, scalar_first=True)
    return Track(
        track.times + seconds,
        np.hstack([track.positions @ matrix.T, rotations]),
        both @ track.covariances @ both.T,
        track.seen,
        track.joints @ matrix.T,
    )[kept]
