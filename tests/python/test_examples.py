"""Every public name says what it is, with an example that runs."""

import ast
import doctest
import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import flexsc
import flexsc._native
import numpy
import pytest

# They read files of other programs: the page about imports has examples, and tests of their own run them.
OF_FILES = {"appendage_from_nastran", "from_nastran"}
MODULES = {"parts", "plot", "scenario", "structure"}


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
        if not method.startswith("_") and (
            callable(inner) or isinstance(inner, property) or inspect.isgetsetdescriptor(inner)
        ):
            assert inspect.getdoc(inner), f"{name}.{method}"


@pytest.mark.parametrize("name", ["flexsc", "flexsc.plot", "flexsc.scenario", "flexsc._part"])
def test_every_module_has_an_example_that_runs(name: str) -> None:
    if name == "flexsc.plot":
        pytest.importorskip("matplotlib")
    module: ModuleType = importlib.import_module(name)
    text = module.__doc__ if name != "flexsc._part" else module.Part.to_dict.__doc__
    assert text
    assert run([doctest.DocTestParser().get_doctest(text, {}, name, None, None)]) > 0


def documented(stub: Path) -> Iterator[tuple[str, str]]:
    """Names of the engine's classes and of their members, with the texts that an editor shows."""
    for made in ast.parse(stub.read_text("utf-8")).body:
        if isinstance(made, ast.ClassDef) and not issubclass(getattr(flexsc._native, made.name), Exception):
            yield made.name, ast.get_docstring(made) or ""
            for member in made.body:
                if isinstance(member, ast.FunctionDef):
                    yield f"{made.name}.{member.name}", ast.get_docstring(member) or ""


def test_help_says_what_an_editor_shows() -> None:
    texts = {
        name: " ".join(text.split())
        for name, text in documented(Path(flexsc.__path__[0], "_native.pyi"))
        if text
    }
    assert len(texts) > 80
    for name, text in texts.items():
        thing: Any = flexsc._native
        for step in name.split("."):
            thing = getattr(thing, step)
        # The module has examples too.
        assert " ".join((inspect.getdoc(thing) or "").split()).partition(" >>>")[0] == text, name
