"""A unit is guessed only where one alone can be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_lab.new_objects.units import UNITS, UPS, guess_unit, scale_of, upright, which_unit
from inhand_runtime.errors import SettingsError


@given(size_m=st.floats(0.01, 2.5), unit=st.sampled_from(tuple(UNITS)))
def test_what_a_hand_holds_is_never_taken_for_another_size(size_m: float, unit: str) -> None:
    guess = guess_unit(size_m / UNITS[unit], None)
    assert guess.sure in (None, unit) or abs(size_m - 0.01) < 1e-9 or abs(size_m - 2.5) < 1e-9


@pytest.mark.parametrize(
    ("length", "declared", "sure"),
    [
        (0.33, None, "m"),
        (330.0, None, "mm"),
        (120.0, None, None),
        (12.0, None, None),
        (2.0, None, None),
        (1.2, "m", "m"),
        (330.0, "m", None),
        (1000.0, "m", None),
        (1000.0, None, "mm"),
        (1e6, None, None),
        (1e-6, None, None),
    ],
)
def test_a_unit_is_sure_where_no_other_fits_a_hand_nor_is_declared(
    length: float, declared: str | None, sure: str | None
) -> None:
    assert guess_unit(length, declared).sure == sure


def test_what_is_not_sure_is_said_with_what_each_unit_would_make() -> None:
    line = which_unit(12.0, guess_unit(12.0, None))
    assert (
        "--unit mm makes it 1.2 cm, --unit cm makes it 12 cm, --unit inch makes it 30.5 cm" in line
    )
    assert "by no unit is it a thing that a hand holds" in which_unit(1e6, guess_unit(1e6, None))


def test_a_mesh_of_a_kilometre_is_refused_with_the_units_that_would_do() -> None:
    with pytest.raises(
        SettingsError, match=r"by --unit m it is 1 km long, .* --unit mm makes it 1 m"
    ):
        scale_of(1000.0, "m", None)
    with pytest.raises(SettingsError, match=r"by --unit mm it is 1 km long, .* 4 m: --size CM"):
        scale_of(1e6, "mm", None)
    with pytest.raises(SettingsError, match=r"by --size 500 it is 5 m long"):
        scale_of(2.0, None, 5.0)
    assert scale_of(1e6, None, 0.2) == pytest.approx(2e-7)


@pytest.mark.parametrize("up", UPS)
def test_what_was_up_is_z_afterwards_and_nothing_is_mirrored(up: str) -> None:
    axis = np.eye(3)["xyz".index(up[-1])] * (-1.0 if up[0] == "-" else 1.0)
    turn = upright(up)
    np.testing.assert_array_equal(turn @ axis, [0.0, 0.0, 1.0])
    np.testing.assert_array_equal(turn @ turn.T, np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1.0)
