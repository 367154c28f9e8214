#!/usr/bin/env bash
# eclipse-zenoh 1.10.2: closing the link of a reader that stands still holds up all other readers.
#
# One process publishes 160 kB 30 times a second; one reads, and another one is stopped (SIGSTOP). One
# would bet that the first reader is none the worse when, ten seconds later, the lease of the stopped
# one's link ends. It hears nothing for about two seconds, and what was published then is lost: Zenoh has
# one thread that sends, and closing a link whose bytes nobody takes holds it. With several such threads
# nothing is lost. See also https://github.com/eclipse-zenoh/zenoh/issues/2718, where it is ten seconds.
#
# So sessions of Inhand have eight (ZENOH_RUNTIME).
#
# Output seen on 2026-11-29:
#   with one thread that sends the other reader hears nothing for 2.456394535000072 s
#   with eight for 0.03857476499979384 s
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check eclipse-zenoh==1.10.2
cat > "$folder/readers.py" <<'PYTHON'
import json
import signal
import socket
import subprocess
import sys
import time

import zenoh

SECONDS = 20.0


def peer(listen: list[str], connect: list[str]) -> zenoh.Session:
    config = zenoh.Config()
    for key, value in {
        "mode": "peer",
        "scouting/multicast/enabled": False,
        "transport/shared_memory/enabled": False,
        # A link is to outlast a reader that stands still for less than its lease, 10 s.
        "transport/link/tx/queue/congestion_control/block/wait_before_close": 10_000_000,
        "listen/endpoints": listen,
        "connect/endpoints": connect,
    }.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def read(address: str) -> None:
    times: list[float] = []
    with peer([], [address]) as session:
        handle = session.declare_subscriber("frame", lambda _: times.append(time.monotonic()))
        while not times:
            time.sleep(0.01)
        print("reads", flush=True)
        time.sleep(SECONDS)
        handle.undeclare()
    print(max(after - one for one, after in zip(times, times[1:])), flush=True)


def longest_gap() -> float:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
    command = [sys.executable, __file__, address]
    with peer([address], []) as session:
        frame = session.declare_publisher(
            "frame", congestion_control=zenoh.CongestionControl.BLOCK_FIRST
        )
        readers = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
        begin = time.monotonic()
        while time.monotonic() < begin + SECONDS:
            frame.put(bytes(160_000))
            time.sleep(1.0 / 30.0)
            if time.monotonic() > begin + 4.0:
                readers[1].send_signal(signal.SIGSTOP)
        said = readers[0].communicate()[0].split()
        readers[1].kill()
    return float(said[-1])


if len(sys.argv) > 1:
    read(sys.argv[1])
else:
    print(longest_gap())
PYTHON
gap() { ZENOH_RUNTIME="(tx: (worker_threads: $1))" "$folder/venv/bin/python" "$folder/readers.py"; }
one=$(gap 1)
echo "with one thread that sends the other reader hears nothing for $one s"
several=$(gap 8)
echo "with eight for $several s"
awk -v one="$one" -v several="$several" 'BEGIN { exit !(one > 1.0 && several < 1.0) }'
