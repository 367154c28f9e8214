"""Progress bars on standard error, or lines on standard output for programs."""

import argparse
import contextlib
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

LINES_APART_S = 0.2
"""Seconds between two lines of one name, but for its last."""


def add_progress_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that makes the progress lines."""
    parser.add_argument(
        "--progress-lines",
        action="store_true",
        help="print the progress as lines, `progress: WHAT DONE/TOTAL`, for programs",
    )


@contextlib.contextmanager
def progress_bar(what: str, total: int, *, lines: bool = False) -> Iterator[Callable[[], None]]:
    """A bar that advances by one at each call of what is yielded."""
    with progress_bars({what: total}, lines=lines) as advance:
        yield lambda: advance(what)


@contextlib.contextmanager
def progress_bars(
    totals: Mapping[str, int], *, lines: bool = False
) -> Iterator[Callable[[str], None]]:
    """A bar for each name; what is yielded advances the one of the name that it is called with.

    With ``lines`` it is lines on standard output instead.
    """
    if lines:
        yield _lines(totals)
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    console = Console(stderr=True)
    hidden = not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=hidden) as progress:
        tasks = {name: progress.add_task(name, total=total) for name, total in totals.items()}
        yield lambda name: progress.advance(tasks[name])


def _lines(totals: Mapping[str, int]) -> Callable[[str], None]:
    done: Counter[str] = Counter()
    said_at: dict[str, float] = {}

    def advance(name: str) -> None:
        done[name] += 1
        now = time.monotonic()
        if done[name] == totals[name] or now - said_at.get(name, 0.0) >= LINES_APART_S:
            said_at[name] = now
            print(f"progress: {name} {done[name]}/{totals[name]}", flush=True)

    return advance
