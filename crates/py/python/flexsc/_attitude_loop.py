"""Loops with an attitude filter: gyro, attitude sensor and law, each with a period of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine
from flexsc._blocks import AXES, Block, refused
from flexsc._linear import Linear
from flexsc._signal import Signal

if TYPE_CHECKING:
    from flexsc._blocks import Matrix


# Times are whole numbers of femtoseconds, as in a run.
_TICKS = 1e15
# With more samples of the law in one period of the whole loop, a model is of little use.
_MOST = 100


@dataclass
class _Sensor:
    """Period and latency (ticks); the angle and rate of its mount, as rows over the states of the body."""

    period: int
    latency: int
    integrates: bool
    angle: Matrix
    rate: Matrix

    @classmethod
    def from_parts(cls, parts: Mapping[str, Any], order: int) -> _Sensor:
        import numpy as np

        angle, rate = np.zeros((3, order)), np.zeros((3, order))
        angle[:, :3] = rate[:, 3:6] = np.eye(3)
        turned = np.array(parts["turned"], dtype=np.float64).reshape(-1, 3).T
        angle[:, 6::2], rate[:, 7::2] = turned, turned
        times = round(parts["period"] * _TICKS), round(parts["latency"] * _TICKS)
        return cls(*times, bool(parts["integrates"]), angle, rate)


class _Filter:
    """The filter: its numbers are rows over the states at the start of a period and the commands since."""

    def __init__(self, parts: Mapping[str, Any], order: int) -> None:
        import numpy as np

        self.gyro = _Sensor.from_parts(parts["gyro"], order)
        self.sensor = _Sensor.from_parts(parts["sensor"], order)
        self.gain = np.array(parts["gain"], dtype=np.float64)
        # Exposures that may still correct it, the newest first, and what they show beyond what is expected.
        count = (self.sensor.latency + self.gyro.period) // self.sensor.period + 2
        self.exposed = [-(k + 1) * self.sensor.period for k in range(count)]
        self.blocks: list[Matrix] = []

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

    def start(self, rows: Matrix) -> None:
        """Begin with these rows."""
        self.angle, self.bias, self.rate, self.mount, *self.beyond = rows.reshape(-1, 3, rows.shape[1])

    def rows(self) -> list[Matrix]:
        """What is known now."""
        return [self.angle, self.bias, self.rate, self.mount, *self.beyond]

    def events(self, whole: int) -> set[int]:
        """The times at which it does something, up to `whole` (ticks)."""
        gyro, sensor = self.gyro.period, self.sensor.period
        exposed = range(self.exposed[-1], whole, sensor)
        return {*range(0, whole, gyro), *exposed, *(self._taken(each) for each in exposed)}

    def act(self, now: int, x: Matrix) -> None:
        """Do what is done at a time (ticks), at which the body's states are x."""
        reads = now % self.gyro.period == 0
        if reads:
            self._read(now, x)
        if now % self.sensor.period == 0:
            shown = self.sensor.angle @ x
            self.exposed = [now, *self.exposed[:-1]]
            self.beyond = [shown - self.angle if reads else shown, *self.beyond[:-1]]
        self._take(now, [each for each in self.exposed if each + self.sensor.latency == now])

    def estimates(self, now: int) -> tuple[Matrix, Matrix]:
        """Angle and rate that a law reads."""
        rate = self.rate - self.bias
        return self.angle + (now % self.gyro.period) / _TICKS * rate, rate

    def _covered(self, exposed: int) -> int:
        """The time of the gyro reading up to which the filter has to know what it expected at an exposure."""
        return -(-exposed // self.gyro.period) * self.gyro.period

    def _taken(self, exposed: int) -> int:
        return max(exposed + self.sensor.latency, self._covered(exposed))

    def _read(self, now: int, x: Matrix) -> None:
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
    loop: Literal["command", "torque"],
) -> Linear:
    """Return the loop opened at the commands or torques, with the sign of negative feedback.

    Everything that happens in a period of the law is in the model, in the order of a run. A loop that repeats
    only after several periods of the law is modelled from one repetition to the next: its inputs and outputs
    are those of each sample in between.
    """
    import numpy as np

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
    flows: dict[int, Matrix] = {}
    commands: list[Matrix] = []
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
            flows[after - now] = engine.exponential(both)[:order]
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


def _that_matter(a: Matrix, c: Matrix) -> list[int]:
    """The states on which something depends: some are overwritten before they are read."""
    kept = list(range(len(a)))
    while True:
        still = [k for k in kept if a[kept, k].any() or c[:, k].any()]
        if len(still) == len(kept):
            return kept
        kept = still
