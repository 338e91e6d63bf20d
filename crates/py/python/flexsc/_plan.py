"""Planned manoeuvres."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._analysis import analysis
from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from flexsc._scenario import Scenario


class Plan(Mapping[str, Any]):
    """The plan of a scenario's manoeuvre, with the names of `flexsc plan --json`.

    Units are in the names: `plan["peak_torque_nm"]`, `plan["residual_rad"]["angle"]`.

    >>> import flexsc
    >>> plan = flexsc.Scenario.example("rotation-sine").plan(band=0.1)
    >>> plan
    <flexsc.Plan: 1.5708 rad in 12 s>
    >>> plan.torque([0.0, 3.0]).shape, len(plan.compare()) > 3
    ((2,), True)
    """

    def __init__(self, scenario: Scenario, band: float) -> None:
        self._scenario = scenario
        self._band = band
        self._values: dict[str, Any] = analysis("plan", scenario, band=band)

    def torque(self, time: npt.ArrayLike) -> npt.NDArray[Any]:
        """Return the command at times (s), in their shape (N m, or rad/s² if the hub's motion is
        prescribed).

        >>> plan.torque([0.0, 3.0]).round(3).tolist()                        # N m
        [0.0, 390.102]
        """
        times = np.asarray(time, dtype=np.float64)
        return engine.plan_torque(self._scenario._native, times.ravel()).reshape(times.shape)

    def compare(self, peak_torque: float | None = None) -> list[dict[str, Any]]:
        """Return the plans with every command for the same body, one dictionary each.

        Args:
            peak_torque: Plan each for this peak torque (N m), in its own time; if omitted, for the time of
                the scenario.

        >>> rivals = plan.compare()
        >>> rivals[0]["command"], round(rivals[0]["peak_torque_nm"], 1)       # N m
        ('sine p=0', 316.4)
        """
        rows: list[dict[str, Any]] = analysis(
            "rivals", self._scenario, band=self._band, peak_torque=peak_torque
        )
        return rows

    def __reduce__(self) -> tuple[object, ...]:
        return Plan, (self._scenario, self._band)

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def _repr_html_(self) -> str:
        from flexsc import _html

        return _html.table(("name", "value"), self.items())

    def __repr__(self) -> str:
        return f"<flexsc.Plan: {self['angle_rad']:g} rad in {self['time_s']:g} s>"
