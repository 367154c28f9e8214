"""What is said of a recording's file that cannot be opened."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from inhand_runtime.recording.layout import RecordingError


@contextmanager
def opening(path: Path) -> Iterator[None]:
    """Raise RecordingError, with the mend, for a file that is missing or cannot be read."""
    try:
        yield
    except FileNotFoundError:
        raise RecordingError(f"{path} does not exist: check the path") from None
    except OSError as error:
        raise RecordingError(
            f"cannot read {path}: {error.strerror}: give a file that you may read"
        ) from error
