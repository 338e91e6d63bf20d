"""Units: the names of columns and metrics end with their units; descriptions give the others."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NoReturn

from flexsc._analysis import analysis
from flexsc._columns import read_only
from flexsc._equality import equal
from flexsc._named import no_such

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

# The longest endings first: `_rad_s` ends with `_s`, too.
_ENDINGS = {
    "_kg_m2": "kg m²",
    "_rad_s2": "rad/s²",
    "_rad_s": "rad/s",
    "_m_s2": "m/s²",
    "_nm_s": "N m s",
    "_m_s": "m/s",
    "_1_s": "1/s",
    "_am2": "A m²",
    "_rad": "rad",
    "_nm": "N m",
    "_kg": "kg",
    "_fs": "fs",
    "_s": "s",
    "_m": "m",
    "_j": "J",
    "_t": "T",
    "_n": "N",
}
# On a body without a moment of inertia a torque is an acceleration.
_REDUCED = {"N m": "rad/s²", "N m s": "rad/s", "J": "J/(kg m²)"}
# A unit within a description, such as `Displacement (m sqrt(kg)).`
_IN_TEXT = re.compile(r"\(((?:rad|deg|m|s|N|kg|J|T|A|1/s|Hz|sqrt)\b(?:[^(),;]|\([^()]*\))*)")


def meanings(scenario: Scenario | None) -> dict[str, dict[str, str]]:
    """Return `unit` and `doc` of the metrics by name, for runs of a scenario if it is given."""
    values: dict[str, dict[str, str]] = analysis("metrics", scenario)
    return values


def is_reduced(scenario: Scenario | None) -> bool:
    """Whether the torques of a scenario are accelerations."""
    return meanings(scenario)["peak_torque_nm"]["unit"] != "N m"


def of_column(topic: str, name: str, reduced: bool = False) -> str:
    """The unit of a column such as `modes.displacement_rad`; empty for a count, a ratio or a word."""
    found = _ending(name) or _described().get((topic, name), "")
    return reduced_unit(found) if reduced else found


def reduced_unit(unit: str) -> str:
    """The unit of a quantity on a body without a moment of inertia, where a torque is an acceleration."""
    return _REDUCED.get(unit, unit)


def _ending(name: str) -> str:
    for part in reversed(name.split(".")):
        for ending, unit in _ENDINGS.items():
            if part.endswith(ending) and part != ending[1:]:
                return unit
    return ""


@lru_cache(maxsize=1)
def _described() -> dict[tuple[str, str], str]:
    """The units of columns whose names have none, by topic and column, from the engine's descriptions."""

    def units(above: str, unit: str, fields: list[dict[str, Any]]) -> Iterator[tuple[str, str]]:
        for field in fields:
            name = f"{above}.{field['name']}" if above else field["name"]
            own = in_text(field["doc"])
            if "fields" in field:
                # The components of a vector have its unit.
                yield from units(name, own if field["kind"] == "row" else "", field["fields"])
            elif field["kind"] == "time":
                yield name, "s"
            elif field["kind"] == "number" and (own or unit):
                yield name, own or unit

    topics = analysis("topics").items()
    return {(topic, name): unit for topic, of in topics for name, unit in units("", "", of["fields"])}


def in_text(text: str) -> str:
    """The unit in a description, such as that of `Angle at the start (rad)`; empty without one."""
    found = _IN_TEXT.search(text)
    return found[1].rstrip() if found else ""


@lru_cache(maxsize=256)
def of_key(path: str) -> str:
    """The unit of a key of a scenario, such as `body.planar.angle`; empty without one."""
    schema = analysis("schema")
    places: list[tuple[dict[str, Any], str]] = [(schema, "")]
    for step in re.sub(r"\[\d+\]", "[]", path).replace("[]", ".[]").split("."):
        places = [inner for place, _ in places for inner in _within(schema, place, step)]
    return next((unit for _, unit in places if unit), "")


def _within(schema: dict[str, Any], place: Any, step: str) -> Iterator[tuple[dict[str, Any], str]]:
    """The values that a step of a path may lead to, each with the unit of its description."""
    if not isinstance(place, dict):
        return
    if "$ref" in place:
        yield from _within(schema, schema["$defs"][place["$ref"].rpartition("/")[2]], step)
    for kind in ("oneOf", "anyOf"):
        for choice in place.get(kind, ()):
            yield from _within(schema, choice, step)
    inner = place.get("items") if step == "[]" else place.get("properties", {}).get(step)
    if isinstance(inner, dict):
        yield inner, in_text(inner.get("description", ""))


class Metrics(dict[str, Any]):
    """The metrics of a run by name: a dictionary with their units.

    Lists are arrays, words are str, lists of words are lists, and None means no value.

    >>> import flexsc
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0).simulate()
    >>> run.metrics["switchings"], run.metrics.unit("cycle_period_s")
    (81, 's')
    """

    def __init__(self, values: dict[str, Any], scenario: Scenario) -> None:
        super().__init__(values)
        read_only(value for value in values.values() if hasattr(value, "flags"))
        self._scenario = scenario
        self._meanings: dict[str, dict[str, str]] | None = None

    def __eq__(self, other: object) -> bool:
        return equal(self, other) if isinstance(other, Mapping) else NotImplemented

    # That of a dictionary takes arrays for truth values.
    __ne__ = object.__ne__
    __hash__ = None

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise TypeError("metrics are those of a run, and read-only: dict(run.metrics) can be changed")

    __setitem__ = __delitem__ = pop = popitem = clear = __ior__ = _refuse
    update = setdefault = _refuse  # pyright: ignore[reportAssignmentType]

    def __reduce__(self) -> tuple[Any, ...]:
        return Metrics, (dict(self), self._scenario)

    def __missing__(self, name: object) -> Any:
        raise no_such("no metric", name, self)

    def _ipython_key_completions_(self) -> list[str]:
        """Return the names of the metrics, which Jupyter and IPython complete."""
        return list(self)

    def _meaning(self, name: str) -> dict[str, str]:
        if name not in self:
            raise no_such("no metric", name, self)
        if self._meanings is None:
            self._meanings = meanings(self._scenario)
        return self._meanings[name]

    def unit(self, name: str) -> str:
        """Return the unit of a metric; empty for a count, a ratio or a word.

        >>> run.metrics.unit("cycle_period_s")
        's'

        Raises:
            KeyError: The run has no such metric.
        """
        return self._meaning(name)["unit"]

    def doc(self, name: str) -> str:
        """Return the meaning of a metric.

        >>> run.metrics.doc("switchings")
        'Number of switchings of the law'

        Raises:
            KeyError: The run has no such metric.
        """
        return self._meaning(name)["doc"]

    def _repr_html_(self) -> str:
        from flexsc import _html

        rows = ((name, value, self.unit(name)) for name, value in self.items())
        return _html.folded(f"{len(self)} metrics", _html.table(("metric", "value", "unit"), rows))

    def __repr__(self) -> str:
        def line(name: str, value: Any) -> str:
            unit = self.unit(name)
            return f"  {name}: {value}" + (f" {unit}" if unit and value is not None else "")

        lines = "\n".join(line(name, value) for name, value in self.items())
        return f"<flexsc.Metrics of {self._scenario.name}:\n{lines}>"
