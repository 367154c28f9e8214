"""A scripted home's day through the daemon of outcomes, as fast as it takes it; run by hand.

``python tests/scenes/day_in_a_minute.py``: two simulated people do in eight rounds all that things
are used for, with a tracker's errors, over 24 hours of Europe/Zurich about the night in which the
clocks go back an hour; a round is under way at midnight, and another while the clocks are set. In
between there are hours without a message. The daemon is killed (-9) in the middle of two acts, and
after its next start the camera's last seconds come again; once the clock of the captures is set
back half an hour, and forward again. All is counted beside the truth of the simulation, and beside
what a watcher says that is never killed. Ends with 1 where the daemon has kept anything else.
"""

import argparse
import itertools
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np
from acts_of_all_uses import Act, camera_info, floor_frame, rounds_of_acts, write_models
from inhand_lab.achieved.truths import TRUTHS
from inhand_lab.motions.performance import ContactKind
from inhand_outcomes.floor_watch import FloorWatch
from inhand_outcomes.memory import Memory
from inhand_outcomes.store.database import Database, open_database
from inhand_outcomes.store.queries import totals
from inhand_outcomes.store.saving import Keeping, Saver, read_journal
from inhand_outcomes.things import load_things
from inhand_outcomes.totals import DayTotal
from inhand_outcomes.watching import Watcher
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import Health, ObjectPose, Skeletons
from inhand_schemas.topics import HEALTH, INFO, POSE, RELIABLE, RGBD, SKELETONS, Topic
from rich.console import Console
from rich.table import Table
from running_rig import Process, RunningRig, eventually

ZONE = ZoneInfo("Europe/Zurich")
S = 1_000_000_000
ROUNDS = (
    "2026-10-24 12:00:00",
    "2026-10-24 15:00:00",
    "2026-10-24 18:30:00",
    "2026-10-24 23:57:30",
    "2026-10-25 02:57:30",  # the first of the two hours
    "2026-10-25 06:30:00",
    "2026-10-25 09:00:00",
    "2026-10-25 10:55:00",
)
STEP_S = 20.0
"""Seconds from the beginning of one act to the next of a round."""
KILLED = {(2, 7): 4.5, (4, 13): 7.0}
"""By round and act the second in which the daemon is killed."""
FRAME_S = 1.0 / 600.0
"""Seconds from one frame to the next at least: what comes all at once comes in no order."""
SET_BACK = (1, 5)
"""The act of which the clock is half an hour behind."""
REPEATED_S = 3.0
"""Seconds before the kill from which on the camera's frames come again: what the daemon had not
written."""
DAYS = (datetime.fromisoformat(ROUNDS[0]).date(), datetime.fromisoformat(ROUNDS[-1]).date())

Frame = tuple[Skeletons, ObjectPose]
Kinds = Counter[tuple[str, str]]
"""Numbers of outcomes by local day and kind."""


@dataclass(frozen=True)
class Played:
    """An act and when it begins, by the clock of its captures."""

    act: Act
    round: int
    number: int
    start_ns: int
    frames: Sequence[Frame]


def the_day(seeds: Sequence[int]) -> Iterator[Played]:
    """All acts in order."""
    first = 0
    for number, acts in enumerate(rounds_of_acts(seeds)):
        begin = datetime.fromisoformat(ROUNDS[number]).replace(tzinfo=ZONE)
        for place, act in enumerate(acts):
            start_ns = round(begin.timestamp() + place * STEP_S) * S
            if (number, place) == SET_BACK:
                start_ns -= 1_800 * S
            frames = list(act.messages(start_ns, number % 2, first))
            first += len(frames)
            yield Played(act, number, place, start_ns, frames)


class Feed:
    """Sends what a camera and its tracker would, no faster than the daemon takes it."""

    def __init__(self, rig: RunningRig, objects: Iterable[str]) -> None:
        self._objects = objects
        self._session = open_session(ZenohSettings(meeting=rig.meeting))
        self._health: Health | None = None

    def __enter__(self) -> "Feed":
        session = self._session.__enter__()
        # Waiting for the reader, so that nothing is lost on the way.
        people = Topic(SKELETONS.stream, Skeletons, RELIABLE)
        poses = Topic(POSE.stream, ObjectPose, RELIABLE)
        self._people = Publisher(session, people, people.key(Site(), "front"), _ignore)
        self._poses = {
            name: Publisher(session, poses, poses.key(Site(), name), _ignore)
            for name in self._objects
        }
        self._infos = Publisher(session, INFO, INFO.key(Site(), "front"), _ignore)
        self._pixels = Publisher(session, RGBD, RGBD.key(Site(), "front"), _ignore)
        self._sent = 0
        self._looks = itertools.count()
        self._listening = subscribe(
            session, HEALTH.pattern(Site()), HEALTH.delivery, self._take_health
        )
        return self

    def __exit__(self, *error: object) -> None:
        self._session.__exit__(*error)  # type: ignore[arg-type]

    def _take_health(self, sample: Received) -> None:
        self._health = HEALTH.received(sample.key, sample.payload, sample.encoding)

    @property
    def resident_bytes(self) -> int:
        """Memory of the daemon."""
        assert self._health is not None
        return self._health.resident_bytes

    def received(self) -> tuple[int, int]:
        """Numbers of messages that this daemon took, and of those that it could not use."""
        if self._health is None:
            return 0, 0
        found = [
            topic
            for key, topic in self._health.topics.items()
            if "/skeletons/" in key or "/pose/" in key
        ]
        unused = sum(one.dropped + one.refused + one.malformed for one in found)
        return sum(one.received for one in found), unused

    def begin(self) -> None:
        """Begin with a daemon that has just started."""
        self._sent, self._health = 0, None
        publishers = (self._people, *self._poses.values())
        eventually("a daemon that listens", lambda: all(one.wanted() for one in publishers))
        time.sleep(0.2)  # so that what is sent first has a way
        self._infos.put(camera_info())

    def look(self, act: Act, time_ns: int) -> None:
        """Show the empty room's depth, if the daemon wants to look."""
        if self._pixels.wanted():
            self._pixels.put(floor_frame(act, next(self._looks), time_ns))

    def send(self, frames: Sequence[Frame]) -> None:
        """Send frames."""
        for skeletons, pose in frames:
            self._people.put(skeletons)
            self._poses[pose.object].put(pose)
            self._sent += 2
            time.sleep(FRAME_S)

    def wait(self) -> None:
        """Wait until the daemon has taken all that was sent."""
        eventually("the daemon to follow", lambda: self.received()[0] >= self._sent)
        assert self.received() == (self._sent, 0)


def _ignore(_key: str) -> None: ...


def start(rig: RunningRig) -> Process:
    """A daemon that is up."""
    daemon = rig.inhand("outcomes", "--config", rig.config)
    daemon.said("is up")
    return daemon


def written_until_ns(file: Path) -> int:
    """Until when the daemon's memory is written."""
    watcher = Watcher({}, "")
    with closing(open_database(file)) as database:
        Memory(watcher).recall(read_journal(database))
    return max((one.gathering.last_ns for one in watcher.followed.values()), default=0)


@contextmanager
def alone(models: Sequence[Path], act: Act, file: Path) -> Iterator[tuple[Watcher, Saver]]:
    """A watcher without a daemon, that knows the floor, and where what it says is kept."""
    things, problems = load_things(models, {})
    assert not problems
    watcher = Watcher(things, "inhand/rig")
    floors = FloorWatch(lambda *_: None)
    floors.hear_info("front", camera_info())
    floors.hear_frame("front", floor_frame(act, 0, S))
    assert floors.room is not None
    watcher.room = floors.room
    with closing(open_database(file)) as database:
        yield watcher, Saver(database, Keeping(ZONE))


def main() -> int:
    """Run the day; 1 where the daemon kept anything but what a watcher alone says."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=7101, help="of the first round's people")
    parser.add_argument("--rounds", type=int, default=len(ROUNDS), help="of the day's first hours")
    chosen = parser.parse_args()
    day = list(the_day([chosen.seed + number for number in range(chosen.rounds)]))
    with tempfile.TemporaryDirectory(prefix="inhand_day_") as name:
        rig = RunningRig(Path(name))
        models = write_models([one.act for one in day[: len(day) // chosen.rounds]], rig.folder)
        names = ", ".join(f'"{path}"' for path in models)
        rig.configure(f'[outcomes.home]\nmodels = [{names}]\ntime_zone = "Europe/Zurich"\n')
        with alone(models, day[0].act, rig.folder / "alone.db") as (watcher, saver):
            for one in day:
                saver.save(watch(watcher, one))
            wanted = kept_of(saver.database)
        began = time.monotonic()
        memory = play(rig, day)
        seconds = time.monotonic() - began
        with closing(open_database(rig.folder / "outcomes.db")) as database:
            kept = kept_of(database)
        size = (rig.folder / "outcomes.db").stat().st_size
        rig.close()
    show(day, wanted, kept)
    frames = sum(len(one.frames) for one in day)
    print(
        f"{len(day)} acts of {frames} frames in {seconds:.0f} s; database {size / 1e6:.2f} MB; "
        f"memory after each round {', '.join(f'{one / 1e6:.0f}' for one in memory)} MB"
    )
    return int(not agree(wanted, kept))


def watch(watcher: Watcher, one: Played) -> list:
    """What a watcher says of an act, with what follows in silence."""
    outcomes = []
    for skeletons, pose in one.frames:
        outcomes += watcher.hear_skeletons("front", skeletons)
        outcomes += watcher.hear_pose(pose)
    return outcomes + watcher.end_all()


def play(rig: RunningRig, day: Sequence[Played]) -> list[int]:
    """Have the daemon live through the day; its memory after each round, bytes."""
    daemon, memory = start(rig), []
    with Feed(rig, {one.act.name for one in day}) as feed:
        feed.begin()
        for look in range(8):  # until it has found the floor
            feed.look(day[0].act, day[0].start_ns - (60 - 2 * look) * S)
            time.sleep(2.2)
        for one, after in itertools.zip_longest(day, day[1:]):
            feed.look(one.act, one.start_ns)
            killed_s = KILLED.get((one.round, one.number))
            if killed_s is None:
                feed.send(one.frames)
            else:
                kill_ns = one.start_ns + round(killed_s * S)
                feed.wait()
                feed.send([frame for frame in one.frames if frame[1].time_ns < kill_ns])
                eventually(
                    "its memory to be written",
                    lambda until_ns=kill_ns - S // 10: (
                        written_until_ns(rig.folder / "outcomes.db") >= until_ns
                    ),
                )
                daemon.stop(signal.SIGKILL)
                daemon = start(rig)
                feed.begin()
                again_ns = kill_ns - round(REPEATED_S * S)
                feed.send([frame for frame in one.frames if frame[1].time_ns >= again_ns])
            if after is None or after.round != one.round:
                feed.wait()
                time.sleep(6.0)  # what is under way ends, and is saved
                memory.append(feed.resident_bytes)
            else:
                feed.wait()
    daemon.stop()
    return memory


def kept_of(database: Database) -> list[DayTotal]:
    """The totals of what counts."""
    return [one for one in totals(database, *DAYS) if one.counted]


def times(found: Sequence[DayTotal]) -> Kinds:
    """How often each kind was, by day."""
    counts: Kinds = Counter()
    for one in found:
        counts[one.day.isoformat(), one.kind] += one.times
    return counts


def true_times(day: Sequence[Played]) -> Kinds:
    """How often each kind truly was, by the day of its end."""
    counts: Kinds = Counter()
    for one in day:
        simulation = one.act.simulation
        ends = [(true.kind, true.end_s) for true in TRUTHS[simulation.interaction](simulation)]
        resting = np.asarray(simulation.contact == ContactKind.RESTING).astype(int)
        for frame in np.flatnonzero(np.diff(resting)):
            kind = "put_down" if resting[frame + 1] else "taken_up"
            ends.append((kind, (frame + 1) / simulation.frame_rate))
        for kind, end_s in ends:
            local = datetime.fromtimestamp(one.start_ns / S + end_s, ZONE)
            counts[local.date().isoformat(), kind] += 1
    return counts


def show(day: Sequence[Played], wanted: Sequence[DayTotal], kept: Sequence[DayTotal]) -> None:
    """Print a table by kind."""
    table = Table(title="counted by kind, on each of the two days")
    for column in ("kind", "truth", "a watcher alone", "the daemon", "amounts of the daemon"):
        table.add_column(column)
    by_source = [true_times(day), times(wanted), times(kept)]
    amounts: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for total in kept:
        for name, amount in total.amounts.items():
            amounts[total.kind][name] += amount.sum
    for kind in sorted({kind for counts in by_source for _, kind in counts}):
        cells = [
            " + ".join(str(counts[each.isoformat(), kind]) for each in DAYS) for counts in by_source
        ]
        told = ", ".join(f"{name} {value:.4g}" for name, value in sorted(amounts[kind].items()))
        table.add_row(kind, *cells, told)
    Console(width=160).print(table)


def agree(wanted: Sequence[DayTotal], kept: Sequence[DayTotal]) -> bool:
    """Whether two stores have the same totals, to a hundredth; prints what differs."""
    found = [
        {(one.day, one.object, one.kind, one.person): one for one in of} for of in (wanted, kept)
    ]
    differ = [key for key in found[0].keys() | found[1].keys() if not _same(key, *found)]
    for key in differ:
        print("differs:", *key, *(of.get(key) for of in found), sep="\n  ")
    return not differ


def _same(key: tuple, first: Mapping, second: Mapping) -> bool:
    one, other = first.get(key), second.get(key)
    if one is None or other is None or one.times != other.times:
        return False
    sums = [{name: amount.sum for name, amount in of.amounts.items()} for of in (one, other)]
    return sums[0].keys() == sums[1].keys() and all(
        np.isclose(value, sums[1][name], rtol=0.01, atol=0.01) for name, value in sums[0].items()
    )


if __name__ == "__main__":
    sys.exit(main())
