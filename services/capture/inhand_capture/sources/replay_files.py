"""The files of a recording that is played as one: what is in them, and their moments."""

import contextlib
import logging
from collections import Counter
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import partial
from itertools import chain, dropwhile
from pathlib import Path

import msgspec
from inhand_runtime.recording import RecordedMessage, RecordingError, read_recording
from inhand_runtime.recording.reading import Outline, read_outline
from inhand_runtime.source import Captured, SourceError
from inhand_schemas.errors import KeyFormatError, MessageError
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO, LABEL

from inhand_capture.sources.moments import moments
from inhand_capture.sources.replay_options import OBJECT, PLAYED_STREAMS, ReplayOptions

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class PlayedFiles:
    """Files in the order of their times, and what of them is played.

    ``start_ns`` and ``end_ns`` are when the first moment and the last message were captured.
    """

    files: tuple[Path, ...]
    camera: str
    info: CameraInfo
    options: ReplayOptions
    start_ns: int
    end_ns: int

    def moments(self, from_ns: int | None = None) -> Generator[Captured]:
        """Yield the moments in the order of the files, from the first one that was captured at or
        after a time on; raises SourceError for a damaged file."""
        reached = from_ns is None
        for path in self.files:
            with contextlib.closing(self._moments_of(path, None if reached else from_ns)) as played:
                for captured in played:
                    if reached or from_ns is None or captured.time_ns >= from_ns:
                        reached = True
                        yield captured

    def _moments_of(self, path: Path, from_ns: int | None) -> Generator[Captured]:
        unreadable: Counter[str] = Counter()
        with explaining(path):
            recorded = read_recording(path, streams=PLAYED_STREAMS, captured_from_ns=from_ns)
            if from_ns is not None:
                # What colour builds on comes before, and may itself build on more.
                recorded = dropwhile(partial(_is_before, from_ns), recorded)
            chosen = (one for one in recorded if is_played(one.key, self.options))
            for captured in moments(chosen, self.camera, partial(_pass_over, path, unreadable)):
                yield self._renamed(captured)
        if count := unreadable.total():
            log.warning("%s: %d messages cannot be read and were passed over", path, count)

    def _renamed(self, captured: Captured) -> Captured:
        if not self.options.remap or not captured.labels:
            return captured
        names = {old.partition("/")[2]: new for old, new in self.options.remap.items()}
        labels = tuple(
            msgspec.structs.replace(label, object=names.get(label.object, label.object))
            for label in captured.labels
        )
        return replace(captured, labels=labels)


def _is_before(from_ns: int, message: RecordedMessage) -> bool:
    return message.captured_ns < from_ns


def open_files(options: ReplayOptions) -> PlayedFiles:
    """Look into the files of a replay; raises SourceError for what cannot be played."""
    given = (options.file,) if isinstance(options.file, Path) else options.file
    outlines = _outlines(given)
    files = tuple(sorted(outlines, key=lambda path: outlines[path].received_ns or 0))
    infos = [_infos(path) for path in files]
    camera = _choose(files, infos, options.camera)
    info = _info(files, infos, camera)
    played = PlayedFiles(files, camera, info, options, 0, 0)
    _require_something(played, list(outlines.values()))
    with contextlib.closing(played.moments()) as all_moments:
        first = next(all_moments, None)
    ends = [one.last_captured_ns for one in outlines.values() if one.last_captured_ns is not None]
    if first is None or not ends:
        raise SourceError(f"{named(files)} holds no frame of camera {camera!r}: {ANOTHER}")
    return PlayedFiles(files, camera, info, options, first.time_ns, max(ends))


ANOTHER = "choose another recording"


def named(files: Sequence[Path]) -> str:
    """Name files in a line of few words."""
    more = f" and {len(files) - 1} more" if len(files) > 1 else ""
    return f"{files[0]}{more}"


def is_played(key: str, options: ReplayOptions) -> bool:
    """Whether the options choose what is recorded on a key."""
    parsed = parse_key(key)
    name = f"{parsed.stream}/{parsed.name}"
    included = any(fnmatchcase(name, pattern) for pattern in options.include)
    return included and not any(fnmatchcase(name, pattern) for pattern in options.exclude)


@contextlib.contextmanager
def explaining(path: Path) -> Iterator[None]:
    """Raise SourceError for what cannot be read of a recording in a block."""
    try:
        yield
    except RecordingError as error:
        raise SourceError(str(error)) from error
    except (MessageError, KeyFormatError) as error:
        raise SourceError(f"{path}: {error}") from error


def _outlines(files: Sequence[Path]) -> dict[Path, Outline]:
    outlines: dict[Path, Outline] = {}
    for path in files:
        if path in outlines:
            raise SourceError(f"{path} is named twice: name each file once")
        with explaining(path):
            outlines[path] = read_outline(path, PLAYED_STREAMS)
    return outlines


def _infos(path: Path) -> dict[str, CameraInfo]:
    """Read how the cameras of a file saw, each by its first info."""
    infos: dict[str, CameraInfo] = {}
    with explaining(path):
        for recorded in read_recording(path, streams=(INFO.stream,)):
            infos.setdefault(recorded.name, INFO.decode(recorded.payload))
    return infos


def _choose(files: Sequence[Path], infos: Sequence[Mapping[str, object]], wish: str | None) -> str:
    cameras = sorted(set(chain.from_iterable(infos)))
    names = ", ".join(cameras)
    if not cameras:
        raise SourceError(f"{named(files)} holds no camera's info: {ANOTHER}")
    if wish is None and len(cameras) > 1:
        raise SourceError(
            f"{named(files)} holds several cameras; set options.camera to one of: {names}"
        )
    if wish is not None and wish not in cameras:
        raise SourceError(f"{named(files)} holds no camera {wish!r}; there are: {names}")
    return cameras[0] if wish is None else wish


def _info(
    files: Sequence[Path], infos: Sequence[Mapping[str, CameraInfo]], camera: str
) -> CameraInfo:
    """Return a camera's info, which is the same in all files that have it."""
    having = [(path, one[camera]) for path, one in zip(files, infos, strict=True) if camera in one]
    first_path, first = having[0]
    for path, info in having:
        same = msgspec.structs.replace(info, sequence=first.sequence, time_ns=first.time_ns)
        if same != first:
            raise SourceError(
                f"camera {camera!r} sees otherwise in {path} than in {first_path}: play them one "
                "after the other"
            )
    return first


def _require_something(played: PlayedFiles, outlines: Sequence[Outline]) -> None:
    """Raise SourceError where nothing is played, or what is to be renamed is not there."""
    files, options = named(played.files), played.options
    keys = [key for one in outlines for key, count in one.counts.items() if count]
    names = sorted({f"{parsed.stream}/{parsed.name}" for parsed in map(parse_key, keys)})
    of_camera = [one for one in names if one.partition("/")[2] == played.camera]
    objects = {one.partition("/")[2] for one in names if one.startswith(f"{LABEL.stream}/")}
    if not of_camera and not objects:
        raise SourceError(
            f"{files} holds no frame, skeleton or label of camera {played.camera!r}: {ANOTHER}"
        )
    if not any(is_played(key, options) for key in keys):
        raise SourceError(
            f"include and exclude leave nothing of {files}, which has: {', '.join(names)}"
        )
    for old in options.remap:
        name = old.removeprefix(f"{OBJECT}/")
        if name not in objects:
            there = ", ".join(sorted(objects)) or "none"
            raise SourceError(f"{files} has no label of object {name!r} to rename; it has: {there}")


def _pass_over(path: Path, unreadable: Counter[str], error: MessageError) -> None:
    if not unreadable:
        log.warning("%s: a message is passed over: %s", path, error)
    unreadable["messages"] += 1
