"""What ``inhand status`` says of instances that are well but behind."""

from examples import RUNNING
from inhand_runtime.health_lines import LATE_MS, MOST_KEYS, late_lines, left_unused
from inhand_runtime.roll import Heard
from inhand_schemas.messages import TopicHealth
from msgspec.structs import replace

KEY = "inhand/@v1/rig/rgbd/front"


Living = dict[tuple[str, str], Heard | None]


def living(topics: dict[str, TopicHealth], effort: float | None = None) -> Living:
    health = replace(RUNNING, topics=topics, effort=effort)
    return {("tracker", "mug"): Heard(health, 0.0), ("recorder", "disk"): None}


def said(late_ms: float | None, effort: float | None) -> list[str]:
    return late_lines(living({KEY: TopicHealth(received=1, late_ms=late_ms)}, effort))


def test_who_is_on_time_with_the_whole_effort_is_not_named() -> None:
    assert said(None, None) == said(0.5 * LATE_MS, 1.0) == []


def test_keys_that_come_late_and_trackers_that_do_less_are_named() -> None:
    assert said(250.4, 0.4) == [
        "tracker mug, rgbd/front: up to 250 ms after capture",
        "tracker mug: does 40 % of its usual work in a frame, to keep up with its camera",
    ]


def test_what_was_not_used_has_a_line_a_key_that_says_why() -> None:
    topics = {KEY: TopicHealth(received=9, dropped=2, malformed=1, lost=4)}
    assert left_unused(living(topics)) == [
        "tracker mug, rgbd/front: 2 came too late or too fast, 1 could not be read, 4 never came"
    ]


def test_of_a_flood_of_keys_those_with_the_most_are_named_and_the_others_counted() -> None:
    topics = {
        f"inhand/@v1/rig/event/k{number}": TopicHealth(received=1, malformed=number)
        for number in range(1, 1001)
    }
    lines = left_unused(living(topics))
    assert lines[0] == "tracker mug, event/k1000: 1000 could not be read"
    assert len(lines) == MOST_KEYS + 1
    rest = sum(range(1, 1001 - MOST_KEYS))
    assert lines[-1] == f"tracker mug, and 995 more keys: {rest} could not be read"


def test_of_a_flood_of_late_keys_the_latest_are_named_and_the_others_counted() -> None:
    topics = {
        f"inhand/@v1/rig/event/k{number}": TopicHealth(received=1, late_ms=1000.0 + number)
        for number in range(MOST_KEYS + 1)
    }
    lines = late_lines(living(topics))
    assert lines[0] == "tracker mug, event/k5: up to 1005 ms after capture"
    assert lines[-1] == "tracker mug, and 1 more key: up to 1000 ms after capture"
    assert len(lines) == MOST_KEYS + 1


def test_what_a_recorder_refuses_did_not_come_too_late() -> None:
    (line,) = left_unused(living({"(other keys)": TopicHealth(refused=7)}))
    assert line == "tracker mug, (other keys): 7 came on more keys than are recorded"
