"""``inhand recording import``: recordings made of what other programs recorded."""

import argparse
from pathlib import Path

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, require_name

from inhand.progress import progress_bar
from inhand.results import write_json


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "make a recording of what another program recorded"
    action = actions.add_parser("import", help=text, description=text)
    action.add_argument("source", type=Path, metavar="IN")
    action.add_argument(
        "--from", choices=("tum",), required=True, dest="format", help="a TUM RGB-D folder"
    )
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    action.add_argument("--rig", default="rig", metavar="NAME", help="its rig (default: rig)")
    action.add_argument("--camera", default="camera", metavar="NAME", help="default: camera")
    action.add_argument("--object", metavar="NAME", help="whose poses the ground truth has")
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_import)


def _import(arguments: argparse.Namespace) -> int:
    from inhand.imports.foreign import write_imported
    from inhand.imports.tum import messages_of, read_tum

    site = _site(arguments)
    folder = read_tum(arguments.source, arguments.object)
    about = {"source": arguments.source.name, "format": arguments.format}
    frames = len(folder.frames)
    total = 1 + frames * (1 if folder.truth is None else 2)
    with progress_bar("messages", total) as advance:
        messages = messages_of(folder, arguments.camera)
        counts = write_imported(arguments.output, site, messages, about, advance)
    print(f"{arguments.output}: " + ", ".join(f"{n:,} {topic}" for topic, n in counts.items()))
    without_depth = sum(depth is None for _, _, depth, _ in folder.frames)
    if folder.depth and without_depth:
        print(f"  {without_depth:,} of {frames:,} frames have no depth within 20 ms")
    if arguments.json is not None:
        write_json(arguments.json, {"output": str(arguments.output), "counts": counts})
    return DONE


def _site(arguments: argparse.Namespace) -> Site:
    """Return the rig; raises SettingsError for names that no key can have."""
    try:
        for what in ("camera", "object"):
            if (name := getattr(arguments, what)) is not None:
                require_name(what, name)
        return Site(rig=arguments.rig)
    except KeyFormatError as error:
        raise SettingsError(str(error)) from None
