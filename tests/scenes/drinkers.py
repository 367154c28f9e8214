"""Simulated people who drink from a mug, a model learned from some, and a fused track of others."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from inhand_lab.evaluation.vertex_error import vertex_error
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.messages import camera_info, shape_of
from inhand_lab.world.simulation import Simulation, simulate
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.camera import intrinsics_of
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.appearance import AppearanceSample, learn_appearance

SEED = 23
FRAME_RATE = 15.0
FILMED = replace(KINECT, frame_rate=FRAME_RATE)
FRAME_NS = 66_666_667
FRAMES = 150
LEARNED_FROM = range(3)
CHI_SQUARE_90 = 10.645
"""Of six degrees of freedom."""


@cache
def drinking(participant: int) -> Simulation:
    return simulate("drinkFromMug", participant, SEED, FRAMES, FILMED)


def skeletons(simulation: Simulation) -> np.ndarray:
    """Joints (T, 20, 3), missing ones NaN."""
    joints = simulation.joints_in_camera.copy()
    joints[simulation.joint_states == 0] = np.nan
    return joints


@cache
def image(participant: int, frame: int) -> Image:
    simulation = drinking(participant)
    seen = simulation.render(frame)
    camera = intrinsics_of(camera_info(simulation.intrinsics, FRAME_RATE))
    return Image(None, camera, (seen.depth / 1000.0).astype(np.float32), seen.colour)


@cache
def mug_model() -> Model:
    """Of three people's bodies, and of a few of their frames."""
    people = [drinking(participant) for participant in LEARNED_FROM]
    shape = shape_of(people[0].object_model)
    sequences = [
        LabelledSequence(
            f"p{one.participant}",
            one.person.handedness == "left",
            skeletons(one),
            one.translations,
            one.rotations,
            FRAME_RATE,
        )
        for one in people
    ]
    samples: list[AppearanceSample] = [
        (
            image(one.participant, frame),
            one.translations[frame],
            one.rotations[frame],
            skeletons(one)[frame],
        )
        for one in people
        for frame in range(5, FRAMES, 15)
    ]
    return Model(
        "drinkFromMug",
        shape,
        learn(sequences, shape.mirror_normal),
        find_viewpoints(shape),
        learn_appearance(shape, samples),
        learn_prior(sequences, shape),
    )


@dataclass(frozen=True)
class Fused:
    """Estimates, their vertex errors in metres, and how many standard deviations squared they are
    off; the track of one stranger's frames."""

    estimates: list[Estimate]
    errors: np.ndarray
    square_distances: np.ndarray

    def coverage(self) -> float:
        """The share of frames whose true pose is within the 90 % region."""
        return float(np.mean(self.square_distances < CHI_SQUARE_90))


def fused(participant: int, seen: range | list[int]) -> Fused:
    """Follow a stranger's mug; images are given at the frames that are seen."""
    simulation, model = drinking(participant), mug_model()
    tracker = FusionTracker(model, left_handed=simulation.person.handedness == "left")
    shown = set(seen)
    estimates, errors, distances = [], [], []
    for frame, joints in enumerate(skeletons(simulation)):
        given = image(participant, frame) if frame in shown else None
        estimate = tracker.step(joints, (frame + 1) * FRAME_NS, given)
        true = simulation.translations[frame], simulation.rotations[frame]
        told = estimate.translation, estimate.rotation
        turn = rotations.multiply(told[1], rotations.conjugate(true[1]))
        off = np.concatenate((told[0] - true[0], rotations.to_vector(turn)))
        estimates.append(estimate)
        errors.append(float(vertex_error(told, true, model.shape.marked_vertices)))
        distances.append(float(off @ np.linalg.solve(estimate.covariance, off)))
    return Fused(estimates, np.array(errors), np.array(distances))
