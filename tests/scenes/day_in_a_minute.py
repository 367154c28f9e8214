"""A scripted home's day through the daemon of outcomes, as fast as it takes it; run by hand.

``python tests/scenes/day_in_a_minute.py [--acts N]``: N times somebody carries a cup from one place
to another, spread over two local days of Europe/Zurich, on the first of which the clocks go back an
hour. In between the daemon is killed (-9) in the middle of an act, and after its next start the
camera's last seconds come again; the host's clock is set back an hour and forward again. Each act
must be counted once, on its local day. Says what was counted, the database's size, and how memory
grew; ends with 1 where a count is wrong.
"""

import argparse
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

from carried_cup import Carrying, write_model
from inhand_outcomes.store.database import open_database
from inhand_outcomes.store.queries import totals
from inhand_runtime.session import Publisher, open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose, Skeletons
from inhand_schemas.topics import POSE, RELIABLE, SKELETONS, Topic
from running_rig import Process, RunningRig, eventually

ZONE = ZoneInfo("Europe/Zurich")
MIDNIGHT = datetime(2026, 10, 25, tzinfo=ZONE)
ACT_S = 9.0
KILLED_S = 4.5
REPEATED_S = 3.0
"""Seconds before the kill from which on the camera's frames come again: what the daemon had not
written."""
AHEAD = 200
"""Frames that may be on their way: the daemon's queue holds ten times as many."""


class Feed:
    """Sends frames no faster than the daemon takes them."""

    def __init__(self, rig: RunningRig, people: Publisher[Skeletons], poses: Publisher[ObjectPose]):
        self._rig, self._people, self._poses = rig, people, poses
        self._sent = 0

    def began(self) -> None:
        """Count anew: another daemon listens."""
        self._sent = 0

    def act(self, start_ns: int, first_s: float = 0.0, until_s: float = ACT_S) -> None:
        """Send an act that begins at a capture time."""
        for skeletons, pose in Carrying(start_ns=start_ns).messages(until_s):
            if (pose.time_ns - start_ns) * 1e-9 < first_s:
                continue
            self._people.put(skeletons)
            self._poses.put(pose)
            self._sent += 1
            if self._sent % AHEAD == 0:
                self.wait()

    def wait(self) -> None:
        """Wait until the daemon has taken all that was sent."""
        key = POSE.key(Site(), "cup")
        eventually(
            "the daemon to follow",
            lambda: self._rig.counted("home", key, "received") >= self._sent,
        )


@contextmanager
def feeding(rig: RunningRig) -> Iterator[Feed]:
    """A camera and a tracker of the rig."""
    people = Topic(SKELETONS.stream, Skeletons, RELIABLE)
    poses = Topic(POSE.stream, ObjectPose, RELIABLE)
    with open_session(ZenohSettings(meeting=rig.meeting)) as session:

        def ignore(_key: str) -> None: ...

        yield Feed(
            rig,
            Publisher(session, people, people.key(Site(), "front"), ignore),
            Publisher(session, poses, poses.key(Site(), "cup"), ignore),
        )


def start(rig: RunningRig) -> Process:
    """A daemon that is up and listens."""
    daemon = rig.inhand("outcomes", "--config", rig.config)
    daemon.said("is up")
    eventually("its health", lambda: "home" in rig.healths())
    time.sleep(1.0)  # so that the publishers have heard of its subscriptions
    return daemon


def starts(acts: int) -> list[datetime]:
    """When each act begins, over 49 hours of two days."""
    step = timedelta(hours=49) / acts
    begin = MIDNIGHT.astimezone(ZoneInfo("UTC"))
    return [
        (begin + number * step + timedelta(minutes=1)).astimezone(ZONE) for number in range(acts)
    ]


def main() -> int:
    """Run the days; 1 where an act was counted otherwise than once on its day."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--acts", type=int, default=200)
    chosen = parser.parse_args()
    wanted: Counter[str] = Counter()
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="inhand_day_") as name:
        rig = RunningRig(Path(name))
        model = write_model(rig.folder / "cup.model")
        rig.configure(f'[outcomes.home]\nmodels = ["{model}"]\ntime_zone = "Europe/Zurich"\n')
        daemon = start(rig)
        memory = []
        with feeding(rig) as feed:
            for number, at in enumerate(starts(chosen.acts)):
                start_ns = round(at.timestamp() * 1e9)
                if number == chosen.acts // 2:
                    feed.act(start_ns, until_s=KILLED_S)
                    feed.wait()
                    time.sleep(2.3)  # its memory is written, and its track not ended yet
                    daemon.stop(signal.SIGKILL)
                    daemon = start(rig)
                    feed.began()
                    feed.act(start_ns, first_s=KILLED_S - REPEATED_S)
                elif number == chosen.acts // 3:
                    feed.act(start_ns)
                    feed.wait()
                    back = start_ns - 1_800 * 10**9
                    feed.act(back)  # the clock was set back: another act, at an earlier time
                    wanted[str(datetime.fromtimestamp(back * 1e-9, ZONE).date())] += 1
                else:
                    feed.act(start_ns)
                wanted[str(at.date())] += 1
                if number % max(chosen.acts // 10, 1) == 0:
                    feed.wait()
                    memory.append(rig.health("home")["resident_bytes"])
            feed.wait()
            time.sleep(6.0)
        daemon.stop()
        database = open_database(rig.folder / "outcomes.db")
        found: dict[str, Counter[str]] = {"taken_up": Counter(), "put_down": Counter()}
        for total in totals(database, MIDNIGHT.date(), MIDNIGHT.date() + timedelta(days=3)):
            if total.kind in found:
                found[total.kind][str(total.day)] += total.times
        database.close()
        size = sum(path.stat().st_size for path in rig.folder.glob("outcomes.db*"))
        rig.close()
    print(f"wanted {dict(wanted)}")
    for kind, days in found.items():
        print(f"{kind} {dict(days)}")
    print(
        f"{time.monotonic() - began:.0f} s; database {size / 1e6:.2f} MB; memory "
        + ", ".join(f"{one / 1e6:.0f}" for one in memory)
        + " MB"
    )
    return int(any(days != wanted for days in found.values()))


if __name__ == "__main__":
    sys.exit(main())
