"""Has colour coded as H.264 beside the recording, which never waits long for it.

A frame whose colour is not coded in time, or cannot be, is recorded as it came.
"""

import threading
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from queue import SimpleQueue
from typing import Literal, Protocol

from inhand_runtime.recording.coded_colour import digest_of
from inhand_runtime.wording import counted
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import RGBD
from msgspec import structs

from inhand_recorder.colour_encoder import QUALITY, ColourEncoder, load_pyav
from inhand_recorder.recording_file import CodedEntry, Entry

COLOUR_RECORD = "colour"
"""The name of the metadata record on how colour was coded, and how many frames of each key were, or
were not, since the recorder's start."""
MOST_CODERS = 16
"""Cameras whose colour is coded; that of others is recorded as it came."""
MOST_WAITING = 4
"""Frames of a camera that wait to be coded; what comes beyond is recorded as it came."""
LONGEST_WAIT_S = 0.08
"""How long a frame may wait to be coded, so that a crash costs little more than without it."""
LAST_WAIT_S = 1.0
"""How long is waited for a frame where a file ends."""
TROUBLE_LASTS_S = 5.0

Fate = Literal["coded", "late", "unfit", "baseless"]
"""What becomes of a frame's colour: as it came is what was too ``late``, or ``unfit``, or would
build on what is not in the file."""


class Troubles(Protocol):
    """Where it is said that colour is not coded."""

    def trouble(self, name: str, text: str, *, lasts_s: float = ...) -> None:
        """Say what is wrong, for some seconds."""


@dataclass(eq=False)
class _Waiting:
    """A frame that is coded; ``given_up`` says that nobody waits for it any more."""

    entry: Entry
    since: float
    done: threading.Event = field(default_factory=threading.Event)
    coded: CodedEntry | None = None
    problem: str | None = None
    given_up: bool = False
    late: bool = False


class _Coder:
    """Codes the frames of one key in a thread of its own."""

    def __init__(self, key: str) -> None:
        self.key = key
        self.waiting: deque[_Waiting] = deque()
        self.counts: Counter[Fate] = Counter()
        self._given: SimpleQueue[_Waiting] = SimpleQueue()
        self._anew = threading.Event()
        self._ended = threading.Event()
        threading.Thread(target=self._run, name=f"colour of {key}", daemon=True).start()

    def take(self, waiting: _Waiting) -> None:
        self.waiting.append(waiting)
        if self._ended.is_set():
            waiting.problem = "what codes it has failed, as the log says"
            waiting.done.set()
        elif sum(not one.done.is_set() for one in self.waiting) > MOST_WAITING:
            waiting.late = True
            waiting.done.set()
        else:
            self._given.put(waiting)

    def begin_anew(self) -> None:
        """Take note that what a coded frame builds on is not in the file."""
        self.counts["coded"] -= 1
        self.counts["baseless"] += 1
        self._anew.set()

    def _run(self) -> None:
        try:
            self._code_all()
        finally:
            self._ended.set()

    def _code_all(self) -> None:
        encoder: ColourEncoder | None = None
        while True:
            waiting = self._given.get()
            try:
                encoder = encoder or ColourEncoder()
                if self._anew.is_set():
                    self._anew.clear()
                    encoder.begin_anew()
                if not waiting.given_up:
                    waiting.coded = self._coded(encoder, waiting.entry)
                if waiting.given_up:
                    encoder.begin_anew()
            except ModuleNotFoundError:
                waiting.problem = 'PyAV is not installed: pip install "inhand[h264]"'
            except (MessageError, ValueError, MemoryError) as error:
                waiting.problem = str(error) or type(error).__name__
            finally:
                waiting.done.set()

    def _coded(self, encoder: ColourEncoder, entry: Entry) -> CodedEntry | None:
        frame: RgbdFrame = RGBD.decode(entry.payload)
        if frame.colour is None:
            return None
        colour: ColourImage = encoder.encode(frame.colour, entry.captured_ns)
        payload = RGBD.encode(structs.replace(frame, colour=colour))
        return CodedEntry(payload, digest_of(colour), colour.builds_on, self.begin_anew)


class ColourCoding:
    """Takes entries, and hands them out again in the order of each key, frames with their colour
    coded beside; from one thread, which ``clock``, in seconds, is of."""

    def __init__(self, troubles: Troubles, clock: Callable[[], float]) -> None:
        self._troubles, self._clock = troubles, clock
        with suppress(ModuleNotFoundError):  # then each frame's problem says so
            load_pyav()
        self._coders: dict[str, _Coder] = {}

    @property
    def under_way(self) -> bool:
        """Whether any entry has not been handed out."""
        return any(one.waiting for one in self._coders.values())

    @property
    def counts(self) -> Mapping[Fate, int]:
        """What became of the colour of all frames so far."""
        return sum((one.counts for one in self._coders.values()), Counter[Fate]())

    @property
    def waiting(self) -> Counter[str]:
        """How many messages of each key have not been handed out."""
        return Counter({key: len(one.waiting) for key, one in self._coders.items()})

    def take(self, entry: Entry) -> Iterator[Entry]:
        """Take an entry, and hand out those that are ready: other ones than frames at once."""
        coder = None if entry.apart or not _is_frame(entry.key) else self._coder(entry.key)
        if coder is None:
            yield entry
            return
        coder.take(_Waiting(entry, self._clock()))
        yield from self._ready(coder)

    def ready(self) -> Iterator[Entry]:
        """Hand out what is coded, and what has waited long enough."""
        for coder in self._coders.values():
            yield from self._ready(coder)

    def all(self) -> Iterator[Entry]:
        """Wait for what is under way, and hand it out."""
        for coder in self._coders.values():
            for one in list(coder.waiting):
                one.done.wait(LAST_WAIT_S)
                yield self._handed_out(coder)

    def records(self) -> Mapping[str, Mapping[str, str]]:
        """Return the named record of a file that begins or ends now."""
        values = {
            "codec": f"h264 of libx264, preset {QUALITY.preset}, rate factor {QUALITY.rate_factor}"
        }
        for key, coder in sorted(self._coders.items()):
            fates = {fate: count for fate, count in coder.counts.items() if count}
            values[key] = " ".join(f"{fate}={count}" for fate, count in sorted(fates.items()))
        return {COLOUR_RECORD: values}

    def _coder(self, key: str) -> _Coder | None:
        if key not in self._coders:
            if len(self._coders) == MOST_CODERS:
                self._say(key, f"colour of {counted(MOST_CODERS, 'camera')} is coded already")
                return None
            self._coders[key] = _Coder(key)
        return self._coders[key]

    def _ready(self, coder: _Coder) -> Iterator[Entry]:
        while coder.waiting:
            first = coder.waiting[0]
            if not first.done.is_set() and self._clock() - first.since < LONGEST_WAIT_S:
                return
            yield self._handed_out(coder)

    def _handed_out(self, coder: _Coder) -> Entry:
        one = coder.waiting.popleft()
        if not one.done.is_set():
            one.given_up = one.late = True
        if one.late:
            coder.counts["late"] += 1
            self._say(coder.key, "coding it as H.264 takes longer than it comes")
        elif one.problem is not None:
            coder.counts["unfit"] += 1
            self._say(coder.key, one.problem)
        elif one.coded is not None:
            coder.counts["coded"] += 1
            return replace(one.entry, coded=one.coded)
        return one.entry

    def _say(self, key: str, why: str) -> None:
        text = f"{key}: colour is recorded as it came: {why}"
        self._troubles.trouble(f"colour {key}", text, lasts_s=TROUBLE_LASTS_S)


def _is_frame(key: str) -> bool:
    return key.split("/")[-2:-1] == [RGBD.stream]
