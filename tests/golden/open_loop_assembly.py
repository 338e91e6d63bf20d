"""Open loops of scenarios assembled with NumPy and SciPy, and margins by bisection.

The keys of a scenario are read again, and laws, sensors, filters and actuators become blocks of a linear loop
here; the body, the coefficients of filters and the settled gains of estimators are the engine's, which other
references check. `open_loop_reference.py` writes golden numbers from it, and tests/python/test_open_loop.py
compares all shipped loops with it.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import floor, lcm, pi
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from flexsc import Linear, Scenario, Signal
from flexsc import _native as engine
from scipy.linalg import expm

Array = npt.NDArray[np.float64]
AXES = ("roll", "pitch", "yaw")
# Times are whole numbers of femtoseconds, as in a run.
_TICKS = 1e15
# With more samples of the law in one period of the whole loop, a model is of little use.
_MOST = 100
# Factors beyond this, or below its inverse, are as good as none.
_LARGEST = 1e4
# Growth (1/s) below which a motion is steady, and the rounding of poles over a period.
_STEADY, _ROUNDING = 1e-8, 1e-11


def open_loop(scenario: Scenario, loop: str, delay: float | None = None) -> Linear:
    """Return the open loop of a scenario at a break."""
    keys = scenario.to_dict()
    late = _delay(scenario.name, keys["actuator"]) if delay is None else delay
    return _loop(scenario, keys, scenario.linearise(), late, loop)


def _loop(scenario: Scenario, keys: Mapping[str, Any], body: Linear, delay: float, loop: str) -> Linear:
    """The loop transfer at a break, with the sign of negative feedback: closed it is a - b c."""
    name = scenario.name
    if loop not in ("command", "torque", "measurement"):
        raise ValueError(f"loop must be 'command', 'torque' or 'measurement', got {loop!r}")
    count = len(body.inputs)
    prefixes = [""] if count == 1 else [f"{axis}_" for axis in AXES]
    gain = _gain(name, keys["actuator"], count)
    parts = json.loads(engine.analysis("loop_parts", scenario._native, {})[0])
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
    unit = body.inputs[0].unit if gain == 1.0 else f"{body.inputs[0].unit}/{gain:g}".replace("e-0", "e-")
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


def _acting(plant: Linear, order: int, count: int, period: float, delay: float) -> tuple[Array, Array]:
    """The mean of each input over the coming period, by the states of a sampled plant and by its inputs."""
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


@dataclass
class Block:
    """x[k+1] = a x + b u, y = c x + d u, and the names of its states."""

    a: Array
    b: Array
    c: Array
    d: Array
    states: list[Signal]

    def then(self, after: Block) -> Block:
        """This block and one that takes what it gives."""
        none = np.zeros((len(self.a), len(after.a)))
        return Block(
            np.block([[self.a, none], [after.b @ self.c, after.a]]),
            np.vstack([self.b, after.b @ self.d]),
            np.hstack([after.d @ self.c, after.c]),
            after.d @ self.d,
            self.states + after.states,
        )

    @classmethod
    def beside(cls, blocks: Sequence[Block]) -> Block:
        """Blocks that know nothing of each other."""
        a, b, c, d = (_diagonal([getattr(block, name) for block in blocks]) for name in "abcd")
        return cls(a, b, c, d, [state for block in blocks for state in block.states])

    @classmethod
    def gain(cls, d: Array) -> Block:
        """A block without states."""
        return cls(np.zeros((0, 0)), np.zeros((0, d.shape[1])), np.zeros((len(d), 0)), d, [])


def kind_of(part: str | Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return the kind of a part and its keys: a part without keys is a word."""
    return (part, {}) if isinstance(part, str) else next(iter(part.items()))


def refused(name: str, why: str) -> ValueError:
    """The error of a loop that is not linear."""
    return ValueError(f"{name}: {why}")


@dataclass
class LinearLaw:
    """A law about one axis or about three, from angles and rates, axis by axis, to its commands."""

    period: float
    block: Block
    is_acceleration: bool
    inertia: Any
    """The inertia tensor in its model, if it has its own."""


def law_about(
    name: str, keys: Mapping[str, Any], filters: Sequence[Any], axis: int, prefix: str
) -> LinearLaw:
    """Return the law about an axis; `filters` are the coefficients of its filters."""
    law = keys["law"]
    if "per_axis" in law:
        law = law["per_axis"][AXES[axis]]
    kind, own = kind_of(law)
    if kind not in ("pd", "attitude", "state_space"):
        raise refused(name, f"the law `{kind}` is not linear: a loop has `pd`, `attitude` or `state_space`")
    if own.get("extra"):
        raise refused(name, "law.pd.extra is not supported in linear loops: leave it out")
    period = float(own["period"])
    if kind == "attitude":
        return LinearLaw(period, _attitude(own, period, filters, prefix), True, own.get("inertia"))
    if kind == "pd":
        k_p, k_d, way = float(own["k_p"]), float(own["k_d"]), own["differentiation"]
        if way == "exact":
            return LinearLaw(period, Block.gain(-np.array([[k_p, k_d]])), False, None)
        k_d = k_d / period if way == "difference" else k_d
        before = [Signal(f"{prefix}law_last_angle", "rad")]
        a, b = np.zeros((1, 1)), np.array([[1.0, 0.0]])
        block = Block(a, b, np.array([[k_d]]), -np.array([[k_p + k_d, 0.0]]), before)
        return LinearLaw(period, block, False, None)
    is_acceleration = own.get("command", "torque") == "acceleration"
    return LinearLaw(period, _state_space(own, period, prefix, 1, 2), is_acceleration, None)


def law_about_three_axes(name: str, keys: Mapping[str, Any]) -> LinearLaw | None:
    """Return the law about three axes together, if the scenario has one."""
    kind, own = kind_of(keys["law"])
    if kind != "state_space" or not own.get("inputs"):
        return None
    inputs, outputs = own["inputs"], own.get("outputs") or list(AXES)
    # What an angle or a rate is in the inputs.
    read = np.zeros((len(inputs), 6))
    for row, each in enumerate(inputs):
        if each.startswith("wheel"):
            why = f"the input `{each}` of the law is no state of the body: a linear loop has angles and rates"
            raise refused(name, why)
        if each.startswith("quaternion_"):
            # The vector part is half the angle.
            read[row, 2 * "xyz".index(each[-1])] = 0.5
        else:
            axis, _, of_rate = each.partition("_")
            read[row, 2 * AXES.index(axis) + bool(of_rate)] = 1.0
    period = float(own["period"])
    block = _state_space(own, period, "", len(outputs), len(inputs))
    written = np.zeros((3, len(outputs)))
    for column, axis in enumerate(outputs):
        written[AXES.index(axis), column] = 1.0
    block.b, block.d = block.b @ read, written @ block.d @ read
    block.c = written @ block.c
    return LinearLaw(period, block, own.get("command", "torque") == "acceleration", None)


def _attitude(own: Mapping[str, Any], period: float, filters: Sequence[Any], prefix: str) -> Block:
    """The law `attitude`: its integral, then its filters."""
    wn, damping = float(own["bandwidth"]), float(own["damping"])
    d = -np.array([[wn**2, 2.0 * damping * wn]])
    block = Block.gain(d)
    if own.get("integral"):
        c = np.array([[-(wn**2) / float(own["integral"]["time"])]])
        states = [Signal(f"{prefix}integral", "rad s")]
        block = Block(np.eye(1), np.array([[period, 0.0]]), c, d, states)
    for index, ((b0, b1, b2), (a1, a2)) in enumerate(filters):
        states = [Signal(f"{prefix}filter{index}_{k}", "rad/s²") for k in range(2)]
        a, b = np.array([[-a1, 1.0], [-a2, 0.0]]), np.array([[b1 - a1 * b0], [b2 - a2 * b0]])
        block = block.then(Block(a, b, np.array([[1.0, 0.0]]), np.array([[b0]]), states))
    return block


def _state_space(own: Mapping[str, Any], period: float, prefix: str, outputs: int, inputs: int) -> Block:
    """The law `state_space`, from its inputs; from angle and rate about one axis."""
    order = len(own.get("a", []))
    count = len((own.get("b") or own["d"])[0])
    b = np.array(own.get("b", []), dtype=np.float64).reshape(order, count)
    d = np.array(own.get("d") or [[0.0] * count] * outputs, dtype=np.float64)
    a = np.array(own.get("a", []), dtype=np.float64).reshape(order, order)
    c = np.array(own.get("c") or [[]] * outputs, dtype=np.float64).reshape(outputs, order)
    a, b, c, d = _at_samples(a, b, c, d, period, own.get("of", "samples"))
    c, d = float(own.get("gain", 1.0)) * c, float(own.get("gain", 1.0)) * d
    # e is what is wanted less what is believed; one input is the angle alone.
    wide = np.zeros((order, inputs)), np.zeros((outputs, inputs))
    wide[0][:, :count], wide[1][:, :count] = -b, -d
    return Block(a, wide[0], c, wide[1], [Signal(f"{prefix}law{k}", "") for k in range(order)])


def estimator(observers: Sequence[Mapping[str, Any]], prefixes: Sequence[str]) -> tuple[Block, Array]:
    """Return Kalman filters with their steady gains, from measured angles and rates to those that laws read,
    and what a torque about each axis, held over a period, adds to their states.

    The states are those that the filter expects before a sample.
    """
    blocks, pushes = [], []
    for filter_values, prefix in zip(observers, prefixes, strict=True):
        transition, push = np.array(filter_values["transition"]), np.array(filter_values["push"])
        order = len(push)
        seen = np.zeros((2, order))
        seen[0, 0::2] = seen[1, 1::2] = 1.0
        # After a sample the state is kept x + learnt y.
        kept, learnt = np.eye(order), np.zeros((order, 2))
        for row, gain in enumerate(np.array(filter_values["gains"])):
            learnt = learnt - np.outer(gain, seen[row] @ learnt)
            learnt[:, row] += gain
            kept = kept - np.outer(gain, seen[row] @ kept)
        read = seen if not filter_values["rigid"] else np.eye(2, order)
        names = ["rigid_angle", "rigid_rate"]
        names += [f"mode{k}_{what}" for k in range(order // 2 - 1) for what in ("displacement", "rate")]
        states = [
            Signal(f"{prefix}expected_{each}", "rad/s" if each.endswith("rate") else "rad") for each in names
        ]
        blocks.append(Block(transition @ kept, transition @ learnt, read @ kept, read @ learnt, states))
        pushes.append((push / float(filter_values["inertia"])).reshape(-1, 1))
    return Block.beside(blocks), _diagonal(pushes)


def _at_samples(
    a: Array,
    b: Array,
    c: Array,
    d: Array,
    h: float,
    of: str,
) -> tuple[Array, ...]:
    """Matrices as the law `state_space` samples them."""
    order = len(a)
    if of == "samples" or order == 0:
        return a, b, c, d
    if of == "held":
        return *held(a, b, h), c, d
    inverse = np.linalg.inv(np.eye(order) - 0.5 * h * a)
    c = c @ inverse
    return inverse @ (np.eye(order) + 0.5 * h * a), inverse @ b * h, c, d + c @ b * (0.5 * h)


def _diagonal(blocks: Sequence[Array]) -> Array:
    whole = np.zeros((sum(len(block) for block in blocks), sum(block.shape[1] for block in blocks)))
    row = column = 0
    for block in blocks:
        whole[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return whole


class Sampled(NamedTuple):
    """x[k+1] = a x[k] + b u[k], whose last states are the inputs of `waiting` samples, the latest first."""

    a: Array
    b: Array
    waiting: int


def whole_and_part(period: float, delay: float) -> tuple[int, float]:
    """Return the whole periods of a delay, and the rest (s)."""
    # A delay of whole periods is one, whatever its last bits.
    late = floor(delay / period + 1e-9)
    part = max(delay - late * period, 0.0)
    return late, part if part > 1e-9 * period else 0.0


def sampled(a: Array, b: Array, period: float, delay: float) -> Sampled:
    """Return x' = a x + b u at samples `period` (s) apart, with inputs that act `delay` (s) late."""
    order, count = b.shape
    late, part = whole_and_part(period, delay)
    flow, now = held(a, b, period)
    forced = [now]
    if part > 0.0:
        rest, new = held(a, b, period - part)
        forced = [new, rest @ held(a, b, part)[1]]
    waiting = late + len(forced) - 1
    size = order + count * waiting
    big, into = np.zeros((size, size)), np.zeros((size, count))
    big[:order, :order] = flow
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
    return Sampled(big, into, waiting)


def held(a: Array, b: Array, h: float) -> tuple[Array, Array]:
    """Return the motion over a time (s): of the state, and by inputs that are held."""
    order, count = b.shape
    whole = np.zeros((order + count, order + count))
    whole[:order, :order], whole[:order, order:] = a * h, b * h
    whole = expm(whole)
    return whole[:order, :order], whole[:order, order:]


@dataclass
class _Sensor:
    """Period and latency (ticks); the angle and rate of its mount, as rows over the states of the body."""

    period: int
    latency: int
    integrates: bool
    angle: Array
    rate: Array

    @classmethod
    def from_parts(cls, parts: Mapping[str, Any], order: int) -> _Sensor:
        angle, rate = np.zeros((3, order)), np.zeros((3, order))
        angle[:, :3] = rate[:, 3:6] = np.eye(3)
        turned = np.array(parts["turned"], dtype=np.float64).reshape(-1, 3).T
        angle[:, 6::2], rate[:, 7::2] = turned, turned
        times = round(parts["period"] * _TICKS), round(parts["latency"] * _TICKS)
        return cls(*times, bool(parts["integrates"]), angle, rate)


class _Filter:
    """The filter: its numbers are rows over the states at the start of a period and the commands since."""

    def __init__(self, parts: Mapping[str, Any], order: int) -> None:
        self.gyro = _Sensor.from_parts(parts["gyro"], order)
        self.sensor = _Sensor.from_parts(parts["sensor"], order)
        self.gain = np.array(parts["gain"], dtype=np.float64)
        # Exposures that may still correct it, the newest first, and what they show beyond what is expected.
        count = (self.sensor.latency + self.gyro.period) // self.sensor.period + 2
        self.exposed = [-(k + 1) * self.sensor.period for k in range(count)]
        self.blocks: list[Array] = []

    def states(self) -> list[Signal]:
        """Names and units."""
        named = [
            ("expected_{}", "rad"),
            ("expected_{}_bias", "rad/s"),
            ("gyro_{}", "rad/s"),
            ("gyro_{}_angle", "rad"),
            *((f"exposure{k}_{{}}", "rad") for k in range(len(self.exposed))),
        ]
        return [Signal(name.format(axis), unit) for name, unit in named for axis in AXES]

    def start(self, rows: Array) -> None:
        """Begin with these rows."""
        self.angle, self.bias, self.rate, self.mount, *self.beyond = rows.reshape(-1, 3, rows.shape[1])

    def rows(self) -> list[Array]:
        """What is known now."""
        return [self.angle, self.bias, self.rate, self.mount, *self.beyond]

    def events(self, whole: int) -> set[int]:
        """The times at which it does something, up to `whole` (ticks)."""
        gyro, sensor = self.gyro.period, self.sensor.period
        exposed = range(self.exposed[-1], whole, sensor)
        return {*range(0, whole, gyro), *exposed, *(self._taken(each) for each in exposed)}

    def act(self, now: int, x: Array) -> None:
        """Do what is done at a time (ticks), at which the body's states are x."""
        reads = now % self.gyro.period == 0
        if reads:
            self._read(now, x)
        if now % self.sensor.period == 0:
            shown = self.sensor.angle @ x
            self.exposed = [now, *self.exposed[:-1]]
            self.beyond = [shown - self.angle if reads else shown, *self.beyond[:-1]]
        self._take(now, [each for each in self.exposed if each + self.sensor.latency == now])

    def estimates(self, now: int) -> tuple[Array, Array]:
        """Angle and rate that a law reads."""
        rate = self.rate - self.bias
        return self.angle + (now % self.gyro.period) / _TICKS * rate, rate

    def _covered(self, exposed: int) -> int:
        """The time of the gyro reading up to which the filter has to know what it expected at an exposure."""
        return -(-exposed // self.gyro.period) * self.gyro.period

    def _taken(self, exposed: int) -> int:
        return max(exposed + self.sensor.latency, self._covered(exposed))

    def _read(self, now: int, x: Array) -> None:
        period = self.gyro.period / _TICKS
        if self.gyro.integrates:
            mount = self.gyro.angle @ x
            self.rate, self.mount = (mount - self.mount) / period, mount
        else:
            self.rate = self.gyro.rate @ x
        turning = self.rate - self.bias
        for slot, each in enumerate(self.exposed):
            if each < now == self._covered(each):
                since = (each - now) / _TICKS + period
                self.beyond[slot] = self.beyond[slot] - (self.angle + since * turning)
        self.angle = self.angle + period * turning
        # Those that were reported before this reading waited for it.
        self._take(now, [each for each in self.exposed if each + self.sensor.latency < now])

    def _take(self, now: int, exposed: list[int]) -> None:
        last = now // self.gyro.period * self.gyro.period
        for each in (each for each in reversed(exposed) if self._taken(each) == now):
            slot = self.exposed.index(each)
            angle, bias = self.gain[:3] @ self.beyond[slot], self.gain[3:] @ self.beyond[slot]
            self.angle = self.angle + angle - (last - each) / _TICKS * bias
            self.bias = self.bias + bias
            for other, later in enumerate(self.exposed[:slot]):
                if self._covered(later) <= now:
                    self.beyond[other] = self.beyond[other] - (angle - (later - each) / _TICKS * bias)


def attitude_loop(
    name: str,
    body: Linear,
    law: Block,
    times: tuple[float, float],
    parts: Mapping[str, Any],
    loop: str,
) -> Linear:
    """Return the loop opened at the commands or torques, with the sign of negative feedback.

    Everything that happens in a period of the law is in the model, in the order of a run. A loop that repeats
    only after several periods of the law is modelled from one repetition to the next: its inputs and outputs
    are those of each sample in between.
    """
    order, memory = len(body.a), len(law.a)
    # The law's period and the delay.
    step, late = (round(time * _TICKS) for time in times)
    filtered = _Filter(parts, order)
    whole = lcm(step, filtered.gyro.period, filtered.sensor.period)
    samples = whole // step
    if samples > _MOST:
        why = (
            f"gyro, attitude sensor and law repeat together only after {whole / _TICKS:g} s, {samples} "
            f"samples of the law: a linear loop has at most {_MOST}"
        )
        raise refused(name, why)
    # Torques that act, and commands from the last one back to the one that acts next.
    waiting = late // step + 1
    torques = [
        Signal(s.name if k == 0 else f"{s.name}_{k}_ago", s.unit)
        for k in range(waiting + 1)
        for s in body.inputs
    ]
    states = [*body.states, *filtered.states(), *law.states, *torques]
    size = len(states)
    rows = np.eye(size, size + 3 * samples)
    ends = np.cumsum([order, size - order - memory - len(torques), memory])
    x, known, remembered, pushed = np.split(rows, ends)
    filtered.start(known)
    acting, *given = pushed.reshape(-1, 3, rows.shape[1])
    laws, acts = range(0, whole, step), range(late % step, whole, step)
    flows: dict[int, Array] = {}
    commands: list[Array] = []
    instants = sorted(at for at in {*filtered.events(whole), *laws, *acts, whole} if 0 <= at <= whole)
    for now, after in pairwise(instants):
        filtered.act(now, x)
        if now in laws:
            read = np.stack(filtered.estimates(now), axis=1).reshape(6, -1)
            commands.append(law.c @ remembered + law.d @ read)
            remembered = law.a @ remembered + law.b @ read
            first = size + 3 * (now // step)
            given = [np.eye(3, rows.shape[1], first), *given[:-1]]
        if now in acts:
            acting = given[-1]
        if after - now not in flows:
            both = np.zeros((order + 3, order + 3))
            both[:order] = np.hstack([body.a, body.b]) * ((after - now) / _TICKS)
            flows[after - now] = expm(both)[:order]
        x = flows[after - now] @ np.vstack([x, acting])
    end = np.vstack([x, *filtered.rows(), remembered, acting, *given])
    out = -np.vstack(commands)
    kept = _that_matter(end[:, :size], out[:, :size])
    numbers = [""] if samples == 1 else [f"_{k}" for k in range(samples)]
    signals = tuple(
        Signal(s.name.replace("torque", loop) + number, s.unit) for number in numbers for s in body.inputs
    )
    return Linear(
        end[np.ix_(kept, kept)],
        end[kept, size:],
        out[:, kept],
        out[:, size:],
        tuple(states[k] for k in kept),
        signals,
        signals,
        whole / _TICKS,
    )


def _that_matter(a: Array, c: Array) -> list[int]:
    """The states on which something depends: some are overwritten before they are read."""
    kept = list(range(len(a)))
    while True:
        still = [k for k in kept if a[kept, k].any() or c[:, k].any()]
        if len(still) == len(kept):
            return kept
        kept = still


def margins(opened: Linear, inputs: Sequence[str] | None) -> tuple[float, float, float]:
    """Return the factors below and above 1, and the phase (rad), up to which commands may be off together."""
    if opened.b.shape[1] != opened.c.shape[0]:
        raise ValueError("only an opened loop, with as many outputs as inputs, has margins")
    off = _chosen(opened, inputs)

    def poles(factor: complex) -> npt.NDArray[np.complex128]:
        back = np.linalg.inv(np.eye(len(off)) + opened.d * np.where(off, factor, 1.0))
        closed = opened.a - opened.b * np.where(off, factor, 1.0) @ back @ opened.c
        return np.linalg.eigvals(closed).astype(np.complex128)

    def beyond(factor: complex) -> float:
        found = poles(factor)
        return float(found.real.max() if opened.period is None else np.abs(found).max() - 1.0)

    # One limit in time, also for a loop without a period.
    steady = max(_STEADY * (opened.period or 1.0), _ROUNDING)
    nominal = beyond(1.0)
    if nominal > steady:
        raise ValueError(_unstable_text(poles(1.0), opened.period))
    # A pole that the loop leaves on the limit, such as an undamped mode, stays there.
    limit = -steady if nominal < -2.0 * steady else steady

    def unstable(factor: complex) -> bool:
        return beyond(factor) > limit

    down = _first(lambda power: unstable(10.0**-power), 4.0)
    up = _first(lambda power: unstable(10.0**power), np.log10(_LARGEST))
    turns = [_first(lambda phase, way=way: unstable(np.exp(1j * way * phase)), pi) for way in (1, -1)]  # type: ignore[misc]
    return (
        0.0 if down is None else float(10.0**-down),
        float("inf") if up is None else float(10.0**up),
        min((float(turn) for turn in turns if turn is not None), default=pi),
    )


def _unstable_text(poles: npt.NDArray[np.complex128], period: float | None) -> str:
    """The error of a loop that is not stable: its worst pole and the frequency of that pole."""
    if period is None:
        worst = poles[np.argmax(poles.real)]
        where = f"a pole at {worst.real:.5g} {worst.imag:+.5g}i rad/s"
    else:
        worst = poles[np.argmax(np.abs(poles))]
        frequency = abs(np.angle(worst)) / period
        where = f"the spectral radius {abs(worst):.5g}, of a pole at {frequency:.4g} rad/s"
    return f"the closed loop is not stable and has no margins: it has {where}"


def _chosen(opened: Linear, inputs: Sequence[str] | None) -> npt.NDArray[np.bool_]:
    """Which of the commands are off."""
    names = [signal.name for signal in opened.inputs]
    if inputs is None:
        return np.ones(len(names), dtype=np.bool_)
    numbered = [name.rstrip("0123456789").removesuffix("_") for name in names]
    for name in inputs:
        if name not in names and name not in numbered:
            raise KeyError(f"no command {name!r}; there are {', '.join(dict.fromkeys(numbered))}")
    return np.array(
        [name in inputs or number in inputs for name, number in zip(names, numbered, strict=True)]
    )


def _first(unstable: Callable[[float], bool], largest: float) -> float | None:
    """The last value below the first that is unstable, from 0 on; none if there is none."""
    stable = 0.0
    for value in np.linspace(0.0, largest, 401)[1:]:
        if unstable(value):
            beyond = float(value)
            while beyond - stable > 1e-12 * largest:
                middle = 0.5 * (stable + beyond)
                stable, beyond = (stable, middle) if unstable(middle) else (middle, beyond)
            return stable
        stable = float(value)
    return None
