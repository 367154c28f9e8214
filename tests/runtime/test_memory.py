"""What a process gives back of its memory, and what it must keep."""

import ctypes
import gc
import mmap
import subprocess
import sys
import weakref
from pathlib import Path

import pytest
from inhand_runtime.memory import MAPPINGS, give_libraries_back, keep_what_started

pytestmark = pytest.mark.skipif(not MAPPINGS.exists(), reason="only Linux lists mappings")

COMPILES = """
import re
from pathlib import Path

import numba
from inhand_runtime.memory import give_libraries_back

def resident_kb():
    return int(re.search(r"RssFile:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])

double = numba.njit(lambda x: 2 * x)
assert double(3) == 6
before = resident_kb()
give_libraries_back()
print(before - resident_kb())
assert double(2.5) == 5.0
"""


def test_a_process_that_compiled_gives_the_compilers_pages_back_and_still_compiles() -> None:
    done = subprocess.run([sys.executable, "-c", COMPILES], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 30_000


FAULTS = """
import gc, resource
import numpy as np
from inhand_runtime.memory import keep_memory, keep_what_started

def faults_of(arrays):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(arrays):
        np.ones(2_000_000)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

keep_memory()
faults_of(1)
print(faults_of(10))
keep_what_started()
print(len(gc.get_objects()))
"""


def test_what_an_earlier_start_left_is_collected_by_the_next_one() -> None:
    class Left:
        def __init__(self) -> None:
            self.itself = self

    left = Left()
    gone = weakref.ref(left)
    try:
        keep_what_started()
        del left
        keep_what_started()
    finally:
        gc.unfreeze()
    assert gone() is None


def test_large_arrays_are_made_again_where_the_last_ones_were() -> None:
    done = subprocess.run([sys.executable, "-c", FAULTS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    faults, objects = map(int, done.stdout.split())
    # The arrays have 16 MB, 39,000 pages in all.
    assert faults < 1_000
    assert objects < 1_000


def test_a_read_only_page_that_was_written_before_keeps_what_was_written(tmp_path: Path) -> None:
    (path := tmp_path / "file").write_bytes(bytes(2 * mmap.PAGESIZE))
    with path.open("rb") as file:
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY)
    mapped[:5] = b"wrote"
    address = ctypes.addressof(ctypes.c_char.from_buffer(mapped))
    protect = ctypes.CDLL(None).mprotect
    assert protect(ctypes.c_void_p(address), ctypes.c_size_t(len(mapped)), mmap.PROT_READ) == 0
    assert give_libraries_back() > 0
    assert mapped[:5] == b"wrote"
