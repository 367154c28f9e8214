"""Gives a tab no more pictures than its browser shows.

A browser that gets the next picture before it has unpacked the last one shows neither, and what is
sent to one that is behind waits on the way. So the next is sent only when the browser has answered
to the last: it answers whenever its camera's angle is set, and that by less than anybody sees.
"""

import time

import viser

from inhand_studio.parameters import DEFAULT_STUDIO, StudioParameters


class Pace:
    """Says when a tab may get its next picture."""

    def __init__(
        self, client: viser.ClientHandle, parameters: StudioParameters = DEFAULT_STUDIO
    ) -> None:
        self._client, self._parameters = client, parameters
        self._asked_at: float | None = None
        self._stamp = 0.0
        self._sign = 1.0

    def ready(self) -> bool:
        """Whether the browser has answered to what was sent last, and had time to unpack it."""
        if self._asked_at is None:
            return True
        since_s = time.time() - self._asked_at
        answered_at = self._client.camera.update_timestamp
        if answered_at == self._stamp:
            return not 0.0 <= since_s < self._parameters.answer_s
        took_s = max(answered_at - self._asked_at, 0.0)
        return not 0.0 <= since_s < self._parameters.answers_apart * took_s

    def sent(self) -> None:
        """Note that a picture was sent, and ask the browser to answer to it."""
        camera = self._client.camera
        self._sign = -self._sign
        camera.fov = camera.fov * (1.0 + self._sign * self._parameters.unseen_turn)
        self._asked_at = self._stamp = camera.update_timestamp
