"""Evidence adds up, fades, and is worth nothing where it speaks for nobody."""

import numpy as np
from inhand_tracker.recognition.class_filter import ClassFilter
from inhand_tracker.recognition.parameters import DEFAULT_RECOGNITION

FRAME_NS = 33_333_333


def run(evidence: np.ndarray, frames: int, temper: float = 0.1, step_ns: int = FRAME_NS):
    running = ClassFilter(3, temper)
    return [running.step(n * step_ns, evidence) for n in range(frames)]


def test_nothing_is_in_use_until_something_speaks_for_it() -> None:
    steps = run(np.zeros(4), 1000)
    assert all(abs(step.sum() - 1.0) < 1e-9 for step in steps)
    assert max(step[:-1].max() for step in steps) < 0.3
    assert abs(steps[0][-1] - DEFAULT_RECOGNITION.none_at_first) < 0.01


def test_evidence_that_lasts_makes_an_action_known_and_keeps_it_through_a_pause() -> None:
    running = ClassFilter(3, 0.1)
    speaking, silent = np.array([2.5, 0.0, 0.0, 0.0]), np.zeros(4)
    first = [running.step(n * FRAME_NS, speaking)[0] for n in range(40)]
    assert first[0] < 0.1
    assert first[-1] > 0.9
    assert np.all(np.diff(first) > -1e-3)
    later = [running.step((40 + n) * FRAME_NS, silent)[0] for n in range(60)]
    assert 0.5 < later[-1] < first[-1]


def test_half_as_many_frames_a_second_tell_as_much() -> None:
    speaking = np.array([1.0, 0.0, 0.0, 0.0])
    every, second = run(speaking, 61), run(speaking, 31, step_ns=2 * FRAME_NS)
    np.testing.assert_allclose(every[-1], second[-1], atol=0.02)


def test_who_comes_next_starts_without_a_history() -> None:
    running = ClassFilter(3, 0.1)
    first = running.step(0, np.array([2.0, 0.0, 0.0, 0.0])).copy()
    for n in range(1, 50):
        running.step(n * FRAME_NS, np.array([2.0, 0.0, 0.0, 0.0]))
    running.restart()
    np.testing.assert_allclose(running.step(0, np.array([2.0, 0.0, 0.0, 0.0])), first)
