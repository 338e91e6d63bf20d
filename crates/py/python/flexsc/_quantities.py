"""The quantities of motion at an instant, of one run or of many, and commands to them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from flexsc._columns import Lookup
from flexsc._named import no_such
from flexsc._numpy import np, npt


class Quantities(Lookup["npt.NDArray[np.float64]"]):
    """The quantities of motion of a run at an instant: arrays by name, with units.

    For one run a quantity has shape () or (k,), for n copies shape (n,) or (n, k). The arrays do not change
    when the run is advanced.

    >>> sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes"))
    >>> sim.state["attitude"].shape, sim.state.units["rate"]
    ((4,), 'rad/s')
    """

    __slots__ = ("_values", "units")

    units: Mapping[str, str]
    """The unit of each quantity, empty for a dimensionless one.

    >>> sim.state.units["rate"]
    'rad/s'
    """

    def __init__(self, values: dict[str, npt.NDArray[np.float64]], units: Mapping[str, str]) -> None:
        self._values = values
        self.units = units

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self._values:
            raise no_such("no quantity", name, self._values)
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __reduce__(self) -> tuple[object, ...]:
        return _with_units, (self._values, dict(self.units))

    def __repr__(self) -> str:
        each = (f"{name}: {values} {self.units[name]}".rstrip() for name, values in self._values.items())
        return "\n".join(each)


def _with_units(values: dict[str, npt.NDArray[np.float64]], units: dict[str, str]) -> Quantities:
    """Create the quantities of a pickle, whose units are read-only again."""
    return Quantities(values, MappingProxyType(units))


class Fields:
    """The positions of the quantities of each group in a row."""

    def __init__(self, fields: list[tuple[str, str, str, int | None]]) -> None:
        self._places: dict[str, list[tuple[str, int | slice]]] = {}
        units: dict[str, dict[str, str]] = {}
        at = 0
        for group, name, unit, count in fields:
            place = at if count is None else slice(at, at + count)
            self._places.setdefault(group, []).append((name, place))
            units.setdefault(group, {})[name] = unit
            at += 1 if count is None else count
        self._units = {group: MappingProxyType(each) for group, each in units.items()}

    def view(self, group: str, rows: npt.NDArray[np.float64]) -> Quantities:
        values = {name: rows[..., place] for name, place in self._places[group]}
        return Quantities(values, self._units[group])


def parse_commands(given: npt.ArrayLike, shape: tuple[int, ...], unit: str) -> npt.NDArray[np.float64]:
    try:
        values = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"commands must be numbers of shape {shape}, got {given!r}") from error
    if np.shape(given) != shape:
        if shape[-1] != 1 or np.shape(given) != shape[:-1]:
            raise ValueError(f"commands must have shape {shape}, got {np.shape(given)}")
        values = values.reshape(shape)
    if not np.isfinite(values).all():
        where = np.argwhere(~np.isfinite(values))[0].tolist()
        raise ValueError(f"commands must be finite numbers{unit and f' of {unit}'}, not so at {where}")
    return values
