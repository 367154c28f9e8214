"""Scores of answers and boxes, on a few frames by hand."""

import numpy as np
import pytest
from inhand_lab.datasets.observations import Observation
from inhand_lab.recognition.recognition_scores import UNKNOWN, answer_together, box_error
from inhand_lab.recognition.true_boxes import box_centres
from inhand_tracker.body.reader import Body
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.recognition.object_recogniser import ObjectRecogniser
from inhand_tracker.recognition.recognition import Recognition

NOTHING = [np.nan] * 4


def boxes(*lefts: float | None) -> np.ndarray:
    """Squares of 10 pixels by their left sides; None is no box."""
    return np.array([NOTHING if left is None else [left, 0, left + 10, 10] for left in lefts])


def test_a_box_s_centre_is_between_its_sides() -> None:
    np.testing.assert_allclose(box_centres(boxes(4.0)), [[9.0, 5.0]])


def test_a_frame_without_a_box_keeps_the_last_one_and_those_before_the_first_take_that() -> None:
    truth = boxes(0.0, 0.0, 0.0, 0.0)
    assert box_error(boxes(None, 3.0, None, 5.0), truth) == pytest.approx((3 + 3 + 3 + 5) / 4)


def test_frames_without_a_true_box_do_not_count() -> None:
    assert box_error(boxes(2.0, 100.0), boxes(0.0, None)) == pytest.approx(2.0)
    assert np.isnan(box_error(boxes(None, None), boxes(0.0, 0.0)))
    assert np.isnan(box_error(boxes(1.0, 1.0), boxes(None, None)))


class Counting(ObjectRecogniser):
    """Recognises the number of frames since its start, from the second one on."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        self._frames = 0

    def step(self, *_: object) -> Recognition:
        self._frames += 1
        known = None if self._frames == 1 else self._frames
        return Recognition(np.zeros(1), known)

    def _recognise(
        self, body: Body, time_ns: int, image: Image | None, camera: Intrinsics | None
    ) -> Recognition:
        raise NotImplementedError

    def _without_body(self, time_ns: int) -> Recognition:
        raise NotImplementedError


def test_methods_answer_to_the_same_frames_and_start_afresh_with_somebody_else() -> None:
    seen = [Observation(n, None, None, somebody_else=n == 3) for n in range(5)]
    answers = answer_together([Counting(), Counting()], seen, 5)
    for one in answers:
        np.testing.assert_array_equal(one.actions, [UNKNOWN, 2, 3, UNKNOWN, 2])
        assert np.isnan(one.boxes).all()
