"""OpenCV's adaptive trackers, run in a process of their own."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetEntry
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.recognition.adaptive_comparison import Environments, follow_adaptively
from inhand_runtime.errors import InhandError
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import CameraInfo, RgbdFrame, Skeletons
from waving import FRAME_NS

FRAMES = 12


@pytest.fixture
def recording(tmp_path: Path) -> tuple[Path, np.ndarray]:
    """A checkered square that moves 3 pixels a frame, and its boxes; unlabelled at first."""
    random = np.random.default_rng(0)
    background = random.integers(90, 120, (120, 160, 3)).astype(np.uint8)
    square = np.kron(np.indices((4, 4)).sum(axis=0) % 2, np.ones((6, 6)))[..., None] * 255
    boxes, messages = [], []
    messages.append(
        CameraInfo(sequence=0, time_ns=1, width=160, height=120, fx=150, fy=150, cx=80, cy=60)
    )
    for n in range(FRAMES):
        left = 20 + 3 * n
        image = background.copy()
        image[40:64, left : left + 24] = square
        messages.append(Skeletons(sequence=n, time_ns=1 + n * FRAME_NS))
        messages.append(
            RgbdFrame(sequence=n, time_ns=1 + n * FRAME_NS, colour=encode_colour(image))
        )
        boxes.append((left, 40.0, left + 24, 64.0))
    writer = DatasetWriter(tmp_path / "set")
    entry = DatasetEntry(file="recordings/a.mcap", interaction="slide", participant="p")
    writer.add_recording(entry, messages)
    dataset = writer.finish({})
    truth = np.array(boxes, float)
    truth[:2] = np.nan
    return dataset.path(entry), truth


def test_trackers_start_at_the_first_known_box_and_follow(
    recording: tuple[Path, np.ndarray],
) -> None:
    path, truth = recording
    pythons = {"MIL": Environments().of()["MIL"]}
    followed = follow_adaptively(path, load_frames(path, None), truth, pythons)
    assert list(followed) == ["MIL"]
    boxes = followed["MIL"]
    assert np.isnan(boxes[:2]).all()
    np.testing.assert_array_equal(boxes[2], truth[2])
    assert np.linalg.norm((boxes[-1] - truth[-1])[:2]) < 8.0


def test_an_environment_that_is_not_there_is_one_line_with_the_mend() -> None:
    with pytest.raises(InhandError, match=r"cannot run .*; `make contrib` makes an environment"):
        Environments(Path("nowhere/python")).of()
