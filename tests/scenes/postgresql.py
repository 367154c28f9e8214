"""A real server of PostgreSQL, for the tests alone: in a folder of its own, at no port."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

REQUIRED = "POSTGRESQL_REQUIRED"
"""Set where a machine without PostgreSQL is a fault, as in CI."""
USER = "postgres_test"


@contextmanager
def postgresql() -> Iterator[str]:
    """Start a server, whose address it yields, and end it with the block; the test is skipped where
    it is not installed."""
    initdb = _program("initdb")
    folder = Path(tempfile.mkdtemp(prefix="pg", dir="/tmp"))  # a socket's path must be short
    owner = {"user": "nobody"} if os.geteuid() == 0 else {}  # it refuses to be run by root
    if owner:
        shutil.chown(folder, "nobody")
    run = {"cwd": folder, "check": True, "stdout": subprocess.DEVNULL, **owner}
    made = (initdb, "-D", folder / "data", "-U", USER, "--auth=trust", "-N", "-E", "UTF8")
    try:
        subprocess.run(made, **run)
        quick = f"-c listen_addresses= -c fsync=off -k {folder}"
        control = (initdb.with_name("pg_ctl"), "-D", folder / "data", "-w", "-l", folder / "log")
        subprocess.run((*control, "-o", quick, "start"), **run)
        try:
            yield f"postgresql+psycopg://{USER}@/postgres?host={folder}"
        finally:
            subprocess.run((*control, "-m", "immediate", "stop"), **run)
    finally:
        shutil.rmtree(folder)


def _program(name: str) -> Path:
    found = sorted(Path("/usr/lib/postgresql").glob(f"*/bin/{name}"))
    if not found:
        assert REQUIRED not in os.environ, "there is no PostgreSQL: apt-get install postgresql"
        pytest.skip("there is no PostgreSQL: apt-get install postgresql")
    return found[-1]
