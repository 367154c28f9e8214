"""A script's stages bring poses and values from one to the next."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.script import Script, To
from inhand_lab.motions.timeline import Stage
from inhand_lab.people.person import sample_person

STAGES = [
    Stage("wait", 0, 0.0, 1.0),
    Stage("lift", 0, 1.0, 2.0),
    Stage("use", 0, 2.0, 3.0),
    Stage("use", 1, 3.0, 4.0),
    Stage("return", 1, 4.0, 6.0),
]
TIMES = np.linspace(0.0, 7.0, 141)
SCRIPT = Script(sample_person(0, 0), TIMES, np.random.default_rng(0), STAGES)


def at_height(height: float) -> Transform:
    return SCRIPT.still(Transform(np.array([0.0, 0.0, height]), np.eye(3)))


def heights(moving: Transform, *times: float) -> list[float]:
    return [float(np.interp(time, TIMES, moving.translation[:, 2])) for time in times]


def test_stages_are_found_by_name_in_order_of_time() -> None:
    assert SCRIPT.stage("use") is STAGES[2]
    assert SCRIPT.every("return", "use") == STAGES[2:]


def test_a_way_leads_from_stage_to_stage_and_stays_between() -> None:
    way = SCRIPT.way(at_height(0.0), {"lift": To(at_height(1.0)), "return": To(at_height(0.2))})
    assert heights(way, 0.5, 1.5, 2.0, 4.0, 5.0, 6.5) == pytest.approx([0, 0.5, 1, 1, 0.6, 0.2])


def test_a_way_takes_its_part_of_a_stage_and_more_than_one_goal() -> None:
    up, down = To(at_height(1.0), part=(0.0, 0.5)), To(at_height(0.0), part=(0.5, 1.0))
    way = SCRIPT.way(at_height(0.0), {"return": (up, down)})
    assert heights(way, 4.0, 4.5, 5.0, 5.5, 6.0) == pytest.approx([0.0, 0.5, 1.0, 0.5, 0.0])


def test_a_goal_is_made_for_each_stage_in_turn_or_left_out() -> None:
    made = []

    def goal(stage: Stage) -> Transform | None:
        made.append(stage.repetition)
        return at_height(1.0) if stage.repetition == 1 else None

    way = SCRIPT.way(at_height(0.0), {"use": To(goal)})
    assert made == [0, 1]
    assert heights(way, 3.0, 3.5, 4.0) == pytest.approx([0.0, 0.5, 1.0])


def test_a_level_changes_in_its_part_of_a_stage() -> None:
    goals = {"lift": 1.0, "use": lambda stage: 2.0 + stage.repetition}
    level = SCRIPT.level(0.0, goals, parts={"lift": (0.5, 1.0)})
    values = np.interp([1.0, 1.5, 1.75, 2.0, 3.0, 4.0, 7.0], TIMES, level)
    assert values == pytest.approx([0.0, 0.0, 0.5, 1.0, 2.0, 3.0, 3.0])


def test_a_share_around_a_stage_rises_before_and_falls_after_it() -> None:
    share = SCRIPT.around(STAGES[2], before=0.5, after=1.0)
    values = np.interp([1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0], TIMES, share)
    assert values == pytest.approx([0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0])
