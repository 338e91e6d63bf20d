"""Every public name says what it is, with an example that runs."""

import doctest
import importlib
import inspect
from types import ModuleType
from typing import Any

import flexsc
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
