"""From poses and skeletons to settled outcomes: what a daemon does, without its session."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, Skeletons

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.days import NS_PER_S
from inhand_outcomes.false_starts import without_false_starts
from inhand_outcomes.gathering import Gathering, Holding, Sighting, Sightings
from inhand_outcomes.handling import DROPPED, LEFT_IN_USE, PLACE, PUT_DOWN, handling
from inhand_outcomes.in_hand import in_hand
from inhand_outcomes.lasting import LastingOutcomes
from inhand_outcomes.leaps import without_leaps
from inhand_outcomes.outcome import Outcome, outcome_id
from inhand_outcomes.parameters import DEFAULT_GATHERING, GatheringParameters
from inhand_outcomes.room import LEVEL, Room
from inhand_outcomes.swept_floors import SweptFloors
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_outcomes.uses import USES
from inhand_outcomes.waiting_poses import WaitingPoses

HANDED_OVER = "handed_over"
SWEEPING = "sweeping"
"""The use of which a map of the floor is kept."""


@dataclass
class Followed:
    """One object in one person's hands: what came of it, and what was said of it."""

    gathering: Gathering
    lasting: LastingOutcomes
    measured_ns: int
    said_until_ns: dict[str, int] = field(default_factory=dict)
    """Until when achievements of each kind are settled."""
    used: float = 0.0
    """How probably it was taken up, used or taken over since this began, and not put down since."""


class Watcher:
    """Follows all objects, and says what was achieved once it is settled.

    ``place`` names the rig, for the ids. Messages of each stream come in the order of their
    capture; what comes late or twice is passed over.
    """

    def __init__(
        self,
        things: Mapping[str, Thing],
        place: str,
        parameters: GatheringParameters = DEFAULT_GATHERING,
    ) -> None:
        self.room: Room = LEVEL
        self.floors = SweptFloors()
        self.things = things
        self._place = place
        self._parameters = parameters
        self._sightings = Sightings(parameters)
        self._waiting = WaitingPoses(parameters.frames_that_wait)
        self.followed: dict[Holding, Followed] = {}
        self.told: dict[str, dict[str, Outcome]] = {}
        """The last settled outcome of each object, by kind."""

    def hear_info(self, camera: str, info: CameraInfo) -> None:
        """Take note of where a camera stands."""
        self._sightings.hear_info(camera, info)

    def hear_skeletons(self, camera: str, skeletons: Skeletons) -> list[Outcome]:
        """Take the people of a frame; what is settled by poses that waited for them."""
        self._sightings.hear_skeletons(camera, skeletons)
        return self._follow_all(self._waiting.take(camera, skeletons.time_ns))

    def hear_pose(self, message: ObjectPose) -> list[Outcome]:
        """Take a pose; what is settled by now of its object and person."""
        if message.person is None or self._sightings.knows(message.camera, message.time_ns):
            return self._follow(message)
        return self._follow_all(self._waiting.put(message))

    def _follow_all(self, messages: Iterable[ObjectPose]) -> list[Outcome]:
        return [outcome for message in messages for outcome in self._follow(message)]

    def _follow(self, message: ObjectPose) -> list[Outcome]:
        holding = Holding(message.object, message.person)
        followed = self.followed.get(holding)
        last = None if followed is None else followed.gathering.sightings[-1]
        sighting = self._sightings.sighting(message, last)
        if sighting is None:
            return []
        outcomes: list[Outcome] = []
        if followed is not None and not followed.gathering.continues(sighting.time_ns):
            if abs(sighting.time_ns - followed.gathering.last_ns) <= self._gap_ns:
                return []  # a frame that was counted already
            outcomes = self._measure(holding, followed, ended=True)
            followed = None
        if followed is None:
            followed = self.follow(holding, sighting.time_ns)
        followed.gathering.add(sighting)
        if sighting.time_ns - followed.measured_ns >= NS_PER_S:
            followed.measured_ns = sighting.time_ns
            outcomes += self._measure(holding, followed, ended=False)
        return outcomes

    def end_quiet(self, now_ns: int) -> list[Outcome]:
        """Settle the tracks of which nothing came for long, by the clock of capture times."""
        outcomes = self._follow_all(self._waiting.take_all())
        quiet = [
            (holding, followed)
            for holding, followed in self.followed.items()
            if abs(now_ns - followed.gathering.last_ns) > self._gap_ns
        ]
        return outcomes + self._end(quiet)

    def forget(self) -> None:
        """Know nothing of what came until now."""
        self.followed.clear()
        self.told.clear()
        self.floors.forget()

    def end_all(self) -> list[Outcome]:
        """Settle all tracks, at the end of what comes."""
        outcomes = self._follow_all(self._waiting.take_all())
        return outcomes + self._end(list(self.followed.items()))

    def follow(self, holding: Holding, time_ns: int) -> Followed:
        """Follow an object in a person's hands from a capture time on."""
        settle_s, piece_s = self._parameters.settle_s, self._parameters.piece_s
        lasting = LastingOutcomes(settle_s * NS_PER_S, piece_s * NS_PER_S)
        self.followed[holding] = Followed(Gathering(self._parameters), lasting, time_ns)
        return self.followed[holding]

    @property
    def _gap_ns(self) -> float:
        return self._parameters.longest_gap_s * NS_PER_S

    def _end(self, ended: Iterable[tuple[Holding, Followed]]) -> list[Outcome]:
        outcomes = []
        for holding, followed in ended:
            outcomes += self._measure(holding, followed, ended=True)
            del self.followed[holding]
        return outcomes

    def _taken_over(self, holding: Holding, last: Sighting) -> int | None:
        """The person in whose hands an object is found where another's track of it has ended."""
        for other, followed in self.followed.items():
            if other.object != holding.object or other.person in (None, holding.person):
                continue
            first = next(
                (one for one in followed.gathering.sightings if one.time_ns > last.time_ns), None
            )
            if first is None or first.time_ns - last.time_ns > self._gap_ns:
                continue
            distance = float(np.linalg.norm(first.pose[:3] - last.pose[:3]))
            if distance < self._parameters.handed_within_m:
                return other.person
        return None

    def _measure(self, holding: Holding, followed: Followed, *, ended: bool) -> list[Outcome]:
        """What is settled now of a track."""
        track = self._track(holding, followed)
        first_ns, last_ns = followed.gathering.first_ns, followed.gathering.last_ns
        sightings = list(followed.gathering.sightings)
        found = [
            (achievement.lasting, self._outcome(holding, sightings, achievement))
            for achievement in self._achievements(holding, followed, track, ended=ended)
        ]
        found.sort(key=lambda one: one[1].end_ns)
        settled_ns = last_ns if ended else last_ns - self._parameters.settle_s * NS_PER_S
        outcomes = []
        for lasts, outcome in found:
            said_until_ns = followed.said_until_ns.get(outcome.kind, first_ns - 1)
            is_new = outcome.start_ns >= said_until_ns and outcome.end_ns > said_until_ns
            if not lasts and is_new and outcome.end_ns <= settled_ns:
                followed.said_until_ns[outcome.kind] = outcome.end_ns
                outcomes.append(outcome)
        lasting = [outcome for lasts, outcome in found if lasts]
        outcomes += followed.lasting.follow(lasting, last_ns, ended=ended)
        outcomes = [self._gone(holding, followed, outcome) for outcome in _by_end(outcomes)]
        self.told.setdefault(holding.object, {}).update({one.kind: one for one in outcomes})
        return outcomes

    def _track(self, holding: Holding, followed: Followed) -> Track:
        track, thing = followed.gathering.track(self.room), self.things.get(holding.object)
        return track if thing is None else without_leaps(track, thing)

    def _gone(self, holding: Holding, followed: Followed, outcome: Outcome) -> Outcome:
        """What was left in use is handed over, where somebody else has it then; else it is as
        probable as that it was in use: what only lay near a hand was not.

        Outcomes come in the order in which they ended.
        """
        if outcome.kind != LEFT_IN_USE:
            if outcome.kind in (PUT_DOWN, DROPPED):
                followed.used *= 1.0 - outcome.probability
            else:
                followed.used = max(followed.used, outcome.probability)
            return outcome
        receiver = self._taken_over(holding, followed.gathering.sightings[-1])
        if receiver is None:
            evidence = {**outcome.evidence, "used": followed.used}
            probability = outcome.probability * followed.used
            return replace(outcome, probability=probability, evidence=evidence)
        received = self.followed[Holding(holding.object, receiver)]
        received.used = max(received.used, outcome.probability)
        evidence = {**outcome.evidence, "receiver": float(receiver)}
        return replace(outcome, kind=HANDED_OVER, evidence=evidence)

    def _achievements(
        self, holding: Holding, followed: Followed, track: Track, *, ended: bool
    ) -> Iterator[Achievement]:
        """What the measures find in a track, times counted from its first frame."""
        thing = self.things.get(holding.object)
        if thing is None:
            return
        yield from handling(track, thing, ended=ended)
        use = USES.get(thing.use)
        counted_s = (followed.lasting.counted_ns - followed.gathering.first_ns) / NS_PER_S
        track = without_false_starts(track)
        uncounted = track[track.times >= counted_s]
        if use is not None and len(uncounted) > 1:
            done = use.measure(uncounted, thing)
            if use.in_hand:
                done = in_hand(done, uncounted, thing)
            if use.complete is not None:
                done = use.complete(done, self._earlier(holding, followed.gathering.first_ns))
            if thing.use == SWEEPING:
                for one in done:
                    self.floors.sweep(holding, uncounted, thing, one.start_s, one.end_s)
            yield from done

    def _earlier(self, holding: Holding, first_ns: int) -> list[Achievement]:
        """What was settled of an object before, as achievements of a track that began then."""
        return [
            Achievement(
                outcome.kind,
                (outcome.start_ns - first_ns) / NS_PER_S,
                (outcome.end_ns - first_ns) / NS_PER_S,
                outcome.probability,
                outcome.amounts,
                outcome.evidence,
            )
            for outcome in self.told.get(holding.object, {}).values()
        ]

    def _outcome(
        self, holding: Holding, sightings: Sequence[Sighting], achievement: Achievement
    ) -> Outcome:
        start_ns, end_ns = (
            sightings[0].time_ns + round(seconds * NS_PER_S)
            for seconds in (achievement.start_s, achievement.end_s)
        )
        first = bisect_left(sightings, start_ns, key=_time_of)
        end = bisect_right(sightings, end_ns, key=_time_of)
        last = sightings[end - 1] if first < end else sightings[-1]
        return Outcome(
            id=outcome_id(self._place, achievement.kind, holding.object, holding.person, start_ns),
            kind=achievement.kind,
            object=holding.object,
            person=holding.person,
            start_ns=start_ns,
            end_ns=end_ns,
            probability=achievement.probability,
            amounts=achievement.amounts,
            evidence=achievement.evidence,
            rig_from_object=self._pose_at_end(achievement, sightings[first:end] or [last]),
            first_sequence=sightings[first].sequence if first < end else last.sequence,
            last_sequence=last.sequence,
        )

    def _pose_at_end(self, achievement: Achievement, sightings: Sequence[Sighting]) -> Pose:
        """Where the object was at the end, in the rig: where it lies, if that was measured."""
        if not achievement.amounts.keys() >= PLACE:
            return _pose_message(sightings[-1])
        place = np.array([achievement.amounts[axis].value for axis in sorted(PLACE)])
        place = (place - self.room.translation) @ self.room.matrix
        nearest = min(sightings, key=lambda one: float(np.linalg.norm(one.pose[:3] - place)))
        return _pose_message(replace(nearest, pose=np.concatenate([place, nearest.pose[3:]])))


def _by_end(outcomes: Iterable[Outcome]) -> list[Outcome]:
    """Outcomes in the order in which they ended; what was left is judged by all others."""
    return sorted(outcomes, key=lambda one: (one.kind == LEFT_IN_USE, one.end_ns))


def _time_of(sighting: Sighting) -> int:
    return sighting.time_ns


def _pose_message(sighting: Sighting) -> Pose:
    """Where the object was in a sighting, in the rig."""
    x, y, z, *rotation = sighting.pose.tolist()
    w, i, j, k = rotation
    return Pose((x, y, z), (w, i, j, k))
