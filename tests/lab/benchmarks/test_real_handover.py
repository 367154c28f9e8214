"""A prior of simulated handovers beside a real one."""

import pytest
from inhand_lab.benchmarks.real_handover import RealHandoverParameters, check_real_handover
from real_data import DATA, needs_real_data


@needs_real_data
@pytest.mark.long
def test_whose_prior_is_nearer_has_the_baton() -> None:
    few = RealHandoverParameters(seeds=(7701,), frames=240, rate_hz=10.0)
    found = check_real_handover(DATA / "handover", few)
    giver, taker = found.people
    assert min(giver.frames, taker.frames) > 15
    assert found.held_frames == giver.frames + taker.frames
    assert found.right_holder > 0.85 * found.held_frames
    for one in found.people:
        assert one.following_m < one.mean_m < one.largest_m < 0.3
    assert found.passes_s == pytest.approx(3.35, abs=0.1)
    assert found.passes_by_prior_s == pytest.approx(found.passes_s, abs=0.5)
