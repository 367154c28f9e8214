"""Where the head of a body is, and how large."""

import numpy as np
import pytest
from inhand_capture.faces.heads import head_of, head_of_skeleton
from inhand_capture.faces.parameters import DEFAULT_FACES
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person
from msgspec.structs import replace as replace_struct
from posed_person import INFO, pixels_of, seen, standing

RADIUS = DEFAULT_FACES.head_radius_m


@pytest.mark.parametrize("distance", [1.0, 2.5, 5.0])
def test_a_head_is_hidden_by_its_size_in_the_picture(distance: float) -> None:
    truth = standing(z=distance)
    disc = head_of(seen(truth), DEFAULT_FACES)
    assert disc is not None
    assert (disc.x, disc.y) == pytest.approx(tuple(pixels_of(truth)[Joint.HEAD]))
    assert INFO.fx * RADIUS / distance <= disc.radius < 1.5 * INFO.fx * RADIUS / distance


def test_somebody_who_bends_towards_the_camera_has_a_head_as_large() -> None:
    truth = standing()
    for joint in (Joint.HIP_LEFT, Joint.HIP_RIGHT):
        truth[joint, 1] = truth[Joint.SHOULDER_LEFT, 1] + 0.02  # the trunk points at the camera
    disc = head_of(seen(truth), DEFAULT_FACES)
    assert disc is not None
    assert disc.radius >= INFO.fx * RADIUS / 2.5


def test_a_network_that_knows_no_head_has_it_above_the_shoulders() -> None:
    truth = standing()
    expected = pixels_of(truth)[Joint.HEAD]
    truth[Joint.HEAD] = np.nan
    disc = head_of(seen(truth), DEFAULT_FACES)
    assert disc is not None
    assert np.hypot(disc.x - expected[0], disc.y - expected[1]) < 0.5 * disc.radius


def test_a_body_without_shoulders_has_no_place_for_a_head() -> None:
    truth = standing()
    truth[[Joint.HEAD, Joint.SHOULDER_LEFT]] = np.nan
    assert head_of(seen(truth), DEFAULT_FACES) is None


def _skeleton(head: tuple[float, float, float]) -> Person:
    return Person(id=0, joints=(head,) * 20, states=("tracked",) * 20, confidences=(1.0,) * 20)


def test_a_skeleton_s_head_is_where_the_lens_sees_it() -> None:
    disc = head_of_skeleton(_skeleton((0.5, -0.4, 2.0)), INFO, DEFAULT_FACES)
    assert disc is not None
    assert (disc.x, disc.y) == pytest.approx((INFO.cx + INFO.fx / 4, INFO.cy - INFO.fy / 5))
    assert disc.radius == pytest.approx(INFO.fx * RADIUS / 2.0)


def test_a_head_that_is_missing_or_behind_the_camera_hides_nothing() -> None:
    missing = replace_struct(_skeleton((0.0, 0.0, 2.0)), states=("missing",) * 20)
    assert head_of_skeleton(missing, INFO, DEFAULT_FACES) is None
    assert head_of_skeleton(_skeleton((0.0, 0.0, -1.0)), INFO, DEFAULT_FACES) is None
