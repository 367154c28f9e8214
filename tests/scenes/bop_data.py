"""A tiny BOP data set: a red cube of 10 cm a metre away, whose corners are projected by hand."""

from pathlib import Path
from typing import Any

import cv2
import msgspec
import numpy as np
import trimesh

CAM_K = [200.0, 0.0, 32.0, 0.0, 200.0, 24.0, 0.0, 0.0, 1.0]
QUARTER_TURN = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
SHIFT_MM = [50.0, -20.0, 1000.0]
CORNERS = {
    (50.0, 50.0, 50.0): (32.0, 29.714),
    (-50.0, 50.0, -50.0): (32.0, 9.263),
    (50.0, -50.0, -50.0): (53.053, 30.316),
    (-50.0, -50.0, -50.0): (53.053, 9.263),
}
"""Some corners in millimetres, and their pixels: (x, y, z) goes to (50 - y, x - 20, 1000 + z), and
u = 32 + 200 (50 - y) / (1000 + z), v = 24 + 200 (x - 20) / (1000 + z)."""


def instance(object_id: int = 1, **changes: Any) -> dict[str, Any]:
    """An annotation of the cube where ``CORNERS`` has it."""
    return {"obj_id": object_id, "cam_R_m2c": QUARTER_TURN, "cam_t_m2c": SHIFT_MM} | changes


def save_scene(
    folder: Path,
    truth: dict[int, list[dict[str, Any]]],
    *,
    depth_scale: float = 0.1,
    colour: str = "rgb/{:06}.png",
    with_depth: bool = True,
    sensor: str = "",
    camera: dict[str, Any] | None = None,
) -> Path:
    """Write a scene whose images show the cube's front, which is 95 cm away."""
    cameras = {
        n: {"cam_K": CAM_K, "depth_scale": depth_scale} | (camera or {}) for n in sorted(truth)
    }
    folder.mkdir(parents=True, exist_ok=True)
    save_json(folder / f"scene_camera{sensor}.json", cameras)
    save_json(folder / f"scene_gt{sensor}.json", truth)
    shown = np.zeros((48, 64), np.uint16)
    shown[10:31, 32:54] = 1
    image = np.full((48, 64, 3), 20, np.uint8)
    image[shown > 0] = (0, 0, 220)
    for number in truth:
        path = folder / colour.format(number)
        path.parent.mkdir(exist_ok=True)
        pixels = image if path.parent.name.startswith("rgb") else image[..., 2]
        cv2.imwrite(str(path), pixels)
        if with_depth:
            depth = folder / f"depth{sensor}" / f"{number:06}.png"
            depth.parent.mkdir(exist_ok=True)
            cv2.imwrite(str(depth), shown * round(950.0 / depth_scale))
    return folder


def save_models(folder: Path, objects: tuple[int, ...] = (1,), **info: Any) -> None:
    """Write cubes in millimetres, all described alike."""
    folder.mkdir(parents=True)
    for number in objects:
        trimesh.creation.box((100.0, 100.0, 100.0)).export(folder / f"obj_{number:06}.ply")
    described = {"diameter": 173.2, "min_x": -50.0, "size_x": 100.0} | info
    save_json(folder / "models_info.json", dict.fromkeys(objects, described))


def save_bop(root: Path) -> Path:
    """A data set of one scene with the cube in one frame."""
    save_models(root / "models")
    save_scene(root / "test" / "000001", {0: [instance()]})
    return root


def save_json(path: Path, values: Any) -> None:
    path.write_bytes(msgspec.json.encode(values))
