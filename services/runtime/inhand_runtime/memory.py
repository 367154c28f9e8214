"""Gives memory that is free, or that the file system holds as well, back to the system."""

import ctypes
import re
from collections.abc import Iterator
from pathlib import Path

_libc = ctypes.CDLL(None)
_malloc_trim = getattr(_libc, "malloc_trim", None)

MAPPINGS = Path("/proc/self/smaps")
"""Where Linux lists the parts of this process's memory; other systems have no such file."""

MADV_DONTNEED = 4
"""Linux's number of the advice that pages are not needed now."""

_HEAD = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S{4}) \S+ \S+ (\d+)")
"""Beginning, end, rights and file number of a part of memory, 0 of none."""


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
