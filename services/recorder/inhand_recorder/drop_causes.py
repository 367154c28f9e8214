"""Tells what was dropped because the disk took nothing from what came too fast."""

from collections import Counter
from collections.abc import Callable, Mapping


class DropCauses:
    """Divides the drops that a queue counts, by key, between a disk that fails and all else.

    ``report`` gets each key with how many more of its messages the disk was to blame for.
    """

    def __init__(
        self, drops: Callable[[], Mapping[str, int]], report: Callable[[str, int], None]
    ) -> None:
        self._drops = drops
        self._report = report
        self._seen: Counter[str] = Counter()

    def note(self, *, disk_failed: bool) -> None:
        """Take note of the drops since the last call, in which the disk failed all the time or not
        at all."""
        drops = Counter(self._drops())
        if disk_failed:
            for key, count in (drops - self._seen).items():
                self._report(key, count)
        self._seen = drops
