"""What is truly achieved in simulated performances agrees with the stages of their scripts."""

from collections.abc import Callable

import pytest
from inhand_lab.achieved.at_head import (
    true_calls,
    true_filming,
    true_playing,
    true_reading,
    true_wearing,
)
from inhand_lab.achieved.drinking import true_sips
from inhand_lab.achieved.pouring import true_pours
from inhand_lab.achieved.shoes import true_shoes
from inhand_lab.achieved.true_achievement import TrueAchievement
from inhand_lab.world.simulation import Simulation, simulate

Truth = Callable[[Simulation], list[TrueAchievement]]


def times(simulation: Simulation, name: str, end: bool) -> list[float]:
    """When the stages of a name start or end."""
    stages = [stage for stage in simulation.stages if stage.name == name]
    return [stage.end if end else stage.start for stage in stages]


@pytest.mark.parametrize(
    ("interaction", "truth", "kind", "first", "last"),
    [
        ("drinkFromMug", true_sips, "sip", ("raise", True), ("lower", False)),
        ("answerPhone", true_calls, "call", ("raise", True), ("lower", False)),
        ("recordVideo", true_filming, "filming", ("raise", True), ("lower", False)),
        ("playFlute", true_playing, "playing", ("raise", True), ("lower", False)),
        ("putOnGlasses", true_wearing, "worn", ("put on", True), ("take off", False)),
        ("pourCream", true_pours, "pour", ("pour", False), ("pour", True)),
        ("putOnShoe", true_shoes, "shoe_on", ("put on", True), ("put on", True)),
        ("putOnShoe", true_shoes, "shoe_off", ("take off", False), ("take off", False)),
    ],
)
def test_acts_are_when_the_script_has_them(
    interaction: str, truth: Truth, kind: str, first: tuple[str, bool], last: tuple[str, bool]
) -> None:
    simulation = simulate(interaction, 3, 6001)
    found = [one for one in truth(simulation) if one.kind == kind]
    assert [one.start_s for one in found] == pytest.approx(times(simulation, *first), abs=0.7)
    assert [one.end_s for one in found] == pytest.approx(times(simulation, *last), abs=0.7)
    for one in found:
        if "duration_s" in one.amounts:
            assert one.amounts["duration_s"] == pytest.approx(one.end_s - one.start_s)


def test_reading_is_from_the_first_look_to_the_way_back() -> None:
    simulation = simulate("magnifyText", 3, 6001)
    (read,) = true_reading(simulation)
    assert read.start_s == pytest.approx(times(simulation, "focus", end=False)[0], abs=0.05)
    assert read.end_s == pytest.approx(times(simulation, "return", end=False)[0], abs=0.05)
