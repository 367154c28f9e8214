"""What training costs by the number of labelled frames."""

from collections import Counter

import pytest
from inhand_lab.benchmarks.training_cost import benchmark_training, training_steps

from inhand.bench_tables import training_table


@pytest.mark.exhaustive
def test_the_cost_of_training_is_measured_for_every_size() -> None:
    calls: Counter[str] = Counter()
    sizes = (720, 2160)
    costs = list(benchmark_training(sizes, 1, lambda stage: calls.update([stage])))
    assert calls == training_steps(sizes)
    assert [cost.learning.recordings for cost in costs] == [2, 6]
    for cost, size in zip(costs, sizes, strict=True):
        assert 0.9 * size < cost.learning.frames <= size
        assert cost.learning.peak_memory_mb > 50.0
        assert cost.asking.found == 1.0
        assert 0.0 < cost.asking.nearest_ms.p50 <= cost.asking.nearest_ms.p99
    assert costs[1].learning.model_mb > 1.5 * costs[0].learning.model_mb
    assert training_table(costs).row_count == 14
