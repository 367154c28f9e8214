"""A replay is paused, stepped through and sought while it runs."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inhand_capture.sources.replay import ReplaySource
from inhand_capture.view.viewed_source import viewed
from inhand_runtime.source import Source, control_playback
from inhand_schemas.playback import PlaybackAction, PlaybackReply, PlaybackRequest
from played import FRAME_NS, START_NS, entries, write
from running_rig import eventually
from scripted_source import ScriptedSource


class Played:
    """A source that plays in a thread of its own, and the numbers of the frames that it gave."""

    def __init__(self, source: ReplaySource) -> None:
        self.source = source
        self.numbers: list[int] = []
        self._thread = threading.Thread(target=self._play)
        self._thread.start()

    def ask(self, action: PlaybackAction, value: float | None = None) -> PlaybackReply:
        return self.source.playback(PlaybackRequest(action=action, value=value), "kitchen")

    def reached(self, number: int) -> None:
        eventually(f"frame {number}", lambda: self.numbers[-1:] == [number])

    def ended(self) -> bool:
        self._thread.join(10.0)
        return not self._thread.is_alive()

    def close(self) -> None:
        self.source.close()
        self._thread.join()

    def _play(self) -> None:
        for captured in self.source.captures(lambda: True):
            if captured is not None:
                self.numbers.append((captured.time_ns - START_NS) // FRAME_NS)


Play = Callable[..., Played]


@pytest.fixture
def play(tmp_path: Path) -> Iterator[Play]:
    """Plays a hundred frames of two seconds."""
    path = write(tmp_path / "hundred.mcap", entries(100))
    playing: list[Played] = []

    def start(**options: Any) -> Played:
        playing.append(Played(ReplaySource({"file": path, **options})))
        return playing[-1]

    yield start
    for one in playing:
        one.close()


def test_one_that_starts_paused_gives_nothing_until_it_is_resumed(play: Play) -> None:
    played = play(paused=True, rate=0)
    time.sleep(0.1)
    assert played.numbers == []
    status = played.ask("status")
    assert (status.paused, status.position_s, status.length_s) == (True, None, 1.98)
    assert not played.ask("resume").paused
    assert played.ended()
    assert played.numbers == list(range(100))


def test_a_step_gives_one_frame(play: Play) -> None:
    played = play(paused=True)
    for number in range(3):
        played.ask("step")
        played.reached(number)
    assert played.numbers == [0, 1, 2]
    reply = played.ask("status")
    assert reply.paused
    assert reply.position_s == 2 * FRAME_NS / 1e9
    assert reply.captured_ns == START_NS + 2 * FRAME_NS


def test_a_pause_holds_what_is_under_way_and_loses_nothing(play: Play) -> None:
    played = play()
    eventually("some frames", lambda: len(played.numbers) > 5)
    assert played.ask("pause").paused
    time.sleep(0.1)
    held = len(played.numbers)
    time.sleep(0.2)
    assert len(played.numbers) == held < 100
    played.ask("rate", 0.0)
    played.ask("resume")
    assert played.ended()
    assert played.numbers == list(range(100))


def test_it_goes_elsewhere_while_it_runs(play: Play) -> None:
    played = play(rate=0.01)
    played.reached(0)
    played.ask("seek", 1.8)
    played.reached(90)
    played.ask("rate", 0.0)
    assert played.ended()
    assert played.numbers == [0, *range(90, 100)]


def test_a_paused_one_shows_the_frame_where_it_goes_and_stays_paused(play: Play) -> None:
    played = play(paused=True)
    played.ask("seek", 1.0)
    played.reached(50)
    played.ask("skip", -0.5)
    played.reached(25)
    played.ask("skip", 100.0)
    played.reached(99)
    played.ask("seek", -3.0)
    played.reached(0)
    assert played.ask("status").paused
    assert played.numbers == [50, 25, 99, 0]


def test_two_skips_at_once_add_up(play: Play) -> None:
    source = play(paused=True).source
    source.close()
    request = PlaybackRequest(action="skip", value=0.4)
    source.playback(request, "kitchen")
    source.playback(request, "kitchen")
    assert source._playback.take_target_ns() == START_NS + 800_000_000


def test_going_back_in_a_loop_goes_on_with_the_loop(play: Play) -> None:
    played = play(rate=0, loop=True, paused=True, start=1.9)
    played.ask("seek", 0.0)
    played.reached(0)
    played.ask("resume")
    eventually("the loop", lambda: len(played.numbers) > 120)
    assert played.numbers[:100] == list(range(100))
    assert played.numbers[100:110] == [*range(95, 100), *range(95, 100)]


def test_another_rate_counts_at_once(play: Play) -> None:
    played = play(rate=0.001)
    played.reached(0)
    assert played.ask("rate", 50.0).rate == 50.0
    assert played.ended()


@pytest.mark.parametrize(
    ("action", "value", "line"),
    [
        ("seek", None, "seek needs a number"),
        ("skip", float("nan"), "skip needs a number"),
        ("rate", float("inf"), "rate needs a number"),
        ("rate", -1.0, "a rate is 0 or more, not -1"),
    ],
)
def test_what_makes_no_sense_is_said_and_changes_nothing(
    play: Play, action: PlaybackAction, value: float | None, line: str
) -> None:
    played = play(paused=True)
    before = played.ask("status")
    reply = played.ask(action, value)
    assert reply.problem == line
    assert (reply.rate, reply.paused) == (before.rate, before.paused)


def test_a_masked_and_turned_replay_is_controlled_as_well(play: Play) -> None:
    turned = viewed(play(paused=True).source, 90, ())
    assert control_playback(turned, PlaybackRequest(action="pause"), "kitchen").paused


def test_a_source_that_plays_nothing_says_so() -> None:
    source: Source = ScriptedSource({"script": [1]})
    reply = control_playback(source, PlaybackRequest(action="pause"), "front")
    assert reply == PlaybackReply(camera="front", problem="its source plays no recording")
