"""Which people outcomes are shown that use nothing."""

from inhand_lab.world.interactions import INTERACTIONS

from inhand.bench_outcomes_false import STANDING, kind_beside


def test_people_are_idle_in_each_way_beside_each_object() -> None:
    shown = len(INTERACTIONS) * len(STANDING)
    pairs = {(number % len(INTERACTIONS), kind_beside(number)) for number in range(shown)}
    assert len(pairs) == shown
