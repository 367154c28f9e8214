"""Sees that no camera's frames are used without its info, which alone makes them usable."""

from inhand_schemas.topics import INFO, RGBD

from inhand_runtime.health import HealthBoard

PATIENCE_S = 3.0
"""Seconds until missing info is a trouble: kept values come within two."""


class InfoWatch:
    """Notes which cameras send frames and which sent their info; troubles go to the health."""

    def __init__(self, health: HealthBoard) -> None:
        self._health = health
        self._infos: set[str] = set()
        self._first_frames: dict[str, float] = {}

    def note(self, stream: str, camera: str, now_s: float) -> None:
        """Take note of one message."""
        if stream == INFO.stream:
            self._infos.add(camera)
            self._health.well(f"info {camera}")
        elif stream == RGBD.stream:
            self._first_frames.setdefault(camera, now_s)

    def check(self, now_s: float) -> None:
        """Say whose frames came for long without info."""
        for camera, first_s in self._first_frames.items():
            if camera not in self._infos and now_s - first_s > PATIENCE_S:
                self._health.trouble(
                    f"info {camera}",
                    f"no camera info of {camera} yet: its frames cannot be used without it",
                )
