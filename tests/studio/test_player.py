"""Which frame is played when."""

import numpy as np
from inhand_studio.player import Player

TIMES_NS = 10**18 + 100_000_000 * np.arange(10)


def test_it_goes_on_by_the_times_of_the_frames_at_any_rate_and_stops_at_the_last() -> None:
    player = Player(TIMES_NS)
    player.jump(2)
    player.play(2.0, 50.0)
    assert [player.frame(50.0 + seconds) for seconds in (0.0, 0.04, 0.06, 0.21)] == [2, 2, 3, 6]
    assert player.playing
    assert player.frame(60.0) == 9
    assert not player.playing
    player.play(1.0, 70.0)
    assert player.frame(70.11) == 1


def test_jumps_stay_within_the_recording() -> None:
    player = Player(TIMES_NS)
    player.jump(99)
    assert player.frame(0.0) == 9
    player.jump(-1)
    assert player.frame(0.0) == 0


def test_a_clock_that_was_set_back_stops_nothing_for_ever() -> None:
    times_ns = TIMES_NS.copy()
    times_ns[5:] -= 300_000_000
    player = Player(times_ns)
    player.play(1.0, 0.0)
    assert player.frame(0.45) >= 4
    assert player.frame(1.0) == 9
