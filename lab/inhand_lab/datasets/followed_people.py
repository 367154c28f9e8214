"""Chooses whom a recording is about: the person whom its labels name, or whom a tracker follows."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person
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


def show_hips(people: Iterable[Person]) -> bool:
    """Whether anybody's hips are seen, as ``PersonFollower`` has to know."""
    return any(person.states[Joint.HIP_CENTER] != "missing" for person in people)


def _as_trackers_follow(frames: Sequence[RecordedFrame]) -> Iterator[FollowedPerson]:
    follower = PersonFollower(needs_hips=show_hips(one for frame in frames for one in frame.people))
    for frame in frames:
        before = follower.person_id
        person = follower.choose(frame.people, frame.time_ns)
        yield FollowedPerson(person, follower.person_id != before)
