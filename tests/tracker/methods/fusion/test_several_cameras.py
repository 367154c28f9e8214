"""One object in the images of several cameras: what each adds, and when."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.image import Image, OtherView, ViewPull
from inhand_tracker.geometry.placement import HERE, Placement
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from inhand_tracker.methods.fusion.search import ImageSearch, SideLook
from inhand_tracker.methods.fusion.tracker import FusionTracker
from people import FRAME_NS, held, quaternion_of, unseen_wave, wave_model
from scipy.spatial.transform import Rotation
from sights import CAMERA as BOX_CAMERA
from sights import PLACE, TURN, appearance, draw, sight
from wedges import FRAMES, images

SPHERE = BoundingSphere(np.zeros(3), 0.15)
OFF = np.array([0.02, 0.01, 0.06])
"""Metres by which the box is believed elsewhere than it is."""
FAR_AWAY = np.full((20, 3), 9.0)
UNSURE = np.diag([0.02**2] * 3 + [0.01**2] * 3)
NOTHING = Image(None, BOX_CAMERA)


def aside(degrees: float, middle: np.ndarray) -> Placement:
    """view_from_reference of a camera that looks at a place from so far aside."""
    turn = Rotation.from_euler("y", degrees, degrees=True)
    return Placement(middle - turn.apply(middle), quaternion_of(turn))


def shown(place: Placement, source: str) -> Image:
    """The box, of which no depth is measured, as a camera elsewhere sees it."""
    return replace(draw(*place.poses(PLACE, TURN), returns_depth=False), source=source)


def off(first: Image, others: Sequence[SideLook], seeds: Sequence[int] = range(4)) -> np.ndarray:
    """How far off, in metres, the box is by several searches, (S, 3)."""
    part = PoseGaussian(PLACE + OFF, TURN, np.diag([0.05**2] * 3 + [0.1**2] * 3))
    belief = PoseMixture((part,), np.ones(1))
    eyes = sight(learned=appearance(returns_depth=False))
    poses = [
        ImageSearch(eyes, SPHERE, DEFAULT_FUSION, seed).look(
            belief, first, FAR_AWAY, 1.0, 1.0, others
        )
        for seed in seeds
    ]
    return np.array([pose.centre - PLACE for pose in poses])


FRONT = shown(HERE, "front")
LEFT = SideLook(shown(aside(75.0, PLACE), "left"), aside(75.0, PLACE), 1.0)


def test_two_cameras_without_depth_err_by_less_than_each_of_them() -> None:
    front, left, both = off(FRONT, []), off(NOTHING, [LEFT]), off(FRONT, [LEFT])
    errors = [np.linalg.norm(one, axis=1).mean() for one in (front, left, both)]
    assert errors[2] < 0.6 * min(errors[:2])


def test_another_cameras_image_is_enough_where_the_first_has_none() -> None:
    across = off(NOTHING, [LEFT]) @ np.array([0.0, 1.0, 0.0])
    assert np.abs(across).mean() < 0.3 * OFF[1]


def test_what_lies_is_not_lost_as_a_body_goes_away_from_it() -> None:
    near, far = (np.diag([deviation**2] * 3 + [0.1**2] * 3) for deviation in (0.02, 0.1))
    places = (PLACE + np.array([0.03, 0.0, 0.0]), PLACE + np.array([0.0, 0.3, 0.4]), PLACE)
    parts = tuple(map(PoseGaussian, places, [TURN] * 3, (near, far, near)))
    belief = PoseMixture(parts, np.array([1e-4, 1.0 - 1.1e-4, 1e-5]), carried=(0, 2))
    for seed in range(4):
        eyes = sight(learned=appearance(returns_depth=False))
        search = ImageSearch(eyes, SPHERE, DEFAULT_FUSION, seed)
        found = search.look(belief, FRONT, FAR_AWAY, 1.0, 1.0, [LEFT])
        assert np.linalg.norm(found.centre - PLACE) < 0.01


def test_several_cameras_outweigh_a_body_however_sure_it_is() -> None:
    """The body is sure that the box is 60 cm away from where it was believed to be."""
    wide, sure = (np.diag([deviation**2] * 3 + [0.1**2] * 3) for deviation in (0.04, 0.03))
    body = PoseGaussian(PLACE + np.array([0.0, 0.4, 0.45]), TURN, sure)
    carried = PoseGaussian(PLACE + np.array([0.01, 0.01, 0.02]), TURN, wide)
    belief = PoseMixture((body, carried), np.array([1.0, 1e-60]), carried=(1,))
    for seed in range(3):
        eyes = sight(learned=appearance(returns_depth=False))
        search = ImageSearch(eyes, SPHERE, DEFAULT_FUSION, seed)
        found = search.look(belief, FRONT, FAR_AWAY, 1.0, 1.0, [LEFT])
        assert np.linalg.norm(found.centre - PLACE) < 0.01
        assert search.tried is not None
        first = search.tried.centres[: DEFAULT_FUSION.hypotheses]
        near = np.linalg.norm(first - PLACE, axis=1) < 0.2
        assert near.mean() == pytest.approx(DEFAULT_FUSION.carried_tried_share, abs=0.01)


def test_each_camera_has_colours_of_its_own() -> None:
    eyes = sight(learned=appearance(returns_depth=False))
    search = ImageSearch(eyes, SPHERE, DEFAULT_FUSION, 1)
    belief = PoseMixture((PoseGaussian(PLACE, TURN, np.eye(6) * 1e-4),), np.ones(1))
    green = replace(LEFT.image, colour=LEFT.image.colour[..., [1, 0, 2]])
    for _ in range(3 * DEFAULT_FUSION.looks_to_learn):
        search.look(belief, FRONT, FAR_AWAY, 1.0, 1.0, [replace(LEFT, image=green, sharpness=0.1)])
    front, left = (search._eyes[name].colours.of_object for name in ("front", "left"))
    assert np.abs(front - eyes.start().of_object).sum() < np.abs(left - front).sum()


def test_a_camera_that_sees_nothing_of_the_object_adds_nothing() -> None:
    away = Placement(np.zeros(3), quaternion_of(Rotation.from_euler("y", np.pi)))
    beside = OtherView(replace(images()[0], source="away"), away)
    for others in ((), (beside,)):
        one, given = FusionTracker(wave_model(), seed=1), []
        for frame, joints in enumerate(unseen_wave(FRAMES)[:10]):
            image = replace(images()[frame], others=others)
            given.append(one.step(joints, (frame + 1) * FRAME_NS, image))
        if not others:
            alone = given
    for first, second in zip(alone, given, strict=True):
        np.testing.assert_array_equal(first.translation, second.translation)
        np.testing.assert_array_equal(first.covariance, second.covariance)


def looked_at(
    later_s: float, monkeypatch: pytest.MonkeyPatch, body: np.ndarray | None = None
) -> list[SideLook]:
    """How another camera's images, captured at another time, are looked at while a wedge is waved,
    or a ``body``'s joints (T, 20, 3) go."""
    seen: list[SideLook] = []
    looked = ImageSearch.look

    def look(search: ImageSearch, *given: object, thoroughly: bool) -> object:
        seen.append(given[5][0])
        return looked(search, *given, thoroughly=thoroughly)

    one = FusionTracker(wave_model(), seed=1)
    place = aside(70.0, np.array([0.0, 0.0, 2.5]))
    with monkeypatch.context() as patched:
        patched.setattr(ImageSearch, "look", look)
        for frame, joints in enumerate(unseen_wave(FRAMES) if body is None else body):
            blank = replace(images()[frame], source="aside", colour=None, depth=None)
            others = (OtherView(blank, place, later_s),)
            image = replace(images()[frame], others=others)
            one.step(joints, (frame + 1) * FRAME_NS, image)
    return seen


@pytest.mark.parametrize("frames", [-1, 1])
def test_what_was_captured_at_another_time_is_looked_at_where_the_object_was_then(
    frames: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = aside(70.0, np.array([0.0, 0.0, 2.5]))
    where, _ = held(unseen_wave(FRAMES), seed=7)
    seen = looked_at(frames * FRAME_NS / 1e9, monkeypatch)
    now = np.arange(2, FRAMES - 1)
    then = place.points(where[now + frames])
    aware = [seen[n].view_from_reference.points(where[n]) for n in now]
    unaware = place.points(where[now])
    off_aware, off_unaware = (np.linalg.norm(one - then, axis=1) for one in (aware, unaware))
    assert off_aware.mean() < 0.5 * off_unaware.mean()
    at_once = looked_at(0.0, monkeypatch)
    sharper = [one.sharpness > other.sharpness for one, other in zip(at_once, seen, strict=True)]
    assert np.mean(sharper[2:]) > 0.9


def test_what_was_captured_at_another_time_is_not_looked_at_where_a_body_leaps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No object goes as a body does that is put 60 cm aside within a frame."""
    leaps = unseen_wave(10)
    leaps[6:] += np.array([0.6, 0.0, 0.0])
    place = aside(70.0, np.array([0.0, 0.0, 2.5]))
    seen = looked_at(0.5 * FRAME_NS / 1e9, monkeypatch, leaps)[6]
    there = held(unseen_wave(10), seed=7)[0][5]
    moved = seen.view_from_reference.points(there) - place.points(there)
    assert np.linalg.norm(moved) < 0.05
    assert seen.sharpness > 0.5


def pulls_by(*others: SideLook) -> list[ViewPull]:
    """What the first camera's image and others say of the box where they were looked at long
    enough."""
    told: list[ViewPull] = []
    first = replace(FRONT, on_pulls=told.extend)
    belief = PoseMixture((PoseGaussian(PLACE, TURN, np.eye(6) * 1e-4),), np.ones(1))
    search = ImageSearch(sight(learned=appearance(returns_depth=False)), SPHERE, DEFAULT_FUSION, 1)
    for _ in range(DEFAULT_FUSION.looks_to_place):
        search.look(belief, first, FAR_AWAY, 1.0, 1.0, others)
    return told


def test_each_image_says_where_it_alone_has_the_object() -> None:
    """The cameras look from aside of each other, and the left one is 2 cm lower than it is said to
    be: it has the box 2 cm lower beside the first one."""
    place = LEFT.view_from_reference
    higher = Placement(place.translation + np.array([0.0, -0.02, 0.0]), place.rotation)
    front, left = pulls_by(replace(LEFT, view_from_reference=higher, place_covariance=UNSURE))
    assert (front.camera, left.camera) == ("front", "left")
    assert left.deviation[1] - front.deviation[1] == pytest.approx(0.02, abs=0.003)
    for one in (front, left):
        assert one.information[1, 1] > 1.0 / 0.02**2
        np.testing.assert_allclose(one.information, one.information.T, rtol=1e-3, atol=1.0)


def test_an_image_that_does_not_show_the_object_says_nothing_of_where_it_is() -> None:
    nothing = np.full_like(LEFT.image.colour, 90)
    pulls = pulls_by(replace(LEFT, image=replace(LEFT.image, colour=nothing)))
    assert [one.camera for one in pulls] == ["front"]
