"""What is said of goals is kept until it is published, and said once over restarts."""

from datetime import time
from pathlib import Path

from inhand_outcomes.achievement import Amount
from inhand_outcomes.rules import Goal, PersonsGoal, Rules
from inhand_outcomes.store.goal_marks import events_to_publish, judge_goals, mark_published
from kept_outcomes import ZURICH, S, at, new_saver, sip

GOALS = [
    Goal(name="drink", kind="pour", amount="volume_ml", at_least=100, remind_at=(time(15),)),
    Goal(name="tilt", kind="pour", amount="angle_deg", at_least=60),
    Goal(name="lift", kind="repetition", amount="days", at_least=1, per="week"),
]
RULES = Rules([PersonsGoal(goal, None) for goal in GOALS], ZURICH)


def test_each_event_is_raised_once_over_restarts_and_waits_until_it_is_published(
    tmp_path: Path,
) -> None:
    saver = new_saver(tmp_path)
    saver.save([sip(at("2026-05-08 14:00"), ml=40.0, kind="pour")])  # a Friday
    steep = {"volume_ml": Amount(30.0, 4.0), "angle_deg": Amount(61.0, 3.0)}
    raised = []
    for text in ("05-08 14:30", "05-08 15:00", "05-08 16:00", "05-09 00:05", "05-11 00:05"):
        database = new_saver(tmp_path).database  # as after a restart
        raised.append(judge_goals(database, RULES, at(f"2026-{text}")))
        assert judge_goals(database, RULES, at(f"2026-{text}") + S) == 0
        if text == "05-08 15:00":
            saver.save([sip(at("2026-05-08 15:30"), amounts=steep, kind="pour")])
        database.close()
    events = events_to_publish(saver.database)
    shown = [(event.kind, event.description, event.amounts) for event in events]
    assert shown[:3] == [
        ("reminder", "drink", {"volume_ml": 40.0}),
        ("goal_reached", "tilt", {"angle_deg": 61.0}),  # the largest of 50 and 61: no sum
        ("goal_missed", "drink", {"volume_ml": 70.0}),
    ]
    # At the end of Sunday, of which nobody had looked at the day before.
    assert sorted(shown[3:], key=lambda one: one[1]) == [
        ("goal_missed", "drink", {"volume_ml": 0.0}),
        ("goal_missed", "lift", {"days": 0.0}),
        ("goal_missed", "tilt", {"angle_deg": 0.0}),
    ]
    assert raised == [0, 1, 1, 1, 3]
    mark_published(saver.database, events[:4])
    assert [one.id for one in events_to_publish(saver.database)] == [one.id for one in events[4:]]
    mark_published(saver.database, events[4:])
    assert events_to_publish(saver.database) == []


def test_no_goals_cost_nothing(tmp_path: Path) -> None:
    database = new_saver(tmp_path).database
    assert judge_goals(database, Rules([], ZURICH), at("2026-05-08 14:00")) == 0
