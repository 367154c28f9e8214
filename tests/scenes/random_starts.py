"""Starts three processes of a rig in random order, many times, and counts infos that never came.

``python tests/scenes/random_starts.py --trials 1000``: in each trial a publisher of a camera's
info, a subscriber and, in every other one, a third peer that may hold the meeting address start
within two seconds. Many trials run beside each other, each with an address of its own; the three
roles are three processes. A kept value that comes later than two seconds after both are there is a
miss.
"""

import argparse
import json
import random
import socket
import subprocess
import sys
import threading
import time
from typing import Any

from inhand_runtime.session import REPEAT_S, Publisher, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO

LATEST_START_S = 2.0
WATCHED_S = 8.0
LATE_S = 2.0
TOGETHER = 20
ROLES = ("holder", "publisher", "subscriber")

INFO_MESSAGE = CameraInfo(
    sequence=0, time_ns=1, width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5
)


def run_trials(trials: int, seed: int) -> list[float]:
    """Seconds until the info came in each trial, infinite where it did not."""
    draw = random.Random(seed)
    latencies: list[float] = []
    while len(latencies) < trials:
        count = min(TOGETHER, trials - len(latencies))
        latencies += _run_together([_plan(draw, number) for number in range(count)])
    return latencies


def _plan(draw: random.Random, number: int) -> dict[str, Any]:
    roles = ROLES if number % 2 else ROLES[1:]
    delays = {role: draw.uniform(0.0, LATEST_START_S) for role in roles}
    return {"meeting": f"tcp/127.0.0.1:{_free_port()}", "delays": delays}


def _free_port() -> int:
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        port: int = server.getsockname()[1]
        return port


def _run_together(plans: list[dict[str, Any]]) -> list[float]:
    begin = time.time() + 2.0
    command = [sys.executable, __file__, "--plans", json.dumps({"begin": begin, "plans": plans})]
    processes = {
        role: subprocess.Popen([*command, "--role", role], stdout=subprocess.PIPE, text=True)
        for role in ROLES
    }
    times = {role: json.loads(process.communicate()[0]) for role, process in processes.items()}
    latencies = []
    for published, (subscribed, got) in zip(times["publisher"], times["subscriber"], strict=True):
        latencies.append(
            float("inf") if got is None else max(got - max(published, subscribed), 0.0)
        )
    return latencies


def _play(role: str, begin: float, plans: list[dict[str, Any]]) -> list[Any]:
    results: list[Any] = [None] * len(plans)

    def play(number: int) -> None:
        plan = plans[number]
        if role not in plan["delays"]:
            return
        time.sleep(max(0.0, begin + plan["delays"][role] - time.time()))
        with open_session(ZenohSettings(meeting=plan["meeting"])) as session:
            results[number] = _ROLES[role](session, begin + LATEST_START_S + WATCHED_S)

    threads = [threading.Thread(target=play, args=(number,)) for number in range(len(plans))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def _hold(_session: Any, end: float) -> None:
    time.sleep(max(0.0, end - time.time()))


def _publish(session: Any, end: float) -> float:
    publisher = Publisher(session, INFO, INFO.key(Site(), "front"), lambda _key: None)
    published = time.time()
    publisher.put(INFO_MESSAGE)
    while time.time() < end:
        time.sleep(REPEAT_S)
        publisher.repeat()
    return published


def _subscribe(session: Any, end: float) -> tuple[float, float | None]:
    came: list[float] = []
    handle = subscribe(
        session,
        INFO.key(Site(), "front"),
        INFO.delivery,
        lambda _sample: came.append(time.time()),
    )
    subscribed = time.time()
    time.sleep(max(0.0, end - time.time()))
    del handle
    return subscribed, came[0] if came else None


_ROLES = {"holder": _hold, "publisher": _publish, "subscriber": _subscribe}


def main() -> int:
    """Run the trials and say how many infos came late or never; exit code 1 where one did."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--role", choices=ROLES, help=argparse.SUPPRESS)
    parser.add_argument("--plans", type=json.loads, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.role is not None:
        print(json.dumps(_play(chosen.role, chosen.plans["begin"], chosen.plans["plans"])))
        return 0
    latencies = sorted(run_trials(chosen.trials, chosen.seed))
    misses = sum(latency > LATE_S for latency in latencies)
    print(
        f"{misses} misses in {len(latencies)} starts; the info came after "
        f"{latencies[len(latencies) // 2]:.3f} s in the middle, {latencies[-1]:.3f} s at the latest"
    )
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
