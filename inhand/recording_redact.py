"""``inhand recording redact``: recordings without faces, or without people."""

import argparse
from pathlib import Path

from inhand_recorder.conversion import Selection, convert_recording
from inhand_runtime.exit_codes import DONE
from inhand_runtime.recording import RecordingError
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

    from inhand.redaction.redacted import RedactedRecording

    def new_finder() -> FaceFinder:
        return open_face_finder(open_network(DEFAULT_NETWORK), trust_skeletons=True, both_ends=True)

    output: Path = arguments.output
    if output.exists():
        raise RecordingError(f"{output} exists already: choose another name, or move it away")
    require_network(DEFAULT_NETWORK)
    require_face_detector()
    with (
        RedactedRecording(arguments.files, arguments.what) as recording,
        progress_bars({"looking": STEPS, "writing": STEPS}) as advance,
    ):
        frames = recording.count(recording.frame_keys)
        recording.look(new_finder, percent_of(frames, lambda: advance("looking")))
        done = convert_recording(
            recording,
            output,
            Selection(),
            on_message=percent_of(len(recording), lambda: advance("writing")),
        )
        counts = dict(recording.counts)
    print(f"{output}: {counted(sum(one.messages for one in done.files), 'message')}")
    for name, count in counts.items():
        print(f"  {name}: {count:,}")
    for topic, count in done.damaged.items():
        print(f"  {topic}: {counted(count, 'damaged message')} left out")
    if done.apart:
        print(f"  {counted(done.apart, 'message')} that could not be read on their keys left out")
    if arguments.json is not None:
        values = {"output": str(output), "hidden": arguments.what, "counts": counts}
        write_json(
            arguments.json,
            {"redacted": values, "damaged": dict(done.damaged), "apart": done.apart},
        )
    return DONE
