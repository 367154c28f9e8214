"""Texts of pages as HTML, in which whatever a rig or a file says is only text."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import Literal

import viser

_COLOURS = {"wrong": "#e8590c", "note": "inherit"}
_BASE = "padding: 0.3em 0.7em; font-size: 0.8em; line-height: 1.4;"


def write(element: viser.GuiHtmlHandle, text: str) -> None:
    """Let an element of a tab show a text; nothing is sent where it does already."""
    if element.content != text:
        element.content = text


def lines_html(lines: Iterable[str], kind: Literal["wrong", "note"]) -> str:
    """Write sentences below each other; nothing where there are none."""
    written = "".join(f"<div>{escape(line)}</div>" for line in lines)
    return f'<div style="{_BASE} color: {_COLOURS[kind]}">{written}</div>' if written else ""


def table_html(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Write a table; its first column is to the left, the others to the right."""
    body = "".join(_row(row, "td") for row in rows)
    return (
        f'<div style="{_BASE}"><table style="width: 100%; border-collapse: collapse">'
        f"{_row(heads, 'th')}{body}</table></div>"
    )


def _row(cells: Sequence[str], tag: str) -> str:
    written = "".join(
        f'<{tag} style="text-align: {"right" if column else "left"}">{escape(cell)}</{tag}>'
        for column, cell in enumerate(cells)
    )
    return f"<tr>{written}</tr>"
