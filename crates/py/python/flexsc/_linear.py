"""Linear models of a body at rest, sampled exactly, and of loops with a linear law; linear controllers as
laws."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from math import floor
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from flexsc._scenario import Scenario

Break = Literal["command", "torque", "measurement"]
"""The point at which a loop is opened."""

_AXES = ("roll", "pitch", "yaw")


@dataclass(frozen=True)
class Signal:
    """A state, input or output of a linear model: its name and its unit.

    >>> flexsc.Signal("angle", "rad").unit
    'rad'
    """

    name: str
    unit: str


@dataclass(frozen=True, eq=False)
class Linear:
    """A linear model: x' = a x + b u, y = c x + d u, or with a sampling period x[k+1] = a x[k] + b u[k].

    >>> model = flexsc.Scenario.example("relay-fixed").linearise()
    >>> model.a.shape, [state.name for state in model.states[:3]]
    ((6, 6), ['rigid_angle', 'rigid_rate', 'mode0_displacement'])
    """

    a: npt.NDArray[np.float64]
    """Shape (states, states)."""
    b: npt.NDArray[np.float64]
    """Shape (states, inputs)."""
    c: npt.NDArray[np.float64]
    """Shape (outputs, states)."""
    d: npt.NDArray[np.float64]
    """Shape (outputs, inputs)."""
    states: tuple[Signal, ...]
    """The names and units of the states."""
    inputs: tuple[Signal, ...]
    """The names and units of the inputs."""
    outputs: tuple[Signal, ...]
    """The names and units of the outputs."""
    period: float | None = None
    """Sampling period (s); None for continuous time."""

    def eigenfrequencies(self) -> npt.NDArray[np.float64]:
        """Return the natural frequencies |s| of the poles (rad/s), increasing; a pair of poles counts once.

        For a sampled model s = log(z)/period, below the Nyquist frequency. Rigid motion has the frequency 0.

        >>> flexsc.Scenario.example("relay-fixed").linearise().eigenfrequencies()
        array([0.   , 0.   , 0.44 , 0.755])
        """
        import numpy as np

        poles: Any = np.linalg.eigvals(self.a).astype(np.complex128)
        if self.period is not None:
            # What was a state for one period alone has no frequency.
            poles = np.log(poles[np.abs(poles) > 1e-12]) / self.period
        upper = poles[poles.imag >= 0.0]
        # Two rigid poles come out of rounding as a pair near 0.
        found = np.where(np.abs(upper) < 1e-7 * max(1.0, np.abs(upper).max(initial=0.0)), 0.0, np.abs(upper))
        missing = self._rigid() - int(np.count_nonzero(found == 0.0))
        return np.sort(np.concatenate([found, np.zeros(max(missing, 0))]))

    def _rigid(self) -> int:
        """The number of poles at rest."""
        import numpy as np

        at_rest = self.a if self.period is None else self.a - np.eye(len(self.a))
        return 2 * (len(self.a) - int(np.linalg.matrix_rank(at_rest)))

    def select(self, inputs: Sequence[str] | None = None, outputs: Sequence[str] | None = None) -> Linear:
        """Return the model with only the named inputs and outputs.

        >>> flexsc.Scenario.example("relay-fixed").linearise().select(outputs=["angle"]).c.shape
        (1, 6)

        Raises:
            KeyError: There is no signal of this name.
        """

        def places(names: Sequence[str] | None, signals: tuple[Signal, ...]) -> list[int]:
            known = [signal.name for signal in signals]
            if names is None:
                return list(range(len(known)))
            for name in names:
                if name not in known:
                    raise KeyError(f"no signal {name!r}; there are {', '.join(known)}")
            return [known.index(name) for name in names]

        into, out = places(inputs, self.inputs), places(outputs, self.outputs)
        return Linear(
            self.a,
            self.b[:, into],
            self.c[out],
            self.d[out][:, into],
            self.states,
            tuple(self.inputs[k] for k in into),
            tuple(self.outputs[k] for k in out),
            self.period,
        )

    def sampled(self, period: float, delay: float = 0.0) -> Linear:
        """Return the exact model at samples `period` (s) apart: inputs are held and act `delay` (s) late.

        Inputs still in the delay are states, after the others.

        >>> flexsc.Scenario.example("relay-fixed").linearise().sampled(0.5, delay=0.7).a.shape
        (8, 8)

        Raises:
            ValueError: The model is sampled already, or a time is not accepted.
        """
        import numpy as np

        if self.period is not None:
            raise ValueError("a model that is sampled already cannot be sampled")
        if not (0.0 < period < np.inf and 0.0 <= delay < np.inf):
            raise ValueError(f"period must be positive and delay 0 or more, got {period} and {delay}")
        order, count = self.b.shape

        def held(h: float) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
            whole = np.zeros((order + count, order + count))
            whole[:order, :order], whole[:order, order:] = self.a * h, self.b * h
            whole = engine.exponential(whole)
            return whole[:order, :order], whole[:order, order:]

        # A delay of whole periods is one, whatever its last bits.
        late = floor(delay / period + 1e-9)
        part = max(delay - late * period, 0.0)
        a, now = held(period)
        forced = [now]
        if part > 1e-9 * period:
            rest, new = held(period - part)
            forced = [new, rest @ held(part)[1]]
        waiting = late + len(forced) - 1
        size = order + count * waiting
        big, into = np.zeros((size, size)), np.zeros((size, count))
        big[:order, :order] = a
        for k, column in enumerate(forced):
            back = late + k
            if back == 0:
                into[:order] = column
            else:
                at = order + count * (back - 1)
                big[:order, at : at + count] = column
        if waiting:
            into[order : order + count] = np.eye(count)
            for k in range(1, waiting):
                at = order + count * k
                big[at : at + count, at - count : at] = np.eye(count)
        c = np.hstack([self.c, np.zeros((len(self.c), size - order))])
        under_way = tuple(
            Signal(f"{signal.name}_{back + 1}_ago", signal.unit)
            for back in range(waiting)
            for signal in self.inputs
        )
        states = self.states + under_way
        return Linear(big, into, c, self.d, states, self.inputs, self.outputs, period)

    def closed(self) -> Linear:
        """Close the loop that `linearise(loop=...)` opened: the inputs are added at the break.

        >>> scenario = flexsc.Scenario.example("rotation-robust")
        >>> bool(abs(numpy.linalg.eigvals(scenario.linearise(loop="command").closed().a)).max() < 1.0)
        True
        """
        import numpy as np

        if self.b.shape[1] != self.c.shape[0] or self.d.any():
            raise ValueError("only a model with as many outputs as inputs and d = 0 can be closed as a loop")
        d = np.zeros_like(self.d)
        a = self.a - self.b @ self.c
        return Linear(a, self.b, self.c, d, self.states, self.inputs, self.outputs, self.period)

    def control(self) -> Any:
        """Return the model as a `control.StateSpace` of python-control, which must be installed.

        >>> flexsc.Scenario.example("relay-fixed").linearise().control().nstates  # doctest: +SKIP
        6
        """
        control = import_module("control")
        names = {
            kind: [signal.name for signal in signals]
            for kind, signals in (("states", self.states), ("inputs", self.inputs), ("outputs", self.outputs))
        }
        period = 0 if self.period is None else self.period
        return control.ss(self.a, self.b, self.c, self.d, period, remove_useless_states=False, **names)

    def __repr__(self) -> str:
        time = "continuous" if self.period is None else f"every {self.period:g} s"
        shape = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<flexsc.Linear {time}: {shape}>"


def linearise(
    scenario: Scenario, at: float, period: float | None, delay: float | None, loop: Break | None
) -> Linear:
    """Return the body of a scenario, or its open loop."""
    import numpy as np

    told = json.loads(engine.linear_json(scenario._native, at))
    a, b, c = (np.array(told[name], dtype=np.float64) for name in "abc")
    states, inputs, outputs = (
        tuple(Signal(**each) for each in told[kind]) for kind in ("states", "inputs", "outputs")
    )
    body = Linear(a, b.reshape(len(a), -1), c, np.zeros((len(c), b.shape[1])), states, inputs, outputs)
    keys = scenario.to_dict()
    kind, wheel = _kind(keys["actuator"])
    own = float(wheel["delay"]) if kind == "wheel" else 0.0
    late = own if delay is None else delay
    if loop is not None:
        if period is not None:
            raise ValueError("period must be left out where a loop is cut open: it is the law's")
        return _loop(scenario.name, keys, body, late, loop)
    if period is None:
        if delay is not None:
            raise ValueError("delay needs a period")
        return body
    return body.sampled(period, late)


def _kind(part: str | Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return the kind of a part and its keys: a part without keys is a word."""
    return (part, {}) if isinstance(part, str) else next(iter(part.items()))


def _refused(name: str, why: str) -> ValueError:
    return ValueError(f"{name}: {why}")


def _law(name: str, keys: Mapping[str, Any], axis: int) -> tuple[str, dict[str, Any]]:
    """Return the kind and the keys of the law about an axis."""
    law = keys["law"]
    if "per_axis" in law:
        law = law["per_axis"][_AXES[axis]]
    kind, own = _kind(law)
    if kind not in ("pd", "attitude", "state_space"):
        raise _refused(name, f"the law `{kind}` is not linear: a loop has `pd`, `attitude` or `state_space`")
    for key in ("extra", "filters", "integral"):
        if own.get(key):
            raise _refused(name, f"law.{kind}.{key} is not supported in linear loops: leave it out")
    return kind, own


def _feedback(kind: str, own: Mapping[str, Any]) -> tuple[float, list[npt.NDArray[np.float64]], bool]:
    """A law from (angle, rate) to what it commands: its period, a, b, c, d, and whether it is an
    acceleration."""
    import numpy as np

    period = float(own["period"])
    none = np.zeros((0, 0))
    if kind == "attitude":
        wn, damping = float(own["bandwidth"]), float(own["damping"])
        d = -np.array([[wn**2, 2.0 * damping * wn]])
        return period, [none, np.zeros((0, 2)), np.zeros((1, 0)), d], True
    if kind == "pd":
        k_p, k_d, way = float(own["k_p"]), float(own["k_d"]), own["differentiation"]
        if way == "exact":
            return period, [none, np.zeros((0, 2)), np.zeros((1, 0)), -np.array([[k_p, k_d]])], False
        k_d = k_d / period if way == "difference" else k_d
        # The state is the angle of the sample before.
        a, b = np.zeros((1, 1)), np.array([[1.0, 0.0]])
        return period, [a, b, np.array([[k_d]]), -np.array([[k_p + k_d, 0.0]])], False
    order = len(own.get("a", []))
    count = len((own.get("b") or own["d"])[0])
    b = np.array(own.get("b", []), dtype=np.float64).reshape(order, count)
    d = np.array(own.get("d") or [[0.0] * count], dtype=np.float64)
    a = np.array(own.get("a", []), dtype=np.float64).reshape(order, order)
    c = np.array(own.get("c", []), dtype=np.float64).reshape(1, order)
    a, b, c, d = _at_samples(a, b, c, d, period, own.get("of", "samples"))
    # e is what is wanted less what is believed; one input is the angle alone.
    wide = np.zeros((order, 2)), np.zeros((1, 2))
    wide[0][:, : b.shape[1]], wide[1][:, : d.shape[1]] = -b, -d
    return period, [a, wide[0], c, wide[1]], own.get("command", "torque") == "acceleration"


def _at_samples(
    a: npt.NDArray[np.float64],
    b: npt.NDArray[np.float64],
    c: npt.NDArray[np.float64],
    d: npt.NDArray[np.float64],
    h: float,
    of: str,
) -> tuple[npt.NDArray[np.float64], ...]:
    """Matrices as the law `state_space` samples them."""
    import numpy as np

    order, count = b.shape
    if of == "samples" or order == 0:
        return a, b, c, d
    if of == "held":
        whole = np.zeros((order + count, order + count))
        whole[:order, :order], whole[:order, order:] = a * h, b * h
        whole = engine.exponential(whole)
        return whole[:order, :order], whole[:order, order:], c, d
    inverse = np.linalg.inv(np.eye(order) - 0.5 * h * a)
    c = c @ inverse
    return inverse @ (np.eye(order) + 0.5 * h * a), inverse @ b * h, c, d + c @ b * (0.5 * h)


def _loop(name: str, keys: Mapping[str, Any], body: Linear, delay: float, loop: Break) -> Linear:
    """The loop transfer at a break, with the sign of negative feedback: closed it is a - b c."""
    import numpy as np

    if loop not in ("command", "torque", "measurement"):
        raise ValueError(f"loop must be 'command', 'torque' or 'measurement', got {loop!r}")
    if keys.get("estimator") and "envelope" not in keys["estimator"]:
        kind, _ = _kind(keys["estimator"])
        raise _refused(name, f"the estimator `{kind}` is not supported in linear loops: leave it out")
    kind_of_actuator, own_keys = _kind(keys["actuator"])
    if kind_of_actuator not in ("ideal", "wheel", "wheels"):
        why = f"the actuator `{kind_of_actuator}` is not linear: a loop has `ideal`, `wheel` or `wheels`"
        raise _refused(name, why)
    count = len(body.inputs)
    gain = float(own_keys["gain"]) if kind_of_actuator == "wheel" else 1.0
    laws = [_law(name, keys, axis) for axis in range(count)]
    parts = [_feedback(kind, own) for kind, own in laws]
    period = parts[0][0]
    if any(part[0] != period for part in parts):
        raise _refused(name, "the laws of the axes have different periods: a linear loop has one")
    if any(part[2] != parts[0][2] for part in parts):
        raise _refused(
            name, "the laws of the axes command torques and accelerations: a linear loop has one kind"
        )
    # From angles and rates, axis by axis, to commands.
    a, b, c, d = (_diagonal([part[1][k] for part in parts]) for k in range(4))
    if parts[0][2]:
        # Rigid rates for a unit of torque: the inertia is their inverse.
        first = 1 if count == 1 else 3
        inertia = np.linalg.inv(body.b[first : first + count])
        own = laws[0][1].get("inertia")
        inertia = inertia if own is None else np.array(own, dtype=np.float64)
        c, d = inertia @ c, inertia @ d
        if count == 3:
            # Accelerations become torques J a + w x (J w + h), and J times this block is the cross of h.
            own_inertia = np.linalg.inv(body.b[3:6])
            d[:, 1::2] -= own_inertia @ body.a[3:6, 3:6]
    names = ["angle", "rate"] if count == 1 else [f"{axis}{what}" for axis in _AXES for what in ("", "_rate")]
    plant = body.select(outputs=names).sampled(period, delay)
    states = [f"law{k}" for k in range(len(a))]
    differs, sensor = _differs(name, keys, period)
    seen_c: Any
    seen_b: Any
    seen_d: Any
    seen_c, seen_a, seen_b = np.eye(2 * count), np.zeros((0, 0)), np.zeros((0, 2 * count))
    seen_d = np.zeros((2 * count, 0))
    if differs:
        # Rates are differences of angles: the angles of the sample before are states.
        seen_a = np.zeros((count, count))
        seen_b = np.kron(np.eye(count), [[1.0, 0.0]])
        seen_d = np.kron(np.eye(count), [[0.0], [-1.0 / sensor]])
        seen_c = np.kron(np.eye(count), [[1.0, 0.0], [1.0 / sensor, 0.0]])
        states = [f"last_{name}" for name in names[::2]] + states
    # Sensor and law in a row: z = (seen, law).
    order = len(a)
    z_a = np.block([[seen_a, np.zeros((len(seen_a), order))], [b @ seen_d, a]])
    z_b = np.vstack([seen_b, b @ seen_c])
    z_c, z_d = np.hstack([d @ seen_d, c]), d @ seen_c
    inside, outside = len(plant.a), len(z_a)
    torque = plant.b * (gain if loop != "torque" else 1.0)
    law_states = tuple(Signal(each, "") for each in states)
    unit = body.inputs[0].unit if gain == 1.0 else f"{body.inputs[0].unit}/{gain:g}"
    if loop == "measurement":
        whole = np.block([[plant.a, torque @ z_c], [np.zeros((outside, inside)), z_a]])
        into = np.vstack([torque @ z_d, z_b])
        out = np.hstack([plant.c, np.zeros((2 * count, outside))])
        signals = plant.outputs, plant.outputs
    else:
        whole = np.block([[plant.a, np.zeros((inside, outside))], [z_b @ plant.c, z_a]])
        into = np.vstack([torque, np.zeros((outside, count))])
        out = np.hstack([z_d @ plant.c, z_c]) * (gain if loop == "torque" else 1.0)
        commands = tuple(Signal(s.name.replace("torque", "command"), unit) for s in body.inputs)
        each = commands if loop == "command" else body.inputs
        signals = each, each
    none = np.zeros((len(out), into.shape[1]))
    return Linear(whole, into, -out, none, plant.states + law_states, *signals, period)


def _differs(name: str, keys: Mapping[str, Any], period: float) -> tuple[bool, float]:
    """Whether rates are differences of measured angles, and over which period (s)."""
    sensor = keys["sensor"]
    if isinstance(sensor, list):
        if len(sensor) > 1:
            raise _refused(name, "several sensors are not supported in linear loops: use one")
        sensor = sensor[0]
    kind, own = _kind(sensor)
    if kind in ("continuous", "gyro"):
        return False, period
    if kind != "sampled":
        why = f"the sensor `{kind}` is no part of linear loops: take `continuous`, `sampled` or `gyro`"
        raise _refused(name, why)
    if float(own["period"]) != period:
        raise _refused(name, "the sensor and the law have different periods: a linear loop has one")
    return own.get("rate_noise") is None, period


def _diagonal(blocks: Sequence[npt.NDArray[np.float64]]) -> npt.NDArray[np.float64]:
    import numpy as np

    whole = np.zeros((sum(len(block) for block in blocks), sum(block.shape[1] for block in blocks)))
    row = column = 0
    for block in blocks:
        whole[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return whole


def law_of(
    controller: object,
    period: float | None,
    method: Literal["held", "tustin"],
    command: Literal["torque", "acceleration"],
    limit: float | None,
    track: bool,
) -> dict[str, Any]:
    """Return the keys of a law `state_space`, for one controller or for one per axis."""
    if isinstance(controller, Mapping):
        if set(controller) != set(_AXES):
            found = ", ".join(map(str, controller))
            raise ValueError(f"controllers must be given for {', '.join(_AXES)}, got {found}")
        each = {axis: law_of(controller[axis], period, method, command, limit, track) for axis in _AXES}
        return {"per_axis": each}
    a, b, c, d, step = _matrices(controller)
    if method not in ("held", "tustin"):
        raise ValueError(f"method must be 'held' or 'tustin', got {method!r}")
    if step is None and period is None:
        raise ValueError("a controller of continuous time, or of no period of its own, needs a period")
    if step is not None and period is not None and period != step:
        raise ValueError(f"period must be that of the controller, {step} s, or left out, got {period}")
    if d.shape[0] != 1:
        why = "one for each axis is given as a dict of 'roll', 'pitch' and 'yaw'"
        raise ValueError(f"a controller has one output, the command about its axis, got {d.shape[0]}: {why}")
    keys: dict[str, Any] = {
        "period": period if step is None else step,
        "of": "samples" if step is not None or _unspecified(controller) else method,
        "command": command,
        "d": d,
    }
    if len(a):
        keys |= {"a": a, "b": b, "c": c}
    if limit is not None:
        keys["limit"] = limit
    if track:
        keys["track"] = True
    return {"state_space": keys}


def _unspecified(controller: object) -> bool:
    """Whether it is in discrete time without a period: `dt=True` of python-control."""
    return getattr(controller, "dt", None) is True


def _matrices(controller: object) -> tuple[Any, Any, Any, Any, float | None]:
    """Return the matrices of a controller and its period; None for continuous time."""
    import numpy as np

    step: object = None
    if isinstance(controller, Linear):
        parts: Sequence[object] = (controller.a, controller.b, controller.c, controller.d)
        step = controller.period
    elif all(hasattr(controller, name) for name in "ABCD"):
        parts = [getattr(controller, name) for name in "ABCD"]
        step = getattr(controller, "dt", None)
    elif isinstance(controller, Sequence) and len(controller) == 4:
        parts = controller
    else:
        kind = type(controller).__name__
        what = "a controller is (A, B, C, D), or has A, B, C and D as control.StateSpace does"
        raise TypeError(f"{what}, got {kind}")
    a, b, c, d = (np.array(part, dtype=np.float64, ndmin=2) for part in parts)
    order = 0 if a.size == 0 else len(a)
    inputs = d.shape[1]
    a, b, c = a.reshape(order, order), b.reshape(order, inputs), c.reshape(len(d), order)
    is_period = isinstance(step, (int, float)) and not isinstance(step, bool) and step > 0.0
    return a, b, c, d, float(step) if is_period and isinstance(step, (int, float)) else None
