"""What vessels hold, against formulas of cylinders and boxes."""

import numpy as np
import pytest
from cups import HEIGHT, MUG, RADIUS, VOLUME_ML, WALL, round_cup, turned, with_box
from inhand_outcomes.measures.vessels import VesselParameters, inside_of, measure_inside

COARSE = VesselParameters(cubes=24, step_deg=15.0)
MIDDLING = VesselParameters(cubes=28)


def test_an_upright_cup_holds_a_cylinder_and_a_tilted_one_what_formulas_say() -> None:
    inside = measure_inside(*round_cup(), MIDDLING)
    assert inside is not None
    assert not inside.solid
    assert inside.full_ml == pytest.approx(VOLUME_ML, rel=0.03)
    # The surface from the lip to the opposite edge of the bottom halves the cylinder; the one to
    # the middle of the bottom leaves a hoof of 2/3 r^2 h.
    halved, hoof = np.arctan(HEIGHT / (2.0 * RADIUS)), np.arctan(HEIGHT / RADIUS)
    assert inside.holds(halved) == pytest.approx(VOLUME_ML / 2.0, rel=0.04)
    assert inside.holds(hoof) == pytest.approx(2.0 / 3.0 * RADIUS**2 * HEIGHT * 1e6, rel=0.08)
    assert inside.holds(np.radians(95.0)) == pytest.approx(0.0, abs=2.0)
    assert inside.radius == pytest.approx(RADIUS, abs=0.002)
    assert inside.rim[2] == pytest.approx(HEIGHT, abs=0.003)
    # Before the surface reaches the bottom, it falls by pi r^3 / cos^2 for each radian.
    slope = np.pi * RADIUS**3 / np.cos(0.5) ** 2 * 1e6
    assert inside.ml_per_radian(0.5) == pytest.approx(slope, rel=0.1)


def test_a_handle_holds_nothing_and_is_no_part_of_the_rim() -> None:
    inside = inside_of(MUG)
    assert inside is not None
    assert inside is inside_of(MUG), "it is worked out once"
    assert inside.full_ml == pytest.approx(VOLUME_ML, rel=0.03)
    np.testing.assert_allclose(inside.rim[:2], 0.0, atol=0.003)


def test_a_cup_that_was_taught_as_a_solid_is_given_a_wall_and_doubted() -> None:
    outer = RADIUS + WALL
    solid = turned([(0, -WALL), (outer, -WALL), (outer, HEIGHT), (0, HEIGHT)])
    handle = np.array([-0.005, 0.04, 0.02]), np.array([0.005, 0.075, 0.08])
    inside = measure_inside(*with_box(solid, *handle), MIDDLING)
    assert inside is not None
    assert inside.solid
    assert inside.full_ml == pytest.approx(VOLUME_ML, rel=0.1)
    assert inside.deviation > VesselParameters().deviation


def test_a_box_whose_wall_is_lower_on_one_side_holds_less_towards_it() -> None:
    wall, half, high, low = 0.004, 0.04, 0.08, 0.06
    sides = [
        ([-half, -half, -wall], [half, half, 0.0]),
        ([-half - wall, -half, -wall], [-half, half, high]),
        ([half, -half, -wall], [half + wall, half, high]),
        ([-half, -half - wall, -wall], [half, -half, high]),
        ([-half, half, -wall], [half, half + wall, low]),
    ]
    mesh = np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    for first, last in sides:
        mesh = with_box(mesh, np.array(first), np.array(last))
    inside = measure_inside(*mesh, COARSE)
    assert inside is not None
    area_ml = (2.0 * half) ** 2 * 1e6
    assert inside.full_ml == pytest.approx(area_ml * low, rel=0.05)
    # Tilted by 15 degrees, the mean height is half a side's rise below the lip.
    tilt, rise = np.radians(15.0), half * np.tan(np.radians(15.0))
    assert inside.holds(tilt, np.pi / 2.0) == pytest.approx(area_ml * (low - rise), rel=0.08)
    assert inside.holds(tilt, np.pi / 2.0) < 0.9 * inside.holds(tilt, -np.pi / 2.0)


def test_a_plate_holds_nothing() -> None:
    mesh = np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    plate = with_box(mesh, np.array([-0.1, -0.1, 0.0]), np.array([0.1, 0.1, 0.01]))
    assert measure_inside(*plate, COARSE) is None
