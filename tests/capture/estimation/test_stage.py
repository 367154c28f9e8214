"""Skeletons in a thread of their own: frames do not wait, and what is skipped is counted."""

import threading
from collections.abc import Iterator, Sequence

import numpy as np
import pytest
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.stage import SkeletonStage
from inhand_runtime.errors import InhandError
from inhand_runtime.health import HealthBoard
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.source import Pixels
from inhand_schemas.messages import Skeletons
from msgspec import structs
from numpy.typing import NDArray
from posed_person import INFO, depth_of, seen, standing

KEY = "inhand/@v1/rig/skeletons/front"
COLOUR = np.zeros((480, 640, 3), np.uint8)
DEPTH = depth_of(standing())
PIXELS = Pixels(COLOUR, DEPTH)


class WaitingNetwork:
    """Finds one person in each picture, once it is let."""

    def __init__(self) -> None:
        self.looking = threading.Semaphore(0)
        self.may = threading.Semaphore(0)
        self.fault: Exception | None = None

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Wait, and find somebody."""
        self.looking.release()
        self.may.acquire()
        if self.fault is not None:
            raise self.fault
        return [seen(standing())]


class Stage:
    """A running stage, what it published, and its health."""

    def __init__(self) -> None:
        self.network = WaitingNetwork()
        self.health = HealthBoard("capture", "front")
        self.health.state = "running"
        self.sent: list[Skeletons] = []
        self.came = threading.Semaphore(0)
        self.stage = SkeletonStage(
            lambda info: SkeletonEstimator(self.network, info),
            self.put,
            self.health,
            KEY,
            "blazepose",
        )

    def put(self, message: Skeletons) -> None:
        self.sent.append(message)
        self.came.release()


@pytest.fixture
def running() -> Iterator[Stage]:
    made = Stage()
    with made.stage:
        made.stage.introduce(INFO)
        yield made
        made.network.may.release(100)


def test_the_newest_frame_is_next_and_those_between_are_counted(running: Stage) -> None:
    running.stage.offer(10, 1000, PIXELS)
    running.network.looking.acquire()
    for number in range(11, 16):
        running.stage.offer(number, 100 * number, PIXELS)
    running.network.may.release(2)
    for _ in range(2):
        running.came.acquire()
    assert [(one.sequence, one.time_ns) for one in running.sent] == [(10, 1000), (15, 1500)]
    assert running.health.report().topics[KEY].dropped == 4
    assert [len(one.people) for one in running.sent] == [1, 1]
    assert {one.convention for one in running.sent} == {"blazepose"}


def test_encoded_pictures_are_decoded_and_damaged_ones_are_a_trouble_until_one_is_whole(
    running: Stage,
) -> None:
    running.network.may.release(10)
    broken = Pixels(encode_colour(COLOUR), encode_depth(DEPTH))
    assert broken.depth is not None
    damaged = type(broken.depth)("z16-zstd", 640, 480, b"nothing")  # type: ignore[call-arg]
    running.stage.offer(0, 1, Pixels(broken.colour, damaged))
    while not running.health.report().troubles:
        pass
    assert "damaged depth" in running.health.report().troubles[0]
    running.stage.offer(1, 2, broken)
    running.came.acquire()
    assert running.sent[0].sequence == 1
    assert running.health.report().troubles == ()


def test_a_camera_without_depth_is_a_trouble_that_says_the_mend(running: Stage) -> None:
    running.stage.offer(0, 1, Pixels(COLOUR, None))
    while not running.health.report().troubles:
        pass
    assert running.health.report().troubles == (
        "no skeletons without depth: the camera gives none; turn its depth on",
    )


def test_a_fault_of_the_program_ends_capture_and_is_not_swallowed(running: Stage) -> None:
    running.network.fault = RuntimeError("something that nobody thought of")
    running.network.may.release(10)

    def offered_for_ever() -> None:
        for number in range(10**9):
            running.stage.offer(number, number, PIXELS)

    with pytest.raises(InhandError, match="failed: something that nobody thought of"):
        offered_for_ever()


def test_a_camera_that_comes_back_as_it_was_keeps_people_s_ids(running: Stage) -> None:
    running.network.may.release(10)
    running.stage.offer(0, 1_000_000_000, PIXELS)
    running.came.acquire()
    running.stage.introduce(structs.replace(INFO, sequence=3, time_ns=4))
    running.stage.offer(1, 1_500_000_000, PIXELS)
    running.came.acquire()
    running.stage.introduce(structs.replace(INFO, fx=500.0, fy=500.0))
    running.stage.offer(2, 9_000_000_000, PIXELS)
    running.came.acquire()
    assert [person.id for one in running.sent for person in one.people] == [0, 0, 0]


def test_a_stage_ends_while_a_frame_waits() -> None:
    made = Stage()
    with made.stage:
        made.stage.introduce(INFO)
        made.stage.offer(0, 1, PIXELS)
        made.network.looking.acquire()
        made.stage.offer(1, 2, PIXELS)
        made.network.may.release(10)
    assert [one.sequence for one in made.sent] in ([0], [0, 1])
