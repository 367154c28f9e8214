"""``inhand recording redact``: recordings without faces, or without people."""

import argparse
from collections.abc import Callable
from pathlib import Path

from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted

from inhand.progress import progress_bars
from inhand.recording_convert import STEPS, percent_of
from inhand.results import write_json


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "hide faces, or whole people, in colour, depth and previews"
    action = actions.add_parser("redact", help=text, description=text)
    action.add_argument("files", nargs="+", type=Path, metavar="IN", help="files or folders")
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    what = action.add_mutually_exclusive_group(required=True)
    for name, help_text in (
        ("faces", "heads, as `mask_faces` hides them live"),
        ("people", "whole people, and what they hold"),
    ):
        what.add_argument(
            f"--{name}", action="store_const", const=name, dest="what", help=help_text
        )
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_redact)


def _redact(arguments: argparse.Namespace) -> int:
    # What finds people is large, and no other action needs it.
    from inhand_capture.estimation.networks import open_network, require_network
    from inhand_capture.estimation.weights import DEFAULT_NETWORK
    from inhand_capture.faces.finder import FaceFinder, open_face_finder, require_face_detector

    from inhand.redaction.redacted import redact_recording

    def new_finder() -> FaceFinder:
        return open_face_finder(open_network(DEFAULT_NETWORK), trust_skeletons=True, both_ends=True)

    require_network(DEFAULT_NETWORK)
    require_face_detector()
    output: Path = arguments.output
    with progress_bars({"looking": STEPS, "writing": STEPS}) as advance:
        steps: dict[str, Callable[[], None]] = {}

        def on_step(name: str, total: int) -> None:
            if name not in steps:
                steps[name] = percent_of(total, lambda: advance(name))
            steps[name]()

        done = redact_recording(arguments.files, output, arguments.what, new_finder, on_step)
    written, counts = done.written, dict(done.counts)
    print(f"{output}: {counted(sum(one.messages for one in written.files), 'message')}")
    for name, count in counts.items():
        print(f"  {name}: {count:,}")
    for topic, count in written.damaged.items():
        print(f"  {topic}: {counted(count, 'damaged message')} left out")
    if done.apart:
        apart = counted(done.apart, "message")
        print(f"  {apart} that could not be read on their keys left out")
    if arguments.json is not None:
        values = {"output": str(output), "hidden": arguments.what, "counts": counts}
        write_json(
            arguments.json,
            {"redacted": values, "damaged": dict(written.damaged), "apart": done.apart},
        )
    return DONE
