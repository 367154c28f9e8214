"""Sees that the calibration by which a daemon works is still the one in its file."""

import time
from collections.abc import Callable
from pathlib import Path

from inhand_runtime.errors import SettingsError
from inhand_runtime.health import HealthBoard
from inhand_runtime.settings_file import settings_data

LOOK_S = 2.0
"""Seconds between looks at the file."""


class CalibrationWatch:
    """Says in the health when a calibration file is another one than at the start, or gone: what
    was read then holds until the daemon starts anew. None is watched where none is named."""

    def __init__(
        self, path: Path | None, health: HealthBoard, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._path = path
        self._health = health
        self._now = now
        self._looked_at = now()
        self._first = None if path is None else _content(path)

    def look(self) -> None:
        """Compare, now and then."""
        if self._path is None or self._now() - self._looked_at < LOOK_S:
            return
        self._looked_at = self._now()
        content = _content(self._path)
        if content == self._first:
            self._health.well("calibration")
        elif content is None:
            self._health.trouble(
                "calibration",
                f"{self._path} cannot be read any more, and what it said at the start holds: put "
                "it back, or make it anew with `inhand calibrate`",
            )
        else:
            self._health.trouble(
                "calibration",
                f"{self._path} was written anew, and what it said at the start holds: "
                "`inhand reload` takes it over",
            )


def _content(path: Path) -> bytes | None:
    try:
        return settings_data(path)
    except SettingsError:
        return None
