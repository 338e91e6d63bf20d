"""Write the tutorials of docs/tutorials as notebooks, which are part of the package.

`python crates/py/tutorial_notebooks.py` does it. Code comes without output. `tests/python/test_tutorials.py`
checks that the notebooks are current.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "docs" / "tutorials"
NOTEBOOKS = ROOT / "crates" / "py" / "python" / "flexsc" / "tutorials"
PAGES = "https://github.com/flexsc/flexsc/blob/main/docs/"
MARK = "# %%"


def cells(text: str) -> list[dict[str, Any]]:
    """Return the cells of a script in cells, which begin with `# %%`."""
    found = []
    for number, part in enumerate(re.split(rf"^{MARK}", text, flags=re.MULTILINE)[1:]):
        head, body = part.split("\n", 1)
        lines = body.strip("\n").split("\n")
        is_text = head.strip() == "[markdown]"
        if is_text:
            lines = [line.removeprefix("#").removeprefix(" ") for line in lines]
            # A notebook has no page beside it.
            lines = [re.sub(r"\]\(\.\./", f"]({PAGES}", line) for line in lines]
        cell: dict[str, Any] = {"cell_type": "markdown" if is_text else "code", "id": f"cell-{number}"}
        if not is_text:
            cell |= {"execution_count": None, "outputs": []}
        source = [line + "\n" for line in lines[:-1]] + lines[-1:]
        found.append(cell | {"metadata": {}, "source": source})
    return found


def notebook(source: Path) -> str:
    """Return the notebook of a tutorial, as JSON."""
    content = {
        "cells": cells(source.read_text("utf-8")),
        "metadata": {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def main() -> None:
    """Write all notebooks."""
    NOTEBOOKS.mkdir(exist_ok=True)
    for source in sorted(SOURCES.glob("*.py")):
        (NOTEBOOKS / f"{source.stem}.ipynb").write_text(notebook(source), "utf-8", newline="\n")


if __name__ == "__main__":
    main()
