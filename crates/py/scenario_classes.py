"""Writes `flexsc/scenario.py`, the classes of a scenario's parts, from the schema.

`python crates/py/scenario_classes.py` does it, with `flexsc` installed. A table of the schema is a class with
its keys; a choice of kinds, such as `Law`, is a class for each kind, and the union of them, `LawKind`.
`tests/python/test_scenario_classes.py` checks that the file is current.
"""

from __future__ import annotations

import json
import keyword
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

FILE = Path(__file__).parent / "python" / "flexsc" / "scenario.py"
WIDTH = 108
# Tables and choices whose names in the schema need a number to differ.
NAMES = {
    "Drive2": "AppendageDrive",
    "Form2": "FilterForm",
    "Form3": "ObserverForm",
    "Initial2": "AttitudeFilterInitial",
    # `flexsc.Log` is a log file.
    "Log": "LogContents",
    "Plate2": "DragPlate",
    "Target": "ShapedZero",
    "Target2": "Target",
    "Weights2": "RecurrenceWeights",
}
# Names that mean something else in `flexsc` and `flexsc.parts`: a kind with one of them also has the name of
# its choice.
TAKEN = {"Hold", "StateSpace", "Table", "Truth"}
HEAD = '''"""The parts of a scenario as classes, for editors and type checkers.

    >>> import flexsc
    >>> from flexsc.scenario import Mode, Planar, Relay
    >>> scenario = flexsc.Scenario(
    ...     name="two-sided",
    ...     duration=600.0,
    ...     body=Planar(angle=4.5e-4, modes=[Mode(frequency=0.44, gain=0.0213)]),
    ...     law=Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.31),
    ... )
    >>> scenario.to_dict()["law"]["relay"]["k_t"]
    0.31

Their keys, units and meanings are those of a scenario file. A key that is left out has its default: its
field is None until a scenario is made of the part, and `Scenario.part` returns it with all defaults. A
table of which there are several kinds, such as `[law]`, has a class for each kind, and a union of them,
`LawKind`. Parts of which a file has several, such as its `[[sensor]]`, are a list. What values have to be
is checked when a scenario is made of them; all mistakes are reported at once.
"""

# Made by crates/py/scenario_classes.py: a change here is lost.

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, TypedDict, Union

from flexsc._part import DEFAULT, Part

if TYPE_CHECKING:
    import numpy.typing as npt

Vector: TypeAlias = Union[Sequence[float], "npt.NDArray[Any]"]
"""Numbers in a row: a list, a tuple or an array of shape (n,)."""
Rows: TypeAlias = Union[Sequence[Sequence[float]], "npt.NDArray[Any]"]
"""Rows of numbers: lists in a list, or an array of shape (rows, columns)."""
'''
OLD_NAMES = """

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        from flexsc import _deprecated

        return _deprecated.of_module(__name__, name)
"""


def camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def named(name: str) -> str:
    """The name of a class or a union."""
    name = NAMES.get(name, name)
    if name[-1].isdigit():
        sys.exit(f"{name}: name it in NAMES of {__file__}")
    return name


def union(choice: str) -> str:
    """The name of the union of the kinds of a choice."""
    return f"{named(choice)}Kind"


def ref(of: Any) -> str | None:
    """The name of what a value refers to, if it may be nothing else."""
    if isinstance(of, dict) and "anyOf" in of:
        [*others] = [choice for choice in of["anyOf"] if choice.get("type") != "null"]
        of = others[0] if len(others) == 1 else of
    return of["$ref"].rpartition("/")[2] if isinstance(of, dict) and "$ref" in of else None


def tagged(choice: dict[str, Any]) -> tuple[str, Any] | None:
    """The kind that a choice names, and what it holds."""
    if choice.get("type") == "object" and len(choice.get("properties", {})) == 1:
        [(tag, content)] = choice["properties"].items()
        if choice.get("required") == [tag]:
            return tag, content
    return None


class Schema:
    """The schema, and the names of the classes that are made of it."""

    def __init__(self, schema: dict[str, Any]) -> None:
        self.root = schema
        self.all: dict[str, Any] = schema["$defs"]
        self.choices = {
            name: self.kinds(of) for name, of in self.all.items() if isinstance(of, dict) and self.kinds(of)
        }
        # Tables that are the kind of one choice: where they are used without it, they lose their tag.
        all_kinds = [(name, tag, of) for name, kinds in self.choices.items() for tag, of in kinds]
        held = [(ref(of), (name, tag)) for name, tag, of in all_kinds if ref(of)]
        counts = [name for name, _ in held]
        once = {name: kind for name, kind in held if counts.count(name) == 1}
        self.of_kind = {name: kind for name, kind in once.items() if self.all[name].get("properties")}
        self.tables: list[str] = []
        for of in [*self.all.values(), schema]:
            self.reach(of)
        tags = [camel(tag) for kinds in self.choices.values() for tag, _ in kinds]
        # A name of the package counts twice, so that no kind has it alone.
        taken = [*tags, *map(named, self.tables), *map(union, self.choices), *TAKEN, *TAKEN]
        self.kind_names = {
            (choice, tag): camel(tag) if taken.count(camel(tag)) == 1 else camel(tag) + named(choice)
            for choice, kinds in self.choices.items()
            for tag, _ in kinds
        }

    def kinds(self, of: dict[str, Any]) -> list[tuple[str, Any]]:
        """The kinds of a choice; those that no file can hold are left out."""
        found = [tagged(choice) for choice in of.get("oneOf", ())]
        return [kind for kind in found if kind and self.resolve(kind[1]) is not False]

    def resolve(self, of: Any) -> Any:
        return self.all[of["$ref"].rpartition("/")[2]] if isinstance(of, dict) and "$ref" in of else of

    def reach(self, of: Any) -> None:
        """Notes the tables that something refers to other than as a kind."""
        if isinstance(of, dict):
            if "$ref" in of:
                name = of["$ref"].rpartition("/")[2]
                table, known = self.all[name], name in self.tables or name in self.of_kind
                if isinstance(table, dict) and table.get("properties") and not known:
                    self.tables.append(name)
            for key, inner in of.items():
                if key == "oneOf":
                    for choice in inner:
                        kind = tagged(choice)
                        content = self.resolve(kind[1]) if kind else choice
                        if kind and not (isinstance(content, dict) and content.get("type") == "object"):
                            self.reach(kind[1])
                elif key != "$defs":
                    self.reach(inner)
        elif isinstance(of, list):
            for inner in of:
                self.reach(inner)

    def type_of(self, of: Any) -> str:
        """The type of a value, without None."""
        if "$ref" in of:
            name = of["$ref"].rpartition("/")[2]
            if name in self.choices:
                extra = [c for c in self.all[name]["oneOf"] if not tagged(c)]
                return " | ".join([union(name), *([self.literals(extra)] if extra else [])])
            if name in self.tables:
                return named(name)
            if name in self.of_kind:
                return self.kind_names[self.of_kind[name]]
            return self.type_of(self.all[name])
        if "const" in of:
            return f'Literal["{of["const"]}"]'
        if "oneOf" in of:
            return self.literals(of["oneOf"])
        if "anyOf" in of:
            types = [self.type_of(choice) for choice in of["anyOf"] if choice.get("type") != "null"]
            flat = [part for one in types for part in parts_of(one)]
            return " | ".join(dict.fromkeys(flat))
        kinds = of["type"] if isinstance(of["type"], list) else [of["type"]]
        [kind] = [kind for kind in kinds if kind != "null"]
        if kind == "array":
            inner = self.type_of(of["items"])
            return {"float": "Vector", "Vector": "Rows"}.get(inner, f"Sequence[{inner}]")
        if kind == "object":
            inner = of.get("additionalProperties")
            return f"Mapping[str, {self.type_of(inner) if isinstance(inner, dict) else 'object'}]"
        return {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}[kind]

    def literals(self, choices: list[dict[str, Any]]) -> str:
        return f"Literal[{', '.join(json.dumps(choice['const']) for choice in choices)}]"


def parts_of(union: str) -> list[str]:
    """The types of a union; one within the brackets of another stays there."""
    parts = [""]
    for piece in union.split(" | "):
        whole = parts[-1].count("[") == parts[-1].count("]")
        parts = [*parts, piece] if whole else [*parts[:-1], f"{parts[-1]} | {piece}"]
    return parts[1:]


def told(text: str) -> str:
    """A description as plain text."""
    return re.sub(r"\\([\[\]_])", r"\1", " ".join(text.split()))


def docstring(text: str, indent: str, keys: list[tuple[str, str]] | None = None) -> str:
    text = told(text)
    if keys:
        lines = [*textwrap.wrap(text, WIDTH - len(indent) - 3, break_long_words=False), "", "Args:"]
        for name, meaning in keys:
            lines += textwrap.wrap(
                f"{name}: {told(meaning)}",
                WIDTH - len(indent),
                initial_indent=" " * 4,
                subsequent_indent=" " * 8,
                break_long_words=False,
            )
        return (
            f'{indent}"""'
            + "\n".join(f"{indent}{line}".rstrip() for line in lines).lstrip()
            + f'\n{indent}"""\n'
        )
    if len(indent) + len(text) + 6 <= WIDTH + 1:
        return f'{indent}"""{text}"""\n'
    lines = textwrap.wrap(text, WIDTH - len(indent) - 3, break_long_words=False)
    return f'{indent}"""' + f"\n{indent}".join(lines) + f'\n{indent}"""\n'


def python_name(key: str) -> str:
    """The name of a key in Python, which keeps some for itself."""
    return f"{key}_" if keyword.iskeyword(key) else key


def meaning(of: dict[str, Any], needed: bool) -> str:
    """The description of a key, with its default."""
    doc: str = of.get("description", "")
    given = of.get("default")
    if not needed and given not in (None, [], {}) and not isinstance(given, (dict, list)):
        doc = f"{doc} Default: {json.dumps(given)}."
    return doc


def field(schema: Schema, name: str, of: dict[str, Any], needed: bool) -> str:
    is_date = name == "epoch"
    name = python_name(name)
    kind = "datetime" if is_date else schema.type_of(of)
    line = f"    {name}: {kind}\n" if needed else f"    {name}: {kind} = DEFAULT\n"
    if len(line) > 110:
        # Ruff's form of a choice of many words.
        line = line.replace('Literal["', 'Literal[\n        "').replace('", "', '",\n        "')
        line = line.replace('"]', '",\n    ]')
    doc = meaning(of, needed)
    return line + (docstring(doc, "    ") if doc else "")


def table(schema: Schema, name: str, of: dict[str, Any], doc: str, tag: str | None) -> str:
    """The class of a table, as a kind of a choice if it has a tag."""
    head = f"\n\nclass {name}(Part):\n"
    needed = of.get("required", [])
    properties = of.get("properties", {})
    order = sorted(properties, key=lambda key: key not in needed)
    meanings = [(python_name(key), meaning(properties[key], key in needed)) for key in order]
    body = docstring(doc or f"The table `{tag or name}`.", "    ", meanings)
    body += f'\n    _tag: ClassVar[str | None] = "{tag}"\n' if tag else ""
    bare = [key for key, value in of.get("properties", {}).items() if ref(value) in schema.of_kind]
    if bare:
        line = f"    _bare: ClassVar[tuple[str, ...]] = ({''.join(f'{json.dumps(key)}, ' for key in bare)})\n"
        if len(line) > WIDTH:
            line = (
                line.replace('("', '(\n        "')
                .replace('", "', '",\n        "')
                .replace('", )', '",\n    )')
            )
        body += f"\n{line}"
    fields = "".join(field(schema, key, properties[key], key in needed) for key in order)
    return head + body + ("\n" + fields if fields else "")


def wrapped(schema: Schema, name: str, of: dict[str, Any], doc: str, tag: str) -> str:
    """The class of a kind that holds one value."""
    head = f"\n\nclass {name}(Part, kw_only=False):\n"
    body = docstring(doc or f"The kind `{tag}`.", "    ") + f'\n    _tag: ClassVar[str | None] = "{tag}"\n'
    return head + body + f"\n    value: {schema.type_of(of)}\n"


def written(schema_of_scenarios: dict[str, Any]) -> str:
    schema = Schema(schema_of_scenarios)
    classes: list[tuple[str, str]] = []
    unions = []
    for choice, kinds in schema.choices.items():
        by_tag = {kind[0]: c for c in schema.all[choice]["oneOf"] if (kind := tagged(c))}
        names = []
        for tag, content in kinds:
            name = schema.kind_names[choice, tag]
            of = schema.resolve(content)
            doc = by_tag[tag].get("description") or of.get("description", "")
            if of.get("type") == "object" and of.get("additionalProperties") is False:
                classes.append((name, table(schema, name, of, doc, tag)))
            else:
                classes.append((name, wrapped(schema, name, content, doc, tag)))
            names.append(name)
        alias = union(choice)
        line = f"{alias}: TypeAlias = {' | '.join(names)}\n"
        if len(line) > WIDTH:
            parts = "\n    | ".join(names)
            line = f"{alias}: TypeAlias = (\n    {parts}\n)\n"
        unions.append((alias, line + docstring(schema.all[choice].get("description", ""), "")))
    for name in schema.tables:
        of = schema.all[name]
        doc = of.get("description", "")
        classes.append((named(name), table(schema, named(name), of, doc, None)))
    names = sorted([*(name for name, _ in classes), *(name for name, _ in unions), "Keys", "Rows", "Vector"])
    listed = "\n__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n"
    keys = "\n\nclass Keys(TypedDict, total=False):\n" + docstring(
        "The keys of a scenario, as `flexsc.Scenario` takes them.", "    "
    )
    for key, of in schema.root["properties"].items():
        if key != "name":
            type_ = "datetime" if key == "epoch" else schema.type_of(of)
            line = f"    {key}: {type_}\n"
            if len(line) > WIDTH + 2:
                line = f"    {key}: (\n        {type_}\n    )\n"
            keys += f"\n{line}" + docstring(of.get("description", ""), "    ")
    text = HEAD.replace("\nVector: TypeAlias", listed + "\nVector: TypeAlias", 1)
    bodies = "".join(body for _, body in sorted(classes))
    return text + bodies + "\n\n" + "".join(union for _, union in sorted(unions)) + keys + OLD_NAMES


if __name__ == "__main__":
    import flexsc

    FILE.write_text(written(flexsc.schema()), encoding="utf-8")
