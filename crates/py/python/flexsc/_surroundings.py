"""Disturbances and guidance written in Python, and compiled ones."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING

from flexsc._compiled import Compiled
from flexsc._numpy import np, npt
from flexsc._own_part import OwnPart

if TYPE_CHECKING:
    from flexsc._native import Aim, Draws, Load, Sky, Truth


class DisturbanceModel(OwnPart):
    """A disturbance, in addition to those of the scenario: torques and forces that depend on the time, the
    motion and the sky.

    >>> class Drag(DisturbanceModel):
    ...     period = 0.1
    ...     def act(self, truth):
    ...         return [-1e-3 * rate for rate in truth.rigid]                  # N m
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(disturbance=Drag()).simulate()
    """

    period: float | str | None = None
    """Period (s, or a text such as "20 ms") of the calls if a load gives no time; None for a disturbance
    whose loads all give one.

    >>> Drag().period
    0.1
    """
    points: Sequence[str] = ()
    """Names of the points of a three-axis body at which torques and forces act. Without any, the torque acts
    at the point of the actuators, and the force at the body's first point.

    >>> class Cooler(Drag):
    ...     points = ("hub",)
    >>> Cooler.points
    ('hub',)
    """

    def start(self, axes: int, draws: Draws) -> None:
        """Start a run of a body with 1 or 3 axes; take random numbers from streams of `draws`, so that runs
        are repeatable.

        >>> class Noise(Drag):
        ...     def start(self, axes, draws):
        ...         self.noise = draws.stream("cooler")
        ...     def act(self, truth):
        ...         return [1e-4 * self.noise.normal() for _ in range(3)]          # N m
        >>> run = scenario.with_parts(disturbance=Noise()).simulate()
        """

    @abstractmethod
    def act(self, truth: Truth) -> Load | Sequence[float] | npt.NDArray[np.float64]:
        """Return the torque (N m) in body axes from now on, of shape (3,), or (1,) of a body with one angle.

        `Load` has forces too, several points, or the time of the next call. The disturbance is called at the
        start of the run, and at the time given by the last load; between calls its loads are constant.

        >>> class Push(Drag):
        ...     def act(self, truth):
        ...         return flexsc.Load(force=[0.0, 1e-3, 0.0], after=0.5)          # N, s
        >>> run = scenario.with_parts(disturbance={0: Drag(), 1: Push()}).simulate()
        """


class Guidance(OwnPart):
    """A guidance in place of the targets of a three-axis body: its reference motion as a function of time.

    >>> from math import cos, sin
    >>> class Spin(Guidance):
    ...     def aim(self, sky):
    ...         half = 0.5e-3 * sky.time
    ...         return flexsc.Aim((cos(half), 0.0, 0.0, sin(half)), rate=(0.0, 0.0, 1e-3))     # rad/s
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(guidance=Spin()).simulate()
    """

    def start(self, draws: Draws) -> None:
        """Start a run; take random numbers from streams of `draws`.

        >>> class Uncertain(Spin):
        ...     def start(self, draws):
        ...         self.rate = 1e-3 * draws.stream("spin").uniform()              # rad/s
        >>> run = scenario.with_parts(guidance=Uncertain()).simulate()
        """

    @abstractmethod
    def aim(self, sky: Sky) -> Aim:
        """Return the attitude, the rate and the acceleration of the target at the instant of `sky`.

        The engine calls it at decisions, samples and rows, several times for one instant, so it must depend
        on the instant and on `start` alone. Rate and acceleration must be those of the attitude: laws take
        them for the feedforward.

        >>> class Still(Spin):
        ...     def aim(self, sky):
        ...         return flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0))
        >>> run = scenario.with_parts(guidance=Still()).simulate()
        """


class CompiledDisturbance(Compiled, DisturbanceModel):
    """A disturbance given by a compiled function, such as a `cfunc` of numba or a C function.

    The function takes five arguments and returns nothing; all numbers are doubles:

        void disturbance(double now, double since, const double *input, double *states, double *load);

    `now` is the time (s), and `since` the time since the last call. `input` has 22 numbers: the attitude (w,
    x, y, z), or the angle and three zeros; the rates at the first sensor and the rigid rates (rad/s); then
    position (m), velocity (m/s), direction to the Sun and magnetic field (T) in inertial axes, NaN where
    there are none. `states` are its own values, kept from call to call. The function writes to `load`: for
    each point a torque (N m) and a force (N) in body axes, then the time until the next call (s). All are 0
    at the call, and the time NaN, which stands for the period.

    >>> import ctypes
    >>> array = ctypes.POINTER(ctypes.c_double)
    >>> kind = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double, array, array, array)
    >>> @kind
    ... def drag(now, since, truth, states, load):
    ...     for axis in range(3):
    ...         load[axis] = -1e-3 * truth[7 + axis]
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(disturbance=CompiledDisturbance(drag, period=0.1)).simulate()

    Args:
        function: A `cfunc` of numba, a function of `ctypes`, or an address. A wrong address crashes the
            process.
        period: Period (s, or a text such as "20 ms") of the calls if a load gives no time; None for a
            function that always gives one.
        points: Names of the points at which it acts, as `DisturbanceModel.points`.
        states: Its states at the start of a run.
    """

    def __init__(
        self,
        function: object,
        *,
        period: float | str | None = None,
        points: Sequence[str] = (),
        states: Sequence[float] = (),
    ) -> None:
        self._keep(function, states)
        self.period, self.points = period, tuple(points)

    def act(self, truth: Truth) -> Load:
        """Never called: the engine calls the compiled function instead.

        >>> CompiledDisturbance(drag, period=0.1).act(None)
        Traceback (most recent call last):
        NotImplementedError: a compiled part is called by its address
        """
        return self._never(truth)


class CompiledGuidance(Compiled, Guidance):
    """A guidance given by a compiled function, such as a `cfunc` of numba or a C function.

    The function takes five arguments and returns nothing; all numbers are doubles:

        void guidance(double now, double since, const double *sky, double *constants, double *aim);

    `now` is the time (s), and `since` is 0. `sky` has 12 numbers: position (m), velocity (m/s), direction to
    the Sun and magnetic field (T) in inertial axes, NaN where there are none. `constants` are `states`, the
    same at each call. The function writes to `aim`: attitude (w, x, y, z), rate (rad/s), acceleration
    (rad/s²), which are 0 at the call.

    >>> import ctypes, math
    >>> array = ctypes.POINTER(ctypes.c_double)
    >>> kind = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double, array, array, array)
    >>> @kind
    ... def spin(now, since, sky, constants, aim):
    ...     half = 0.5 * constants[0] * now
    ...     aim[0], aim[3], aim[6] = math.cos(half), math.sin(half), constants[0]
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(guidance=CompiledGuidance(spin, states=[1e-3])).simulate()

    Args:
        function: A `cfunc` of numba, a function of `ctypes`, or an address. A wrong address crashes the
            process.
        states: Its constants.
    """

    def __init__(self, function: object, *, states: Sequence[float] = ()) -> None:
        self._keep(function, states)

    def aim(self, sky: Sky) -> Aim:
        """Never called: the engine calls the compiled function instead.

        >>> CompiledGuidance(spin).aim(None)
        Traceback (most recent call last):
        NotImplementedError: a compiled part is called by its address
        """
        return self._never(sky)
