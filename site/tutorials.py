"""Tutorials: scripts in cells (`# %%`), run, with what they print and draw put below each cell."""

from __future__ import annotations

from pathlib import Path

import jupytext
import nbformat
from nbclient import NotebookClient
from nbconvert import MarkdownExporter


def made(source: Path) -> dict[str, str | bytes]:
    """The page, its pictures, and the notebook to take along, by their names.

    Raises:
        CellExecutionError: A cell fails.
    """
    notebook = jupytext.read(source)
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    NotebookClient(
        notebook,
        timeout=300,
        kernel_name="python3",
        coalesce_streams=True,
        resources={"metadata": {"path": source.parent}},
    ).execute()
    prefix = source.stem
    page, resources = MarkdownExporter().from_notebook_node(
        notebook, resources={"unique_key": prefix, "output_files_dir": f"{prefix}-figures"}
    )
    title, rest = page.split("\n", 1)
    taken = f"\n[Download this page as a notebook]({prefix}.ipynb){{ download }}\n"
    files: dict[str, str | bytes] = {
        f"{prefix}.md": f"{title}\n{taken}{rest}",
        f"{prefix}.ipynb": nbformat.writes(notebook),
    }
    return files | resources.get("outputs", {})
