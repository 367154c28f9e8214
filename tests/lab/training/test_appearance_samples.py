from pathlib import Path

import numpy as np
import pytest
from inhand_lab.training.appearance_samples import appearance_samples
from inhand_lab.training.model_training import train
from inhand_lab.training.parameters import DEFAULT_TRAINING
from waving import waving, write_dataset


def test_samples_are_frames_with_their_own_poses_and_joints(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path / "seen", 2, frames=30, images=True)
    samples = list(appearance_samples(dataset, dataset.entries))
    assert len(samples) == 60
    joints, places, turns = waving(30, 0)
    for (image, translation, rotation, known), frame in zip(samples[:30], range(30), strict=True):
        assert image.colour is not None
        np.testing.assert_allclose(translation, places[frame])
        np.testing.assert_allclose(rotation, turns[frame])
        assert known is not None
        np.testing.assert_allclose(known, joints[frame])


def test_of_many_recordings_some_frames_of_some_are_read(tmp_path: Path) -> None:
    dataset = write_dataset(
        tmp_path / "many", 2 * DEFAULT_TRAINING.appearance_recordings, frames=12, images=True
    )
    samples = list(appearance_samples(dataset, dataset.entries))
    frames = DEFAULT_TRAINING.appearance_frames
    assert len(samples) == frames
    assert len({sample[1].tobytes() for sample in samples}) > 0.9 * frames


@pytest.mark.parametrize("images", [True, False])
def test_training_learns_how_an_object_looks_where_there_are_images(
    tmp_path: Path, images: bool
) -> None:
    dataset = write_dataset(tmp_path / "some", 2, frames=30, images=images)
    model = train(dataset, dataset.entries)
    assert (model.appearance is not None) == images
    assert model.viewpoints.contours is not None
