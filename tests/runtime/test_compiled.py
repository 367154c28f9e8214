"""What is compiled is kept where a process may write, and for as long as its sources stay."""

import itertools
import json
import os
import shutil
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inhand_runtime.cache_folder import cache_folder
from inhand_tracker.geometry.rotations import from_matrix

ROOT = Path(__file__).parents[2]

PARTS = """
from inhand_runtime.compiled import njit
FACTOR = 3.0
@njit(cache=True, inline="always")
def doubled(value):
    return 2.0 * value
"""
KERNEL = """
import numpy as np
from inhand_runtime.compiled import njit, vectorised
from inhand_small.parts import FACTOR, doubled
@njit(cache=True)
def scaled(value):
    return FACTOR * doubled(value) + below(value)
@njit(cache=True)
def below(value):
    return 0.0 * value
@vectorised("(n)->()")
def sums(values, total):
    total[0] = values.sum()
def kernel(value):
    return float(sums(np.array([scaled(value), 0.0])))
"""
CALL = """
import json, sys
from numba.core.dispatcher import Dispatcher
{call}
kernels = {{id(v): v for m in list(sys.modules.values()) for v in vars(m).values()
            if isinstance(v, Dispatcher)}}
counts = {{name: sum(sum(getattr(k.stats, name).values()) for k in kernels.values())
          for name in ("cache_hits", "cache_misses")}}
print(json.dumps({{"result": result, **counts}}))
"""
SMALL = CALL.format(call="from inhand_small.kernel import kernel; result = kernel(1.0)")
FRAME = CALL.format(
    call="""
from inhand_lab.world.simulation import simulate
from inhand_lab.sensing.cameras import KINECT
import inhand_lab
simulation = simulate("drinkFromMug", 0, 0, 2, KINECT)
simulation.prepare()
simulation.render(0)
result = inhand_lab.__file__
"""
)
STAMPS = """
import json
from inhand_runtime.compiled import KernelLocator
stamps = {}
class Noted(KernelLocator):
    def __init__(self, kernel, file):
        super().__init__(kernel, file)
        stamps[f"{kernel.__module__}.{kernel.__qualname__}"] = self.get_source_stamp()
import inhand_runtime.compiled
inhand_runtime.compiled.KernelLocator = Noted
import inhand_tracker.service
print(json.dumps(stamps))
"""


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A package of two modules whose kernel gives 6."""
    return _written(tmp_path / "site/inhand_small")


def _written(package: Path) -> Path:
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / "parts.py").write_text(PARTS)
    (package / "kernel.py").write_text(KERNEL)
    return package


@pytest.fixture(scope="module")
def started(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A package as ``small``, and the folder of what its first start compiled."""
    folder = tmp_path_factory.mktemp("started")
    package = _written(folder / "site/inhand_small")
    answer, _ = _start(package.parent, folder / "cache")
    assert (answer["result"], answer["cache_hits"]) == (6.0, 0)
    return package, folder / "cache"


@pytest.fixture
def kept(started: tuple[Path, Path], tmp_path: Path) -> tuple[Path, Path]:
    """The package that was started, and a copy of what was compiled."""
    package, cache = started
    return package, shutil.copytree(cache, tmp_path / "cache")


def _start(site: Path, cache: Path | str, code: str = SMALL) -> tuple[dict[str, Any], str]:
    env = os.environ | {"INHAND_CACHE": str(cache), "PYTHONPATH": str(site)}
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer, done.stderr


@pytest.mark.long
def test_a_second_start_compiles_nothing_and_writes_nothing_beside_the_source(
    kept: tuple[Path, Path],
) -> None:
    package, cache = kept
    second, _ = _start(package.parent, cache)
    assert second["result"] == 6.0
    assert (second["cache_hits"], second["cache_misses"]) == (1, 0)
    assert not list(package.rglob("*.nb?"))


@pytest.mark.long
def test_a_loop_over_arrays_is_compiled_for_who_asks_and_not_at_the_import(
    small: Path, tmp_path: Path
) -> None:
    cache = tmp_path / "cache"
    imported = CALL.format(call="import inhand_small.kernel; result = 0")
    answer, _ = _start(small.parent, cache, imported)
    assert answer["cache_misses"] == 0
    assert not list(cache.rglob("*.nb?"))
    made = "import inhand_small.kernel; from inhand_runtime.compiled import make_loops; "
    _start(small.parent, cache, CALL.format(call=made + "make_loops(); result = 0"))
    assert list(cache.rglob("guf-kernel.sums*.nbc"))


@pytest.mark.long
@pytest.mark.parametrize(("before", "after"), [("3.0", "4.0"), ("2.0", "5.0")])
def test_a_change_of_another_file_that_a_kernel_takes_from_is_seen(
    small: Path, tmp_path: Path, before: str, after: str
) -> None:
    _start(small.parent, tmp_path / "cache")
    parts = small / "parts.py"
    times = parts.stat()
    parts.write_text(PARTS.replace(before, after))
    os.utime(parts, ns=(times.st_atime_ns, times.st_mtime_ns + 10**9))  # so that Python reads it
    changed, _ = _start(small.parent, tmp_path / "cache")
    assert changed["result"] == 6.0 * float(after) / float(before)


@pytest.mark.long
def test_a_folder_that_cannot_be_written_is_one_warning(small: Path) -> None:
    answer, said = _start(small.parent, "/proc/nowhere")
    assert answer["result"] == 6.0
    assert said.count("\n") == 1
    assert said.startswith("cannot write /proc/nowhere/compiled: ")
    assert said.endswith("name a folder that can be written in INHAND_CACHE\n")
    assert not list(small.rglob("*.nb?"))


@pytest.mark.long
@pytest.mark.parametrize("kernel", ["kernel.scaled", "kernel.sums", "guf-kernel.sums"])
def test_a_damaged_file_is_compiled_again_with_a_warning(
    kept: tuple[Path, Path], kernel: str
) -> None:
    package, cache = kept
    for suffix, left in itertools.product(("nbi", "nbc"), (0, 20)):
        files = list(cache.rglob(f"{kernel}*.{suffix}"))
        assert files, suffix
        for file in files:
            file.write_bytes(file.read_bytes()[:left])
        answer, said = _start(package.parent, cache)
        assert answer["result"] == 6.0
        assert "is damaged" in said
        assert "Traceback" not in said
        after = list(cache.rglob(f"{kernel}*.{suffix}"))
        assert min(file.stat().st_size for file in after) > left, "it was not kept anew"
    whole, said = _start(package.parent, cache)
    assert (whole["cache_hits"], whole["cache_misses"], said) == (1, 0, "")


@pytest.mark.long
def test_a_disk_that_takes_nothing_costs_time_and_no_more(small: Path, tmp_path: Path) -> None:
    full = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500)); "
    answer, said = _start(small.parent, tmp_path / "cache", full + SMALL.lstrip())
    assert answer["result"] == 6.0
    assert "cannot keep compiled code in" in said
    assert "Traceback" not in said


@pytest.mark.long
def test_a_loop_that_belongs_to_another_compilation_is_compiled_again(
    kept: tuple[Path, Path],
) -> None:
    """As after two processes that started at once, of which each kept one half."""
    package, cache = kept
    for file in cache.rglob("kernel.sums*"):
        file.unlink()
    other = "import numba; numba.njit(lambda: 1)(); " + SMALL.lstrip()
    for _ in range(2):
        answer, said = _start(package.parent, cache, other)
        assert (answer["result"], said) == (6.0, "")


@pytest.mark.long
def test_an_installation_starts_from_the_cache_and_is_not_written(tmp_path: Path) -> None:
    site = tmp_path / "site"
    for package in ("schemas", "services/runtime", "services/tracker", "lab"):
        for folder in (ROOT / package).glob("inhand_*"):
            shutil.copytree(
                folder, site / folder.name, ignore=shutil.ignore_patterns("__pycache__")
            )
    first, _ = _start(site, tmp_path / "cache", FRAME)
    assert first["result"] == str(site / "inhand_lab/__init__.py")
    assert first["cache_misses"] > 0
    second, _ = _start(site, tmp_path / "cache", FRAME)
    assert second["cache_misses"] == 0
    assert second["cache_hits"] > 0
    assert not list(site.rglob("*.nb?"))


@pytest.mark.long
def test_what_a_tracker_s_kernels_are_compiled_from_is_the_same_at_each_start() -> None:
    starts = []
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", STAMPS], check=True, capture_output=True)
        starts.append(json.loads(done.stdout))
    assert len(starts[0]) > 50
    assert starts[0] == starts[1]


@pytest.mark.parametrize(
    ("given", "folder"),
    [
        ({"INHAND_CACHE": "/a", "CACHE_DIRECTORY": "/b"}, "/a"),
        ({"CACHE_DIRECTORY": "/b:/c", "XDG_CACHE_HOME": "/d"}, "/b"),
        ({"XDG_CACHE_HOME": "/d"}, "/d/inhand"),
        ({"HOME": "/home/somebody"}, "/home/somebody/.cache/inhand"),
    ],
)
def test_the_folder_is_what_was_chosen_else_the_services_else_the_users(
    monkeypatch: pytest.MonkeyPatch, given: dict[str, str], folder: str
) -> None:
    for name in ("INHAND_CACHE", "CACHE_DIRECTORY", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    for name, value in given.items():
        monkeypatch.setenv(name, value)
    assert cache_folder() == Path(folder)


def test_what_is_not_a_number_stays_so_without_a_warning_in_every_thread() -> None:
    nothing = np.zeros((2, 3, 3))
    with warnings.catch_warnings(), ThreadPoolExecutor(1) as other, np.errstate(all="warn"):
        warnings.simplefilter("error")
        for turned in (
            from_matrix(nothing / np.inf - np.inf),
            other.submit(from_matrix, nothing - np.inf).result(),
        ):
            assert np.isnan(turned).any()
        assert np.geterr()["invalid"] == "warn"
