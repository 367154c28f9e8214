"""Brings one pose that a person gave to where the image of its frame shows the object."""

from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.sight import Sight

from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.expectations import expected_at
from inhand_lab.labelling.looking import Looker
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters


@dataclass(frozen=True)
class RefinedPose:
    """A pose, its ``covariance`` (6, 6) of a translation and of a rotation vector on the left, and
    how far it went from the one that was given, in metres and radians.

    ``shown`` is false where the image says nothing of the object there: the pose is the given one.
    """

    pose: Pose
    covariance: Array
    moved_m: float
    moved_rad: float
    shown: bool


def refine_pose(
    sight: Sight,
    image: Image,
    pose: Pose,
    joints: Array | None = None,
    parameters: LabellingParameters = DEFAULT_LABELLING,
) -> RefinedPose:
    """Return the pose (3,), (4,) near a given one at which an image shows the object best.

    ``joints`` (20, 3) are those of the person who holds it, in the camera's frame, or None. Colours
    count where the ``sight`` has learned some, edges and depth always. How far it looks is
    ``parameters.given_m`` and ``given_rad``; the same input gives the same pose.
    """
    given = expected_at(pose, parameters.given_m, parameters.given_rad)
    view = sight.view(prepare(image), sight.start(), joints)
    random = np.random.default_rng(0)
    look = Looker(sight, parameters).look([given], [], view, 1.0, random)
    found = look.believed.centre, look.believed.rotation
    return RefinedPose(
        found,
        look.believed.covariance,
        float(np.linalg.norm(found[0] - pose[0])),
        float(rotations.angle_between(found[1], pose[1])),
        bool(look.information.any()),
    )
