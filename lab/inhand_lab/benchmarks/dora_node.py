"""A node of dora-rs that sends frames, or takes them: a program by itself.

``dora_node.py send|receive FOLDER``: the folder has the frame's bytes, how many are sent and how
often; each node leaves there when each frame was sent, or there, by the machine's steady clock.
"""

import importlib
import json
import sys
import time
from pathlib import Path
from typing import Any

FRAME, EXCHANGE, OUTPUT, INPUT = "frame.bin", "exchange.json", "frame", "frame"
SENT, CAME = "sent.json", "came.json"


def send(node: Any, folder: Path) -> dict[int, int]:
    """Send every frame, and return when."""
    exchange = json.loads((folder / EXCHANGE).read_text())
    payload = importlib.import_module("pyarrow").array(
        memoryview((folder / FRAME).read_bytes()), type="uint8"
    )
    sent, due_s = {}, time.monotonic()
    for number in range(exchange["frames"]):
        due_s += 1.0 / exchange["frame_rate"]
        time.sleep(max(0.0, due_s - time.monotonic()))
        sent[number] = time.monotonic_ns()
        node.send_output(OUTPUT, payload, {"number": number})
    return sent


def receive(node: Any, _folder: Path) -> dict[int, int]:
    """Take frames until the sender ends, and return when the bytes of each were there."""
    came = {}
    for event in node:
        if event["type"] == "INPUT":
            event["value"].to_numpy()
            now = time.monotonic_ns()
            came[event["metadata"]["number"]] = now
        elif event["type"] in ("STOP", "INPUT_CLOSED"):
            break
    return came


if __name__ == "__main__":
    role, name = sys.argv[1:]
    work, file = {"send": (send, SENT), "receive": (receive, CAME)}[role]
    times = work(importlib.import_module("dora").Node(), Path(name))
    (Path(name) / file).write_text(json.dumps(times))
