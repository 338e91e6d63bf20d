"""Examples of docstrings as code: griffe takes bare lines that begin with `>>>` for text."""

from __future__ import annotations

import textwrap
from typing import Any

import griffe


def fenced(docstring: str) -> str:
    """The docstring with each of its examples in a block of code."""
    lines: list[str] = []
    example: list[str] = []
    for line in [*docstring.split("\n"), ""]:
        if example and not line.strip():
            code = textwrap.dedent("\n".join(example))
            lines += ["```pycon", *code.split("\n"), "```", ""]
            example = []
        elif example or line.lstrip().startswith(">>>"):
            example.append(line)
        else:
            lines.append(line)
    return "\n".join(lines).rstrip("\n")


class Doctests(griffe.Extension):
    """Rewrites docstrings before they are read."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        if obj.docstring is not None:
            obj.docstring.value = fenced(obj.docstring.value)
