"""Recordings of an Azure Kinect become recordings, with depth where its colour camera sees it."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import azure_kinect
import inhand_recorder
import numpy as np
import pytest
from azure_kinect import (
    BOARD,
    BOARD_M,
    COLOUR,
    COLOUR_LENS,
    DEPTH,
    DEPTH_LENS,
    FRAME_US,
    IR,
    LATE_US,
    NARROW,
    SHIFT_M,
    TANGENTIAL,
    TURN,
    WALL_M,
    WIDE,
    calibration,
    depth_image,
    images,
    jpeg,
    track,
    tracks,
    write_kinect,
)
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from scipy.optimize import fsolve

from inhand.__main__ import main

BEGIN_NS = 1_700_000_000_000_000_000


def bring(source: Path, output: Path, *more: str) -> int:
    return main(["recording", "import", str(source), "--from", "kinect", "-o", str(output), *more])


def through_lens(ray: np.ndarray, lens: tuple[float, ...]) -> np.ndarray:
    """Where a ray (x, y) at a distance of 1 meets a sensor, as shares of its width and height."""
    cx, cy, fx, fy, k1, k2, k3, k4, k5, k6 = lens
    p2, p1 = TANGENTIAL[2:]
    x, y = ray
    r = x * x + y * y
    scale = (1 + k1 * r + k2 * r**2 + k3 * r**3) / (1 + k4 * r + k5 * r**2 + k6 * r**3)
    across = x * scale + 2 * p1 * x * y + p2 * (r + 2 * x * x)
    down = y * scale + 2 * p2 * x * y + p1 * (r + 2 * y * y)
    return np.array([across * fx + cx, down * fy + cy])


def colour_pixel(point: np.ndarray) -> np.ndarray:
    """The pixel of a point in the colour camera's frame: 1280 × 720 of 1280 × 960."""
    share = through_lens(point[:2] / point[2], COLOUR_LENS)
    return share * (1280, 960) - (0, 120) - 0.5


def depth_point(corner: tuple[int, int], z: float) -> np.ndarray:
    """A point at z, seen by the depth camera at a corner of its pixels, in the colour camera's
    frame: the sensor has 512 × 512 such pixels, of which the image begins at (96, 90)."""
    share = np.array([corner[0] + 96, corner[1] + 90]) / 512.0
    ray = fsolve(lambda one: through_lens(one, DEPTH_LENS) - share, (share - 0.5) / 0.49)
    return np.reshape(TURN, (3, 3)) @ (*(ray * z), z) + SHIFT_M


def test_depth_is_where_the_colour_camera_sees_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = write_kinect(tmp_path / "k.mkv", tracks(), images(jpeg()), attached=calibration())
    output = tmp_path / "out.mcap"
    assert bring(source, output, "--camera", "front") == 0
    said = capsys.readouterr().out
    assert f"{output}: 1 info/front, 3 rgbd/front\n" in said
    assert "depth is aligned to colour" in said
    assert verify_recording(output) == []
    about = read_metadata(output)["import"]
    assert (about["source"], about["encoder"]) == ("k.mkv", "libmatroska-1.4.9")
    assert "000123456789" not in str(about)
    with inhand_recorder.open(output) as recording:
        info = recording.infos["front"]
        assert (info.width, info.height, info.depth_scale) == (1280, 720, 0.001)
        assert info.frame_rate == pytest.approx(30.0, rel=1e-3)
        frames = list(recording["rgbd/front"])
    for number, frame in enumerate(frames):
        assert frame.time_ns == BEGIN_NS + 1000 * number * FRAME_US
        assert frame.message.time_uncertainty_ns == 1000 * LATE_US
        assert frame.message.colour.data == jpeg()
    depth_m = frames[0].depth_m
    board = np.argwhere((depth_m > 0) & (depth_m < 0.8))[:, ::-1]
    (top, bottom), (left, right) = ((side.start, side.stop) for side in BOARD)
    corners = [depth_point((x, y), BOARD_M) for x in (left, right) for y in (top, bottom)]
    middle = np.mean([colour_pixel(corner) for corner in corners], axis=0)
    np.testing.assert_allclose(board.mean(axis=0), middle, atol=0.7)
    for place in (corners[0], corners[-1], depth_point((60, 60), WALL_M)):
        x, y = np.round(colour_pixel(place) + (2, 2) * np.sign(middle - colour_pixel(place)))
        assert depth_m[int(y), int(x)] == pytest.approx(place[2], abs=0.002)


@pytest.mark.parametrize("code", ["NV12", "YUY2", "BGRA"])
def test_colour_that_is_no_jpeg_is_coded(code: str, tmp_path: Path) -> None:
    count = 1280 * 720
    data, bits = {
        "NV12": (bytes([90]) * count + bytes([128]) * (count // 2), 12),
        "YUY2": (bytes([90, 128]) * count, 16),
        "BGRA": (bytes([10, 20, 200, 255]) * count, 32),
    }[code]
    source = write_kinect(
        tmp_path / "k.mkv",
        tracks(code.encode(), bits)[:1],
        images(data, frames=1, kinds=(COLOUR,)),
        attached=calibration(),
    )
    assert bring(source, tmp_path / "out.mcap") == 0
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        (frame,) = recording["rgbd/camera"]
        # BT.601: Y of 90 with neutral U and V is grey, 1.164 × (90 − 16).
        shown = (200, 20, 10) if code == "BGRA" else (86, 86, 86)
        np.testing.assert_allclose(frame.colour[360, 640], shown, atol=4)


def test_either_camera_alone_keeps_its_own_view(tmp_path: Path) -> None:
    for kind, place, size in ((COLOUR, 0, WIDE), (DEPTH, 1, NARROW)):
        source = write_kinect(
            tmp_path / f"{kind}.mkv",
            tracks()[place : place + 1],
            images(jpeg(), frames=2, kinds=(kind,)),
            attached=calibration(),
        )
        output = tmp_path / f"{kind}.mcap"
        assert bring(source, output) == 0
        with inhand_recorder.open(output) as recording:
            info = recording.infos["camera"]
            assert (info.has_colour, info.has_depth) == (kind == COLOUR, kind == DEPTH)
            assert (info.width, info.height) == size
            frames = list(recording["rgbd/camera"])
            assert len(frames) == 2
            if kind == DEPTH:
                # Half of 1024 pixels, of which the image begins at (96, 90).
                lens = (0.4928 * 512, 0.502 * 512 - 96.5, 0.501 * 512 - 90.5)
                assert (info.fx, info.cx, info.cy) == pytest.approx(lens)
                np.testing.assert_array_equal(frames[0].depth, depth_image())


def test_an_early_calibration_of_a_part_of_the_sensor_is_the_same_camera(tmp_path: Path) -> None:
    cx, cy, fx, fy, *rest = COLOUR_LENS
    early = (cx, (cy * 3072 - 384) / 2304, fx, fy * 3072 / 2304, *rest, *TANGENTIAL)
    lens = azure_kinect.camera_json("PV0", COLOUR_LENS, (3840, 2160))["Intrinsics"]
    spoilt = calibration(
        Intrinsics=lens | {"ModelParameters": early}, SensorWidth=3840, SensorHeight=2160
    )
    infos = []
    for name, attached in (("new", calibration()), ("early", spoilt)):
        source = write_kinect(
            tmp_path / f"{name}.mkv",
            tracks()[:1],
            images(jpeg(), frames=1, kinds=(COLOUR,)),
            attached=attached,
        )
        assert bring(source, tmp_path / f"{name}.mcap") == 0
        with inhand_recorder.open(tmp_path / f"{name}.mcap") as recording:
            infos.append(recording.infos["camera"])
    for field in ("fx", "fy", "cx", "cy"):
        assert getattr(infos[0], field) == pytest.approx(getattr(infos[1], field))


def test_damaged_images_are_counted_and_a_file_that_was_cut_off_is_read_to_its_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    several = list(images(jpeg(), frames=4))
    several[3] = (COLOUR, several[3][1], jpeg()[:300])
    several[7] = (DEPTH, several[7][1], bytes(100))
    source = write_kinect(tmp_path / "k.mkv", tracks(), several, attached=calibration())
    whole = source.read_bytes()
    source.write_bytes(whole[: -len(depth_image().tobytes()) * 3 // 2])  # within the last depth
    assert bring(source, tmp_path / "out.mcap") == 0
    said = capsys.readouterr().out
    assert "2 images left out; the first: colour: damaged JPEG" in said
    assert "1 of 4 frames have no depth within 20 ms" in said
    assert verify_recording(tmp_path / "out.mcap") == []
    with inhand_recorder.open(tmp_path / "out.mcap") as recording:
        frames = list(recording["rgbd/camera"])
        assert [frame.depth is None for frame in frames] == [False, False, True, True]
        assert [frame.colour is None for frame in frames] == [False, True, False, False]


@pytest.mark.parametrize(
    ("write", "said"),
    [
        (lambda path: path.write_text("no film"), "is no Matroska file that can be read"),
        (lambda path: None, "is no Matroska file that can be read"),
        (lambda path: write_kinect(path, tracks(), images(jpeg())), "has no calibration.json"),
        (
            lambda path: write_kinect(path, tracks(), images(jpeg()), attached=b"{}"),
            "it is not as the SDK has it",
        ),
        (
            lambda path: write_kinect(
                path, tracks(), images(b"", kinds=(IR,)), attached=calibration()
            ),
            "has no image",
        ),
        (
            lambda path: write_kinect(
                path,
                tracks(),
                images(jpeg()),
                attached=calibration(
                    Intrinsics={"ModelParameters": [0.5] * 14, "ModelType": "Theta"}
                ),
            ),
            "a lens of the model 'Theta' is not read",
        ),
        (
            lambda path: write_kinect(
                path, [track(1, "FILM", WIDE, b"MJPG", 24)], images(jpeg(), kinds=(1,))
            ),
            "it has no track COLOR or DEPTH",
        ),
        (
            lambda path: write_kinect(
                path, tracks(b"H264"), images(jpeg()), attached=calibration()
            ),
            "colour in 'H264' is not read",
        ),
        (
            lambda path: write_kinect(
                path,
                tracks(size=(640, 480)),
                images(jpeg((640, 480))),
                attached=calibration(),
            ),
            "no mode of the colour camera has images of 640 × 480",
        ),
        (
            lambda path: write_kinect(
                path, tracks()[1:], images(b"", kinds=(IR,)), attached=calibration()
            ),
            "has no image",
        ),
    ],
)
def test_what_is_no_recording_of_one_is_said_and_nothing_is_made(
    write: Callable[[Path], Any], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path / "k.mkv")
    assert bring(tmp_path / "k.mkv", tmp_path / "out.mcap") == 1
    assert said in capsys.readouterr().err
    assert not list(tmp_path.glob("out*"))
