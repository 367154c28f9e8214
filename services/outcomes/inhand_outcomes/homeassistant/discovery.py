"""What Home Assistant's MQTT discovery is sent for a shape: pure functions.

Home Assistant of 2024.11 and later takes one message for the whole device; earlier ones take one
for each entity. Ids depend on the device and on names of ours alone, never on a name that people
give in Home Assistant.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from inhand_outcomes.homeassistant.shape import GoalShape, ObjectShape, Shape
from inhand_outcomes.outcome import adds_up
from inhand_outcomes.rules import DAYS, TIMES

ONLINE, OFFLINE = "online", "offline"
ON, OFF, UNKNOWN = "ON", "OFF", "None"
PRESS = "PRESS"
FLOOR, FORGET, PAUSE = "floor", "forget_today", "pause"
GOAL_EVENTS = ("goal_reached", "goal_missed", "reminder")
EXPIRES_S = 180
"""Seconds after which a value that is refreshed each 30 s is taken as unknown."""
MIGRATE = {"migrate_discovery": True}

UNITS: Mapping[str, tuple[str | None, str | None]] = {
    "_ml": ("volume", "mL"),
    "_m2": (None, "m²"),
    "_count": (None, None),
    "_m_s": ("speed", "m/s"),
    "_deg_s": (None, "°/s"),
    "_per_s": (None, "1/s"),
    "_per_min": (None, "1/min"),
    "_s": ("duration", "s"),
    "_deg": (None, "°"),
    "_m": ("distance", "m"),
}
"""Device class and unit by the end of an amount's name; longer ends come first. (The class of areas
is not known to Home Assistant before 2025.1, which then refuses the whole entity.)"""

Json = dict[str, Any]


@dataclass(frozen=True)
class Entity:
    """One entity: its id within the device, its platform, and what is particular to it."""

    component: str
    platform: str
    config: Mapping[str, Any]


@dataclass(frozen=True)
class Topics:
    """The topics of a device."""

    node: str

    @property
    def status(self) -> str:
        """Whether the device is there: its last will."""
        return f"inhand/{self.node}/status"

    @property
    def commands(self) -> str:
        """All commands, as a filter."""
        return f"inhand/{self.node}/+/set"

    def state(self, component: str) -> str:
        """The value of an entity."""
        return f"inhand/{self.node}/{component}/state"

    def command(self, component: str) -> str:
        """What an entity is told."""
        return f"inhand/{self.node}/{component}/set"


def total_id(object_name: str, kind: str, amount: str) -> str:
    """Return the id of a total of the day."""
    return f"{object_name}-{kind}-{amount}"


def place_id(object_name: str) -> str:
    """Return the id of an object's last place."""
    return f"{object_name}-place"


def in_use_id(object_name: str) -> str:
    """Return the id of whether an object is in use."""
    return f"{object_name}-in_use"


def event_id(object_name: str) -> str:
    """Return the id of an object's events."""
    return f"{object_name}-event"


def goal_id(goal: str, what: str) -> str:
    """Return the id of ``progress``, ``reached`` or ``event`` of a goal: none of an object's is the
    same, since names have no dash."""
    return f"goal--{goal}-{what}"


def region_id(region: str, what: str) -> str:
    """Return the id of ``swept`` or ``missed`` of a part of the floor."""
    return f"region--{region}-{what}"


def entities(shape: Shape) -> list[Entity]:
    """Return all entities of a shape, by id."""
    topics = Topics(shape.node)
    found = [*_of_device(shape, topics)]
    for thing in shape.objects:
        found += _of_object(thing, topics)
    for goal in shape.goals:
        found += _of_goal(goal, topics)
    for region in shape.regions:
        found += _of_region(region, topics)
    return sorted(found, key=lambda entity: entity.component)


def announcement(
    shape: Shape, version: str, removed: Sequence[Entity] = ()
) -> list[tuple[str, bytes]]:
    """Return topics and payloads that announce a shape, to be retained.

    The message for a whole device says of those ``removed`` that they go.
    """
    topics, device = Topics(shape.node), _device(shape, version)
    origin = {"name": "inhand", "sw_version": version}
    common = {"availability_topic": topics.status}
    if shape.single_components:
        return [
            (
                single_topic(shape, entity),
                _json({**_config(entity, shape), "device": device, "origin": origin, **common}),
            )
            for entity in entities(shape)
        ]
    components: dict[str, Json] = {
        entity.component: {"platform": entity.platform, **_config(entity, shape)}
        for entity in entities(shape)
    }
    for entity in removed:
        components[entity.component] = {"platform": entity.platform}
    message = {"device": device, "origin": origin, **common, "components": components}
    return [(device_topic(shape), _json(message))]


def device_topic(shape: Shape) -> str:
    """Return where the message for a whole device goes."""
    return f"{shape.prefix}/device/{shape.node}/config"


def single_topic(shape: Shape, entity: Entity) -> str:
    """Return where the message for one entity goes."""
    return f"{shape.prefix}/{entity.platform}/{shape.node}/{entity.component}/config"


def config_topics(shape: Shape) -> set[str]:
    """Return all topics of a shape's announcement."""
    if not shape.single_components:
        return {device_topic(shape)}
    return {single_topic(shape, entity) for entity in entities(shape)}


def state_topics(shape: Shape) -> set[str]:
    """Return all topics on which values of a shape may be retained, but for whether it is there."""
    return {Topics(shape.node).state(entity.component) for entity in entities(shape)}


def removed_entities(old: Sequence[Shape], new: Shape) -> list[Entity]:
    """Return what was announced by messages for the device of ``new`` and is no more."""
    stay = {entity.component for entity in entities(new)}
    gone = {
        entity.component: entity
        for shape in old
        if config_topics(shape) == config_topics(new)
        for entity in entities(shape)
        if entity.component not in stay
    }
    return [gone[component] for component in sorted(gone)]


def unit_of(amount: str) -> tuple[str | None, str | None]:
    """Return the device class and the unit of an amount's name, each None where there is none."""
    if amount == DAYS:
        return None, "d"
    ends = (end for end in UNITS if amount.endswith(end))
    return UNITS.get(next(ends, ""), (None, None))


def _of_device(shape: Shape, topics: Topics) -> Iterator[Entity]:
    settled = {"entity_category": "config"}
    yield Entity(
        FORGET,
        "button",
        {
            "name": "Forget today",
            "icon": "mdi:delete-clock",
            "command_topic": topics.command(FORGET),
            "payload_press": PRESS,
            **settled,
        },
    )
    yield Entity(
        PAUSE,
        "switch",
        {
            "name": "Pause measuring",
            "icon": "mdi:pause-circle",
            "command_topic": topics.command(PAUSE),
            "state_topic": topics.state(PAUSE),
            **settled,
        },
    )
    if shape.floor:
        yield Entity(
            FLOOR,
            "image",
            {
                "name": "Swept floor",
                "image_topic": topics.state(FLOOR),
                "content_type": "image/png",
            },
        )


def _of_object(thing: ObjectShape, topics: Topics) -> Iterator[Entity]:
    for kind, amounts in thing.kinds:
        for amount in (TIMES, *amounts):
            component = total_id(thing.name, kind, amount)
            name = f"{thing.name} {kind} {TIMES if amount == TIMES else _without_unit(amount)}"
            yield Entity(component, "sensor", _total(name, amount, topics.state(component)))
    place, in_use, event = place_id(thing.name), in_use_id(thing.name), event_id(thing.name)
    yield Entity(
        place,
        "sensor",
        {
            "name": f"{_words(thing.name)} last place",
            "icon": "mdi:map-marker",
            "state_topic": topics.state(place),
            "value_template": "{{ value_json.value }}",
            "json_attributes_topic": topics.state(place),
            "json_attributes_template": "{{ value_json.attributes | tojson }}",
        },
    )
    yield Entity(
        in_use,
        "binary_sensor",
        {
            "name": f"{_words(thing.name)} in use",
            "icon": "mdi:hand-back-right",
            "state_topic": topics.state(in_use),
            "value_template": "{{ value_json.value }}",
            "expire_after": EXPIRES_S,
        },
    )
    yield Entity(
        event,
        "event",
        {
            "name": f"{_words(thing.name)} event",
            "icon": "mdi:gesture-tap",
            "state_topic": topics.state(event),
            "event_types": [kind for kind, _ in thing.kinds],
        },
    )


def _of_goal(goal: GoalShape, topics: Topics) -> Iterator[Entity]:
    progress, reached, event = (
        goal_id(goal.name, what) for what in ("progress", "reached", "event")
    )
    name = f"goal {goal.name}"
    yield Entity(
        progress,
        "sensor",
        {**_total(f"{name} progress", goal.amount, topics.state(progress)), "icon": "mdi:target"},
    )
    yield Entity(
        reached,
        "binary_sensor",
        {
            "name": _words(f"{name} reached"),
            "icon": "mdi:flag-checkered",
            "state_topic": topics.state(reached),
        },
    )
    yield Entity(
        event,
        "event",
        {
            "name": _words(f"{name} event"),
            "icon": "mdi:bell",
            "state_topic": topics.state(event),
            "event_types": list(GOAL_EVENTS),
        },
    )


def _of_region(region: str, topics: Topics) -> Iterator[Entity]:
    for what, unit in (("swept", "%"), ("missed", "m²")):
        component = region_id(region, what)
        yield Entity(
            component,
            "sensor",
            {
                "name": _words(f"{region} {what}"),
                "icon": "mdi:broom",
                "state_topic": topics.state(component),
                "value_template": "{{ value_json.value }}",
                "state_class": "measurement",
                "unit_of_measurement": unit,
                "suggested_display_precision": 0 if unit == "%" else 2,
            },
        )


def _total(name: str, amount: str, topic: str) -> Json:
    """A sensor of what is done since a time, which may go down when something is forgotten."""
    device_class, unit = unit_of(amount)
    config: Json = {
        "name": _words(name),
        "state_topic": topic,
        "value_template": "{{ value_json.value }}",
        "state_class": "total",
        "last_reset_value_template": "{{ value_json.last_reset }}",
        "json_attributes_topic": topic,
        "json_attributes_template": "{{ value_json.attributes | tojson }}",
    }
    if amount not in (TIMES, DAYS) and not adds_up(amount):  # the largest of a period, no sum
        del config["last_reset_value_template"]
        config["state_class"] = "measurement"
    else:
        config["suggested_display_precision"] = 1 if unit == "m²" else 0
    if device_class is not None:
        config["device_class"] = device_class
    else:
        config["icon"] = "mdi:counter" if unit is None else "mdi:texture-box"
    if unit is not None:
        config["unit_of_measurement"] = unit
    return config


def _config(entity: Entity, shape: Shape) -> Json:
    config = {"unique_id": f"{shape.node}-{entity.component}", **entity.config}
    slug = entity.config["name"].lower().replace(" ", "_")
    if shape.single_components:
        config["object_id"] = slug
    else:
        config["default_entity_id"] = f"{entity.platform}.{slug}"
    return config


def _device(shape: Shape, version: str) -> Json:
    return {
        "identifiers": [shape.node],
        "name": shape.label,
        "manufacturer": "Inhand",
        "model": "Outcomes",
        "sw_version": version,
    }


def _without_unit(amount: str) -> str:
    end = next((end for end in UNITS if amount.endswith(end) and end != "_count"), "")
    return amount.removesuffix(end)


def _words(name: str) -> str:
    text = name.replace("_", " ")
    return text[:1].upper() + text[1:]


def _json(message: Mapping[str, Any]) -> bytes:
    return json.dumps(message, ensure_ascii=False, separators=(",", ":"), sort_keys=True).encode()
