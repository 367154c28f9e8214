"""How near new objects come to the true ones: by a few measures, and measured by a camera.

The true meshes differ from what the kinds can make: a mug that tapers and bulges, a bottle with a
long shoulder, a label and a sprinkler, a box with round edges, a hammer with a bent handle.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from statistics import median

import numpy as np
import trimesh
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.benchmarks.parameters import DEFAULT_OBJECT_ACCURACY, ObjectAccuracyParameters
from inhand_lab.benchmarks.table_scene import camera_above, standing_at, table_depths
from inhand_lab.geometry.surface_distance import MeasuredSurface, mean_surface_distance
from inhand_lab.new_objects.measuring import MeasuredThing, measure_thing
from inhand_lab.new_objects.recorded_depth import still_depth
from inhand_lab.new_objects.table import MeasuringError
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.kinds import build_kind
from inhand_lab.objects.model import ObjectModel, build_model
from inhand_lab.objects.mug import mug
from inhand_lab.objects.vinegar_bottle import vinegar_bottle
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.random_streams import random_stream

MM_PER_M = 1000.0


@dataclass(frozen=True)
class TrueObject:
    """An object, and what a ruler reads of it: a kind and its measures in centimetres.

    It stands on a table as it is, or lies there with its x axis down.
    """

    model: ObjectModel
    kind: str
    measures_cm: Mapping[str, float]
    lies: bool = False

    @property
    def on_table(self) -> ObjectModel:
        """The object in axes of which z is up when it is on a table."""
        x, y, z = self.model.vertices.T
        return _deformed(self.model, np.column_stack((z, y, -x))) if self.lies else self.model


@dataclass(frozen=True)
class ObjectAccuracy:
    """Mean distances from the true surface in millimetres.

    ``by_measures_mm`` is that of the mesh that the ruler's measures make, ``by_camera_mm`` those of
    the meshes that were fitted, where they were fitted, a scene each; ``stated_mm`` are the
    residuals that these fits stated, and ``kinds`` what was fitted. ``refusals`` are the lines that
    the other scenes got.
    """

    name: str
    by_measures_mm: float
    by_camera_mm: tuple[float, ...]
    stated_mm: tuple[float, ...]
    kinds: tuple[str, ...]
    refusals: tuple[str, ...]

    @property
    def camera_median_mm(self) -> float:
        """The median over the scenes in which something was fitted, NaN where there is none."""
        return median(self.by_camera_mm) if self.by_camera_mm else float("nan")


def check_objects(
    advance: Callable[[], None], parameters: ObjectAccuracyParameters = DEFAULT_OBJECT_ACCURACY
) -> list[ObjectAccuracy]:
    """Compare every object; ``advance`` is called once a scene."""
    return [_check(one, advance, parameters) for one in true_objects()]


def object_steps(parameters: ObjectAccuracyParameters = DEFAULT_OBJECT_ACCURACY) -> int:
    """Number of scenes of all objects."""
    return len(true_objects()) * parameters.scenes


def true_objects() -> tuple[TrueObject, ...]:
    """The four objects."""
    return (
        TrueObject(_bulging_mug(), "mug", {"height": 9.6, "diameter": 8.4, "handle": 3.9}),
        TrueObject(
            vinegar_bottle(),
            "bottle",
            {"height": 21.5, "diameter": 6.2, "neck": 2.6, "shoulder": 11.0},
        ),
        TrueObject(_rounded_box(), "box", {"height": 18.0, "width": 12.0, "depth": 5.0}),
        TrueObject(
            _bent_hammer(),
            "hammer",
            {"length": 33.0, "head": 13.6, "face": 2.7, "handle": 3.2},
            lies=True,
        ),
    )


def _check(
    true: TrueObject, advance: Callable[[], None], parameters: ObjectAccuracyParameters
) -> ObjectAccuracy:
    made = build_kind("made", true.kind, true.measures_cm)
    surface = _surface(true.model.vertices, true.model.faces, parameters)
    by_measures = mean_surface_distance(
        surface, _surface(made.vertices, made.faces, parameters), parameters.compared
    )
    fitted: list[tuple[float, MeasuredThing]] = []
    refusals: list[str] = []
    for outcome in _measured(true.on_table, parameters):
        if isinstance(outcome, str):
            refusals.append(outcome)
        else:
            fitted.append(outcome)
        advance()
    return ObjectAccuracy(
        true.model.name,
        MM_PER_M * by_measures,
        tuple(distance for distance, _ in fitted),
        tuple(thing.residual_mm for _, thing in fitted),
        tuple(thing.kind for _, thing in fitted),
        tuple(refusals),
    )


def _measured(
    model: ObjectModel, parameters: ObjectAccuracyParameters
) -> Iterator[tuple[float, MeasuredThing] | str]:
    """The distance in millimetres of what was measured in each scene, or why it was refused."""
    random = random_stream(parameters.seed, 0, model.name, "table")
    for scene in range(parameters.scenes):
        camera_from_table = camera_above(
            random.uniform(*parameters.distance_m),
            random.uniform(*parameters.down),
            random.uniform(-parameters.aside, parameters.aside),
        )
        x, y = random.uniform(-parameters.off_middle_m, parameters.off_middle_m, 2)
        table_from_object = standing_at(model, x, y, random.uniform(0.0, 2.0 * np.pi))
        depths = table_depths(
            [(model, table_from_object)], camera_from_table, scene, parameters.frames
        )
        try:
            thing = measure_thing(still_depth(depths), KINECT.intrinsics)
        except MeasuringError as error:
            yield str(error)
            continue
        true = (camera_from_table @ table_from_object).apply(model.vertices)
        found = thing.camera_from_object.apply(thing.model.vertices)
        distance = mean_surface_distance(
            _surface(true, model.faces, parameters),
            _surface(found, thing.model.faces, parameters),
            parameters.compared,
        )
        yield MM_PER_M * distance, thing


def _surface(
    vertices: Array, faces: Indices, parameters: ObjectAccuracyParameters
) -> MeasuredSurface:
    return MeasuredSurface(vertices, faces, parameters.samples, parameters.neighbours)


def _bulging_mug() -> ObjectModel:
    """A mug that is 8 % wider at its rim than at its foot, and bulges by 2 mm."""
    model = mug()
    x, y, z = model.vertices.T
    high = z / z.max()
    radii = np.hypot(x, y)
    wider = 1.0 + np.minimum(0.041 / np.maximum(radii, 1e-9), 1.0) * (
        0.04 * (high - 1.0) + 0.05 * (1.0 - high**2) + 0.024
    )
    return _deformed(model, np.column_stack((x * wider, y * wider, z)))


def _bent_hammer() -> ObjectModel:
    """A hammer whose handle bends by 5 mm, as wooden ones do."""
    model = hammer()
    x, y, z = model.vertices.T
    share = (z - z.min()) / np.ptp(z)
    return _deformed(model, np.column_stack((x, y + 0.005 * np.sin(np.pi * share), z)))


def _rounded_box() -> ObjectModel:
    """A box of 18 cm × 12 cm × 5 cm whose edges are round by 6 mm."""
    radius, half = 0.006, np.array([0.06, 0.025, 0.09])
    ball = trimesh.creation.icosphere(subdivisions=2, radius=radius).vertices
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = (corners * (half - radius))[:, None] + ball
    hull = trimesh.convex.convex_hull(points.reshape(-1, 3))
    return build_model("box", [(hull, (184, 148, 104))], [(0.06, 0.025, 0.09)])


def _deformed(model: ObjectModel, vertices: Array) -> ObjectModel:
    mesh = trimesh.Trimesh(vertices, model.faces, process=False)
    marks = [tuple(mark) for mark in model.marked_vertices.tolist()]
    return build_model(model.name, [(mesh, model.colour)], marks)
