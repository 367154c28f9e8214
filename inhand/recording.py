"""``inhand recording``: look into recordings, verify them, and recover damaged ones."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inhand_capture.estimation.weights import DEFAULT_NETWORK, LANDMARKS
from inhand_recorder.inspection import RecordingInfo, inspect_recording
from inhand_recorder.missing_infos import add_infos
from inhand_recorder.recovery import RecoveryReport, recover_recording
from inhand_recorder.redaction import redaction_lines
from inhand_recorder.verification import examine_recording
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.recording.part_file import PART_SUFFIX
from inhand_runtime.wording import counted
from rich.table import Table

from inhand.looking import output
from inhand.recording_convert import add_action as add_convert_action
from inhand.recording_export import add_action as add_export_action
from inhand.recording_import import add_action as add_import_action
from inhand.recording_merge import add_action as add_merge_action
from inhand.recording_redact import add_action as add_redact_action
from inhand.results import listing, write_json
from inhand.retrack import add_action as add_retrack_action

RECOVERED_SUFFIX = ".recovered.mcap"
REPAIRED_SUFFIX = ".repaired.mcap"
COMPLETED_SUFFIX = ".skeletons.mcap"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    for name, run_action, text in (
        ("info", _info, "what is in recordings, whole or not"),
        ("verify", _verify, "whether they are whole and true; exit 1 when one is not"),
        ("recover", _recover, "save what is left of recordings that were cut off or damaged"),
        ("repair", _repair, "add the camera info that a recording lacks, from another one"),
        ("skeletons", _skeletons, "add the skeletons of the people in a recording's pictures"),
    ):
        action = actions.add_parser(name, help=text, description=text)
        action.add_argument("files", nargs="+", type=Path, metavar="FILE")
        action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
        action.set_defaults(run_action=run_action)
        if name == "repair":
            action.add_argument(
                "--info", type=Path, required=True, metavar="FILE", help="a recording that has it"
            )
        if name == "skeletons":
            _add_skeleton_arguments(action)
        if name in ("recover", "repair", "skeletons"):
            action.add_argument(
                "-o", "--output", type=Path, metavar="OUT", help="the file to write (of one FILE)"
            )
    add_retrack_action(actions)

    add_convert_action(actions)
    add_merge_action(actions)
    add_export_action(actions)
    add_import_action(actions)
    add_redact_action(actions)


def _add_skeleton_arguments(action: argparse.ArgumentParser) -> None:
    action.add_argument(
        "--network",
        type=lambda text: text if text in LANDMARKS else Path(text),
        default=DEFAULT_NETWORK,
        help=f"what finds people: {', '.join(LANDMARKS)}, or an ONNX file (default: "
        f"{DEFAULT_NETWORK})",
    )
    action.add_argument(
        "--replace", action="store_true", help="in place of the skeletons that it has"
    )
    action.add_argument(
        "--true",
        action="store_true",
        help="the true joints that labels of simulated people hold, in place of its skeletons",
    )


def run(arguments: argparse.Namespace) -> int:
    """Do one action; raises RecordingError, or SettingsError for a wrong use of ``-o``."""
    return int(arguments.run_action(arguments))


def _info(arguments: argparse.Namespace) -> int:
    infos = [inspect_recording(path) for path in arguments.files]
    for info in infos:
        output().print(_info_table(info))
        for line in (*info.clock, *info.faults, *redaction_lines(info.metadata)):
            print(f"  {line}")
    _result(arguments, "recordings", [_info_values(info) for info in infos])
    return 0


def _verify(arguments: argparse.Namespace) -> int:
    examined = {str(path): examine_recording(path) for path in arguments.files}
    for path, one in examined.items():
        count = len(one.problems)
        print(f"{path}: whole and true" if not count else f"{path}: {counted(count, 'problem')}")
        for line in one.problems:
            print(f"  {line}")
        for line in one.notes:
            print(f"  note: {line}")
    _result(arguments, "problems", {path: one.problems for path, one in examined.items()})
    return FAILED if any(one.problems for one in examined.values()) else DONE


def _recover(arguments: argparse.Namespace) -> int:
    if arguments.output is not None and len(arguments.files) > 1:
        raise SettingsError("-o names one output: give one FILE, or leave -o out")
    reports = []
    for path in arguments.files:
        report = recover_recording(path, arguments.output or _recovered(path))
        print(
            f"{report.output}: {counted(report.messages, 'message')} of "
            f"{counted(report.keys, 'key')}; "
            f"{counted(report.skipped_bytes, 'byte')} could not be saved"
        )
        for line in report.faults:
            print(f"  {line}")
        reports.append(_report_values(path, report))
    _result(arguments, "recovered", reports)
    return 0


def _repair(arguments: argparse.Namespace) -> int:
    if arguments.output is not None and len(arguments.files) > 1:
        raise SettingsError("-o names one output: give one FILE, or leave -o out")
    repaired = []
    for path in arguments.files:
        output = arguments.output or path.with_name(
            path.name.removesuffix(".mcap") + REPAIRED_SUFFIX
        )
        cameras = add_infos(path, arguments.info, output)
        print(f"{output}: with the info of {', '.join(cameras)}")
        repaired.append({"path": str(path), "output": str(output), "cameras": cameras})
    _result(arguments, "repaired", repaired)
    return DONE


def _skeletons(arguments: argparse.Namespace) -> int:
    # What estimates them is large, and no other action needs it.
    from inhand_capture.estimation.networks import convention_of, open_network, require_network

    from inhand.recorded_skeletons import add_skeletons

    if arguments.output is not None and len(arguments.files) > 1:
        raise SettingsError("-o names one output: give one FILE, or leave -o out")
    if arguments.true:
        return _true_skeletons(arguments)
    require_network(arguments.network)
    completed = []
    for path in arguments.files:
        output = _completed(path, arguments)
        cameras = add_skeletons(
            path,
            output,
            lambda: open_network(arguments.network),
            convention=convention_of(arguments.network),
            replace=arguments.replace,
        )
        for name, one in cameras.items():
            of = f"{one.with_people} of {counted(one.frames, 'frame')}"
            print(f"{output}: {name}: somebody in {of}")
            if one.unusable:
                print(f"  {counted(one.unusable, 'frame')} without skeletons: {one.reason}")
        values = {name: asdict(one) for name, one in cameras.items()}
        completed.append({"path": str(path), "output": str(output), "cameras": values})
    _result(arguments, "completed", completed)
    return DONE


def _true_skeletons(arguments: argparse.Namespace) -> int:
    from inhand.recorded_skeletons import true_skeletons

    completed = []
    for path in arguments.files:
        output = _completed(path, arguments)
        written = true_skeletons(path, output)
        print(f"{output}: true joints of {counted(written, 'frame')}")
        completed.append({"path": str(path), "output": str(output), "true": written})
    _result(arguments, "completed", completed)
    return DONE


def _completed(path: Path, arguments: argparse.Namespace) -> Path:
    """Return where a recording goes that gets skeletons."""
    output: Path | None = arguments.output
    return output or path.with_name(path.name.removesuffix(".mcap") + COMPLETED_SUFFIX)


def _recovered(path: Path) -> Path:
    stem = path.name.removesuffix(PART_SUFFIX).removesuffix(".mcap")
    return path.with_name(stem + RECOVERED_SUFFIX)


def _result(arguments: argparse.Namespace, name: str, value: Any) -> None:
    if arguments.json is not None:
        write_json(arguments.json, {name: value})


def _info_table(info: RecordingInfo) -> Table:
    state = "complete" if info.complete else "NOT COMPLETE: `inhand recording recover` saves it"
    table = listing(
        ("key", "message"),
        ("messages", "Hz", "bytes", "lost"),
        f"{info.path}: {counted(info.bytes, 'byte')}, {info.duration_s:.3f} s, {state}",
    )
    for key in info.keys:
        table.add_row(
            key.key,
            key.type,
            str(key.messages),
            f"{key.rate_hz:.2f}",
            f"{key.bytes:,}",
            str(key.lost),
        )
    return table


def _info_values(info: RecordingInfo) -> dict[str, Any]:
    return {
        "path": str(info.path),
        "bytes": info.bytes,
        "start_ns": info.start_ns,
        "end_ns": info.end_ns,
        "duration_s": info.duration_s,
        "messages": info.messages,
        "complete": info.complete,
        "unread_bytes": info.unread_bytes,
        "clock": info.clock,
        "faults": info.faults,
        "metadata": info.metadata,
        "keys": {
            key.key: {
                "type": key.type,
                "messages": key.messages,
                "bytes": key.bytes,
                "rate_hz": key.rate_hz,
                "lost": key.lost,
            }
            for key in info.keys
        },
    }


def _report_values(path: Path, report: RecoveryReport) -> dict[str, Any]:
    return {
        "path": str(path),
        "output": str(report.output),
        "messages": report.messages,
        "keys": report.keys,
        "skipped_bytes": report.skipped_bytes,
        "unchecked": report.unchecked,
        "undecodable": report.undecodable,
        "faults": report.faults,
    }
