"""The choice of surfaces against trying everything."""

import itertools

import numpy as np
import pytest
from inhand_capture.estimation.kernels.depth_choice import (
    choose_limb,
    depths_at_length,
    middle_depth,
)

COSTS = np.array([0.12, 0.2, 0.15, 4.0, 5.0])


def _cost(child, parent, turn, length, before):  # type: ignore[no-untyped-def]
    parts = [
        (child[2] - parent[2] - turn) / COSTS[0],
        (np.linalg.norm(child - parent) - length) / (COSTS[1] * length),
        (child[2] - before[2]) / COSTS[2],
    ]
    return sum(min(part**2, COSTS[3]) for part in parts if np.isfinite(part))


@pytest.mark.parametrize("seed", range(8))
def test_a_limb_takes_the_cheapest_of_all_combinations(seed: int) -> None:
    random = np.random.default_rng(seed)
    candidates = 2.0 + random.normal(0.0, 0.4, (20, 4))
    counts = random.integers(0, 4, 20)
    rays = random.normal(0.0, 0.15, (20, 2))
    relative = random.normal(0.0, 0.1, 20)
    lengths = np.full(20, 0.3)
    before = np.where(random.random((20, 1)) < 0.5, np.nan, random.normal(2.0, 0.2, (20, 3)))
    chain, first = np.array([4, 5, 6, 7]), np.array([0.1, 0.1, 2.0])
    places, states = choose_limb(
        chain, first, candidates, counts, rays, relative, lengths, before, COSTS
    )

    def options(joint, parent, turn):  # type: ignore[no-untyped-def]
        hidden = [*depths_at_length(rays[joint], parent, lengths[joint]), parent[2] + turn]
        seen = [(depth, 2) for depth in candidates[joint, : counts[joint]]]
        return seen + [(depth, 1) for depth in hidden]

    best = (np.inf, None, None)
    for picks in itertools.product(range(7), repeat=3):
        parent, cost, trial, marks = first, 0.0, [], []
        for before_joint, joint, pick in zip(chain[:-1], chain[1:], picks, strict=True):
            turn = relative[joint] - relative[before_joint]
            there = options(joint, parent, turn)
            if pick >= len(there):
                break
            depth, mark = there[pick]
            place = np.array([*(rays[joint] * depth), depth])
            cost += _cost(place, parent, turn, lengths[joint], before[joint])
            cost += COSTS[4] if mark == 1 else 0.0
            parent = place
            trial.append(place)
            marks.append(mark)
        if len(trial) == 3 and cost < best[0]:
            best = (cost, trial, marks)
    np.testing.assert_allclose(places, best[1])
    assert states.tolist() == best[2]


def test_a_limb_s_end_lies_at_its_length_from_the_other_end() -> None:
    end, direction = np.array([0.1, -0.2, 2.0]), np.array([0.1, 0.0])
    for depth in depths_at_length(direction, end, 0.5):
        place = np.array([*(direction * depth), depth])
        assert np.linalg.norm(place - end) == pytest.approx(0.5)
    near, far = depths_at_length(direction, end, 0.05)
    assert near == far == pytest.approx((direction @ end[:2] + 2.0) / 1.01)


def test_the_middle_lies_where_most_joints_agree_and_nowhere_without_depth() -> None:
    relative = np.array([0.0, 0.1, -0.2, 0.0])
    candidates = np.array([[2.5, 3.5], [2.6, 3.5], [2.3, 3.5], [3.5, 0.0]])
    counts = np.array([2, 2, 2, 1])
    middle = middle_depth(candidates, np.full((4, 2), 0.5), counts, relative, np.ones(4), 0.1)
    assert middle == pytest.approx(2.5, abs=0.01)
    nothing = np.zeros(4, np.int64)
    assert np.isnan(middle_depth(candidates, np.ones((4, 2)), nothing, relative, np.ones(4), 0.1))
