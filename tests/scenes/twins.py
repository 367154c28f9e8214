"""Starts two recorders of one name, many times, and counts how often both were let in, or neither.

``python tests/scenes/twins.py --trials 32``: a third process of the rig is there or comes, and in
turn the second recorder starts when the first is up; both start at once; the third, which holds the
meeting address, is killed before the second starts; or all three start within a second, in any
order. One recorder must be up, and the other must end with 1 and without having been up.
"""

import argparse
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from running_rig import Process, RunningRig, eventually

PEER = Path(__file__).parents[1] / "runtime" / "peer.py"
LATEST_START_S = 1.0
ENDS_WITHIN_S = 10.0
"""Seconds in which the younger of two that are both up must have ended."""

ONE_UP, BOTH_UP, NONE_UP, STAYED = "one up", "both up, one ended", "none up", "both up for good"
WAYS = ("later", "together", "orphaned", "any order")


def outcomes(trials: int, seed: int) -> Iterator[tuple[str, str]]:
    """The way of each trial, and what came of it."""
    draw = random.Random(seed)
    for number in range(trials):
        way = WAYS[number % len(WAYS)]
        with tempfile.TemporaryDirectory(prefix="inhand-twins-") as folder:
            rig = RunningRig(Path(folder))
            rig.configure(f'[recorder.disk]\nfolder = "{folder}/disk"')
            try:
                yield way, _outcome(_start(rig, way, draw))
            finally:
                rig.close()


def _start(rig: RunningRig, way: str, draw: random.Random) -> list[Process]:
    """Start the three, and return the two recorders."""
    if way == "any order":
        starts = [_third, _recorder, _recorder]
        draw.shuffle(starts)
        processes = []
        for start in starts:
            processes.append((start, start(rig)))
            time.sleep(draw.uniform(0.0, LATEST_START_S))
        return [process for start, process in processes if start is _recorder]
    third = _third(rig)
    third.said("knows 0")
    first = _recorder(rig)
    if way == "together":
        return [first, _recorder(rig)]
    first.said("is up")
    third.said("knows 1")
    if way == "orphaned":
        third.popen.kill()
        third.wait()
    return [first, _recorder(rig)]


def _third(rig: RunningRig) -> Process:
    return rig.python(PEER, rig.meeting)


def _recorder(rig: RunningRig) -> Process:
    return rig.inhand("recorder", "--config", rig.config)


def _outcome(twins: list[Process]) -> str:
    eventually("what becomes of both", lambda: all(_ended(one) or _was_up(one) for one in twins))
    up = sum(map(_was_up, twins))
    if up < len(twins):
        refused = [one for one in twins if not _was_up(one)]
        assert all("runs already" in one.stderr and one.wait() == 1 for one in refused)
        return ONE_UP if up else NONE_UP
    end = time.monotonic() + ENDS_WITHIN_S
    while time.monotonic() < end:
        if sum(map(_ended, twins)) == 1:
            return BOTH_UP
        time.sleep(0.05)
    return STAYED


def _ended(process: Process) -> bool:
    return process.popen.poll() is not None


def _was_up(process: Process) -> bool:
    return "is up" in process.stderr


def main() -> int:
    """Run the trials and say what came of them; exit code 1 unless one was up in each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=32)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    counts = Counter(outcomes(chosen.trials, chosen.seed))
    for way in WAYS:
        of_way = {outcome: count for (of, outcome), count in counts.items() if of == way}
        print(f"{way}: " + ", ".join(f"{count} {outcome}" for outcome, count in of_way.items()))
    return 0 if all(outcome == ONE_UP for _, outcome in counts) else 1


if __name__ == "__main__":
    sys.exit(main())
