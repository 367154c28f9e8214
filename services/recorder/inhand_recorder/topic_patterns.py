"""Which keys are recorded: patterns ``STREAM`` or ``STREAM/NAME``, in which ``*`` is any text."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from inhand_runtime.settings_errors import suggestion
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.topics import TOPICS, AnyTopic, topic_of

_NAME_PATTERN = re.compile(r"[a-z0-9_*]+")


@dataclass(frozen=True)
class Chosen:
    """The keys that one of ``included`` matches and none of ``excluded``."""

    included: tuple[str, ...]
    excluded: tuple[str, ...] = ()

    def holds(self, key: str) -> bool:
        """Whether a key is chosen; never one that is not Inhand's."""
        try:
            topic, parsed = topic_of(key)
        except KeyFormatError:
            return False
        return self.holds_name(topic.stream, parsed.name)

    def holds_name(self, stream: str, name: str) -> bool:
        """Whether a stream of a name is chosen."""
        return _matches(self.included, stream, name) and not _matches(self.excluded, stream, name)

    def subscriptions(self) -> Mapping[AnyTopic, tuple[str | None, ...]]:
        """The names of each topic to subscribe to, so that no key is heard twice; None is all."""
        chosen: dict[AnyTopic, tuple[str | None, ...]] = {}
        for stream, topic in TOPICS.items():
            names = _names(self.included, stream)
            if not names or "*" in _names(self.excluded, stream):
                continue
            exact = all("*" not in name for name in names)
            chosen[topic] = tuple(sorted(names)) if exact else (None,)
        return chosen


def checked_patterns(patterns: tuple[str, ...]) -> tuple[str, ...]:
    """Return the patterns; raises ValueError for one that can match nothing."""
    for pattern in patterns:
        stream, name = _parts(pattern)
        if not _NAME_PATTERN.fullmatch(stream) or not any(
            fnmatchcase(one, stream) for one in TOPICS
        ):
            raise ValueError(f"there is no stream {stream!r}" + suggestion(stream, TOPICS))
        checked_name(name)
    return patterns


def checked_name(pattern: str) -> str:
    """Return a pattern of names; raises ValueError for one that can match nothing."""
    if not _NAME_PATTERN.fullmatch(pattern):
        lower = re.sub(r"[^a-z0-9_*]+", "_", pattern.lower()) or "*"
        raise ValueError(
            f"no name is like {pattern!r}: names are of a-z, digits and underscore, and * is any "
            f"text (did you mean {lower}?)"
        )
    if len(pattern.replace("*", "")) > 64:
        raise ValueError(f"no name is as long as {pattern!r}: 64 letters at the most")
    return pattern


def _parts(pattern: str) -> tuple[str, str]:
    stream, slash, name = pattern.partition("/")
    return stream, name if slash else "*"


def _names(patterns: Sequence[str], stream: str) -> set[str]:
    """The patterns of names that a stream's keys are to match."""
    return {name for one, name in map(_parts, patterns) if fnmatchcase(stream, one)}


def _matches(patterns: Sequence[str], stream: str, name: str) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in _names(patterns, stream))
