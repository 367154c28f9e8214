"""What capture says of its source in the health: lost, back after a gap, and in what condition."""

import logging
import time
from collections.abc import Callable, Mapping
from typing import Any

from inhand_runtime.health import HealthBoard
from inhand_runtime.source import Source, SourceError, control_playback, control_source
from inhand_schemas.playback import PlaybackReply, PlaybackRequest

log = logging.getLogger(__name__)

LOOK_S = 1.0
"""Seconds between questions to a source about its condition."""


class WatchedSource:
    """Notes how one source is, across its losses."""

    def __init__(
        self, name: str, health: HealthBoard, now: Callable[[], float] = time.monotonic
    ) -> None:
        self._name = name
        self._health = health
        self._now = now
        self._lost_at: float | None = None
        self._source: Source | None = None
        self._looked_at = float("-inf")
        self._troubles: Mapping[str, str] = {}

    def opened(self, source: Source) -> None:
        """Note that the source is open, be it again."""
        self._source = source

    def lost(self, error: SourceError) -> None:
        """Note a loss, or an attempt to open the source again that failed."""
        self._source = None
        self._show({})
        if self._lost_at is None:
            self._lost_at = self._now()
        self._health.state = "running"
        self._health.trouble("source", f"source {self._name}: {error}")

    def captured(self) -> None:
        """Note that a moment came."""
        self._health.state = "running"
        if self._lost_at is not None:
            gap_s = self._now() - self._lost_at
            log.warning("source %s is back; nothing was captured for %.1f s", self._name, gap_s)
            self._lost_at = None
        self._health.well("source")

    def shut(self) -> None:
        """Note that nothing is captured on purpose, which is no trouble."""
        self._source = None
        self._lost_at = None
        self._show({})
        self._health.well("source")
        self._health.state = "running"

    def control(self, options: Mapping[str, Any]) -> None:
        """Change options of the source, from any thread; raises SourceError."""
        if (source := self._source) is None:
            raise SourceError("it is not open now: try again when it is back")
        control_source(source, options)

    def playback(self, request: PlaybackRequest, camera: str) -> PlaybackReply:
        """Change how the source plays what is recorded, from any thread."""
        if (source := self._source) is None:
            return PlaybackReply(camera=camera, problem="it is not open now: try again later")
        return control_playback(source, request, camera)

    def look(self) -> None:
        """Ask the source once a second what is wrong with it, if it is one that knows."""
        if self._source is None or self._now() - self._looked_at < LOOK_S:
            return
        self._looked_at = self._now()
        self._show(getattr(self._source, "troubles", dict)())

    def _show(self, troubles: Mapping[str, str]) -> None:
        for name in self._troubles.keys() - troubles.keys():
            self._health.well(f"source {name}")
        for name, text in troubles.items():
            self._health.trouble(f"source {name}", f"source {self._name}: {text}")
        self._troubles = dict(troubles)
