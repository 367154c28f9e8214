"""Where somebody's mouth, eyes and ears are, as far as a skeleton tells."""

from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.track import Track

VERTICAL = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class FaceParameters:
    """Measures of a head, as shares of the neck: of the usual distance from the shoulder centre to
    its middle for the size of the trunk.

    They are those of anthropometry (Drillis & Contini, 1966; ANSUR II) over a neck of 0.112
    statures.
    """

    neck_of_back: float = 0.112 / 0.384
    """The neck as a share of the back, from the hip centre by spine and shoulder centre to the
    middle of the head."""
    neck_m: tuple[float, float] = (0.12, 0.23)
    """Least and largest neck, metres: from small children to tall adults; skeletons say others when
    they err."""
    face_ahead: float = 0.46
    """Mouth and eyes ahead of the middle of the head."""
    mouth_below: float = 0.33
    """The mouth below the middle of the head."""
    eyes_above: float = 0.06
    """The eyes above the middle of the head."""
    ear_aside: float = 0.38
    """Each ear beside the middle of the head."""
    deviation_m: float = 0.035
    """Standard deviation of a point of the face along any axis: heads turn by 20 degrees, which no
    skeleton shows, and the middle of a head is off by 1 to 2 cm."""


DEFAULT_FACE = FaceParameters()


@dataclass(frozen=True)
class Face:
    """A person's head over T frames, points and unit vectors (T, 3) in the room, NaN if unseen.

    It looks where the shoulders face and leans as the neck does.
    """

    middle: Array
    right: Array
    forward: Array
    up: Array
    mouth: Array
    eyes: Array
    size: float
    """The neck, metres: by it distances go with the size of the person."""

    @property
    def seen(self) -> Flags:
        """Where (T,) it is known."""
        return np.asarray(np.all(np.isfinite(self.mouth), axis=1))


def find_face(track: Track, parameters: FaceParameters = DEFAULT_FACE) -> Face:
    """The head of a track's person, from head, shoulder centre and shoulders."""
    middle, below = track.joint(Joint.HEAD), track.joint(Joint.SHOULDER_CENTER)
    neck = middle - below
    spine = track.joint(Joint.SPINE)
    back = sum(
        np.linalg.norm(bone, axis=1)
        for bone in (neck, below - spine, spine - track.joint(Joint.HIP_CENTER))
    )
    backs, necks = (
        lengths[np.isfinite(lengths)] for lengths in (back, np.linalg.norm(neck, axis=1))
    )
    usual = np.median(necks) if len(necks) else 0.0
    if len(backs):
        usual = parameters.neck_of_back * np.median(backs)
    size = float(np.clip(usual, *parameters.neck_m))
    up = _unit(_unit(neck) + VERTICAL)
    across = track.joint(Joint.SHOULDER_RIGHT) - track.joint(Joint.SHOULDER_LEFT)
    right = _unit(across - np.sum(across * up, axis=1, keepdims=True) * up)
    forward = np.cross(up, right)
    ahead = middle + parameters.face_ahead * size * forward
    return Face(
        middle,
        right,
        forward,
        up,
        mouth=ahead - parameters.mouth_below * size * up,
        eyes=ahead + parameters.eyes_above * size * up,
        size=size,
    )


def nearest_hands(track: Track, points: Array) -> Array:
    """Distance (T,) of points (T, 3) from the nearest hand, metres; infinite where none is known.

    Of each hand the palm and the wrist count: either may be misread.
    """
    hands = track.joints[
        :, [Joint.HAND_LEFT, Joint.HAND_RIGHT, Joint.WRIST_LEFT, Joint.WRIST_RIGHT]
    ]
    distances = np.linalg.norm(hands - points[:, None], axis=2)
    return np.asarray(np.min(np.where(np.isfinite(distances), distances, np.inf), axis=1))


def thin_axis(vertices: Array) -> Array:
    """The axis (3,) of the object's frame along which a flat thing with vertices (V, 3) is thin."""
    return np.eye(3)[int(np.argmin(np.ptp(vertices, axis=0)))]


def middle_of(vertices: Array) -> Array:
    """The middle (3,) of the box around vertices (V, 3)."""
    return np.asarray(0.5 * (vertices.min(axis=0) + vertices.max(axis=0)))


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0.0, lengths, np.nan))
