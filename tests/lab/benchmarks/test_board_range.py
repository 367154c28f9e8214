"""From how far a drawn board is found."""

from inhand_lab.benchmarks.board_range import BoardRangeParameters, measure_board_ranges

FEW = BoardRangeParameters(
    papers=("a3",), lenses=("plain",), distances_m=(2.4, 1.4, 0.9, 0.7), views=3
)


def test_a_board_is_found_from_farther_away_in_good_light_and_not_where_it_is_tiny() -> None:
    done: list[None] = []
    good, poor = measure_board_ranges(lambda: done.append(None), FEW)
    assert len(done) == 2
    assert (good.light, poor.light) == ("good", "poor")
    assert good.range_m == 1.4
    assert poor.range_m == 0.9
    assert 2.4 not in good.shares
    assert good.shares == {1.4: 1.0, 0.9: 1.0}
    assert poor.shares[1.4] < 0.9
    assert good.width_px is not None
    assert 90 < good.width_px < 100
