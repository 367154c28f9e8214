"""``inhand label``: writes an object's labels between a person's keyframes beside a recording.

Without keyframes it serves the page on which a person sets them.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from inhand_lab.labelling.assisted_labels import AssistedLabels, assist
from inhand_lab.labelling.interpolation import Interpolated, interpolate
from inhand_lab.labelling.keyframes import KeyframeFile, load_keyframes
from inhand_lab.labelling.labelled_copy import (
    Labels,
    labelled_path,
    require_labels_wanted,
    write_labels,
)
from inhand_lab.labelling.scene import Scene, check_keyframes, load_scene
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted
from inhand_runtime.writable import require_writable_file
from inhand_tracker.shape.shape import ObjectShape, load_shape
from inhand_tracker.shape.viewpoints import count_views, find_viewpoints

from inhand.progress import progress_bars
from inhand.results import write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument("recording", type=Path, metavar="RECORDING")
    parser.add_argument("--object", metavar="NAME", help="which object is labelled")
    parser.add_argument(
        "--keyframes",
        type=Path,
        metavar="FILE",
        help="its poses in some frames (default: they are set on a page in the browser)",
    )
    parser.add_argument(
        "--assisted", action="store_true", help="refine the poses between keyframes by the images"
    )
    parser.add_argument(
        "--dataset",
        type=Path,
        metavar="FOLDER",
        help="the dataset with objects/NAME (default: the folder above the recording's)",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="OUT", help="(default: RECORDING.labelled.mcap)"
    )
    parser.add_argument(
        "--replace", action="store_true", help="in place of the labels that the object has"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result there")


def run(arguments: argparse.Namespace) -> int:
    """Write the labelled copy, or serve the page; raises InhandError."""
    if arguments.keyframes is None:
        return _serve(arguments)
    if arguments.object is None:
        raise SettingsError("--keyframes are of an object: give --object NAME as well")
    path, name = arguments.recording, arguments.object
    output = arguments.output or labelled_path(path)
    require_writable_file(output)
    contents = load_keyframes(arguments.keyframes)
    shape = load_shape(_dataset(arguments) / "objects" / name)
    scene = load_scene(path, contents.camera)
    check_keyframes(scene, contents, name)
    require_labels_wanted(scene, name, output, replace=arguments.replace)
    way = interpolate(contents.keyframes, scene.times_ns, scene.joints, shape.symmetries)
    found = _assisted(scene, contents, way, shape) if arguments.assisted else _plain(way)
    about = {
        "object": name,
        "keyframes": str(len(contents.keyframes)),
        "assisted": "yes" if arguments.assisted else "no",
    }
    write_labels(scene, name, found.labels, output, about)
    _report(arguments, output, way, found)
    return DONE


def _serve(arguments: argparse.Namespace) -> int:
    """Serve the labelling page until Ctrl-C."""
    from inhand_studio.labelling_page.alone import serve_alone

    for option in ("assisted", "output", "replace", "json"):
        if getattr(arguments, option):
            raise SettingsError(
                f"--{option} is for labels between keyframes: give --keyframes FILE, or leave it "
                "out and choose on the page"
            )
    dataset, name = _dataset(arguments), arguments.object
    if not arguments.recording.is_file():
        raise SettingsError(f"{arguments.recording} does not exist: check the path")
    if name is not None:
        load_shape(dataset / "objects" / name)
    serve_alone(dataset, arguments.recording, name)
    return DONE


def _plain(way: Interpolated) -> AssistedLabels:
    """Return interpolated labels as they are; nothing is doubted where nobody looked."""
    labels = Labels(way.translations, way.rotations, way.absent)
    return AssistedLabels(labels, np.full(len(way.absent), np.nan))


def _assisted(
    scene: Scene, contents: KeyframeFile, way: Interpolated, shape: ObjectShape
) -> AssistedLabels:
    with progress_bars({"viewpoints": count_views(), "refining": len(way.stretches)}) as advance:
        viewpoints = find_viewpoints(shape, on_view=lambda: advance("viewpoints"))
        return assist(
            scene,
            contents.keyframes,
            way,
            (shape, viewpoints),
            on_stretch=lambda: advance("refining"),
        )


def _report(
    arguments: argparse.Namespace, output: Path, way: Interpolated, found: AssistedLabels
) -> None:
    """Say what was written, and where it should be looked at."""
    given, absent = int(found.labels.given.sum()), int(way.absent.sum())
    frames, worst = len(way.absent), found.worst_frame
    print(
        f"{output}: {given} of {counted(frames, 'frame')} with a pose of {arguments.object}, "
        f"{absent} without it"
    )
    for note in way.notes:
        print(f"  {note}")
    if worst is not None:
        print(f"  least sure is frame {worst}: it may be {100 * found.doubts[worst]:.1f} cm off")
    if arguments.json is not None:
        values: dict[str, Any] = {
            "output": str(output),
            "frames": frames,
            "labelled": given,
            "absent": absent,
            "notes": way.notes,
            "doubts_m": [one if np.isfinite(one) else None for one in found.doubts.tolist()],
            "worst_frame": worst,
        }
        write_json(arguments.json, values)


def _dataset(arguments: argparse.Namespace) -> Path:
    return Path(arguments.dataset or arguments.recording.absolute().parent.parent)
