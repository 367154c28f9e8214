"""The options of a replay."""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Annotated, Any, Literal

from inhand_runtime.settings import FilePath, Section
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name
from inhand_schemas.topics import LABEL, RGBD, SKELETONS
from pydantic import AfterValidator, BeforeValidator, Field, Strict

PLAYED_STREAMS = tuple(topic.stream for topic in (RGBD, SKELETONS, LABEL))
OBJECT = "object"


def _instant(value: Any) -> Any:
    """Take numbers, and times of ISO 8601, which are UTC where they do not say otherwise."""
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            value = _time(value)
    if isinstance(value, datetime):
        return value if value.tzinfo else value.replace(tzinfo=UTC)
    return value


def _time(text: str) -> datetime:
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        raise ValueError(
            f"{text!r} is neither seconds from the begin nor a time such as 2026-11-29T20:17:53Z"
        ) from None


Instant = Annotated[
    Annotated[float, Field(ge=0, allow_inf_nan=False)] | Annotated[datetime, Strict()],
    BeforeValidator(_instant),
]
"""Seconds from the begin of the recording, or a time."""


def _pattern(text: str) -> str:
    stream, slash, name = text.partition("/")
    if not slash or not name or "/" in name:
        raise ValueError(f"{text!r} is no STREAM/NAME, in which * stands for any letters")
    if stream == "info":
        raise ValueError("the camera's info is always played: nobody could use frames without it")
    if "*" not in stream and stream not in PLAYED_STREAMS:
        played = ", ".join(PLAYED_STREAMS)
        raise ValueError(f"a replay plays {played}, and not {stream!r}: see docs/playback.md")
    return text


Pattern = Annotated[str, AfterValidator(_pattern)]


def _renamed(remap: Mapping[str, str]) -> Mapping[str, str]:
    for old, new in remap.items():
        kind, slash, name = old.partition("/")
        if kind == "camera":
            raise ValueError(f"{old!r}: a camera has the name of its table, [capture.NAME]")
        if kind != OBJECT or not slash:
            raise ValueError(f"{old!r}: write {OBJECT}/NAME, the object's name in the recording")
        for one in (name, new):
            try:
                require_name("object", one)
            except KeyFormatError as error:
                raise ValueError(str(error)) from None
    if len(set(remap.values())) < len(remap):
        raise ValueError("two objects cannot get one name: their labels would be mixed")
    return remap


class ReplayOptions(Section):
    """``[capture.NAME.options]`` of a replay.

    Several files are one recording, in the order of their times. ``rate`` 2 plays twice as fast, 0
    as fast as possible; ``loop`` begins again at the end. ``camera`` chooses one of a recording of
    several. Played is what was captured from ``start`` until before ``until``; ``paused`` waits for
    whoever resumes it. ``times`` are the original ones, or those of now. ``include`` and
    ``exclude`` choose by the names in the recording, ``remap`` gives objects others.
    """

    file: FilePath | Annotated[tuple[FilePath, ...], Field(min_length=1)]
    rate: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 1.0
    loop: bool = False
    camera: str | None = None
    start: Instant = 0.0
    until: Instant | None = None
    paused: bool = False
    times: Literal["original", "now"] = "original"
    include: tuple[Pattern, ...] = ("*/*",)
    exclude: tuple[Pattern, ...] = ()
    remap: Annotated[dict[str, str], AfterValidator(_renamed)] = {}
