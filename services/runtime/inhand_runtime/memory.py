"""Keeps freed memory for what comes next, or gives it back: free memory, and what the file system
holds as well."""

import ctypes
import gc
import re
from collections.abc import Iterator
from pathlib import Path

_libc = ctypes.CDLL(None)
_malloc_trim = getattr(_libc, "malloc_trim", None)
_mallopt = getattr(_libc, "mallopt", None)

MAPPINGS = Path("/proc/self/smaps")
"""Where Linux lists the parts of this process's memory; other systems have no such file."""

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Numbers that the C library (glibc) gives two of its settings."""

KEPT_BYTES = 32 * 2**20
"""Bytes of free memory that a process keeps, and of the largest array that is made of it: the
images of four cameras, decoded, are 11 MB. More than this the C library does not take."""

MADV_DONTNEED = 4
"""Linux's number of the advice that pages are not needed now."""

_HEAD = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S{4}) \S+ \S+ (\d+)")
"""Beginning, end, rights and file number of a part of memory, 0 of none."""


def keep_memory() -> None:
    """Let freed memory be used again, where the C library is glibc, for who makes the same large
    arrays with every frame.

    By itself it gives them back at once, and the system has to clear every page of the next ones,
    which takes a tenth of the time of decoding a frame.
    """
    if _mallopt is not None and _malloc_trim is not None:
        _mallopt(M_MMAP_THRESHOLD, KEPT_BYTES)
        _mallopt(M_TRIM_THRESHOLD, KEPT_BYTES)


def keep_what_started() -> None:
    """Let collections of garbage pass over all that is there: a start's modules and compiled code
    live as long as the process, and to go through them takes as long as two frames. What an earlier
    start left, as of a hub that starts anew, is collected before."""
    gc.unfreeze()
    gc.collect()
    gc.freeze()


def give_memory_back() -> None:
    """Return the pages of freed memory that the C library (glibc) keeps; others keep none.

    A start frees tens of megabytes in places that nothing later fits into: parts of files, arrays
    from which others were made.
    """
    if _malloc_trim is not None:
        _malloc_trim(0)


def give_libraries_back() -> int:
    """Unmap the pages of libraries that are as in their files; returns bytes of address space.

    A start touches most of LLVM, which nothing needs later. Pages that are needed again come back
    from the file cache at a microsecond each, so call it once after a start. Only mappings that
    cannot be written and hold no page of their own are given back: the others would lose what a
    start wrote there. Where the system has no list of mappings nothing is done.
    """
    if not MAPPINGS.exists():
        return 0
    given = 0
    for begin, length in list(_unchanged_mappings(MAPPINGS.read_text())):
        if _libc.madvise(ctypes.c_void_p(begin), ctypes.c_size_t(length), MADV_DONTNEED) == 0:
            given += length
    return given


def _unchanged_mappings(listed: str) -> Iterator[tuple[int, int]]:
    """Address and length of the private mappings of files that are as the files are."""
    mapping: tuple[int, int] | None = None
    for line in listed.splitlines():
        if head := _HEAD.match(line):
            begin, end = int(head[1], 16), int(head[2], 16)
            of_file = head[4] != "0" and head[3][1] == "-" and head[3][3] == "p"
            mapping = (begin, end - begin) if of_file else None
        elif mapping and line.split() == ["Anonymous:", "0", "kB"]:
            yield mapping
