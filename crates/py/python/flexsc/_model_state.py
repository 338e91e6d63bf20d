"""The state of a linear model at an instant of a stepped run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc._values import AXES, kind_of

if TYPE_CHECKING:
    from flexsc._linear import Linear
    from flexsc._scenario import Scenario
    from flexsc._simulator import Simulator
    from flexsc._simulators import Simulators

    Values = npt.NDArray[np.float64]


def state_of(model: Linear, simulator: Simulator | Simulators) -> Values:
    """Return the state of a model where a run, or each copy of many, is."""
    known = _one_axis(simulator) if simulator.axes == 1 else _three_axes(simulator)
    known |= _acting(model, simulator)
    missing = [signal.name for signal in model.states if signal.name not in known]
    if missing:
        raise ValueError(
            f"{simulator.scenario.name}: a simulator does not have the states {', '.join(missing)} of the "
            f"model; it has {', '.join(known)}"
        )
    shape = simulator.state["rigid_rate"].shape[: None if simulator.axes == 1 else -1]
    return np.stack([known[signal.name] for signal in model.states], axis=-1).reshape(*shape, -1)


def _one_axis(simulator: Simulator | Simulators) -> dict[str, Values]:
    state = simulator.state
    known = {"rigid_angle": state["rigid_angle"], "rigid_rate": state["rigid_rate"]}
    return known | _modes(state["modes"], state["mode_rates"])


def _three_axes(simulator: Simulator | Simulators) -> dict[str, Values]:
    state = simulator.state
    # The attitude is that of the hub, which modes of a spacecraft turn; rigid angles are without the modes.
    turned = np.einsum("...ma,...m->...a", _hub_rotations(simulator), state["modes"])
    angles, rates = state["error"] - turned, state["rigid_rate"]
    known = {f"rigid_{axis}": angles[..., k] for k, axis in enumerate(AXES)}
    known |= {f"rigid_{axis}_rate": rates[..., k] for k, axis in enumerate(AXES)}
    return known | _modes(state["modes"], state["mode_rates"])


def _modes(displacements: Values, rates: Values) -> dict[str, Values]:
    known: dict[str, Values] = {}
    for mode in range(displacements.shape[-1]):
        known[f"mode{mode}_displacement"] = displacements[..., mode]
        known[f"mode{mode}_rate"] = rates[..., mode]
    return known


def _acting(model: Linear, simulator: Simulator | Simulators) -> dict[str, Values]:
    """The torques that act: states of a model whose inputs take effect within a period."""
    torque = _without_back_emf(simulator)
    axes = [""] if simulator.axes == 1 else [f"_{axis}" for axis in AXES]
    names = {signal.name for signal in model.states}
    # An attitude loop names them as the inputs of the body.
    known = {f"torque{axis}": torque[..., k] if axes[0] else torque for k, axis in enumerate(axes)}
    known = {name: values for name, values in known.items() if name in names}
    # Of sampled inputs the last one acts where the next one will within the period.
    body = [k for k, signal in enumerate(model.states) if not signal.name.endswith("_ago")]
    if model.b[body].any() and not any(f"torque{axis}_2_ago" in names for axis in axes):
        for k, axis in enumerate(axes):
            if f"torque{axis}_1_ago" in names and f"torque{axis}" not in known:
                known[f"torque{axis}_1_ago"] = torque[..., k] if axes[0] else torque
    return known


def _without_back_emf(simulator: Simulator | Simulators) -> Values:
    """The torque of the actuator; the back-EMF of a wheel is in the matrices of the model."""
    state = simulator.state
    actuator: Any = simulator.scenario.to_dict()["actuator"]
    kind, wheel = ("", {}) if isinstance(actuator, list) else kind_of(actuator)
    if kind != "wheel":
        return state["torque"]
    given: Values = state["torque"] + wheel["back_emf"] * state[wheel["opposes"].replace("body_", "")]
    return given


def _hub_rotations(simulator: Simulator | Simulators) -> Values:
    """Rotation of the hub by each mode (rad/(m sqrt(kg))), of shape (modes, 3), or (copies, modes, 3)."""
    scenario = simulator.scenario
    uncertain: Any = scenario.to_dict().get("uncertain", {})
    of_body = ("spacecraft", "appendage", "actuator", "wheel")
    runs = getattr(simulator, "runs", None)
    if runs is not None and any(key.startswith(of_body) for key in uncertain):
        return np.stack([_of_modes(scenario.draw(int(run))) for run in runs])
    return _of_modes(scenario)


def _of_modes(scenario: Scenario) -> Values:
    keys = scenario.to_dict()
    if "spacecraft" not in keys:
        # Modes of a `[body.spatial]` do not turn it.
        return np.zeros((scenario._native.mode_count, 3))
    hub = [point["name"] for point in keys["spacecraft"].get("points", [])] or ["hub"]
    # The angles at a sensor on the hub are rigid angles and these rotations.
    path, sensor = _first_sensor(keys["sensor"])
    if path and sensor.get("point", hub[0]) not in hub:
        scenario = scenario.with_(f"{path}.point", hub[0])
    model = scenario.linearise().select(outputs=AXES)
    displacements = [state.name.endswith("_displacement") for state in model.states]
    # The rotation about each axis by each mode, at the first sensor.
    return model.c[:, displacements].T


def _first_sensor(sensors: Any) -> tuple[str, dict[str, Any]]:
    """The path of the first sensor and its keys; no path for a sensor without keys."""
    many = isinstance(sensors, list)
    first = sensors[0] if many else sensors
    if isinstance(first, str):
        return "", {}
    kind, keys = kind_of(first)
    return f"sensor[0].{kind}" if many else f"sensor.{kind}", keys
