"""Imports skeletons of NTU RGB+D (Shahroudy et al. 2016; Liu et al. 2020): Kinect 2, 25 joints.

A ``.skeleton`` file is text, numbers only: of frames; of each frame's bodies; of each body its id,
nine numbers of which none is read, of joints, and of each joint x, y and z in metres, eight
numbers of pixels and turns, and its state (0 not tracked, 1 inferred, 2 tracked). The frame is
Kinect's: x to the sensor's left, y up, z forwards. Files have no times: frames are taken to be a
thirtieth of a second apart.
"""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from inhand_schemas import conventions
from inhand_schemas.joints import Joint

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.body_checks import Mends, check_joint_count
from inhand_lab.importers.foreign_bodies import (
    Bodies,
    ForeignBody,
    body_messages,
    our_bodies,
    recording_file,
)
from inhand_lab.importers.joint_tables import (
    INFERRED,
    MISSING,
    TRACKED,
    JointTable,
    at,
    feet,
    limbs,
    trunk,
)
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.sources import NobodyError, find_files, read_files
from inhand_lab.importers.timing import Timing, thin

RECORDED_RATE = 30.0

_LIMBS = (("Shoulder", "Elbow", "Wrist", "Hand"), ("Hip", "Knee", "Ankle", "Foot"))
_JOINTS = (
    *("SpineBase", "SpineMid", "Neck", "Head"),
    *(f"{joint}{side}" for limb in _LIMBS for side in ("Left", "Right") for joint in limb),
    *("SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight", "ThumbRight"),
)
_SPINE_MID_SHARE = 0.58
"""Place of SpineMid on the way from SpineBase to SpineShoulder in Kinect 2's skeletons."""


def _name(joint: str, side: str) -> str:
    return f"{joint.title()}{side.title()}"


NTU = JointTable(
    "NTU RGB+D",
    conventions.KINECT_V2,
    _JOINTS,
    {
        **trunk("SpineBase", "SpineMid", "SpineShoulder", _SPINE_MID_SHARE),
        Joint.HEAD: at("Head"),
        **limbs(_name),
    },
    front=feet(_name),
)

_CAMERA_FROM_KINECT = np.array([-1.0, -1.0, 1.0])
_CONFIDENCES = np.array([0.0, DEFAULT_IMPORT.inferred_confidence, 1.0])
_MENDS = Mends(
    "joints seem to be in {unit}, and NTU's are in metres; write them so",
    "axes are not those of a Kinect (x to its left, y up, z forwards): write them so",
)
_BODY_NUMBERS, _JOINT_NUMBERS = 10, 12
_FILE_NAME = re.compile(r"S\d{3}C\d{3}(P\d{3})R\d{3}(A\d{3})")


def import_ntu(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import ``*.skeleton`` files, or folders of them, as skeletons, one recording each.

    Participants and interactions are those of the files' names, P001 and A023. Files that
    cannot be read or show nobody are named and left out. Raises DatasetError where all are, or
    InhandError.
    """
    files = read_files(find_files(sources, ".skeleton"), read_ntu)
    timing = thin(sources[0], RECORDED_RATE, frame_rate)
    writer = DatasetWriter(folder)
    for bodies in files.recordings:
        stem = bodies.path.stem
        name = _FILE_NAME.fullmatch(stem)
        entry = DatasetEntry(
            file=recording_file(bodies),
            interaction=name[2] if name else stem,
            participant=name[1] if name else stem,
            frame_rate=timing.frame_rate,
        )
        kept = bodies.kept(np.arange(0, len(bodies.times_ns), timing.step))
        writer.add_recording(entry, body_messages(kept))
    files.report()
    return writer.finish({"importer": "ntu"})


def read_ntu(path: Path) -> Bodies:
    """Read one file; raises DatasetError."""
    numbers = _Numbers(path)
    frames = numbers.count("frames")
    bodies: list[ForeignBody] = []
    for frame in range(frames):
        numbers.where = f"in frame {frame} of {frames}"
        bodies += [_body(numbers, frame) for _ in range(numbers.count("bodies"))]
    numbers.require_end(frames)
    if not frames:
        raise NobodyError(f"{path} has no frame")
    timing = Timing(RECORDED_RATE, 1)
    times_ns = np.array([timing.time_ns(frame) for frame in range(frames)], np.int64)
    return our_bodies(path, NTU, times_ns, bodies, _MENDS)


def _body(numbers: "_Numbers", frame: int) -> ForeignBody:
    number = numbers.whole(numbers.take(_BODY_NUMBERS)[0], "id")
    joints = numbers.count("joints")
    check_joint_count(numbers.path, NTU, joints)
    rows = np.array(numbers.take(joints * _JOINT_NUMBERS)).reshape(joints, _JOINT_NUMBERS)
    places = numbers.real(rows[:, :3]) * _CAMERA_FROM_KINECT
    states = numbers.real(rows[:, -1])
    if not np.isin(states, (MISSING, INFERRED, TRACKED)).all():
        raise DatasetError(f"{numbers.path}: a joint's state {numbers.where} is none of 0, 1 and 2")
    states = states.astype(np.uint8)
    return ForeignBody(frame, number, places, states, _CONFIDENCES[states])


class _Numbers:
    """The numbers of a file, one after the other; ``where`` says for errors where they are."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.where = "at its start"
        try:
            self._words = path.read_text(encoding="ascii").split()
        except OSError as error:
            raise DatasetError(f"cannot read {path}: {error.strerror}") from None
        except UnicodeDecodeError:
            raise DatasetError(f"{path} is no text: NTU's skeletons are numbers in text") from None
        self._next = 0

    def take(self, count: int) -> list[str]:
        """Take the next words; raises DatasetError where the file ends before."""
        words = self._words[self._next : self._next + count]
        if len(words) < count:
            raise DatasetError(f"{self.path} ends {self.where}: it is cut off; fetch it again")
        self._next += count
        return words

    def count(self, what: str) -> int:
        """Take a number of things."""
        number = self.whole(self.take(1)[0], f"number of {what}")
        if number < 0:
            raise DatasetError(f"{self.path}: the number of {what} {self.where} is {number}")
        return number

    def whole(self, word: str, what: str) -> int:
        """Return a word as a whole number."""
        try:
            return int(word)
        except ValueError:
            raise DatasetError(
                f"{self.path}: the {what} {self.where} is {word[:20]!r}, and no whole number: this "
                "is no skeleton file of NTU's"
            ) from None

    def real(self, words: np.ndarray) -> np.ndarray:
        """Return words as numbers, of any shape."""
        try:
            return words.astype(float)
        except ValueError as error:
            raise DatasetError(f"{self.path}: a joint {self.where}: {error}") from None

    def require_end(self, frames: int) -> None:
        """Raise DatasetError where words are left."""
        left = len(self._words) - self._next
        if left:
            raise DatasetError(
                f"{self.path} goes on for {left} numbers after its {frames} frames: this is no "
                "skeleton file of NTU's"
            )
