"""The values of Home Assistant's entities, as the payloads of their topics: pure functions."""

import json
import math
from collections.abc import Mapping
from typing import Any

from inhand_outcomes.days import local_time
from inhand_outcomes.homeassistant.discovery import (
    FLOOR,
    OFF,
    ON,
    PAUSE,
    UNKNOWN,
    Topics,
    event_id,
    goal_id,
    in_use_id,
    place_id,
    region_id,
    total_id,
)
from inhand_outcomes.homeassistant.state import HomeEvent, HomeState, KindTotal
from inhand_outcomes.rules import TIMES
from inhand_outcomes.store.queries import LastPlace

DIGITS = 6
"""Number of digits of values: Home Assistant keeps each change."""


def retained_values(state: HomeState) -> dict[str, bytes]:
    """Return the payload of each topic that is retained."""
    topics = Topics(state.shape.node)
    values = {PAUSE: _switch(state.paused)}
    if state.shape.floor:
        values[FLOOR] = state.floor_png
    for thing in state.shape.objects:
        for kind, amounts in thing.kinds:
            total = state.totals.get((thing.name, kind), KindTotal())
            for amount in (TIMES, *amounts):
                values[total_id(thing.name, kind, amount)] = _total(state, total, amount)
        values[place_id(thing.name)] = _place(state, state.places.get(thing.name))
    for goal in state.shape.goals:
        progress = state.goals[goal.name]
        value = _number(progress.value)
        values[goal_id(goal.name, "progress")] = _value(
            value, {"wanted": progress.wanted}, last_reset=progress.since.isoformat()
        )
        values[goal_id(goal.name, "reached")] = _switch(progress.reached)
    for name in state.shape.regions:
        share = state.regions[name]
        values[region_id(name, "swept")] = _value(round(100.0 * share.share, 1))
        values[region_id(name, "missed")] = _value(round(share.missed_m2, 2))
    return {topics.state(component): payload for component, payload in values.items()}


def refreshed_values(state: HomeState) -> dict[str, bytes]:
    """Return the payload of each topic whose value expires unless it is sent again."""
    topics = Topics(state.shape.node)
    texts = {True: ON, False: OFF, None: UNKNOWN}
    return {
        topics.state(in_use_id(thing.name)): _value(texts[state.in_use.get(thing.name)])
        for thing in state.shape.objects
    }


def event_message(node: str, event: HomeEvent) -> tuple[str, bytes]:
    """Return topic and payload of an event, which is not retained."""
    component = (
        goal_id(event.goal, "event") if event.goal is not None else event_id(event.object or "")
    )
    numbers = {name: _number(value) for name, value in event.numbers.items()}
    said = {"event_type": event.kind, "time": event.time.isoformat(), **numbers}
    return Topics(node).state(component), _json(said)


def _total(state: HomeState, total: KindTotal, amount: str) -> bytes:
    since = state.since.isoformat()
    if amount == TIMES:
        return _value(total.times, {}, last_reset=since)
    found = total.amounts.get(amount)
    if found is None:
        return _value(0, {"deviation": 0}, last_reset=since)
    deviation = {"deviation": _number(math.sqrt(found.variance))}
    return _value(_number(found.sum), deviation, last_reset=since)


def _place(state: HomeState, place: LastPlace | None) -> bytes:
    """Where an object was, from the rig's first camera: x right, y down, z forward, metres."""
    if place is None:
        return _value(UNKNOWN, {})
    x, y, z = (round(number, 2) for number in place.rig_from_object.translation)
    side, height = "right" if x >= 0.0 else "left", "down" if y >= 0.0 else "up"
    depth = "ahead" if z >= 0.0 else "behind"
    text = f"{abs(z):.2f} m {depth}, {abs(x):.2f} m {side}, {abs(y):.2f} m {height}"
    time = local_time(place.time_ns, state.zone).isoformat(timespec="seconds")
    return _value(text, {"x_m": x, "y_m": y, "z_m": z, "time": time, "after": place.kind})


def _switch(on: bool) -> bytes:
    return (ON if on else OFF).encode()


def _value(
    value: Any, attributes: Mapping[str, Any] | None = None, *, last_reset: str | None = None
) -> bytes:
    said: dict[str, Any] = {"value": value}
    if attributes is not None:
        said["attributes"] = attributes
    if last_reset is not None:
        said["last_reset"] = last_reset
    return _json(said)


def _number(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _json(message: Mapping[str, Any]) -> bytes:
    return json.dumps(message, ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()
