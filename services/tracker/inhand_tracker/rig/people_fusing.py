"""Makes one person of what several cameras see of them, with a number that stays.

fuser = PeopleFuser({"front": rig_from_front, "left": rig_from_left})
people = fuser.fuse([CameraPeople("front", time_ns, seen), …], time_ns)
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import numpy as np
from inhand_schemas.messages import Person

from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import ViewPull
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.people.cheapest_pairs import cheapest_pairs
from inhand_tracker.rig.agreement import FEWEST_JOINTS, Agreement
from inhand_tracker.rig.far_off import FarOff
from inhand_tracker.rig.joint_fusion import fuse_joints
from inhand_tracker.rig.kernels.fuse import mean_distance
from inhand_tracker.rig.parameters import DEFAULT_RIG, RigParameters
from inhand_tracker.rig.person_track import AS_THEY_ARE, FusedPerson, PersonTrack
from inhand_tracker.rig.sightings import STATES, CameraPeople, Sighting, sightings_of

_IMPOSSIBLE = 1e6
"""Cost of taking a sighting for a person who cannot be there."""


class PeopleFuser:
    """Fuses the people of a rig's cameras; ``places`` are the cameras', ``rig_from_camera``, in
    the frame of reference that the people then are in; they may change. The first one is believed
    where two disagree."""

    def __init__(
        self, places: Mapping[str, Placement], parameters: RigParameters = DEFAULT_RIG
    ) -> None:
        self._places = places
        self._parameters = parameters
        self._tracks: list[PersonTrack] = []
        self._next = 0
        self._agreement = Agreement(parameters)
        self._far_off = FarOff(parameters)
        self._compared_ns = 0
        self.pulls: list[list[ViewPull]] = []
        """By how much each camera has each person elsewhere, where that was just compared."""
        self._together: dict[tuple[int, int], int] = {}

    @property
    def left_out(self) -> Mapping[str, float]:
        """Cameras that are not where they are said to be, and by how many metres they are off."""
        return self._agreement.left_out

    def fuse(self, seen: Iterable[CameraPeople], time_ns: int) -> list[FusedPerson]:
        """Return the people at a time, by what each camera saw about then; those whom no camera
        sees are left out. A clock that went back starts anew."""
        self._forget(time_ns)
        sightings = {one.camera: sightings_of(one, self._places, self._parameters) for one in seen}
        trusted = {camera: people for camera, people in sightings.items() if not self._off(camera)}
        matched = self._match(trusted, time_ns)
        for camera in sightings.keys() - trusted.keys():
            self._match_camera(sightings[camera], matched)
        self._compare(sightings, matched, time_ns)
        people = []
        for track in self._tracks:
            believed = [one for one in matched[track.identity] if not self._off(one.camera)]
            if believed:
                people.append(track.take(believed, time_ns))
        self._tracks = [self._right_way_round(track) for track in self._tracks]
        self._merge(matched, time_ns)
        return people

    def _off(self, camera: str) -> bool:
        return camera in self._agreement.left_out

    def _forget(self, time_ns: int) -> None:
        if any(time_ns < track.time_ns for track in self._tracks):
            self._tracks = []
        patience_ns = self._parameters.patience_ns
        self._tracks = [one for one in self._tracks if time_ns - one.time_ns <= patience_ns]

    def _match(
        self, sightings: Mapping[str, Sequence[Sighting]], time_ns: int
    ) -> dict[int, list[Sighting]]:
        """Give each track what cameras see of it, by its number; who is none yet becomes one."""
        matched: dict[int, list[Sighting]] = {track.identity: [] for track in self._tracks}
        left = {camera: self._match_camera(people, matched) for camera, people in sightings.items()}
        for people in left.values():
            # Somebody new whom several cameras see at once is one person.
            for stranger in self._match_camera(people, matched):
                track = PersonTrack(self._next, stranger.joints, time_ns, self._parameters)
                self._next += 1
                self._tracks.append(track)
                matched[track.identity] = [stranger]
        return matched

    def _match_camera(
        self, people: Sequence[Sighting], matched: dict[int, list[Sighting]]
    ) -> list[Sighting]:
        """Add a camera's people to those whom they are ``matched`` with; returns the others."""
        if not people or not self._tracks:
            return list(people)
        costs = np.array(
            [[self._cost(track, one, matched) for one in people] for track in self._tracks]
        )
        left = set(range(len(people)))
        for row, column in cheapest_pairs(costs):
            if costs[row, column] < _IMPOSSIBLE:
                matched[self._tracks[row].identity].append(people[column])
                left.discard(column)
        return [people[column] for column in sorted(left)]

    def _cost(
        self, track: PersonTrack, sighting: Sighting, matched: Mapping[int, Sequence[Sighting]]
    ) -> float:
        if any(one.camera == sighting.camera for one in matched[track.identity]):
            return _IMPOSSIBLE
        away = track.distance(sighting)
        unseen_s = abs(sighting.time_ns - track.time_ns) / 1e9
        farthest = self._parameters.farthest_m + self._parameters.drift_m_s * unseen_s
        return away if away < farthest else _IMPOSSIBLE

    def _compare(
        self,
        sightings: Mapping[str, Sequence[Sighting]],
        matched: Mapping[int, Sequence[Sighting]],
        time_ns: int,
    ) -> None:
        """Watch whether the cameras agree; now and then is enough."""
        self.pulls = []
        if 0 <= time_ns - self._compared_ns < self._parameters.compared_every_ns:
            return
        self._compared_ns = time_ns
        tracks = [track for track in self._tracks if len(matched[track.identity]) > 1]
        nowhere = np.full((20, 3), np.nan)
        seen: dict[str, list[Array]] = {camera: [] for camera in sightings}
        for track in tracks:
            by_camera = {
                one.camera: one.joints + track.moved(time_ns - one.time_ns)
                for one in matched[track.identity]
            }
            for camera, joints in seen.items():
                joints.append(by_camera.get(camera, nowhere))
            pulls = self._pulls(by_camera)
            if pulls:
                self.pulls.append(pulls)
        if tracks:
            self._agreement.compare(
                {camera: seen[camera] for camera in self._places if camera in seen}, time_ns
            )
        self._compare_far(sightings, matched, time_ns)

    def _compare_far(
        self,
        sightings: Mapping[str, Sequence[Sighting]],
        matched: Mapping[int, Sequence[Sighting]],
        time_ns: int,
    ) -> None:
        """Watch whether the only person of a camera is that of most others, who are believed, or
        of the first one."""
        persons = {
            one.camera: seen
            for seen in matched.values()
            for one in seen
            if not self._off(one.camera)
        }
        cameras = [camera for camera in self._places if camera in persons]
        alone = all(len(sightings[camera]) == 1 for camera in cameras)
        others = max(cameras, key=lambda camera: len(persons[camera]), default="")
        for camera in self._places:
            if not alone or camera not in persons or persons[camera] is persons[others]:
                self._far_off.forget(camera)
                continue
            own, theirs = sightings[camera][0], sightings[others][0]
            off_m = self._far_off.compare(camera, own.joints, theirs.joints, time_ns)
            if off_m is not None:
                self._agreement.leave_out(camera, off_m)

    def _pulls(self, by_camera: Mapping[str, Array]) -> list[ViewPull]:
        """By how much cameras, those that agree by and large, have a person elsewhere than all of
        them have, by joints (20, 3) of each; none where they see few of the same."""
        trusted = {name: joints for name, joints in by_camera.items() if not self._off(name)}
        if len(trusted) < 2:
            return []
        each = np.stack(list(trusted.values()))
        common = np.isfinite(each).all(axis=(0, 2))
        if common.sum() < FEWEST_JOINTS:
            return []
        middle = each[:, common].mean(axis=0)
        at = middle.mean(axis=0)
        information = np.diag([self._parameters.body_place_m**-2.0] * 3 + [0.0] * 3)
        return [
            ViewPull(
                camera,
                at,
                np.concatenate((np.median(joints[common] - middle, axis=0), np.zeros(3))),
                information,
            )
            for camera, joints in trusted.items()
        ]

    def _merge(self, matched: Mapping[int, Sequence[Sighting]], time_ns: int) -> None:
        """Take two for one person, the one of before, whom no camera sees apart, and who have long
        been where one person is."""
        together: dict[tuple[int, int], int] = {}
        gone: set[int] = set()
        for one, other in combinations(self._tracks, 2):
            cameras = [{seen.camera for seen in matched[track.identity]} for track in (one, other)]
            if not all(cameras) or cameras[0] & cameras[1]:
                continue
            if mean_distance(one.joints, other.joints, AS_THEY_ARE) < self._parameters.same_m:
                pair = one.identity, other.identity
                together[pair] = self._together.get(pair, time_ns)
                if time_ns - together[pair] >= self._parameters.same_for_ns:
                    gone.add(other.identity)
        self._together = together
        self._tracks = [track for track in self._tracks if track.identity not in gone]

    def _right_way_round(self, track: PersonTrack) -> PersonTrack:
        """Exchange the sides of a person whom most cameras have long read the other way."""
        return track.exchanged() if track.is_turned else track


def compile_fusing() -> None:
    """Compile what the first frame of a rig would wait for."""
    nobody = np.zeros((2, 1, 3))
    fuse_joints(nobody, np.ones((2, 1)), nobody)
    mean_distance(np.zeros((20, 3)), np.zeros((20, 3)), AS_THEY_ARE)


def person_message(fused: FusedPerson) -> Person:
    """Write a fused person as a message, in the frame of reference that the joints are in."""
    seen = np.asarray(np.isfinite(fused.joints).all(axis=1))
    return Person(
        id=fused.identity,
        joints=tuple(
            (x, y, z) if there else (0.0, 0.0, 0.0)
            for there, (x, y, z) in zip(seen, fused.joints.tolist(), strict=True)
        ),
        states=tuple(
            STATES[state] if there else "missing"
            for there, state in zip(seen, fused.states.tolist(), strict=True)
        ),
        confidences=tuple(np.where(seen, fused.confidences, 0.0).tolist()),
    )
