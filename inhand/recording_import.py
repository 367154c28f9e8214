"""``inhand recording import``: recordings made of what other programs recorded."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE
from inhand_runtime.wording import counted
from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import Site, require_name

from inhand.progress import progress_bar
from inhand.results import write_json

if TYPE_CHECKING:
    from inhand.imports.foreign import LeftOut


FIRST_CLOCK_NS = 946_684_800_000_000_000
"""Nanoseconds since the epoch of the year 2000: times before it are of no clock that was set."""
OPTIONS: dict[str, set[str]] = {
    "tum": {"object"},
    "ros": {"colour", "depth", "camera_info"},
    "bop": {"frame_rate"},
    "kinect": set(),
}
"""Options that belong to a format alone."""


def add_action(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the action and its arguments."""
    text = "make a recording of what another program recorded"
    action = actions.add_parser("import", help=text, description=text)
    action.add_argument("source", type=Path, metavar="IN")
    action.add_argument(
        "--from",
        choices=tuple(OPTIONS),
        required=True,
        dest="format",
        help="a TUM RGB-D folder; a bag of ROS 1 or 2, also of a RealSense, or MCAP with messages "
        "of ROS 2; a scene of BOP; a recording of an Azure Kinect (MKV)",
    )
    action.add_argument("-o", "--output", type=Path, required=True, metavar="OUT")
    action.add_argument("--rig", default="rig", metavar="NAME", help="its rig (default: rig)")
    action.add_argument("--camera", default="camera", metavar="NAME", help="default: camera")
    action.add_argument("--object", metavar="NAME", help="tum: whose poses the ground truth has")
    action.add_argument(
        "--frame-rate",
        type=float,
        metavar="HZ",
        help="bop: the rate at which its images, which have no times, were taken (default: "
        "30, or the times that our exports have)",
    )
    for name in ("colour", "depth", "camera-info"):
        text = "ros: which topic, of several"
        action.add_argument(f"--{name}", metavar="TOPIC", help=text)
    action.add_argument("--json", type=Path, metavar="FILE", help="write the result there")
    action.set_defaults(run_action=_import)


def _import(arguments: argparse.Namespace) -> int:
    site = _site(arguments)
    _refuse_options_of_others(arguments)
    importers = {
        "tum": _import_tum,
        "ros": _import_ros,
        "bop": _import_bop,
        "kinect": _import_kinect,
    }
    counts = importers[arguments.format](arguments, site)
    print(f"{arguments.output}: " + ", ".join(f"{n:,} {topic}" for topic, n in counts.items()))
    if arguments.json is not None:
        write_json(arguments.json, {"output": str(arguments.output), "counts": counts})
    return DONE


def _refuse_options_of_others(arguments: argparse.Namespace) -> None:
    others = set().union(*OPTIONS.values()) - OPTIONS[arguments.format]
    for name in sorted(others):
        if getattr(arguments, name) is not None:
            option = "--" + name.replace("_", "-")
            raise SettingsError(f"{option} says nothing about --from {arguments.format}: omit it")
    if arguments.frame_rate is not None and not 1e-3 <= arguments.frame_rate <= 1e4:
        raise SettingsError(f"--frame-rate {arguments.frame_rate:g}: no camera has this rate")


def _import_tum(arguments: argparse.Namespace, site: Site) -> dict[str, int]:
    from inhand.imports.foreign import write_imported
    from inhand.imports.tum import messages_of, read_tum

    folder = read_tum(arguments.source, arguments.object)
    about = {"source": arguments.source.name, "format": arguments.format}
    frames = folder.frames
    total = 1 + len(frames) * (1 if folder.truth is None else 2)
    with progress_bar("messages", total) as advance:
        messages = messages_of(folder, arguments.camera)
        counts = write_imported(arguments.output, site, messages, about, advance)
    if folder.depth:
        _say_without_depth(len(frames), sum(depth is None for _, _, depth, _ in frames))
    return counts


def _import_ros(arguments: argparse.Namespace, site: Site) -> dict[str, int]:
    from inhand.imports.foreign import write_imported
    from inhand.imports.ros import plan_import
    from inhand.imports.ros_bag import open_bag

    asked = {name: getattr(arguments, name) for name in ("colour", "depth", "camera_info")}
    with open_bag(arguments.source) as reader:
        bag = plan_import(reader, asked)
        topics = {k: v for k, v in asdict(bag.topics).items() if v is not None}
        about = {"source": arguments.source.name, "format": arguments.format, **topics}
        if bag.device is not None:
            about |= {"device": bag.device, "aligned": str(bag.align is not None).lower()}
        with progress_bar("messages", 1 + len(bag.frames)) as advance:
            messages = bag.messages(arguments.camera)
            counts = write_imported(arguments.output, site, messages, about, advance)
    for name, topic in topics.items():
        print(f"{name} of {topic}")
    if bag.topics.depth is not None:
        _say_without_depth(len(bag.frames), sum(depth < 0 for _, depth in bag.frames))
    if bag.align is not None:
        print("depth is aligned to colour by the calibration in the bag")
    if bag.info.time_ns < FIRST_CLOCK_NS:
        print("times are of the camera's own clock, and not since 1970")
    _say_left_out(bag.left_out, "image")
    return counts


def _import_bop(arguments: argparse.Namespace, site: Site) -> dict[str, int]:
    from inhand.imports.bop import read_bop
    from inhand.imports.foreign import write_imported

    recording = read_bop(arguments.source, arguments.frame_rate)
    scene, meshes = recording.scene, recording.meshes()
    about = {
        "source": arguments.source.resolve().name,
        "format": arguments.format,
        "scene": scene.name,
        "times": f"assumed at {recording.frame_rate:g} Hz" if recording.assumed else "recorded",
    }
    total = 1 + sum(1 + len(frame.labels) for frame in scene.frames)
    with progress_bar("messages", total) as advance:
        messages = recording.messages(arguments.camera)
        counts = write_imported(arguments.output, site, messages, about, advance, meshes)
    if recording.assumed:
        print(f"BOP has no times: image n is taken to be the n-th at {recording.frame_rate:g} Hz")
    if not scene.labelled:
        print("it has no scene_gt.json: there are no labels")
    if without := sorted(set(recording.objects) - set(meshes)):
        print(f"no model is there of: {', '.join(without)}")
    if recording.grey_bits > 8:
        print(f"colour has {recording.grey_bits} bits, of which the upper 8 are taken")
    if all(frame.depth is None for frame in scene.frames):
        print("it has no depth, without which no tracker finds an object")
    _say_left_out(recording.left_out, "frame")
    return counts


def _import_kinect(arguments: argparse.Namespace, site: Site) -> dict[str, int]:
    from inhand.imports.azure_kinect import open_kinect
    from inhand.imports.foreign import write_imported

    with open_kinect(arguments.source) as recording:
        about = {"source": arguments.source.name, "format": arguments.format, **recording.about}
        with progress_bar("messages", 1 + len(recording.frames)) as advance:
            messages = recording.messages(arguments.camera)
            counts = write_imported(arguments.output, site, messages, about, advance)
    if recording.align is not None:
        print("depth is aligned to colour by the calibration in the file")
        without = sum(depth < 0 for _, depth in recording.frames)
        _say_without_depth(len(recording.frames), without)
    if not recording.clock:
        print("the file does not say when it was begun: times count from 9 September 2001")
    _say_left_out(recording.left_out, "image")
    return counts


def _say_left_out(left_out: "LeftOut", what: str) -> None:
    if left_out.count:
        print(f"{counted(left_out.count, what)} left out; the first: {left_out.reason}")


def _say_without_depth(frames: int, without: int) -> None:
    if without:
        print(f"{without:,} of {counted(frames, 'frame')} have no depth within 20 ms")


def _site(arguments: argparse.Namespace) -> Site:
    """Return the rig; raises SettingsError for names that no key can have."""
    try:
        for what in ("camera", "object"):
            if (name := getattr(arguments, what)) is not None:
                require_name(what, name)
        return Site(rig=arguments.rig)
    except KeyFormatError as error:
        raise SettingsError(str(error)) from None
