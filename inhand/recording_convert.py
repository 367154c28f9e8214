"""``inhand recording convert``: merge, cut, filter and split recordings."""

import argparse
import math
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import inhand_recorder
from inhand_recorder.conversion import Selection, chosen_keys, convert_recording
from inhand_recorder.recording_reader import Recording
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.recording.layout import LATEST_NS
from inhand_runtime.wording import counted

from inhand.progress import progress_bar
from inhand.results import write_json

STEPS = 100
"""Steps of the progress bar, since one for each message would take longer than its copy."""


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "merge, cut, filter and split recordings"
    action = actions.add_parser("convert", help=text, description=text)
    action.add_argument("files", nargs="+", type=Path, metavar="IN", help="files or folders")
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    add_selection(action)
    action.add_argument(
        "--split-seconds", type=_seconds, default=0.0, metavar="S", help="OUT_000, OUT_001, …"
    )
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_convert)


def add_selection(action: argparse.ArgumentParser) -> None:
    """Add the arguments that say what of recordings is taken."""
    for name, text in (("--start", "from then on"), ("--end", "until before then")):
        action.add_argument(
            name,
            type=_time,
            metavar="T",
            help=f"{text}: seconds from the begin, or an ISO time (UTC without another zone)",
        )
    for name, text in (("--include", "only topics"), ("--exclude", "no topics")):
        action.add_argument(
            name,
            action="append",
            default=[],
            metavar="PATTERN",
            help=f"{text} that match, as pose/* or a whole key (again for more)",
        )


def selection_of(arguments: argparse.Namespace, recording: Recording) -> Selection:
    """Return what is selected; raises SettingsError for an end before the start."""
    start_ns = 0 if arguments.start is None else arguments.start(recording.start_ns)
    end_ns = LATEST_NS if arguments.end is None else arguments.end(recording.start_ns)
    if start_ns >= end_ns:
        raise SettingsError("--end is not behind --start: give a later end")
    return Selection(tuple(arguments.include), tuple(arguments.exclude), start_ns, end_ns)


def percent_of(total: int, advance: Callable[[], None]) -> Callable[[], None]:
    """Return what advances a bar of a hundred steps while it is called ``total`` times."""
    done = 0

    def step() -> None:
        nonlocal done
        before = done * STEPS // max(total, 1)
        done += 1
        for _ in range(min(done * STEPS // max(total, 1), STEPS) - before):
            advance()

    return step


def _convert(arguments: argparse.Namespace) -> int:
    with inhand_recorder.open(arguments.files) as recording:
        selection = selection_of(arguments, recording)
        total = recording.count(chosen_keys(recording, selection))
        with progress_bar("messages", STEPS) as advance:
            done = convert_recording(
                recording,
                arguments.output,
                selection,
                split_seconds=arguments.split_seconds,
                on_message=percent_of(total, advance),
            )
    for one in done.files:
        print(f"{one.path}: {counted(one.messages, 'message')}")
    for topic, count in done.damaged.items():
        print(f"  {topic}: {counted(count, 'damaged message')} left out")
    if done.apart:
        print(f"  {counted(done.apart, 'message')} that could not be read on their keys kept apart")
    if arguments.json is not None:
        files = [{"path": str(one.path), "messages": one.messages} for one in done.files]
        damaged = dict(done.damaged)
        write_json(arguments.json, {"converted": files, "damaged": damaged, "apart": done.apart})
    return DONE


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds < math.inf:
        raise argparse.ArgumentTypeError(f"write a number of seconds above 0, not {text!r}")
    return seconds


def _time(text: str) -> Callable[[int], int]:
    """Return what makes nanoseconds since the epoch of those of a recording's begin."""
    try:
        seconds = float(text)
    except ValueError:
        return _wall_time(text)
    if not 0.0 <= seconds < math.inf:
        raise argparse.ArgumentTypeError(f"write seconds from the begin, 0 or more, not {text!r}")
    return lambda begin_ns: begin_ns + round(1e9 * seconds)


def _wall_time(text: str) -> Callable[[int], int]:
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"write seconds from the begin, or a time as 2026-05-04T12:30:00Z, not {text!r}"
        ) from None
    moment = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
    whole = int(moment.replace(microsecond=0).timestamp())
    time_ns = 1_000_000_000 * whole + 1000 * moment.microsecond
    return lambda _: time_ns
