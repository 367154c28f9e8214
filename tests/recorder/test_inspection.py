"""What is in a recording, as `inhand recording info` shows it."""

from pathlib import Path

import pytest
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.losses import LossCounter
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError, RecordingWriter
from recordings import POSE_KEY, RGBD_KEY, SKELETONS_KEY, write_frame


def test_a_gap_between_estimates_is_no_loss_and_between_pictures_is_one(
    tmp_path: Path,
) -> None:
    with RecordingWriter(tmp_path / "walk.mcap") as writer:
        for number in (0, 1, 4, 5):
            write_frame(writer, LossCounter(), number, 20)
    lost = {key.key: key.lost for key in inspect_recording(writer.path).keys}
    assert lost == {RGBD_KEY: 2, SKELETONS_KEY: 0, POSE_KEY: 0}


@pytest.mark.parametrize("content", [b"", bytes(4096)], ids=["no byte", "zeros of a power cut"])
def test_an_empty_file_is_said_to_be_empty(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "walk.mcap"
    path.write_bytes(content)
    for look in (inspect_recording, verify_recording):
        with pytest.raises(RecordingError, match="is empty: nothing was recorded into it; delete"):
            look(path)
