"""How much left a vessel, by what it can hold at the deepest tilt of each act."""

import pytest
from inhand_outcomes.achievement import Achievement, Amount
from inhand_outcomes.measures.emptying import EmptyingParameters, with_volumes

SIPS = EmptyingParameters("sip", Amount(20.0, 8.0))


def sip(start_s: float, holds_ml: float, deviation_ml: float = 5.0, **left: float) -> Achievement:
    evidence = {
        "holds_ml": holds_ml,
        "holds_deviation_ml": deviation_ml,
        "full_ml": 300.0,
        "share_deviation": 0.04,
        **left,
    }
    return Achievement("sip", start_s, start_s + 1.0, 0.95, evidence=evidence)


def volumes(acts: list[Achievement]) -> list[float]:
    return [act.amounts["volume_ml"].value for act in acts if act.kind == "sip"]


def test_the_first_act_takes_what_is_usual_and_the_next_the_difference() -> None:
    acts = with_volumes([sip(0.0, 250.0), sip(4.0, 215.0), sip(60.0, 190.0)], [], SIPS)
    assert [act.kind for act in acts] == ["sip"] * 3
    assert volumes(acts) == pytest.approx([20.0, 35.0, 25.0], abs=2.0)
    first, second, _ = (act.amounts["volume_ml"] for act in acts)
    assert first.deviation == 8.0
    assert second.deviation == pytest.approx((5.0**2 + 5.0**2 + 1.4**2) ** 0.5, abs=0.3)


def test_a_first_sip_is_no_more_than_the_vessel_holds_above_its_tilt() -> None:
    assert volumes(with_volumes([sip(0.0, 292.0)], [], SIPS)) == [8.0]


def test_who_tilts_less_soon_after_took_nothing_and_the_vessel_held_more_than_thought() -> None:
    acts = with_volumes([sip(0.0, 200.0), sip(3.0, 210.0), sip(6.0, 180.0)], [], SIPS)
    assert volumes(acts) == pytest.approx([20.0, 0.0, 25.0])


def test_who_tilts_much_less_later_had_it_refilled() -> None:
    acts = with_volumes([sip(0.0, 120.0), sip(60.0, 250.0), sip(64.0, 230.0)], [], SIPS)
    assert [act.kind for act in acts] == ["sip", "refill", "sip", "sip"]
    refill = acts[1]
    assert refill.probability > 0.9
    assert refill.amounts["volume_ml"].value == pytest.approx(250.0 + 20.0 - 120.0)
    assert refill.end_s == 60.0
    assert volumes(acts) == pytest.approx([20.0, 20.0, 20.0], abs=1.0)


def test_a_refill_that_is_not_sure_is_told_with_doubt_and_spreads_the_volume() -> None:
    acts = with_volumes([sip(0.0, 150.0, 20.0), sip(60.0, 205.0, 20.0)], [], SIPS)
    refill = next(act for act in acts if act.kind == "refill")
    assert 0.3 < refill.probability < 0.9
    amount = acts[-1].amounts["volume_ml"]
    assert 0.0 < amount.value < 20.0
    assert amount.deviation > 8.0


def test_what_was_told_before_the_window_began_is_known() -> None:
    before = sip(-50.0, 180.0, left_ml=180.0, left_deviation_ml=5.0)
    assert volumes(with_volumes([sip(4.0, 150.0)], [before], SIPS)) == pytest.approx(
        [30.0], abs=1.0
    )
    long_ago = sip(-5000.0, 180.0, left_ml=180.0, left_deviation_ml=5.0)
    assert volumes(with_volumes([sip(4.0, 150.0)], [long_ago], SIPS)) == [20.0]


def test_an_act_that_was_told_is_found_again_as_it_was_told() -> None:
    whole = with_volumes([sip(0.0, 250.0), sip(4.0, 215.0)], [], SIPS)
    again = with_volumes([sip(4.02, 214.0), sip(9.0, 200.0)], [whole[-1]], SIPS)
    assert volumes(again) == pytest.approx([35.0, 15.0], abs=0.1)


def test_what_an_unlikely_act_left_is_not_believed() -> None:
    doubted = Achievement("sip", 3.0, 4.0, 0.2, evidence=dict(sip(3.0, 20.0).evidence))
    acts = with_volumes([sip(0.0, 200.0), doubted, sip(8.0, 170.0)], [], SIPS)
    assert volumes(acts)[-1] == pytest.approx(30.0, abs=1.0)
