from dataclasses import replace

import numpy as np
import pytest
import trimesh
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.rotations import angle_between
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.refinement import PosePrior
from inhand_tracker.sight.sight import SIGHT_TERMS, Sight, SightTerm
from people import STANDING, quaternion_of, scipy_rotation
from scipy.spatial.transform import Rotation
from sights import CAMERA, PLACE, TURN, appearance, draw, scattered, sight, view_of

HAND = 11


@pytest.mark.parametrize(
    ("terms", "share"),
    [
        (("edges",), 0.05),
        (("region",), 0.01),
        (("interior",), 0.1),
        (("depth",), 0.01),
        (SIGHT_TERMS, 0.002),
    ],
)
def test_the_true_pose_is_among_the_likeliest(terms: tuple[SightTerm, ...], share: float) -> None:
    eyes = sight(terms, appearance())
    weights = eyes.log_likelihood(*scattered(2000, 0.05, 20.0), view_of(eyes, draw()))
    assert np.mean(weights > weights[0]) < share


def test_terms_add_up_and_what_is_left_out_is_zero() -> None:
    poses, both = scattered(50, 0.05, 20.0), sight(("edges", "depth"), appearance())
    view = view_of(both, draw())
    by_term = both.log_likelihoods_by_term(*poses, view)
    assert tuple(by_term) == SIGHT_TERMS
    np.testing.assert_array_equal(by_term["region"], np.zeros(50))
    np.testing.assert_allclose(both.log_likelihood(*poses, view), sum(by_term.values()))
    alone = sight(("depth",), appearance())
    np.testing.assert_allclose(alone.log_likelihood(*poses, view), by_term["depth"])


def test_a_boundary_says_as_much_however_long_the_rest_of_the_outline_is() -> None:
    """A plate of 20 cm × 20 cm × 2 cm: points lie denser around its edge than around its face."""
    mesh = trimesh.creation.box((0.2, 0.2, 0.02))
    vertices = np.asarray(mesh.vertices, float)
    plate = ObjectShape("plate", vertices, np.asarray(mesh.faces), vertices, np.array([1.0, 0, 0]))
    eyes = Sight(plate, find_viewpoints(plate), terms=("edges",))
    grey = np.full((480, 640, 3), 90, np.uint8)
    grey[:, 320:] = 170
    view = eyes.view(prepare(Image(None, CAMERA, None, grey)), eyes.start())
    view.pixels.edge_scores[:] = 1.0
    facing = np.array([1.0, 0.0, 0.0, 0.0])
    edge_on = quaternion_of(Rotation.from_rotvec([np.pi / 2.0, 0.0, 0.0]))
    ahead = np.tile([0.0, 0.0, 1.5], (2, 1))
    whole, narrow = eyes.weigh(ahead, np.array([facing, edge_on]), view)[:, 0]
    assert narrow / whole == pytest.approx(0.44 / 0.8, abs=0.06)


def test_an_image_that_holds_nothing_says_nothing() -> None:
    eyes, poses = sight(), scattered(20, 0.05, 20.0)
    empty = Image(None, CAMERA, np.zeros((480, 640), np.float32), None)
    np.testing.assert_array_equal(eyes.log_likelihood(*poses, view_of(eyes, empty)), np.zeros(20))
    nothing = replace(empty, depth=None)
    np.testing.assert_array_equal(eyes.log_likelihood(*poses, view_of(eyes, nothing)), np.zeros(20))


def test_what_is_out_of_the_image_or_behind_the_camera_is_neither_likely_nor_unlikely() -> None:
    eyes = sight(SIGHT_TERMS, appearance())
    places = np.array([[5.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    weights = eyes.log_likelihood(places, np.tile(TURN, (2, 1)), view_of(eyes, draw()))
    np.testing.assert_allclose(weights, 0.0, atol=1e-6)


def test_without_appearance_edges_and_depth_find_it_all_the_same() -> None:
    eyes = sight()
    weights = eyes.log_likelihood(*scattered(2000, 0.05, 20.0), view_of(eyes, draw()))
    assert np.mean(weights > weights[0]) < 0.01


def test_colours_learned_on_the_way_tell_as_much_as_those_of_training() -> None:
    eyes, frame = sight(("region",)), prepare(draw())
    colours = eyes.learn(eyes.start(), frame, PLACE, TURN, of_object=0.1, around=0.5)
    poses = scattered(2000, 0.05, 20.0)
    weights = eyes.log_likelihood(*poses, eyes.view(frame, colours))
    assert np.mean(weights > weights[0]) < 0.01


def test_depth_missing_all_over_says_nothing() -> None:
    eyes, image = sight(("depth",), appearance()), draw()
    holes = replace(image, depth=np.zeros_like(image.depth))
    weights = eyes.log_likelihood(*scattered(20, 0.05, 20.0), view_of(eyes, holes))
    np.testing.assert_array_equal(weights, np.zeros(20))


def test_something_measured_in_front_says_nothing_and_something_behind_speaks_against() -> None:
    eyes, image = sight(("depth",), appearance()), draw()
    truth = (PLACE[None], TURN[None])
    for depth, least, most in ((0.6, -0.05, 0.05), (1.9, -100.0, -5.0)):
        wall = replace(image, depth=np.full((480, 640), depth, np.float32))
        (weight,) = eyes.log_likelihood(*truth, view_of(eyes, wall))
        assert least <= weight <= most


def test_an_object_that_returns_no_depth_is_not_sought_in_the_surfaces_around_it() -> None:
    eyes = sight(("depth",), appearance(returns_depth=False))
    assert appearance(returns_depth=False).returned < 0.1
    view = view_of(eyes, draw(returns_depth=False))
    # In the plane of the wall, where a wall is measured, or in its own hole.
    on_wall = PLACE * (2.0 / PLACE[2]) + np.array([0.5, 0.0, 0.0])
    weights = eyes.log_likelihood(np.array([PLACE, on_wall]), np.tile(TURN, (2, 1)), view)
    assert weights[0] > weights[1]


def test_what_something_nearer_covers_is_not_held_against_a_pose() -> None:
    eyes, image = sight(("edges", "region", "interior"), appearance()), draw()
    before = eyes.log_likelihood(PLACE[None], TURN[None], view_of(eyes, image))
    column = int(CAMERA.project(PLACE)[0])
    colour, depth = image.colour.copy(), image.depth.copy()
    colour[:, column:], depth[:, column:] = (60, 60, 160), 0.7
    covered = replace(image, colour=colour, depth=depth)
    uncovered = replace(covered, depth=image.depth)
    known, unknown = (
        eyes.log_likelihood(PLACE[None], TURN[None], view_of(eyes, one))
        for one in (covered, uncovered)
    )
    assert 0.3 * before[0] < known[0] < before[0]
    assert unknown[0] < known[0] - 2.0


def test_where_a_hand_may_be_strange_colours_count_less() -> None:
    eyes, image = sight(("interior",), appearance()), draw()
    colour = image.colour.copy()
    row, column = (int(value) for value in CAMERA.project(PLACE)[::-1])
    colour[row - 20 : row + 20, column - 20 : column + 20] = (220, 180, 150)
    held = replace(image, colour=colour, depth=None)
    joints = STANDING + (PLACE - STANDING[HAND])
    with_hand, without = (
        eyes.log_likelihood(PLACE[None], TURN[None], view_of(eyes, held, known))
        for known in (joints, None)
    )
    assert with_hand[0] > without[0] + 0.5


def test_threads_give_the_same() -> None:
    poses = scattered(3000, 0.05, 20.0)
    one, two = sight(SIGHT_TERMS, appearance()), sight(SIGHT_TERMS, appearance(), threads=2)
    view = view_of(one, draw())
    np.testing.assert_array_equal(
        one.log_likelihood(*poses, view), two.log_likelihood(*poses, view)
    )
    assert two.log_likelihood(np.empty((0, 3)), np.empty((0, 4)), view).shape == (0,)


def prior_about(place: np.ndarray, turn: np.ndarray, metres: float, degrees: float) -> PosePrior:
    spread = np.repeat([3.0 / metres**2, 3.0 / np.deg2rad(degrees) ** 2], 3)
    return PosePrior(place, turn, np.diag(spread))


@pytest.mark.parametrize("terms", [SIGHT_TERMS, ("edges", "region", "interior")])
def test_refinement_brings_a_pose_near_to_the_true_one(terms: tuple[SightTerm, ...]) -> None:
    eyes = sight(terms, appearance())
    view = view_of(eyes, draw())
    places, turns = scattered(21, 0.03, 10.0)
    refined = [
        eyes.refine(place[None], turn[None], view, prior_about(place, turn, 0.03, 10.0))
        for place, turn in zip(places[1:], turns[1:], strict=True)
    ]
    off = [np.linalg.norm(one.translations[0] - PLACE) for one in refined]
    turned = [np.rad2deg(angle_between(one.rotations[0], TURN)) for one in refined]
    # Without depth the distance along the view is only seen by the size.
    assert np.median(off) < (0.004 if "depth" in terms else 0.015)
    assert np.median(turned) < (2.0 if "depth" in terms else 4.0)


def test_where_nothing_is_seen_the_prior_is_what_remains() -> None:
    eyes = sight(SIGHT_TERMS, appearance())
    nothing = view_of(eyes, Image(None, CAMERA, np.zeros((480, 640), np.float32), None))
    start = PLACE + np.array([0.02, 0.0, -0.01])
    turn = quaternion_of(Rotation.from_rotvec([0.0, 0.1, 0.0]) * scipy_rotation(TURN))
    refined = eyes.refine(start[None], turn[None], nothing, prior_about(PLACE, TURN, 0.02, 8.0))
    np.testing.assert_allclose(refined.information, np.zeros((1, 6, 6)))
    np.testing.assert_allclose(refined.translations[0], PLACE, atol=1e-4)
    assert angle_between(refined.rotations[0], TURN) < 0.001
    unmoved = eyes.refine(start[None], turn[None], nothing)
    np.testing.assert_allclose(unmoved.translations[0], start)


def test_the_information_is_least_where_the_image_tells_least() -> None:
    eyes = sight(("edges", "region"), appearance())
    refined = eyes.refine(PLACE[None], TURN[None], view_of(eyes, draw()))
    across, along = np.diag(refined.information[0])[:2], refined.information[0][2, 2]
    assert (across > 5.0 * along).all()
    np.testing.assert_allclose(refined.information[0], refined.information[0].T, rtol=1e-9)
    assert np.linalg.eigvalsh(refined.information[0]).min() > -1e-6


# --- What is not seen


def out_of_view() -> tuple[np.ndarray, np.ndarray]:
    return PLACE + np.array([50.0, 0.0, 0.0]), TURN


def compared(image: Image) -> tuple[np.ndarray, float]:
    """What a frame says of scattered poses, and of one out of view, half as likely as those."""
    eyes = sight(learned=appearance())
    view = view_of(eyes, image)
    places, turns = scattered(100, 0.05, 20.0)
    out, turn = out_of_view()
    half = np.arange(len(places)) % 2 == 1
    places[half], turns[half] = out, turn
    weighed = eyes.weigh(places, turns, view)
    said = eyes.log_likelihood_by(weighed, eyes.compare_unseen(weighed, view, 0.4))
    assert np.ptp(said[half]) == 0.0
    return said[~half], float(said[half][0])


def test_an_object_that_is_not_there_gains_nothing_by_being_out_of_view() -> None:
    """All that is believed to be in view is as likely as all that is out of it."""
    empty = draw(out_of_view()[0], TURN)
    seen, unseen = compared(empty)
    assert np.exp(0.4 * unseen) == pytest.approx(np.exp(0.4 * seen).mean(), rel=0.1)
    assert unseen < -1.0


def test_what_is_out_of_view_is_as_before_where_the_object_is_seen() -> None:
    seen, unseen = compared(draw(PLACE, TURN))
    assert seen[0] > 3.0
    assert unseen == 0.0
