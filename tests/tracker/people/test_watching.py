"""Several people, each with what they use."""

import numpy as np
from inhand_schemas.messages import Person
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.people.following import PeopleWatched, worth_publishing
from inhand_tracker.people.watching import (
    CameraFrame,
    GivenObjects,
    RecognisedObjects,
    WatchedObject,
)
from inhand_tracker.recognition.recognition import Recognition
from people import FRAME_NS, STANDING

HERE = Estimate("tracked", 1.0, np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.eye(6))


class Scripted:
    """A cascade that says what it is told to."""

    def __init__(self, *answers: Recognition | Exception) -> None:
        self.answers = list(answers)
        self.restarts = 0

    def restart(self) -> None:
        self.restarts += 1

    def step(self, *_: object) -> Recognition:
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def remember(self, *_: object) -> None:
        self.step()

    def outline(self, *_: object) -> None:
        return None


def see(watcher, failures=None):
    on_failure = (lambda *_: None) if failures is None else lambda *told: failures.append(told)
    return watcher.see(STANDING, CameraFrame(FRAME_NS), on_failure)


def test_the_known_object_has_a_pose_and_all_tell_the_probabilities() -> None:
    answer = Recognition(np.array([0.2, 0.6, 0.1]), 1, HERE)
    watcher = RecognisedObjects(Scripted(answer), ["mug", "phone", "mug"])
    mug, phone = see(watcher)
    assert (mug.name, mug.estimate.state) == ("mug", "lost")
    assert (phone.name, phone.estimate) == ("phone", HERE)
    for seen in (mug, phone):
        assert {k: round(v, 9) for k, v in seen.class_probabilities.items()} == {
            "mug": 0.3,
            "phone": 0.6,
        }


def test_a_cascade_that_fails_is_told_restarted_and_loses_a_frame() -> None:
    failing = Scripted(ZeroDivisionError("a bug"), Recognition(np.array([0.9]), 0, HERE))
    watcher, failures = RecognisedObjects(failing, ["mug"]), []
    assert [seen.estimate.state for seen in see(watcher, failures)] == ["lost"]
    assert (failing.restarts, str(failures[0][1])) == (1, "a bug")
    assert [seen.estimate.state for seen in see(watcher)] == ["tracked"]


def test_every_pose_is_published_and_an_unused_object_is_lost_once() -> None:
    found = {
        0: [WatchedObject("mug", HERE), WatchedObject("phone"), WatchedObject("pan")],
        1: [
            WatchedObject("mug", HERE),
            WatchedObject("phone", HERE),
            WatchedObject("pan", LOST, None, {"pan": 0.4}),
        ],
    }
    told = [(person, seen.name, seen.estimate.state) for person, seen in worth_publishing(found)]
    assert told == [
        (0, "mug", "tracked"),
        (1, "mug", "tracked"),
        (1, "phone", "tracked"),
        (1, "pan", "lost"),
    ]


def person(number: int, x: float) -> Person:
    joints = STANDING + np.array([x, 0.0, 0.0])
    return Person(
        id=number,
        joints=tuple(map(tuple, joints.tolist())),
        states=("tracked",) * 20,
        confidences=(1.0,) * 20,
    )


class Still:
    """A tracker of a thing that never moves; it keeps when, and with which effort."""

    effort = 1.0

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        self.stepped: list[tuple[int, float]] = []
        self.remembered: list[int] = []

    def remember_joints(self, joints: np.ndarray, time_ns: int) -> None:
        if self.remembered:
            raise ZeroDivisionError("a bug")
        self.remembered.append(time_ns)

    def step(self, joints: object, time_ns: int, *_: object) -> Estimate:
        self.stepped.append((time_ns, self.effort))
        return LOST if joints is None else HERE

    def outline(self, *_: object) -> None:
        return None


def test_no_more_people_are_watched_than_asked_for_and_who_leaves_makes_room() -> None:
    watched = PeopleWatched(lambda: GivenObjects({"mug": Still()}), 2)

    def numbers(people: list[Person], second: float) -> set[int | None]:
        frame = CameraFrame(round(second * 1e9))
        return set(watched.see(people, frame, lambda *_: None))

    assert numbers([], 0.0) == {None}
    three = [person(1, -1.0), person(2, 0.0), person(3, 1.0)]
    assert numbers(three, 0.1) == {0, 1}
    assert numbers(three[1:], 0.2) == {0, 1}
    assert numbers(three[1:], 2.0) == {0, 1}
    assert numbers(three[1:], 2.2) == {1, 2}


def test_frames_that_are_skipped_are_remembered_by_whom_they_are_of() -> None:
    trackers = {1: Still(), 2: Still()}
    idle = list(trackers.values())
    watched = PeopleWatched(lambda: GivenObjects({"mug": idle.pop(0)}), 2)
    watched.see([person(1, 0.0)], CameraFrame(0), fail)
    watched.remember([person(1, 0.0), person(2, 1.0)], FRAME_NS, fail)
    assert [still.remembered for still in trackers.values()] == [[FRAME_NS], [FRAME_NS]]
    watched.remember([], 2 * FRAME_NS, fail)
    assert set(watched.see([], CameraFrame(3 * FRAME_NS), fail)) == {0, 1}


def fail(name: str, error: Exception) -> None:
    raise AssertionError(name) from error


def test_an_object_that_cannot_remember_starts_afresh_and_stops_no_other() -> None:
    failing, well, failures = Still(), Still(), []
    failing.remembered = [0]
    watcher = GivenObjects({"mug": failing, "pan": well})
    watcher.remember(STANDING, FRAME_NS, lambda *told: failures.append(told))
    assert [(name, str(error)) for name, error in failures] == [("mug", "a bug")]
    assert (failing.remembered, well.remembered) == ([], [FRAME_NS])


def test_a_cascade_that_cannot_remember_starts_afresh() -> None:
    failing, failures = Scripted(ZeroDivisionError("a bug")), []
    watcher = RecognisedObjects(failing, ["mug"])
    watcher.remember(STANDING, FRAME_NS, lambda *told: failures.append(told))
    assert (failing.restarts, len(failures)) == (1, 1)


def test_trackers_take_the_effort_that_a_frame_is_worth() -> None:
    still, cascade = Still(), Scripted(Recognition(np.array([0.9]), 0, HERE))
    for watcher in (GivenObjects({"mug": still}), RecognisedObjects(cascade, ["mug"])):
        watcher.see(STANDING, CameraFrame(FRAME_NS, effort=0.5), fail)
    assert still.stepped == [(FRAME_NS, 0.5)]
    assert cascade.effort == 0.5
