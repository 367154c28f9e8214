"""What of a picture somebody takes, by their joints."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.faces.heads import NEAREST_M, pixels_of_a_metre
from inhand_capture.faces.parameters import DEFAULT_FACES
from inhand_capture.view.masks import Mask
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Person
from numpy.typing import NDArray

from inhand.redaction.parameters import DEFAULT_REDACTION, RedactionParameters

Body = NDArray[np.float32]
"""Joints of a body (20, 3): x, y and the pixels of a metre there, in the camera's pixels; NaN where
a joint is not known."""

SIDES = ("LEFT", "RIGHT")
TRUNK = (Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT, Joint.HIP_RIGHT, Joint.HIP_LEFT)
TRUNK_PLACES = np.array(
    [
        [(1 - down) * (1 - across), (1 - down) * across, down * across, down * (1 - across)]
        for down in np.linspace(0.0, 1.0, 7)
        for across in np.linspace(0.0, 1.0, 5)
    ]
)
"""Places all over a trunk, as shares of its four corners."""
FARTHEST_PX = 20_000.0
"""Where a picture is left of that, in pixels: what lies farther out is drawn there."""


def found_body(person: FoundPerson, scale: float) -> Body | None:
    """Return the body of somebody whom a network found in a picture, which is so many times as
    large in the camera's pixels; None where nothing says how large it is."""
    metre = pixels_of_a_metre(person.pixels, DEFAULT_FACES)
    if not np.isfinite(metre):
        return None
    sizes = np.full((len(person.pixels), 1), metre)
    return _with_neck(np.hstack([scale * (person.pixels + 0.5) - 0.5, scale * sizes]))


def skeleton_body(person: Person, info: CameraInfo) -> Body | None:
    """Return the body of a skeleton in space; None where no joint is before the camera."""
    joints = np.array(person.joints)
    known = np.array([state != "missing" for state in person.states]) & (joints[:, 2] > 0.0)
    if not known.any():
        return None
    depths = np.maximum(joints[:, 2], NEAREST_M)
    focal = max(info.fx, info.fy)
    body = np.column_stack(
        [
            info.fx * joints[:, 0] / depths + info.cx,
            info.fy * joints[:, 1] / depths + info.cy,
            focal / depths,
        ]
    )
    body[~known] = np.nan
    return _with_neck(body)


def mask_of_bodies(
    bodies: Iterable[Body],
    info: CameraInfo,
    shape: tuple[int, int],
    parameters: RedactionParameters = DEFAULT_REDACTION,
    *,
    wider_m: float = 0.0,
) -> Mask:
    """Return the pixels (H, W) of a camera's picture of ``shape`` that bodies may take, or that are
    so many metres beside them."""
    drawn = np.zeros(shape, np.uint8)
    scale = np.array([shape[1] / info.width, shape[0] / info.height])
    for body in bodies:
        places = np.clip(scale * (body[:, :2] + 0.5) - 0.5, -FARTHEST_PX, FARTHEST_PX)
        metres = scale.max() * body[:, 2]
        for one, other, radius in _parts(parameters):
            _draw(drawn, places[[one, other]], (radius + wider_m) * metres[[one, other]])
        trunk = places[list(TRUNK)]
        if np.isfinite(trunk).all():
            cv2.fillConvexPoly(drawn, cv2.convexHull(np.rint(trunk).astype(np.int32)), 1)
    return drawn.astype(bool)


def mask_as_far_as_trunks(
    bodies: Sequence[Body],
    info: CameraInfo,
    depth: NDArray[np.float32],
    parameters: RedactionParameters = DEFAULT_REDACTION,
) -> Mask:
    """Return the pixels of depth (H, W) in metres that are beside bodies and as far away."""
    height, width = depth.shape
    scale = np.array([width / info.width, height / info.height])
    distances = []
    for body in bodies:
        places = np.rint(TRUNK_PLACES @ (scale * (body[list(TRUNK), :2] + 0.5) - 0.5))
        inside = np.isfinite(places).all(axis=1)
        inside &= ((places >= 0) & (places < [width, height])).all(axis=1)
        x, y = places[inside].astype(int).T
        measured = depth[y, x]
        if (measured > 0.0).any():
            distances.append(float(np.median(measured[measured > 0.0])))
    if not distances:
        return np.zeros(depth.shape, bool)
    beside = mask_of_bodies(bodies, info, depth.shape, parameters, wider_m=parameters.beside_m)
    nearest = max(min(distances) - parameters.trunk_depth_m, 0.0)
    farthest = max(distances) + parameters.trunk_depth_m
    return beside & (depth > nearest) & (depth < farthest)


def _with_neck(body: NDArray[np.float64]) -> Body:
    """Fill in the joints of the trunk that networks do not know."""
    for middle, ends in (
        (Joint.SHOULDER_CENTER, (Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT)),
        (Joint.HIP_CENTER, (Joint.HIP_LEFT, Joint.HIP_RIGHT)),
        (Joint.SPINE, (Joint.SHOULDER_CENTER, Joint.HIP_CENTER)),
    ):
        if not np.isfinite(body[middle]).all():
            body[middle] = body[list(ends)].mean(axis=0)
    return body.astype(np.float32)


def _parts(parameters: RedactionParameters) -> Iterable[tuple[Joint, Joint, float]]:
    """Yield the two ends of each part, and the metres about the line between them."""
    yield Joint.HEAD, Joint.HEAD, parameters.head_m
    yield Joint.HEAD, Joint.SHOULDER_CENTER, parameters.trunk_m
    yield Joint.SHOULDER_CENTER, Joint.SPINE, parameters.trunk_m
    yield Joint.SPINE, Joint.HIP_CENTER, parameters.trunk_m
    for one, other in zip(TRUNK, (*TRUNK[1:], TRUNK[0]), strict=True):
        yield one, other, parameters.trunk_m
    for side in SIDES:
        shoulder, elbow, wrist, hand, knee, ankle, foot = (
            Joint[f"{name}_{side}"]
            for name in ("SHOULDER", "ELBOW", "WRIST", "HAND", "KNEE", "ANKLE", "FOOT")
        )
        for one, other in ((shoulder, elbow), (elbow, wrist), (wrist, hand)):
            yield one, other, parameters.arm_m
        for one, other in ((Joint[f"HIP_{side}"], knee), (knee, ankle), (ankle, foot)):
            yield one, other, parameters.leg_m
        for end in (wrist, hand, foot):
            yield end, end, parameters.hand_m


def _draw(drawn: NDArray[np.uint8], ends: NDArray[np.float64], radii: NDArray[np.float64]) -> None:
    """Draw two discs and all between them, or the one that is known."""
    known = np.isfinite(ends).all(axis=1) & np.isfinite(radii)
    reach = np.ceil(np.minimum(radii[known], FARTHEST_PX)).astype(int)
    middles = np.rint(ends[known]).astype(int)
    for (x, y), radius in zip(middles.tolist(), reach.tolist(), strict=True):
        cv2.circle(drawn, (x, y), radius, 1, -1)
    if known.all():
        along = ends[1] - ends[0]
        length = np.hypot(*along)
        if length > 0.0:
            across = np.array([-along[1], along[0]]) / length
            corners = [ends[0] + reach[0] * across, ends[1] + reach[1] * across]
            corners += [ends[1] - reach[1] * across, ends[0] - reach[0] * across]
            cv2.fillConvexPoly(drawn, np.rint(corners).astype(np.int32), 1)
