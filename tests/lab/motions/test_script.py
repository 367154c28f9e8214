"""A script's stages bring poses and values from one to the next."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.parameters import DEFAULT_VARIETY
from inhand_lab.motions.script import Script, To, write_script
from inhand_lab.motions.timeline import Move, Pause, Plan, Stage
from inhand_lab.people.person import PEOPLE, People, sample_person

STAGES = [
    Stage("wait", 0, 0.0, 1.0),
    Stage("lift", 0, 1.0, 2.0),
    Stage("use", 0, 2.0, 3.0),
    Stage("use", 1, 3.0, 4.0),
    Stage("return", 1, 4.0, 6.0),
]
TIMES = np.linspace(0.0, 7.0, 141)
SCRIPT = Script(
    sample_person(0, 0),
    TIMES,
    np.random.default_rng(0),
    STAGES,
    TIMES,
    np.random.default_rng(1),
)
PLAN = Plan(
    (Pause("wait", 0.4), Move("lift", 1.0)),
    (Move("use", 0.8, swift=True), Pause("look", 0.3)),
    (Move("put", 0.8),),
)


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


def scripts(people: People, seeds: range, plan: Plan = PLAN) -> list[Script]:
    person = sample_person(0, 0, people)
    alike = replace(person, manner=sample_person(0, 0).manner)
    return [write_script(alike, TIMES, np.random.default_rng(seed), plan) for seed in seeds]


def test_tables_and_things_stand_less_alike_for_varied_people() -> None:
    spreads = []
    for people in PEOPLE:
        (script,) = scripts(people, range(1))
        heights = [script.table_top(0.5) for _ in range(200)]
        places = [script.place(0.1, 0.4) for _ in range(200)]
        spreads.append([np.std(heights), *np.std(places, axis=0)])
    assert np.divide(spreads[1], spreads[0]) == pytest.approx(
        [DEFAULT_VARIETY.heights, DEFAULT_VARIETY.places, DEFAULT_VARIETY.places]
    )


def test_who_is_not_interrupted_moves_as_people_do_who_never_are() -> None:
    usual, varied = (scripts(people, range(30)) for people in PEOPLE)
    assert all(script.times is TIMES for script in usual)
    free = [script.stages[-1].end == pytest.approx(TIMES[-1]) for script in varied]
    assert 5 < sum(free) < 30
    for one, other, freely in zip(usual, varied, free, strict=True):
        if freely:
            assert one.stages == other.stages


def test_some_give_up_put_the_thing_back_and_swing_nothing() -> None:
    given_up = [
        script
        for script in scripts("varied", range(80))
        if script.times.max() < script.stage("use").at(1.0)
    ]
    assert 2 < len(given_up) < 25
    for script in given_up:
        assert script.times[-1] < script.stage("lift").start + 1.0
        assert script.times.max() < script.stage("use").start


def test_some_sit_who_do_what_can_be_done_on_a_stool() -> None:
    low = -DEFAULT_VARIETY.seat_drop * sample_person(0, 0).height
    on_stool = replace(PLAN, on_stool=True)
    seated = [script for script in scripts("varied", range(40), on_stool) if script.seated]
    assert 5 < len(seated) < 20
    assert not any(script.seated for script in scripts("varied", range(40)))
    assert not any(script.seated for script in scripts("usual", range(40), on_stool))
    script = seated[0]
    upright = replace(script, seated=False)
    still = np.zeros((len(TIMES), 3))
    bodies = []
    for one in (script, upright):
        again = replace(one, random=np.random.default_rng(0))
        top = again.table_top(0.5)
        posture, trunk = again.stand(again.upright_stance(still, still))
        bodies.append((top, trunk.world_from_pelvis.translation, posture.world_from_right_foot))
    (lower, sitting, feet), (higher, standing, soles) = bodies
    assert lower - higher == pytest.approx(low)
    assert sitting[:, :2] == pytest.approx(standing[:, :2])
    assert sitting[:, 2] - standing[:, 2] == pytest.approx(low, abs=0.01)
    assert feet.translation[:, 2] == pytest.approx(soles.translation[:, 2])
    (seat, *_) = script.seat
    assert upright.seat == ()
    assert seat.centre[2] + 0.5 * seat.size[2] < sitting[:, 2].min()
