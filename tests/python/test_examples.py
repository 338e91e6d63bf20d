"""Every public name says what it is, with an example that runs; so do the pages about Python."""

import doctest
import importlib
import inspect
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import flexsc
import numpy
import pytest

ROOT = Path(__file__).parents[2]
# They read files of other programs: the page about imports has examples, and tests of their own run them.
OF_FILES = {"appendage_from_nastran", "from_nastran"}
MODULES = {"parts", "plot", "scenario", "structure"}
PAGES = ["results.md"]


def run(found: list[doctest.DocTest]) -> int:
    """Runs examples, and counts them."""
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    told: list[str] = []
    for example in found:
        runner.run(example, out=told.append)
    assert runner.failures == 0, "".join(told)
    return sum(len(example.examples) for example in found)


@pytest.mark.parametrize("name", sorted(set(flexsc.__all__) - MODULES - {"__version__"}))
def test_every_name_has_an_example_that_runs(name: str) -> None:
    thing: Any = getattr(flexsc, name)
    text = inspect.getdoc(thing) or ""
    assert len(text) > 20, name
    if name in OF_FILES:
        return
    # An example shows what it is about: what every reader has imported may be left out.
    finder = doctest.DocTestFinder(recurse=inspect.isclass(thing))
    found = finder.find(thing, name, module=False, globs={**vars(flexsc), "flexsc": flexsc, "numpy": numpy})
    assert run(found) > 0, name
    for method, inner in vars(thing).items() if inspect.isclass(thing) else ():
        if not method.startswith("_") and (callable(inner) or isinstance(inner, property)):
            assert inspect.getdoc(inner), f"{name}.{method}"


@pytest.mark.parametrize("name", ["flexsc", "flexsc.plot", "flexsc.scenario", "flexsc._part"])
def test_every_module_has_an_example_that_runs(name: str) -> None:
    if name == "flexsc.plot":
        pytest.importorskip("matplotlib")
    module: ModuleType = importlib.import_module(name)
    text = module.__doc__ if name != "flexsc._part" else module.Part.to_dict.__doc__
    assert text
    assert run([doctest.DocTestParser().get_doctest(text, {}, name, None, None)]) > 0


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) > 2
    names: dict[str, Any] = {}
    for block in blocks:
        for missing in re.findall(r"^import (\w+)", block, re.MULTILINE):
            pytest.importorskip(missing)
        exec(compile(block, page, "exec"), names)
