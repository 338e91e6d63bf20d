"""Your own parts: a law, an estimator, a sensor, an actuator or an adaptation as a Python object.

A part is called only at events and samples; between them the motion is exact. `Scenario.with_parts` puts it
in place of a part of the scenario and combines it with parts of any other kind:

>>> import flexsc
>>> class Damper(flexsc.Law):
...     period = 0.25
...     def decide(self, event):
...         return flexsc.Hold(-4.0 * event.angle - 30.0 * event.rate)
>>> body = {"planar": {"inertia": 100.0, "angle": 1e-3}}
>>> scenario = flexsc.Scenario({"duration": 60.0, "law": {"open": {}}, "body": body})
>>> scenario.with_parts(law=Damper()).simulate().metrics["peak_torque_nm"]
0.004

Each run starts with copies of the objects, so that runs are repeatable. The method `copy` makes them, with
`copy.deepcopy` unless a class overrides it. An exception ends the run and leaves `simulate` as raised; in a
campaign it is the `error` of its row. Numbers are in SI units.
"""

from __future__ import annotations

import copy
import ctypes
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeVar

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
    ThreeAxisEvent,
    ThreeAxisHold,
    Truth,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

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
    "ThreeAxisEvent",
    "ThreeAxisHold",
    "ThreeAxisLaw",
    "Truth",
]

_Self = TypeVar("_Self", bound="_Part")


class _Part(ABC):  # noqa: B024
    """The common base of all parts; each role adds its methods."""

    signals: Mapping[str, str | tuple[str, int]] = MappingProxyType({})
    """Attributes that a full log has as columns, each with its unit, or with (unit, size) for a sequence.

    >>> class Sliding(Law):
    ...     period = 0.25
    ...     signals = {"s": "rad/s", "gains": ("N m s/rad", 2)}
    ...     s, gains = 0.0, (4.0, 30.0)
    ...     def decide(self, event):
    ...         self.s = event.rate + 0.1 * event.angle
    ...         return Hold(-self.gains[1] * self.s)
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_parts(law=Sliding())
    >>> list(scenario.with_("duration", 1.0).simulate(log="full")["own_law"])
    ['time_s', 'axis', 's', 'gains0', 'gains1']
    """

    def copy(self: _Self) -> _Self:
        """Make a part in the same state that shares nothing with this one, with `copy.deepcopy`."""
        return copy.deepcopy(self)


class Law(_Part):
    """A control law about one axis; on a three-axis body one copy acts about each axis.

    >>> class Weak(Law):
    ...     def decide(self, event):
    ...         return Hold(-1e-6 if event.angle > 0.0 else 1e-6, after=1.0)
    """

    period: float | None = None
    """Period (s) of the calls if a hold gives no time; None for a law whose holds all give one."""
    reads: Literal["nothing", "field", "motion", "dominant_mode", "elastic_rates"] = "motion"
    """The quantities that it reads from an estimator."""
    promise: float | None = None
    """The distance from the goal (rad) within which it keeps the angle, for the metrics; None without a
    promise."""
    switches: bool = False
    """Whether the torque changes only together with the state given by a hold, as for a relay."""
    tracks: bool = False
    """Whether it follows a manoeuvre while it lasts; otherwise its goal is the end of the manoeuvre."""
    tunable: Mapping[str, float] = MappingProxyType({})
    """The parameters that an adaptation may tune, by name, with their initial values."""

    def start(self, authority: Authority) -> None:
        """Start a run about the axis `authority.axis`."""

    @abstractmethod
    def decide(self, event: Event) -> Hold:
        """Return the command from now on and the conditions for the next call.

        Called at the start of the run, at the time given by the last hold, and when the angle passes one of
        its levels: at the exact instant with a continuous sensor, otherwise at the first sample beyond the
        level.
        """

    def tune(self, key: str, value: float) -> None:
        """Accept the new value of a parameter of `tunable` that an adaptation has changed."""


class ThreeAxisLaw(_Part):
    """A control law about three axes together.

    >>> class Coupled(ThreeAxisLaw):
    ...     period = 0.25
    ...     def decide(self, event):
    ...         return [-4.0 * angle - 60.0 * rate for angle, rate in zip(event.angles, event.rates)]
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_parts(law=Coupled())
    """

    period: float | None = None
    """Period (s) of the calls if a hold gives no time; None for a law whose holds all give one."""
    promise: float | None = None
    """The distance from the goal (rad) within which it keeps each angle, for the metrics; None without a
    promise."""
    tunable: Mapping[str, float] = MappingProxyType({})
    """The parameters that an adaptation may tune, by name, with their initial values."""

    def start(self, authorities: Sequence[Authority]) -> None:
        """Start a run; there is one authority for each axis."""

    @abstractmethod
    def decide(self, event: ThreeAxisEvent) -> ThreeAxisHold | Sequence[float] | npt.NDArray[np.float64]:
        """Return the torques (N m) about the body axes from now on, of shape (3,).

        `ThreeAxisHold` has accelerations or magnetic moments instead, or the time of the next call. The law
        is called at the start of the run, and at the time given by the last hold.
        """

    def tune(self, key: str, value: float) -> None:
        """Accept the new value of a parameter of `tunable` that an adaptation has changed."""


class CompiledLaw(Law):
    """A law given by a compiled function, such as a `cfunc` of numba or a C function, called without Python.

    The function takes nine arguments and returns nothing; all numbers are doubles:

        void law(double now, double since, double cause, double angle, double rate,
                 double goal_angle, double goal_rate, double *states, double *hold);

    `now` is the time (s), and `since` the time since the last call, rounded once. `cause` is 0 at the start,
    1 at the time given by the last hold, 2 when the angle is at least its level, and 3 when it is at most its
    level. `states` are the law's own values, kept from call to call. The function writes to `hold`: torque
    (N m), time until the next call (s), the levels `at_least` and `at_most` of the angle (rad) at which it is
    called, and its state for the log: 0 to 11 for OPEN, PD, W0, RACC, RBRK, W+, LACC, LBRK, W-, COAST, FIRE
    and BDOT. Each entry is NaN at the call; an entry left at NaN is not set.

    >>> import ctypes
    >>> kind = ctypes.CFUNCTYPE(None, *[ctypes.c_double] * 7, *[ctypes.POINTER(ctypes.c_double)] * 2)
    >>> @kind
    ... def damper(now, since, cause, angle, rate, goal_angle, goal_rate, states, hold):
    ...     hold[0] = -4.0 * (angle - goal_angle) - 30.0 * (rate - goal_rate)
    >>> CompiledLaw(damper, period=0.25).period
    0.25

    Args:
        function: A `cfunc` of numba, a function of `ctypes`, or an address. A wrong address crashes the
            process.
        period: Period (s) of the calls if a hold gives no time; None for a function that always gives one.
        states: Its states at the start of a run.
        promise: The distance from the goal (rad) within which it keeps the angle; None without a promise.
        switches: Whether its torque changes only together with its state, as for a relay.
    """

    address: int
    """The address of the function."""
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
        """Never called: the engine calls the compiled function instead."""
        raise NotImplementedError("a compiled law is called by its address")

    def copy(self) -> CompiledLaw:
        """Return the law itself: its states are copied for each run."""
        return self

    def __reduce__(self) -> tuple[object, ...]:
        raise TypeError("a compiled law is an address in this process and cannot be pickled")


class Estimator(_Part):
    """An estimator: at each sample it computes estimates about all axes from the measurements.

    >>> class Direct(Estimator):
    ...     def take(self, taken):
    ...         return taken.measured
    """

    def start(self, known: Known) -> None:
        """Start a run with the known data of the scenario."""

    @abstractmethod
    def take(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Process a sample.

        Returns:
            Angle (rad) and rate (rad/s) about each axis, of shape (axes, 2), with angles relative to the
            target. With displacement (rad), rate (rad/s) and frequency (rad/s) of the dominant mode appended,
            the shape is (axes, 5). None leaves the estimate unchanged.
        """

    def given(self, now: Instant, moments: tuple[float, float, float]) -> None:
        """Accept the reduced moments (rad/s²) about each axis that the actuator gives from now on."""

    def carry(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Propagate the estimate from the last sample to now, if a law decides between samples.

        `taken` has the time and the target, but no measurements. The return value is that of `take`. The
        method must not change the estimator.
        """
        return None

    def attitude(self, now: Instant) -> tuple[Any, ...] | None:
        """Return the attitude estimate after a sample, for the log `attitude_filter` and the metrics.

        Returns:
            The attitude now (w, x, y, z), the bias of the gyro (rad/s) of shape (3,), and the covariance of
            their errors, of shape (6, 6), in rad² and rad²/s²; arrays are accepted. After a sample that
            measured the attitude a fourth value may follow, for the NIS: the innovation, 3 angles (rad) or 2
            numbers of a direction, and its covariance; None after other samples. None for an estimator
            without them.
        """
        return None

    def shift(self, by: tuple[float, float, float]) -> None:
        """Accept a change of target: angles are now larger by `by` (rad) about each axis."""


class Sensor(_Part):
    """A sensor, which is read at samples.

    >>> class Encoder(Sensor):
    ...     period = 0.25
    ...     def read(self, truth):
    ...         return Reading(angle=round(truth.angle / 1e-6) * 1e-6)
    """

    period: float
    """Period of its samples (s)."""
    angle_noise: float = 0.0
    """Standard deviation of the measured angle (rad), as used by filters."""
    rate_noise: float | None = None
    """Standard deviation of the measured rate (rad/s); None for a sensor that does not measure the rate."""

    def start(self, axes: int, draws: Draws) -> None:
        """Start a run of a body with 1 or 3 axes; take noise from streams of `draws`, so that runs are
        repeatable."""

    @abstractmethod
    def read(self, truth: Truth) -> Reading | None:
        """Return a measurement; None if the sensor is silent."""


class Actuator(_Part):
    """An actuator, which converts the demands of laws into torques about all axes.

    >>> class Servo(Actuator):
    ...     limit = 0.05
    ...     def command(self, demanded):
    ...         return [max(-0.05, min(0.05, value)) for value in demanded.values]
    """

    limit: float | Sequence[float] | None = None
    """Largest torque about every axis (N m), or one value per axis; None without a limit."""

    def start(self, settings: Sequence[Setting]) -> None:
        """Start a run with the settings of each axis."""

    @abstractmethod
    def command(self, demanded: Demanded) -> Effort | Sequence[float]:
        """Return the torques (N m) about each axis from now on, of shape (axes,).

        `Effort(torques, after=s)` requests another call after `s` seconds, with the same demands.
        """


class Adaptation(_Part):
    """An adaptation: after each window it may change a parameter of the law.

    >>> class Descent(Adaptation):
    ...     tunes = "k_t"
    ...     def start(self, value, draws):
    ...         self.value = value
    ...     def learn(self, time, measured):
    ...         self.value += 1e-4
    ...         return self.value
    """

    tunes: str
    """The parameter, by its key within the law's table; of a law of your own, one of its `tunable`."""
    objective: str = "envelope_mean"
    """Quantity measured over each window, as `objective` of `[adaptation.random_search]`."""
    window: float | None = None
    """Length of the windows (s); None for `envelope_mean`, which has those of the `[estimator.envelope]`."""

    def start(self, value: float, draws: Draws) -> None:
        """Start a run with the initial value of the parameter."""

    @abstractmethod
    def learn(self, time: float, measured: float) -> float | None:
        """Process the objective, such as the mean envelope (rad), over the window that ends now (s).

        Returns:
            The new value of the parameter; None leaves it unchanged.
        """
