"""Learns an object's model from simulated people, without a dataset on disk."""

from collections.abc import Iterator, Sequence

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.appearance import AppearanceSample, learn_appearance

from inhand_lab.benchmarks.rendered_images import rendered_image
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import Simulation


def learn_model(shown: Sequence[Simulation], looks: int) -> Model:
    """Learn the model of one object from people who use it, as ``inhand train`` does; its
    appearance from about so many frames of them."""
    shape = shape_of(shown[0].object_model)
    sequences = [
        LabelledSequence(
            str(one.participant),
            one.person.handedness == "left",
            read_joints(one),
            one.translations,
            one.rotations,
        )
        for one in shown
    ]
    return Model(
        shown[0].interaction,
        shape,
        learn(sequences, shape.mirror_normal),
        find_viewpoints(shape),
        learn_appearance(shape, _samples(shown, looks)),
        learn_prior(sequences, shape),
    )


def read_joints(shown: Simulation) -> Array:
    """Return the joints (T, 20, 3) that the skeleton tracker reads, missing ones NaN."""
    joints = shown.joints_in_camera.copy()
    joints[shown.joint_states == 0] = np.nan
    return joints


def _samples(shown: Sequence[Simulation], looks: int) -> Iterator[AppearanceSample]:
    for one in shown:
        joints = read_joints(one)
        for frame in np.linspace(0, one.frames - 1, looks // len(shown)).astype(int):
            image = rendered_image(one, frame)
            yield image, one.translations[frame], one.rotations[frame], joints[frame]
