"""The faults: what each does to a rig, and undoes at its end."""

import itertools
import random
import resource
import signal
import subprocess
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass
from typing import TypeVar

import msgspec
import psutil
from inhand_schemas.keys import VERSION, parse_key
from inhand_schemas.topics import TOPICS

from inhand_lab.chaos.link import Condition
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.chaos.rig import INHAND, OBJECT, SERVICES, ChaosRig

P = TypeVar("P")

FLOOD_PAUSE_S = 0.02
Sent = tuple[str, bytes, str]
"""A message as it is put: its key, its bytes, and its encoding."""


@dataclass(frozen=True)
class Fault:
    """Something that goes wrong: in words ``what`` that is, what ``inflict`` does while its block
    runs, for how long, in seconds, and which service it may end, if any; ``of_site`` where a hub
    and a link are needed for it."""

    what: str
    inflict: Callable[[ChaosRig], AbstractContextManager[None]]
    lasts_s: float = 0.0
    victim: str | None = None
    of_site: bool = False


def _killed(service: str) -> Fault:
    @contextmanager
    def inflict(rig: ChaosRig) -> Iterator[None]:
        rig.process(service).kill()
        yield

    return Fault(f"the {service} is killed", inflict, victim=service)


def _frozen(service: str) -> Fault:
    @contextmanager
    def inflict(rig: ChaosRig) -> Iterator[None]:
        process = rig.process(service)
        process.suspend()
        try:
            yield
        finally:
            with suppress(psutil.NoSuchProcess):  # who ended it is told as well
                process.resume()

    return Fault(f"the {service} stands still for 8 s", inflict, lasts_s=8.0)


@contextmanager
def _flooded(rig: ChaosRig, messages: Iterable[Sent]) -> Iterator[None]:
    for number, (key, payload, encoding) in enumerate(messages):
        rig.session.put(key, payload, encoding=encoding)
        if number % DEFAULT_CHAOS.flood_pause_every == 0:
            time.sleep(FLOOD_PAUSE_S)
    yield


def _malformed(rig: ChaosRig) -> AbstractContextManager[None]:
    """On each stream bytes that are no message, or one of other fields."""
    draw = random.Random(0)

    def payloads() -> Iterator[bytes]:
        while True:
            yield draw.randbytes(draw.randrange(200))
            yield msgspec.msgpack.encode({"sequence": draw.choice((-1, "1", None, 1.5, [[]]))})
            yield msgspec.msgpack.encode({"sequence": 1, "time_ns": 2**63 - 1, "people": [[[]]]})

    keys = itertools.cycle(_keys(rig))
    chosen = zip(keys, payloads(), range(rig.messages), strict=False)
    return _flooded(rig, (_as_sent(key, data) for key, data, _ in chosen))


def _huge(rig: ChaosRig) -> AbstractContextManager[None]:
    payload = bytes(DEFAULT_CHAOS.huge_bytes)
    keys = _keys(rig) * DEFAULT_CHAOS.huge_messages
    return _flooded(rig, (_as_sent(key, payload) for key in keys))


def _of_other_releases(rig: ChaosRig) -> AbstractContextManager[None]:
    """Messages of a release that was, in an encoding of version 0, and of one to come, under the
    next version's keys and in its encoding."""

    def sent() -> Iterator[Sent]:
        payload = msgspec.msgpack.encode({"sequence": 1, "time_ns": time.time_ns(), "new": True})
        for key in itertools.cycle(_keys(rig)):
            _, _, encoding = _as_sent(key, payload)
            name, _, _ = encoding.rpartition(".v")
            yield key, payload, f"{name}.v0"
            yield key.replace(f"/@v{VERSION}/", f"/@v{VERSION + 1}/"), payload, f"{name}.v2"

    return _flooded(rig, itertools.islice(sent(), rig.messages))


@contextmanager
def _stuck_reader(rig: ChaosRig) -> Iterator[None]:
    reader = psutil.Popen(
        [*INHAND, "topics", "--config", str(rig.config), "--seconds", "60"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    try:
        time.sleep(3.0)  # until it reads
        reader.suspend()
        yield
    finally:
        reader.kill()
        reader.wait()


@contextmanager
def _twin(rig: ChaosRig) -> Iterator[None]:
    """A second tracker of the same name, which should refuse to start."""
    command = [*INHAND, "tracker", "--config", str(rig.configs["tracker"])]
    twin = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        twin.send_signal(signal.SIGTERM)
        twin.wait()


@contextmanager
def _full_disk(rig: ChaosRig) -> Iterator[None]:
    """Every write of the recorder fails, by a limit on the size of files."""
    recorder = rig.process("recorder")
    before = recorder.rlimit(resource.RLIMIT_FSIZE)
    recorder.rlimit(resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        yield
    finally:
        with suppress(psutil.NoSuchProcess):
            recorder.rlimit(resource.RLIMIT_FSIZE, before)


def _stepped(what: str, by_s: float) -> Fault:
    """The clock stays where it was set."""

    @contextmanager
    def inflict(rig: ChaosRig) -> Iterator[None]:
        rig.host.clock.step(by_s)
        yield

    return Fault(f"the clock is set {what}", inflict)


@contextmanager
def _unplugged(rig: ChaosRig) -> Iterator[None]:
    rig.host.plug.unlink()
    try:
        yield
    finally:
        rig.host.plug.touch()


@contextmanager
def _without_hub(rig: ChaosRig) -> Iterator[None]:
    hub = _required(rig.hub)
    hub.kill()
    try:
        yield
    finally:
        hub.start()


def _link(what: str, condition: Condition) -> Fault:
    def inflict(rig: ChaosRig) -> AbstractContextManager[None]:
        return _required(rig.link).being(condition)

    return Fault(f"the camera's link is {what} for 10 s", inflict, 10.0, of_site=True)


def _required(part: P | None) -> P:
    if part is None:
        raise ValueError("this fault is for a rig with a hub")
    return part


def _keys(rig: ChaosRig) -> list[str]:
    """A key of each stream, in names that the rig uses."""
    names = {"pose": OBJECT, "label": OBJECT, "health": "follower", "event": "drunk"}
    return [topic.key(rig.site, names.get(stream, "camera")) for stream, topic in TOPICS.items()]


def _as_sent(key: str, payload: bytes) -> Sent:
    return key, payload, TOPICS[parse_key(key).stream].encoding


FAULTS: dict[str, Fault] = {
    **{f"kill-{service}": _killed(service) for service in SERVICES},
    **{f"freeze-{service}": _frozen(service) for service in SERVICES},
    "malformed": Fault("malformed messages come on all streams", _malformed),
    "huge": Fault(
        f"{DEFAULT_CHAOS.huge_messages} messages of {DEFAULT_CHAOS.huge_bytes >> 20} MiB on each "
        "stream",
        _huge,
    ),
    "other-releases": Fault("messages of former and later releases come", _of_other_releases),
    "stuck-reader": Fault("a reader of everything stands still for 15 s", _stuck_reader, 15.0),
    "twin": Fault("a second tracker of the same name starts", _twin, 6.0),
    "full-disk": Fault("the recorder can write nothing for 8 s", _full_disk, 8.0),
    "clock-ahead": _stepped("an hour ahead", 3600.0),
    "clock-back": _stepped("back by an hour", -3600.0),
    "clock-leap": _stepped("back by a second, as by a leap", -1.0),
    "camera-gone": Fault("the camera is unplugged for 8 s", _unplugged, 8.0),
    "hub-away": Fault("the hub is killed, and started after 5 s", _without_hub, 5.0, of_site=True),
    "link-cut": _link("cut", Condition(cut=True)),
    "link-slow": _link("slow (500 kB a second)", Condition(bytes_per_s=500e3)),
    "link-late": _link("200 ms late", Condition(delay_s=0.2)),
    "link-lossy": _link("lossy (2 % of packets come 300 ms later)", Condition(lost=0.02)),
}
"""All faults, by the name under which `inhand chaos` has them."""
