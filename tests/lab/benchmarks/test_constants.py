"""Every number of fusion is tried lower and higher, and stays what it can be."""

import pytest
from inhand_lab.benchmarks import constants
from inhand_lab.benchmarks.ablation import VARIANTS, Worth
from inhand_lab.benchmarks.constants import check_constants
from inhand_lab.benchmarks.variation import parameter_names, vary


def test_each_number_is_halved_and_doubled_and_the_poorest_choice_comes_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried: list[str] = []

    def ablate(_dataset: object, _processes: int, _progress: object, settings: list[str]) -> object:
        tried.extend(settings)
        errors = [2.0, *(2.0 if "image_temper" not in one else 1.0 for one in settings)]
        return [Worth(VARIANTS[0], error, 90.0) for error in errors]

    monkeypatch.setattr(constants, "ablate", ablate)
    checks = check_constants(None, 1)  # type: ignore[arg-type]
    assert checks[0].name == "image_temper"
    assert (checks[0].lower, checks[0].usual, checks[0].higher) == pytest.approx(
        (2 / 3, 0.8, 8 / 9)
    )
    assert (checks[0].best_ratio, checks[-1].best_ratio) == (0.5, 1.0)
    switches = {"carries", "leaves", "refines"}
    assert {check.name for check in checks} == set(parameter_names()) - switches
    assert len(tried) == 2 * len(checks)
    for setting in tried:
        vary(setting)


def test_a_share_stays_a_share_and_a_count_a_count() -> None:
    for name, usual, lower, higher in constants._numbers():
        assert lower < higher
        assert lower <= usual <= higher
        if 0.5 < usual < 1.0:
            assert 0.0 < lower < usual < higher < 1.0, name
        if isinstance(usual, int):
            assert isinstance(lower, int)
            assert lower >= 1
