"""People and objects for the tracker's tests, made without the code under test."""

from functools import lru_cache

import numpy as np
import trimesh
from inhand_schemas.messages import Person
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.shape import ObjectShape, Symmetry
from inhand_tracker.shape.viewpoints import find_viewpoints
from scipy.spatial.transform import Rotation

FRAME_NS = 33_333_333

# A person of 1.792 m (trunk 0.728 m, leg 0.88 m) who stands before the camera and faces it: the
# person's left is at +x, up is -y.
STANDING = np.array(
    [
        (0.00, 0.00, 2.50),  # HipCenter
        (0.00, -0.20, 2.50),  # Spine
        (0.00, -0.45, 2.50),  # ShoulderCenter
        (0.00, -0.728, 2.50),  # Head
        (0.20, -0.42, 2.50),  # ShoulderLeft
        (0.25, -0.15, 2.52),  # ElbowLeft
        (0.27, 0.08, 2.42),  # WristLeft
        (0.28, 0.16, 2.38),  # HandLeft
        (-0.20, -0.42, 2.50),  # ShoulderRight
        (-0.26, -0.16, 2.45),  # ElbowRight
        (-0.22, -0.12, 2.20),  # WristRight
        (-0.20, -0.13, 2.12),  # HandRight
        (0.10, 0.03, 2.50),  # HipLeft
        (0.10, 0.47, 2.50),  # KneeLeft
        (0.10, 0.91, 2.50),  # AnkleLeft
        (0.11, 0.95, 2.38),  # FootLeft
        (-0.10, 0.03, 2.50),  # HipRight
        (-0.10, 0.47, 2.50),  # KneeRight
        (-0.10, 0.91, 2.50),  # AnkleRight
        (-0.11, 0.95, 2.38),  # FootRight
    ]
)
STANDING_HEIGHT = (0.728 + 0.88) / 0.896

# The kinematic tree by the numbers of Kinect's joints: (parent, child), one a part.
KINECT_TREE = [
    (0, 1), (1, 2), (2, 3),
    (2, 4), (4, 5), (5, 6), (6, 7),
    (2, 8), (8, 9), (9, 10), (10, 11),
    (0, 12), (12, 13), (13, 14), (14, 15),
    (0, 16), (16, 17), (17, 18), (18, 19),
]  # fmt: skip

ELBOW, WRIST, HAND = 9, 10, 11
RIGHT_ARM = [WRIST, HAND]


def scipy_rotation(quaternion: np.ndarray) -> Rotation:
    """SciPy's rotation of (w, x, y, z)."""
    return Rotation.from_quat(np.asarray(quaternion), scalar_first=True)


def quaternion_of(rotation: Rotation) -> np.ndarray:
    """SciPy's rotation as (w, x, y, z)."""
    return rotation.as_quat(scalar_first=True)


def same_rotation(first: np.ndarray, second: np.ndarray, tolerance: float = 1e-9) -> bool:
    """Whether quaternions are equal up to their signs."""
    dots = np.abs(np.sum(np.asarray(first) * np.asarray(second), axis=-1))
    lengths = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    return bool(np.all(np.abs(dots - 1.0) < tolerance) and np.all(np.abs(lengths - 1) < 1e-6))


def move(rotation: Rotation, shift: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Points (..., 3) of a scene that is turned and then shifted as a whole."""
    return rotation.apply(points.reshape(-1, 3)).reshape(points.shape) + shift


def waving(frames: int, *, seed: int = 0, speed: float = 0.25, wobble: float = 0.004) -> np.ndarray:
    """Joints (T, 20, 3) of a person whose right forearm swings about the elbow, with noise."""
    random = np.random.default_rng(seed)
    joints = np.repeat(STANDING[None], frames, axis=0)
    turns = Rotation.from_rotvec(
        np.column_stack(
            (
                0.7 * np.sin(speed * np.arange(frames) + seed),
                0.4 * np.cos(speed * np.arange(frames)),
                np.zeros(frames),
            )
        )
    )
    for joint in RIGHT_ARM:
        offset = STANDING[joint] - STANDING[ELBOW]
        joints[:, joint] = STANDING[ELBOW] + turns.apply(offset)
    return joints + wobble * random.normal(size=joints.shape)


def unseen_wave(frames: int) -> np.ndarray:
    """Joints (T, 20, 3) of somebody whom ``wave_model`` does not know."""
    return waving(frames, seed=7, speed=0.23)


def held(joints: np.ndarray, *, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """An object (T, 3), (T, 4) 10 cm beyond the right hand, turned with the forearm, loosely."""
    random = np.random.default_rng(seed + 1000)
    forearm = joints[:, HAND] - joints[:, ELBOW]
    forearm /= np.linalg.norm(forearm, axis=1, keepdims=True)
    across = np.cross(forearm, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    matrices = np.stack((across, np.cross(forearm, across), forearm), axis=-1)
    jitter = Rotation.from_rotvec(0.05 * random.normal(size=(len(joints), 3)))
    rotations = quaternion_of(Rotation.from_matrix(matrices) * jitter)
    signs = np.where(random.random(len(joints)) < 0.5, -1.0, 1.0)
    shift = 0.10 * forearm + 0.005 * random.normal(size=(len(joints), 3))
    return joints[:, HAND] + shift, rotations * signs[:, None]


def sequence(
    participant: str, frames: int = 60, *, seed: int = 0, left_handed: bool = False
) -> LabelledSequence:
    """A labelled recording of a waving person."""
    joints = waving(frames, seed=seed, speed=0.2 + 0.02 * seed)
    return LabelledSequence(participant, left_handed, joints, *held(joints, seed=seed))


def wedge() -> ObjectShape:
    """A box of 6 × 10 × 24 cm with its far end narrowed; symmetric about x only."""
    mesh = trimesh.creation.box((0.06, 0.10, 0.24))
    vertices = np.array(mesh.vertices)
    far = vertices[:, 2] > 0
    vertices[far, 1] = 0.6 * vertices[far, 1] + 0.01
    return ObjectShape(
        "wedge",
        vertices,
        np.array(mesh.faces, np.int64),
        vertices[:5].copy(),
        np.array([1.0, 0.0, 0.0]),
        (Symmetry((0.0, 0.0, 1.0), (0.0, 0.01, 0.0), 2),),
    )


@lru_cache(maxsize=1)
def wave_model() -> Model:
    """A model of the wedge, learned from three participants."""
    sequences = [sequence(f"p{seed}", seed=seed) for seed in range(3)]
    shape = wedge()
    return Model(
        "wave",
        shape,
        learn(sequences, shape.mirror_normal),
        find_viewpoints(shape),
        prior=learn_prior(sequences, shape),
    )


def person(
    number: int, depth: float = 2.0, missing: tuple[int, ...] = (), wild: float | None = None
) -> Person:
    """A message of somebody ``depth`` metres away; one joint may be ``wild`` metres off."""
    joints = [(0.1 * j, -0.1 * j, depth) for j in range(20)]
    if wild is not None:
        joints[11] = (0.0, wild, depth)
    return Person(
        id=number,
        joints=tuple(joints),
        states=tuple("missing" if j in missing else "tracked" for j in range(20)),
        confidences=(1.0,) * 20,
    )
