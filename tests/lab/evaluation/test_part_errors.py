"""How well parts predict an object that is carried in the right hand."""

import subprocess
import sys

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.evaluation.part_errors import PartErrors, measure_part_errors
from inhand_tracker.body.skeleton import PARTS, RIGHT_HAND
from waving import write_dataset

RIGHT_WRIST = PARTS.index("WristRight")


@pytest.fixture(scope="module")
def waved(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return write_dataset(tmp_path_factory.mktemp("waved"), frames=90)


@pytest.fixture(scope="module")
def errors(waved: Dataset) -> PartErrors:
    return measure_part_errors(waved, by_true_joints=False)


def test_the_carrying_hand_predicts_translation_better_than_most_parts(errors: PartErrors) -> None:
    assert errors.translation_m[RIGHT_HAND] < 0.03
    assert errors.translation_m[RIGHT_HAND] < np.median(errors.translation_m[:-1])


def test_the_short_hand_bone_turns_more_with_noise_than_the_forearm(errors: PartErrors) -> None:
    assert errors.rotation_rad[RIGHT_HAND] > errors.rotation_rad[RIGHT_WRIST]


def test_the_mean_of_all_parts_is_better_than_a_part_on_average(errors: PartErrors) -> None:
    assert errors.translation_m[-1] < errors.translation_m[:-1].mean()
    assert errors.rotation_rad[-1] < errors.rotation_rad[:-1].mean()


def test_a_dataset_of_real_people_has_no_column_of_true_joints(waved: Dataset) -> None:
    command = [sys.executable, "-m", "inhand_lab.evaluation.part_errors", str(waved.folder)]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "measured: cm" in shown
    assert "true: cm" not in shown
    assert "HandRight" in shown
