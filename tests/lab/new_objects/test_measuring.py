"""Things on a table are measured by simulated depth with its noise, or refused with the reason."""

import numpy as np
import pytest
from inhand_lab.benchmarks.table_scene import camera_above, standing_at, table_depths
from inhand_lab.new_objects.measuring import MeasuredThing, measure_thing
from inhand_lab.new_objects.recorded_depth import still_depth
from inhand_lab.new_objects.table import MeasuringError
from inhand_lab.objects.hammer import hammer
from inhand_lab.objects.handled_shapes import build_box
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import mug
from inhand_lab.objects.turned_shapes import build_bottle, build_can, build_cup
from inhand_lab.sensing.cameras import KINECT, OAK_D, Camera

pytestmark = pytest.mark.long
VIEWS = [(0.7, 0.5, -0.4), (1.0, 0.8, 0.3)]
"""Distance of the camera, angle down, and angle to a side."""
Place = tuple[ObjectModel, float, float, float]


def measured(
    *things: Place, view: tuple[float, float, float] = VIEWS[0], camera: Camera = KINECT
) -> MeasuredThing:
    """What is measured of things at places and turns."""
    placed = [(model, standing_at(model, *place)) for model, *place in things]
    depths = table_depths(placed, camera_above(*view), seed=3, frames=9, camera=camera)
    return measure_thing(still_depth(depths), camera.intrinsics)


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize(
    ("model", "kind", "measures"),
    [
        (build_can("can", 0.11, 0.066), "cylinder", {"height": 11.0, "diameter": 6.6}),
        (
            build_cup("cup", 0.10, 0.08, 0.06),
            "cup",
            {"height": 10.0, "diameter": 8.0, "foot": 6.0},
        ),
        (
            build_bottle("bottle", 0.25, 0.07, 0.028, 0.15),
            "bottle",
            {"height": 25.0, "diameter": 7.0, "neck": 2.8, "shoulder": 15.0},
        ),
        (build_can("pot", 0.20, 0.18), "cylinder", {"height": 20.0, "diameter": 18.0}),
    ],
    ids=["can", "cup", "bottle", "pot"],
)
def test_a_round_thing_is_measured_to_a_few_millimetres(
    model: ObjectModel, kind: str, measures: dict[str, float], view: tuple[float, float, float]
) -> None:
    thing = measured((model, 0.08, -0.05, 0.3), view=view)
    assert thing.kind == kind
    assert dict(thing.measures_cm) == pytest.approx(measures, abs=0.5)
    assert thing.residual_mm < 2.5


@pytest.mark.parametrize("camera", [KINECT, OAK_D], ids=lambda camera: camera.name)
@pytest.mark.parametrize("place", [(0.1, 0.0), (-0.08, 0.06)])
@pytest.mark.parametrize(("height", "diameter"), [(0.05, 0.05), (0.04, 0.085)])
def test_a_small_can_is_round_by_its_outline_where_its_points_do_not_tell(
    height: float, diameter: float, place: tuple[float, float], camera: Camera
) -> None:
    model = build_can("can", height, diameter)
    thing = measured((model, *place, 0.3), view=VIEWS[1], camera=camera)
    assert thing.kind == "cylinder"
    expected = {"height": 100.0 * height, "diameter": 100.0 * diameter}
    assert dict(thing.measures_cm) == pytest.approx(expected, abs=0.4)
    assert thing.overlap > 0.85


@pytest.mark.parametrize("camera", [KINECT, OAK_D], ids=lambda camera: camera.name)
@pytest.mark.parametrize("turn", [0.0, 0.4, 1.2])
def test_a_box_is_measured_to_a_few_millimetres_however_it_is_turned(
    turn: float, camera: Camera
) -> None:
    model = build_box("box", 0.18, 0.12, 0.05)
    thing = measured((model, -0.05, 0.04, turn), view=VIEWS[1], camera=camera)
    assert thing.kind == "box"
    sides = sorted((thing.measures_cm["width"], thing.measures_cm["depth"]))
    assert [*sides, thing.measures_cm["height"]] == pytest.approx([5.0, 12.0, 18.0], abs=0.7)


def test_a_handle_that_is_seen_makes_a_mug_and_one_that_is_hidden_a_cup() -> None:
    seen = measured((mug(), 0.0, 0.0, 3.0))
    assert seen.kind == "mug"
    assert dict(seen.measures_cm) == pytest.approx(
        {"height": 9.6, "diameter": 8.2, "handle": 3.9}, abs=0.8
    )
    assert measured((mug(), 0.0, 0.0, 0.0)).kind == "cup"


def test_a_handle_that_the_cup_parts_from_it_in_the_image_is_still_of_it() -> None:
    assert measured((mug(), 0.0, 0.0, 0.4)).kind in ("mug", "cup")


def test_what_was_measured_stands_where_the_thing_does() -> None:
    camera_from_table = camera_above(*VIEWS[0])
    table_from_object = standing_at(mug(), 0.05, -0.03, 3.0)
    depths = table_depths([(mug(), table_from_object)], camera_from_table, seed=3, frames=9)
    thing = measure_thing(still_depth(depths), KINECT.intrinsics)
    true = (camera_from_table @ table_from_object).apply(mug().marked_vertices)
    handle = thing.camera_from_object.apply(thing.model.marked_vertices)[-1]
    assert np.linalg.norm(handle - true[-1]) < 0.012


@pytest.mark.parametrize("turn", [0.5, 2.0])
@pytest.mark.parametrize("view", [(1.0, 0.8, 0.3), (1.1, 0.5, -0.4)])
def test_what_no_shape_fits_is_refused_with_how_badly(
    turn: float, view: tuple[float, float, float]
) -> None:
    with pytest.raises(MeasuringError, match=r"^no box, cylinder, cup or bottle fits: of the best"):
        measured((hammer(), 0.0, 0.0, turn), view=view)


def test_a_thing_that_is_too_near_for_the_camera_is_refused() -> None:
    box = build_box("box", 0.18, 0.12, 0.05)
    with pytest.raises(MeasuringError):
        measured((box, -0.05, 0.04, 0.4), camera=OAK_D)  # which measures from 0.7 m on


def test_two_things_are_refused_and_nothing_is() -> None:
    can, box = build_can("can", 0.11, 0.066), build_box("box", 0.1, 0.1, 0.1)
    with pytest.raises(MeasuringError, match=r"two things stand on the table, 2\d cm apart"):
        measured((can, -0.15, 0.0, 0.0), (box, 0.15, 0.0, 0.0))
    with pytest.raises(MeasuringError, match="nothing stands on the table"):
        measured()


def test_a_thing_that_is_cut_off_by_the_image_is_refused() -> None:
    camera = camera_above(0.8, 0.3)
    tall = build_box("box", 0.55, 0.08, 0.08)
    depths = table_depths([(tall, standing_at(tall, 0.0, 0.0, 0.0))], camera, seed=3, frames=9)
    with pytest.raises(MeasuringError, match="cut off by the edge of the image"):
        measure_thing(still_depth(depths), KINECT.intrinsics)


@pytest.mark.parametrize("far", [0.0, 3.0])
def test_depth_without_anything_near_is_refused(far: float) -> None:
    with pytest.raises(MeasuringError, match="put the camera half a metre"):
        measure_thing(np.full((480, 640), far), KINECT.intrinsics)


def test_a_wall_alone_is_no_table() -> None:
    with pytest.raises(MeasuringError, match="no table is seen: hold the camera upright"):
        measure_thing(np.full((480, 640), 1.0), KINECT.intrinsics)
