"""Whether fusion's numbers are good ones on a dataset: each is halved and doubled by itself.

The numbers were chosen on simulated people. On a dataset that they were not chosen on, from another
seed or of real bodies, a number whose half or double errs clearly less is a poor choice, and one
whose half and double err the same says nothing.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION

from inhand_lab.benchmarks.ablation import ablate
from inhand_lab.benchmarks.ablation_data import AblationData
from inhand_lab.benchmarks.variation import parameter_names
from inhand_lab.datasets.dataset import Dataset


@dataclass(frozen=True)
class ConstantCheck:
    """A number's usual value, a lower and a higher one, and the vertex errors with these two, as
    ratios to that with the usual one."""

    name: str
    usual: float
    lower: float
    higher: float
    lower_ratio: float
    higher_ratio: float

    @property
    def best_ratio(self) -> float:
        """The smaller of the two ratios: below 1 another value would be better here."""
        return min(self.lower_ratio, self.higher_ratio)


def check_constants(
    dataset: Dataset, processes: int, on_progress: Callable[[], None] = lambda: None
) -> list[ConstantCheck]:
    """Leave one participant out, with every number halved and doubled; the poorest choices first.

    Raises DatasetError or RecordingError.
    """
    numbers = list(_numbers())
    settings = [f"{name}={value}" for name, _, *both in numbers for value in both]
    usual, *others = ablate(AblationData(dataset), processes, on_progress, settings)
    ratios = [worth.vertex_error_cm / usual.vertex_error_cm for worth in others]
    checks = [
        ConstantCheck(name, value, lower, higher, ratios[2 * place], ratios[2 * place + 1])
        for place, (name, value, lower, higher) in enumerate(numbers)
    ]
    return sorted(checks, key=lambda check: check.best_ratio)


def _numbers() -> Iterator[tuple[str, float, float, float]]:
    """Each number of fusion with its usual, a lower and a higher value."""
    for name in parameter_names():
        usual: Any = DEFAULT_FUSION
        for step in name.split("."):
            usual = getattr(usual, step)
        if isinstance(usual, bool):
            continue
        if isinstance(usual, int):
            yield name, usual, max(usual // 2, 1), 2 * usual
        elif 0.5 < usual < 1.0:
            # A share that cannot be doubled: its odds are.
            yield name, usual, usual / (2.0 - usual), 2.0 * usual / (1.0 + usual)
        else:
            yield name, usual, 0.5 * usual, 2.0 * usual
