from dataclasses import replace

import pytest
from inhand_tracker.methods.darby2014.variants import TABLE_1, VARIANTS

# Table 1 of the paper: re-initialises after the first frame, l_T, l_R.
TABLE = {
    "g-hand": (False, "hand", "hand"),
    "gd-hand": (True, "hand", "hand"),
    "gd-random": (True, "random", "random"),
    "gd-stable": (True, "stable", "stable"),
    "gd-stable-proximate": (True, "proximate", "stable"),
}


@pytest.mark.parametrize("name", TABLE)
def test_the_methods_are_the_columns_of_the_table(name: str) -> None:
    method = VARIANTS[name]
    assert (method.reinitialises, method.translation_part, method.rotation_part) == TABLE[name]
    assert method.name == name


def test_the_fallback_is_the_best_of_the_table_otherwise() -> None:
    assert list(TABLE_1) == list(TABLE)
    assert not any(VARIANTS[name].falls_back for name in TABLE_1)
    best = VARIANTS["gd-stable-proximate"]
    assert VARIANTS["gd-fallback"] == replace(best, name="gd-fallback", falls_back=True)
