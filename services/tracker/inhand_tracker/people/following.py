"""Whose objects are followed when several people are in view."""

from collections.abc import Callable, Iterator, Sequence

from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person

from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.estimate import LOST
from inhand_tracker.geometry.image import Image
from inhand_tracker.people.identities import Identities
from inhand_tracker.people.watching import OnFailure, Seen, Watcher
from inhand_tracker.wire.conversion import joints_of

PATIENCE_NS = 2_000_000_000


class Follower:
    """Follows one person by id; when that one is gone for two seconds, the nearest one."""

    def __init__(self) -> None:
        self.person_id: int | None = None
        self._seen_ns = 0

    def choose(self, people: Sequence[Person], time_ns: int) -> Person | None:
        """The person followed, of those seen at a time; None while that one is not seen."""
        chosen = next((person for person in people if person.id == self.person_id), None)
        waiting = self.person_id is not None and 0 <= time_ns - self._seen_ns < PATIENCE_NS
        if chosen is None and not waiting:
            chosen = _nearest(people)
        if chosen is not None:
            self.person_id, self._seen_ns = chosen.id, time_ns
        return chosen


def _nearest(people: Sequence[Person]) -> Person | None:
    hips = Joint.HIP_CENTER
    seen = [person for person in people if person.states[hips] != "missing"]
    return min(seen, key=lambda person: person.joints[hips][2], default=None)


class PeopleWatched:
    """Watches so many people at once, each by a watcher of their own.

    Of one alone it is the person that ``Follower`` chooses, by the camera's id. Several keep their
    own numbers (``Identities``), whatever the camera calls them; who is gone for two seconds makes
    room, and the nearest stranger is next.
    """

    def __init__(self, new_watcher: Callable[[], Watcher], most: int) -> None:
        self._most = most
        self._new_watcher = new_watcher
        self._idle = [new_watcher()]
        self.names = self._idle[0].names
        self._follower = Follower()
        self._identities = Identities()
        self._watchers: dict[int | None, Watcher] = {}
        self._seen_ns: dict[int | None, int] = {}

    def see(
        self,
        people: Sequence[Person],
        time_ns: int,
        image: Image | None,
        camera: Intrinsics | None,
        on_failure: OnFailure,
    ) -> dict[int | None, list[Seen]]:
        """What each watched person uses in a frame, by the person's number."""
        found = self._alone(people, time_ns) if self._most == 1 else self._several(people, time_ns)
        if not found:
            return {None: [Seen(name, LOST) for name in self.names]}
        return {
            number: self._watchers[number].see(
                None if person is None else joints_of(person), time_ns, image, camera, on_failure
            )
            for number, person in found.items()
        }

    def _alone(self, people: Sequence[Person], time_ns: int) -> dict[int | None, Person | None]:
        before = self._follower.person_id
        person = self._follower.choose(people, time_ns)
        number = self._follower.person_id
        if not self._watchers:
            self._watchers[number] = self._idle.pop()
        elif number != before:
            watcher = self._watchers.pop(before)
            watcher.restart()
            self._watchers[number] = watcher
        return {number: person}

    def _several(self, people: Sequence[Person], time_ns: int) -> dict[int | None, Person | None]:
        seen = self._identities.assign(people, time_ns)
        for number in [n for n, last in self._seen_ns.items() if _gone(last, time_ns)]:
            watcher = self._watchers.pop(number)
            del self._seen_ns[number]
            watcher.restart()
            self._idle.append(watcher)
        for number in sorted(seen, key=lambda n: _depth(seen[n])):
            if number not in self._watchers and len(self._watchers) < self._most:
                self._watchers[number] = self._idle.pop() if self._idle else self._new_watcher()
            if number in self._watchers:
                self._seen_ns[number] = time_ns
        return {number: seen.get(number) for number in self._watchers if number is not None}


def published(
    seen: dict[int | None, list[Seen]],
) -> Iterator[tuple[int | None, Seen]]:
    """What is worth a message: every pose, and once that an object is lost where nobody uses it."""
    things = [(person, thing) for person, found in seen.items() for thing in found]
    for name in dict.fromkeys(thing.name for _, thing in things):
        ours = [(person, thing) for person, thing in things if thing.name == name]
        placed = [one for one in ours if one[1].estimate.translation is not None]
        yield from placed or [max(ours, key=lambda one: _probability(*one))]


def _probability(_: int | None, thing: Seen) -> float:
    return thing.class_probabilities.get(thing.name, 0.0)


def _gone(last_ns: int, time_ns: int) -> bool:
    return not 0 <= time_ns - last_ns < PATIENCE_NS


def _depth(person: Person) -> float:
    return person.joints[Joint.HIP_CENTER][2]
