"""Parts of your own: a law, an estimator, a sensor, an actuator or an adaptation as an object of Python.

A part is asked at events and at samples alone; between them the motion is exact. `Scenario.with_parts` puts
it in the place of the scenario's own, beside all other kinds:

>>> import flexsc
>>> class Damper(flexsc.Law):
...     period = 0.25
...     def decide(self, event):
...         return flexsc.Hold(-4.0 * event.angle - 30.0 * event.rate)
>>> body = {"planar": {"inertia": 100.0, "angle": 1e-3}}
>>> scenario = flexsc.Scenario({"duration": 60.0, "law": {"open": {}}, "body": body})
>>> scenario.with_parts(law=Damper()).simulate().metrics["peak_torque_nm"]
0.004

Each run begins with copies of the objects, so that runs repeat: `copy` makes them, by `copy.deepcopy` unless
a class says otherwise. An exception ends the run, and comes out of `simulate` as it was raised; in a campaign
it is the `error` of its row. Numbers are in SI units.
"""

from __future__ import annotations

import copy
import ctypes
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Literal, TypeVar

from flexsc._native import (
    Authority,
    Demanded,
    Draws,
    Effort,
    Event,
    Hold,
    Instant,
    Known,
    Reading,
    Setting,
    Stream,
    Taken,
    Truth,
)

__all__ = [
    "Actuator",
    "Adaptation",
    "Authority",
    "CompiledLaw",
    "Demanded",
    "Draws",
    "Effort",
    "Estimator",
    "Event",
    "Hold",
    "Instant",
    "Known",
    "Law",
    "Reading",
    "Sensor",
    "Setting",
    "Stream",
    "Taken",
    "Truth",
]

_Self = TypeVar("_Self", bound="_Part")


class _Part(ABC):  # noqa: B024
    """What all parts have: roles have the methods."""

    def copy(self: _Self) -> _Self:
        """Make a part in the same state that shares nothing with this one: by `copy.deepcopy`."""
        return copy.deepcopy(self)


class Law(_Part):
    """A control law about one axis; on a body with three axes a copy acts about each.

    >>> class Weak(Law):
    ...     def decide(self, event):
    ...         return Hold(-1e-6 if event.angle > 0.0 else 1e-6, after=1.0)
    """

    period: float | None = None
    """Period (s) at which it is asked again if a hold names no time; None of a law that names them all."""
    reads: Literal["nothing", "field", "motion", "dominant_mode", "elastic_rates"] = "motion"
    """What it reads of an estimator."""
    promise: float | None = None
    """How near to the goal it promises to stay (rad), for the metrics; None if it promises nothing."""
    switches: bool = False
    """Whether the torque changes with the state that a hold names alone, as a relay's does."""
    tracks: bool = False
    """Whether it follows a manoeuvre while it lasts; else its goal is where the manoeuvre ends."""
    tunable: Mapping[str, float] = MappingProxyType({})
    """The numbers that an adaptation may tune, by name, with their values at the start."""

    def start(self, authority: Authority) -> None:
        """Begin a run about the axis `authority.axis`."""

    @abstractmethod
    def decide(self, event: Event) -> Hold:
        """Answer an event: the command from now on, and when to be asked again.

        Asked at the start of the run, at the time that the last hold named, and when the angle passes one of
        its levels: exactly then with a continuous sensor, else at the first sample beyond it.
        """

    def tune(self, key: str, value: float) -> None:
        """Take over a number of `tunable` that an adaptation has changed."""


class CompiledLaw(Law):
    """A law that is a compiled function, called without Python: what numba's `cfunc` or a C compiler makes.

    The function takes nine arguments and returns nothing; all numbers are doubles:

        void law(double now, double since, double cause, double angle, double rate,
                 double goal_angle, double goal_rate, double *states, double *hold);

    `now` is the time (s), `since` that since its last call, rounded once. `cause` is
    0 at the start, 1 at the time of the last hold, 2 and 3 when the angle is at least and at most its level.
    `states` are its own from call to call. It writes `hold`: torque (N m), time until it is asked again (s),
    the least and most angle (rad) at which it is asked, and its state for the log: 0 to 11 for OPEN, PD, W0,
    RACC, RBRK, W+, LACC, LBRK, W-, COAST, FIRE and BDOT. Those that it leaves NaN, as they come, are none.

    >>> import ctypes
    >>> kind = ctypes.CFUNCTYPE(None, *[ctypes.c_double] * 7, *[ctypes.POINTER(ctypes.c_double)] * 2)
    >>> @kind
    ... def damper(now, since, cause, angle, rate, goal_angle, goal_rate, states, hold):
    ...     hold[0] = -4.0 * (angle - goal_angle) - 30.0 * (rate - goal_rate)
    >>> CompiledLaw(damper, period=0.25).period
    0.25

    Args:
        function: A function of numba's `cfunc`, one of `ctypes`, or its address. A wrong address ends the
        process. period: Period (s) at which it is asked again if a hold has no time; None of a function that
        gives them all. states: Its states at the start of a run.
        promise: How near to the goal it promises to stay (rad); None if it promises nothing.
        switches: Whether its torque changes with its state alone, as a relay's does.
    """

    address: int
    """Where the function is."""
    states: tuple[float, ...]
    """Its states at the start of a run."""

    def __init__(
        self,
        function: object,
        *,
        period: float | None = None,
        states: Sequence[float] = (),
        promise: float | None = None,
        switches: bool = False,
    ) -> None:
        self._function = function
        if isinstance(function, int):
            self.address = function
        elif isinstance(address := getattr(function, "address", None), int):
            self.address = address
        else:
            self.address = ctypes.cast(function, ctypes.c_void_p).value or 0  # type: ignore[arg-type]
        self.period, self.states = period, tuple(float(state) for state in states)
        self.promise, self.switches = promise, switches

    def decide(self, event: Event) -> Hold:
        """The function decides: this is never called."""
        raise NotImplementedError("a compiled law is called by its address")

    def copy(self) -> CompiledLaw:
        """The law itself: its states are copied for each run."""
        return self

    def __reduce__(self) -> tuple[object, ...]:
        raise TypeError("a compiled law is a place in this process: it cannot be pickled")


class Estimator(_Part):
    """An estimator: at each sample it makes a belief of what was measured, about all axes together.

    >>> class Direct(Estimator):
    ...     def take(self, taken):
    ...         return taken.measured
    """

    def start(self, known: Known) -> None:
        """Begin a run, with what is known of the scenario."""

    @abstractmethod
    def take(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Take a sample.

        Returns:
            Angle (rad) and rate (rad/s) about each axis, of shape (axes, 2), angles beyond the target; with
            displacement (rad), rate (rad/s) and frequency (rad/s) of the dominant mode behind them, of shape
            (axes, 5). None leaves the belief as it is.
        """

    def given(self, now: Instant, moments: tuple[float, float, float]) -> None:
        """Take over the reduced moments (rad/s²) about each axis that the actuator gives from now on."""

    def carry(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Carry the belief on from the last sample to now, where a law is asked between samples.

        `taken` has the time and the target, and nothing that was measured. Returns what `take` does. It must
        not change the estimator.
        """
        return None

    def attitude(
        self, now: Instant
    ) -> tuple[Sequence[float], Sequence[float], Sequence[Sequence[float]]] | None:
        """What an attitude filter knows after a sample, for the log `attitude_filter` with errors and NEES.

        Returns:
            The attitude now (w, x, y, z), the bias of the gyro (rad/s) of shape (3,), and the covariance of
            their errors, of shape (6, 6), rad² and rad²/s²; arrays will do. None of an estimator without.
        """
        return None

    def shift(self, by: tuple[float, float, float]) -> None:
        """Take over that angles count from another target: by so much more (rad) about each axis."""


class Sensor(_Part):
    """A sensor: it is read at samples.

    >>> class Encoder(Sensor):
    ...     period = 0.25
    ...     def read(self, truth):
    ...         return Reading(angle=round(truth.angle / 1e-6) * 1e-6)
    """

    period: float
    """Period of its samples (s)."""
    angle_noise: float = 0.0
    """Standard deviation of the measured angle (rad), as filters take it to be."""
    rate_noise: float | None = None
    """The same of the measured rate (rad/s); None of a sensor that measures none."""

    def start(self, axes: int, draws: Draws) -> None:
        """Begin a run of a body with 1 or 3 axes; noise comes from streams of `draws`: runs repeat."""

    @abstractmethod
    def read(self, truth: Truth) -> Reading | None:
        """Read what there is to measure; None where the sensor is silent."""


class Actuator(_Part):
    """An actuator: it makes torques of what laws demand, about all axes together.

    >>> class Servo(Actuator):
    ...     limit = 0.05
    ...     def command(self, demanded):
    ...         return [max(-0.05, min(0.05, value)) for value in demanded.values]
    """

    limit: float | Sequence[float] | None = None
    """Largest torque about an axis (N m), or about each; None without a limit."""

    def start(self, settings: Sequence[Setting]) -> None:
        """Begin a run, with what is around it about each axis."""

    @abstractmethod
    def command(self, demanded: Demanded) -> Effort | Sequence[float]:
        """Answer demands: the torques (N m) about each axis from now on, of shape (axes,).

        `Effort(torques, after=s)` is asked again after `s` seconds, with the same demands.
        """


class Adaptation(_Part):
    """An adaptation: after each window of an `[estimator.envelope]` it may tune a number of the law.

    >>> class Descent(Adaptation):
    ...     tunes = "k_t"
    ...     def start(self, value, draws):
    ...         self.value = value
    ...     def learn(self, time, mean):
    ...         self.value += 1e-4
    ...         return self.value
    """

    tunes: str
    """The name of the number of the law: one of its `tunable`."""

    def start(self, value: float, draws: Draws) -> None:
        """Begin a run, with the number as the law has it."""

    @abstractmethod
    def learn(self, time: float, mean: float) -> float | None:
        """Learn the mean envelope (rad) of the window that ends now (s).

        Returns:
            The number from now on; None leaves it.
        """
