"""Chooses whom a recording is about: the person whom its labels name, or whom a tracker follows."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person
from inhand_tracker.geometry.arrays import Flags
from inhand_tracker.people.following import PersonFollower

from inhand_lab.datasets.recorded_frames import RecordedFrame


@dataclass(frozen=True)
class FollowedPerson:
    """Whom a frame is about, None where that one is out of view.

    ``somebody_else`` is true where it is another person from this frame on.
    """

    person: Person | None
    somebody_else: bool


def follow_people(frames: Sequence[RecordedFrame]) -> Iterator[FollowedPerson]:
    """Yield whom each frame is about.

    It is the one whom the label names, and in frames without such a label whom the last one named,
    or the first where none did before. Where no label of a recording names anybody, it is whom a
    tracker would follow: the nearest at first.
    """
    named = [None if frame.label is None else frame.label.person for frame in frames]
    first = next((number for number in named if number is not None), None)
    if first is None:
        yield from _as_trackers_follow(frames)
        return
    current, before = first, None
    for frame, number in zip(frames, named, strict=True):
        current = current if number is None else number
        person = next((one for one in frame.people if one.id == current), None)
        yield FollowedPerson(person, current != before)
        before = current


def frames_of_others(frames: Sequence[RecordedFrame]) -> Flags:
    """Flag (T,) the frames in which labels name somebody else than the one whom most name, and
    those without a name after these.

    Both are seen beside each other in some frame: an object passes from one to the other. Where
    they never are it is one person, whom a body tracker has lost and numbered anew.
    """
    named = [None if frame.label is None else frame.label.person for frame in frames]
    counts = Counter(number for number in named if number is not None)
    if len(counts) < 2:
        return np.zeros(len(frames), bool)
    (main, _), *_ = counts.most_common()
    seen = [{person.id for person in frame.people} for frame in frames]
    others = {number for number in counts if any({main, number} <= ids for ids in seen)} - {main}
    passed, current = np.zeros(len(frames), bool), main
    for index, number in enumerate(named):
        current = current if number is None else number
        passed[index] = current in others
    return passed


def show_hips(people: Iterable[Person]) -> bool:
    """Whether anybody's hips are seen, as ``PersonFollower`` has to know."""
    return any(person.states[Joint.HIP_CENTER] != "missing" for person in people)


def _as_trackers_follow(frames: Sequence[RecordedFrame]) -> Iterator[FollowedPerson]:
    follower = PersonFollower(needs_hips=show_hips(one for frame in frames for one in frame.people))
    for frame in frames:
        before = follower.person_id
        person = follower.choose(frame.people, frame.time_ns)
        yield FollowedPerson(person, follower.person_id != before)
