"""A camera's frames and an object's poses as a folder in the layout of the TUM RGB-D benchmark."""

from contextlib import ExitStack
from pathlib import Path
from typing import TextIO

import cv2
import numpy as np
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Pose
from numpy.typing import NDArray

from inhand.exports.request import ExportRequest, FramePoses
from inhand.exports.unfinished import unfinished

CAMERA_FILE = "camera.txt"
TRUTH_FILE = "groundtruth.txt"


def export_tum(request: ExportRequest, output: Path) -> dict[str, int]:
    """Write the frames of one camera, and the poses of one object where there are any.

    Returns the numbers of frames, poses and damaged images; raises RecordingError where the camera
    or the object is not one.
    """
    camera, info, frames = request.frames_of_one_camera()
    poses = request.poses_of_one_object()
    counts = {"frames": 0, "poses": 0, "damaged images": 0}
    latest_ns = -1
    with unfinished(output) as folder, ExitStack() as stack:
        lists = _open_lists(stack, folder, info, poses)
        for frame in frames:
            if frame.time_ns <= latest_ns:
                raise RecordingError(
                    f"the frames of {camera} go back in time at {frame.time_ns}, where the clock "
                    "was set: cut there with --start and --end"
                )
            latest_ns = frame.time_ns
            try:
                colour, depth = frame.colour, frame.depth
            except MessageError:
                counts["damaged images"] += 1
                continue
            stamp = seconds_text(frame.time_ns)
            names = {}
            if colour is not None:
                names["rgb"] = f"rgb/{stamp}.png"
                save_png(folder / names["rgb"], colour[..., ::-1])
            if depth is not None:
                names["depth"] = f"depth/{stamp}.png"
                save_png(folder / names["depth"], depth)
            for name, path in names.items():
                lists[name].write(f"{stamp} {path}\n")
            if len(names) == 2:
                lists["associations"].write(f"{stamp} {names['rgb']} {stamp} {names['depth']}\n")
            counts["frames"] += 1
            pose = None if poses is None else poses.transform(camera, frame.time_ns)
            if pose is not None:
                lists["groundtruth"].write(f"{stamp} {pose_text(pose)}\n")
                counts["poses"] += 1
        if not counts["frames"]:
            raise RecordingError(f"there is no frame of {camera} in this time")
    return counts


def seconds_text(time_ns: int) -> str:
    """Return seconds with nine decimals, which are exactly the nanoseconds."""
    return f"{time_ns // 1_000_000_000}.{time_ns % 1_000_000_000:09}"


def pose_text(pose: Pose) -> str:
    """Return ``tx ty tz qx qy qz qw``, as exact as the numbers are."""
    w, *xyz = pose.rotation
    return " ".join(repr(float(one)) for one in (*pose.translation, *xyz, w))


def save_png(path: Path, pixels: NDArray[np.uint8] | NDArray[np.uint16]) -> None:
    """Write pixels without loss; raises InhandError."""
    done, data = cv2.imencode(".png", np.ascontiguousarray(pixels))
    if not done:
        raise InhandError(f"{path.name}: no PNG can be made of {pixels.shape}")
    path.write_bytes(data.tobytes())


def _open_lists(
    stack: ExitStack, folder: Path, info: CameraInfo, poses: FramePoses | None
) -> dict[str, TextIO]:
    for name in ("rgb", "depth"):
        (folder / name).mkdir(parents=True)
    numbers = (info.fx, info.fy, info.cx, info.cy, info.width, info.height, 1.0 / info.depth_scale)
    (folder / CAMERA_FILE).write_text(
        "# fx fy cx cy width height depth_factor (units of a depth image that are a metre), "
        "then distortion as OpenCV has it\n"
        + " ".join(map(repr, (*numbers, *info.distortion)))
        + "\n"
    )
    heads = {
        "rgb": "# timestamp filename",
        "depth": f"# timestamp filename ({1.0 / info.depth_scale:g} is a metre, 0 not measured)",
        "associations": "# rgb timestamp, filename, depth timestamp, filename",
    }
    if poses is not None:
        heads["groundtruth"] = (
            f"# timestamp tx ty tz qx qy qz qw: camera_from_object of {poses.object}, metres, "
            f"from {poses.source}"
        )
    lists: dict[str, TextIO] = {
        name: stack.enter_context((folder / f"{name}.txt").open("w")) for name in heads
    }
    for name, head in heads.items():
        lists[name].write(f"{head}\n")
    return lists
