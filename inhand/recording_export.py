"""``inhand recording export``: recordings in the formats of other programs."""

import argparse
from collections.abc import Callable
from pathlib import Path

import inhand_recorder
from inhand_recorder.conversion import chosen_keys
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted

from inhand.exports.request import ExportRequest
from inhand.progress import progress_bar
from inhand.recording_convert import STEPS, add_selection, percent_of, selection_of
from inhand.results import write_json

Exporter = Callable[[ExportRequest, Path], dict[str, int]]

FORMATS = {
    "parquet": "tables of poses, labels and skeletons, a folder",
    "tum": "a folder as in the TUM RGB-D benchmark: pictures, depth, an object's poses",
    "mp4": "a video of a camera, with the outlines of objects drawn in, a file",
    "foxglove": "MCAP of Foxglove's schemas, for Foxglove, Lichtblick and Rerun, a file",
    "bop": "a data set of the BOP benchmark with masks and visibility, a folder",
}


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "write recordings in the formats of other programs"
    action = actions.add_parser(
        "export",
        help=text,
        description=text,
        epilog="; ".join(f"{name}: {about}" for name, about in FORMATS.items()),
    )
    action.add_argument("files", nargs="+", type=Path, metavar="IN", help="files or folders")
    action.add_argument("--to", choices=FORMATS, required=True, metavar="FORMAT", dest="format")
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", dest="out")
    add_selection(action)
    action.add_argument("--camera", metavar="NAME", help="which one, of several")
    action.add_argument("--object", metavar="NAME", help="which one, of several")
    action.add_argument(
        "--objects",
        type=Path,
        metavar="FOLDER",
        help="meshes of objects, NAME/mesh.ply, as a dataset's objects (mp4, bop)",
    )
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_export)


def _export(arguments: argparse.Namespace) -> int:
    export = _exporter(arguments.format)
    with inhand_recorder.open(arguments.files) as recording:
        selection = selection_of(arguments, recording)
        keys = tuple(chosen_keys(recording, selection))
        total = recording.count(keys)
        with progress_bar("messages", STEPS) as advance:
            request = ExportRequest(
                recording,
                keys,
                selection,
                camera=arguments.camera,
                object=arguments.object,
                objects=arguments.objects,
                on_message=percent_of(total, advance),
            )
            counts = export(request, arguments.out)
        damaged, apart = dict(recording.damaged), sum(recording.apart.values())
    print(f"{arguments.out}: " + ", ".join(f"{n:,} {name}" for name, n in counts.items()))
    for topic, count in damaged.items():
        print(f"  {topic}: {counted(count, 'damaged message')} left out")
    if apart:
        print(f"  {counted(apart, 'message')} that could not be read on their keys left out")
    if arguments.json is not None:
        values = {"output": str(arguments.out), "counts": counts, "damaged": damaged}
        write_json(arguments.json, {"exported": values})
    return DONE


def _exporter(name: str) -> Exporter:
    """Return what writes a format; only that one's library is imported."""
    if name == "parquet":
        from inhand.exports.parquet import export_parquet

        return export_parquet
    if name == "mp4":
        from inhand.exports.video import export_video

        return export_video
    if name == "bop":
        from inhand.exports.bop import export_bop

        return export_bop
    if name == "foxglove":
        from inhand.exports.foxglove import export_foxglove

        return export_foxglove
    from inhand.exports.tum import export_tum

    return export_tum
