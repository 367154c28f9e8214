"""The settings of a recorder, and what is checked of them before a start."""

from pathlib import Path
from typing import Annotated, Self

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.writable import try_folder
from inhand_schemas.topics import PREVIEW, TOPICS
from pydantic import AfterValidator, ByteSize, Field, model_validator

from inhand_recorder.topic_patterns import Chosen, checked_patterns

SMALLEST_SPLIT_BYTES = 1 << 20
SMALLEST_SPLIT_S = 1.0
SPLIT_S = 3600.0
"""Seconds after which a new file begins, unless the settings say otherwise."""


def _zero_or_a_mebibyte(size: ByteSize) -> ByteSize:
    if 0 < size < SMALLEST_SPLIT_BYTES:
        raise ValueError("a file must hold 1 MiB at least; 0 means never")
    return size


def _zero_or_a_second(seconds: float) -> float:
    if 0 < seconds < SMALLEST_SPLIT_S:
        raise ValueError("a file must last 1 s at least; 0 means never")
    return seconds


class RecorderSettings(Section):
    """``[recorder.NAME]``.

    A new file begins after ``split_bytes`` or ``split_seconds``; 0 means never. Without a word it
    is each hour, so that no file grows for ever, and what is copied or recovered is an hour at the
    most. What the disk cannot take at once waits in memory, ``queue_bytes`` at the most; then the
    oldest is dropped and counted. Without a word all ``streams`` are recorded but previews, which
    are made only while somebody listens, and show less than the frames do. ``streams`` and
    ``exclude`` are patterns ``STREAM`` or ``STREAM/NAME``, in which ``*`` is any text. With
    ``start_paused`` it records nothing until it is asked to resume.
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

    @property
    def chosen(self) -> Chosen:
        """The keys that are recorded."""
        return Chosen(self.streams, self.exclude)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if not self.chosen.subscriptions():
            raise ValueError("exclude leaves out all that streams names: nothing would be recorded")
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
