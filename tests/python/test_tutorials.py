"""The notebooks of the package: made of docs/tutorials, written by the command, and run."""

from __future__ import annotations

import builtins
import importlib.util
import json
import os
import re
import subprocess
import symtable
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
NAMES = sorted(path.stem for path in (ROOT / "docs" / "tutorials").glob("*.py"))
# What a notebook may not need: libraries that come with neither `flexsc` nor `flexsc[plot]`.
OTHERS = ["IPython", "control", "dask", "gymnasium", "pandas", "polars", "pyarrow", "scipy"]
RUN = """
import sys
import matplotlib
matplotlib.use("agg")
sys.modules.update(dict.fromkeys(OTHERS))
names = {"__name__": "__main__"}
for cell in CELLS:
    exec(cell, names)
"""


def command(*arguments: str | Path, exits: int = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        [sys.executable, "-m", "flexsc", "tutorials", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
        encoding="utf-8",
    )
    assert done.returncode == exits, done.stderr
    return done


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("work") / "new" / "tutorials"
    done = command("-o", directory)
    assert done.stdout.split() == [str(directory / f"{name}.ipynb") for name in NAMES]
    return directory


def test_the_notebooks_are_current(written: Path) -> None:
    path = ROOT / "crates" / "py" / "tutorial_notebooks.py"
    spec = importlib.util.spec_from_file_location("tutorial_notebooks", path)
    assert spec
    assert spec.loader
    maker: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(maker)
    assert sorted(path.stem for path in maker.NOTEBOOKS.glob("*.ipynb")) == NAMES
    for name in NAMES:
        made = maker.notebook(maker.SOURCES / f"{name}.py")
        text = (maker.NOTEBOOKS / f"{name}.ipynb").read_text("utf-8")
        assert text == made, "python crates/py/tutorial_notebooks.py makes them"
        assert (written / f"{name}.ipynb").read_text("utf-8") == text
        # No link leads to a page beside the notebook.
        assert "](../" not in text


def cells(path: Path) -> list[str]:
    """The code of the cells of a notebook."""
    notebook = json.loads(path.read_text("utf-8"))
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_needs_no_names_of_jupyter(name: str, written: Path) -> None:
    """All that is not of Python is made or imported by a cell above: what runs in Jupyter runs without it."""
    known = {*dir(builtins), "__name__"}
    for cell in cells(written / f"{name}.ipynb"):
        made: set[str] = set()
        used: set[str] = set()
        waiting = [symtable.symtable(cell, name, "exec")]
        while waiting:
            table = waiting.pop()
            waiting += table.get_children()
            for symbol in table.get_symbols():
                if symbol.is_global() or table.get_type() == "module":
                    made |= {symbol.get_name()} if symbol.is_assigned() or symbol.is_imported() else set()
                    used |= {symbol.get_name()} if symbol.is_referenced() else set()
        known |= made
        assert used <= known
    text = "\n".join(cells(written / f"{name}.ipynb"))
    imported = set(re.findall(r"^\s*(?:import|from) (\w+)", text, re.MULTILINE))
    assert not imported & set(OTHERS)


def test_the_command_lists_them() -> None:
    lines = command().stdout.splitlines()
    assert [line.split()[0] for line in lines] == NAMES
    for name, line in zip(NAMES, lines, strict=True):
        title = (ROOT / "docs" / "tutorials" / f"{name}.py").read_text("utf-8").splitlines()[1]
        assert line.split(maxsplit=1)[1] == title.removeprefix("# # ")


def test_other_files_are_kept(written: Path, tmp_path: Path) -> None:
    command("-o", written)
    mine = tmp_path / f"{NAMES[0]}.ipynb"
    mine.write_text("mine", "utf-8")
    refused = command("-o", tmp_path, exits=1)
    assert refused.stderr == f"error: {mine} exists and is another file: --force replaces it\n"
    assert [path.name for path in tmp_path.iterdir()] == [mine.name]
    assert mine.read_text("utf-8") == "mine"
    command("-o", tmp_path, "--force")
    assert mine.read_text("utf-8") == (written / mine.name).read_text("utf-8")
    assert "usage: flexsc tutorials" in command("-x", exits=2).stderr


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_runs_with_matplotlib_alone(name: str, written: Path) -> None:
    found = cells(written / f"{name}.ipynb")
    assert len(found) > 3
    script = f"CELLS = {found!r}\nOTHERS = {OTHERS!r}\n{RUN}"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=written, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_runs_in_jupyter(name: str, written: Path) -> None:
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(written / f"{name}.ipynb", as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(written)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", {}) for output in outputs)
