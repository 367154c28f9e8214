"""Stages fill their time, and what moves through keys is where it should be."""

from itertools import pairwise

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.timeline import (
    Key,
    Move,
    Pause,
    Plan,
    Stage,
    flow,
    minimum_jerk,
    move_through,
    schedule,
    track,
)
from inhand_lab.people.person import sample_person

TIMES = np.linspace(0.0, 4.0, 81)


def test_a_schedule_fills_its_time_and_repeats_the_use() -> None:
    person, random = sample_person(0, 0), np.random.default_rng(0)
    opening, closing = (Pause("wait", 0.5), Move("reach", 1.0)), (Move("leave", 1.0),)
    plan = Plan(opening, (Move("do", 1.0), Pause("hold", 0.5)), closing)
    stages = schedule(person, random, 30.0, plan)
    assert stages[0].start == 0.0
    assert stages[-1].end == pytest.approx(30.0)
    assert all(a.end == b.start for a, b in pairwise(stages))
    assert sum(stage.name == "do" for stage in stages) > 10


def test_minimum_jerk_starts_and_ends_at_rest() -> None:
    progress = minimum_jerk(np.linspace(-0.5, 1.5, 2001))
    assert progress[0] == 0.0
    assert progress[-1] == 1.0
    assert np.abs(np.diff(progress, 2)).max() < 1e-5
    assert np.diff(progress).min() >= 0.0


def test_a_stage_is_cut_at_shares_of_its_time() -> None:
    stage = Stage("reach", 0, 1.0, 3.0)
    assert stage.seconds == 2.0
    assert (stage.at(0.0), stage.at(0.25), stage.at(1.0)) == (1.0, 1.5, 3.0)
    assert stage.part(0.25, 0.5) == Stage("reach", 0, 1.5, 2.0)


def test_a_track_keeps_each_value_until_the_next_move() -> None:
    keys = [(0.5, 2.0), (1.0, 2.0), (2.0, -1.0), (3.0, -1.0)]
    values = track(TIMES, keys)
    assert values[TIMES <= 1.0] == pytest.approx(2.0)
    assert values[TIMES == 1.5] == pytest.approx(0.5)
    assert values[TIMES >= 2.0] == pytest.approx(-1.0)
    columns = track(TIMES, [(time, (value, 3.0 * value)) for time, value in keys])
    np.testing.assert_allclose(columns, np.outer(values, [1.0, 3.0]))


def test_a_flow_passes_its_knots_and_does_not_overshoot() -> None:
    values = flow(TIMES, [(1.0, (0.0,)), (2.0, (1.0,)), (3.0, (1.5,))])[:, 0]
    assert values[[0, 20, 40, 60, 80]] == pytest.approx([0.0, 0.0, 1.0, 1.5, 1.5])
    assert np.diff(values).min() >= 0.0


def test_a_way_swings_out_by_its_bow_and_bends_towards_a_pose_between() -> None:
    here, there, between = (
        Transform(np.array(place), np.eye(3)).repeated(len(TIMES))
        for place in ([0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0])
    )
    keys = [Key(1.0, here), Key(3.0, there, bow=(0.0, 0.0, 0.5))]
    bowed = move_through(TIMES, keys).translation
    assert bowed[[0, 40, 80]] == pytest.approx(np.array([[0, 0, 0], [1, 0, 0.5], [2, 0, 0]]))
    bent = move_through(TIMES, [Key(1.0, here), Key(3.0, there, by=between)]).translation
    assert bent[40] == pytest.approx([1.0, 0.5, 0.0])
