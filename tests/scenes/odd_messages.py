"""Sends a running rig messages that are malformed, or valid and extreme, and sees that it lives.

``python tests/scenes/odd_messages.py --messages 100000``: a tracker and a recorder run as
processes, with the small model of ``tests/tracker/golden``. So many malformed messages come, and as
many that decode and hold the largest, smallest and oddest number that a field may hold. Then a
person stands before the camera: a pose must come within a second, no process may have died or hung,
and memory may have grown by 50 MB at the most.
"""

import argparse
import json
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import psutil
from examples import EXAMPLES
from inhand_runtime.session import Session, open_session, subscribe
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message
from inhand_schemas.topics import POSE, SKELETONS, TOPICS, AnyTopic
from running_rig import RunningRig

MODEL = Path(__file__).parents[1] / "tracker" / "golden" / "drinkFromMug.model"
MOST_GROWN_BYTES = 50_000_000
POSE_WITHIN_S = 1.0
NAMES = {"pose": "cup", "label": "cup"}
EXTREMES: tuple[Any, ...] = (
    0,
    1,
    -1,
    2**31,
    2**63 - 1,
    -(2**63),
    0.0,
    -0.0,
    5e-324,
    1e-30,
    1e30,
    1e308,
    -1e308,
    float("inf"),
    float("nan"),
)


def fuzz(folder: Path, messages: int, seed: int) -> dict[str, Any]:
    """Run the rig and return what was seen, as numbers."""
    rig = RunningRig(folder)
    try:
        rig.configure(
            f'[tracker.cup]\ncamera = "kitchen"\nmodel = "{MODEL}"\n[recorder.disk]\n'
            f'folder = "{folder}/disk"'
        )
        processes = [rig.inhand(name, "--config", rig.config) for name in ("tracker", "recorder")]
        for process in processes:
            process.said("is up")
        with open_session(ZenohSettings(meeting=rig.meeting)) as session:
            return _attack(session, processes, messages, random.Random(seed))
    finally:
        rig.close()


def _attack(
    session: Session, processes: list[Any], messages: int, draw: random.Random
) -> dict[str, Any]:
    came: list[float] = []
    handle = subscribe(
        session, POSE.key(Site(), "mug"), POSE.delivery, lambda _sample: came.append(time.time())
    )
    _until_a_pose(session, came)
    before = _resident(processes)
    sent = {"malformed": 0, "extreme": 0}
    for kind, source in (("malformed", _malformed(draw)), ("extreme", _extreme(draw))):
        while sent[kind] < messages:
            topic, payload = next(source)
            key = topic.key(Site(), NAMES.get(topic.stream, "kitchen"))
            session.put(key, payload, encoding=topic.encoding)
            sent[kind] += 1
            if sent[kind] % 200 == 0:
                time.sleep(0.02)  # the rig is attacked, not the link
    time.sleep(3.0)
    waited_s = _until_a_pose(session, came)
    grown = [after - start for after, start in zip(_resident(processes), before, strict=True)]
    del handle
    return {
        **sent,
        "alive": all(process.popen.poll() is None for process in processes),
        "pose_after_s": round(waited_s, 3),
        "grown_mb": [round(one / 1e6, 1) for one in grown],
    }


def _resident(processes: list[Any]) -> list[int]:
    return [psutil.Process(process.pid).memory_info().rss for process in processes]


def _until_a_pose(session: Session, came: list[float]) -> float:
    """Let somebody stand before the camera until a pose comes; returns the seconds that it took."""
    begin = time.time()
    while not [at for at in came if at > begin]:
        person = next(one for one in EXAMPLES if type(one).__name__ == "Skeletons")
        standing = msgspec.structs.replace(
            person, sequence=int(time.time() * 1000), time_ns=time.time_ns()
        )
        session.put(
            SKELETONS.key(Site(), "kitchen"),
            SKELETONS.encode(standing),
            encoding=SKELETONS.encoding,
        )
        time.sleep(0.03)
        if time.time() - begin > 60.0:
            return float("inf")
    return time.time() - begin


def _malformed(draw: random.Random) -> Iterator[tuple[AnyTopic, bytes]]:
    examples = _examples()
    while True:
        topic, message = draw.choice(examples)
        payload = bytearray(msgspec.msgpack.encode(message))
        for _ in range(draw.randint(1, 4)):
            payload[draw.randrange(len(payload))] = draw.randrange(256)
        del payload[draw.randint(len(payload) // 2, len(payload)) :]
        yield topic, bytes(payload)


def _extreme(draw: random.Random) -> Iterator[tuple[AnyTopic, bytes]]:
    """Examples in which one number, and now and then more, is as odd as the contract lets it be."""
    examples = _examples()
    while True:
        topic, message = draw.choice(examples)
        plain = msgspec.to_builtins(message, builtin_types=(bytes,))
        for _ in range(draw.choice((1, 1, 1, 2, 5))):
            places = list(_numbers(plain))
            holder, place = draw.choice(places)
            holder[place] = draw.choice(EXTREMES)
        payload = msgspec.msgpack.encode(plain)
        try:
            topic.decode(payload)
        except MessageError:
            continue
        yield topic, payload


def _examples() -> list[tuple[AnyTopic, Message]]:
    by_type = {topic.message_type: topic for topic in TOPICS.values() if topic.stream != "label"}
    return [(by_type[type(message)], message) for message in EXAMPLES]


def _numbers(value: Any) -> Iterator[tuple[Any, Any]]:
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for place, item in list(items):
        if isinstance(item, tuple):
            value[place] = item = list(item)
        if isinstance(item, (dict, list)):
            yield from _numbers(item)
        elif isinstance(item, (int, float)) and not isinstance(item, bool):
            yield value, place


def judge(seen: dict[str, Any]) -> bool:
    """Whether the rig came through."""
    return (
        seen["alive"]
        and seen["pose_after_s"] <= POSE_WITHIN_S
        and max(seen["grown_mb"]) * 1e6 <= MOST_GROWN_BYTES
    )


def main() -> int:
    """Attack once and print what was seen; exit code 1 where a promise was broken."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--messages", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seen = fuzz(Path(folder), chosen.messages, chosen.seed)
    print(json.dumps(seen))
    return 0 if judge(seen) else 1


if __name__ == "__main__":
    sys.exit(main())
