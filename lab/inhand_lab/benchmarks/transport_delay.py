"""Measures the delay of a frame from one process to another, beside Zenoh by itself and dora-rs.

A delay is from the call that puts a frame to its bytes being there in the reader's callback. All
ways carry the same bytes: a simulated Kinect's frame, coded as on the wire.
"""

import socket
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from multiprocessing import get_context

import numpy as np
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import RgbdFrame
from inhand_schemas.topics import RGBD

from inhand_lab.benchmarks import transport_ends
from inhand_lab.benchmarks.dora_delay import DORA, measure_dora, why_not_measured
from inhand_lab.benchmarks.parameters import DEFAULT_TRANSPORT, TransportParameters
from inhand_lab.benchmarks.transport_ends import RAW, WAYS, Exchange, Times
from inhand_lab.world.messages import pixels_message
from inhand_lab.world.simulation import simulate

INTERACTION = "drinkFromMug"


@dataclass(frozen=True)
class WayDelay:
    """Milliseconds that frames were under way, and how many of those that were sent were lost.

    ``ratio`` is how many times longer the median is than that of Zenoh by itself, and ``ratios``
    are those of each pair of processes that both went through. Where no frame came there are none.
    """

    way: str
    sent: int
    lost: int
    p50_ms: float | None = None
    p99_ms: float | None = None
    ratio: float | None = None
    ratios: tuple[float, ...] = ()


@dataclass(frozen=True)
class TransportDelays:
    """Delays of frames of so many bytes; ``without_dora`` says why dora-rs was not measured."""

    frame_bytes: int
    ways: tuple[WayDelay, ...]
    without_dora: str | None


def measure_transport(parameters: TransportParameters = DEFAULT_TRANSPORT) -> TransportDelays:
    """Measure Zenoh's ways in turns, frame by frame, in several pairs of processes, as one pair may
    be faster than another for as long as it lives; then dora-rs, where it is installed, in one.

    Raises InhandError.
    """
    frame = simulated_frame(parameters)
    payload = RGBD.encode(frame)
    pairs = [_exchanged(frame, parameters) for _ in range(parameters.pairs)]
    delays = {way: [_delays_ms(*pair, way, parameters) for pair in pairs] for way in WAYS}
    if not all(map(len, delays[RAW])):
        raise InhandError("Zenoh by itself delivered no frame: there is nothing to compare with")
    counted = parameters.pairs * (parameters.frames - parameters.first_frames)
    rows = [_row(way, delays[way], delays[RAW], counted) for way in WAYS]
    without_dora = why_not_measured()
    if without_dora is None:
        longer = replace(parameters, frames=parameters.first_frames + counted)
        sent, came = measure_dora(payload, longer)
        dora = _delays_ms({DORA: sent}, {DORA: came}, DORA, longer)
        rows.append(_row(DORA, [dora], [np.concatenate(delays[RAW])], counted))
    return TransportDelays(len(payload), tuple(rows), without_dora)


def simulated_frame(parameters: TransportParameters) -> RgbdFrame:
    """Return a simulated Kinect's frame, coded as on the wire."""
    shown = simulate(INTERACTION, 0, parameters.seed, parameters.shown_frame + 1)
    return pixels_message(shown.render(parameters.shown_frame), sequence=0, time_ns=0)


def _exchanged(frame: RgbdFrame, parameters: TransportParameters) -> tuple[Times, Times]:
    """Send frames from one new process to another, and return when each was put and there."""
    context = get_context("spawn")
    exchange = Exchange(_free_addresses(), frame, parameters.frames, parameters.frame_rate)
    with ProcessPoolExecutor(2, context, transport_ends.begin, (context.Event(),)) as pool:
        came = pool.submit(transport_ends.receive, exchange)
        sent = pool.submit(transport_ends.send, exchange)
        arrived = came.result()  # first: why it failed, where it did, is what the sender waits for
        return sent.result(), arrived


def _free_addresses() -> Mapping[str, str]:
    """Addresses of this machine that nobody uses, one for each way."""
    with ExitStack() as stack:
        addresses = {}
        for way in WAYS:
            taken = stack.enter_context(socket.socket())
            taken.bind(("127.0.0.1", 0))
            addresses[way] = f"tcp/127.0.0.1:{taken.getsockname()[1]}"
        return addresses


def _delays_ms(sent: Times, came: Times, way: str, parameters: TransportParameters) -> np.ndarray:
    """Milliseconds that those frames of a way were under way that count and came."""
    counted = range(parameters.first_frames, parameters.frames)
    return np.array([(came[way][n] - sent[way][n]) / 1e6 for n in counted if n in came[way]])


def _row(
    way: str, delays_ms: Sequence[np.ndarray], usual_ms: Sequence[np.ndarray], counted: int
) -> WayDelay:
    """The row of a way's delays in each pair of processes, beside Zenoh's by itself in the same."""
    every = np.concatenate(delays_ms)
    lost = counted - len(every)
    if lost == counted:
        return WayDelay(way, counted, lost)
    p50_ms, p99_ms = np.percentile(every, [50, 99]).tolist()
    ratios = tuple(
        float(np.median(one) / np.median(usual))
        for one, usual in zip(delays_ms, usual_ms, strict=True)
        if len(one)
    )
    ratio = p50_ms / float(np.median(np.concatenate(usual_ms)))
    return WayDelay(way, counted, lost, p50_ms, p99_ms, ratio, ratios)
