"""Writes `flexsc/results.py`, the classes of the results of analyses, from their schema.

`python crates/py/result_classes.py` does it, with `flexsc` installed. A struct of the engine is a frozen
dataclass. The unit at the end of a field's name goes; a list of objects of numbers is a dictionary of
columns; null is NaN for a number. What else differs from JSON is declared in Rust, by extensions of the
schema:

- `x-name`: the name in Python.
- `x-null`: `infinite` for a number that is infinite where it is null.
- `x-key`: a list of objects is a dictionary by this field of them.
- `x-names`: a list is a dictionary whose names are this field of the whole result.
- `x-main`: of a struct whose fields become fields of the struct that has it, or dictionaries where it is in a
  list with `x-key`: this one with the name of the struct's field, the others with that name before their own.
- `x-flat`: a form such as `{}_before` for the names of these fields instead; also for a list, which becomes
  columns.
- `x-dict`: a struct that is a dictionary, without the field that is the key.
- `x-tuple`: a struct that is a tuple, without the field that is the key.
- `x-type`: the class of something that is made elsewhere.

`tests/python/test_result_classes.py` checks that the file is current.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parent))
from scenario_classes import docstring

FILE = Path(__file__).parent / "python" / "flexsc" / "results.py"
WIDTH = 108
# Units that names of fields leave out. Hz stays, as a frequency without a unit is in rad/s.
UNITS = ("_rad_s", "_rad", "_nm_s", "_nm", "_s")
# Classes with methods, by hand.
BASES = {
    "IndexBudget": "BudgetFigure",
    "NoiseSpectrum": "NoiseFigure",
    "OutputBound": "BoundFigure",
    "StabilityMargins": "MarginsFigure",
    "TunedScenario": "TuningFigure",
    "WorstCase": "WorstFigure",
}
EXAMPLES = {
    "BudgetLevel": """
    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> level = budget.indices[0].levels[0.955]["mixed"]
    >>> level.campaign > 0.0
    True
    """,
    "IndexBudget": """
    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> index = budget.indices[0]
    >>> index.name, list(index.levels), list(index.sources)[:2]
    ('arrival', [0.683, 0.955, 0.997], ['bias', 'bias_spread'])
    """,
    "LoopMargins": """
    >>> margins = flexsc.Scenario.example("wheel-fast-mode").margins().loops["command"]
    >>> round(margins.gain_above, 2), round(margins.delay, 3), round(margins.modulus, 4)
    (3.03, 80.738, 0.6247)
    """,
    "MirrorSensitivity": """
    >>> mirror = {"frequency": 1885.0, "damping": 0.6, "period": 0.005, "gain": 0.25}
    >>> craft = flexsc.Scenario.example("wheel-run-up").with_("line_of_sight[0].mirror", mirror)
    >>> found = craft.spectrum(speeds=[40.0]).mirrors[0]
    >>> found.point, bool(found.sensitivity[0] < 0.1), found.peak > 1.0
    ('bench', True, True)
    """,
    "NoiseSpectrum": """
    >>> spectrum = flexsc.Scenario.example("attitude-hold").spectrum(["pitch"], window=1.0)
    >>> noise = spectrum.outputs["pitch"]
    >>> noise.window["mpe"] < noise.rms < 1e-4
    True
    """,
    "OutputBound": """
    >>> bound = flexsc.Scenario.example("bounded-jitter").bound()[0]
    >>> bound.output, bound.verdict
    ('roll', 'proved')
    >>> bool((bound.rows["high"] <= bound.range[1]).all())
    True
    """,
    "OutputNoise": """
    >>> noise = flexsc.Scenario.example("attitude-hold").spectrum().outputs["roll"]
    >>> max(noise.rms_by_source, key=noise.rms_by_source.get), noise.unit
    ('sensor.sampled.rate_noise', 'rad')
    """,
    "PointingBudget": """
    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> budget.runs, len(budget.indices) <= len(budget.requirements)
    (2, True)
    """,
    "RequiredContrast": """
    >>> sharp = {"name": "sharp", "quantity": "mtf", "point": "bench", "spatial_frequency": 1e5, "least": 0.9}
    >>> spectrum = flexsc.Scenario.example("wheel-run-up").with_("requirement", [sharp]).spectrum()
    >>> contrast = spectrum.contrasts["sharp"]
    >>> contrast.met == (contrast.mtf >= 0.9), list(contrast.costs)[0]
    (True, 'actuator.wheels.imbalance')
    """,
    "SettlingTime": """
    >>> times = flexsc.Scenario.example("attitude-hold").margins().settling_times
    >>> times[0].step, times[0].angle, times[0].time < 100.0
    ('roll', 'roll', True)
    """,
    "StabilityMargins": """
    >>> margins = flexsc.Scenario.example("attitude-hold").margins("torque")
    >>> list(margins.loops), margins.disk <= min(each.disk for each in margins.loops.values())
    (['torque_roll', 'torque_pitch', 'torque_yaw'], True)
    """,
    "TunedMeasure": """
    >>> scenario = flexsc.Scenario.example("attitude-hold")
    >>> ranges = {"law.per_axis.roll.pd.k_d": (100.0, 900.0)}
    >>> measure = scenario.tune(ranges, objective="settling", keep=["margin>=0.5"]).measures["settling"]
    >>> measure.value < measure.before
    True
    """,
    "TunedPlant": """
    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> plant = tuned.plants[0]
    >>> round(plant.margin_before, 4), round(plant.margin, 4)
    (0.5773, 0.7437)
    """,
    "TunedScenario": """
    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> list(tuned.keys), tuned.scenario.tune({"law.attitude.damping": (0.4, 1.5)}).keys == tuned.keys
    (['law.attitude.damping'], True)
    """,
    "Witness": """
    >>> scenario = flexsc.Scenario.example("bounded-jitter").with_("bound[0].limits", [-5e-6, 5e-6])
    >>> witness = scenario.bound()[0].witness
    >>> abs(witness.simulated / witness.value - 1.0) < 1e-9
    True
    """,
    "WorstCase": """
    >>> scenario = flexsc.Scenario.example("slew-wheel-lqg")
    >>> worst = scenario.worst(requirement="stability", points=20)
    >>> worst
    WorstCase(quantity='stability', value=2.435e-05, nominal=2.154e-05)
    """,
}
HEAD = '''"""Results of analyses in SI units, as `Scenario.margins` and other methods return them.

Arrays cannot be changed. NaN is a number that does not exist.
"""

# Made by crates/py/result_classes.py: a change here is lost.

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from flexsc._numpy import np, npt
from flexsc._read import (
    {readers},
)
from flexsc._review_figures import (
    {bases},
)

if TYPE_CHECKING:
    from flexsc._noise import WheelSpectrum
    from flexsc._scenario import Scenario

Values: TypeAlias = "npt.NDArray[np.float64]"
"""Numbers that cannot be changed."""
Columns: TypeAlias = "dict[str, npt.NDArray[np.float64]]"
"""Columns of numbers that cannot be changed, by their names."""

__all__ = [
    {names},
]
'''


class Field(NamedTuple):
    """A field of a class: name and type, path of its value in JSON, code of its reader, text."""

    name: str
    type: str
    path: str
    reader: str
    doc: str


def python_name(key: str) -> str:
    """The name of a field without its unit."""
    return next((key.removesuffix(unit) for unit in UNITS if key.endswith(unit)), key)


class Schema:
    """The schema of the results, and the classes that are made of it."""

    def __init__(self, schema: dict[str, Any]) -> None:
        self.all: dict[str, Any] = schema["$defs"]
        self.classes: dict[str, str] = {}
        # Names in the code of readers.
        self.readers: list[str] = []
        for of in schema["properties"].values():
            inner = of.get("items", of) if isinstance(of, dict) else {}
            if isinstance(inner, dict) and "$ref" in inner:
                self.add(inner["$ref"].rpartition("/")[2])

    def resolve(self, of: Any) -> tuple[dict[str, Any], str, bool]:
        """What a value is, with what its place adds; the name of its struct, and whether it may be null."""
        if not isinstance(of, dict):
            return {}, "", True
        nullable = "null" in of.get("type", ())
        if "anyOf" in of:
            [inner] = [choice for choice in of["anyOf"] if choice.get("type") != "null"]
            nullable = True
            of = {**inner, **{key: value for key, value in of.items() if key != "anyOf"}}
        if "$ref" not in of:
            return of, "", nullable
        name = of["$ref"].rpartition("/")[2]
        return {**self.all[name], **of}, name, nullable

    def add(self, name: str) -> None:
        """Adds the class of a struct, behind those that it has."""
        if name in self.classes:
            return
        of = self.all[name]
        fields = [each for key, value in of["properties"].items() for each in self.fields(key, value)]
        base = ", ".join([*([BASES[name]] if name in BASES else []), "Data"])
        text = f"\n\n@dataclass(frozen=True, eq=False, repr=False)\nclass {name}({base}):\n"
        doc = docstring(of["description"], "    ").rstrip().removesuffix('"""').rstrip()
        text += f'{doc}\n{EXAMPLES[name].rstrip()}\n    """\n'
        self.readers += [re.sub('"[^"]*"', "", each.reader) for each in fields]
        for each in fields:
            head, value = f"    {each.name}: {each.type} = at(", f"{json.dumps(each.path)}, {each.reader}"
            is_short = len(head) + len(value) < WIDTH + 2
            line = f"{head}{value})\n" if is_short else f"{head}\n        {value}\n    )\n"
            text += f"\n{line}{docstring(each.doc, '    ')}"
        self.classes[name] = text

    def fields(self, key: str, of: Any) -> Iterator[Field]:
        """The fields of a class that a field of JSON gives."""
        whole, _, nullable = self.resolve(of)
        name = whole.get("x-name", python_name(key))
        doc = str(of.get("description", "") if isinstance(of, dict) else "")
        form, main = whole.get("x-flat"), whole.get("x-main")
        items, _, _ = self.resolve(whole.get("items", {}))
        by = whole.get("x-key")
        if "properties" in whole and (form or main):
            for inner, text in self.inner(whole, name, form, main, doc):
                none = " | None" if nullable and inner.type != "float" else ""
                yield inner._replace(type=inner.type + none, path=f"{key}.{inner.path}", doc=text)
        elif by and items.get("x-main"):
            for inner, text in self.inner(items, name, form, items["x-main"], doc, by):
                reader = f'keyed("{by}", part("{inner.path}", {inner.reader}))'
                none = " | None" if nullable else ""
                kind = self.key_type(items, by)
                yield Field(inner.name, f"dict[{kind}, {inner.type}]{none}", key, reader, text)
        elif form and "properties" in items:
            for inner, text in self.inner(items, name, form, None, ""):
                yield Field(inner.name, "Values", key, f'column("{inner.path}")', text)
        else:
            kind, reader = self.shape(of)
            doc += self.members(items if kind == "Columns" else whole, by or "")
            yield Field(name, kind, key, reader, doc + self.if_null(whole, kind, doc))

    def inner(
        self, of: dict[str, Any], name: str, form: str | None, main: str | None, doc: str, by: str = ""
    ) -> Iterator[tuple[Field, str]]:
        """The fields of a struct for a field of this name, with their texts."""
        for key, value in of["properties"].items():
            if key == by:
                continue
            for each in self.fields(key, value):
                if key == main:
                    yield each._replace(name=name), doc + each.doc[len(value.get("description", "")) :]
                    continue
                text = each.doc
                if doc:
                    place = f"`{name}`" if main else doc[0].lower() + doc[1:].rstrip(".")
                    text = f"{text.rstrip('.')} ({place})."
                yield each._replace(name=(form or f"{name}_{{}}").format(each.name)), text

    def members(self, of: dict[str, Any], by: str) -> str:
        """What the text says of the columns, or of the names in a dictionary."""
        if not (of.get("x-dict") or ("properties" in of and "x-main" not in of and self.is_numeric(of))):
            return ""
        texts = {
            python_name(key): value["description"] for key, value in of["properties"].items() if key != by
        }
        each = (f"`{name}`: {text[0].lower()}{text[1:].rstrip('.')}" for name, text in texts.items())
        return f" {'; '.join(each)}."

    def is_numeric(self, of: dict[str, Any]) -> bool:
        """Whether a struct has numbers alone."""
        return all(each.get("type") in ("number", ["number", "null"]) for each in of["properties"].values())

    def if_null(self, of: dict[str, Any], kind: str, doc: str) -> str:
        """What the text says of null."""
        if kind == "float" and "null" in of.get("type", ()):
            return (
                " Infinite if there is none." if of.get("x-null") == "infinite" else " NaN if there is none."
            )
        return " None if there is none." if kind.endswith("| None") and "none" not in doc else ""

    def key_type(self, of: dict[str, Any], key: str) -> str:
        return self.shape(of["properties"][key])[0]

    def shape(self, of: Any, without: str = "") -> tuple[str, str]:
        """The type of a value, and the code of its reader."""
        whole, name, nullable = self.resolve(of)
        none = " | None" if nullable else ""
        if "x-type" in whole:
            return whole["x-type"] + none, "plain"
        choices = [each.get("const") for each in whole.get("oneOf", ())] or whole.get("enum")
        if choices:
            return f"Literal[{', '.join(map(json.dumps, choices))}]{none}", "plain"
        kinds = [whole.get("type")] if isinstance(whole.get("type"), str) else whole.get("type", [])
        kind = next((kind for kind in kinds if kind != "null"), None)
        if kind == "number":
            return "float", "bounded" if whole.get("x-null") == "infinite" else "number"
        if kind == "array":
            return self.list_shape(whole, none)
        if kind == "object" and "properties" in whole:
            return self.object_shape(whole, name, none, without)
        if kind == "object":
            return f"dict[str, {self.shape(whole['additionalProperties'])[0]}]{none}", "plain"
        plain = {"integer": "int", "boolean": "bool", "string": "str"}.get(str(kind))
        return (plain + none, "plain") if plain else ("dict[str, Any]", "plain")

    def object_shape(self, of: dict[str, Any], name: str, none: str, without: str) -> tuple[str, str]:
        if not (of.get("x-tuple") or of.get("x-dict")):
            self.add(name)
            return name + none, f"one({name})"
        inner = {key: self.shape(value) for key, value in of["properties"].items() if key != without}
        pairs = {key: f'("{key}", {reader})' for key, (_, reader) in inner.items()}
        types = list(dict.fromkeys(kind for kind, _ in inner.values()))
        if of.get("x-tuple"):
            return (
                f"tuple[{', '.join(kind for kind, _ in inner.values())}]",
                f"parts({', '.join(pairs.values())})",
            )
        named = "".join(f"    {python_name(key)}={pair},\n" for key, pair in pairs.items())
        constant = "_" + re.sub("(?<!^)(?=[A-Z])", "_", name).upper()
        self.classes[constant] = f"\n\n{constant} = attributes(\n{named})\n"
        self.readers += ["attributes", *(re.sub('"[^"]*"', "", pair) for pair in pairs.values())]
        return f"dict[str, {types[0] if len(types) == 1 else 'Any'}]{none}", constant

    def list_shape(self, of: dict[str, Any], none: str) -> tuple[str, str]:
        items, _, _ = self.resolve(of["items"])
        if by := of.get("x-key"):
            kind, reader = self.shape(of["items"], without=by)
            return f"dict[{self.key_type(items, by)}, {kind}]{none}", f'keyed("{by}", {reader})'
        if names := of.get("x-names"):
            kind, reader = self.shape(of["items"])
            return f"dict[str, {kind}]", f'named("{names}", {reader})'
        properties = items.get("properties", {})
        if properties and self.is_numeric(items):
            pairs = ", ".join(f'{python_name(key)}="{key}"' for key in properties)
            return "Columns", f"columns({pairs})"
        kind, reader = self.shape(of["items"])
        if kind in ("float", "Values"):
            if of.get("maxItems", -1) == of.get("minItems"):
                return f"tuple[{', '.join(['float'] * of['minItems'])}]{none}", "tuple_of(number)"
            return "Values", "array"
        return f"tuple[{kind}, ...]{none}", f"tuple_of({reader})"


def written(schema_of_results: dict[str, Any]) -> str:
    schema = Schema(schema_of_results)
    classes = schema.classes
    bodies = "".join(classes.values())
    readers = sorted({"Data", "at", *re.findall(r"\b[a-z_]+\b(?!=)", " ".join(schema.readers))})
    bases = sorted({BASES[name] for name in classes if name in BASES})

    def lines(names: list[str], mark: str = "") -> str:
        return ",\n    ".join(f"{mark}{name}{mark}" for name in names)

    head = HEAD.replace("{readers}", lines(readers)).replace("{bases}", lines(bases))
    return (
        head.replace(
            "{names}",
            lines(sorted([*(name for name in classes if name[0] != "_"), "Columns", "Values"]), '"'),
        )
        + bodies
    )


if __name__ == "__main__":
    from flexsc._analysis import analysis

    FILE.write_text(written(analysis("results")), encoding="utf-8")
