"""Outputs that are there when they are whole, and not at all before."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from inhand_runtime.errors import InhandError

SUFFIX = ".exporting"


@contextmanager
def unfinished(output: Path) -> Iterator[Path]:
    """Yield where to write a file or folder, which gets its name when the block is done.

    Of what fails nothing stays. Raises InhandError where the output exists, or no room is left.
    """
    if output.exists():
        raise InhandError(f"{output} exists already: choose another name, or move it away")
    growing = output.with_name(output.name + SUFFIX)
    _remove(growing)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        yield growing
        growing.rename(output)
    except OSError as error:
        raise InhandError(
            f"cannot write {output}: {error.strerror or error}: make room or choose another disk"
        ) from error
    finally:
        _remove(growing)


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
