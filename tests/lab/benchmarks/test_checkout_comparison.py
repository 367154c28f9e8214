from pathlib import Path

import pytest
from inhand_lab.benchmarks.checkout_comparison import CaseComparison, packages_of
from inhand_runtime.errors import SettingsError

ROOT = Path(__file__).parents[3]


def test_a_ratio_is_that_of_one_turn() -> None:
    case = CaseComparison("a case", (1.0, 2.0), (5.0, 8.0))
    assert case.ratios == (5.0, 4.0)


def test_the_packages_of_a_checkout_are_found() -> None:
    packages = {str(folder.relative_to(ROOT)) for folder in packages_of(ROOT)}
    assert {"schemas", "lab", "services/runtime", "services/tracker"} <= packages


def test_a_folder_without_the_source_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="is no checkout of this project"):
        packages_of(tmp_path)
