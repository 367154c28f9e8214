"""A camera's frames and its objects' poses as a data set of the BOP benchmark, with masks."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from inhand_recorder.attachments import meshes_in
from inhand_recorder.recorded import RecordedImages
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingError
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Pose
from inhand_tracker.geometry.rotations import from_vector, to_matrix
from inhand_tracker.shape.shape import Symmetry
from numpy.typing import NDArray

from inhand.exports.bop_masks import mask_object
from inhand.exports.placed_objects import Mesh, Meshes, lens_of
from inhand.exports.request import ExportRequest, FramePoses
from inhand.exports.tum import save_png
from inhand.exports.unfinished import unfinished

MM_PER_M = 1000.0
SCENE = "test/000001"
TIMES_FILE = "scene_times.json"
"""File beside the benchmark's own with the capture of each image, nanoseconds since the epoch."""


def export_bop(request: ExportRequest, output: Path) -> dict[str, int]:
    """Write a data set with one scene: the frames of one camera that have colour and depth.

    Objects are numbered in the order of their names. Returns the numbers of frames, of poses, and
    of frames that are damaged or lack an image; raises RecordingError where the camera is not one
    or no pose is there, and InhandError for a mesh that is missing.
    """
    camera, info, frames = request.frames_of_one_camera()
    poses = sorted(request.poses_of_objects(), key=lambda one: one.object)
    if not poses:
        raise RecordingError("there are no poses and no labels: nothing says where an object is")
    meshes = Meshes(request.objects, meshes_in(request.recording.attachments()))
    with unfinished(output) as folder:
        _write_models(folder / "models", {one.object: meshes.mesh(one.object) for one in poses})
        scene = _Scene(folder / SCENE, camera, info, meshes, poses)
        scene.begin()
        for frame in frames:
            scene.add(frame)
        scene.finish()
    return scene.counts


@dataclass
class _Scene:
    folder: Path
    camera: str
    info: CameraInfo
    meshes: Meshes
    poses: list[FramePoses]
    counts: dict[str, int] = field(
        default_factory=lambda: {"frames": 0, "poses": 0, "frames left out": 0}
    )
    _files: dict[str, dict[str, Any]] = field(default_factory=dict)

    def begin(self) -> None:
        for name in ("rgb", "depth", "mask", "mask_visib"):
            (self.folder / name).mkdir(parents=True)
        names = ("scene_camera", "scene_gt", "scene_gt_info", Path(TIMES_FILE).stem)
        self._files = {name: {} for name in names}

    def add(self, frame: RecordedImages) -> None:
        """Write a frame, with the objects that are seen in it."""
        number = self.counts["frames"]
        try:
            colour, depth, depth_m = frame.colour, frame.depth, frame.depth_m
        except MessageError:
            colour = depth = depth_m = None
        if colour is None or depth is None or depth_m is None or colour.shape[:2] != depth.shape:
            self.counts["frames left out"] += 1
            return
        save_png(self.folder / f"rgb/{number:06}.png", colour[..., ::-1])
        save_png(self.folder / f"depth/{number:06}.png", depth)
        truth: list[dict[str, Any]] = []
        seen: list[dict[str, Any]] = []
        for object_id, poses in enumerate(self.poses, 1):
            pose = poses.transform(self.camera, frame.time_ns)
            if pose is not None:
                name = f"{number:06}_{len(truth):06}.png"
                truth.append(_instance(object_id, pose))
                seen.append(self._masks(poses.object, pose, depth_m, name))
        lens = lens_of(self.info, depth.shape[1], depth.shape[0])
        matrix = [lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0]
        scale = self.info.depth_scale * MM_PER_M
        entries = ({"cam_K": matrix, "depth_scale": scale}, truth, seen, frame.time_ns)
        for values, entry in zip(self._files.values(), entries, strict=True):
            values[str(number)] = entry
        self.counts["frames"] += 1
        self.counts["poses"] += len(truth)

    def finish(self) -> None:
        if not self.counts["frames"]:
            raise RecordingError(f"there is no frame of {self.camera} with colour and depth")
        for name, values in self._files.items():
            (self.folder / f"{name}.json").write_text(json.dumps(values, indent=1) + "\n")

    def _masks(
        self, name: str, pose: Pose, depth_m: NDArray[np.float32], file: str
    ) -> dict[str, Any]:
        lens = lens_of(self.info, depth_m.shape[1], depth_m.shape[0])
        masks = mask_object(self.meshes.mesh(name), pose, lens, depth_m)
        save_png(self.folder / "mask" / file, masks.silhouette.astype(np.uint8) * 255)
        save_png(self.folder / "mask_visib" / file, masks.visible.astype(np.uint8) * 255)
        visible = int(np.count_nonzero(masks.visible))
        return {
            "bbox_obj": masks.whole_box if visible else [-1, -1, -1, -1],
            "bbox_visib": masks.visible_box,
            "px_count_all": masks.whole_pixels,
            "px_count_valid": int(np.count_nonzero(masks.silhouette & (depth_m > 0.0))),
            "px_count_visib": visible,
            "visib_fract": visible / masks.whole_pixels if masks.whole_pixels else 0.0,
        }


def _instance(object_id: int, pose: Pose) -> dict[str, Any]:
    return {
        "cam_R_m2c": to_matrix(np.array(pose.rotation)).ravel().tolist(),
        "cam_t_m2c": [MM_PER_M * one for one in pose.translation],
        "obj_id": object_id,
    }


def _write_models(folder: Path, meshes: Mapping[str, Mesh]) -> None:
    """Write the meshes in millimetres, with sizes, names and symmetries."""
    folder.mkdir(parents=True)
    infos: dict[str, Any] = {}
    for object_id, (name, mesh) in enumerate(meshes.items(), 1):
        vertices = MM_PER_M * mesh.vertices
        shape = trimesh.Trimesh(vertices, mesh.faces, process=False)
        shape.export(folder / f"obj_{object_id:06}.ply")
        least, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
        infos[str(object_id)] = {
            "name": name,
            "diameter": _diameter(vertices),
            **{f"min_{axis}": float(one) for axis, one in zip("xyz", least, strict=True)},
            **{f"size_{axis}": float(one) for axis, one in zip("xyz", size, strict=True)},
            **_symmetries(mesh.symmetries),
        }
    (folder / "models_info.json").write_text(json.dumps(infos, indent=1) + "\n")


def _symmetries(symmetries: tuple[Symmetry, ...]) -> dict[str, Any]:
    turned: dict[str, Any] = {}
    for one in symmetries:
        axis, centre = np.array(one.axis), MM_PER_M * np.array(one.centre)
        axis = axis / np.linalg.norm(axis)
        if one.order == 0:
            entry = {"axis": axis.tolist(), "offset": centre.tolist()}
            turned.setdefault("symmetries_continuous", []).append(entry)
        for turn in range(1, one.order):
            rotation = to_matrix(from_vector(axis * (2.0 * np.pi * turn / one.order)))
            matrix = np.eye(4)
            matrix[:3, :3], matrix[:3, 3] = rotation, centre - rotation @ centre
            turned.setdefault("symmetries_discrete", []).append(matrix.ravel().tolist())
    return turned


def _diameter(vertices: NDArray[np.float64]) -> float:
    """Return the largest distance between two vertices (V, 3)."""
    from scipy.spatial import ConvexHull, QhullError
    from scipy.spatial.distance import pdist

    try:
        corners = vertices[ConvexHull(vertices).vertices]
    except QhullError:  # a flat mesh has no hull
        corners = np.unique(vertices, axis=0)
    if len(corners) < 2:
        raise InhandError("a mesh is a single point: it has no size")
    return float(pdist(corners).max())
