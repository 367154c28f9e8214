"""Particles over actions, held to sums that are written out (Darby et al. 2012, section 4)."""

import numpy as np
import pytest
from inhand_tracker.body.skeleton import PARTS
from inhand_tracker.recognition.darby2012.action_particles import (
    ActionParticles,
    TrainingPoses,
    corrections,
    draw_particles,
    likeliest_actions,
    move_particles,
    rank_chances,
)
from inhand_tracker.recognition.darby2012.parameters import DEFAULT_DARBY2012
from scipy.stats import norm

STAYS = DEFAULT_DARBY2012.stays
NEIGHBOUR_SIGMA = DEFAULT_DARBY2012.neighbour_sigma


def actions(count: int = 3, frames: int = 40) -> list[TrainingPoses]:
    random = np.random.default_rng(0)
    return [
        TrainingPoses(random.normal(size=(frames, 60)).astype(np.float32)) for _ in range(count)
    ]


def particles(numbers: list[int], parts: list[int], frames: list[int]) -> ActionParticles:
    weights = np.arange(1.0, 1.0 + len(numbers))
    return ActionParticles(
        np.array(numbers), np.array(parts), np.array(frames), weights / weights.sum()
    )


def test_neighbours_come_in_the_order_of_their_distances() -> None:
    known = actions(1)[0]
    asked = np.random.default_rng(1).normal(size=(5, 60))
    order = np.argsort(np.linalg.norm(asked[:, None] - known.poses, axis=2), axis=1)
    for rank in (0, 3, 39):
        found = known.neighbours(asked, np.full(5, rank))
        np.testing.assert_array_equal(found, order[:, rank])
        np.testing.assert_array_equal(known.ranks(asked[:1], int(order[0, rank])), [rank])
    np.testing.assert_array_equal(known.neighbours(asked, np.full(5, 99)), order[:, -1])


def test_rank_chances_are_those_of_rounded_normal_numbers() -> None:
    ranks = np.arange(200)
    chances = rank_chances(ranks)
    assert chances.sum() == pytest.approx(1.0)
    assert chances[0] == pytest.approx(2.0 * (norm.cdf(0.5 / NEIGHBOUR_SIGMA) - 0.5))
    drawn_ranks = np.rint(np.abs(np.random.default_rng(0).normal(0, NEIGHBOUR_SIGMA, 200_000)))
    np.testing.assert_allclose(
        np.bincount(drawn_ranks.astype(int), minlength=200) / 200_000, chances, atol=0.003
    )


def test_the_likeliest_actions_hold_half_of_the_mass_and_no_more_than_needed() -> None:
    np.testing.assert_allclose(
        likeliest_actions(np.array([0.1, 0.3, 0.35, 0.25])), [0, 6 / 13, 7 / 13, 0]
    )
    np.testing.assert_allclose(likeliest_actions(np.array([0.2, 0.8])), [0, 1])
    np.testing.assert_allclose(likeliest_actions(np.array([0.5, 0.5])), [1, 0])


def test_action_particles_change_rarely_and_keep_their_part_unless_they_do() -> None:
    known = actions()
    before = ActionParticles(np.ones(1, int), np.full(1, 4), np.full(1, 7), np.ones(1))
    after = move_particles(before, 50_000, known, np.random.default_rng(0))
    stayed = after.actions == 1
    assert stayed.mean() == pytest.approx(STAYS, abs=0.001)
    assert (after.parts[stayed] == 4).all()
    assert len(set(after.parts[~stayed].tolist())) == len(PARTS)
    ranks = np.array([known[1].ranks(known[1].poses[7:8], int(f))[0] for f in after.frames[:3000]])
    inner = ranks[stayed[:3000]]
    assert (inner == 0).mean() == pytest.approx(rank_chances(np.array([0]))[0], abs=0.02)


def test_the_correction_is_f_over_g_as_the_equation_says() -> None:
    known = actions()
    before = particles([0, 0, 1, 2], [3, 5, 3, 3], [1, 2, 3, 4])
    shares = np.array([0.75, 0.25, 0.0])
    pose = np.random.default_rng(5).normal(size=60)
    importance = draw_particles(200, shares, pose, known, np.random.default_rng(2))
    found = corrections(importance, shares, before, known)
    changed = (1.0 - STAYS) / 2
    for index in range(200):
        action, part = int(importance.actions[index]), int(importance.parts[index])
        frame = int(importance.frames[index])
        f = 0.0
        for i in range(4):
            start = known[before.actions[i]].poses[before.frames[i]].astype(float)
            away = np.linalg.norm(known[action].poses - start, axis=1)
            chance = rank_chances(np.array([(away < away[frame]).sum()]))[0]
            if before.actions[i] == action:
                f += before.weights[i] * STAYS * chance * (before.parts[i] == part)
            else:
                f += before.weights[i] * changed * chance / len(PARTS)
        g = shares[action] / len(PARTS)
        assert found[index] == pytest.approx(f / g, rel=1e-6)
