"""The texts of the live page as HTML, in which whatever a rig says is only text."""

import time
from collections.abc import Sequence

from inhand_runtime.health_lines import (
    deleted_recordings,
    late_lines,
    left_unused,
    shown_state,
    stilled_instances,
    unused_counts,
)
from inhand_runtime.roll import Heard, Instance, Roll
from inhand_schemas.messages import ObjectPose
from inhand_schemas.procedures import ObjectHypotheses

from inhand_studio.live_page.conditions import age_text
from inhand_studio.live_page.parameters import LiveParameters
from inhand_studio.texts import lines_html, table_html


def objects_html(objects: Sequence[ObjectPose], parameters: LiveParameters) -> str:
    """Write the state, confidence and age of objects' newest poses."""
    if not objects:
        return ""
    now_ns = time.time_ns()
    rows = [
        (
            named(pose),
            pose.state,
            f"{pose.confidence:.2f}",
            age_text(pose, now_ns, parameters),
        )
        for pose in objects
    ]
    return table_html(("object", "state", "confidence", "age"), rows)


def processes_html(roll: Roll) -> str:
    """Write how the rig's processes do: rates, losses and troubles."""
    living = roll.living()
    rows = [_row(instance, heard) for instance, heard in living.items()]
    table = table_html(("process", "state", "ms", "msg/s", "MB", "unused"), rows)
    notes = [
        *stilled_instances(living),
        *deleted_recordings(living),
        *left_unused(living),
        *late_lines(living),
    ]
    return table + lines_html(roll.troubles(), "wrong") + lines_html(notes, "note")


def shown_html(shown_hz: float, pictures_hz: float) -> str:
    """Write how many pictures come and are shown a second."""
    return lines_html([f"{shown_hz:.0f} of {pictures_hz:.0f} pictures a second are shown."], "note")


def named(thing: ObjectPose | ObjectHypotheses) -> str:
    """Name an object, and whose it is where that is known."""
    return thing.object if thing.person is None else f"{thing.object} of person {thing.person}"


def _row(instance: Instance, heard: Heard | None) -> tuple[str, ...]:
    if heard is None:
        return " ".join(instance), "silent", "", "", "", ""
    health = heard.health
    latency = health.latency_ms
    return (
        " ".join(instance),
        shown_state(health),
        "" if latency is None else f"{latency.p50:.0f} / {latency.p99:.0f}",
        f"{sum(topic.rate_hz for topic in health.topics.values()):.0f}",
        f"{health.resident_bytes / 1e6:.0f}",
        str(sum(unused_counts(health).values())),
    )
