"""What `inhand calibrate` looks at: pictures and skeletons of a rig that runs, or of recordings."""

import argparse
import os
import time
from collections import defaultdict, deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_calibration.arrays import Array
from inhand_calibration.errors import CalibrationError
from inhand_calibration.from_board.board import (
    SQUARES_MM,
    CharucoBoard,
    printed_board,
    written_board,
)
from inhand_calibration.from_board.calibration import scaled
from inhand_calibration.from_board.collecting import BoardSights
from inhand_calibration.from_board.rig import ENOUGH_MOMENTS
from inhand_calibration.from_board.sheet import LINE_MM
from inhand_calibration.from_board.sights import CameraSights
from inhand_calibration.from_board.together import PlacesTogether
from inhand_calibration.from_people.skeletons import CameraSkeletons
from inhand_runtime.recording import RecordedMessage, RecordingError, read_recording
from inhand_runtime.wording import counted
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site, parse_key
from inhand_schemas.messages import CameraInfo, Message, Person, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS, AnyTopic, topic_of

from inhand.looking import nothing_heard, open_look

SAY_EVERY_S = 5.0
"""Seconds between two lines on what has been seen so far."""


@dataclass(frozen=True)
class _Heard:
    """A message of a camera, and when it was received, seconds; None when nothing just was."""

    camera: str
    message: Message
    received_s: float


def board_sights(arguments: argparse.Namespace) -> BoardSights:
    """Gather what cameras see of the board; raises InhandError."""
    sights, places = BoardSights(_boards(arguments.pattern)), PlacesTogether()
    said_at, live = time.monotonic(), not arguments.recordings
    workers = os.cpu_count() or 1
    waiting: deque[tuple[_Heard, Future[Array | None]]] = deque()
    with ThreadPoolExecutor(workers, thread_name_prefix="board") as pool:
        for heard in _messages(arguments, (INFO, RGBD)):
            while waiting and (len(waiting) > 2 * workers or waiting[0][1].done()):
                _note(places, *waiting.popleft())
            if live and time.monotonic() - said_at > SAY_EVERY_S:
                said_at = time.monotonic()
                _say(places, sights.cameras)
            if heard is None:
                continue
            if isinstance(heard.message, CameraInfo):
                sights.introduce(heard.camera, heard.message)
            elif isinstance(heard.message, RgbdFrame):
                waiting.append((heard, pool.submit(sights.add, heard.camera, heard.message)))
        for one in waiting:
            _note(places, *one)
    if not sights.cameras:
        raise CalibrationError("no camera said how it sees: start the rig, or name recordings")
    return sights


def sized_sights(sights: BoardSights, line_mm: float | None) -> list[CameraSights]:
    """Return the sights of a board as large as its line shows; raises CalibrationError."""
    cameras = sights.sights()
    return cameras if line_mm is None else scaled(cameras, line_mm / LINE_MM)


def people_seen(arguments: argparse.Namespace) -> list[CameraSkeletons]:
    """Gather the people whom cameras see, a row each, and say which cameras send no skeletons;
    raises InhandError."""
    rows: dict[str, list[tuple[int, Person]]] = defaultdict(list)
    introduced: set[str] = set()
    said_at = time.monotonic()
    for heard in _messages(arguments, (INFO, SKELETONS)):
        if not arguments.recordings and time.monotonic() - said_at > SAY_EVERY_S:
            said_at = time.monotonic()
            print("people seen: " + _listed({name: len(own) for name, own in rows.items()}))
        if heard is not None and isinstance(heard.message, Skeletons):
            rows[heard.camera] += [(heard.message.time_ns, one) for one in heard.message.people]
        elif heard is not None and isinstance(heard.message, CameraInfo):
            introduced.add(heard.camera)
    if not rows:
        raise CalibrationError(
            "no camera sent skeletons: start the rig, or choose its recordings; a source that has "
            'none of its own takes skeletons = "estimated"'
        )
    for name in sorted(introduced - rows.keys()):
        print(
            f"{name} sent no skeletons, and is left out: a source that has none of its own takes "
            'skeletons = "estimated"'
        )
    return [_skeletons(name, own) for name, own in sorted(rows.items())]


def _boards(pattern: str | None) -> Sequence[CharucoBoard]:
    if pattern is not None:
        return [written_board(pattern)]
    return [printed_board(paper) for paper in SQUARES_MM]


def _messages(arguments: argparse.Namespace, topics: Sequence[AnyTopic]) -> Iterator[_Heard | None]:
    """Messages of some topics, of recordings or of the rig that runs, and None while there is none;
    raises InhandError."""
    if arguments.recordings:
        streams = [topic.stream for topic in topics]
        sites: dict[str, Site] = {}
        for path in arguments.recordings:
            for recorded in read_recording(path, streams=streams):
                _require_one_rig(sites, recorded, path)
                try:
                    message = recorded.message()
                except MessageError as error:
                    raise RecordingError(f"{path}: {error}") from None
                yield _Heard(recorded.name, message, recorded.received_ns * 1e-9)
        return
    heard_any = False
    with open_look(arguments.config) as look:
        for topic in topics:
            look.follow(topic)
        for sample in look.samples(arguments.seconds):
            if sample is None:
                yield None
                continue
            topic, parsed = topic_of(sample.key)
            heard_any = True
            try:
                message = topic.received(sample.key, sample.payload, sample.encoding)
            except MessageError as error:
                raise CalibrationError(f"{sample.key}: {error}") from None
            yield _Heard(parsed.name, message, sample.received_ns * 1e-9)
        if not heard_any:
            raise nothing_heard(look.site, arguments.seconds)
        if look.skipped:
            print(f"{counted(look.skipped, 'picture')} left out: this computer is too slow for all")


def _require_one_rig(sites: dict[str, Site], recorded: RecordedMessage, path: Path) -> None:
    """Note the rig of a message's camera; raises RecordingError where two rigs have one of that
    name, which would pass for one camera."""
    site = parse_key(recorded.key).site
    if sites.setdefault(recorded.name, site) != site:
        raise RecordingError(
            f"{path}: {recorded.key} is of another rig's camera {recorded.name}: give recordings "
            "in which each camera has a name of its own"
        )


def _note(places: PlacesTogether, heard: _Heard, done: "Future[Array | None]") -> None:
    middle = done.result()
    if middle is not None:
        places.note(heard.camera, heard.received_s, middle)


def _say(places: PlacesTogether, cameras: tuple[str, ...]) -> None:
    for (one, two), count in places.counts(cameras).items():
        print(
            f"{one} and {two} saw the board together in {counted(count, 'place')}, "
            f"{ENOUGH_MOMENTS} are enough",
            flush=True,
        )


def _listed(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count:,}" for name, count in sorted(counts.items())) or "none yet"


def _skeletons(camera: str, rows: list[tuple[int, Person]]) -> CameraSkeletons:
    """People as arrays, in the order of their times."""
    rows = sorted(rows, key=lambda row: row[0])
    joints = np.array([person.joints for _, person in rows], float).reshape(-1, 20, 3)
    missing = np.array([[state == "missing" for state in one.states] for _, one in rows], bool)
    joints[missing.reshape(joints.shape[:2])] = np.nan
    return CameraSkeletons(
        camera,
        np.array([time_ns for time_ns, _ in rows], np.int64),
        np.array([person.id for _, person in rows], np.int64),
        joints,
        np.array([person.confidences for _, person in rows], float).reshape(-1, 20),
    )
