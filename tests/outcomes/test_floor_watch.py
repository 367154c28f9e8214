"""When the floor is looked for, and what comes of it."""

from typing import Any

import numpy as np
import pytest
from inhand_outcomes.floor_watch import DEFAULT_FLOOR_WATCH, FloorWatch
from inhand_runtime.pixels import encode_depth
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, DepthImage, RgbdFrame

S = 1_000_000_000
INFO = CameraInfo(
    sequence=0, time_ns=0, width=320, height=240, fx=262.5, fy=262.5, cx=159.5, cy=119.5
)
UP = np.array([0.0, -np.cos(0.4), -np.sin(0.4)])
"""Up in a camera that looks down by 0.4 radians."""


def floor_frame(second: float, camera_height: float = 1.3) -> RgbdFrame:
    """A frame with depth of nothing but the floor."""
    v, u = np.mgrid[0:240, 0:320]
    rays = np.stack([(u - 159.5) / 262.5, (v - 119.5) / 262.5, np.ones(u.shape)], axis=-1)
    down = -(rays @ UP)
    along = np.where(down > 0.05, camera_height / np.maximum(down, 0.05), 0.0)
    depth = np.where(along < 6.0, np.rint(1000.0 * along), 0.0).astype(np.uint16)
    return RgbdFrame(sequence=0, time_ns=round(second * S), depth=encode_depth(depth))


def a_watch() -> tuple[FloorWatch, list[Any]]:
    """A watch of the camera ``front``, and what it tells of depth."""
    told: list[Any] = []
    watch = FloorWatch(lambda *one: told.append(one))
    watch.hear_info("front", INFO)
    return watch, told


def test_the_floor_is_found_in_the_first_frame_and_told() -> None:
    watch, told = a_watch()
    assert watch.room is None
    watch.hear_frame("front", floor_frame(1.0))
    assert watch.room is not None
    np.testing.assert_allclose(watch.room.up, UP, atol=0.01)
    assert watch.room.floor_height == pytest.approx(-1.3, abs=0.02)
    assert len(told) == 1


def test_it_is_looked_for_often_at_first_and_seldom_then() -> None:
    watch, told = a_watch()
    for second in range(1, 601):
        if watch.wants_frame(second * S):
            watch.hear_frame("front", floor_frame(float(second)))
    usual = DEFAULT_FLOOR_WATCH
    assert len(told) == usual.first_looks + int(600 // usual.period_s) - 1


def test_a_camera_that_was_moved_has_another_floor() -> None:
    watch, _ = a_watch()
    for second in (1.0, 4.0, 7.0):
        watch.hear_frame("front", floor_frame(second))
    for second in (400.0, 800.0, 1200.0):
        watch.hear_frame("front", floor_frame(second, camera_height=1.6))
    assert watch.room is not None
    assert watch.room.floor_height == pytest.approx(-1.6, abs=0.02)


def test_damaged_depth_is_an_error_and_changes_nothing() -> None:
    watch, told = a_watch()
    damaged = DepthImage("z16-zstd", 320, 240, b"no zstd")
    with pytest.raises(MessageError):
        watch.hear_frame("front", RgbdFrame(sequence=0, time_ns=S, depth=damaged))
    assert (watch.room, told) == (None, [])


def test_frames_without_depth_are_asked_for_no_more_often_than_others() -> None:
    watch, _ = a_watch()
    assert watch.wants_frame(S)
    watch.hear_frame("front", RgbdFrame(sequence=0, time_ns=S))
    period_ns = round(DEFAULT_FLOOR_WATCH.first_period_s * S)
    assert not watch.wants_frame(S + period_ns // 2)
    assert watch.wants_frame(S + period_ns)
