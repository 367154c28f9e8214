"""Checks an export for BOP with the benchmark's own toolkit, which is in no package registry.

Run it with a Python that has the toolkit (github.com/thodan/bop_toolkit) and what it needs, not
Inhand's: ``PYTHONPATH=bop_toolkit python tests/scenes/bop_toolkit_reads.py FOLDER``. It reads the
scene with the toolkit's readers, draws each object with the toolkit's renderer, computes masks and
visibility with its functions, and ends with an error where ours are others. Without a display the
renderer wants ``EGL_PLATFORM=surfaceless``. It has the middle of the first pixel at (0.5, 0.5), and
the benchmark's matrices, as ours, at (0, 0): so the principal point that it gets is moved.
"""

import sys
from pathlib import Path

import numpy as np
from bop_toolkit_lib import inout, misc, visibility
from bop_toolkit_lib.dataset import bop_scenewise
from bop_toolkit_lib.rendering import renderer

MIDDLE_PX = 0.5
DELTA_MM = 15.0
"""Millimetres before an object up to which a measured surface is its own: the toolkit's number."""


def main(folder: Path) -> None:
    """Print what agrees; raises AssertionError where something does not."""
    scene = folder / "test/000001"
    infos = bop_scenewise.read_scene_infos(scene, read_image_ids=True, read_n_objects=True)
    assert all(infos[f"has_{one}"] for one in ("rgb", "depth", "mask", "mask_visib", "gt_info"))
    models = inout.load_json(folder / "models/models_info.json", keys_to_int=True)
    for number, about in models.items():
        model = inout.load_ply(folder / f"models/obj_{number:06}.ply")
        size = np.ptp(model["pts"], axis=0)
        assert np.allclose(size, [about[f"size_{axis}"] for axis in "xyz"], atol=1e-3)
        if len(model["pts"]) < 5000:
            diameter = misc.calc_pts_diameter(model["pts"])
            assert np.isclose(diameter, about["diameter"], atol=1e-3)
        turns = misc.get_symmetry_transformations(about, 0.01)
        print(f"model {number}: {len(model['pts'])} vertices, {len(turns)} symmetric poses")
    first = bop_scenewise.load_image_data(scene, infos["image_ids"][0])
    height, width = first["im_depth"].shape
    draw = renderer.create_renderer(3 * width, 3 * height, "vispy", mode="depth")
    for number in models:
        draw.add_object(number, str(folder / f"models/obj_{number:06}.ply"))
    differing = silhouette = poses = 0
    for image in infos["image_ids"]:
        data = bop_scenewise.load_image_data(
            scene, image, load_mask=True, load_gt=True, load_gt_info=True
        )
        assert data["im_rgb"].shape == (height, width, 3)
        assert data["mask"].shape == (len(data["gt"]), height, width)
        for place, truth in enumerate(data["gt"]):
            differing += _compare(draw, data, place, truth)
            silhouette += np.count_nonzero(data["mask"][place])
            poses += 1
    print(
        f"{len(infos['image_ids'])} images, {poses} poses: {differing} of {silhouette} pixels "
        "of the silhouettes differ, and no box or count by more than those"
    )


def _compare(draw, data, place, truth) -> int:  # type: ignore[no-untyped-def]
    """Return the number of pixels of an object's silhouette that differ."""
    matrix = data["camera"]["cam_K"]
    height, width = data["im_depth"].shape
    centre = matrix[0, 2] + width + MIDDLE_PX, matrix[1, 2] + height + MIDDLE_PX
    turn, shift = truth["cam_R_m2c"], truth["cam_t_m2c"]
    drawn = draw.render_object(truth["obj_id"], turn, shift, matrix[0, 0], matrix[1, 1], *centre)[
        "depth"
    ]
    shown = drawn[height : 2 * height, width : 2 * width]
    true = misc.depth_im_to_dist_im_fast(shown, matrix)
    seen = misc.depth_im_to_dist_im_fast(data["im_depth"], matrix)
    visible = visibility.estimate_visib_mask_gt(seen, true, DELTA_MM, visib_mode="bop19")
    ours, ours_visible = data["mask"][place] > 0, data["mask_visib"][place] > 0
    differing = ours ^ (shown > 0)
    doubtful = differing | (np.abs(true - seen - DELTA_MM) < 0.1)
    assert not ((ours_visible ^ visible) & ~doubtful).any(), "visible parts differ"
    info = data["gt_info"][place]
    off = np.count_nonzero(differing)
    assert abs(info["px_count_all"] - np.count_nonzero(drawn)) <= off
    assert info["px_count_visib"] == np.count_nonzero(ours_visible)
    assert info["px_count_valid"] == np.count_nonzero(seen[ours] > 0)
    if info["px_count_visib"]:
        rows, columns = np.nonzero(ours_visible)
        box = misc.calc_2d_bbox(columns, rows, (width, height))
        assert list(map(int, box)) == list(map(int, info["bbox_visib"])), "boxes differ"
    return int(off)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
