"""The body of a scenario as a linear model, and loops with linear parts cut open."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine
from flexsc._attitude_loop import attitude_loop
from flexsc._blocks import AXES, Block, estimator, kind_of, law_about, law_about_three_axes, refused
from flexsc._linear import Linear
from flexsc._sampling import whole_and_part
from flexsc._signal import Signal

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from flexsc._scenario import Scenario

Break = Literal["command", "torque", "measurement"]
"""The point at which a loop is opened."""


def linearise(
    scenario: Scenario, at: float, period: float | None, delay: float | None, loop: Break | None
) -> Linear:
    """Return the body of a scenario, or its open loop."""
    import numpy as np

    model = json.loads(engine.linear_json(scenario._native, at))
    a, b, c = (np.array(model[name], dtype=np.float64) for name in "abc")
    states, inputs, outputs = (
        tuple(Signal(**each) for each in model[kind]) for kind in ("states", "inputs", "outputs")
    )
    body = Linear(a, b.reshape(len(a), -1), c, np.zeros((len(c), b.shape[1])), states, inputs, outputs)
    keys = scenario.to_dict()
    late = _delay(scenario.name, keys["actuator"]) if delay is None else delay
    if loop is not None:
        if period is not None:
            raise ValueError("period must be left out where a loop is cut open: it is the law's own")
        return _loop(scenario, keys, body, late, loop)
    if period is None:
        if delay is not None:
            raise ValueError("delay needs a period")
        return body
    return body.sampled(period, late)


def _loop(scenario: Scenario, keys: Mapping[str, Any], body: Linear, delay: float, loop: Break) -> Linear:
    """The loop transfer at a break, with the sign of negative feedback: closed it is a - b c."""
    import numpy as np

    name = scenario.name
    if loop not in ("command", "torque", "measurement"):
        raise ValueError(f"loop must be 'command', 'torque' or 'measurement', got {loop!r}")
    count = len(body.inputs)
    prefixes = [""] if count == 1 else [f"{axis}_" for axis in AXES]
    gain = _gain(name, keys["actuator"], count)
    parts = json.loads(engine.loop_json(scenario._native))
    whole_law = law_about_three_axes(name, keys)
    laws = (
        [whole_law]
        if whole_law
        else [law_about(name, keys, parts["filters"][k], k, prefix) for k, prefix in enumerate(prefixes)]
    )
    period = laws[0].period
    if any(law.period != period for law in laws):
        raise refused(name, "the laws of the axes have different periods: a linear loop has one")
    if any(law.is_acceleration != laws[0].is_acceleration for law in laws):
        raise refused(
            name, "the laws of the axes command torques and accelerations: a linear loop has one kind"
        )
    # From angles and rates, axis by axis, to commands.
    law = Block.beside([law.block for law in laws])
    if laws[0].is_acceleration:
        # Rigid rates for a unit of torque: the inertia is their inverse.
        first = 1 if count == 1 else 3
        inertia = np.linalg.inv(body.b[first : first + count])
        own = laws[0].inertia
        inertia = inertia if own is None else np.array(own, dtype=np.float64)
        law.c, law.d = inertia @ law.c, inertia @ law.d
        if count == 3:
            # Accelerations become torques J a + w x (J w + h), and J times this block is the cross of h.
            own_inertia = np.linalg.inv(body.b[3:6])
            law.d[:, 1::2] -= own_inertia @ body.a[3:6, 3:6]
    if parts["attitude"]:
        if loop == "measurement":
            why = "an attitude filter reads gyro and attitude sensor: open its loop at `command` or `torque`"
            raise refused(name, why)
        return attitude_loop(name, body, law, (period, delay), parts["attitude"], loop)
    names = ["angle", "rate"] if count == 1 else [f"{axis}{what}" for axis in AXES for what in ("", "_rate")]
    plant = body.select(outputs=names).sampled(period, delay)
    seen = Block.gain(np.eye(2 * count))
    if _differs(name, keys, period):
        # Rates are differences of angles: the angles of the sample before are states.
        each: Any = np.eye(count)
        seen = Block(
            np.zeros((count, count)),
            np.kron(each, np.array([[1.0, 0.0]])),
            np.kron(each, np.array([[0.0], [-1.0 / period]])),
            np.kron(each, np.array([[1.0, 0.0], [1.0 / period, 0.0]])),
            [Signal(f"last_{name}", "rad") for name in names[::2]],
        )
    inner = seen
    pushed = np.zeros((len(seen.a), count))
    if parts["estimators"]:
        observer, push = estimator(parts["estimators"], prefixes)
        inner, pushed = seen.then(observer), np.vstack([pushed, push])
    inner = inner.then(law)
    pushed = np.vstack([pushed, np.zeros((len(law.a), count))])
    # What acts over the coming period: of torques that are late, those under way.
    by_state, by_input = _acting(plant, len(body.a), count, period, delay)
    inside, outside = len(plant.a), len(inner.a)
    scale = gain if loop != "torque" else 1.0
    torque, by_input = plant.b * scale, by_input * scale
    unit = body.inputs[0].unit if gain == 1.0 else f"{body.inputs[0].unit}/{gain:g}"
    known = pushed @ by_state
    if loop == "measurement":
        whole = np.block([[plant.a, torque @ inner.c], [known, inner.a + pushed @ by_input @ inner.c]])
        into = np.vstack([torque @ inner.d, inner.b + pushed @ by_input @ inner.d])
        out = np.hstack([plant.c, np.zeros((2 * count, outside))])
        signals = plant.outputs, plant.outputs
    else:
        whole = np.block([[plant.a, np.zeros((inside, outside))], [inner.b @ plant.c + known, inner.a]])
        into = np.vstack([torque, pushed @ by_input])
        out = np.hstack([inner.d @ plant.c, inner.c]) * (gain if loop == "torque" else 1.0)
        commands = tuple(Signal(s.name.replace("torque", "command"), unit) for s in body.inputs)
        of_break = commands if loop == "command" else body.inputs
        signals = of_break, of_break
    none = np.zeros((len(out), into.shape[1]))
    return Linear(whole, into, -out, none, plant.states + tuple(inner.states), *signals, period)


def _executing(actuators: Any) -> list[tuple[str, dict[str, Any], Mapping[str, Any]]]:
    """Return the kind, the keys and the entry of each actuator that executes commands."""
    entries = actuators if isinstance(actuators, list) else [actuators]
    tasks: list[Mapping[str, Any]] = [{} if isinstance(entry, str) else entry for entry in entries]
    return [
        (*kind_of(entry), task) for entry, task in zip(entries, tasks, strict=True) if "unloads" not in task
    ]


def _delay(name: str, actuators: Any) -> float:
    """Return the delay (s) of all actuators."""
    delays = {float(keys["delay"]) if kind == "wheel" else 0.0 for kind, keys, _ in _executing(actuators)}
    if len(delays) > 1:
        raise refused(name, f"the actuators have different delays, {sorted(delays)} s: give `delay`")
    return delays.pop()


def _gain(name: str, actuators: Any, count: int) -> float:
    """Return the torque for a unit of the command, of actuators whose shares make one linear actuator."""
    gains = [0.0] * count
    for kind, keys, task in _executing(actuators):
        if kind not in ("ideal", "wheel", "wheels"):
            why = f"the actuator `{kind}` is not linear: a loop has `ideal`, `wheel` or `wheels`"
            raise refused(name, why)
        share = float(task.get("share", 1.0)) * (float(keys["gain"]) if kind == "wheel" else 1.0)
        for axis, about in enumerate(AXES[:count]):
            gains[axis] += share if about in task.get("axes", AXES) else 0.0
    if max(gains) - min(gains) > 1e-12 * max(gains):
        raise refused(
            name, f"the actuators have different gains about the axes, {gains}: a linear loop has one"
        )
    return gains[0]


def _acting(
    plant: Linear, order: int, count: int, period: float, delay: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """The mean of each input over the coming period, by the states of a sampled plant and by its inputs."""
    import numpy as np

    late, part = whole_and_part(period, delay)
    by_state, by_input = np.zeros((count, len(plant.a))), np.zeros((count, count))
    for back, share in ((late, 1.0 - part / period), (late + 1, part / period)):
        if back == 0:
            by_input += share * np.eye(count)
        elif share > 0.0:
            at = order + count * (back - 1)
            by_state[:, at : at + count] += share * np.eye(count)
    return by_state, by_input


def _differs(name: str, keys: Mapping[str, Any], period: float) -> bool:
    """Whether rates are differences of measured angles."""
    sensor = keys["sensor"]
    if isinstance(sensor, list):
        # Others measure nothing of the motion.
        motion = [kind_of(each)[0] not in ("accelerometer", "tachometer") for each in sensor]
        if sum(motion) > 1 or not motion[0]:
            raise refused(name, "several sensors are not supported in linear loops: use one")
        sensor = sensor[0]
    kind, own = kind_of(sensor)
    if kind in ("continuous", "gyro"):
        return False
    if kind != "sampled":
        why = f"the sensor `{kind}` is not supported in linear loops: use `continuous`, `sampled` or `gyro`"
        raise refused(name, why)
    if float(own["period"]) != period:
        raise refused(name, "the sensor and the law have different periods: a linear loop has one")
    return own.get("rate_noise") is None
