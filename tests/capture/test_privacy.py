"""No message, log or crash report holds a masked pixel."""

import struct
from pathlib import Path

import numpy as np
import pytest
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_schemas.topics import RGBD, TOPICS
from running_rig import RunningRig, eventually
from secret_source import COLOUR, DEPTH, WIDTH
from wire import Wire

MASK = "masks = [[[0, 0], [0.5, 0], [0.5, 1], [0, 1]]]"
NO_DUMPS = """
import ctypes, resource
from inhand_capture.view.private_memory import forbid_core_dumps
forbid_core_dumps()
print(ctypes.CDLL(None).prctl(3, 0, 0, 0, 0), resource.getrlimit(resource.RLIMIT_CORE)[0])
"""


@pytest.mark.long
@pytest.mark.parametrize(("end", "code"), [("exception", 1), ("abort", -6), ("lost", None)])
def test_a_masked_pixel_is_in_no_message_log_or_crash_report(
    wire: Wire, rig: RunningRig, plugin_folder: Path, end: str, code: int | None
) -> None:
    heard = {stream: wire.hear(topic) for stream, topic in TOPICS.items()}
    rig.configure(
        f'[capture.front]\nsource = "secret"\n{MASK}\n[capture.front.options]\nend = "{end}"\n'
    )
    arguments = ("-m", "inhand_capture", "--config", rig.config)
    daemon = rig.python(*arguments, PYTHONPATH=str(plugin_folder), PYTHONFAULTHANDLER="1")
    eventually("frames", lambda: len(heard[RGBD.stream]) >= 20)
    if code is None:
        daemon.said("the camera went away")
        daemon.stop()
    else:
        assert daemon.wait() == code
    for sample in heard[RGBD.stream]:
        frame = RGBD.decode(sample.payload)
        assert frame.colour is not None
        assert frame.depth is not None
        depth, colour = decode_depth(frame.depth), decode_colour(frame.colour)
        assert not depth[:, : WIDTH // 2].any()
        assert set(np.unique(depth).tolist()) == {0, 1_000}
        assert np.abs(colour.astype(int) - COLOUR).sum(axis=2).min() > 100
    written = daemon.stdout + daemon.stderr
    payloads = b"".join(sample.payload for samples in heard.values() for sample in samples)
    for secret in (struct.pack("<2H", DEPTH, DEPTH), bytes(2 * COLOUR)):
        assert secret not in payloads
        assert secret not in written.encode()
    assert str(COLOUR) not in written
    assert not list(Path.cwd().glob("core*"))


@pytest.mark.long
def test_a_process_with_masks_leaves_no_core_dump(rig: RunningRig) -> None:
    process = rig.python("-c", NO_DUMPS)
    assert process.wait() == 0
    assert process.stdout == "0 0\n"


@pytest.mark.long
@pytest.mark.parametrize(
    ("masks", "line"),
    [
        ("[[[0, 0], [640, 0], [640, 480]]]", "write shares of its width and height"),
        ("[[[0, 0], [1, 1]]]", "at least 3"),
        ("[[0, 0], [1, 1], [0, 1]]", "masks"),
    ],
)
def test_a_mask_that_is_none_is_refused_before_a_start(
    rig: RunningRig, plugin_folder: Path, masks: str, line: str
) -> None:
    rig.configure(f'[capture.front]\nsource = "simulator"\nmasks = {masks}\n')
    daemon = rig.python("-m", "inhand_capture", "--config", rig.config, "--check-config")
    assert daemon.wait() == 2
    assert line in daemon.stderr
    assert "rig.toml:" in daemon.stderr
