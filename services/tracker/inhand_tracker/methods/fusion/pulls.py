"""What each camera's image alone says of an object that all of them together found."""

from collections.abc import Sequence

import numpy as np

from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import ViewPull
from inhand_tracker.geometry.placement import HERE
from inhand_tracker.geometry.pose_gaussian import turn_blocks
from inhand_tracker.methods.fusion.parameters import FusionParameters
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import PlacedView


def pulls_of(
    sight: Sight,
    views: Sequence[tuple[str, PlacedView, Array | None]],
    pose: tuple[Array, Array],
    parameters: FusionParameters,
) -> list[ViewPull]:
    """Refine the pose of an object's origin, (3,) and (4,), by each of some cameras' views alone,
    and leave those out that support no pose near it. The sharpness of a view is that of its image;
    with each comes the covariance (6, 6) by which the object is off as its camera's place is."""
    pulls = []
    for camera, placed, covariance in views:
        pull = _pull(sight, camera, placed, pose, covariance, parameters)
        if pull is not None:
            pulls.append(pull)
    return pulls


def _pull(
    sight: Sight,
    camera: str,
    placed: PlacedView,
    pose: tuple[Array, Array],
    covariance: Array | None,
    parameters: FusionParameters,
) -> ViewPull | None:
    place = placed.view_from_reference or HERE
    turn = rotations.to_matrix(place.rotation)
    deviations = np.repeat([parameters.pull_reach_m, parameters.pull_reach_rad], 3)
    reach = np.diag(np.square(deviations))
    if covariance is not None:
        reach = reach + turn_blocks(covariance, turn)
    start = place.poses(*pose)
    prior = PosePrior(start[0][None], start[1][None], np.linalg.inv(reach)[None])
    trust = parameters.refinement_temper * placed.sharpness
    alone = sight.refine_alone(start, placed.view, prior, trust)
    if alone.log_likelihoods[0] < parameters.pull_log_likelihood:
        return None
    turned = rotations.multiply(alone.rotations[0], rotations.conjugate(start[1]))
    off = np.concatenate((alone.translations[0] - start[0], rotations.to_vector(turned)))
    # What the prior kept it from counts as well.
    information = alone.information[0]
    whole = np.linalg.solve(
        information + 1e-3 * prior.information[0], (information + prior.information[0]) @ off
    )
    back = np.kron(np.eye(2), turn.T)
    said = np.asarray(turn_blocks(information, turn.T), np.float64)
    return ViewPull(camera, pose[0], np.asarray(back @ whole, np.float64), said)
