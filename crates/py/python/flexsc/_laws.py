"""Laws written in Python, and compiled ones."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from flexsc._compiled import Compiled
from flexsc._numpy import np, npt
from flexsc._own_part import OwnPart

if TYPE_CHECKING:
    from flexsc._native import Authority, Event, Hold, ThreeAxisEvent, ThreeAxisHold


class Law(OwnPart):
    """A control law about one axis; on a three-axis body one copy acts about each axis.

    A class has the method `decide`, and as attributes, all of which may be left out, its `period` (s), what
    it `reads`, the distance that it can `promise` (rad), whether it `switches` or `tracks`, what is
    `tunable`, and its `signals` in the log.

    >>> class Weak(Law):
    ...     def decide(self, event):
    ...         return Hold(-1e-6 if event.angle > 0.0 else 1e-6, after=1.0)
    """

    period: float | str | None = None
    """Period (s, or a text such as "20 ms") of the calls if a hold gives no time; None for a law whose holds
    all give one.

    >>> class Damper(Law):
    ...     period = 0.25
    ...     def decide(self, event):
    ...         return Hold(-30.0 * event.rate)
    >>> Damper().period
    0.25
    """
    reads: Literal["nothing", "field", "motion", "dominant_mode", "elastic_rates"] = "motion"
    """The quantities that it reads from an estimator.

    >>> class Detumble(Law):
    ...     reads = "field"
    ...     def decide(self, event):
    ...         return Hold(moment=-1e6 * event.field_rate, after=0.5)     # A m²
    >>> Detumble.reads
    'field'
    """
    promise: float | None = None
    """The distance from the goal (rad) within which it keeps the angle, for the metrics; None without a
    promise.

    >>> class Keeper(Weak):
    ...     promise = 1e-3
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).with_parts(law=Keeper())
    >>> scenario.simulate().metrics["goal_band_rad"]
    0.001
    """
    switches: bool = False
    """Whether the torque changes only together with the state given by a hold, as for a relay.

    >>> class Pushing(Weak):
    ...     switches = True
    ...     def decide(self, event):
    ...         torque, state = (-1e-6, "W-") if event.angle > 0.0 else (1e-6, "W+")       # rad/s²
    ...         return Hold(torque, after=1.0, state=state)
    >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).with_parts(law=Pushing())
    >>> scenario.simulate()["command"]["state"][0].item()
    'W+'
    """
    tracks: bool = False
    """Whether it follows a manoeuvre while it lasts; otherwise its goal is the end of the manoeuvre.

    >>> class Following(Weak):
    ...     tracks = True
    >>> Following().tracks, Weak().tracks
    (True, False)
    """
    tunable: Mapping[str, float] = MappingProxyType({})
    """The parameters that an adaptation may tune, by name, with their initial values.

    >>> class Tuned(Weak):
    ...     tunable = {"strength": 1e-6}
    >>> Tuned().tunable["strength"]
    1e-06
    """

    def start(self, authority: Authority) -> None:
        """Start a run about the axis `authority.axis`.

        >>> class PerAxis(Weak):
        ...     def start(self, authority):
        ...         self.gain = (4.0, 6.0, 5.0)[authority.axis]                # N m/rad, about x, y and z
        ...     def decide(self, event):
        ...         return Hold(-self.gain * event.angle - 60.0 * event.rate, after=0.25)
        >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
        >>> run = scenario.with_parts(law=PerAxis()).simulate()
        """

    @abstractmethod
    def decide(self, event: Event) -> Hold | float:
        """Return the command from now on and the conditions for the next call.

        Called at the start of the run, at the time given by the last hold, and when the angle passes one of
        its levels: at the exact instant with a continuous sensor, otherwise at the first sample beyond the
        level.

        >>> class Bouncing(Law):
        ...     def decide(self, event):
        ...         if event.angle > 0.0:
        ...             return Hold(-4e-5, at_most=-4e-4)                      # rad/s², rad
        ...         return Hold(4e-5, at_least=4e-4)
        >>> scenario = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0)
        >>> run = scenario.with_parts(law=Bouncing()).simulate(log="full")
        >>> angle = run["attitude"]["angle_rad"]
        >>> round(angle.max().item(), 6), round(angle.min().item(), 6)         # rad
        (0.003645, -0.003237)
        """

    def tune(self, key: str, value: float) -> None:
        """Accept the new value of a parameter of `tunable` that an adaptation has changed.

        >>> class Tuned(Weak):
        ...     tunable = {"strength": 1e-6}
        ...     strength = 1e-6
        ...     def tune(self, key, value):
        ...         self.strength = value
        >>> law = Tuned()
        >>> law.tune("strength", 2e-6)
        >>> law.strength
        2e-06
        """


class ThreeAxisLaw(OwnPart):
    """A control law about three axes together.

    >>> class Coupled(ThreeAxisLaw):
    ...     period = 0.25
    ...     def decide(self, event):
    ...         return [-4.0 * angle - 60.0 * rate for angle, rate in zip(event.angles, event.rates)]
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_parts(law=Coupled())
    """

    period: float | str | None = None
    """Period (s, or a text such as "20 ms") of the calls if a hold gives no time; None for a law whose holds
    all give one.

    >>> Coupled().period
    0.25
    """
    promise: float | None = None
    """The distance from the goal (rad) within which it keeps each angle, for the metrics; None without a
    promise.

    >>> class Keeper(Coupled):
    ...     promise = 1e-3
    >>> Keeper().promise
    0.001
    """
    tunable: Mapping[str, float] = MappingProxyType({})
    """The parameters that an adaptation may tune, by name, with their initial values.

    >>> class Tuned(Coupled):
    ...     tunable = {"k_p": 4.0}
    >>> Tuned().tunable["k_p"]
    4.0
    """

    def start(self, authorities: Sequence[Authority]) -> None:
        """Start a run; there is one authority for each axis.

        >>> class Limited(Coupled):
        ...     def start(self, authorities):
        ...         self.limits = [authority.accelerations for authority in authorities]       # rad/s²
        >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
        >>> run = scenario.with_parts(law=Limited()).simulate()
        """

    @abstractmethod
    def decide(self, event: ThreeAxisEvent) -> ThreeAxisHold | Sequence[float] | npt.NDArray[np.float64]:
        """Return the torques (N m) about the body axes from now on, of shape (3,).

        `ThreeAxisHold` has accelerations or magnetic moments instead, or the time of the next call. The law
        is called at the start of the run, and at the time given by the last hold.

        >>> class Tracking(Coupled):
        ...     def decide(self, event):
        ...         error, rates = numpy.subtract(event.angles, event.goal_angles), numpy.array(event.rates)
        ...         return ThreeAxisHold(accelerations=-0.01 * error - 0.1 * rates, after=0.5)     # rad/s²
        >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
        >>> run = scenario.with_parts(law=Tracking()).simulate()
        """

    def tune(self, key: str, value: float) -> None:
        """Accept the new value of a parameter of `tunable` that an adaptation has changed.

        >>> class Tuned(Coupled):
        ...     tunable = {"k_p": 4.0}
        ...     def tune(self, key, value):
        ...         self.k_p = value
        >>> law = Tuned()
        >>> law.tune("k_p", 5.0)
        >>> law.k_p
        5.0
        """


class CompiledLaw(Compiled, Law):
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
        period: Period (s, or a text such as "20 ms") of the calls if a hold gives no time; None for a
            function that always gives one.
        states: Its states at the start of a run.
        promise: The distance from the goal (rad) within which it keeps the angle; None without a promise.
        switches: Whether its torque changes only together with its state, as for a relay.
    """

    def __init__(
        self,
        function: object,
        *,
        period: float | str | None = None,
        states: Sequence[float] = (),
        promise: float | None = None,
        switches: bool = False,
    ) -> None:
        self._keep(function, states)
        self.period = period
        self.promise, self.switches = promise, switches

    def decide(self, event: Event) -> Hold:
        """Never called: the engine calls the compiled function instead.

        >>> law = CompiledLaw(damper, period=0.25)
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0).with_parts(law=law)
        >>> scenario.simulate().metrics["peak_torque_nm"] > 0.0
        True
        """
        return self._never(event)


class CompiledThreeAxisLaw(Compiled, ThreeAxisLaw):
    """A law about three axes together, given by a compiled function, such as a `cfunc` of numba or a C
    function.

    The function takes five arguments and returns nothing; all numbers are doubles:

        void law(double now, double since, const double *input, double *states, double *hold);

    `now` is the time (s), and `since` the time since the last call. `input` has 18 numbers, three for each:
    angles (rad) and rates (rad/s) from the target to the estimate, the goals of the angles, of the rates and
    of the accelerations (rad/s²), and the rates of change of the magnetic field (T/s). `states` are its own
    values, kept from call to call. The function writes to `hold`: three commands, the time until the next
    call (s), and its state for the log, as `CompiledLaw`; the last two are NaN at the call, and an entry
    left at NaN is not set.

    >>> import ctypes
    >>> array = ctypes.POINTER(ctypes.c_double)
    >>> kind = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double, array, array, array)
    >>> @kind
    ... def coupled(now, since, motion, states, hold):
    ...     for axis in range(3):
    ...         hold[axis] = -0.01 * motion[axis] - 0.1 * (motion[3 + axis] - motion[9 + axis])
    >>> law = CompiledThreeAxisLaw(coupled, period=0.25, command="acceleration")
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(law=law).simulate()

    Args:
        function: A `cfunc` of numba, a function of `ctypes`, or an address. A wrong address crashes the
            process.
        period: Period (s, or a text such as "20 ms") of the calls if a hold gives no time; None for a
            function that always gives one.
        command: Whether its commands are torques (N m), accelerations (rad/s²) or magnetic moments (A m²).
        states: Its states at the start of a run.
        promise: The distance from the goal (rad) within which it keeps each angle; None without a promise.
    """

    command: Literal["torque", "acceleration", "moment"]
    """The quantity that it commands.

    >>> CompiledThreeAxisLaw(coupled, period=0.25).command
    'torque'
    """

    def __init__(
        self,
        function: object,
        *,
        period: float | str | None = None,
        command: Literal["torque", "acceleration", "moment"] = "torque",
        states: Sequence[float] = (),
        promise: float | None = None,
    ) -> None:
        self._keep(function, states)
        self.period, self.command, self.promise = period, command, promise

    def decide(self, event: ThreeAxisEvent) -> ThreeAxisHold:
        """Never called: the engine calls the compiled function instead.

        >>> CompiledThreeAxisLaw(coupled, period=0.25).decide(None)
        Traceback (most recent call last):
        NotImplementedError: a compiled part is called by its address
        """
        return self._never(event)
