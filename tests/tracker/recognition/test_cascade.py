"""Which objects the cascade follows, and where it says one is, as recognition comes and goes."""

from types import SimpleNamespace

import numpy as np
import pytest
from inhand_tracker.body.skeleton import body_pose, pelvis_basis
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.people.watching import CameraFrame, RecognisedObjects
from inhand_tracker.recognition import cascade as cascade_module
from inhand_tracker.recognition.cascade import Cascade, worth_following
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION
from inhand_tracker.recognition.presence import usual_presence
from inhand_tracker.sight.support import Support
from people import FRAME_NS, STANDING, STANDING_HEIGHT

CAMERA = Intrinsics(500.0, 500.0, 320.0, 240.0, 640, 480)
ACTIONS = 4
TURN = DEFAULT_RECOGNITION.turn_frames
STANDING_POSE = body_pose(STANDING, pelvis_basis(STANDING), STANDING_HEIGHT)[None]


class AtPixel:
    """A tracker of an object whose box is a square around one pixel; it keeps what it saw."""

    effort = 1.0
    learned_as = None

    def __init__(self, left: float) -> None:
        self.left = left
        self.confidence = 1.0
        self.support: Support | None = None
        self.considers = Considered(np.zeros((0, 3)), np.zeros((0, 4)), np.zeros(0), {})
        self.restart()

    def considered(self) -> Considered:
        return self.considers

    def restart(self) -> None:
        self.seen: list[int] = []
        self.images: list[object] = []
        self.remembered: list[int] = []
        self.efforts: list[float] = []

    def remember(self, body: object, time_ns: int) -> None:
        self.remembered.append(time_ns)

    def step_body(self, body: object, time_ns: int, image: object = None) -> Estimate:
        self.seen.append(time_ns)
        self.images.append(image)
        self.efforts.append(self.effort)
        unturned = np.array([1.0, 0.0, 0.0, 0.0])
        return Estimate("tracked", self.confidence, np.zeros(3), unturned, np.eye(6))

    def step(self, joints: object, time_ns: int, image: object = None) -> Estimate:
        return self.step_body(None, time_ns, image)

    def outline(self, estimate: Estimate, camera: Intrinsics) -> np.ndarray:
        return np.array([[self.left, 0.0], [self.left + 10.0, 10.0]])


@pytest.fixture
def told() -> list:
    """The evidence of images that the recogniser was told, frame by frame."""
    return []


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch, told: list) -> list[list[float]]:
    """The probabilities that the recogniser will tell, frame by frame."""
    frames: list[list[float]] = []

    class Told:
        def __init__(self, *_: object) -> None:
            pass

        def restart(self) -> None:
            pass

        def remember(self, time_ns: int, body: object) -> None:
            told.append("remembered")

        def step(self, time_ns: int, body: object, seen: np.ndarray | None) -> np.ndarray:
            told.append(seen)
            shares = np.array(frames.pop(0))
            return np.append(shares, 1.0 - shares.sum())

    monkeypatch.setattr(cascade_module, "MovementRecogniser", Told)
    return frames


def new_cascade() -> tuple[Cascade, list[AtPixel]]:
    trackers = [AtPixel(100.0 * action) for action in range(ACTIONS)]
    learned = SimpleNamespace(
        movements=None,
        temper=1.0,
        body_poses=STANDING_POSE,
        presence=usual_presence(ACTIONS),
    )
    return Cascade(learned, trackers), trackers


def fail(name: str, error: Exception) -> None:
    raise AssertionError(name) from error


def run(cascade: Cascade, frames: int, *, image: Image | None = None, first: int = 0) -> list:
    return [
        cascade.step(STANDING, (first + frame + 1) * FRAME_NS, image, CAMERA)
        for frame in range(frames)
    ]


def look(cascade: Cascade, frames: int, *, first: int = 0) -> list:
    """The same with images."""
    return run(cascade, frames, image=Image(None, CAMERA), first=first)


@pytest.mark.parametrize(
    ("probabilities", "expected"),
    [
        ((0.1, 0.6, 0.2, 0.1), [1, 2]),
        ((0.1, 0.8, 0.1, 0.0), [1]),
        ((0.0, 0.1, 0.0, 0.0), [1]),
        ((0.3, 0.0, 0.3, 0.31), [3, 0]),
    ],
)
def test_the_likeliest_is_worth_following_and_others_that_are_likely_enough(
    probabilities: tuple[float, ...], expected: list[int]
) -> None:
    assert worth_following(np.array(probabilities)) == expected


def test_before_anything_was_known_the_box_is_that_of_the_likeliest(script) -> None:
    script += [[0.1, 0.3, 0.0, 0.0]]
    cascade, trackers = new_cascade()
    (answer,) = run(cascade, 1)
    assert answer.known is None
    assert answer.box[0] == 100.0
    assert [len(tracker.seen) for tracker in trackers] == [1, 1, 0, 0]


def test_the_object_that_was_used_last_is_followed_while_others_are_likelier(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0], *[[0.0, 0.4, 0.2, 0.0]] * 30, [0.9, 0.0, 0.0, 0.0]]
    cascade, trackers = new_cascade()
    answers = run(cascade, 32)
    assert [answer.known for answer in answers] == [0, *[None] * 30, 0]
    assert len(trackers[0].seen) == 32
    assert [len(tracker.seen) for tracker in trackers[1:]] == [30, 30, 0]


def test_what_is_doubted_for_a_moment_keeps_its_pose_and_is_not_known(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0], [0.3, 0.3, 0.0, 0.0], [0.1, 0.0, 0.0, 0.0]]
    cascade, _ = new_cascade()
    watcher = RecognisedObjects(cascade, ["mug", "phone", "broom", "shoe"])
    answers = run(cascade, 3)
    assert [answer.known for answer in answers] == [0, None, None]
    assert [answer.estimate.state for answer in answers] == ["tracked", "tracked", "lost"]
    script += [[0.9, 0.0, 0.0, 0.0], [0.3, 0.3, 0.0, 0.0]]
    for frame in (4, 5):
        seen = watcher.see(STANDING, CameraFrame(frame * FRAME_NS), fail)
    assert [one.estimate.state for one in seen] == ["tracked", "lost", "lost", "lost"]


def test_what_is_used_is_followed_in_the_image_while_no_body_is_seen(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0]]
    cascade, trackers = new_cascade()
    run(cascade, 1)
    image = Image(None, CAMERA)
    answer = cascade.step(None, 2 * FRAME_NS, image, CAMERA)
    assert (answer.known, answer.estimate.state) == (0, "tracked")
    assert trackers[0].images == [None, image]


def test_where_nothing_is_in_use_the_box_is_where_the_last_object_was_left(script) -> None:
    script += [[0.0, 0.9, 0.0, 0.0], [0.0, 0.0, 0.0, 0.1]]
    cascade, _ = new_cascade()
    answer = run(cascade, 2)[-1]
    assert (answer.known, answer.estimate) == (None, LOST)
    assert answer.box[0] == 100.0


def test_a_tracker_that_is_not_sure_of_its_object_does_not_say_where_one_is(script) -> None:
    script += [[0.0, 0.3, 0.2, 0.0], [0.0, 0.3, 0.2, 0.0]]
    cascade, trackers = new_cascade()
    trackers[1].confidence = 0.2
    assert run(cascade, 1)[0].box[0] == 200.0
    trackers[2].confidence = 0.2
    assert run(cascade, 1)[0].box[0] == 100.0


def support_all(trackers: list[AtPixel], support: Support | None) -> None:
    for tracker in trackers:
        tracker.support = support


def test_another_object_that_is_known_takes_the_place_of_the_last(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0], [0.0, 0.9, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0]]
    cascade, trackers = new_cascade()
    answers = run(cascade, 3)
    assert [answer.known for answer in answers] == [0, 1, None]
    assert len(trackers[0].seen) == 1
    assert answers[-1].box[0] == 100.0


def test_only_the_known_object_says_what_its_pose_was_chosen_from(script) -> None:
    script += [[0.0, 0.9, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0]]
    cascade, trackers = new_cascade()
    watcher = RecognisedObjects(cascade, ["mug", "phone", "broom", "shoe"])
    assert watcher.considered() == {}
    run(cascade, 1)
    assert watcher.considered() == {"phone": trackers[1].considers}
    run(cascade, 1, first=1)
    assert watcher.considered() == {}


def test_somebody_else_left_nothing(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0]]
    cascade, trackers = new_cascade()
    run(cascade, 1)
    cascade.restart()
    (answer,) = run(cascade, 1)
    assert answer.box[0] == 200.0
    assert trackers[0].seen == []


def test_without_an_image_the_others_keep_what_the_body_did(script) -> None:
    script += [[0.9, 0.0, 0.0, 0.0]] * 3
    cascade, trackers = new_cascade()
    run(cascade, 3)
    assert [len(tracker.remembered) for tracker in trackers] == [0, 3, 3, 3]


def test_in_images_every_object_takes_its_turn_until_one_is_sure(script) -> None:
    script += [[0.6, 0.0, 0.0, 0.0]] * (1 + 6 * TURN) + [[0.95, 0.0, 0.0, 0.0]] * (6 * TURN)
    cascade, trackers = new_cascade()
    look(cascade, 1 + 6 * TURN)
    unsure = [len(tracker.seen) for tracker in trackers]
    assert unsure[0] == 1 + 6 * TURN
    assert min(unsure[1:]) >= 2 * TURN - 1
    look(cascade, 6 * TURN, first=1 + 6 * TURN)
    assert sum(len(tracker.seen) for tracker in trackers[1:]) - sum(unsure[1:]) <= TURN + 1


def test_an_object_that_becomes_known_has_its_pose_in_that_frame(script) -> None:
    script += [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.9]]
    cascade, trackers = new_cascade()
    answer = look(cascade, 2)[-1]
    assert answer.known == 3
    assert answer.estimate.state == "tracked"
    assert len(trackers[3].seen) + len(trackers[3].remembered) == 2


def test_the_supports_of_the_objects_looked_for_reach_the_recogniser(script, told) -> None:
    script += [[0.9, 0.0, 0.0, 0.0]] * 2
    cascade, trackers = new_cascade()
    support_all(trackers, Support(0.0, 0.0, 0.0, 100.0))
    look(cascade, 1)
    assert told[0][0] > 0.0
    assert told[0][-1] == 0.0
    assert np.count_nonzero(told[0]) == sum(len(tracker.seen) for tracker in trackers)


def test_a_second_without_images_is_told_as_no_image(script, told) -> None:
    script += [[0.9, 0.0, 0.0, 0.0]] * 40
    cascade, trackers = new_cascade()
    support_all(trackers, Support(0.0, 0.0, 0.0, 100.0))
    look(cascade, 1)
    support_all(trackers, None)
    run(cascade, 39, first=1)
    assert [one is None for one in told] == [False] * 31 + [True] * 9


def test_a_frame_that_is_skipped_is_remembered_by_the_movement_and_all_trackers(
    script: list, told: list
) -> None:
    cascade, trackers = new_cascade()
    cascade.remember(STANDING, FRAME_NS)
    cascade.remember(np.full((20, 3), np.nan), 2 * FRAME_NS)
    assert told == ["remembered"]
    assert [tracker.remembered for tracker in trackers] == [[FRAME_NS]] * ACTIONS


def test_the_cascade_s_effort_is_its_trackers(script: list) -> None:
    cascade, trackers = new_cascade()
    cascade.effort = 0.5
    script.append([0.7, 0.1, 0.1, 0.0])
    cascade.step(STANDING, FRAME_NS)
    assert trackers[0].efforts == [0.5]
