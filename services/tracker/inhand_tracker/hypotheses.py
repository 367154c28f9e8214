"""Answers who asks what the poses of the next frame are chosen from."""

import contextlib
import queue
from collections import deque

from inhand_schemas.procedures import HypothesesReply, HypothesesRequest

from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.wire.poses import SourceFrame, hypotheses_message

PATIENCE_S = 1.0
"""Seconds that a question waits for the next frame; without one it has no answer."""


class HypothesesDesk:
    """Takes questions from any thread, and answers them from the one that tracks.

    Nothing is computed for it while nobody asks.
    """

    def __init__(self, tracker: str) -> None:
        self._tracker = tracker
        self._waiting: deque[queue.SimpleQueue[HypothesesReply]] = deque()

    def ask(self, request: HypothesesRequest) -> HypothesesReply | None:
        """Wait for the next frame's; None where another tracker is asked, or no frame comes."""
        if request.tracker not in (None, self._tracker):
            return None
        reply: queue.SimpleQueue[HypothesesReply] = queue.SimpleQueue()
        self._waiting.append(reply)
        try:
            return reply.get(timeout=PATIENCE_S)
        except queue.Empty:
            with contextlib.suppress(ValueError):  # it is being answered, too late
                self._waiting.remove(reply)
            return None

    def answer(self, people: PeopleWatched, source: SourceFrame) -> None:
        """Answer all who wait by what was considered in a frame that was just tracked."""
        if not self._waiting:
            return
        reply = HypothesesReply(
            tracker=self._tracker,
            camera=source.camera,
            sequence=source.sequence,
            time_ns=source.time_ns,
            objects=tuple(
                hypotheses_message(considered, name=name, person=person)
                for person, name, considered in people.considered()
            ),
        )
        while self._waiting:
            self._waiting.popleft().put(reply)
