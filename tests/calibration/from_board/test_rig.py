"""Cameras are placed by a board to the truth, in hard cases too, and how sure that is is true."""

from dataclasses import replace

import numpy as np
import pytest
from board_rigs import WALK, WIDE, disturbed, seen_board, three_cameras
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.adjustment import (
    DEFAULT_ADJUSTMENT,
    Bundle,
    Corners3D,
    adjust,
)
from inhand_calibration.from_board.board import printed_board
from inhand_calibration.from_board.lens import Lens
from inhand_calibration.from_board.rig import _of_camera, solve_rig
from inhand_calibration.from_board.sights import without_false_corners
from inhand_calibration.rigid import inverse, moved
from inhand_lab.sensing.board_walk import board_walk, is_seen
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

PLACE_M, TURN_RAD, CLOCK_S = 0.002, np.radians(0.1), 0.004


@pytest.mark.long
def test_cameras_are_found_with_one_upside_down_of_half_the_rate_and_two_seconds_late() -> None:
    seen = seen_board(11)
    solution = solve_rig(seen.sights)
    for place_m, turn_rad, clock_s in seen.errors(solution).values():
        assert place_m < PLACE_M
        assert turn_rad < TURN_RAD
        assert clock_s < CLOCK_S
    assert min(solution.together().values()) >= 3
    assert np.abs(solution.lens_changes[:, 0] / solution.lens_deviations[:, 0]).max() < 4.5


@pytest.mark.long
def test_false_corners_are_left_out() -> None:
    seen, random = seen_board(12), np.random.default_rng(1)
    for camera in range(3):
        own = seen.sights[camera]
        false = disturbed(own.sights, 0.08, 6.0, random)
        kept = [without_false_corners(own.lens, own.board, one) for one in false]
        seen = seen.with_sights(camera, tuple(one for one in kept if one is not None))
    solution = solve_rig(seen.sights)
    assert all(
        place_m < 2.0 * PLACE_M and turn_rad < TURN_RAD
        for place_m, turn_rad, _ in seen.errors(solution).values()
    )
    assert solution.left_out.min() > 0.001


@pytest.mark.long
@pytest.mark.parametrize(
    ("camera", "lens", "number", "change"),
    [
        (0, replace(WIDE, fx=1.015 * WIDE.fx, fy=1.015 * WIDE.fy), 0, -0.0148),
        (1, replace(WIDE, cx=WIDE.cx + 12.0), 1, -12.0),
    ],
)
def test_a_lens_that_is_other_than_published_is_found_with_what_it_is(
    camera: int, lens: Lens, number: int, change: float
) -> None:
    seen = seen_board(13, cameras=three_cameras()[:2]).with_lens(camera, lens)
    solution = solve_rig(seen.sights)
    z = np.abs(solution.lens_changes / solution.lens_deviations)
    assert z[camera, number] == z.max() > 4.5
    deviation = solution.lens_deviations[camera, number]
    assert solution.lens_changes[camera, number] == pytest.approx(change, abs=3.5 * deviation)


def test_cameras_that_never_see_the_board_together_are_named() -> None:
    seen = seen_board(14, replace(WALK, holds=6))
    lonely = seen.sights[2].sights
    late = tuple(replace(one, time_ns=one.time_ns + 60_000_000_000) for one in lonely)
    said = r"right never saw the board together with front .* Clocks that are more than 10 s apart"
    with pytest.raises(CalibrationError, match=said):
        solve_rig(seen.with_sights(2, late).sights)


@pytest.mark.long
def test_two_cameras_that_look_at_two_boards_are_refused() -> None:
    cameras = three_cameras()[:2]
    one, other = (seen_board(seed, cameras=cameras) for seed in (15, 16))
    with pytest.raises(CalibrationError, match=r"do not see one board|never saw the board"):
        solve_rig(one.with_sights(1, other.sights[1].sights).sights)


def test_the_region_of_ninety_percent_of_independent_errors_holds_about_that_many_truths() -> None:
    cameras = three_cameras()
    from_room = np.array([inverse(one.room_from_camera) for one in cameras])
    true = from_room @ cameras[0].room_from_camera
    inside = [
        one
        for seed in range(30)
        for one in _inside(*_corners(seed, true), true, tuple(c.lens for c in cameras))
    ]
    assert 0.80 <= float(np.mean(inside)) <= 0.98


def _corners(seed: int, true: np.ndarray) -> tuple[Corners3D, np.ndarray]:
    """Corners of a board that stands still in twelve places, with noise, and where it stood."""
    cameras, board = three_cameras(), printed_board("a3")
    random = np.random.default_rng(seed)
    walk = board_walk(board, cameras, random, replace(WALK, shake_m=0.0))
    places = inverse(cameras[0].room_from_camera) @ walk.places
    columns: list[list[np.ndarray]] = [[], [], [], []]
    kept: list[np.ndarray] = []
    for place in places:
        seen = [
            (index, camera.lens.project(moved(true[index] @ place, board.corners)))
            for index, camera in enumerate(cameras)
            if is_seen(board, true[index] @ place, 4.0)
        ]
        if len(seen) < 2:
            continue
        for index, pixels in seen:
            noise = 0.1 * random.standard_normal(pixels.shape)
            count = len(pixels)
            row = (np.full(count, index), np.full(count, len(kept)), board.corners, pixels + noise)
            for column, values in zip(columns, row, strict=True):
                column.append(values)
        kept.append(place)
    camera, moment, corner, pixel = (np.concatenate(column) for column in columns)
    still = np.zeros_like(pixel)
    alike = np.ones(len(pixel))
    return Corners3D(camera, moment, corner, pixel, still, still[:, 0], alike), np.array(kept)


def _inside(
    corners: Corners3D, places: np.ndarray, true: np.ndarray, lenses: tuple[Lens, ...]
) -> list[bool]:
    """Whether the truth lies in each camera's region of 90 %."""
    start = Bundle(true, places, np.zeros(3), np.zeros((3, 3)))
    independent = replace(DEFAULT_ADJUSTMENT, alike=1.0)
    found = adjust(corners, lenses, start, independent)
    inside = []
    for index in (1, 2):
        seen, truth = inverse(found.bundle.cameras[index]), inverse(true[index])
        turn = Rotation.from_matrix(seen[:3, :3] @ truth[:3, :3].T).as_rotvec()
        error = np.concatenate([seen[:3, 3] - truth[:3, 3], turn])
        own = slice(10 * index, 10 * index + 6)
        covariance = _of_camera(found.bundle.cameras[index], found.covariance[own, own])
        inside.append(bool(error @ np.linalg.solve(covariance, error) < chi2(6).ppf(0.9)))
    return inside
