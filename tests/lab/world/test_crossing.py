"""Two people who cross keep who they are, whatever the camera calls them."""

import numpy as np
import pytest
from crossing import cross
from inhand_tracker.geometry.estimate import LOST
from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.people.identities import Identities
from inhand_tracker.people.watching import CameraFrame, WatchedObject


class Notes:
    """A watcher that notes where the person is whom it watches."""

    names = ("thing",)
    needs_hips = True

    def __init__(self) -> None:
        self.hips: list[np.ndarray | None] = []

    def restart(self) -> None:
        self.hips.clear()

    def see(self, joints, *_):
        self.hips.append(None if joints is None else joints[0])
        return [WatchedObject("thing", LOST)]


@pytest.mark.long
@pytest.mark.parametrize("seed", range(20))
def test_identities_are_not_exchanged_where_two_people_cross(seed: int) -> None:
    identities = Identities()
    given: dict[int, set[int]] = {0: set(), 1: set()}
    exchanged = hidden = 0
    for frame in cross(seed):
        found = identities.assign(frame.people, frame.time_ns)
        hidden += len(frame.people) < 2
        for person, who in zip(frame.people, frame.who, strict=True):
            exchanged += person.id != who
            given[who] |= {number for number, one in found.items() if one is person}
    assert [len(numbers) for numbers in given.values()] == [1, 1]
    assert given[0] != given[1]
    assert hidden > 5
    assert (exchanged > 30) == (seed % 2 == 1)


@pytest.mark.long
def test_each_of_two_people_is_watched_by_one_watcher_throughout() -> None:
    made: list[Notes] = []

    def new_watcher() -> Notes:
        made.append(Notes())
        return made[-1]

    watched = PeopleWatched(new_watcher, 2)
    for frame in cross(1):
        watched.see(frame.people, CameraFrame(frame.time_ns), lambda *_: None)
    assert len(made) == 2
    for notes in made:
        places = np.array([place for place in notes.hips if place is not None])
        assert len(places) > 200
        assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 0.6
        assert abs(places[-1, 0] - places[0, 0]) > 1.5
