"""Finds people in all pictures of a camera, before any of them is written."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import msgspec
import numpy as np
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.finder import FaceFinder, HeadsSeen, HeldSightings
from inhand_capture.faces.heads import head_of, head_of_skeleton
from inhand_capture.faces.parameters import DEFAULT_FACES
from inhand_recorder.recorded import Recorded, RecordedImages
from inhand_recorder.recording_reader import Recording
from inhand_recorder.recording_series import Series
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.joints import Joint
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import CameraInfo, Person, Skeletons
from inhand_schemas.topics import SKELETONS
from numpy.typing import NDArray

from inhand.redaction.bodies import Body, found_body, skeleton_body
from inhand.redaction.parameters import DEFAULT_REDACTION
from inhand.resumed_work import SectionResults

SAME_FRAME_NS = 20_000_000
"""How far from a frame, in nanoseconds, skeletons are of it: those of others only hide more."""

Stamp = tuple[int, int]
"""Number and time of capture of a frame."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """Who was found in one frame, in the camera's pixels.

    ``heads`` (N, 3) are x, y and radius of discs to hide, of shortly before and after it as well,
    ``bodies`` those of the
    frame alone, ``headless`` those of them whose head nobody can say, ``counts`` how many the
    network found, and how many skeletons were recorded.
    """

    time_ns: int
    bodies: tuple[Body, ...] = ()
    headless: tuple[Body, ...] = ()
    counts: tuple[int, int] = (0, 0)
    heads: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 3), np.float32))

    @property
    def discs(self) -> list[Disc]:
        """What to hide of heads."""
        return [Disc(x, y, radius) for x, y, radius in self.heads.tolist()]


class CameraSightings:
    """The sightings of all frames of a camera: of each, and of all about it."""

    def __init__(self, info: CameraInfo, frames: Sequence[tuple[Stamp, Sighting]]) -> None:
        self.info = info
        counted = Counter(stamp for stamp, _ in frames)
        self._by_stamp = {stamp: one for stamp, one in frames if counted[stamp] == 1}
        self.in_time = sorted((one for _, one in frames), key=lambda one: one.time_ns)
        self._times_ns = np.array([one.time_ns for one in self.in_time], np.int64)

    def of(self, stamp: Stamp) -> Sighting | None:
        """Return who was found in a frame; None where there was none, or two, of that stamp."""
        return self._by_stamp.get(stamp)

    def about(self, sighting: Sighting, seconds: float) -> list[Sighting]:
        """Return those of all frames that were captured within so many seconds."""
        reach = round(1e9 * seconds)
        first = np.searchsorted(self._times_ns, sighting.time_ns - reach, side="left")
        last = np.searchsorted(self._times_ns, sighting.time_ns + reach, side="right")
        return self.in_time[first:last]

    def missed(self, sighting: Sighting) -> bool:
        """Whether fewer people were found in a frame than in another one about it."""
        about = self.about(sighting, DEFAULT_REDACTION.held_s)
        most = [max(counts) for counts in zip(*(one.counts for one in about), strict=True)]
        return any(count < many for count, many in zip(sighting.counts, most, strict=True))

    def bodies(self, sighting: Sighting) -> list[Body]:
        """Return the bodies that may be in a frame: those of it and its neighbours, and of a whole
        while where somebody was missed in it."""
        missed = self.missed(sighting)
        seconds = DEFAULT_REDACTION.held_s if missed else DEFAULT_REDACTION.around_s
        return [body for one in self.about(sighting, seconds) for body in one.bodies]

    def headless(self, sighting: Sighting) -> list[Body]:
        """Return the bodies about a frame whose heads nobody can say."""
        about = self.about(sighting, DEFAULT_REDACTION.held_s)
        return [body for one in about for body in one.headless]


class _Looked(msgspec.Struct, frozen=True, array_like=True):
    """What was seen in one frame, by itself, as it is kept until the work is done: discs as x, y
    and radius, bodies as the bytes of their numbers."""

    stamp: Stamp
    of_bodies: list[list[tuple[float, float, float]]]
    faces: list[list[tuple[float, float, float]]]
    bodies: list[bytes]
    headless: list[bytes]
    counts: tuple[int, int]

    def seen(self) -> HeadsSeen:
        """Return the heads and faces."""
        return HeadsSeen(
            [[Disc(*disc) for disc in discs] for discs in self.of_bodies],
            [[Disc(*disc) for disc in discs] for discs in self.faces],
            (),
        )

    def sighting(self) -> Sighting:
        """Return the bodies, without any heads."""
        return Sighting(
            time_ns=self.stamp[1],
            bodies=tuple(map(_body, self.bodies)),
            headless=tuple(map(_body, self.headless)),
            counts=self.counts,
        )


_LOOKED = msgspec.msgpack.Decoder(list[_Looked])


def look_through(
    recording: Recording,
    key: str,
    new_finder: Callable[[], FaceFinder],
    results: SectionResults,
    on_frame: Callable[[], None] = lambda: None,
    section_frames: int = DEFAULT_REDACTION.section_frames,
) -> CameraSightings:
    """Find people in all frames of a key, by the pictures and by skeletons of the recording.

    Each section has a finder of its own, so that it shows the same whether those before it were
    looked through now or before an interruption. Frames that cannot be read are passed over. Raises
    RecordingError where the camera's info is missing.
    """
    info = recording.info_of(key)
    if info is None:
        raise RecordingError(
            f"there is no info of {parse_key(key).name}: `inhand recording repair` adds it from "
            "another file"
        )
    frames, looked = recording[key], list[_Looked]()
    for first in range(0, len(frames), section_frames):
        section = frames[first : first + section_frames]
        name = f"looked {key.replace('/', ' ')} {first}"
        result = results.load(name)
        if result is None:
            result = msgspec.msgpack.encode(
                _look_at_section(recording, section, new_finder(), info, on_frame)
            )
            results.store(name, result)
        else:
            for _ in range(len(section)):
                on_frame()
        looked += _LOOKED.decode(result)
    seen, sightings = [one.seen() for one in looked], [one.sighting() for one in looked]
    held = [
        replace(one, heads=heads)
        for one, heads in zip(sightings, _held(seen, sightings), strict=True)
    ]
    stamps = [one.stamp for one in looked]
    return CameraSightings(info, list(zip(stamps, held, strict=True)))


def _look_at_section(
    recording: Recording,
    frames: Series,
    finder: FaceFinder,
    info: CameraInfo,
    on_frame: Callable[[], None],
) -> list[_Looked]:
    """Look at frames that follow each other."""
    looked = []
    skeletons = _skeletons(recording, frames.key)
    for frame in frames:
        if isinstance(frame, RecordedImages):
            with suppress(MessageError):
                looked.append(_look(frame, finder, info, _people_at(skeletons, frame.time_ns)))
        on_frame()
    return looked


def _look(
    frame: RecordedImages, finder: FaceFinder, info: CameraInfo, skeletons: Sequence[Person]
) -> _Looked:
    """Look at one frame; raises MessageError where its picture is damaged."""
    colour = frame.colour
    if colour is None:
        known = [head_of_skeleton(one, info, DEFAULT_FACES) for one in skeletons]
        heads = HeadsSeen([[disc for disc in known if disc is not None]], [], ())
    else:
        heads = _scaled(finder.look(colour, skeletons, info), info.width / colour.shape[1])
    scale = 1.0 if colour is None else info.width / colour.shape[1]
    found = [(found_body(one, scale), head_of(one, DEFAULT_FACES)) for one in heads.people]
    found += [
        (skeleton_body(one, info), head_of_skeleton(one, info, DEFAULT_FACES)) for one in skeletons
    ]
    return _Looked(
        stamp=(frame.sequence, frame.time_ns),
        of_bodies=_numbers(heads.of_bodies),
        faces=_numbers(heads.faces),
        bodies=[body.tobytes() for body, _ in found if body is not None],
        headless=[body.tobytes() for body, head in found if body is not None and head is None],
        counts=(len(heads.people), len(skeletons)),
    )


def _held(
    seen: Sequence[HeadsSeen], sightings: Sequence[Sighting]
) -> Iterator[NDArray[np.float32]]:
    """Hold heads as the live way does, after they were seen last, and before they are first."""
    before = HeldSightings()
    backward = [
        _array(before.see(one, -of.time_ns))
        for one, of in zip(reversed(seen), reversed(sightings), strict=True)
    ]
    after = HeldSightings()
    for one, of, others in zip(seen, sightings, reversed(backward), strict=True):
        yield np.unique(np.vstack([_array(after.see(one, of.time_ns)), others]), axis=0)


def _numbers(discs_of_all: Iterable[Iterable[Disc]]) -> list[list[tuple[float, float, float]]]:
    return [
        [(float(one.x), float(one.y), float(one.radius)) for one in discs] for discs in discs_of_all
    ]


def _body(data: bytes) -> Body:
    return np.frombuffer(data, np.float32).reshape(len(Joint), 3)


def _array(discs: Iterable[Disc]) -> NDArray[np.float32]:
    rows = [(disc.x, disc.y, disc.radius) for disc in discs]
    return np.array(rows, np.float32).reshape(-1, 3)


def _scaled(seen: HeadsSeen, scale: float) -> HeadsSeen:
    def all_of(sequences: Iterable[Sequence[Disc]]) -> list[list[Disc]]:
        return [[disc.scaled(scale) for disc in discs] for discs in sequences]

    return replace(seen, of_bodies=all_of(seen.of_bodies), faces=all_of(seen.faces))


def _skeletons(recording: Recording, key: str) -> Series | None:
    parsed = parse_key(key)
    of_camera = SKELETONS.key(parsed.site, parsed.name)
    if of_camera not in recording:
        return None
    return recording[of_camera]


def _people_at(skeletons: Series | None, time_ns: int) -> tuple[Person, ...]:
    """Return the recorded people of a frame; none where they are damaged."""
    if skeletons is None:
        return ()
    found: Recorded | None
    try:
        found = skeletons.nearest(time_ns, within_ns=SAME_FRAME_NS)
    except (RecordingError, MessageError):
        return ()
    return found.message.people if found and isinstance(found.message, Skeletons) else ()
