"""Chooses whose objects are followed when several people are in view."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_schemas.messages import Person

from inhand_tracker.body.skeleton import PELVIS_JOINTS
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.people.identities import Identities
from inhand_tracker.people.parameters import DEFAULT_PEOPLE, PeopleParameters
from inhand_tracker.people.watching import CameraFrame, OnFailure, WatchedObject, Watcher
from inhand_tracker.wire.conversion import joints_of

WHOLE_PLACE = (Joint.HIP_CENTER,)
UPPER_PLACE = (Joint.HIP_CENTER, Joint.SHOULDER_CENTER)
"""Joints whose depth is a person's, the first that is seen."""


class PersonFollower:
    """Follows one person by the camera's id; when that one is gone for two seconds, the nearest.

    Nobody is chosen whose hips are hidden, but where trackers do not need them (``needs_hips``).
    """

    def __init__(
        self, parameters: PeopleParameters = DEFAULT_PEOPLE, *, needs_hips: bool = True
    ) -> None:
        self._place_joints = WHOLE_PLACE if needs_hips else UPPER_PLACE
        self.person_id: int | None = None
        self._patience_ns = parameters.patience_ns
        self._seen_ns = 0

    def choose(self, people: Sequence[Person], time_ns: int) -> Person | None:
        """Choose whom to follow of the people in a frame; None while that one is out of view."""
        chosen = next((person for person in people if person.id == self.person_id), None)
        away = _is_gone(self._seen_ns, time_ns, self._patience_ns)
        if chosen is None and (self.person_id is None or away):
            chosen = _nearest(people, self._place_joints)
        if chosen is not None:
            self.person_id, self._seen_ns = chosen.id, time_ns
        return chosen


class PeopleWatched:
    """Watches several people at once, ``most`` at the most, each by a watcher of their own.

    Of one alone it is the person that ``PersonFollower`` chooses, by the camera's id. Several keep
    their own numbers (``Identities``), whatever the camera calls them; who is gone for two seconds
    makes room, and the nearest stranger is next.
    """

    def __init__(
        self,
        new_watcher: Callable[[], Watcher],
        most: int,
        parameters: PeopleParameters = DEFAULT_PEOPLE,
    ) -> None:
        self._most = most
        self._new_watcher = new_watcher
        self._idle = [new_watcher()]
        self.names = self._idle[0].names
        self._patience_ns = parameters.patience_ns
        needs_hips = self._idle[0].needs_hips
        self._place_joints = WHOLE_PLACE if needs_hips else UPPER_PLACE
        self._follower = PersonFollower(parameters, needs_hips=needs_hips)
        self._identities = Identities(parameters, needs_hips=needs_hips)
        self._watchers: dict[int | None, Watcher] = {}
        self._seen_ns: dict[int | None, int] = {}
        self._needs_hips = needs_hips
        self._hips_lack: tuple[str, ...] | None = None

    @property
    def hips_trouble(self) -> str | None:
        """What the models need and nobody has shown yet; None where nothing is."""
        if not self._needs_hips or not self._hips_lack:
            return None
        return (
            f"people are seen without {', '.join(self._hips_lack)}, which the models need: train "
            "them with recordings of upper bodies, or see to it that the hips are in view"
        )

    def see(
        self, people: Sequence[Person], frame: CameraFrame, on_failure: OnFailure
    ) -> dict[int | None, list[WatchedObject]]:
        """Watch a frame: the objects of each watched person, by the person's number."""
        chosen = self._choose(people, frame.time_ns)
        if not chosen:
            return {None: [WatchedObject(name) for name in self.names]}
        return {
            number: self._watchers[number].see(
                None if person is None else joints_of(person), frame, on_failure
            )
            for number, person in chosen.items()
        }

    def considered(self) -> Iterator[tuple[int | None, str, Considered]]:
        """What the poses in the last frame were chosen from: the person's number, the object, and
        what was considered."""
        for number, watcher in self._watchers.items():
            for name, considered in watcher.considered().items():
                yield number, name, considered

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of people's joints; None where nothing is."""
        troubles = (watcher.trouble for watcher in self._watchers.values())
        return next((trouble for trouble in troubles if trouble is not None), None)

    def remember(self, people: Sequence[Person], time_ns: int, on_failure: OnFailure) -> None:
        """Take a frame that is skipped: who is who, and what bodies did, counts later."""
        for number, person in self._choose(people, time_ns).items():
            if person is not None:
                self._watchers[number].remember(joints_of(person), time_ns, on_failure)

    def _choose(self, people: Sequence[Person], time_ns: int) -> dict[int | None, Person | None]:
        """Choose who is watched, by their numbers; None for those out of view."""
        self._note_hips(people)
        choose = self._choose_one if self._most == 1 else self._choose_several
        return choose(people, time_ns)

    def _note_hips(self, people: Sequence[Person]) -> None:
        """Note the joints of the pelvis that people lack, until somebody has shown it whole."""
        if self._hips_lack == ():
            return
        lacking = [
            tuple(JOINT_NAMES[j] for j in PELVIS_JOINTS if person.states[j] == "missing")
            for person in people
            if any(state != "missing" for state in person.states)
        ]
        if lacking:
            self._hips_lack = min(lacking, key=len)

    def _choose_one(
        self, people: Sequence[Person], time_ns: int
    ) -> dict[int | None, Person | None]:
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

    def _choose_several(
        self, people: Sequence[Person], time_ns: int
    ) -> dict[int | None, Person | None]:
        in_view = self._identities.assign(people, time_ns)
        self._release_watchers(time_ns)
        for number in sorted(in_view, key=lambda one: _depth(in_view[one], self._place_joints)):
            if number not in self._watchers and len(self._watchers) < self._most:
                self._watchers[number] = self._idle.pop() if self._idle else self._new_watcher()
            if number in self._watchers:
                self._seen_ns[number] = time_ns
        return {number: in_view.get(number) for number in self._watchers if number is not None}

    def _release_watchers(self, time_ns: int) -> None:
        """Free the watchers of people who are gone."""
        for number, seen_ns in list(self._seen_ns.items()):
            if _is_gone(seen_ns, time_ns, self._patience_ns):
                watcher = self._watchers.pop(number)
                del self._seen_ns[number]
                watcher.restart()
                self._idle.append(watcher)


def worth_publishing(
    objects: Mapping[int | None, Sequence[WatchedObject]],
) -> Iterator[tuple[int | None, WatchedObject]]:
    """Choose what of people's objects is worth a message: every pose, and every lost object once.

    An object that nobody uses is lost with the probabilities of whoever most probably uses it.
    """
    everything = [(person, thing) for person, theirs in objects.items() for thing in theirs]
    for name in dict.fromkeys(thing.name for _, thing in everything):
        same = [(person, thing) for person, thing in everything if thing.name == name]
        placed = [one for one in same if one[1].estimate.translation is not None]
        yield from placed or [max(same, key=lambda one: _probability(one[1]))]


def _probability(thing: WatchedObject) -> float:
    return thing.class_probabilities.get(thing.name, 0.0)


def _is_gone(seen_ns: int, time_ns: int, patience_ns: int) -> bool:
    """Whether somebody last seen at a time is gone; also when the clock went back."""
    return not 0 <= time_ns - seen_ns < patience_ns


def _nearest(people: Sequence[Person], place_joints: Sequence[int]) -> Person | None:
    """The person with the least depth, by the first of some joints that is seen of each."""
    visible = [person for person in people if np.isfinite(_depth(person, place_joints))]
    return min(visible, key=lambda person: _depth(person, place_joints), default=None)


def _depth(person: Person, place_joints: Sequence[int]) -> float:
    """The depth of the first of some joints that is seen; infinite where none is."""
    for joint in place_joints:
        if person.states[joint] != "missing" and any(person.joints[joint]):
            return person.joints[joint][2]
    return np.inf
