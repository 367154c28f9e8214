"""How well a prior of simulated handovers says where a real baton is while it passes on.

The prior is learned of a mug that simulated people hand over, and asked, by each person's measured
body alone, where the thing would be if that one had it. A baton is no mug: its middle is somewhere
else beside the hand, and its axes say nothing, so that places are compared, with and without what
stays the same of the difference. Who has the baton, by the forces on its ends, is compared with
whose prior is nearer.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.registry import new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.appearance import learn_appearance
from scipy.stats import chi2

from inhand_lab.geometry.transforms import quaternions
from inhand_lab.importers.measured_handovers import (
    MEASURED,
    PEOPLE,
    RATE_HZ,
    MeasuredHandover,
    read_measured_handover,
)
from inhand_lab.importers.motion import world_in_camera
from inhand_lab.sensing.skeleton_noise import MISSING
from inhand_lab.world.handover import HANDOVER, simulate_handover
from inhand_lab.world.messages import shape_of

ABSENT = tuple(joint for joint in range(20) if joint not in MEASURED)


@dataclass(frozen=True)
class RealHandoverParameters:
    """What is learned from, and how a recording is read."""

    seeds: tuple[int, ...] = (7700, 7701, 7702, 7703, 7704, 7705)
    """Seeds of the simulated handovers that are learned from."""
    frames: int = 450
    """Number of frames of each: all of it."""
    rate_hz: float = 30.0
    """Rate at which the recording is asked about."""
    held_n: float = 2.0
    """Force from which on somebody holds an end, newtons; sensors of free ends say up to 1.5."""


DEFAULT_REAL_HANDOVER = RealHandoverParameters()


@dataclass(frozen=True)
class HeldPrior:
    """What is said of a thing while one person alone holds it, in so many ``frames``.

    In metres: how far it is away, the mean and the largest; the same less the difference that
    stays, in the axes of what is predicted; and the mean stated deviation of its place.
    ``region_share`` is that of the frames whose 90 % region of the place holds it.
    """

    person: str
    frames: int
    mean_m: float
    largest_m: float
    following_m: float
    deviation_m: float
    region_share: float


@dataclass(frozen=True)
class RealHandover:
    """How each person's prior does, in how many of the frames with one holder the right one is
    nearer, and when, in seconds, the thing passes on: by the forces, and by the priors."""

    people: tuple[HeldPrior, ...]
    held_frames: int
    right_holder: int
    passes_s: float
    passes_by_prior_s: float


def check_real_handover(
    path: Path, parameters: RealHandoverParameters = DEFAULT_REAL_HANDOVER
) -> RealHandover:
    """Learn, and compare with the recording; raises DatasetError for what is none."""
    measured = read_measured_handover(path)
    model = _learned(parameters)
    every = round(RATE_HZ / parameters.rate_hz)
    predicted = {who: _predicted(measured, who, model, every) for who in PEOPLE}
    holds = [measured.forces[who][::every] >= parameters.held_n for who in PEOPLE]
    alone = dict(zip(PEOPLE, (holds[0] & ~holds[1], holds[1] & ~holds[0]), strict=True))
    nearer = predicted["taker"].away < predicted["giver"].away
    held = alone["giver"] | alone["taker"]
    forces = [measured.forces[who][::every] for who in PEOPLE]
    return RealHandover(
        tuple(_held(who, predicted[who], alone[who]) for who in PEOPLE),
        int(held.sum()),
        int((nearer == alone["taker"])[held].sum()),
        _first(forces[1] > np.maximum(forces[0], parameters.held_n)) / parameters.rate_hz,
        _first(nearer) / parameters.rate_hz,
    )


def _first(flags: Flags) -> int:
    """The first frame of which something holds, or the number of frames."""
    return int(np.argmax(flags)) if flags.any() else len(flags)


def _learned(parameters: RealHandoverParameters) -> Model:
    """A model of the mug, from what of simulated people the recording says of real ones too."""
    sequences = [
        sequence for seed in parameters.seeds for sequence in _sequences(seed, parameters.frames)
    ]
    shape = shape_of(simulate_handover(parameters.seeds[0], 1, 2).rig.cameras[0].object_model)
    return Model(
        HANDOVER,
        shape,
        learn(sequences, shape.mirror_normal, absent_joints=ABSENT),
        find_viewpoints(shape),
        learn_appearance(shape, []),
        learn_prior(sequences, shape),
    )


def _sequences(seed: int, frames: int) -> list[LabelledSequence]:
    """Giver and taker of a handover, each while they have the mug."""
    handover = simulate_handover(seed, 1, frames)
    seen, pose = handover.rig.cameras[0], handover.rig.cameras[0].camera_from_object
    turns = quaternions(pose.rotation)
    sequences = []
    for role, reading in enumerate((seen.reading, seen.others[0].reading)):
        joints = np.where((reading.states == MISSING)[..., None], np.nan, reading.joints)
        joints[:, ABSENT] = np.nan
        has = handover.holders[0] == role
        name = f"{seed} {PEOPLE[role]}"
        sequences.append(
            LabelledSequence(
                name, False, joints[has], pose.translation[has], turns[has]
            ).with_stand_ins(ABSENT)
        )
    return sequences


@dataclass(frozen=True)
class _Predicted:
    """Where a thing is, less where it is predicted to be (T, 3), in the camera's axes and in those
    of what is predicted, how far that is (T,), and the covariances (T, 3, 3) of the place."""

    off: Array
    off_in_object: Array
    away: Array
    covariances: Array


def _predicted(measured: MeasuredHandover, who: str, model: Model, every: int) -> _Predicted:
    """What one person's body says in each frame."""
    joints = measured.joints[who]
    world = world_in_camera(joints)
    seen = (world.origins + rotations.rotate(world.rotations, joints))[::every]
    true, _ = world.to_camera(measured.translations, measured.rotations)
    tracker = new_tracker(model, left_handed=False)
    off = np.full((len(seen), 3), np.nan)
    off_in_object, covariances = off.copy(), np.full((len(seen), 3, 3), np.nan)
    for frame, body in enumerate(seen):
        estimate = tracker.step(body, round(1e9 * frame * every / RATE_HZ))
        if estimate.translation is None or estimate.rotation is None:
            continue
        off[frame] = true[frame * every] - estimate.translation
        off_in_object[frame] = rotations.rotate(rotations.conjugate(estimate.rotation), off[frame])
        if estimate.covariance is not None:
            covariances[frame] = estimate.covariance[:3, :3]
    return _Predicted(off, off_in_object, np.linalg.norm(off, axis=1), covariances)


def _held(who: str, predicted: _Predicted, alone: Flags) -> HeldPrior:
    off, covariances = predicted.off[alone], predicted.covariances[alone]
    inside = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariances), off) <= chi2(3).ppf(0.9)
    within = predicted.off_in_object[alone]
    following = np.linalg.norm(within - np.nanmedian(within, axis=0), axis=1)
    return HeldPrior(
        who,
        int(alone.sum()),
        float(np.nanmean(predicted.away[alone])),
        float(np.nanmax(predicted.away[alone])),
        float(np.nanmean(following)),
        float(np.nanmean(np.sqrt(np.trace(covariances, axis1=1, axis2=2)))),
        float(np.mean(inside)),
    )
