"""Bags as RealSense's SDK writes them become recordings, with depth aligned to colour."""

from pathlib import Path

import inhand_recorder
import numpy as np
import pytest
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from realsense_bag import (
    CENTRE,
    COLOUR,
    DEPTH,
    DEVICE,
    FRAME_NS,
    SIZE,
    START_NS,
    TURN,
    UNITS_M,
    Bag,
    depth_image,
    write_bag,
    write_db3,
)

from inhand.__main__ import main


def bring(source: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(source), "--from", "ros", "-o", str(output), *more])


def moved_depth() -> np.ndarray:
    """What a camera 5 cm to the right sees, at 60 pixels a radian: the wall moved by 3 pixels, the
    board by 6."""
    depth = np.zeros((SIZE, SIZE), int)
    depth[:, :45] = round(1.0 / UNITS_M)
    depth[20:30, 20:30] = round(0.5 / UNITS_M)
    depth[20:30, 30:33] = 0  # seen by the colour camera alone
    return depth


@pytest.mark.parametrize("one_by_one", [False, True], ids=["2.59", "2.58"])
def test_a_bag_of_a_later_release_has_the_same_frames(
    one_by_one: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.mcap"
    assert bring(write_db3(tmp_path / "a", one_by_one=one_by_one), output) == 0
    said = capsys.readouterr().out
    assert "1 of 3 frames have no depth within 20 ms" in said
    assert "own clock" not in said
    assert verify_recording(output) == []
    assert read_metadata(output)["import"]["device"] == "Intel RealSense D455"
    with inhand_recorder.open(output) as recording:
        assert recording.infos["camera"].depth_scale == UNITS_M
        frames = list(recording["rgbd/camera"])
        assert len(frames) == 3
        for number, frame in enumerate(frames):
            # Milliseconds with six decimals, as a float of 64 bits has them: to 0.2 µs.
            true_ns = START_NS + number * FRAME_NS + 4_000_000
            assert frame.time_ns == frame.received_ns == pytest.approx(true_ns, rel=0, abs=300)
            np.testing.assert_allclose(frame.colour[20, 20], (200, 20, 10), atol=3)
            if number == 1:
                assert frame.depth is None
            else:
                np.testing.assert_array_equal(frame.depth, moved_depth())
    odd = write_db3(tmp_path / "b", model="Kannala Brandt4", first_coefficient=0.1)
    assert bring(odd, tmp_path / "odd.mcap") == 1
    assert "a lens of the model 'Kannala Brandt4' is not read" in capsys.readouterr().err


@pytest.mark.parametrize("units", [UNITS_M, 0.0], ids=["units in images", "units of an option"])
def test_depth_is_what_the_colour_camera_would_measure(
    units: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.mcap"
    bag = write_bag(tmp_path / "a.bag", units=units, shift=(-0.05, 0.0, 0.0))
    assert bring(bag, output, "--camera", "front") == 0
    said = capsys.readouterr().out
    assert f"{output}: 1 info/front, 3 rgbd/front\n" in said
    assert "depth is aligned to colour" in said
    assert "own clock" not in said
    assert verify_recording(output) == []
    about = read_metadata(output)["import"]
    assert (about["device"], about["aligned"]) == ("Intel RealSense D435", "true")
    assert (about["depth"], about["colour"]) == (f"{DEPTH}/image/data", f"{COLOUR}/image/data")
    with inhand_recorder.open(output) as recording:
        assert recording.infos["front"].depth_scale == pytest.approx(UNITS_M)
        frames = list(recording["rgbd/front"])
        for number, frame in enumerate(frames):
            assert frame.time_ns == START_NS + number * FRAME_NS + 4_000_000
            assert frame.received_ns == frame.time_ns
            assert frame.message.time_uncertainty_ns == 4_000_000
            np.testing.assert_array_equal(frame.depth, moved_depth())
            np.testing.assert_allclose(frame.colour[20, 20], (200, 20, 10), atol=3)


def test_a_turned_colour_camera_sees_depth_turned(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "a.bag", turn=TURN, shift=(0.0, 0.0, 0.1))
    assert bring(bag, tmp_path / "out.mcap") == 0
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame, *_) = recording["rgbd/camera"]
        # x goes to y and y to -x, so a pixel (u, v) to (47 - v, u), and all is 10 cm farther away.
        turned = np.rot90(depth_image(), -1)
        board = np.argwhere(turned < 1500).mean(axis=0) - CENTRE
        seen = np.argwhere((frame.depth > 0) & (frame.depth < 1500)).mean(axis=0) - CENTRE
        np.testing.assert_allclose(seen, board * 0.5 / 0.6, atol=0.5)
        assert frame.depth[24, 40] == round(1.1 / UNITS_M)
        assert np.median(frame.depth_m[frame.depth_m < 0.8][1:]) in (0.0, pytest.approx(0.6))


def test_colour_in_yuv_is_read_and_times_of_the_cameras_own_clock_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "a.bag", encoding="yuv422", start_ns=50_000_000_000)
    assert bring(bag, tmp_path / "out.mcap") == 0
    assert "times are of the camera's own clock" in capsys.readouterr().out
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame, *_) = recording["rgbd/camera"]
        # BT.601: Y of 90 with neutral U and V is grey, 1.164 × (90 − 16).
        np.testing.assert_allclose(frame.colour[20, 20], 86, atol=2)


def no_place(bag: Bag) -> None:
    other = f"{DEVICE}/sensor_2/Depth_0"
    bag.stream(other, "mono16", "Brown Conrady", (0.0,) * 5)
    bag.image(other, START_NS, depth_image(), "mono16", UNITS_M)


def cut(bag: Bag) -> None:
    """Put an image whose message is shorter than it says."""
    short = depth_image()[:10]
    bag.image(DEPTH, START_NS + 4 * FRAME_NS, short, "mono16", UNITS_M)
    colour = np.zeros((SIZE, SIZE, 3), np.uint8)
    bag.image(COLOUR, START_NS + 4 * FRAME_NS, colour, "rgb8", UNITS_M)


def test_what_is_missing_or_not_read_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.mcap"
    odd = write_bag(tmp_path / "odd.bag", model="Kannala Brandt4", coefficients=(0.1,) * 5)
    two = write_bag(tmp_path / "two.bag", spoil=no_place)
    more = ("--depth", f"{DEVICE}/sensor_2/Depth_0/image/data")
    for bag, options, said in (
        (odd, (), "a lens of the model 'Kannala Brandt4' is not read"),
        (two, (), "choose one with --depth: /device_0/sensor_0/Depth_0/image/data"),
        (two, more, "there is no /device_0/sensor_2/Depth_0/tf/0"),
    ):
        assert bring(bag, output, *options) == 1
        assert said in capsys.readouterr().err
        assert not output.exists()
    assert bring(write_bag(tmp_path / "cut.bag", spoil=cut), output) == 0
    said = capsys.readouterr().out
    assert "4 rgbd/camera" in said
    assert "1 image left out; the first: /device_0/sensor_0/Depth_0/image/data: " in said
