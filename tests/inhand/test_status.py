"""What ``inhand status`` says of instances that are well but behind."""

from inhand_schemas.messages import Health, TopicHealth

from inhand.instances import Heard
from inhand.status import LATE_MS, late_lines

KEY = "inhand/@v1/rig/rgbd/front"


def said(late_ms: float | None, effort: float | None) -> list[str]:
    health = Health(
        sequence=0,
        time_ns=1,
        service="tracker",
        instance="mug",
        state="running",
        uptime_s=1.0,
        resident_bytes=1,
        topics={KEY: TopicHealth(received=1, late_ms=late_ms)},
        effort=effort,
    )
    return late_lines({("tracker", "mug"): Heard(health, 0.0, 1), ("recorder", "disk"): None})


def test_who_is_on_time_with_the_whole_effort_is_not_named() -> None:
    assert said(None, None) == said(0.5 * LATE_MS, 1.0) == []


def test_keys_that_come_late_and_trackers_that_do_less_are_named() -> None:
    assert said(250.4, 0.4) == [
        "tracker mug, rgbd/front: up to 250 ms after capture",
        "tracker mug: does 40 % of its usual work in a frame, to keep up with its camera",
    ]
