"""One take of a training recording: a countdown, what is missing, and a whole file or none."""

import contextlib
import math
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from inhand_lab.new_recordings.view_watch import ViewWatch
from inhand_recorder.recording_file import RecordingFile
from inhand_recorder.stamps import entry_of
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.inbox import Received
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS, topic_of

from inhand.looking import Look, nothing_heard

TOPICS_TAKEN = (INFO, RGBD, SKELETONS, LABEL)
"""What is learned from. A simulated world, or a program of others, says labels by itself."""
CAMERAS_PATIENCE_S = 5.0
"""Seconds until a rig without cameras is one: info comes within two of the connection."""
CAMERAS_SETTLE_S = 1.0
"""Seconds after the first camera's info in which others are heard."""
SYNC_PERIOD_S = 0.75

Say = Callable[[str], None]


@dataclass(frozen=True)
class TakeWishes:
    """What to record: into which folder, of which ``camera`` (None: the only one), after how many
    seconds and for how many (None: until Ctrl-C)."""

    folder: Path
    camera: str | None
    countdown_s: float
    seconds: float | None


@dataclass(frozen=True)
class Take:
    """What was recorded. ``missing`` says of each kind for which share of the time it was."""

    path: Path
    camera: str
    seconds: float
    frames: int
    skeletons: int
    lost: int
    missing: dict[str, float] = field(default_factory=dict)


def take(look: Look, wishes: TakeWishes, say: Say) -> Take:
    """Record one take; what is missing is said when it begins to be and when it ends.

    Raises InhandError where no camera is heard, nothing came to learn from, or the disk failed,
    and KeyboardInterrupt at Ctrl-C in the countdown: then no file stays.
    """
    for topic in TOPICS_TAKEN:
        look.follow(topic)
    infos = _cameras(look)
    camera = _chosen(wishes.camera, infos)
    say(f"Camera {camera}.")
    view = _View(camera, infos[camera], say)
    _count_down(look, view, wishes.countdown_s)
    return _record(look, view, wishes)


class _View:
    """Reads what a camera sends and says what is missing in it."""

    def __init__(self, camera: str, info: Received, say: Say) -> None:
        self.camera = camera
        self.info = info
        self.say = say
        self.watch = self._new_watch()

    def begin(self) -> None:
        """Count from now on."""
        missing = self.watch.missing
        self.watch = self._new_watch()
        self.watch.expect(missing)

    def note(self, sample: Received) -> bool:
        """Look at a sample; returns whether it belongs to this camera's recording."""
        try:
            topic, parsed = topic_of(sample.key)
            message = topic.received(sample.key, sample.payload, sample.encoding)
        except (MessageError, KeyFormatError) as error:
            self.say(f"! A message on {sample.key} cannot be read: {error}")
            return False
        if topic is LABEL:
            return getattr(message, "camera", None) == self.camera
        if parsed.name != self.camera:
            return False
        self.watch.note(message, time.monotonic())
        return True

    def tell(self) -> None:
        """Say what is news."""
        begun, ended = self.watch.news(time.monotonic())
        for one in begun:
            self.say(f"! {one.text}")
        for one in ended:
            self.say(f"  {one.kind}: well again.")

    def _new_watch(self) -> ViewWatch:
        watch = ViewWatch(time.monotonic())
        watch.note(INFO.decode(self.info.payload, self.info.encoding), time.monotonic())
        return watch


def _cameras(look: Look) -> dict[str, Received]:
    """Hear which cameras there are: their infos by name."""
    infos: dict[str, Received] = {}
    end = time.monotonic() + CAMERAS_PATIENCE_S
    for sample in look.samples(CAMERAS_PATIENCE_S):
        if sample is not None and (name := _camera_of(sample)) is not None:
            if not infos:
                end = min(end, time.monotonic() + CAMERAS_SETTLE_S)
            infos[name] = sample
        if time.monotonic() > end:
            break
    if not infos:
        raise nothing_heard(look.site, CAMERAS_PATIENCE_S)
    return infos


def _camera_of(sample: Received) -> str | None:
    with contextlib.suppress(MessageError, KeyFormatError):  # of a foreign program
        topic, parsed = topic_of(sample.key)
        if topic is INFO:
            INFO.decode(sample.payload, sample.encoding)
            return parsed.name
    return None


def _chosen(wanted: str | None, infos: dict[str, Received]) -> str:
    names = ", ".join(sorted(infos))
    if wanted is None and len(infos) > 1:
        raise SettingsError(f"there are several cameras: add --camera with one of: {names}")
    if wanted is not None and wanted not in infos:
        raise SettingsError(f"there is no camera {wanted!r}; there are: {names}")
    return wanted or next(iter(infos))


def _count_down(look: Look, view: _View, seconds: float) -> None:
    end = time.monotonic() + seconds
    said = math.ceil(seconds) + 1
    for sample in look.samples(seconds):
        left = math.ceil(end - time.monotonic())
        if left < said and left > 0:
            said = left
            view.say(f"{left} …")
        if sample is not None:
            view.note(sample)
        view.tell()


def _record(look: Look, view: _View, wishes: TakeWishes) -> Take:
    view.begin()
    began = time.monotonic()
    with _whole_or_gone(wishes.folder, view) as file:
        view.say("Recording" + (" until you stop it (Ctrl-C)." if wishes.seconds is None else "."))
        missing = _write_until_stopped(look, view, file, wishes.seconds)
        if not view.watch.skeletons:
            raise InhandError(
                f"no skeletons came from {view.camera}, and nothing can be learned without: "
                "nothing was kept"
            )
        path = file.finish({})
    seconds = time.monotonic() - began
    watch = view.watch
    shares = {kind: min(1.0, lasted / seconds) for kind, lasted in missing.items()}
    return Take(path, view.camera, seconds, watch.frames, watch.skeletons, watch.lost, shares)


def _write_until_stopped(
    look: Look, view: _View, file: RecordingFile, seconds: float | None
) -> Mapping[str, float]:
    """Write what comes; returns for how many seconds each kind of thing was missing."""
    missing: defaultdict[str, float] = defaultdict(float)
    before = next_sync = time.monotonic()
    info_written = False
    with contextlib.suppress(KeyboardInterrupt):  # the usual end
        for sample in look.samples(seconds):
            if sample is not None and sample.key != view.info.key and view.note(sample):
                if not info_written:  # the first sample may have waited since before this file
                    file.repeat(entry_of(view.info), sample.received_ns)
                    info_written = True
                file.put(entry_of(sample))
            view.tell()
            now = time.monotonic()
            for one in view.watch.missing:
                missing[one.kind] += now - before
            before = now
            if now >= next_sync:
                file.sync()
                next_sync = now + SYNC_PERIOD_S
    return missing


@contextlib.contextmanager
def _whole_or_gone(folder: Path, view: _View) -> Iterator[RecordingFile]:
    """Open a recording; where anything fails until the end of the block, nothing of it stays."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InhandError(f"cannot create {folder}: {error.strerror}") from None
    file = _open(folder, view.camera)
    try:
        yield file
    except BaseException as error:
        file.discard()
        if isinstance(error, RecordingError):
            raise InhandError(f"{error}; nothing of this take was kept") from None
        raise


def _open(folder: Path, camera: str) -> RecordingFile:
    """Begin a file of a name that no other process has."""
    moment = datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    name, number = f"{camera}_{moment}", 1
    while True:
        try:
            return RecordingFile(folder / f"{name}.mcap", time.monotonic())
        except RecordingError:
            if not any(folder.glob(f"{name}.mcap*")):
                raise
        number += 1
        name = f"{camera}_{moment}_{number}"
