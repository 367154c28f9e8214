"""What a window tells of a body's last moments: wherever it stands, and at any frame rate."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_schemas.joints import Joint
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.window import (
    REMEMBERED,
    UPPER_BODY,
    VIEWS,
    BodyWindow,
    PlaceMemory,
    continues,
    earlier_frames,
    remember_places,
    trunk_places,
)
from people import FRAME_NS, STANDING, STANDING_HEIGHT, move, waving
from scipy.spatial.transform import Rotation

small = st.floats(-3.0, 3.0)
LAGS = len(DEFAULT_BODY.lags_s)
UPPER = len(UPPER_BODY)
HAND_RIGHT = Joint.HAND_RIGHT
GAP_NS = DEFAULT_BODY.gap_ns


def described(joints: np.ndarray, step_ns: int = FRAME_NS) -> list[list[np.ndarray]]:
    window = BodyWindow()
    return [window.add(one, (n + 1) * step_ns, STANDING_HEIGHT) for n, one in enumerate(joints)]


def parts(views: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (20, 3) and ways (L, 20, 3) of the whole body, and memories (M, 5, 3)."""
    whole = views[0].reshape(1 + LAGS, 20, 3)
    memories = views[2].reshape(-1)[(1 + LAGS) * UPPER * 3 :]
    return whole[0], whole[1:], memories.reshape(len(DEFAULT_BODY.memories_s), len(REMEMBERED), 3)


def moving_hand(times: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Joints (T, 20, 3) of somebody who stands still but for the right hand."""
    joints = np.repeat(STANDING[None], len(times), axis=0)
    joints[:, HAND_RIGHT] += times[:, None] * speed
    return joints


@given(st.tuples(small, small, small), st.tuples(small, small, small))
def test_it_does_not_matter_where_a_person_stands(
    turn: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    joints = waving(15)
    moved = move(Rotation.from_rotvec(turn), np.array(shift), joints)
    for here, there in zip(described(joints), described(moved), strict=True):
        assert len(here) == VIEWS
        for one, other in zip(here, there, strict=True):
            assert one.dtype == np.float32
            np.testing.assert_allclose(other, one, atol=2e-6)


def test_places_are_from_the_trunk_s_middle_in_heights() -> None:
    """Left, up, forwards of somebody who faces the camera: +x, -y, -z."""
    (views,) = described(STANDING[None])
    seen, ways, memories = parts(views)
    middle = 0.5 * (STANDING[0] + STANDING[2])
    expected = (STANDING - middle) * [1.0, -1.0, -1.0] / STANDING_HEIGHT
    np.testing.assert_allclose(seen, expected, atol=0.01)
    np.testing.assert_array_equal(ways, 0.0)
    np.testing.assert_allclose(memories, np.repeat(seen[None, REMEMBERED], 2, axis=0), atol=1e-6)
    np.testing.assert_array_equal(views[1].reshape(-1, UPPER, 3)[0], seen[UPPER_BODY])


@pytest.mark.parametrize(("rate", "lags"), [(30.0, (4, 10)), (15.0, (2, 5)), (60.0, (8, 20))])
def test_ways_are_those_of_the_lags_at_any_frame_rate(rate: float, lags: tuple[int, int]) -> None:
    """0.13 s and 0.33 s, to the nearest frame; a hand that goes up by 0.6 m/s."""
    step_ns = round(1e9 / rate)
    times = np.arange(round(1.5 * rate)) / rate
    views = described(moving_hand(times, np.array([0.0, -0.6, 0.0])), step_ns)
    _, ways, _ = parts(views[-1])
    for way, lag in zip(ways, lags, strict=True):
        up = 0.5 * 0.6 * lag / rate / STANDING_HEIGHT
        np.testing.assert_allclose(way[HAND_RIGHT], [0.0, up, 0.0], atol=1e-3)
        np.testing.assert_allclose(np.delete(way, HAND_RIGHT, axis=0), 0.0, atol=1e-9)


@pytest.mark.parametrize("rate", [15.0, 30.0])
def test_recorded_frames_find_the_same_lags_as_live_ones(rate: float) -> None:
    joints = waving(40)
    views = described(joints, round(1e9 / rate))
    rows = earlier_frames(np.arange(40), rate)
    for frame in range(25, 40):
        _, ways, _ = parts(views[frame])
        for lag, way in zip(rows[frame], ways, strict=True):
            length = np.linalg.norm(joints[frame] - joints[lag], axis=1)
            np.testing.assert_allclose(
                np.linalg.norm(way, axis=1), 0.5 * length / STANDING_HEIGHT, atol=1e-6
            )


def test_frames_that_are_missing_are_stood_for_by_the_one_before() -> None:
    rows = earlier_frames(np.array([0, 1, 2, 8, 9, 30]), 30.0)
    np.testing.assert_array_equal(rows, [[0, 0], [0, 0], [0, 0], [2, 0], [2, 0], [4, 4]])


def test_at_first_a_memory_is_the_mean_of_all_that_was() -> None:
    """While less than its time constant has passed; the first frame counts as one step."""
    memory, random = PlaceMemory(), np.random.default_rng(0)
    seen = random.normal(size=(25, 20, 3))
    for count, place in enumerate(seen, start=1):
        means = memory.add(place, 1.0 / 30.0)
        expected = seen[:count, REMEMBERED].mean(axis=0)
        np.testing.assert_allclose(means[0], expected)
        np.testing.assert_allclose(means[1], expected)


@pytest.mark.parametrize("rate", [15.0, 30.0])
def test_memories_fade_by_their_time_constants(rate: float) -> None:
    """After long rest a hand moves away: of the old place exp(-t/τ) is left, whatever the rate."""
    memory, step = PlaceMemory(), 1.0 / rate
    there, away = np.zeros((20, 3)), np.ones((20, 3))
    for _ in range(round(30.0 * rate)):
        memory.add(there, step)
    for _ in range(round(2.0 * rate)):
        means = memory.add(away, step)
    for mean, constant in zip(means, (1.0, 3.0), strict=True):
        np.testing.assert_allclose(1.0 - mean, np.exp(-2.0 / constant), atol=1e-9)


def test_a_recording_s_memories_are_those_of_frames_as_they_come() -> None:
    joints = waving(50)
    seen = trunk_places(joints, STANDING_HEIGHT)
    together = remember_places(seen, np.arange(50) / 30.0, 1.0 / 30.0)
    for views, memories in zip(described(joints), together, strict=True):
        np.testing.assert_allclose(parts(views)[2], memories, atol=1e-5)


@pytest.mark.parametrize("later_ns", [GAP_NS + 1, 10**12, 0, -1, -(10**12)])
def test_after_a_gap_or_a_jump_of_the_clock_nothing_before_counts(later_ns: int) -> None:
    joints = waving(21)
    window = BodyWindow()
    for number, one in enumerate(joints[:20]):
        window.add(one, (number + 1) * FRAME_NS, STANDING_HEIGHT)
    after = window.add(joints[20], 20 * FRAME_NS + later_ns, STANDING_HEIGHT)
    first = BodyWindow().add(joints[20], 5, STANDING_HEIGHT)
    for one, other in zip(after, first, strict=True):
        np.testing.assert_array_equal(one, other)


def test_half_a_second_is_no_gap() -> None:
    window = BodyWindow()
    window.add(STANDING, FRAME_NS, STANDING_HEIGHT)
    (later,) = moving_hand(np.ones(1), np.array([0.0, -0.6, 0.0]))
    _, ways, memories = parts(window.add(later, FRAME_NS + GAP_NS, STANDING_HEIGHT))
    assert memories[0, 3, 1] < parts(described(later[None])[0])[2][0, 3, 1]
    assert np.isfinite(ways).all()


@pytest.mark.parametrize(
    ("later_ns", "expected"),
    [(1, True), (GAP_NS, True), (GAP_NS + 1, False), (0, False), (-1, False)],
)
def test_a_frame_continues_the_one_before_when_the_clock_went_on_without_a_gap(
    later_ns: int, expected: bool
) -> None:
    assert continues(10**9, 10**9 + later_ns) is expected
