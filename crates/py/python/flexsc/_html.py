"""HTML for notebooks: a heading, what is worth a table, a small figure."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape
from typing import Any

from flexsc import _native as engine

# Figures that show a run at a glance.
AT_A_GLANCE = ("angle", "pointing")
# A figure is drawn of a run that is repeated this soon (s).
SOON_S = 2.0


def picture(figure: engine.Figure) -> str:
    """A figure of at most 560 pixels."""
    small = 'style="width:560px;max-width:100%;height:auto;display:block"'
    return re.sub(r'width="\d+" height="\d+"', small, figure.svg(), count=1)


def of_log(log: engine.Log, scenario: engine.Scenario, name: str | None = None) -> str:
    """A figure of the run of a scenario; if it has no name, the one that shows the run at a glance."""
    if name is None:
        there = engine.log_figures(log, scenario)
        name = next((name for name in AT_A_GLANCE if name in there), None)
    return picture(engine.log_figure(log, name, scenario)) if name else ""


def heading(what: str, about: str) -> str:
    """A line that says what it is."""
    return f"<div><b>{escape(what)}</b> {escape(about)}</div>"


def line(text: str) -> str:
    """A line of text."""
    return f"<div>{escape(text)}</div>"


def pre(text: str) -> str:
    """Lines of text as they are."""
    return f"<pre>{escape(text)}</pre>"


def table(head: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A table of texts and numbers."""
    names = "".join(f"<th>{escape(name)}</th>" for name in head)
    cells = ("".join(f"<td>{escape(text(cell))}</td>" for cell in row) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in cells)
    return f"<table><thead><tr>{names}</tr></thead><tbody>{body}</tbody></table>"


def folded(summary: str, content: str) -> str:
    """What is shown on a click."""
    return f"<details><summary>{escape(summary)}</summary>{content}</details>"


def text(value: Any) -> str:
    """A value with six digits."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    size = getattr(value, "size", 0)
    return f"{size} values" if size > 4 else str(value)
