"""The skeleton: pelvis basis, body pose, part predictors, height (Darby et al. 2014, section 4).

Joints are (..., 20, 3) in metres in the camera frame, in Kinect order
(``inhand_schemas.joints.JOINT_NAMES``). A part is a joint with its parent: 19 of them, in the
order of ``PARTS``. Missing joints are NaN.
"""

from dataclasses import dataclass

import numpy as np
from inhand_runtime.running_medians import RunningMedians
from inhand_schemas.joints import JOINT_NAMES, MIRRORED_JOINTS, PARENTS, SIDES, Joint

from inhand_tracker.body.kernels import axes as kernels
from inhand_tracker.body.kernels.part_lengths import in_proportion
from inhand_tracker.body.parameters import DEFAULT_BODY, BodyParameters
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array

PARTS = JOINT_NAMES[1:]
CHILD_JOINTS = np.arange(1, len(JOINT_NAMES))
PARENT_JOINTS = np.array(PARENTS[1:])
RIGHT_HAND = PARTS.index("HandRight")
LEFT_HAND = PARTS.index("HandLeft")
TRUNK_PARTS = [PARTS.index(name) for name in ("Spine", "ShoulderCenter", "Head")]
PELVIS_JOINTS = np.array([Joint.HIP_CENTER, Joint.SPINE, Joint.HIP_LEFT, Joint.HIP_RIGHT])

# Shares of stature (Drillis and Contini 1966): from the ankle (3.9 %) to the hip (53 %), and from
# the hip to the middle of the head (93.5 %).
LEG_SHARE = 0.491
TRUNK_SHARE = 0.405

_FOUR = np.zeros(4)
"""It tells the kernel how long a quaternion is."""
_MIRRORED = np.array(MIRRORED_JOINTS)
_LEG_PARTS = [[PARTS.index(f"{name}{side}") for name in ("Knee", "Ankle")] for side in SIDES]


@dataclass(frozen=True)
class Bases:
    """Coordinate systems in the camera frame: ``origins`` (..., 3), ``rotations`` (..., 4)."""

    origins: Array
    rotations: Array

    def to_camera(self, translations: Array, orientations: Array) -> tuple[Array, Array]:
        """Take poses given in these bases, (..., 3) and (..., 4), to the camera frame."""
        return (
            self.origins + rotations.rotate(self.rotations, translations),
            rotations.multiply(self.rotations, orientations),
        )

    def from_camera(self, translations: Array, orientations: Array) -> tuple[Array, Array]:
        """Take poses of the camera frame, (..., 3) and (..., 4), to these bases."""
        inverse = rotations.conjugate(self.rotations)
        return (
            rotations.rotate(inverse, translations - self.origins),
            rotations.multiply(inverse, orientations),
        )


def pelvis_basis(joints: Array) -> Bases:
    """H*: find the basis at HipCenter: x from the right hip to the left, y up, z forwards."""
    return Bases(joints[..., Joint.HIP_CENTER, :], kernels.pelvis_rotation(joints, _FOUR))


def has_pelvis(joints: Array) -> bool:
    """Whether the pelvis basis of one person's (20, 3) joints is defined."""
    return bool(1e-6 < kernels.pelvis_area(joints) < np.inf)


def part_bases(joints: Array, pelvis: Bases) -> Bases:
    """H_l: find the part predictors (..., 19), H* at the parent joint, z turned along the part.

    A part of no length keeps the pelvis' directions; one that points exactly backwards is turned
    about the pelvis' x axis.
    """
    parents = joints[..., PARENT_JOINTS, :]
    pelvis_rotation = pelvis.rotations[..., None, :]
    along = rotations.rotate(
        rotations.conjugate(pelvis_rotation), joints[..., CHILD_JOINTS, :] - parents
    )
    return Bases(parents, rotations.multiply(pelvis_rotation, _turn_z_to(along)))


def _turn_z_to(direction: Array) -> Array:
    """The shortest rotation that takes the z axis to a direction, (..., 3) → (..., 4)."""
    length = np.linalg.norm(direction, axis=-1, keepdims=True)
    unit = direction / np.where(length > 1e-9, length, 1.0)
    x, y, z = rotations.components(unit)
    turn = np.stack((1.0 + z, -y, x, np.zeros_like(z)), axis=-1)
    backwards = np.linalg.norm(turn, axis=-1, keepdims=True) <= 1e-9
    return rotations.normalise(np.where(backwards, np.array([0.0, 1.0, 0.0, 0.0]), turn))


def body_pose(joints: Array, pelvis: Bases, height: Array | float) -> Array:
    """b: give the joints in the pelvis basis in units of the person's height, (..., 60)."""
    local = rotations.rotate(
        rotations.conjugate(pelvis.rotations)[..., None, :],
        joints - pelvis.origins[..., None, :],
    )
    scaled = local / np.asarray(height)[..., None, None]
    return scaled.reshape(*scaled.shape[:-2], 60)


def part_lengths(joints: Array) -> Array:
    """Lengths of the 19 parts, (..., 19); NaN where an end is missing."""
    return np.linalg.norm(joints[..., CHILD_JOINTS, :] - joints[..., PARENT_JOINTS, :], axis=-1)


def typical_lengths(lengths: Array) -> Array:
    """The median (19,) of each part's lengths (T, 19); NaN where a part was never seen."""
    typical = np.full(len(PARTS), np.nan)
    seen = np.isfinite(lengths).any(axis=0)
    measured = lengths[:, seen]
    # np.nanmedian gives the same where nothing is missing, and takes ten times as long.
    median = np.median if np.isfinite(measured).all() else np.nanmedian
    typical[seen] = median(measured, axis=0)
    return typical


def stature(typical: Array) -> float:
    """Estimate stature in metres from typical part lengths (19,) of one person.

    Lengths do not change when a person bends. A leg seen on one side only counts for both; where
    no leg was seen the trunk alone decides. NaN when a part of the trunk was not seen.
    """
    trunk = sum(typical[part] for part in TRUNK_PARTS)
    legs = [leg for leg in (sum(typical[part] for part in leg) for leg in _LEG_PARTS) if leg == leg]
    if not legs:
        return float(trunk / TRUNK_SHARE)
    return float((trunk + sum(legs) / len(legs)) / (TRUNK_SHARE + LEG_SHARE))


def stature_of(joints: Array) -> float:
    """Estimate stature in metres from one person's joints (T, 20, 3), as ``stature`` does."""
    return stature(typical_lengths(part_lengths(joints)))


class RunningHeight:
    """h_t: keeps the stature by the last frames' part lengths.

    ``proportions`` (19,) are usual part lengths in any unit. The person's other parts make one
    expect a length of each part; one of more than twice or less than half of that has a wild
    joint, and the expected length stands for it: so even the first frame may be wild.
    """

    def __init__(
        self, proportions: Array | None = None, parameters: BodyParameters = DEFAULT_BODY
    ) -> None:
        self._proportions = proportions
        self._wild_ratio = parameters.wild_ratio
        self._medians = RunningMedians(len(PARTS), parameters.height_frames)

    def update(self, joints: Array) -> float:
        """Take one frame's (20, 3) joints and give the height in metres; NaN while unknown."""
        lengths = part_lengths(joints)
        if self._proportions is not None:
            lengths = in_proportion(lengths, self._proportions, self._wild_ratio)
        return stature(self._medians.update(lengths))


def without_impossible(joints: Array, farthest_m: float = DEFAULT_BODY.farthest_joint_m) -> Array:
    """Take joints (..., 3) that are farther away than any room as missing, NaN."""
    possible = (np.abs(joints) <= farthest_m).all(axis=-1, keepdims=True)
    return np.where(possible, joints, np.nan)


def mirror_joints(joints: Array) -> Array:
    """Mirror people (..., 20, 3): x negated, left and right exchanged."""
    return joints[..., _MIRRORED, :] * np.array([-1.0, 1.0, 1.0])


def mirror_pose(
    translations: Array, orientations: Array, mirror_normal: Array
) -> tuple[Array, Array]:
    """Mirror object poses (..., 3) and (..., 4), x negated.

    ``mirror_normal`` (3,) is the unit normal, in the object's frame, of the object's own plane of
    symmetry, which makes the mirrored object the same object again.
    """
    # A reflection is minus a half turn about its normal: S R S' = turn_x R turn_normal.
    turn_x = np.array([0.0, 1.0, 0.0, 0.0])
    turn_normal = np.concatenate(([0.0], mirror_normal))
    turned = rotations.multiply(rotations.multiply(turn_x, orientations), turn_normal)
    return translations * np.array([-1.0, 1.0, 1.0]), turned
