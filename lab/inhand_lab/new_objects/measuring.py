"""Measures the one thing on a table by depth: which shape fits it, how large, and how well."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.raster import nearest_depths

from inhand_lab.geometry.transforms import Transform, rotation_about
from inhand_lab.new_objects.outline_fit import (
    FittedShape,
    fit_bottle,
    fit_box,
    fit_cup,
    fit_cylinder,
)
from inhand_lab.new_objects.parameters import DEFAULT_MEASURING, MeasuringParameters
from inhand_lab.new_objects.table import MeasuringError, Standing, cut_out
from inhand_lab.objects.kinds import KINDS, require_measures
from inhand_lab.objects.model import ObjectModel

FITS = (fit_box, fit_cylinder, fit_cup, fit_bottle)
"""The shapes that are tried, the simplest first."""


@dataclass(frozen=True)
class MeasuredThing:
    """A thing that was measured.

    ``kind`` and ``measures_cm`` are as ``objects.kinds`` takes them, and ``model`` is what they
    make. ``residual_mm`` is the mean distance of the points that are on its surface, ``off_share``
    the share of those that are not, and ``overlap`` the pixels that are of both the thing and the
    model, as a share of those of either. ``cost`` is what the shapes are compared by.
    ``camera_from_object`` is where the model stands.
    """

    kind: str
    measures_cm: Mapping[str, float]
    model: ObjectModel
    residual_mm: float
    off_share: float
    overlap: float
    cost: float
    points: int
    camera_from_object: Transform


def measure_thing(
    depth: Array, intrinsics: Intrinsics, parameters: MeasuringParameters = DEFAULT_MEASURING
) -> MeasuredThing:
    """Measure what stands on the table in depth (H, W), metres; raises MeasuringError."""
    return fit_standing(cut_out(depth, intrinsics, parameters), parameters)


def fit_standing(
    standing: Standing, parameters: MeasuringParameters = DEFAULT_MEASURING
) -> MeasuredThing:
    """Fit every shape to a thing on a table, and take the simplest of the best.

    Raises MeasuringError where none fits.
    """
    count = min(parameters.fitted_points, len(standing.points))
    points = standing.points[np.linspace(0, len(standing.points) - 1, count).astype(np.int64)]
    off_m = parameters.off_m + parameters.plane_m_per_m2 * standing.distance_m**2
    fits = [_with_handle(fit(points, parameters), points, off_m, parameters) for fit in FITS]
    best, *others = (_made(fitted, standing, off_m) for fitted in fits)
    for thing in others:
        if thing.cost < parameters.simpler * best.cost:
            best = thing
    _require_fit(best, off_m, parameters)
    return best


def _made(fitted: FittedShape, standing: Standing, off_m: float) -> MeasuredThing:
    """What a fitted shape makes, of whatever measures, and how well it fits."""
    measures_cm = {name: round(100.0 * metres, 1) for name, metres in fitted.measures.items()}
    model = KINDS[fitted.kind].build("measured", **fitted.measures)
    height = float(np.ptp(model.vertices[:, 2]))
    table_from_object = Transform(
        np.array([*fitted.centre, height / 2.0]), rotation_about("z", fitted.turn)
    )
    off = fitted.distances > off_m
    overlap = _overlap(model, table_from_object, standing)
    # One that is off counts as if just off, so that a few wild points do not choose the shape.
    mean_m = float(np.minimum(fitted.distances, off_m).mean())
    return MeasuredThing(
        fitted.kind,
        measures_cm,
        model,
        1000.0 * (off_m if off.all() else float(fitted.distances[~off].mean())),
        float(off.mean()),
        overlap,
        mean_m / max(overlap, 1e-3) ** 2,
        len(standing.points),
        standing.camera_from_table @ table_from_object,
    )


def _require_fit(thing: MeasuredThing, off_m: float, parameters: MeasuringParameters) -> None:
    """Raise MeasuringError for a shape that does not fit, or of measures that no such thing has."""
    try:
        require_measures(thing.kind, thing.measures_cm)
    except SettingsError as error:
        raise MeasuringError(
            f"no box, cylinder, cup or bottle fits: of the best, a {thing.kind}, {error}; see "
            "that depth shows all of the thing, which may be too near to the camera"
        ) from None
    if (
        thing.off_share <= parameters.most_off_share
        and thing.residual_mm <= 1000.0 * parameters.most_residual_m
        and thing.overlap >= parameters.least_overlap
    ):
        return
    raise MeasuringError(
        f"no box, cylinder, cup or bottle fits: of the best, a {thing.kind}, "
        f"{thing.off_share:.0%} of the points lie more than {1000.0 * off_m:.0f} mm off, the "
        f"others {thing.residual_mm:.1f} mm on average, and {thing.overlap:.0%} of the outline is "
        "the same; stand the thing upright by itself, or make it with --kind or --mesh"
    )


def _overlap(model: ObjectModel, table_from_object: Transform, standing: Standing) -> float:
    """The pixels of both a thing and its model, as a share of those of either.

    What is too low to be told from the table is not compared, nor are pixels without depth.
    """
    placed = (standing.camera_from_table @ table_from_object).apply(model.vertices)
    size = standing.seen.shape
    pixels = standing.intrinsics.project(placed)
    depths = nearest_depths(pixels, placed[:, 2], model.faces, (size[0], size[1]))
    rows, columns = np.nonzero(np.isfinite(depths) & standing.measured)
    across = np.column_stack((columns, rows)).astype(np.float64)
    surface = standing.intrinsics.unproject(across, depths[rows, columns])
    high = standing.camera_from_table.inverse().apply(surface)[:, 2] > standing.cut_m
    drawn = np.zeros(size, bool)
    drawn[rows[high], columns[high]] = True
    return float((drawn & standing.seen).sum() / (drawn | standing.seen).sum())


def _with_handle(
    fitted: FittedShape, points: Array, off_m: float, parameters: MeasuringParameters
) -> FittedShape:
    """A mug in place of a cup from which points stand out to one side.

    The points of the handle are taken to be on it.
    """
    if fitted.kind != "cup":
        return fitted
    across = points[:, :2] - fitted.centre
    radii = np.linalg.norm(across, axis=1)
    radius = max(fitted.measures["diameter"], fitted.measures["foot"]) / 2.0
    outside = (fitted.distances > off_m) & (radii > radius + off_m)
    if outside.mean() < parameters.least_handle_share:
        return fitted
    towards = across[outside] / radii[outside, None]
    middle = towards.mean(axis=0)
    reach = float(np.quantile(radii[outside], 1.0 - parameters.outermost)) - radius
    together = float(np.linalg.norm(middle)) >= parameters.handle_spread
    if not together or reach < parameters.least_handle_m:
        return fitted
    measures = {
        "height": fitted.measures["height"],
        "diameter": fitted.measures["diameter"],
        "handle": reach,
    }
    # A mug's handle is towards its +y.
    turn = float(np.arctan2(middle[1], middle[0])) - 0.5 * np.pi
    distances = np.where(outside, 0.0, fitted.distances)
    return FittedShape("mug", measures, fitted.centre, turn, distances)
