"""From poses and skeletons to settled outcomes: what a daemon does, without its session."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, Skeletons

from inhand_outcomes.achievement import Achievement
from inhand_outcomes.gathering import NS_PER_S, Gathering, Holding, Sighting, Sightings
from inhand_outcomes.handling import handling
from inhand_outcomes.lasting import LastingOutcomes
from inhand_outcomes.outcome import Outcome, outcome_id
from inhand_outcomes.parameters import DEFAULT_GATHERING, GatheringParameters
from inhand_outcomes.room import LEVEL, Room
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_outcomes.uses import USES


@dataclass
class _Followed:
    """One object in one person's hands: what came of it, and what was said of it."""

    gathering: Gathering
    lasting: LastingOutcomes
    measured_ns: int
    said_until_ns: dict[str, int] = field(default_factory=dict)
    """Until when achievements of each kind are settled."""


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
        self._things = things
        self._place = place
        self._parameters = parameters
        self._sightings = Sightings(parameters)
        self._followed: dict[Holding, _Followed] = {}
        self._told: dict[str, dict[str, Outcome]] = {}
        """The last settled outcome of each object, by kind."""

    def hear_info(self, camera: str, info: CameraInfo) -> None:
        """Take note of where a camera stands."""
        self._sightings.hear_info(camera, info)

    def hear_skeletons(self, camera: str, skeletons: Skeletons) -> None:
        """Take the people of a frame."""
        self._sightings.hear_skeletons(camera, skeletons)

    def hear_pose(self, message: ObjectPose) -> list[Outcome]:
        """Take a pose; what is settled by now of its object and person."""
        found = self._sightings.sighting(message)
        if found is None:
            return []
        holding, sighting = found
        outcomes: list[Outcome] = []
        followed = self._followed.get(holding)
        if followed is not None and not followed.gathering.continues(sighting.time_ns):
            if abs(sighting.time_ns - followed.gathering.last_ns) <= self._gap_ns:
                return []  # a frame that was counted already
            outcomes = self._measure(holding, followed, ended=True)
            followed = None
        if followed is None:
            followed = _Followed(Gathering(self._parameters), self._lasting(), sighting.time_ns)
            self._followed[holding] = followed
        followed.gathering.add(sighting)
        if sighting.time_ns - followed.measured_ns >= NS_PER_S:
            followed.measured_ns = sighting.time_ns
            outcomes += self._measure(holding, followed, ended=False)
        return outcomes

    def end_quiet(self, now_ns: int) -> list[Outcome]:
        """Settle the tracks of which nothing came for long, by the clock of capture times."""
        quiet = [
            (holding, followed)
            for holding, followed in self._followed.items()
            if abs(now_ns - followed.gathering.last_ns) > self._gap_ns
        ]
        return self._end(quiet)

    def end_all(self) -> list[Outcome]:
        """Settle all tracks, at the end of what comes."""
        return self._end(list(self._followed.items()))

    def _lasting(self) -> LastingOutcomes:
        settle_s, piece_s = self._parameters.settle_s, self._parameters.piece_s
        return LastingOutcomes(settle_s * NS_PER_S, piece_s * NS_PER_S)

    @property
    def _gap_ns(self) -> float:
        return self._parameters.longest_gap_s * NS_PER_S

    def _end(self, ended: Iterable[tuple[Holding, _Followed]]) -> list[Outcome]:
        outcomes = []
        for holding, followed in ended:
            outcomes += self._measure(holding, followed, ended=True)
            del self._followed[holding]
        return outcomes

    def _measure(self, holding: Holding, followed: _Followed, *, ended: bool) -> list[Outcome]:
        """What is settled now of a track."""
        track = followed.gathering.track(holding.person, self.room)
        first_ns, last_ns = followed.gathering.first_ns, followed.gathering.last_ns
        found = [
            (achievement.lasting, self._outcome(holding, followed.gathering, achievement))
            for achievement in self._achievements(holding, followed, track)
        ]
        found.sort(key=lambda one: one[1].end_ns)
        settled_ns = last_ns if ended else last_ns - self._parameters.settle_s * NS_PER_S
        outcomes = []
        for lasts, outcome in found:
            said_until_ns = followed.said_until_ns.get(outcome.kind, first_ns)
            if not lasts and outcome.start_ns >= said_until_ns and outcome.end_ns <= settled_ns:
                followed.said_until_ns[outcome.kind] = outcome.end_ns
                outcomes.append(outcome)
        lasting = [outcome for lasts, outcome in found if lasts]
        outcomes += followed.lasting.follow(lasting, last_ns, ended=ended)
        self._told.setdefault(holding.object, {}).update({one.kind: one for one in outcomes})
        return outcomes

    def _achievements(
        self, holding: Holding, followed: _Followed, track: Track
    ) -> Iterator[Achievement]:
        """What the measures find in a track, times counted from its first frame."""
        thing = self._things.get(holding.object)
        if thing is None:
            return
        yield from handling(track, thing)
        use = USES.get(thing.use)
        counted_s = (followed.lasting.counted_ns - followed.gathering.first_ns) / NS_PER_S
        uncounted = track[track.times >= counted_s]
        if use is not None and len(uncounted) > 1:
            done = use.measure(uncounted, thing)
            if use.complete is not None:
                done = use.complete(done, self._earlier(holding, followed.gathering.first_ns))
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
            for outcome in self._told.get(holding.object, {}).values()
        ]

    def _outcome(self, holding: Holding, gathering: Gathering, achievement: Achievement) -> Outcome:
        start_ns, end_ns = (
            gathering.first_ns + round(seconds * NS_PER_S)
            for seconds in (achievement.start_s, achievement.end_s)
        )
        shown = [one for one in gathering.sightings if start_ns <= one.time_ns <= end_ns]
        last = shown[-1] if shown else gathering.sightings[-1]
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
            rig_from_object=pose_message(last),
            first_sequence=shown[0].sequence if shown else last.sequence,
            last_sequence=last.sequence,
        )


def pose_message(sighting: Sighting) -> Pose:
    """Where the object was in a sighting, in the rig."""
    x, y, z, *rotation = sighting.pose.tolist()
    w, i, j, k = rotation
    return Pose((x, y, z), (w, i, j, k))
