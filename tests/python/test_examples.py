"""Every public name says what it is, with an example that runs."""

import ast
import doctest
import importlib
import inspect
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import flexsc
import flexsc._native
import flexsc.dask
import flexsc.gym
import flexsc.papers
import flexsc.plot
import flexsc.results
import numpy
import pytest

# They read files of other programs: the page about imports has examples, and tests of their own run them.
# The last one needs a cluster; the page about campaigns shows it.
OF_FILES = {
    "flexsc.appendage_from_nastran",
    "flexsc.from_nastran",
    "flexsc.structure.appendage_from_nastran",
    "flexsc.structure.from_nastran",
    "flexsc.dask.campaign",
}


def run(found: list[doctest.DocTest]) -> int:
    """Runs examples, and counts them."""
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    told: list[str] = []
    for example in found:
        runner.run(example, out=told.append)
    assert runner.failures == 0, "".join(told)
    return sum(len(example.examples) for example in found)


def names_of(module: ModuleType) -> dict[str, Any]:
    """The public classes and functions of a module."""
    public: dict[str, Any] = {name: getattr(module, name) for name in module.__all__}
    return {name: thing for name, thing in public.items() if callable(thing)}


# The classes of scenarios have their keys, whose texts are those of the schema.
PUBLIC = {
    f"{module.__name__}.{name}": thing
    for module in (
        flexsc,
        flexsc.papers,
        flexsc.parts,
        flexsc.structure,
        flexsc.plot,
        flexsc.gym,
        flexsc.dask,
    )
    for name, thing in names_of(module).items()
}
CLASSES = {thing: name for name, thing in PUBLIC.items() if inspect.isclass(thing)}


def globals_of_readers() -> dict[str, Any]:
    """What every reader has imported: an example may leave it out, and shows what it is about."""
    return {**vars(flexsc.parts), **vars(flexsc), "flexsc": flexsc, "numpy": numpy}


def run_text(name: str, text: str, names: dict[str, Any]) -> int:
    """Run the examples of a text, which leave their names to those that follow; count them."""
    example = doctest.DocTestParser().get_doctest(text, names, name, None, None)
    # It copies the names.
    example.globs = names
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    told: list[str] = []
    runner.run(example, out=told.append, clear_globs=False)
    assert runner.failures == 0, "".join(told)
    return len(example.examples)


@pytest.mark.parametrize("name", PUBLIC)
def test_every_name_has_an_example_that_runs(name: str) -> None:
    thing = PUBLIC[name]
    text = inspect.getdoc(thing) or ""
    assert len(text) > 20, name
    if thing in CLASSES:
        text = own_classes(thing)[0].text
    if name not in OF_FILES:
        assert run_text(name, text, globals_of_readers()) > 0, name


class Described:
    """A class as its source describes it: its text, and those of its own public members."""

    def __init__(self, node: ast.ClassDef) -> None:
        self.text = ast.get_docstring(node) or ""
        self.members: dict[str, str] = {}
        for member, following in zip(node.body, [*node.body[1:], None], strict=True):
            if isinstance(member, ast.FunctionDef) and not is_overload(member):
                self.members[member.name] = ast.get_docstring(member) or ""
            elif isinstance(member, ast.AnnAssign) and isinstance(member.target, ast.Name):
                self.members[member.target.id] = text_of(following)
        self.members = {name: text for name, text in self.members.items() if not name.startswith("_")}


def is_overload(node: ast.FunctionDef) -> bool:
    return any(isinstance(one, ast.Name) and one.id == "overload" for one in node.decorator_list)


def text_of(node: ast.stmt | None) -> str:
    """The text that stands below an attribute."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return inspect.cleandoc(str(node.value.value))
    return ""


def described(path: Path) -> dict[str, Described]:
    body = ast.parse(path.read_text("utf-8")).body
    return {node.name: Described(node) for node in body if isinstance(node, ast.ClassDef)}


FOLDER = Path(flexsc.__path__[0])
STUB = described(FOLDER / "_native.pyi")
SOURCES: dict[str, Described] = {}
for source in [*FOLDER.glob("*.py"), *FOLDER.glob("structure/*.py")]:
    if source.name != "scenario.py":
        SOURCES.update(described(source))


def own_classes(thing: type) -> list[Described]:
    """The descriptions of a class and of its private bases in the package."""
    if getattr(flexsc._native, thing.__name__, None) is thing:
        return [STUB[thing.__name__]]
    private = [base for base in thing.__mro__[1:] if base not in CLASSES and base.__name__ in SOURCES]
    return [SOURCES[base.__name__] for base in (thing, *private)]


# The text of the class of each member, and its own. What a public base has counts there.
MEMBERS = {
    f"{name}.{member}": (own_classes(thing)[0].text, text)
    for thing, name in CLASSES.items()
    for one in reversed(own_classes(thing))
    for member, text in one.members.items()
}


# Data of results, whose texts are those of the engine: their classes have an example.
OF_RESULTS = {
    f"{CLASSES[kind]}.{field}"
    for kind in map(flexsc.results.__dict__.get, flexsc.results.__all__)
    if kind in CLASSES
    for field in kind.__dataclass_fields__
}
# Examples of their members change what the example of the class names: for each of them it runs anew.
STEPPED = {"flexsc.Simulator", "flexsc.Simulators"}


def run_class(text: str) -> dict[str, Any]:
    """Runs the example of a class; returns what readers have imported, and what the example names."""
    names = globals_of_readers()
    run_text("class", text, names)
    return names


run_class_once = cache(run_class)


@pytest.mark.parametrize("name", MEMBERS)
def test_every_member_has_an_example_that_runs(name: str) -> None:
    """Examples of members go on from that of their class."""
    of_class, text = MEMBERS[name]
    assert len(text.partition(">>>")[0]) > 8, f"{name} has no text"
    names = run_class(of_class) if name.rpartition(".")[0] in STEPPED else dict(run_class_once(of_class))
    assert run_text(name, text, names) > 0 or name in OF_RESULTS, f"{name} has no example"


def test_there_are_as_many_members_as_there_were() -> None:
    assert len(MEMBERS) > 300


@pytest.mark.parametrize("name", ["flexsc", "flexsc.parts", "flexsc.plot", "flexsc.scenario", "flexsc._part"])
def test_every_module_has_an_example_that_runs(name: str) -> None:
    if name == "flexsc.plot":
        pytest.importorskip("matplotlib")
    module: ModuleType = importlib.import_module(name)
    text = module.__doc__ if name != "flexsc._part" else module.Part.to_dict.__doc__
    assert text
    assert run([doctest.DocTestParser().get_doctest(text, {}, name, None, None)]) > 0


def test_help_says_what_an_editor_shows() -> None:
    """The stub is the source of both; the examples of members are in the stub alone."""
    texts = {name: one.text for name, one in STUB.items()}
    for name, one in STUB.items():
        texts |= {f"{name}.{member}": text for member, text in one.members.items()}
    # Attributes of errors have no text at run time.
    compared = {path: text for path, text in texts.items() if text and path != "ScenarioError.mistakes"}
    assert len(compared) > 80
    for path, text in compared.items():
        thing: Any = flexsc._native
        for step in path.split("."):
            thing = getattr(thing, step)
        shown, told = (" ".join(each.split()) for each in (text, inspect.getdoc(thing) or ""))
        assert told.partition(" >>>")[0] == shown.partition(" >>>")[0], path
        assert ">>>" not in told or told == shown, path
