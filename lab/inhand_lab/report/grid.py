"""A table of text that terminals and Markdown can show."""

from dataclasses import dataclass

from rich import box
from rich.table import Table

NOTHING = "–"
"""The cell of a figure that there is not."""

LONGEST_UNBROKEN = 11
"""Number of characters of a column's header up to which it stays in one line."""


@dataclass(frozen=True)
class Grid:
    """Rows of text under a header, some of them set apart as a summary."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    summary: tuple[tuple[str, ...], ...] = ()

    def for_terminal(self) -> Table:
        """Return the table as a terminal shows it: at most 80 columns wide with six methods.

        Long headers break after their last hyphen.
        """
        table = Table(title=self.title, box=box.SIMPLE_HEAD, padding=0, show_edge=False)
        for index, name in enumerate(self.header):
            table.add_column(_broken(name), justify="right" if index else "left", no_wrap=True)
        for row in self.rows:
            table.add_row(*map(_narrow, row))
        if self.summary:
            table.add_section()
        for row in self.summary:
            table.add_row(*map(_narrow, row))
        return table

    def for_markdown(self) -> str:
        """Return the table with its title as a heading."""
        alignment = (":--", *["--:"] * (len(self.header) - 1))
        bold = [tuple(f"**{cell}**" for cell in row) for row in self.summary]
        lines = [f"| {' | '.join(row)} |" for row in (self.header, alignment, *self.rows, *bold)]
        return "\n".join([f"## {self.title}", "", *lines, ""])


def _narrow(cell: str) -> str:
    return cell.replace(" ± ", "±")


def _broken(name: str) -> str:
    head, hyphen, tail = name.rpartition("-")
    return f"{head}-\n{tail}" if hyphen and len(name) > LONGEST_UNBROKEN else name
