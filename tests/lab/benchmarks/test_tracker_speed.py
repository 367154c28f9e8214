import os

import numpy as np
import pytest
from inhand_lab.benchmarks.fusion_cost import measure_fusion
from inhand_lab.benchmarks.tracker_speed import measure_tracker, naive_edge_log_weights
from inhand_lab.workers import usable_cores
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.darby2014.likelihood import Likelihood
from inhand_tracker.model.model import Model
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import find_viewpoints

from inhand.__main__ import main


def test_the_plain_evaluation_gives_the_same_weights() -> None:
    random = np.random.default_rng(0)
    corners = 0.1 * random.normal(size=(4, 3))
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    shape = ObjectShape("thing", corners, faces, corners, np.array([1.0, 0.0, 0.0]))
    model = Model("hold", shape, None, find_viewpoints(shape))  # type: ignore[arg-type]
    grey = random.integers(0, 256, (48, 64)).astype(np.uint8)
    image = Image(grey, Intrinsics(60.0, 60.0, 31.5, 23.5, 64, 48))
    # Some behind the camera, and some outside the image.
    translations = random.normal(size=(200, 3)) + np.array([0.0, 0.0, 1.5])
    orientations = random.normal(size=(200, 4))
    orientations /= np.linalg.norm(orientations, axis=1, keepdims=True)
    plain = naive_edge_log_weights(translations, orientations, model.viewpoints, image)
    quick = Likelihood(model).log_weights(translations, orientations, image)
    np.testing.assert_allclose(quick, plain, atol=1e-6)


def test_the_measurement_says_what_was_measured() -> None:
    speed = measure_tracker(0.05, [])
    assert (speed.points, speed.cores) == (50, 1)
    assert speed.edge_hypotheses_per_second > speed.full_hypotheses_per_second > 0.0
    assert speed.naive_ratio > 1.0


def test_weighing_is_measured_for_every_count_of_hypotheses_and_threads() -> None:
    costs = {(c.threads, c.hypotheses): c for c in measure_tracker(0.05, []).weighing}
    threads = (1, 2)[: usable_cores()]
    assert set(costs) == {(t, h) for t in threads for h in (100, 1_000, 10_000)}
    assert costs[1, 10_000].ms > costs[1, 100].ms
    assert costs[1, 10_000].naive_ms == pytest.approx(10.0 * costs[1, 1_000].naive_ms)


@pytest.mark.long
def test_the_cost_of_fusion_is_told_for_each_size_of_training() -> None:
    costs = measure_fusion([500, 1_000])
    assert [cost.frames for cost in costs] == [500, 1_000]
    assert all(min(cost.learning_s, cost.unseen_ms, cost.seen_ms) > 0.0 for cost in costs)


def test_the_measurement_gives_all_cores_back() -> None:
    before = os.sched_getaffinity(0)
    measure_tracker(0.01, [])
    assert os.sched_getaffinity(0) == before


def test_a_subject_that_there_is_not_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bench", "everything"])
    assert ended.value.code == 2
    assert "tracker" in capsys.readouterr().err
