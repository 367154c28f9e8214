"""Progress bars on standard error."""

import contextlib
from collections.abc import Callable, Iterator, Mapping

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


@contextlib.contextmanager
def progress_bar(what: str, total: int) -> Iterator[Callable[[], None]]:
    """A bar that advances by one at each call of what is yielded."""
    with progress_bars({what: total}) as advance:
        yield lambda: advance(what)


@contextlib.contextmanager
def progress_bars(totals: Mapping[str, int]) -> Iterator[Callable[[str], None]]:
    """A bar for each name; what is yielded advances the one of the name that it is called with."""
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
