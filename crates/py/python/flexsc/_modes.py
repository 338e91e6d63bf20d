"""The elastic modes of a scenario, and its observed coordinates, as arrays."""

from __future__ import annotations

import json

from flexsc import _native as engine
from flexsc._numpy import np, npt


def modes(native: engine.Scenario) -> dict[str, npt.NDArray[np.float64]]:
    """Return the columns of `Scenario.modes`."""
    table = json.loads(native.modes_json())
    if native.spatial:
        names = {"frequency": "frequencies_rad_s", "period": "periods_s", "damping": "dampings"}
        of_modes = {name: np.array(table[key], dtype=np.float64) for name, key in names.items()}
        return of_modes | {"influence": np.array(table["influences"], dtype=np.float64).T}
    columns = {
        "frequency": table["frequencies_rad_s"],
        "period": table["periods_s"],
        "damping": table["dampings"],
        "gain": table["gains"],
        "excitability": table["excitabilities_s2"],
        "effective_inertia": table["effective_inertias_kg_m2"],
        "free_frequency": table["free_frequencies_rad_s"],
        "clamped_frequency": table["clamped_frequencies_rad_s"],
    }
    none = [np.nan] * native.mode_count
    return {
        name: np.array(none if column is None else column, dtype=np.float64)
        for name, column in columns.items()
    }


def poles(native: engine.Scenario, speed: float | None) -> dict[str, npt.NDArray[np.float64]]:
    """Return the columns of `Scenario.poles`."""
    each = np.array(native.whirl_poles(speed), dtype=np.float64).reshape(-1, 2)
    return {"frequency": each[:, 0], "damping": each[:, 1]}


def outputs(native: engine.Scenario) -> dict[str, npt.NDArray[np.float64]]:
    """Return the weights of `Scenario.outputs`."""
    each = json.loads(native.modes_json()).get("outputs", [])
    return {o["name"]: np.array([o["rigid"], *o["weights"]], dtype=np.float64) for o in each}
