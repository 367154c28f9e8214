"""Checks the import of an Azure Kinect's MKV with Microsoft's SDK, which wants an old NumPy.

``python tests/scenes/azure_kinect_sdk_agrees.py PYTHON``: PYTHON has ``pyk4a-bundle`` and
``numpy<2``. The SDK opens the file that our tests write, and says where in the colour camera it
sees points of the depth camera, and how far away; Inhand's aligned depth is compared there.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

STEP = 6
"""Pixels of depth from one point to the next."""


def points(path: str, output: str) -> None:
    """Save pixels and millimetres (N, 3) in the colour camera; runs where ``pyk4a`` is."""
    from pyk4a import CalibrationType, PyK4APlayback

    playback = PyK4APlayback(path)
    playback.open()
    calibration, depth = playback.calibration, playback.get_next_capture().depth
    depth_camera, colour_camera = CalibrationType.DEPTH, CalibrationType.COLOR
    found = []
    for y in range(STEP, depth.shape[0], STEP):
        for x in range(STEP, depth.shape[1], STEP):
            place = (float(x), float(y)), float(depth[y, x])
            point = calibration.convert_2d_to_3d(*place, depth_camera, colour_camera)
            try:
                pixel = calibration.convert_3d_to_2d(point, colour_camera, colour_camera)
            except ValueError:  # the colour camera does not see it
                continue
            found.append((*pixel, point[2]))
    np.save(output, np.array(found))


def main(python: str) -> None:
    """Write, import and print how far both agree."""
    import inhand_recorder
    from azure_kinect import calibration, images, jpeg, tracks, write_kinect

    with tempfile.TemporaryDirectory() as folder:
        path, ours, theirs = (f"{folder}/{name}" for name in ("a.mkv", "a.mcap", "a.npy"))
        write_kinect(Path(path), tracks(), images(jpeg()), attached=calibration())
        subprocess.run([python, __file__, "points", path, theirs], check=True)
        command = [sys.executable, "-m", "inhand", "recording", "import", path]
        subprocess.run([*command, "--from", "kinect", "-o", ours], check=True)
        with inhand_recorder.open(Path(ours)) as recording:
            depth = next(iter(recording["rgbd/camera"])).depth.astype(float)
        found = np.load(theirs)
    columns, rows = np.round(found[:, :2]).astype(int).T
    inside = (columns >= 0) & (columns < depth.shape[1]) & (rows >= 0) & (rows < depth.shape[0])
    ours_mm = depth[rows[inside], columns[inside]]
    off = np.abs(ours_mm - found[inside, 2])
    print(
        f"{inside.sum():,} points: {np.count_nonzero(ours_mm == 0)} without depth, "
        f"{np.count_nonzero(off > 1.0)} more than 1 mm off; "
        f"the median is {np.median(off):.2f} mm off"
    )
    assert np.mean(off > 1.0) < 0.03


if __name__ == "__main__":
    if sys.argv[1] == "points":
        points(*sys.argv[2:])
    else:
        main(*sys.argv[1:])
