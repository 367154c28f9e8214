"""``inhand recording redact`` as it is called, with the real networks on a drawn person."""

import json
from pathlib import Path

import pytest
from drawn_heads import head_pixels
from fetched_weights import use_weights
from inhand_lab.sensing.render import OBJECT, PERSON
from inhand_lab.world.messages import camera_info, person_message, pixels_message
from inhand_lab.world.simulation import Simulation, simulate
from inhand_runtime.pixels import decode_colour, decode_depth
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS
from recordings import write_message

from inhand.__main__ import main

FRAMES = 6
BLACK = 70
"""Brightest that JPEG makes a black pixel whose neighbours are not."""


def _record(path: Path, simulation: Simulation) -> Path:
    with RecordingWriter(path) as writer:
        write_message(writer, INFO, "front", camera_info(simulation.intrinsics, 30.0))
        for frame in range(FRAMES):
            stamp = {"sequence": frame, "time_ns": 10**18 + frame * 33_333_333}
            write_message(writer, RGBD, "front", pixels_message(simulation.render(frame), **stamp))
            write_message(
                writer,
                SKELETONS,
                "front",
                Skeletons(**stamp, people=(person_message(simulation, frame),)),
            )
    return path


@pytest.mark.long
def test_no_true_pixel_of_a_head_or_a_person_is_left_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    use_weights(monkeypatch, "full", "faces")
    simulation = simulate("pourCream", 3, seed=12, frames=FRAMES)
    path, told = _record(tmp_path / "pours.mcap", simulation), tmp_path / "told.json"
    for what in ("faces", "people"):
        output = tmp_path / f"{what}.mcap"
        words = ["recording", "redact", str(path), "-o", str(output), f"--{what}"]
        assert main([*words, "--json", str(told)]) == 0
        assert json.loads(told.read_text())["redacted"]["counts"] == {"frames": FRAMES}
        for message in read_recording(output, streams=("rgbd",)):
            frame = RGBD.decode(message.payload)
            assert frame.colour is not None
            assert frame.depth is not None
            colour, depth = decode_colour(frame.colour), decode_depth(frame.depth)
            labels = simulation.draw(frame.sequence).canvas.labels
            faces = what == "faces"
            sought = head_pixels(simulation, frame.sequence) if faces else labels == PERSON
            assert sought.sum() > 500
            assert not depth[sought].any()
            assert colour[sought].max() < BLACK
            assert (depth > 0).mean() > 0.5
            if faces:
                assert (depth[labels == OBJECT] > 0).mean() > 0.3
    capsys.readouterr()
    assert main(["recording", "info", str(output)]) == 0
    assert "people hidden by inhand " in capsys.readouterr().out


def test_what_is_to_be_hidden_must_be_said(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["recording", "redact", "in.mcap", "-o", "out.mcap"])
    assert "--faces --people" in capsys.readouterr().err
