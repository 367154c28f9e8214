"""Measures what a frame of ``fusion`` costs, by the size of its prior's training.

The people are simulated. Beyond the first 1,000 frames they are repeated, each time with another
noise of their joints, as other people: what a regression costs does not depend on who they are.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.image import Image
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.viewpoints import find_viewpoints

from inhand_lab.benchmarks.parameters import DEFAULT_FUSION_COST as DEFAULT
from inhand_lab.benchmarks.rendered_images import rendered_image
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import Simulation, simulate

INTERACTION = "drinkFromMug"
SHOWN = slice(DEFAULT.first_shown, DEFAULT.last_shown)


@dataclass(frozen=True)
class FusionCost:
    """Processor time: seconds to learn a prior from ``frames`` labelled frames, and the median
    milliseconds that a frame then takes without an image and with one."""

    frames: int
    learning_s: float
    unseen_ms: float
    seen_ms: float


def measure_fusion(sizes: Sequence[int] = DEFAULT.sizes) -> tuple[FusionCost, ...]:
    """Measure frames of one object and one person, with as many hypotheses as usual."""
    people = [
        simulate(INTERACTION, person, DEFAULT.seed, DEFAULT.frames)
        for person in range(DEFAULT.people)
    ]
    sequences = [true_sequence(one) for one in people]
    shape = shape_of(people[0].object_model)
    # fusion asks the mapping for what is usual of joints alone: its size costs a frame nothing.
    mapping = learn(sequences, shape.mirror_normal)
    model = Model(INTERACTION, shape, mapping, find_viewpoints(shape))
    shown = simulate(INTERACTION, DEFAULT.people, DEFAULT.seed, DEFAULT.last_shown)
    images = [rendered_image(shown, frame) for frame in range(SHOWN.start, SHOWN.stop)]
    joints = shown.true_joints_in_camera[SHOWN]
    left_handed = shown.person.handedness == "left"
    costs = []
    for size in sizes:
        copies = _of_size(sequences, size)
        began = time.process_time()
        prior = learn_prior(copies, shape)
        learning_s = time.process_time() - began
        tracker = FusionTracker(replace(model, prior=prior), left_handed=left_handed)
        unseen_ms, seen_ms = (
            _frame_ms(tracker, joints, given) for given in ([None] * len(images), images)
        )
        costs.append(FusionCost(size, learning_s, unseen_ms, seen_ms))
    return tuple(costs)


def true_sequence(done: Simulation) -> LabelledSequence:
    """Return a performance with its true joints."""
    return LabelledSequence(
        str(done.participant),
        done.person.handedness == "left",
        done.true_joints_in_camera,
        done.translations,
        done.rotations,
    )


def _of_size(sequences: Sequence[LabelledSequence], size: int) -> list[LabelledSequence]:
    """Repeat sequences until they have ``size`` frames together, or hardly more."""
    random = np.random.default_rng(DEFAULT.seed)
    copies = []
    for number in range(-(-size // DEFAULT.frames)):
        one = sequences[number % len(sequences)]
        noise = DEFAULT.noise_m * random.normal(size=one.joints.shape)
        copies.append(replace(one, participant=str(number), joints=one.joints + noise))
    return copies


def _frame_ms(tracker: FusionTracker, joints: np.ndarray, images: Sequence[Image | None]) -> float:
    tracker.restart()
    took = []
    for frame, (body, image) in enumerate(zip(joints, images, strict=True)):
        began = time.process_time_ns()
        tracker.step(body, (frame + 1) * DEFAULT.frame_ns, image)
        took.append(time.process_time_ns() - began)
    return float(np.median(took)) / 1e6
