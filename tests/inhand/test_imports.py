"""What a verb loads, and what it says where the extra it needs is not installed."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inhand_runtime.extras import EXTRAS
from people import STANDING

MODEL = Path(__file__).parents[1] / "tracker/golden/drinkFromMug.model"

NEEDED_BY_NOBODY = ("faiss", "matplotlib", "sklearn", "trimesh", "scipy.spatial")
"""(Numba itself loads ``scipy.linalg`` with the first compiled function, where SciPy is.)"""
NEEDED_BY_THE_TRACKER = ("cv2", "numba")
LOADED = """
import json, sys
from inhand.__main__ import main
try:
    main({arguments})
except SystemExit:
    pass
print(json.dumps(sorted(sys.modules)))
"""
WITHOUT_EXTRAS = f"""
import sys
class NotInstalled:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {EXTRAS["lab"] + EXTRAS["oak"]}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, NotInstalled())
"""
MAIN = "from inhand.__main__ import main; sys.exit(main(sys.argv[1:]))"
TRACK = """
import numpy as np
from inhand_tracker import Image, load_model, new_tracker
from inhand_tracker.geometry.camera import Intrinsics
tracker = new_tracker(load_model(sys.argv[1]))
camera = Intrinsics(260.0, 260.0, 159.5, 119.5, 320, 240)
depth, colour = np.full((240, 320), 3.5, np.float32), np.full((240, 320, 3), 110, np.uint8)
for frame in range(1, 4):
    image = Image(None, camera, depth, colour)
    estimate = tracker.step(np.load(sys.argv[2]), frame * 33_000_000, image)
print(estimate.state)
"""


def _run(code: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.long
@pytest.mark.parametrize(
    ("arguments", "unneeded"),
    [
        (["--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "numpy", "zenoh", "rich")),
        (["status", "--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "numpy")),
        (["echo", "--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "numpy")),
        (["recorder", "--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "numpy", "rich")),
        (["capture", "--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "rich", "depthai")),
        (
            ["hub", "--config", "/nowhere"],
            (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER, "numpy", "rich", "cryptography"),
        ),
        (["replay", "--help"], (*NEEDED_BY_NOBODY, *NEEDED_BY_THE_TRACKER)),
        (["outcomes", "--help"], ("matplotlib", "sklearn", "trimesh", "alembic", "numba", "cv2")),
        (["tracker", "--help"], (*NEEDED_BY_NOBODY, "rich", "inhand_lab")),
        (["simulate", "--help"], ("matplotlib", "sklearn")),
        (["evaluate", "--help"], ("matplotlib", "sklearn")),
        (["train", "--help"], ("matplotlib", "sklearn")),
    ],
    ids=lambda value: value[0],
)
def test_a_verb_loads_only_what_it_needs(arguments: list[str], unneeded: tuple[str, ...]) -> None:
    done = _run(LOADED.format(arguments=arguments))
    loaded = json.loads(done.stdout.splitlines()[-1])
    assert [name for name in unneeded if name in loaded] == []


@pytest.mark.long
@pytest.mark.parametrize(
    "verb", ["demo", "simulate", "import", "train", "evaluate", "recognise", "bench"]
)
def test_a_verb_says_in_one_line_which_extra_it_needs(verb: str) -> None:
    done = _run(WITHOUT_EXTRAS + MAIN, verb, "--help")
    assert done.returncode == 2
    assert done.stderr == f"inhand {verb}: needs the extra 'lab': pip install \"inhand[lab]\"\n"


@pytest.mark.long
@pytest.mark.parametrize(
    ("service", "table", "line"),
    [
        (
            "capture",
            'source = "simulator"',
            "setting capture.it.source: source 'simulator' needs the extra 'lab': "
            'pip install "inhand[lab]"',
        ),
        (
            "capture",
            'source = "oak"',
            "setting capture.it.source: source 'oak' needs the extra 'oak': "
            'pip install "inhand[oak]"',
        ),
        (
            "tracker",
            f'model = "{MODEL}"\nmethod = "gd-hand"',
            "tracker: needs the extra 'lab': pip install \"inhand[lab]\"",
        ),
    ],
)
def test_a_daemon_says_before_it_starts_which_extra_its_settings_need(
    tmp_path: Path, service: str, table: str, line: str
) -> None:
    config = tmp_path / "rig.toml"
    config.write_text(f"[{service}.it]\n{table}\n")
    for more in ((), ("--check-config",)):
        done = _run(WITHOUT_EXTRAS + MAIN, service, "--config", config, *more)
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert line in done.stderr


@pytest.mark.long
def test_the_default_method_tracks_with_images_without_the_extra(tmp_path: Path) -> None:
    np.save(tmp_path / "joints.npy", STANDING)
    done = _run(WITHOUT_EXTRAS + TRACK, MODEL, tmp_path / "joints.npy")
    assert done.returncode == 0, done.stderr
    assert done.stdout == "tracked\n"


def test_numpy_computes_in_one_thread_where_frames_are_worked_on() -> None:
    program = """
import os, sys
from inhand.__main__ import main
try:
    main([sys.argv[1], "--help"])
except SystemExit:
    pass
import numpy as np
np.ones((600, 600)) @ np.ones((600, 600))
sys.exit(len(os.listdir("/proc/self/task")) - 1)
"""
    for daemon in ("capture", "tracker"):
        assert subprocess.run([sys.executable, "-c", program, daemon]).returncode == 0
