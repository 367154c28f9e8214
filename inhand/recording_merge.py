"""``inhand recording merge``: recordings of several hosts made one, by one clock."""

import argparse
from contextlib import ExitStack
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import inhand_recorder
import numpy as np
from inhand_recorder.merging import (
    Host,
    HostClock,
    Merged,
    clock_in_words,
    clock_of_shared,
    hosts_of,
    merge_recordings,
    shared_receptions,
)
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.extras import missing_extra
from inhand_runtime.wording import counted
from inhand_schemas.messages import Skeletons
from inhand_schemas.topics import SKELETONS

from inhand.progress import progress_bar
from inhand.recording_convert import STEPS, percent_of
from inhand.results import write_json

if TYPE_CHECKING:
    from inhand_calibration.from_people.skeletons import CameraSkeletons

NEEDED = 'pip install "inhand[calibration]"'
"""The mend where what estimates clocks from people is not installed."""
LEAST_DRIFT_DEVIATIONS = 3.0
"""A drift is taken as one where it is so many times its standard deviation."""


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "make recordings of several hosts one, by the first one's clock"
    action = actions.add_parser("merge", help=text, description=text)
    action.add_argument(
        "hosts", nargs="+", type=Path, metavar="HOST", help="a file, or a folder, of each host"
    )
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    action.add_argument(
        "--exclude",
        action="append",
        default=[],
        metavar="PATTERN",
        help="no topics that match, as health/* or a whole key (again for more)",
    )
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_merge)


def _merge(arguments: argparse.Namespace) -> int:
    if len(arguments.hosts) < 2:
        raise SettingsError("give the recordings of two hosts or more")
    with ExitStack() as opened:
        recordings = [
            opened.enter_context(inhand_recorder.open([path])) for path in arguments.hosts
        ]
        hosts = hosts_of(recordings, arguments.exclude)
        clocks = [HostClock(0, "all times are by this clock", 0)]
        clocks += [_clock_of(hosts[0], other) for other in hosts[1:]]
        total = sum(host.recording.count(host.keys) for host in hosts)
        with progress_bar("messages", STEPS) as advance:
            merged = merge_recordings(hosts, clocks, arguments.output, percent_of(total, advance))
    _say(merged, clocks)
    if arguments.json is not None:
        write_json(arguments.json, {"merged": _values(merged, clocks)})
    return DONE


def _clock_of(first: Host, other: Host) -> HostClock:
    """Estimate a host's clock: by the same messages, or else by the same people."""
    shared = clock_of_shared(shared_receptions(first, other), first.name)
    return shared or _clock_of_people(first, other)


def _clock_of_people(first: Host, other: Host) -> HostClock:
    """Estimate a host's clock from people whom cameras of both saw; taken as it is where there are
    none, or nothing is installed that could tell."""
    try:
        from inhand_calibration.errors import CalibrationError
        from inhand_calibration.from_people.calibration import calibrate_from_people
    except ModuleNotFoundError as error:
        if missing_extra(error) is None:
            raise
        return HostClock(0, f"taken as it is: to estimate it from people, {NEEDED}")
    why = "no camera of either saw people"
    clocks = []
    for own, seen in product(_cameras(first), _cameras(other)):
        try:
            calibration = calibrate_from_people(
                [_skeletons(first, own), _skeletons(other, seen)], reference=own
            )
        except CalibrationError as error:
            why = str(error)
            continue
        camera = calibration.cameras[seen]
        drift, unsure = camera.clock_drift_ppm, camera.clock_drift_deviation_ppm
        sure = abs(drift) > LEAST_DRIFT_DEVIATIONS * unsure
        clocks.append(
            HostClock(
                camera.clock_offset_ns,
                f"people whom {_short(seen)} and {_short(own)} saw",
                camera.clock_deviation_ns,
                1e-6 * drift if sure else 0.0,
                calibration.made_at_ns,
            )
        )
    if not clocks:
        return HostClock(0, f"taken as it is, for nothing says how far it is off: {why}")
    return min(clocks, key=lambda clock: clock.deviation_ns or 0)


def _short(key: str) -> str:
    """RIG/CAMERA of a key."""
    parts = key.split("/")
    return f"{parts[-3]}/{parts[-1]}"


def _cameras(host: Host) -> list[str]:
    return [key for key in host.keys if host.recording.keys[key] is SKELETONS]


def _skeletons(host: Host, key: str) -> "CameraSkeletons":
    """Return all people of a camera in the order of their times."""
    from inhand_calibration.from_people.skeletons import CameraSkeletons

    rows = sorted(
        (
            (frame.time_ns, person.id, person)
            for one in host.recording.read(key)
            if isinstance(frame := one.message, Skeletons)
            for person in frame.people
        ),
        key=lambda row: row[:2],
    )
    missing = np.array([[state == "missing" for state in p.states] for *_, p in rows], bool)
    joints = np.array([person.joints for *_, person in rows], float).reshape(-1, 20, 3)
    joints[missing.reshape(-1, 20)] = np.nan
    return CameraSkeletons(
        key,
        np.array([time_ns for time_ns, *_ in rows], np.int64),
        np.array([number for _, number, _ in rows], np.int64),
        joints,
        np.array([person.confidences for *_, person in rows], float).reshape(-1, 20),
    )


def _say(merged: Merged, clocks: list[HostClock]) -> None:
    print(f"{merged.path}: {counted(merged.messages, 'message')}")
    for (name, messages), clock in zip(merged.by_source.items(), clocks, strict=True):
        unsure = "" if not clock.deviation_ns else f" ± {1e-6 * clock.deviation_ns:.1f}"
        drift = f", and {1e6 * clock.drift:+.1f} µs each second" if clock.drift else ""
        print(f"  {name}: {counted(messages, 'message')}")
        print(f"    {1e-6 * clock.offset_ns:+.1f}{unsure} ms{drift}: {clock.evidence}")
    if merged.repeated:
        print(f"  {counted(merged.repeated, 'message')} that another host has too taken once")
    for name, taken in merged.unlike.items():
        print(
            f"  {name} is not the same of all hosts: all are kept, and readers take that of {taken}"
        )
    for topic, count in merged.damaged.items():
        print(f"  {topic}: {counted(count, 'damaged message')} left out")


def _values(merged: Merged, clocks: list[HostClock]) -> dict[str, object]:
    return {
        "path": str(merged.path),
        "messages": merged.messages,
        "repeated": merged.repeated,
        "damaged": dict(merged.damaged),
        "unlike": dict(merged.unlike),
        "hosts": {
            name: {
                "messages": messages,
                "offset_ns": clock.offset_ns,
                "deviation_ns": clock.deviation_ns,
                "drift_ppm": 1e6 * clock.drift,
                "evidence": clock.evidence,
                "clock": clock_in_words(clock),
            }
            for (name, messages), clock in zip(merged.by_source.items(), clocks, strict=True)
        },
    }
