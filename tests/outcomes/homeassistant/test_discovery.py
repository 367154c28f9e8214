"""What is announced: ids, topics and classes, and what goes with an object."""

import json
import re

import pytest
from home_states import SHAPE, STATE, replace_shape, without
from inhand_outcomes.homeassistant.discovery import (
    announcement,
    config_topics,
    entities,
    removed_entities,
    state_topics,
    unit_of,
)
from inhand_outcomes.homeassistant.shape import GoalShape, object_shape
from inhand_outcomes.homeassistant.values import refreshed_values, retained_values

SINGLE = replace_shape(SHAPE, single_components=True)


def components(shape=SHAPE):
    ((_, payload),) = announcement(shape, "1.0")
    return json.loads(payload)["components"]


@pytest.mark.parametrize(
    ("amount", "device_class", "unit"),
    [
        ("volume_ml", "volume", "mL"),
        ("duration_s", "duration", "s"),
        ("area_m2", None, "m²"),
        ("stroke_count", None, None),
        ("times", None, None),
        ("speed_m_s", "speed", "m/s"),
        ("angle_deg", None, "°"),
        ("days", None, "d"),
    ],
)
def test_an_amount_has_the_unit_of_its_name(
    amount: str, device_class: str | None, unit: str | None
) -> None:
    assert unit_of(amount) == (device_class, unit)


def test_totals_may_go_down_and_begin_anew_and_the_largest_is_no_total() -> None:
    goals = (GoalShape("drink", "volume_ml"), GoalShape("fast", "speed_m_s"))
    said = components(replace_shape(SHAPE, goals=goals))
    for name in ("mug-sip-times", "mug-sip-volume_ml", "goal--drink-progress"):
        assert said[name]["state_class"] == "total"
        assert said[name]["last_reset_value_template"] == "{{ value_json.last_reset }}"
    assert said["goal--fast-progress"]["state_class"] == "measurement"
    assert "last_reset_value_template" not in said["goal--fast-progress"]


def test_ids_and_topics_are_of_characters_that_home_assistant_takes_and_differ() -> None:
    things = tuple(
        object_shape(name, "drinking", (), None) for name in ("a", "a_sip", "goal", "forget_today")
    )
    shape = replace_shape(SINGLE, objects=things, goals=(GoalShape("a", "times"),))
    ids = [json.loads(payload)["unique_id"] for _, payload in announcement(shape, "1.0")]
    assert len(set(ids)) == len(ids) == len(entities(shape)) == len(config_topics(shape))
    for topic in config_topics(shape):
        assert re.fullmatch(r"homeassistant(/[a-z_]+)(/[a-zA-Z0-9_-]+){2}/config", topic)


def test_ids_stay_whatever_else_there_is_and_in_either_form() -> None:
    both = {one["unique_id"] for one in components().values()}
    assert both == {json.loads(payload)["unique_id"] for _, payload in announcement(SINGLE, "1.0")}
    fewer = {one["unique_id"] for one in components(without(STATE, "broom").shape).values()}
    assert fewer < both


def test_every_topic_of_a_value_is_announced_and_every_sensor_has_a_value() -> None:
    values = {**retained_values(STATE), **refreshed_values(STATE)}
    announced = {
        one.get("state_topic", one.get("image_topic"))
        for one in components().values()
        if one["platform"] not in ("event", "button")
    }
    assert values.keys() == announced
    assert values.keys() <= state_topics(SHAPE)


def test_values_are_json_with_their_attributes() -> None:
    values = {topic.split("/")[2]: one for topic, one in retained_values(STATE).items()}
    since = "2026-11-30T00:00:00+01:00"
    volume = {"value": 210.457, "attributes": {"deviation": 12.0}, "last_reset": since}
    assert json.loads(values["mug-sip-volume_ml"]) == volume
    assert json.loads(values["broom-sweeping-area_m2"])["value"] == 0
    place = json.loads(values["mug-place"])
    assert place["value"] == "1.90 m ahead, 0.40 m right, 0.20 m down"
    assert place["attributes"]["x_m"] == 0.4
    assert json.loads(values["broom-place"])["value"] == "None"
    assert values["goal--drink-reached"] == b"OFF"
    assert json.loads(values["region--under_the_table-swept"]) == {"value": 75.0}
    assert json.loads(values["region--under_the_table-missed"]) == {"value": 0.25}


def test_a_removed_object_is_what_the_message_for_the_device_removes() -> None:
    left = without(STATE, "mug").shape
    removed = removed_entities((SHAPE,), left)
    assert {entity.component.split("-")[0] for entity in removed} == {"mug"}
    assert not removed_entities((SINGLE,), left)  # they had topics of their own
    ((_, payload),) = announcement(left, "1.0", removed)
    assert json.loads(payload)["components"]["mug-event"] == {"platform": "event"}


def test_older_home_assistants_get_the_entities_names_in_their_way() -> None:
    sip = components()["mug-sip-volume_ml"]
    assert sip["default_entity_id"] == "sensor.mug_sip_volume"
    single = {topic: json.loads(payload) for topic, payload in announcement(SINGLE, "1.0")}
    old = single[f"homeassistant/sensor/{SHAPE.node}/mug-sip-volume_ml/config"]
    assert (old["object_id"], "default_entity_id" in old) == ("mug_sip_volume", False)
    assert old["availability_topic"] == f"inhand/{SHAPE.node}/status"
