"""Watches what a camera shows, and says what is missing now and how long it was."""

from collections.abc import Iterable, Iterator

from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, RgbdFrame, Skeletons

from inhand_lab.new_recordings.parameters import DEFAULT_VIEW, ViewParameters
from inhand_lab.new_recordings.view_checks import Lack, people_lacks, picture_lacks


class ViewWatch:
    """Collects what is missing, from messages in their order; times are seconds of any clock.

    ``lost`` counts frames that never came, by their numbers.
    """

    def __init__(self, now_s: float, parameters: ViewParameters = DEFAULT_VIEW) -> None:
        self.lost = 0
        self.frames = 0
        self.skeletons = 0
        self._parameters = parameters
        self._info: CameraInfo | None = None
        self._sequence: int | None = None
        self._latest = {"picture": now_s, "skeleton": now_s}
        self._looked_s = float("-inf")
        self._picture: list[Lack] = []
        self._people: list[Lack] = []
        self._since: dict[str, float] = {}
        self._missing: dict[str, Lack] = {}
        self._well_since: dict[str, float] = {}

    @property
    def missing(self) -> tuple[Lack, ...]:
        """What is missing now, and was for a while."""
        return tuple(self._missing.values())

    def expect(self, missing: Iterable[Lack]) -> None:
        """Take it that these are missing and were said, until it shows that they are not."""
        self._missing = {one.kind: one for one in missing}
        self._since = dict.fromkeys(self._missing, float("-inf"))

    def note(self, message: object, now_s: float) -> None:
        """Take note of a camera's message: its info, a frame or skeletons."""
        if isinstance(message, CameraInfo):
            self._info = message
        elif isinstance(message, RgbdFrame):
            self._note_frame(message, now_s)
        elif isinstance(message, Skeletons):
            self._latest["skeleton"] = now_s
            self.skeletons += 1
            self._people = list(people_lacks(message, self._info))

    def news(self, now_s: float) -> tuple[list[Lack], list[Lack]]:
        """Return what is missing since just now, and what no longer is."""
        present = {one.kind: one for one in self._now(now_s)}
        lasting_s = self._parameters.lasting_s
        begun = []
        for kind, one in present.items():
            self._well_since.pop(kind, None)
            lasted = now_s - self._since.setdefault(kind, now_s) >= lasting_s
            if lasted and kind not in self._missing:
                begun.append(one)
            if lasted:
                self._missing[kind] = one
        for kind in set(self._since) - present.keys():
            del self._since[kind]
        ended = []
        for kind in set(self._missing) - present.keys():
            if now_s - self._well_since.setdefault(kind, now_s) >= lasting_s:
                del self._well_since[kind]
                ended.append(self._missing.pop(kind))
        return begun, ended

    def _note_frame(self, frame: RgbdFrame, now_s: float) -> None:
        self._latest["picture"] = now_s
        self.frames += 1
        if self._sequence is not None and frame.sequence > self._sequence + 1:
            self.lost += frame.sequence - self._sequence - 1
        self._sequence = frame.sequence
        if now_s - self._looked_s >= self._parameters.look_every_s:
            self._looked_s = now_s
            try:
                self._picture = list(picture_lacks(frame))
            except MessageError as error:
                self._picture = [Lack("picture", f"The picture cannot be read: {error}.")]

    def _now(self, now_s: float) -> Iterator[Lack]:
        silent = {
            kind: now_s - at_s > self._parameters.silent_s for kind, at_s in self._latest.items()
        }
        if silent["picture"]:
            yield Lack("camera", "No picture comes: is the camera on, and its shutter open?")
        else:
            yield from self._picture
        if silent["skeleton"]:
            yield Lack(
                "skeleton",
                "No skeletons come: give the camera a body tracker, or skeletons = "
                '"estimated" in its settings.',
            )
        else:
            yield from self._people
        if self._info is None:
            yield Lack("info", "The camera has not said how it sees (its info).")
