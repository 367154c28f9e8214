"""From joints in a picture to joints in space, by the depth of the same picture.

Depth gives the skin of whatever is nearest at a joint's pixel: often a hand before the trunk, an
object, or the wall beside a thin limb. So each joint has several surfaces to lie under, and what is
taken is what fits the network's own depths, the person's lengths and the last frame best
(``kernels.depth_choice``).
"""

from dataclasses import dataclass

import numpy as np
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo
from numpy.typing import NDArray

from inhand_capture.estimation.body_lengths import OUTER, BodyLengths, trunk_length, usual_lengths
from inhand_capture.estimation.conventions import States, as_kinect
from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.kernels.depth_choice import (
    INFERRED,
    TRACKED,
    choose_limb,
    middle_depth,
    on_ray,
)
from inhand_capture.estimation.kernels.depth_clusters import surfaces_about
from inhand_capture.estimation.limbs import HIPS, LIMBS, TRUNK_ENDS
from inhand_capture.estimation.parameters import DEFAULT_LIFTING, LiftingParameters


def lens_of(info: CameraInfo, width: int, height: int) -> Pinhole:
    """Return a camera's lens in a picture of that size."""
    whole = Pinhole(info.fx, info.fy, info.cx, info.cy, info.width, info.height)
    return whole.scaled_to(width, height)


@dataclass(frozen=True)
class DepthPicture:
    """Depth (h, w) of what a lens shows, in units of so many metres; 0 is nothing."""

    depth: NDArray[np.uint16]
    unit: float


@dataclass(frozen=True)
class Lifted:
    """One person in space, in the camera frame, metres.

    ``joints`` (20, 3) are Kinect's, NaN where missing, with their ``states`` (20,): 0 missing, 1
    inferred, 2 tracked. ``seen`` (20, 3) are the network's joints, NaN where it knows none.
    """

    joints: Floats
    states: States
    seen: Floats


@dataclass(frozen=True)
class Surfaces:
    """What lies about one person's joints, and where the middle of their hips is by it.

    ``depths`` (20, K) are those at which joints may lie, the first ``counts`` (20,) of each row,
    and ``middle`` (3,) is in the camera frame, all in metres.
    """

    depths: Floats
    counts: NDArray[np.int64]
    middle: Floats


class Lifter:
    """Lifts the people of one camera."""

    def __init__(self, lens: Pinhole, parameters: LiftingParameters = DEFAULT_LIFTING) -> None:
        self._lens = lens
        self._parameters = parameters
        self._radii = joint_radii(parameters)
        self._usual = usual_lengths(parameters)
        self._costs = np.array(
            [
                parameters.depth_deviation_m,
                parameters.length_deviation,
                parameters.movement_m,
                parameters.largest_cost,
                parameters.hidden_cost,
            ]
        )

    def read(self, person: FoundPerson, picture: DepthPicture) -> Surfaces | None:
        """Read the depth about somebody's joints; None where no depth is about them."""
        depths, shares, counts = self._depths_about(person, picture)
        middle = middle_depth(
            depths,
            shares,
            counts,
            np.nan_to_num(person.depths),
            person.visibilities,
            self._parameters.agreement_m,
        )
        if not np.isfinite(middle):
            return None
        hips = person.pixels[list(HIPS)].mean(axis=0)
        return Surfaces(depths, counts, on_ray(self._lens.rays(hips[None])[0], middle))

    def lift(
        self, person: FoundPerson, surfaces: Surfaces, body: BodyLengths, before: Floats
    ) -> Lifted | None:
        """Lift one person; None for what is too small or too large to be one.

        ``body`` are the person's own lengths, and ``before`` (20, 3) the network's joints in the
        last frame, NaN where unknown.
        """
        rays = self._lens.rays(person.pixels)
        seen, states = np.full((20, 3), np.nan), np.zeros(20, np.uint8)

        def choose(
            chain: NDArray[np.int64],
            first: Floats,
            under: Surfaces,
            behind: Floats,
            expected: Floats,
        ) -> None:
            outer = chain[1:]
            seen[outer], states[outer] = choose_limb(
                chain,
                first,
                under.depths,
                under.counts,
                rays,
                behind,
                expected,
                before,
                self._costs,
            )

        behind_middle = np.nan_to_num(person.depths)
        trunks = near_surfaces(surfaces, person.depths, self._parameters.trunk_gate_m)
        for joint in (*TRUNK_ENDS, Joint.HEAD):
            if np.isnan(rays[joint, 0]):
                continue
            chain = np.array([Joint.HIP_CENTER, joint])
            choose(chain, surfaces.middle, trunks, behind_middle, _UNKNOWN)
        trunk = body.trunk if np.isfinite(body.trunk) else trunk_length(seen)
        if not self._parameters.shortest_trunk_m < trunk < self._parameters.longest_trunk_m:
            return None
        expected = np.where(np.isfinite(body.lengths), body.lengths, trunk * self._usual)
        for limb in LIMBS:
            known = limb[np.isfinite(rays[limb, 0])]
            if len(known) > 1:
                choose(known, seen[limb[0]], surfaces, person.depths, expected)
        self._doubt(person, states)
        self._drop_wild(seen, states, expected)
        joints, kinects = as_kinect(seen, states, self._parameters)
        joints[kinects == 0] = np.nan
        return Lifted(joints, kinects, seen)

    def _depths_about(
        self, person: FoundPerson, picture: DepthPicture
    ) -> tuple[Floats, Floats, NDArray[np.int64]]:
        """Return what ``surfaces_about`` finds about somebody's joints."""
        parameters = self._parameters
        height, width = picture.depth.shape
        scale = np.array([width / self._lens.width, height / self._lens.height])
        pixels = (person.pixels + 0.5) * scale - 0.5
        metre = trunk_length(pixels) / parameters.usual_trunk_m
        reaches = np.clip(
            parameters.window * metre * self._radii,
            parameters.smallest_window,
            parameters.largest_window,
        )
        surfaces: tuple[Floats, Floats, NDArray[np.int64]] = surfaces_about(
            picture.depth,
            picture.unit,
            pixels,
            reaches,
            self._radii,
            (parameters.gap, parameters.nearest_depth_m),
            (parameters.fewest_depths, parameters.most_surfaces),
        )
        return surfaces

    def _doubt(self, person: FoundPerson, states: States) -> None:
        """Call joints (20,) inferred that are hardly in view, and ends of limbs missing that are
        out of the picture."""
        unseen = person.visibilities < self._parameters.visible_from
        states[unseen & (states == TRACKED)] = INFERRED
        inside = (person.pixels >= 0) & (person.pixels < [self._lens.width, self._lens.height])
        states[OUTER] = np.where((inside.all(axis=1) | ~unseen)[OUTER], states[OUTER], 0)

    def _drop_wild(self, seen: Floats, states: States, expected: Floats) -> None:
        """Call joints (20,) missing that lie far beyond a limb's length, and all after them."""
        for limb in LIMBS:
            lengths = np.linalg.norm(seen[limb[1:]] - seen[limb[:-1]], axis=1)
            wild = lengths > self._parameters.longest_ratio * expected[limb[1:]]
            if wild.any():
                states[limb[1 + int(np.argmax(wild)) :]] = 0


def near_surfaces(surfaces: Surfaces, behind: Floats, gate_m: float) -> Surfaces:
    """Keep the surfaces within a distance of where joints are expected so far ``behind`` (20,) the
    middle; all of them where that is NaN."""
    away = np.abs(surfaces.depths - (surfaces.middle[2] + behind)[:, None])
    far = (away > gate_m) | (np.arange(away.shape[1]) >= surfaces.counts[:, None])
    order = np.argsort(far, axis=1, kind="stable")
    depths = np.take_along_axis(surfaces.depths, order, axis=1)
    return Surfaces(depths, (~far).sum(axis=1), surfaces.middle)


def joint_radii(parameters: LiftingParameters) -> Floats:
    """Return how far below the skin joints (20,) lie, metres."""
    radii = np.zeros(len(Joint))
    radii[Joint.HEAD] = parameters.head_radius_m
    for name in ("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "foot"):
        for side in ("LEFT", "RIGHT"):
            radii[Joint[f"{name.upper()}_{side}"]] = getattr(parameters, f"{name}_radius_m")
    return radii


_UNKNOWN = np.full(len(Joint), np.nan)
