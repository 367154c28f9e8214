"""Who of a rig lives, what each last said of itself, and what is wrong with that."""

import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import Health
from inhand_schemas.topics import LABEL

from inhand_runtime.daemon import HEALTH_PERIOD_S
from inhand_runtime.wording import printable

Instance = tuple[str, str]
"""A service's name and an instance's."""
SILENT_AFTER_S = 3.5
"""Seconds without a word after which an instance that lives is said to hang: it speaks each one."""
MOST_PROBLEMS_OF_ONE = 16


@dataclass(frozen=True)
class Heard:
    """An instance's last words, and when they came (monotonic seconds)."""

    health: Health
    at: float


class Roll:
    """Keeps who lives and what they last said; thread-safe."""

    def __init__(
        self, now: Callable[[], float] = time.monotonic, *, patience_s: float = 0.0
    ) -> None:
        """``patience_s`` is how long one that has just come may say nothing: whoever looks once
        has seen nobody come, and waits for all to speak."""
        self._now = now
        self._patience_s = patience_s
        self._lock = threading.Lock()
        self._living: dict[Instance, float] = {}
        self._heard: dict[Instance, Heard] = {}
        self._changed = now()

    def change(self, service: str, instance: str, lives: bool) -> None:
        """Take note of a liveliness token."""
        with self._lock:
            self._changed = self._now()
            if lives and (service, instance) not in self._living:
                self._living[service, instance] = self._changed
                self._heard.pop((service, instance), None)  # another process of that name said it
            elif lives:
                return
            else:
                self._living.pop((service, instance), None)

    def hear(self, health: Health) -> None:
        """Take note of a health message; of one that does not live it is forgotten."""
        instance = (health.service, health.instance)
        with self._lock:
            if instance in self._living:
                self._heard[instance] = Heard(health, self._now())

    def living(self) -> dict[Instance, Heard | None]:
        """The live instances by name, with None for one that said nothing yet."""
        with self._lock:
            return {instance: self._heard.get(instance) for instance in sorted(self._living)}

    def settled(self, expected: Iterable[Instance] = ()) -> bool:
        """Whether all expected live, all who live spoke, and nobody came or went of late."""
        living = self.living()
        quiet = self._now() - self._changed > 1.5 * HEALTH_PERIOD_S
        complete = bool(living) and living.keys() >= set(expected)
        return quiet and complete and all(self._speaks(heard) for heard in living.values())

    def silent(self) -> list[Instance]:
        """The instances that live and have not spoken for long."""
        return [one for one, heard in self.living().items() if self._is_silent(one, heard)]

    def troubles(self) -> list[str]:
        """What is wrong with those who live, a line each: who hangs, and what each says."""
        living = self.living()
        lines = []
        for instance, heard in living.items():
            who = " ".join(instance)
            if self._is_silent(instance, heard):
                lines.append(self._silence(who, heard))
            if heard is not None:
                texts = map(printable, heard.health.troubles[:MOST_PROBLEMS_OF_ONE])
                lines += [f"{who}: {text}" for text in texts]
        return lines + _published_twice(living)

    def _is_silent(self, instance: Instance, heard: Heard | None) -> bool:
        came = self._living.get(instance, self._now())
        return not self._speaks(heard) and self._now() - came >= self._patience_s

    def _speaks(self, heard: Heard | None) -> bool:
        return heard is not None and self._now() - heard.at < SILENT_AFTER_S

    def _silence(self, who: str, heard: Heard | None) -> str:
        if heard is None:
            return f"{who} hangs, or is stopped: it is there, and says nothing"
        return f"{who} hangs, or is stopped: it last spoke {self._now() - heard.at:.0f} s ago"


def _published_twice(living: dict[Instance, Heard | None]) -> list[str]:
    publishers: dict[str, list[str]] = {}
    for instance, heard in living.items():
        for key, topic in () if heard is None else heard.health.topics.items():
            if topic.published and topic.rate_hz > 0.0 and not _of_cameras(key):
                publishers.setdefault(key, []).append(" ".join(instance))
    return [
        f"{short_key(key)} is published by {' and by '.join(names)}: readers get all of them; stop "
        "one, or give it another name"
        for key, names in publishers.items()
        if len(names) > 1
    ]


def _of_cameras(key: str) -> bool:
    """Whether it is an object's labels, which each simulated camera of a rig has."""
    try:
        return parse_key(key).stream == LABEL.stream
    except KeyFormatError:
        return False


def short_key(key: str) -> str:
    """A key as ``stream/name``, for one rig's tables; a foreign key as it is."""
    try:
        parsed = parse_key(key)
    except KeyFormatError:
        return printable(key)
    return f"{parsed.stream}/{parsed.name}"
