"""The settings of a recorder, and what is checked of them before a start."""

from pathlib import Path
from typing import Annotated, Literal, Self

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.writable import try_folder
from inhand_schemas.topics import EVENT, PREVIEW, TOPICS
from pydantic import AfterValidator, ByteSize, Field, model_validator

from inhand_recorder.quotas import FILES_WITHIN, SMALLEST_FILE_BYTES, Quotas, WhenFull
from inhand_recorder.topic_patterns import Chosen, checked_name, checked_patterns

SMALLEST_SPLIT_BYTES = 1 << 20
SMALLEST_SPLIT_S = 1.0
SPLIT_S = 3600.0
"""Seconds after which a new file begins, unless the settings say otherwise."""


def _zero_or_a_mebibyte(size: ByteSize) -> ByteSize:
    if 0 < size < SMALLEST_SPLIT_BYTES:
        raise ValueError("a file must hold 1 MiB at least; 0 means never")
    return size


def _zero_or_some_files(size: ByteSize) -> ByteSize:
    if 0 < size < (least := FILES_WITHIN * SMALLEST_FILE_BYTES):
        raise ValueError(f"{least >> 20} MiB must be kept at least; 0 means all")
    return size


def _zero_or_a_second(seconds: float) -> float:
    if 0 < seconds < SMALLEST_SPLIT_S:
        raise ValueError("a file must last 1 s at least; 0 means never")
    return seconds


def _checked_names(patterns: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(map(checked_name, patterns))


class RecorderSettings(Section):
    """``[recorder.NAME]``.

    A new file begins after ``split_bytes`` or ``split_seconds``; 0 means never. Without a word it
    is each hour, so that no file grows for ever, and what is copied or recovered is an hour at the
    most. What the disk cannot take at once waits in memory, ``queue_bytes`` at the most; then the
    oldest is dropped and counted. Without a word all ``streams`` are recorded but previews, which
    are made only while somebody listens, and show less than the frames do. ``streams`` and
    ``exclude`` are patterns ``STREAM`` or ``STREAM/NAME``, in which ``*`` is any text. With
    ``start_paused`` it records nothing until it is asked to resume.

    The oldest recordings are deleted while all take more than ``keep_bytes``, and those older than
    ``keep_days``; 0 is no bound. Where fewer than ``free_bytes`` of the disk are free,
    ``when_full`` says whether recording stops until there is room or the oldest are deleted.

    The last ``ring_seconds`` are held in memory, in ``ring_bytes`` at the most; 0 seconds is none.
    A snapshot, or an event whose name or kind one of ``ring_events`` matches, makes a clip of them
    and of the ``after_seconds``.

    ``colour`` says whether colour is recorded as it is published, or as H.264, which PyAV codes
    (the extra ``h264``); clips have it as it is published.
    """

    folder: FilePath = Field(default=Path("recordings"), validate_default=True)
    streams: Annotated[tuple[str, ...], Field(min_length=1), AfterValidator(checked_patterns)] = (
        tuple(stream for stream in TOPICS if stream != PREVIEW.stream)
    )
    exclude: Annotated[tuple[str, ...], AfterValidator(checked_patterns)] = ()
    split_bytes: Annotated[ByteSize, Field(ge=0), AfterValidator(_zero_or_a_mebibyte)] = ByteSize(0)
    split_seconds: Annotated[
        float, Field(ge=0, allow_inf_nan=False), AfterValidator(_zero_or_a_second)
    ] = SPLIT_S
    queue_bytes: Annotated[ByteSize, Field(ge=1 << 20)] = ByteSize(256 << 20)
    start_paused: bool = False
    keep_bytes: Annotated[ByteSize, Field(ge=0), AfterValidator(_zero_or_some_files)] = ByteSize(0)
    keep_days: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 0.0
    free_bytes: Annotated[ByteSize, Field(ge=0)] = ByteSize(0)
    when_full: WhenFull = "stop"
    ring_seconds: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 0.0
    ring_bytes: Annotated[ByteSize, Field(ge=1 << 20)] = ByteSize(256 << 20)
    after_seconds: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 5.0
    ring_events: Annotated[tuple[str, ...], AfterValidator(_checked_names)] = ()
    colour: Literal["published", "h264"] = "published"

    @property
    def chosen(self) -> Chosen:
        """The keys that are recorded."""
        return Chosen(self.streams, self.exclude)

    @property
    def quotas(self) -> Quotas:
        """How much is kept."""
        return Quotas(self.keep_bytes, self.keep_days, self.free_bytes, self.when_full)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if not self.chosen.subscriptions():
            raise ValueError("exclude leaves out all that streams names: nothing would be recorded")
        if self.when_full == "delete-oldest" and not self.free_bytes:
            raise ValueError(
                'when_full = "delete-oldest" needs free_bytes, how much of the disk stays free'
            )
        if self.ring_events and not self.ring_seconds:
            raise ValueError("ring_events needs ring_seconds, how many seconds before are kept")
        if self.ring_events and EVENT not in self.chosen.subscriptions():
            raise ValueError("ring_events needs the stream event, which is not recorded")
        return self


def check(settings: Settings[RecorderSettings]) -> None:
    """Check all that can be known before a start; raises SettingsError."""
    folder = settings.service.folder
    try:
        try_folder(folder)
    except OSError as error:
        raise SettingsError(
            f"cannot write to the folder {folder}: {error.strerror}: change folder in the "
            "recorder's settings"
        ) from None
