"""Parts written in Python that the tests bring: the relay law again, an attitude filter in NumPy, and small
ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
from flexsc.parts import Authority, Demanded, Draws, Event, Instant, Known, Setting, Stream, Taken, Truth
from scipy.linalg import expm

Array = npt.NDArray[np.float64]


class Relay(flexsc.Law):
    """The relay with dead zone, hysteresis and a timed brake ([Silaev], equation (2), corrected)."""

    switches = True

    def __init__(self, dead_zone: float, hysteresis: float, strong: float, weak: float, k_t: float) -> None:
        self.tunable = {"k_t": k_t}
        self.promise = dead_zone + hysteresis
        self.strong, self.k_t, self.dead_zone = strong, k_t, dead_zone
        self.state = "start"
        self.pushed = Instant(0, 0)
        back = dead_zone - hysteresis
        self.right = flexsc.Hold(-strong, at_most=back, state="RACC")
        self.left = flexsc.Hold(strong, at_least=-back, state="LACC")
        self.weak = {
            state: flexsc.Hold(torque, state=state, at_least=dead_zone, at_most=-dead_zone)
            for state, torque in [("W0", weak), ("W+", weak), ("W-", -weak)]
        }

    def decide(self, event: Event) -> flexsc.Hold:
        state = self.state
        if state == "RACC" or state == "LACC":
            brake = self.k_t * (event.now - self.pushed)
            right = state == "RACC"
            self.state = "RBRK" if right else "LBRK"
            return flexsc.Hold(self.strong if right else -self.strong, after=brake, state=self.state)
        if state == "RBRK" or state == "LBRK":
            self.state = "W+" if state == "RBRK" else "W-"
            return self.weak[self.state]
        if state == "start":
            if abs(event.angle) < self.dead_zone:
                self.state = "W0"
                return self.weak["W0"]
            right = event.angle > 0.0
        else:
            right = event.cause == "at_least"
        self.pushed = event.now
        self.state = "RACC" if right else "LACC"
        return self.right if right else self.left

    def tune(self, key: str, value: float) -> None:
        self.k_t = value

    @classmethod
    def of(cls, scenario: flexsc.Scenario) -> Relay:
        """The same as the scenario's law."""
        keys = scenario.to_dict()["law"]["relay"]
        return cls(*(keys[key] for key in ("dead_zone", "hysteresis", "strong", "weak", "k_t")))


class Notes:
    """What a part writes down: its copies share it."""

    def __init__(self) -> None:
        self.rows: list[tuple[Any, ...]] = []

    def __deepcopy__(self, memo: object) -> Notes:
        return self


class Pd(flexsc.Law):
    """A PD law that notes what it is asked with."""

    def __init__(self, period: float, k_p: float, k_d: float, notes: Notes) -> None:
        self.period, self.k_p, self.k_d, self.notes = period, k_p, k_d, notes

    def start(self, authority: Authority) -> None:
        self.axis = authority.axis

    def decide(self, event: Event) -> flexsc.Hold:
        self.notes.rows.append((event.time, self.axis, event.angle, event.rate))
        return flexsc.Hold(
            -self.k_p * (event.angle - event.goal_angle) - self.k_d * (event.rate - event.goal_rate)
        )


def cross(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def times(p: Array, q: Array) -> Array:
    """The product of two quaternions [w, x, y, z]."""
    return np.concatenate(
        [[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])]
    )


def turn(by: Array) -> Array:
    angle = float(np.linalg.norm(by))
    return np.concatenate([[np.cos(angle / 2)], by * (0.5 * np.sinc(angle / (2 * np.pi)))])


def beyond(goal: Array, q: Array) -> Array:
    off = times(goal * [1, -1, -1, -1], q)
    off = off * np.sign(off[0])
    half = float(np.arctan2(np.linalg.norm(off[1:]), off[0]))
    vector: Array = 2.0 * off[1:] / np.sinc(half / np.pi)
    return vector


class Mekf(flexsc.Estimator):
    """A multiplicative extended Kalman filter of attitude and gyro bias ([LeffertsMarkleyShuster82]).

    Attitudes arrive late: the filter keeps what it was at each gyro reading, and filters again from the
    exposure on. Transition and added noise are exponentials of matrices ([VanLoan78]).
    """

    def __init__(
        self, walks: tuple[float, float], initial: tuple[float, float], tracker: Array, late: float
    ) -> None:
        self.walks, self.initial, self.tracker, self.late = walks, initial, tracker, late

    def start(self, known: Known) -> None:
        assert known.axes == 3
        self.past: list[tuple[float, Array, Array | None, Array, Array, Array]] = []
        self.rate, self.since = np.zeros(3), 0.0
        self.told: tuple[Array, Array] | None = None
        # Off the truth by draws of the covariance at the start, as the engine's.
        draws = known.draws.stream("prior")
        self.off = np.array([[sd * draws.normal() for _ in range(3)] for sd in self.initial])

    def predict(
        self, state: tuple[Array, Array, Array], reading: Array, h: float
    ) -> tuple[Array, Array, Array]:
        q, bias, p = state
        rate = reading - bias
        white, walk = self.walks
        flow = np.zeros((6, 6))
        flow[:3, :3], flow[:3, 3:] = -cross(rate), -np.eye(3)
        noise = np.diag([white**2] * 3 + [walk**2] * 3)
        both = expm(np.block([[-flow, noise], [np.zeros((6, 6)), flow.T]]) * h)
        transition = both[6:, 6:].T
        p = transition @ p @ transition.T + transition @ both[:6, 6:]
        return times(q, turn(rate * h)), bias, 0.5 * (p + p.T)

    def correct(self, state: tuple[Array, Array, Array], seen: Array | None) -> tuple[Array, Array, Array]:
        if seen is None:
            return state
        q, bias, p = state
        spread, innovation = p[:3, :3] + self.tracker, beyond(q, seen)
        self.told = (innovation, spread)
        gain = p[:, :3] @ np.linalg.inv(spread)
        error = gain @ innovation
        q = times(q, turn(error[:3]))
        kept = np.eye(6)
        kept[:, :3] -= gain
        p = kept @ p @ kept.T + gain @ self.tracker @ gain.T
        return q / np.linalg.norm(q), bias + error[3:], 0.5 * (p + p.T)

    def take(self, taken: Taken) -> Sequence[Sequence[float]]:
        now = round(taken.time, 9)
        self.told = None
        if not self.past:
            half = 0.5 * np.array([angle for angle, _ in taken.truth])
            origin = np.array(taken.origin_attitude)
            q = times(origin, np.concatenate([[np.sqrt(1.0 - half @ half)], half]))
            p = np.diag([self.initial[0] ** 2] * 3 + [self.initial[1] ** 2] * 3)
            self.past = [(now, np.zeros(3), None, times(q, turn(self.off[0])), self.off[1], p)]
        gyro, tracker = taken.readings
        if gyro is not None:
            self.rate, self.since = np.array(gyro.rate), taken.time
            at, _, _, *state = self.past[-1]
            if now > at:
                ahead = self.predict((state[0], state[1], state[2]), self.rate, now - at)
                self.past = [*self.past[-20:], (now, self.rate, None, *ahead)]
        if tracker is not None:
            exposed = round(now - self.late, 9) if now > 0.0 else now
            place = [at for at, *_ in self.past].index(exposed)
            seen: Array | None = np.array(tracker.attitude)
            for k in range(place, len(self.past)):
                at, reading, measured, q, bias, p = self.past[k]
                state3 = (q, bias, p)
                if k > place:
                    before = self.past[k - 1]
                    state3 = self.predict((before[3], before[4], before[5]), reading, at - before[0])
                    seen = measured
                self.past[k] = (at, reading, seen, *self.correct(state3, seen))
        return self.believed(taken)

    def believed(self, taken: Taken) -> list[tuple[float, float]]:
        q, bias = self.past[-1][3:5]
        q = times(q, turn((self.rate - bias) * (taken.time - self.since)))
        angles = beyond(np.array(taken.origin_attitude), q)
        return list(zip(angles.tolist(), (self.rate - bias).tolist(), strict=True))

    def carry(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        return self.believed(taken)

    def attitude(self, now: Instant) -> tuple[Any, Any, Any, Any] | None:
        if not self.past:
            return None
        q, bias, p = self.past[-1][3:]
        return times(q, turn((self.rate - bias) * (now.seconds - self.since))), bias, p, self.told


class Encoder(flexsc.Sensor):
    """An angle in whole steps, or small rotations of an attitude, with noise."""

    def __init__(self, period: float, step: float, noise: float) -> None:
        self.period, self.step, self.angle_noise = period, step, noise

    def start(self, axes: int, draws: Draws) -> None:
        self.noise: list[Stream] = [draws.stream(f"encoder {axis}") for axis in range(axes)]

    def read(self, truth: Truth) -> flexsc.Reading:
        off = [self.angle_noise * stream.normal() for stream in self.noise]
        if truth.angle is not None:
            return flexsc.Reading(angle=round((truth.angle + off[0]) / self.step) * self.step)
        return flexsc.Reading(attitude=truth.attitude_at(off))


class AlphaBeta(flexsc.Estimator):
    """Angle and rate about each axis by constant gains."""

    def __init__(self, alpha: float, beta: float) -> None:
        self.alpha, self.beta = alpha, beta

    def start(self, known: Known) -> None:
        self.state: list[list[float]] = []
        self.last: Instant | None = None

    def take(self, taken: Taken) -> list[list[float]]:
        measured = taken.measured
        assert measured is not None
        if self.last is None:
            self.state = [list(pair) for pair in measured]
        else:
            h = taken.now - self.last
            for state, (angle, _) in zip(self.state, measured, strict=True):
                state[0] += h * state[1]
                off = angle - state[0]
                state[0] += self.alpha * off
                state[1] += self.beta * off / h
        self.last = taken.now
        return self.state


class Servo(flexsc.Actuator):
    """Torques in whole steps up to a limit, each a little later than demanded."""

    def __init__(self, limit: float, step: float, late: float) -> None:
        self.limit, self.step, self.late = limit, step, late

    def start(self, settings: Sequence[Setting]) -> None:
        self.given = [0.0] * len(settings)
        self.waiting: tuple[Instant, list[float]] | None = None

    def command(self, demanded: Demanded) -> flexsc.Effort | list[float]:
        if self.waiting is not None and demanded.now >= self.waiting[0]:
            self.given, self.waiting = self.waiting[1], None
            return self.given
        most = self.limit
        assert isinstance(most, float)
        wanted = [max(-most, min(most, round(value / self.step) * self.step)) for value in demanded.values]
        self.waiting = (demanded.now + self.late, wanted)
        return flexsc.Effort(self.given, after=self.late)


class Descent(flexsc.Adaptation):
    """Moves a gain on as long as the mean falls, and turns where it rises."""

    tunes = "k_t"

    def __init__(self, step: float) -> None:
        self.step = step

    def start(self, value: float, draws: Draws) -> None:
        self.value, self.last = value, float("inf")

    def learn(self, time: float, measured: float) -> float:
        if measured > self.last:
            self.step = -self.step
        self.last = measured
        self.value = min(0.4, max(0.28, self.value + self.step))
        return self.value
