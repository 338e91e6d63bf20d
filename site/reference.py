"""Reference pages made from the engine: keys of scenarios, metrics, topics of logs, the command's help."""

from __future__ import annotations

import inspect
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import flexsc
import flexsc.papers
import flexsc.parts
import flexsc.plot
import flexsc.results
import flexsc.scenario
import flexsc.structure
from scenario_keys import Keys

Schema = dict[str, Any]
# A search finds the pages that describe a key before those that list it.
BEHIND = "---\nsearch:\n  boost: 0.2\n---\n\n"


def pages(keys: Keys) -> dict[str, str]:
    """The pages by their paths."""
    made = {
        "keys": Tables(keys).page(),
        "metrics": metrics(),
        "topics": topics(),
        "command": command(),
    }
    return {f"reference/{name}.md": text for name, text in made.items()} | python()


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table in Markdown."""
    lines = [head, tuple("---" for _ in head), *rows]
    return "".join(
        "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in line) + " |\n"
        for line in lines
    )


class Tables:
    """A walk over the schema: a section for each table of a scenario, at the first place that has it."""

    def __init__(self, keys: Keys) -> None:
        self.keys = keys
        self.schema = keys.schema
        self.places: dict[str, str] = {}
        self.sections: list[tuple[str, str, str]] = []

    def page(self) -> str:
        top = [
            self._row("", key, of, key in self.schema.get("required", ()))
            for key, of in self.schema["properties"].items()
        ]
        for key, of in self.schema["properties"].items():
            self._inside(key, of)
        rows = table(("key", "form", "default", "meaning"), top)
        text = (
            f"{BEHIND}# Every key of a scenario\n\n"
            "This page is made from the JSON Schema that `flexsc schema` prints, so no key is missing. "
            "A key leads to its place in [the scenario file](../scenario/index.md), which explains how the "
            "parts work together.\n\n"
            f"## At the top\n\n{rows}\n"
        )
        for title, doc, body in self.sections:
            text += f"## {title}\n\n{doc}\n\n{body}\n"
        return text

    def _resolved(self, of: Schema) -> tuple[Schema, str | None]:
        """What a place holds: without `null` beside it, without its reference, and the name of that."""
        choices = [choice for choice in of.get("anyOf", ()) if choice.get("type") != "null"]
        if len(choices) == 1:
            of = {**choices[0], **{key: value for key, value in of.items() if key != "anyOf"}}
        if "$ref" not in of:
            return of, None
        name = of["$ref"].rsplit("/", 1)[1]
        whole = self.schema["$defs"][name]
        if not isinstance(whole, dict):  # nothing that a file can name
            return {}, None
        return {**whole, **{k: v for k, v in of.items() if k != "$ref"}}, name

    def _inside(self, path: str, of: Schema) -> None:
        """Adds the sections of what stands at a path."""
        whole, name = self._resolved(of)
        if name is not None:
            if name in self.places:
                return
            self.places[name] = path
        if whole.get("type") == "array" and isinstance(whole.get("items"), dict):
            item, _ = self._resolved(whole["items"])
            if "properties" in item or "oneOf" in item or "anyOf" in item:
                self._inside(path if path.endswith("[]") else f"{path}[]", whole["items"])
            return
        own = self.schema["$defs"][name].get("description", "") if name else ""
        for variant in [*whole.get("oneOf", ()), *whole.get("anyOf", ())]:
            inner, _ = self._resolved(variant)
            properties = inner.get("properties", {})
            if len(properties) == 1 and "oneOf" in whole and "description" in inner:
                ((key, value),) = properties.items()
                self._inside(f"{path}.{key}", value)
            else:
                self._inside(path, variant)
        if "properties" in whole:
            required = whole.get("required", ())
            rows = [
                self._row(path, key, value, key in required) for key, value in whole["properties"].items()
            ]
            if rows and (path, own) not in [(place, doc) for place, doc, _ in self.sections]:
                body = table(("key", "form", "default", "meaning"), rows)
                self.sections.append((f"`{header(path)}`", own, body))
            for key, value in whole["properties"].items():
                self._inside(f"{path}.{key}", value)

    def _row(self, path: str, key: str, of: Schema, needed: bool) -> tuple[str, ...]:
        whole, _ = self._resolved(of)
        default = (
            "needed" if needed else short(whole["default"]) if whole.get("default") not in (None, "") else ""
        )
        link = self.keys.link(f"{path}.{key}".replace("[]", "").lstrip("."))
        name = f"[`{key}`]({link})" if link else f"`{key}`"
        return name, self._form(of), default, of.get("description", whole.get("description", ""))

    def _form(self, of: Schema) -> str:
        whole, _ = self._resolved(of)
        variants = [*whole.get("oneOf", ()), *whole.get("anyOf", ())]
        if variants:
            forms = []
            for variant in variants:
                inner, _ = self._resolved(variant)
                if "own" in inner.get("properties", {}):  # a part of a program's own
                    continue
                if "const" in inner:
                    forms.append(f'`"{inner["const"]}"`')
                elif "oneOf" in whole and len(inner.get("properties", {})) == 1:
                    forms.append(f"`{next(iter(inner['properties']))}`")
                else:
                    forms.append(self._form(variant))
            return ", ".join(dict.fromkeys(forms))
        kind = whole.get("type", "")
        if "enum" in whole:
            return ", ".join(f'`"{value}"`' for value in whole["enum"])
        if isinstance(kind, list):
            kind = next(one for one in kind if one != "null")
        if kind == "array":
            items = whole.get("items", {})
            of_items = self._form(items) if isinstance(items, dict) else ""
            count = whole.get("minItems") if whole.get("minItems") == whole.get("maxItems") else None
            plural = {"number": "numbers", "table": "tables", "text": "texts"}.get(of_items, of_items)
            return f"{count} {plural}" if count else f"list of {plural}"
        if kind in ("number", "integer"):
            return {"number": "number", "integer": "integer"}[kind] + "".join(bounds(whole))
        return {"string": "text", "object": "table", "boolean": "`true`, `false`"}.get(kind, kind)


def header(path: str) -> str:
    """The header of a table in a file: `body.planar.modes[]` is `[[body.planar.modes]]`."""
    plain = path.replace("[]", "")
    return f"[[{plain}]]" if path.endswith("[]") else f"[{plain}]"


def bounds(of: Schema) -> Iterator[str]:
    """The bounds of a number, in words."""
    for key, sign in (
        ("exclusiveMinimum", ">"),
        ("minimum", "≥"),
        ("exclusiveMaximum", "<"),
        ("maximum", "≤"),
    ):
        if key in of and abs(of[key]) < 1e9:
            yield f" {sign} {of[key]:g}"


def short(value: object) -> str:
    """A default as a scenario has it."""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f'`"{value}"`'
    if value in ({}, []):
        return "none"
    if isinstance(value, dict):
        return ""
    return f"`{value}`"


def metrics() -> str:
    rows = [(f"`{name}`", told["unit"], told["doc"]) for name, told in flexsc.metrics().items()]
    return (
        "# Every metric\n\nA run reports the metrics that its parts have. A number that does not "
        "exist is null in JSON and NaN in a table. `flexsc schema --metrics` prints this list.\n\n"
        + table(("metric", "unit", "meaning"), rows)
    )


def topics() -> str:
    text = (
        "# Every topic of a log\n\n`--log events` keeps what changes, `--log full` the motion too, "
        "`--log scene` also what viewers draw ([viewers](../viewers.md)). Each row has the time of its "
        "message. Names of fields end with their units. `flexsc schema --topics` prints this list.\n\n"
    )
    for name, told in flexsc.topics().items():
        text += f"## `/{name}`\n\n{told['doc']}\n\n" + table(
            ("field", "kind", "meaning"), list(fields(told["fields"], ""))
        )
        text += "\n"
    return text


def fields(of: list[dict[str, Any]], above: str) -> Iterator[tuple[str, ...]]:
    for field in of:
        labels = ", ".join(f"`{label}`" for label in field.get("labels", ()))
        yield f"`{above}{field['name']}`", field["kind"] + (f": {labels}" if labels else ""), field["doc"]
        yield from fields(field.get("fields", []), f"{above}{field['name']}.")


def command() -> str:
    """The help of every verb."""
    found = shutil.which("flexsc", path=str(Path(sys.executable).parent)) or "flexsc"

    def said(*words: str) -> str:
        return subprocess.run([found, *words, "--help"], capture_output=True, text=True, check=True).stdout

    overview = said()
    text = f"# Every verb of the command\n\n```text\n{overview}```\n"
    for verb in re.findall(r"^  ([a-z]+) ", overview, re.MULTILINE):
        text += f"\n## `flexsc {verb}`\n\n```text\n{said(verb)}```\n"
    return text


# Groups of the index of Python names; what is in none stands in the last.
GROUPS = {
    "Scenarios and runs": "Scenario Result Answer Samples Topic Metrics Simulator Simulators Snapshot "
    "Quantities Plan Log read_log examples schema metrics topics",
    "Campaigns and searches": "campaign sweep compare evaluate estimate read_campaign Table "
    "CampaignAnswer Comparison Row optimise Optimum explore Explorer sensitivities Sensitivities WorstCase "
    "PointingBudget IndexBudget BudgetLevel",
    "Linear models, margins and noise": "Linear Signal CommonMargins LoopMargins StabilityMargins "
    "NoiseSpectrum OutputNoise MirrorSensitivity SettlingTime WheelSpectrum WheelLines OutputBound "
    "Witness TunedScenario TunedPlant TunedMeasure",
    "Your own parts": "Law ThreeAxisLaw CompiledLaw Sensor Estimator Actuator Adaptation "
    "DisturbanceModel Guidance CompiledThreeAxisLaw CompiledDisturbance CompiledGuidance "
    "Reading Hold ThreeAxisHold Effort Load Aim",
    "Structures": "Structure StateSpace appendage_from_matrices appendage_from_nastran "
    "from_csv from_nastran from_state_space read_matrices",
    "Errors": "ScenarioError SimulationError LogError",
    "Others": "",
}
# The fields of a part are the arguments that make it, of which its signature has neither names nor defaults.
OF_A_PART = (
    "heading_level: 1, members: false, inherited_members: false, merge_init_into_class: false, "
    "show_bases: false, docstring_section_style: list"
)
# What the fields of a result are read from is of no interest.
OF_A_RESULT = (
    "heading_level: 1, merge_init_into_class: false, show_attribute_values: false, show_bases: false"
)
# Modules of the package with a page each, and whether that has their members.
MODULES = {
    "papers": True,
    "plot": True,
    "parts": False,
    "structure": False,
    "results": False,
    "scenario": False,
}


def python() -> dict[str, str]:
    """An index of the public names, with pages of classes, of modules and of the functions of a group."""
    names = [name for name in flexsc.__all__ if not name.startswith("__") and name not in MODULES]
    grouped = {name for group in GROUPS.values() for name in group.split()}
    made: dict[str, str] = {}
    index = (
        f"{BEHIND}# The Python module\n\n[Python](../python.md) is the way in; here is every name.\n\n"
        + listed([(f"flexsc.{name}", f"python/module-{name}.md", getattr(flexsc, name)) for name in MODULES])
        + "\n"
    )
    for number, (title, members) in enumerate(GROUPS.items()):
        own = [name for name in members.split() if name in names] or [
            name for name in names if name not in grouped
        ]
        if not own:
            continue
        functions = f"functions-{number}.md"
        rows = []
        for name in own:
            is_class = inspect.isclass(getattr(flexsc, name))
            page = f"{name}.md" if is_class else functions
            if is_class:
                options = OF_A_RESULT if name in flexsc.results.__all__ else "heading_level: 1"
                made[page] = f"{BEHIND}::: flexsc.{name}\n    options: {{{options}}}\n"
            else:
                made.setdefault(page, f"{BEHIND}# {title}: functions\n\n")
                made[page] += f"::: flexsc.{name}\n\n"
            rows.append(
                (name, f"python/{page}" + ("" if is_class else f"#flexsc.{name}"), getattr(flexsc, name))
            )
        index += f"## {title}\n\n{listed(rows)}\n"
    for name, whole in MODULES.items():
        members = "" if whole else "    options: {members: false, inherited_members: false}\n"
        made[f"module-{name}.md"] = f"{BEHIND}# flexsc.{name}\n\n::: flexsc.{name}\n{members}\n"
    classes = []
    for name in flexsc.scenario.__all__:
        of = getattr(flexsc.scenario, name)
        if inspect.isclass(of):
            made[f"scenario/{name}.md"] = (
                f"{BEHIND}::: flexsc.scenario.{name}\n    options: {{{OF_A_PART}}}\n"
            )
            classes.append((name, f"scenario/{name}.md", of))
    made["module-scenario.md"] += f"## Classes\n\n{listed(classes)}"
    return {"reference/python.md": index} | {f"reference/python/{page}": text for page, text in made.items()}


def listed(rows: list[tuple[str, str, object]]) -> str:
    """A table of names with their pages and the first sentences of their docstrings."""

    def first(of: object) -> str:
        paragraph = (inspect.getdoc(of) or "").split("\n\n")[0]
        return re.split(r"(?<=[.]) ", " ".join(paragraph.split()))[0]

    return table(("name", "meaning"), [(f"[`{name}`]({page})", first(of)) for name, page, of in rows])
