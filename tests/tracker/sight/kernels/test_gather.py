import kernel_arrays as arrays
import numpy as np
import pytest
from inhand_tracker.sight.kernels.equations import Equations
from inhand_tracker.sight.kernels.gather import GatherSettings, gather
from inhand_tracker.sight.kernels.inputs import Outlines
from inhand_tracker.sight.kernels.mixed_offset import Mixing

REACH = 0.02, 0.1
SETTINGS = GatherSettings(
    wanted=np.array([True, True, True]),
    returned=0.8,
    outline_weight=0.2,
    surface_weight=0.7,
    sensor=arrays.SENSOR,
    samples=6,
    least_step_pixels=0.5,
    widest_edge_step=2.5,
    contour_error_m=0.002,
    in_front_per_m=3.0,
    behind_per_m=1.5,
    colour_weight=0.5,
    limb_factor=20.0,
    common_pixels=0.5,
    mixing=Mixing(4.0, 4.5, 40.0, 0.1, 3.0),
    mixes=False,
)
OUTLINES, PIXELS = arrays.outlines(), arrays.pixels()
Pose = tuple[np.ndarray, np.ndarray]
Measurement = tuple[np.ndarray, np.ndarray, float, float]


def gathered(
    settings: GatherSettings = SETTINGS,
    *,
    count: int = 24,
    start: float = 0.0,
    outlines: Outlines = OUTLINES,
) -> Equations:
    """The equations of poses, of which every element was ``start`` before."""
    translations, orientations = arrays.poses(count)
    equations = Equations(np.full((count, 6, 6), start), np.full((count, 6), start))
    reaches = np.tile(REACH, (count, 1))
    gather(translations, orientations, reaches, outlines, PIXELS, settings, equations)
    return equations


def summed(
    measurements: list[Measurement], deviation: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The equation of measurements: arm, direction, residual, and weight of each; of a standard
    ``deviation`` where all have the same error beside their own."""
    rows = [np.concatenate((across, np.cross(arm, across))) for arm, across, _, _ in measurements]
    if not rows:
        return np.zeros((6, 6)), np.zeros(6)
    residuals, weights = (np.array([one[part] for one in measurements]) for part in (2, 3))
    seen = weights > 0.0
    matrix, residuals = np.array(rows)[seen], residuals[seen]
    covariance = np.diag(1.0 / weights[seen])
    if deviation is not None:
        covariance += deviation**2
    certainty = np.linalg.inv(covariance)
    return matrix.T @ certainty @ matrix, matrix.T @ certainty @ residuals


def reach_at(arm: np.ndarray) -> float:
    return REACH[0] + REACH[1] * float(np.linalg.norm(arm))


def noise_at(depth: float) -> float:
    return float(arrays.SENSOR.noise_m + arrays.SENSOR.noise_per_m * depth**2)


def across_outline(
    where: np.ndarray, normal: np.ndarray, step: float, sides: np.ndarray
) -> tuple[float, float]:
    """Mean and variance, in pixels, of where the outline lies across a point of it."""
    away = step * np.arange(-SETTINGS.samples, SETTINGS.samples + 1)
    line = where[:, None] + normal[:, None] * away
    colours = arrays.look_up(PIXELS.colour_scores, line)
    odds = step * np.where(away < sides[1], colours[:, 0] - colours[:, 1], 0.0)
    channel = int(arrays.channels(normal[:, None])[0])
    edges = PIXELS.edge_scores[channel, arrays.look_up(PIXELS.edges[channel], line).astype(int)]
    free = arrays.is_inside(line) & (arrays.look_up(PIXELS.limbs, line) == 0.0)
    within = np.cumsum(odds) - odds / 2.0
    # What lies beyond the other side of the object is beside it, too; nothing is known further in.
    beyond = np.where(away - sides[0] > away[0], np.interp(away - sides[0], away, within), 0.0)
    scores = within - beyond + np.where(free & (step < 2.5), edges, 0.0)
    shares = np.exp(scores - scores.max())
    shares /= shares.sum()
    mean = float(shares @ away)
    return mean, float(shares @ away**2) - mean**2 + step**2 / 2.0 + 0.25


def outline(pose: Pose) -> list[Measurement]:
    view = arrays.nearest(OUTLINES.directions, pose)
    arms, points = arrays.place(pose, OUTLINES.points[view].astype(float))
    turned, _ = arrays.place(pose, OUTLINES.normals[view].astype(float))
    normals, where = arrays.project_normals(turned, points), arrays.project(points)
    measured, measurements = arrays.look_up(PIXELS.depth, where), []
    for index in np.flatnonzero(arrays.is_inside(where)):
        arm, point, normal = arms[:, index], points[:, index], normals[:, index]
        margin = arrays.SENSOR.covered_m + 2.0 * noise_at(point[2]) + reach_at(arm)
        if 0.0 < measured[index] < point[2] - margin:
            continue
        per_m = float(arrays.LENS[0]) / point[2]
        step = max(reach_at(arm) * per_m / SETTINGS.samples, SETTINGS.least_step_pixels)
        sides = per_m * np.array([OUTLINES.inside[view, index], OUTLINES.outside[view, index]])
        mean, variance = across_outline(where[:, index], normal, step, sides)
        variance += (SETTINGS.contour_error_m * per_m) ** 2
        certainty = 1.0 / variance - 3.0 / (SETTINGS.samples * (SETTINGS.samples + 1) * step**2)
        slopes = np.vstack((np.eye(2), -point[:2] / point[2])) * arrays.LENS[:2] / point[2]
        weight = SETTINGS.outline_weight * OUTLINES.lengths[view] * max(certainty, 0.0)
        measurements.append((arm, slopes @ normal, mean, weight))
    return measurements


def surface(pose: Pose) -> list[Measurement]:
    view = arrays.nearest(OUTLINES.directions, pose)
    arms, points = arrays.place(pose, OUTLINES.surface_points[view].astype(float))
    normals, _ = arrays.place(pose, OUTLINES.surface_normals[view].astype(float))
    where = arrays.project(points)
    measured, limbs = arrays.look_up(PIXELS.depth, where), arrays.look_up(PIXELS.limbs, where)
    colours, measurements = arrays.look_up(PIXELS.colour_scores, where), []
    for index in np.flatnonzero(measured > 0.0):
        arm, point, normal = arms[:, index], points[:, index], normals[:, index]
        error = measured[index] - point[2]
        deviation = np.hypot(noise_at(point[2]), reach_at(arm) / np.sqrt(3.0))
        near = np.exp(-0.5 * (error / deviation) ** 2) / (np.sqrt(2.0 * np.pi) * deviation)
        other = (SETTINGS.in_front_per_m if error < 0.0 else SETTINGS.behind_per_m) / 0.8
        other *= np.exp(SETTINGS.colour_weight * (colours[index, 1] - colours[index, 0]))
        other *= SETTINGS.limb_factor if limbs[index] else 1.0
        residual = normal @ (point * measured[index] / point[2] - point)
        spread = deviation * max(abs(normal[2]), 0.2)
        weight = SETTINGS.surface_weight * near / (near + other) / spread**2
        measurements.append((arm, normal, residual, weight))
    return measurements


@pytest.mark.parametrize(
    ("wanted", "definition"),
    [
        ((True, True, False), lambda pose: summed(outline(pose), SETTINGS.common_pixels)),
        (
            (True, True, True),
            lambda pose: tuple(
                map(sum, zip(summed(outline(pose), 0.5), summed(surface(pose)), strict=True))
            ),
        ),
    ],
)
def test_equations_are_those_of_the_definition(wanted, definition) -> None:  # type: ignore[no-untyped-def]
    equations = gathered(SETTINGS._replace(wanted=np.array(wanted)))
    assert (equations.information[:, 0, 0] > 0.0).sum() > 12
    for index, pose in enumerate(zip(*arrays.poses(), strict=True)):
        information, gradient = definition(pose)
        scale = np.abs(information).max() + 1.0
        np.testing.assert_allclose(equations.information[index], information, atol=1e-3 * scale)
        np.testing.assert_allclose(equations.gradients[index], gradient, atol=1e-3 * scale)


def test_what_is_not_wanted_adds_nothing() -> None:
    nothing = gathered(SETTINGS._replace(wanted=np.zeros(3, bool)))
    assert not nothing.information.any()
    assert not nothing.gradients.any()


def test_equations_are_added_to_what_was_there() -> None:
    equations, alone = gathered(count=3, start=1.0), gathered(count=3)
    np.testing.assert_allclose(equations.information, 1.0 + alone.information)
    np.testing.assert_allclose(equations.gradients, 1.0 + alone.gradients)


def test_an_outline_of_no_thickness_shows_nothing_by_colours() -> None:
    flat = OUTLINES._replace(inside=np.zeros_like(OUTLINES.inside))
    for mixes in (False, True):
        seen = gathered(SETTINGS._replace(mixes=mixes), outlines=flat)
        assert np.isfinite(seen.information).all()
        assert np.isfinite(seen.gradients).all()
