"""Measures what a hub costs by the number of rigs, and what its encryption and rules do.

Each rig has a camera, a tracker, a recorder and a viewer, which publish and read messages of true
sizes at true rates through the hub; nothing else of Inhand runs. The machine is shared by the hub
and both ends, so that its own share is what counts, and delays grow where the machine is full.
"""

import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.synchronize import Event
from typing import TypeVar

import msgspec
import numpy as np
import psutil
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import ObjectPose, Pose, Preview, Skeletons
from inhand_schemas.topics import POSE, PREVIEW, RGBD, SKELETONS

from inhand_lab.benchmarks import hub_ends
from inhand_lab.benchmarks.hub_ends import Delays, Load, RigEnds, Sent, Stream
from inhand_lab.benchmarks.parameters import HubCostParameters
from inhand_lab.benchmarks.raw_zenoh import raw_router
from inhand_lab.benchmarks.transport_delay import INTERACTION, simulated_frame
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import simulate

N = TypeVar("N")

READERS = {RGBD.stream: "tracker", POSE.stream: "viewer"}
"""Whose delays are told, by stream: a frame to its tracker, a pose to who looks."""
STUCK = "studio"
"""The role of the reader that stands still: it reads more than any other."""


@dataclass(frozen=True)
class StreamDelay:
    """Milliseconds that messages of a stream were under way in all rigs, the smallest and largest
    median of a rig, and the share of those sent that did not come."""

    p50_ms: float
    p99_ms: float
    lowest_p50_ms: float
    highest_p50_ms: float
    lost: float


@dataclass(frozen=True)
class HubCost:
    """A hub with some rigs: cores and MB that it took, how busy the machine was, as a share, frames
    that each rig sent a second, and delays by stream of the rigs in which nobody stood still."""

    rigs: int
    stuck: bool
    hub_cores: float
    hub_mb: float
    busy: float
    frame_rate: float
    delays: Mapping[str, StreamDelay]


@dataclass(frozen=True)
class SecurityCost:
    """Median milliseconds of a stream through the hub of a site of some rigs, and through a router
    of the same machine that encrypts nothing and has no rules, with the ratio in each pair of
    processes."""

    stream: str
    rigs: int
    hub_ms: float
    plain_ms: float
    ratios: tuple[float, ...]

    @property
    def ratio(self) -> float:
        """How many times longer messages are under way through the hub."""
        return self.hub_ms / self.plain_ms


@dataclass(frozen=True)
class Routers:
    """Where messages go: the rigs of a hub, which is the process ``hub``; a rig that is all of the
    site of another hub; and a rig at a plain router, which is yet to be run."""

    rigs: tuple[RigEnds, ...]
    hub: int
    alone: RigEnds
    plain: RigEnds


@dataclass(frozen=True)
class HubCosts:
    """All of it, and the bytes of each message by stream."""

    message_bytes: Mapping[str, int]
    rigs: tuple[HubCost, ...]
    security: tuple[SecurityCost, ...]


def hub_steps(parameters: HubCostParameters) -> int:
    """Return how often ``measure_hub`` calls ``on_progress``."""
    return len(parameters.rig_counts) + 1 + parameters.pairs


def measure_hub(
    routers: Routers, on_progress: Callable[[], None], parameters: HubCostParameters
) -> HubCosts:
    """Measure a hub by its rigs, and two hubs beside a plain router; raises InhandError."""
    streams, rigs = rig_streams(parameters), routers.rigs

    def load(*chosen: RigEnds) -> Load:
        return Load(chosen, streams, parameters.warming_s, parameters.measured_s, (routers.hub,))

    costs = []
    for count in parameters.rig_counts:
        costs.append(_cost(*_exchanged(load(*rigs[:count])), stuck=False))
        on_progress()
    with _standing_still(rigs[0]) as begin:
        costs.append(_cost(*_exchanged(load(*rigs[: parameters.stuck_rigs]), begin), stuck=True))
    on_progress()
    ways = {len(rigs): rigs[0], 1: routers.alone, 0: routers.plain}
    pairs = []
    with _plain_router(routers.plain):
        for number in range(parameters.pairs):
            turns = turned(list(ways), number)
            _, delays = _exchanged(load(*(ways[one] for one in turns)))
            pairs.append({one: _of_rig(delays, place) for place, one in enumerate(turns)})
            on_progress()
    sizes = {name: len(msgspec.msgpack.encode(one.message)) for name, one in streams.items()}
    security = [_security(name, size, pairs) for size in ways if size for name in READERS]
    return HubCosts(sizes, tuple(costs), tuple(security))


def turned(names: list[N], by: int) -> list[N]:
    """Return names in another order each time: none comes always after the same one."""
    by %= len(names)
    return names[by:] + names[:by]


def rig_streams(parameters: HubCostParameters) -> dict[str, Stream]:
    """Return what a rig of one camera publishes, by stream: each message is sent often."""
    transport = parameters.transport
    shown = simulate(INTERACTION, 0, transport.seed, transport.shown_frame + 1)
    person = person_message(shown, transport.shown_frame)
    pose = Pose((0.1, 0.2, 1.5), (1.0, 0.0, 0.0, 0.0))
    tracked = ObjectPose(
        sequence=0,
        time_ns=0,
        object="mug",
        camera="camera",
        state="tracked",
        confidence=0.9,
        person=person.id,
        camera_from_object=pose,
        rig_from_object=pose,
        covariance=tuple(np.linspace(0.001, 0.002, 36).tolist()),
        person_joints=person.joints,
    )
    jpeg = np.random.default_rng(transport.seed).bytes(parameters.preview_bytes)
    rate = transport.frame_rate
    return {
        RGBD.stream: Stream(simulated_frame(transport), rate),
        SKELETONS.stream: Stream(Skeletons(sequence=0, time_ns=0, people=(person,)), rate),
        POSE.stream: Stream(tracked, rate, parameters.tracking_s),
        PREVIEW.stream: Stream(
            Preview(sequence=0, time_ns=0, width=320, height=240, jpeg=jpeg),
            parameters.preview_rate,
        ),
    }


def _exchanged(load: Load, begin: Callable[[], None] = lambda: None) -> tuple[Sent, Delays]:
    """Send from one new process to another; ``begin`` is called while they start."""
    context = get_context("spawn")
    with ProcessPoolExecutor(2, context, hub_ends.begin, (context.Event(),)) as pool:
        came = pool.submit(hub_ends.receive, load)
        sent = pool.submit(hub_ends.send, load)
        begin()
        arrived = came.result()  # first: why it failed, where it did, is what the sender waits for
        return sent.result(), arrived


@contextmanager
def _standing_still(rig: RigEnds) -> Iterator[Callable[[], None]]:
    """Give what has a reader of everything stand still from its first message on."""
    context = get_context("spawn")
    reads = context.Event()
    reader = context.Process(target=hub_ends.stand_still, args=(rig, STUCK, reads), daemon=True)

    def begin() -> None:
        if not reads.wait(hub_ends.READY_S):
            raise InhandError(f"the {STUCK} that is to stand still read nothing")
        psutil.Process(reader.pid).send_signal(signal.SIGSTOP)

    reader.start()
    try:
        yield begin
    finally:
        reader.kill()
        reader.join()


@contextmanager
def _plain_router(plain: RigEnds) -> Iterator[None]:
    context = get_context("spawn")
    runs = context.Event()
    (address,) = plain.members[STUCK].connect
    router = context.Process(target=_run_plain, args=(address, runs), daemon=True)
    router.start()
    try:
        if not runs.wait(hub_ends.READY_S):
            raise InhandError(f"a plain router cannot listen at {address}")
        yield
    finally:
        router.kill()
        router.join()


def _run_plain(address: str, runs: Event) -> None:
    with raw_router(address):
        runs.set()
        while True:
            time.sleep(1.0)


def _cost(sent: Sent, delays: Delays, *, stuck: bool) -> HubCost:
    """Say what the hub cost; a rig in which somebody stands still does not count for delays."""
    rigs = sorted({rig for rig, _ in sent.messages})
    told = rigs[1:] if stuck and len(rigs) > 1 else rigs
    frames = sum(sent.messages[rig, RGBD.stream] for rig in rigs)
    return HubCost(
        len(rigs),
        stuck,
        sent.cpu_s / sent.passed_s,
        sent.mb,
        sent.busy,
        frames / len(rigs) / sent.passed_s,
        {stream: _delay(sent, delays, told, stream) for stream in READERS},
    )


def _delay(sent: Sent, delays: Delays, rigs: Sequence[int], stream: str) -> StreamDelay:
    of_rigs = [np.array(delays[rig, stream, READERS[stream]]) for rig in rigs]
    if not all(map(len, of_rigs)):
        raise InhandError(f"no {stream} of a rig came through the hub")
    medians = [float(np.median(one)) for one in of_rigs]
    p50_ms, p99_ms = np.percentile(np.concatenate(of_rigs), [50, 99]).tolist()
    count = sum(sent.messages[rig, stream] for rig in rigs)
    lost = 1.0 - sum(map(len, of_rigs)) / count
    return StreamDelay(p50_ms, p99_ms, min(medians), max(medians), max(lost, 0.0))


def _of_rig(delays: Delays, rig: int) -> dict[str, np.ndarray]:
    return {stream: np.array(delays[rig, stream, role]) for stream, role in READERS.items()}


PairDelays = Mapping[int, Mapping[str, np.ndarray]]
"""Delays in a pair of processes, by the number of rigs of the hub's site, 0 for the plain router,
and by stream."""


def _security(stream: str, rigs: int, pairs: Sequence[PairDelays]) -> SecurityCost:
    hub, plain = ([pair[size][stream] for pair in pairs] for size in (rigs, 0))
    if not all(map(len, (*hub, *plain))):
        raise InhandError(f"no {stream} came by one of the routers")
    ratios = tuple(
        float(np.median(one) / np.median(usual)) for one, usual in zip(hub, plain, strict=True)
    )
    hub_ms, plain_ms = (float(np.median(np.concatenate(side))) for side in (hub, plain))
    return SecurityCost(stream, rigs, hub_ms, plain_ms, ratios)
