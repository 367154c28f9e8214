"""Lines on instances that are well, but behind, or shut on purpose."""

from collections.abc import Mapping, Sequence

from inhand_schemas.messages import Health, TopicHealth

from inhand_runtime.roll import Heard, Instance, short_key
from inhand_runtime.wording import counted

MOST_KEYS = 5
"""Number of keys of an instance, at the most, that have a line each of one kind."""
LATE_MS = 100.0
"""Milliseconds after its capture from which on a message is said to come late."""


def unused_counts(health: Health) -> dict[str, int]:
    """How many messages of each key came and were not used, or never came."""
    return {
        key: topic.dropped + topic.refused + topic.malformed + topic.lost
        for key, topic in health.topics.items()
        if topic.dropped or topic.refused or topic.malformed or topic.lost
    }


def stilled_instances(living: dict[Instance, Heard | None]) -> list[str]:
    """One line for each camera whose shutter is closed, and each recorder and outcomes that are
    paused."""
    lines = []
    for (service, name), heard in living.items():
        if heard is None:
            continue
        if heard.health.shutter_closed:
            lines.append(
                f"{service} {name}: the shutter is closed: no pictures and no skeletons until "
                f"`inhand shutter open --camera {name}`"
            )
        if heard.health.recording and heard.health.recording.paused:
            lines.append(
                f"{service} {name}: paused: nothing is recorded until `inhand recorder resume "
                f"--name {name}`"
            )
        if heard.health.paused:
            lines.append(
                f"{service} {name}: paused: nothing is measured until `inhand outcomes resume "
                f"--name {name}`, or the switch in Home Assistant is off"
            )
    return lines


def deleted_recordings(living: dict[Instance, Heard | None]) -> list[str]:
    """One line for each recorder whose quotas have deleted recordings since it started."""
    return [
        f"{' '.join(instance)}: its quotas have deleted "
        f"{counted(heard.health.recording.deleted, 'recording')} since it started"
        for instance, heard in living.items()
        if heard is not None and heard.health.recording and heard.health.recording.deleted
    ]


def shown_state(health: Health) -> str:
    """The state of an instance in a word: what somebody wants of it goes before how it is."""
    if health.shutter_closed:
        return "shut"
    paused = health.paused or (health.recording is not None and health.recording.paused)
    return "paused" if paused else health.state


def late_lines(living: dict[Instance, Heard | None]) -> list[str]:
    """Return a line for each key that came late to an instance, and for each that cannot keep up;
    of many keys a line for the latest, and one for all others."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, health = " ".join(instance), heard.health
        late_ms = {
            key: topic.late_ms
            for key, topic in health.topics.items()
            if topic.late_ms is not None and topic.late_ms >= LATE_MS
        }
        latest, others = _first(late_ms)
        lines += [
            f"{who}, {short_key(key)}: up to {late_ms[key]:.0f} ms after capture" for key in latest
        ]
        if others:
            longest_ms = max(late_ms[key] for key in others)
            lines.append(
                f"{who}, and {counted(len(others), 'more key')}: up to {longest_ms:.0f} ms after "
                "capture"
            )
        if health.effort is not None and health.effort < 1.0:
            lines.append(
                f"{who}: does {100.0 * health.effort:.0f} % of its usual work in a frame, to keep "
                "up with its camera"
            )
    return lines


def left_unused(living: dict[Instance, Heard | None]) -> list[str]:
    """Return a line for each key that an instance did not use every message of, and why; of many
    keys a line for those with the most, and one for all others."""
    lines = []
    for instance, heard in living.items():
        if heard is None:
            continue
        who, topics, unused = " ".join(instance), heard.health.topics, unused_counts(heard.health)
        most, others = _first(unused)
        lines += [f"{who}, {short_key(key)}: {_reasons([topics[key]])}" for key in most]
        if others:
            reasons = _reasons([topics[key] for key in others])
            lines.append(f"{who}, and {counted(len(others), 'more key')}: {reasons}")
    return lines


def _reasons(topics: Sequence[TopicHealth]) -> str:
    """Why messages of these keys were not used, and how many for each reason."""
    counts = (
        (sum(topic.dropped - topic.unwritten for topic in topics), "came too late or too fast"),
        (sum(topic.unwritten for topic in topics), "could not be written to the disk"),
        (sum(topic.refused for topic in topics), "came on more keys than are recorded"),
        (sum(topic.malformed for topic in topics), "could not be read"),
        (sum(topic.lost for topic in topics), "never came"),
    )
    return ", ".join(f"{count} {reason}" for count, reason in counts if count)


def _first(amounts: Mapping[str, float]) -> tuple[list[str], list[str]]:
    """The keys with the greatest amounts, and all others."""
    ordered = sorted(amounts, key=amounts.__getitem__, reverse=True)
    return ordered[:MOST_KEYS], ordered[MOST_KEYS:]
