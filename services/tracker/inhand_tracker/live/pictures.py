"""Sees whether poses are made with pictures: without them a tracker follows the body alone."""

from collections import deque

from inhand_runtime.health import HealthBoard

POSES = 90
"""Number of the last poses that are judged: three seconds at 30 Hz."""
MOST_WITHOUT = 0.2
"""Share of them that may lack a picture."""
JUDGED_EVERY = 30
"""Number of poses from one judgement to the next: what changes each frame would be logged each."""
LASTS_S = 5.0
"""Seconds for which the trouble lasts when no more poses are made."""


class PictureWatch:
    """Notes of each pose whether it had a picture, where its method wants one."""

    def __init__(self, health: HealthBoard) -> None:
        self._health = health
        self._had: deque[bool] = deque(maxlen=POSES)
        self._ever = False
        self._noted = 0

    def note(self, had_picture: bool) -> None:
        """Take note of one pose; a camera that sends no pictures at all is no trouble."""
        self._ever |= had_picture
        self._had.append(had_picture)
        self._noted += 1
        if self._noted % JUDGED_EVERY:
            return
        without = self._had.count(False)
        if self._ever and len(self._had) == POSES and without > MOST_WITHOUT * POSES:
            self._health.trouble(
                "pictures",
                f"{without} of {POSES} poses are without picture: pictures come late or not "
                "at all, or this machine is too slow for them",
                lasts_s=LASTS_S,
            )
        else:
            self._health.well("pictures")
