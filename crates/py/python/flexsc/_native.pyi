"""The engine, as `flexsc` calls it. Not for users: what is here may change at any time."""

# By hand, and compared with the module by mypy.stubtest: PyO3 0.30 can write stubs (`experimental-inspect`),
# but leaves arrays of NumPy without a type.

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "Aim",
    "Authority",
    "Commands",
    "Demanded",
    "Design",
    "Directory",
    "Draws",
    "Effort",
    "Event",
    "ExportOptions",
    "Figure",
    "Hold",
    "Instant",
    "Known",
    "Load",
    "Log",
    "LogError",
    "MotionSampler",
    "Reading",
    "RunAnswer",
    "Scenario",
    "ScenarioError",
    "Setting",
    "SimulationError",
    "Simulator",
    "Simulators",
    "Sky",
    "Stream",
    "Taken",
    "ThreeAxisEvent",
    "ThreeAxisHold",
    "Truth",
    "Work",
    "__version__",
    "analysis",
    "answer_columns",
    "arrow_schema",
    "arrow_stream",
    "beside_parts",
    "campaign_answer",
    "campaign_figures",
    "campaign_statistics",
    "common_margins",
    "compare",
    "directory_figures",
    "examples",
    "export_fmu",
    "export_log",
    "export_run",
    "linearise",
    "log_answer",
    "log_figure",
    "log_figures",
    "log_of",
    "log_run",
    "main",
    "matrix_market",
    "modes_figure",
    "overlaid_figure",
    "parts_of",
    "persistence",
    "plan_torque",
    "sample_sizes",
    "sampled",
    "simulate",
    "table_ending",
    "text_beside_parts",
    "to_mcap",
    "with_parts",
    "write",
]

__version__: Final[str]

_Column: TypeAlias = (
    npt.NDArray[np.float64]
    | npt.NDArray[np.int64]
    | npt.NDArray[np.uint64]
    | list[str]
    | tuple[npt.NDArray[np.uint8], list[str]]
    | tuple[npt.NDArray[np.uint32], dict[str, _Column]]
)

_Matrices: TypeAlias = tuple[
    npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]
]

_Signals: TypeAlias = list[tuple[str, str]]

_Model: TypeAlias = tuple[_Matrices, tuple[_Signals, _Signals, _Signals], float | None]

_Summary: TypeAlias = tuple[str, str, int, float, float, list[tuple[float, float]]]

class ScenarioError(ValueError):
    """A scenario, or a key of it, that is not accepted. `mistakes` has a dictionary for each: `line` and
    `column` in the text and the path of the `key`, each None where there is none, the `message`, and as
    `suggestion` the key or the word that was probably meant, or None.

    >>> import flexsc
    >>> try:
    ...     flexsc.Scenario({"durations": 3.0})
    ... except flexsc.ScenarioError as error:
    ...     print(error.mistakes[0]["suggestion"])
    duration
    """

    mistakes: list[dict[str, Any]]
    """The mistakes, each with `line`, `column`, `key`, `message` and `suggestion`.

    >>> try:
    ...     flexsc.Scenario.example("relay-fixed").with_("law.relay.kt", 0.3)
    ... except flexsc.ScenarioError as error:
    ...     print(error.mistakes[0]["key"], error.mistakes[0]["suggestion"])
    law.relay.kt k_t
    """

class SimulationError(RuntimeError):
    """A simulation that cannot go on: its state is no longer finite, or its law switches without end.

    >>> import flexsc
    >>> far = flexsc.Scenario.example("relay-fixed").with_("body.planar.angle", 1e308)
    >>> try:
    ...     far.with_("body.planar.rate", 1e308).simulate()
    ... except flexsc.SimulationError as error:
    ...     print(str(error)[:42])
    relay-fixed: the state is no longer finite
    """

class LogError(OSError):
    """A log that cannot be read or written.

    >>> import flexsc
    >>> try:
    ...     flexsc.read_log("nowhere.mcap")
    ... except flexsc.LogError as error:
    ...     print("nowhere.mcap" in str(error))
    True
    """

@final
class Scenario:
    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scenario: ...
    @staticmethod
    def parse(text: str, name: str) -> Scenario: ...
    @staticmethod
    def from_values(text: str, name: str) -> Scenario: ...
    def with_keys(self, keys: Sequence[tuple[str, str]]) -> Scenario: ...
    def has_key(self, key: str) -> bool: ...
    def in_mode(self, name: str) -> Scenario: ...
    def draw(self, run: int) -> Scenario: ...
    @property
    def name(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def duration(self) -> float: ...
    @property
    def mode_count(self) -> int: ...
    @property
    def spatial(self) -> bool: ...
    @property
    def remarks(self) -> list[str]: ...
    def modes_json(self) -> str: ...
    def whirl_poles(self, speed: float | None) -> list[tuple[float, float]]: ...
    def to_toml(self) -> str: ...
    def to_json(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__ = None  # type: ignore[assignment]

_Three: TypeAlias = tuple[float, float, float]
_Four: TypeAlias = tuple[float, float, float, float]

@final
class Instant:
    """An instant of a run with femtosecond resolution: `Instant(whole, femtoseconds)`.

    >>> from flexsc.parts import Instant
    >>> Instant(20000, 1) - Instant(20000, 0)
    1e-15
    """

    def __new__(cls, whole: int, femtoseconds: int) -> Instant: ...
    @property
    def seconds(self) -> float:
        """The instant (s), rounded to a float.

        >>> from flexsc.parts import Instant
        >>> Instant(20, 500_000_000_000_000).seconds
        20.5
        """
    def __float__(self) -> float: ...
    def __sub__(self, earlier: Instant, /) -> float: ...
    def __rsub__(self, value: Instant, /) -> float: ...
    def __add__(self, seconds: float, /) -> Instant: ...
    def __radd__(self, value: float, /) -> Instant: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __lt__(self, other: Instant, /) -> bool: ...
    def __le__(self, other: Instant, /) -> bool: ...
    def __gt__(self, other: Instant, /) -> bool: ...
    def __ge__(self, other: Instant, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, tuple[int, int]]: ...
    def __deepcopy__(self, _memo: object) -> Instant: ...

@final
class Stream:
    """A stream of random numbers of a run, the same on every machine. A copy continues in the same way.

    >>> class Noisy(flexsc.Sensor):
    ...     period = 0.5
    ...     def start(self, axes, draws):
    ...         streams.append(draws.stream("noise"))
    ...     def read(self, truth):
    ...         return flexsc.Reading(angle=truth.angle + 1e-6 * streams[-1].normal())      # rad
    >>> streams = []
    >>> scenario = flexsc.Scenario.example("relay-sampled").without("uncertain").with_("duration", 1.0)
    >>> run = scenario.with_parts(sensor=Noisy()).simulate()
    >>> stream = streams[0]
    """

    def uniform(self) -> float:
        """A uniformly distributed number in [0, 1).

        >>> 0.0 <= stream.uniform() < 1.0
        True
        """
    def normal(self) -> float:
        """A normally distributed number with mean 0 and standard deviation 1.

        >>> numbers = [stream.normal() for _ in range(10_000)]
        >>> round(float(numpy.std(numbers)), 1)
        1.0
        """
    def __deepcopy__(self, _memo: object) -> Stream: ...

@final
class Draws:
    """The source of the random numbers of a run.

    >>> class Noisy(flexsc.Sensor):
    ...     period = 0.5
    ...     def start(self, axes, draws):
    ...         started.append(draws)
    ...     def read(self, truth):
    ...         return flexsc.Reading(angle=truth.angle)
    >>> started = []
    >>> scenario = flexsc.Scenario.example("relay-sampled").without("uncertain")
    >>> run = scenario.with_("duration", 1.0).with_parts(sensor=Noisy()).simulate(run=3)
    >>> draws = started[0]
    """

    @property
    def seed(self) -> int:
        """The scenario's seed.

        >>> draws.seed == scenario.seed
        True
        """
    @property
    def run(self) -> int:
        """The number of the run.

        >>> draws.run
        3
        """
    def stream(self, name: str) -> Stream:
        """The stream with this name. It is independent of streams with other names.

        >>> noise, drift = draws.stream("noise"), draws.stream("drift")
        >>> noise.normal() != drift.normal()
        True
        """
    def __deepcopy__(self, _memo: object) -> Draws: ...

@final
class Authority:
    """The authority of an actuator about an axis, as laws know it.

    >>> class Noting(flexsc.Law):
    ...     period = 1.0
    ...     def start(self, authority):
    ...         started.append(authority)
    ...     def decide(self, event):
    ...         return flexsc.Hold(0.0)
    >>> started = []
    >>> scenario = flexsc.Scenario.example("earth-observer").with_("duration", 1.0)
    >>> run = scenario.with_parts(law=Noting()).simulate()
    >>> authority = started[2]                                         # about z
    """

    @property
    def axis(self) -> int:
        """The axis: 0, or 0 to 2 for roll, pitch and yaw.

        >>> authority.axis
        2
        """
    @property
    def accelerations(self) -> tuple[float, float]:
        """The largest accelerations in the positive and negative direction (rad/s²); infinite without a
        limit.

        >>> [round(limit, 5) for limit in authority.accelerations]     # rad/s²
        [0.00084, 0.00084]
        """
    @property
    def delay(self) -> float:
        """Time from a command to its execution (s).

        >>> authority.delay                                                 # s
        0.0
        """
    def __deepcopy__(self, _memo: object) -> Authority: ...

@final
class Event:
    """The event at which a law is called, and its input. On three axes angles are relative to the target.

    >>> class Pd(flexsc.Law):
    ...     period = 0.25
    ...     def decide(self, event):
    ...         events.append(event)
    ...         error, rate = event.angle - event.goal_angle, event.rate - event.goal_rate
    ...         return flexsc.Hold(-20.0 * error - 200.0 * rate)           # N m
    >>> events = []
    >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 3.0)
    >>> run = scenario.with_parts(law=Pd()).simulate()
    >>> event = events[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `event.now - earlier` is the time between (s), without rounding before the
        difference.

        >>> event.now - events[-2].now                                      # s
        0.25
        """
    @property
    def time(self) -> float:
        """The instant in seconds.

        >>> event.time
        3.0
        """
    @property
    def cause(self) -> Literal["start", "timeout", "at_least", "at_most"]:
        """The start of the run, the time given by the last hold, or the level that the angle has passed.

        >>> events[0].cause, event.cause
        ('start', 'timeout')
        """
    @property
    def angle(self) -> float:
        """Angle (rad).

        >>> round(event.angle, 3)
        0.164
        """
    @property
    def rate(self) -> float:
        """Rate (rad/s).

        >>> round(event.rate, 3)
        0.145
        """
    @property
    def goal_angle(self) -> float:
        """The goal of the angle at this time (rad).

        >>> round(event.goal_angle, 4)                                      # a quarter of a turn
        1.5708
        """
    @property
    def goal_rate(self) -> float:
        """The goal of the rate (rad/s).

        >>> event.goal_rate
        0.0
        """
    @property
    def goal_acceleration(self) -> float:
        """The goal of the acceleration (rad/s²), for a target with a reference motion.

        >>> event.goal_acceleration
        0.0
        """
    @property
    def goal_from(self) -> Instant:
        """The instant from which the goal applies: the start, or the end of a manoeuvre.

        >>> event.goal_from.seconds                                         # the end of the manoeuvre
        12.0
        """
    @property
    def whole(self) -> float:
        """Magnitude of the vector of the angles about all axes (rad); 0 for a single-axis body.

        >>> event.whole
        0.0
        """
    @property
    def field_rate(self) -> float:
        """Rate of change of the magnetic field along the axis (T/s).

        >>> event.field_rate                                                # without a magnetic field
        0.0
        """
    @property
    def queued(self) -> float:
        """Change of the rate that is commanded but not yet executed (rad/s).

        >>> event.queued
        0.0
        """
    @property
    def dominant(self) -> _Three:
        """The dominant mode: displacement (rad), rate (rad/s) and frequency (rad/s).

        >>> displacement, rate, frequency = event.dominant
        >>> frequency                                                       # no estimator of modes
        0.0
        """
    @property
    def elastic(self) -> list[_Three]:
        """The elastic modes: rate (rad/s), frequency (rad/s) and its jump per jump of the rigid rate.

        >>> event.elastic                                                   # no estimator of modes
        []
        """
    @property
    def trusted(self) -> bool:
        """Whether the law may act on the elastic modes.

        >>> event.trusted
        False
        """

@final
class Hold:
    """A command from now on, and the conditions for the next call of the law.

    `Hold(torque)` holds a torque (N m; rad/s² for a body without inertia; for a wheel, units of its command).
    Use `acceleration` (rad/s²), `change` of the rigid rate (rad/s) or `moment` (A m²) instead of it. The next
    call follows `after` a time (s), at the instant `until`, or when the angle is `at_least` or `at_most` a
    level (rad), whichever is first; if no time is given, after the law's `period`. `state` is the name in the
    log.

    >>> import flexsc
    >>> flexsc.Hold(-4e-5, at_most=4e-4, state="RACC").at_most
    0.0004
    """

    def __new__(
        cls,
        torque: float | None = None,
        *,
        after: float | None = None,
        until: Instant | None = None,
        at_least: float | None = None,
        at_most: float | None = None,
        state: str = "PD",
        acceleration: float | None = None,
        change: float | None = None,
        moment: float | None = None,
    ) -> Hold: ...
    @property
    def torque(self) -> float | None:
        """Torque (N m; rad/s² for a body without inertia; for a wheel, units of its command), if it is
        commanded.

        >>> flexsc.Hold(0.05).torque                                        # N m
        0.05
        """
    @property
    def acceleration(self) -> float | None:
        """Acceleration (rad/s²), if it is commanded.

        >>> flexsc.Hold(acceleration=4e-5).acceleration                     # rad/s²
        4e-05
        """
    @property
    def change(self) -> float | None:
        """Change of the rigid rate (rad/s), if it is commanded.

        >>> flexsc.Hold(change=-2e-6, after=1.0).change                     # rad/s
        -2e-06
        """
    @property
    def moment(self) -> float | None:
        """Magnetic moment (A m²), if it is commanded.

        >>> flexsc.Hold(moment=15.0, after=0.5).moment                      # A m²
        15.0
        """
    @property
    def after(self) -> float | None:
        """Time to the next call (s), if it is given.

        >>> flexsc.Hold(0.05, after=0.5).after
        0.5
        """
    @property
    def until(self) -> Instant | None:
        """The instant of the next call, if it is given.

        >>> hold = flexsc.Hold(0.05, until=flexsc.parts.Instant(20, 0))
        >>> hold.until.seconds
        20.0
        """
    @property
    def at_least(self) -> float | None:
        """Angle (rad) from which on the law is called again, if it is given.

        >>> flexsc.Hold(4e-5, at_least=-4e-4).at_least
        -0.0004
        """
    @property
    def at_most(self) -> float | None:
        """Angle (rad) down to which the law is called again, if it is given.

        >>> flexsc.Hold(-4e-5, at_most=4e-4).at_most
        0.0004
        """
    @property
    def state(self) -> str:
        """State of the law in the log, such as `PD`.

        >>> flexsc.Hold(-4e-5, at_most=4e-4, state="RACC").state
        'RACC'
        """
    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, Any]]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __deepcopy__(self, _memo: object) -> Hold: ...

@final
class ThreeAxisEvent:
    """The input of a law about three axes at a call. Angles are relative to the target.

    >>> class Coupled(flexsc.ThreeAxisLaw):
    ...     period = 0.25
    ...     def decide(self, event):
    ...         events.append(event)
    ...         return [-4.0 * angle - 60.0 * rate for angle, rate in zip(event.angles, event.rates)]
    >>> events = []
    >>> scenario = flexsc.Scenario.example("earth-observer").with_("duration", 3.0)
    >>> run = scenario.with_parts(law=Coupled()).simulate()
    >>> event = events[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `event.now - earlier` is the time between (s), without rounding before the
        difference.

        >>> event.now - events[-2].now                                      # s
        0.25
        """
    @property
    def time(self) -> float:
        """The instant in seconds.

        >>> event.time
        3.0
        """
    @property
    def cause(self) -> Literal["start", "timeout"]:
        """The start of the run, or the time given by the last hold.

        >>> events[0].cause, event.cause
        ('start', 'timeout')
        """
    @property
    def angles(self) -> _Three:
        """Rotation vector from the target to the estimated attitude (rad), in body axes.

        >>> float(numpy.linalg.norm(event.angles)) < 1e-3
        True
        """
    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """Quaternion (w, x, y, z) of the same rotation.

        >>> round(2.0 * event.quaternion[3] / event.angles[2], 6)
        1.0
        """
    @property
    def rates(self) -> _Three:
        """Estimated rates (rad/s), in body axes.

        >>> len(event.rates)
        3
        """
    @property
    def goal_angles(self) -> _Three:
        """The goal of the angles (rad): 0, unless a target drifts.

        >>> event.goal_angles
        (0.0, 0.0, 0.0)
        """
    @property
    def goal_rates(self) -> _Three:
        """The goal of the rates (rad/s).

        >>> event.goal_rates
        (0.0, 0.0, 0.0)
        """
    @property
    def goal_accelerations(self) -> _Three:
        """The goal of the accelerations (rad/s²), for a target with a reference motion.

        >>> event.goal_accelerations
        (0.0, 0.0, 0.0)
        """
    @property
    def field_rates(self) -> _Three:
        """Rates of change of the magnetic field along the body axes (T/s).

        >>> event.field_rates                                               # without a magnetic field
        (0.0, 0.0, 0.0)
        """
    @property
    def wheel_speeds(self) -> list[float]:
        """Speeds of the reaction wheels (rad/s), as available to their drives.

        >>> [round(speed) for speed in event.wheel_speeds]
        [200, -200, 200, -200]
        """

@final
class ThreeAxisHold:
    """Commands about three axes from now on, and the time of the next call of the law.

    `ThreeAxisHold(torques)` holds torques (N m) of shape (3,). Use `accelerations` (rad/s²), which are
    multiplied by the inertia, or magnetic `moments` (A m²) instead of them. The next call follows `after` a
    time (s) or at the instant `until`; if no time is given, after the law's `period`. `state` is the name in
    the log.

    >>> import flexsc
    >>> flexsc.ThreeAxisHold([0.01, 0.0, -0.02], after=0.5).torques
    (0.01, 0.0, -0.02)
    """

    def __new__(
        cls,
        torques: Sequence[float] | npt.NDArray[np.float64] | None = None,
        *,
        accelerations: Sequence[float] | npt.NDArray[np.float64] | None = None,
        moments: Sequence[float] | npt.NDArray[np.float64] | None = None,
        after: float | None = None,
        until: Instant | None = None,
        state: str = "PD",
    ) -> ThreeAxisHold: ...
    @property
    def torques(self) -> _Three | None:
        """Torques about each axis (N m), if they are commanded.

        >>> flexsc.ThreeAxisHold([0.01, 0.0, -0.02]).torques
        (0.01, 0.0, -0.02)
        """
    @property
    def accelerations(self) -> _Three | None:
        """Accelerations about each axis (rad/s²), if they are commanded.

        >>> flexsc.ThreeAxisHold(accelerations=[1e-4, 0.0, 0.0]).accelerations
        (0.0001, 0.0, 0.0)
        """
    @property
    def moments(self) -> _Three | None:
        """Magnetic moments along each axis (A m²), if they are commanded.

        >>> flexsc.ThreeAxisHold(moments=[0.0, 15.0, 0.0]).moments
        (0.0, 15.0, 0.0)
        """
    @property
    def after(self) -> float | None:
        """Time to the next call (s), if it is given.

        >>> flexsc.ThreeAxisHold([0.01, 0.0, 0.0], after=0.5).after
        0.5
        """
    @property
    def until(self) -> Instant | None:
        """The instant of the next call, if it is given.

        >>> hold = flexsc.ThreeAxisHold([0.01, 0.0, 0.0], until=flexsc.parts.Instant(20, 0))
        >>> hold.until.seconds
        20.0
        """
    @property
    def state(self) -> str:
        """State of the law in the log, such as `PD`.

        >>> flexsc.ThreeAxisHold([0.01, 0.0, 0.0], state="FIRE").state
        'FIRE'
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __deepcopy__(self, _memo: object) -> ThreeAxisHold: ...

@final
class Truth:
    """The true motion and sky at an instant, which sensors measure and disturbances depend on.

    >>> class Tracker(flexsc.Sensor):
    ...     period = 0.5
    ...     def read(self, truth):
    ...         truths.append(truth)
    ...         return flexsc.Reading(attitude=truth.attitude)
    >>> truths = []
    >>> scenario = flexsc.Scenario.example("four-clamped-modes").with_("duration", 3.0)
    >>> run = scenario.with_parts(sensor=Tracker()).simulate()
    >>> truth = truths[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `truth.now - earlier` is the time between (s), without rounding before the
        difference.

        >>> truth.now - truths[-2].now                                      # s
        0.5
        """
    @property
    def time(self) -> float:
        """The instant (s).

        >>> truth.time
        3.0
        """
    @property
    def angle(self) -> float | None:
        """The angle with its elastic part (rad), for a single-axis body.

        >>> truth.angle is None                                             # three axes
        True
        """
    @property
    def attitude(self) -> _Four | None:
        """The attitude (w, x, y, z) of a three-axis body, which rotates vectors from the body frame to the
        inertial frame.

        >>> round(float(numpy.linalg.norm(truth.attitude)), 12)
        1.0
        """
    @property
    def elastic(self) -> _Three:
        """The elastic rotations at the sensor, in addition to the attitude (rad).

        >>> max(map(abs, truth.elastic)) < 1e-3
        True
        """
    @property
    def rate(self) -> _Three:
        """The rates at the sensor, including the elastic part (rad/s).

        >>> [round(rate, 3) for rate in truth.rate]                         # rad/s
        [-0.026, -0.032, 0.028]
        """
    @property
    def rigid(self) -> _Three:
        """The rigid rates of the body (rad/s).

        >>> [round(rate, 3) for rate in truth.rigid]                        # rad/s
        [-0.025, -0.032, 0.029]
        """
    @property
    def turned(self) -> _Three:
        """The integral of `rate` (rad) up to a constant, as a gyro counts it.

        >>> swept = numpy.subtract(truth.turned, truths[-2].turned)         # rad, in 0.5 s
        >>> [round(float(angle), 3) for angle in swept]
        [-0.012, -0.015, 0.013]
        """
    @property
    def position(self) -> _Three | None:
        """The position from the planet's centre in the inertial frame (m), on an orbit.

        >>> truth.position is None                                          # no orbit
        True
        """
    @property
    def velocity(self) -> _Three | None:
        """The velocity in the inertial frame (m/s), on an orbit.

        >>> truth.velocity is None                                          # no orbit
        True
        """
    @property
    def field(self) -> _Three | None:
        """The magnetic field in the inertial frame (T), if there is one.

        >>> truth.field is None                                             # no field in this scenario
        True
        """
    @property
    def sun(self) -> _Three | None:
        """The direction to the Sun in the inertial frame, when in sunlight.

        >>> truth.sun is None                                               # no Sun in this scenario
        True
        """
    def attitude_at(self, angles: Sequence[float] | npt.NDArray[np.float64]) -> _Four | None:
        """The attitude rotated by three small angles about the body axes (rad).

        >>> tilted = truth.attitude_at([0.0, 0.0, 1e-3])                    # rad about z
        >>> round(2.0 * float(numpy.linalg.norm(numpy.subtract(tilted, truth.attitude))), 6)
        0.001
        """

@final
class Reading:
    """A measurement: the `angle` (rad) or the `attitude` (w, x, y, z), which default to the true one; the
    `rate` (rad/s), three numbers or one; a `vector` in the body frame with its value in the `inertial`
    frame.

    >>> import flexsc
    >>> flexsc.Reading(angle=1e-3, rate=2e-6).rate
    (2e-06, 0.0, 0.0)
    """

    def __new__(
        cls,
        *,
        angle: float | None = None,
        attitude: Sequence[float] | npt.NDArray[np.float64] | None = None,
        rate: float | Sequence[float] | npt.NDArray[np.float64] | None = None,
        vector: Sequence[float] | npt.NDArray[np.float64] | None = None,
        inertial: Sequence[float] | npt.NDArray[np.float64] | None = None,
        is_direction: bool = False,
    ) -> Reading: ...
    @property
    def angle(self) -> float | None:
        """Measured angle (rad), of a sensor that measures it.

        >>> flexsc.Reading(angle=1e-3).angle
        0.001
        """
    @property
    def attitude(self) -> _Four | None:
        """Measured attitude (w, x, y, z), of a sensor that measures it.

        >>> flexsc.Reading(attitude=[1.0, 0.0, 0.0, 0.0]).attitude
        (1.0, 0.0, 0.0, 0.0)
        """
    @property
    def rate(self) -> _Three | None:
        """Measured rates about each axis (rad/s), of a sensor that measures them.

        >>> flexsc.Reading(rate=[1e-4, 0.0, 2e-4]).rate
        (0.0001, 0.0, 0.0002)
        """
    @property
    def vector(self) -> _Three | None:
        """Measured vector in the body frame, of a sensor that measures one.

        >>> flexsc.Reading(vector=[0.0, 0.0, 1.0], inertial=[1.0, 0.0, 0.0]).vector
        (0.0, 0.0, 1.0)
        """
    @property
    def inertial(self) -> _Three | None:
        """Value of the vector in the inertial frame.

        >>> flexsc.Reading(vector=[2e-5, 0.0, 1e-5], inertial=[1e-5, 2e-5, 0.0]).inertial      # T
        (1e-05, 2e-05, 0.0)
        """
    @property
    def is_direction(self) -> bool:
        """True if the vector is a direction, whose length means nothing.

        >>> flexsc.Reading(vector=[0.0, 0.0, 1.0], inertial=[1.0, 0.0, 0.0], is_direction=True).is_direction
        True
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __deepcopy__(self, _memo: object) -> Reading: ...

@final
class Known:
    """The data of a scenario that an estimator knows before a run.

    >>> class Direct(flexsc.Estimator):
    ...     def start(self, known):
    ...         started.append(known)
    ...     def take(self, taken):
    ...         return taken.measured
    >>> started = []
    >>> scenario = flexsc.Scenario.example("relay-sampled").without("uncertain", "estimator")
    >>> run = scenario.with_("duration", 1.0).with_parts(estimator=Direct()).simulate(run=3)
    >>> known = started[0]
    """

    @property
    def axes(self) -> int:
        """The number of axes: 1 or 3.

        >>> known.axes
        1
        """
    @property
    def inertias(self) -> list[float]:
        """Moment of inertia about each axis (kg m²).

        >>> known.inertias
        [25000.0]
        """
    @property
    def modes(self) -> list[list[_Three]]:
        """Frequency (rad/s), damping ratio and gain of each mode, about each axis.

        >>> [round(frequency, 3) for frequency, damping, gain in known.modes[0]]
        [0.62, 1.45, 2.9, 5.3, 10.0]
        """
    @property
    def period(self) -> float | None:
        """Sampling period (s).

        >>> known.period
        0.1
        """
    @property
    def angle_noise(self) -> float:
        """Standard deviation of the measured angle (rad).

        >>> known.angle_noise
        4.010403138505321e-06
        """
    @property
    def rate_noise(self) -> list[float | None]:
        """Standard deviation of the measured rate (rad/s) about each axis, if it is measured.

        >>> known.rate_noise                                                # the rate is not measured
        [None]
        """
    @property
    def reads(self) -> list[str]:
        """The quantities that the law about each axis reads.

        >>> known.reads
        ['motion']
        """
    @property
    def draws(self) -> Draws:
        """Random numbers of the run.

        >>> known.draws.run
        3
        """
    def __deepcopy__(self, _memo: object) -> Known: ...

@final
class Taken:
    """A sample with its context.

    >>> class Direct(flexsc.Estimator):
    ...     def take(self, taken):
    ...         samples.append(taken)
    ...         return taken.truth
    >>> samples = []
    >>> observer = flexsc.Scenario.example("earth-observer").with_("duration", 3.0)
    >>> run = observer.with_parts(estimator=Direct()).simulate()
    >>> taken = samples[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `taken.now - earlier` is the time between (s), without rounding before the
        difference.

        >>> round(taken.now - samples[-2].now, 12)                          # s
        0.1
        """
    @property
    def time(self) -> float:
        """The instant (s).

        >>> taken.time
        3.0
        """
    @property
    def measured(self) -> list[tuple[float, float]] | None:
        """Angle relative to the target (rad) and rate (rad/s) about each axis; None if the sensor is
        silent.

        >>> angle, rate = taken.measured[2]                                 # about z
        >>> abs(angle) < 1e-3, abs(rate) < 1e-3
        (True, True)
        """
    @property
    def readings(self) -> list[Reading | None]:
        """The measurement of each sensor now, in the order of the scenario; None if it was not due, or
        silent.

        >>> gyro, tracker = taken.readings                                  # the tracker was not due
        >>> len(gyro.rate), tracker is None
        (3, True)
        """
    @property
    def origin_angle(self) -> float | None:
        """The origin of the angles (rad), for a single-axis body.

        >>> taken.origin_angle is None                                      # three axes
        True
        """
    @property
    def origin_attitude(self) -> _Four | None:
        """The target (w, x, y, z), for a three-axis body.

        >>> taken.origin_attitude
        (1.0, 0.0, 0.0, 0.0)
        """
    @property
    def truth(self) -> list[tuple[float, float]]:
        """The true rigid angle relative to the target (rad) and rate (rad/s) about each axis, for
        observers.

        >>> len(taken.truth)
        3
        """
    @property
    def torque(self) -> list[float]:
        """The torque that the actuator holds about each axis (N m).

        >>> len(taken.torque)
        3
        """

@final
class Setting:
    """The data about an axis that an actuator knows.

    >>> class Servo(flexsc.Actuator):
    ...     limit = 0.5                                                # N m
    ...     def start(self, settings):
    ...         started.extend(settings)
    ...     def command(self, demanded):
    ...         return demanded.values
    >>> started = []
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 1.0)
    >>> run = scenario.with_parts(actuator=Servo()).simulate()
    >>> setting = started[2]                                           # about z
    """

    @property
    def axis(self) -> int:
        """The axis: 0, or 0 to 2 for roll, pitch and yaw.

        >>> setting.axis
        2
        """
    @property
    def inertia(self) -> float:
        """The inertia that the torque accelerates (kg m²).

        >>> round(setting.inertia, 1)
        1100.0
        """
    @property
    def rate(self) -> float:
        """Rate at the start (rad/s).

        >>> setting.rate
        0.0
        """
    @property
    def period(self) -> float | None:
        """The law's period (s), if it has one.

        >>> setting.period
        0.2
        """
    def __deepcopy__(self, _memo: object) -> Setting: ...

@final
class Demanded:
    """The demands of the laws from now on.

    >>> class Servo(flexsc.Actuator):
    ...     limit = 0.5                                                # N m
    ...     def command(self, demanded):
    ...         demands.append(demanded)
    ...         return [max(-0.5, min(0.5, value)) for value in demanded.values]
    >>> demands = []
    >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 2.0)
    >>> run = scenario.with_parts(actuator=Servo()).simulate()
    >>> demanded = demands[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `demanded.now - earlier` is the time between (s), without rounding before the
        difference.

        >>> demanded.now - demands[-2].now                                  # s
        0.2
        """
    @property
    def time(self) -> float:
        """The instant (s).

        >>> demanded.time
        2.0
        """
    @property
    def values(self) -> list[float]:
        """The demand about each axis.

        >>> len(demanded.values)
        3
        """
    @property
    def kinds(self) -> list[Literal["torque", "change", "moment"]]:
        """The kind of each demand: a torque (N m), a change of the rigid rate (rad/s), or a magnetic moment
        (A m²).

        >>> demanded.kinds[0]
        'torque'
        """
    @property
    def rigid(self) -> _Three:
        """The rigid rates of the body (rad/s).

        >>> max(map(abs, demanded.rigid)) < 1e-2
        True
        """
    @property
    def field(self) -> _Three | None:
        """The measured magnetic field in the body frame (T).

        >>> demanded.field is None                                          # no field in this scenario
        True
        """

@final
class Effort:
    """Torques about each axis (N m), and the time (s) after which the actuator is called again.

    >>> import flexsc
    >>> flexsc.Effort([0.01], after=0.05).torques
    [0.01]
    """

    def __new__(
        cls, torques: Sequence[float] | npt.NDArray[np.float64], *, after: float | None = None
    ) -> Effort: ...
    @property
    def torques(self) -> list[float]:
        """Torques about each axis (N m).

        >>> flexsc.Effort([0.01, 0.0, 0.0]).torques
        [0.01, 0.0, 0.0]
        """
    @property
    def after(self) -> float | None:
        """Time to the next call (s), if it is given.

        >>> flexsc.Effort([0.01], after=0.05).after
        0.05
        """
    def __eq__(self, other: object, /) -> bool: ...

@final
class Load:
    """Torque (N m) and force (N) in body axes, constant until the next call of the disturbance.

    Both have the shape (3,), or (points, 3) for a disturbance with several `points`. The torque on a body
    with one angle is a number. The next call follows `after` a time (s); if no time is given, after the
    disturbance's `period`.

    >>> import flexsc
    >>> flexsc.Load([0.0, 1e-3, 0.0], after=0.1).torque
    [[0.0, 0.001, 0.0]]
    """

    def __new__(
        cls,
        torque: float | Sequence[float] | Sequence[Sequence[float]] | npt.NDArray[np.float64] | None = None,
        force: Sequence[float] | Sequence[Sequence[float]] | npt.NDArray[np.float64] | None = None,
        *,
        after: float | None = None,
    ) -> Load: ...
    @property
    def torque(self) -> list[list[float]] | None:
        """Torque at each point (N m), of shape (points, 3), if it is given.

        >>> flexsc.Load([0.01, 0.0, 0.0]).torque
        [[0.01, 0.0, 0.0]]
        """
    @property
    def force(self) -> list[list[float]] | None:
        """Force at each point (N), of shape (points, 3), if it is given.

        >>> flexsc.Load(force=[[0.0, 0.0, 0.1], [0.0, 0.0, -0.1]]).force
        [[0.0, 0.0, 0.1], [0.0, 0.0, -0.1]]
        """
    @property
    def after(self) -> float | None:
        """Time to the next call (s), if it is given.

        >>> flexsc.Load([0.01, 0.0, 0.0], after=0.05).after
        0.05
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __deepcopy__(self, _memo: object) -> Load: ...

@final
class Aim:
    """The attitude (w, x, y, z) of a target, its rate (rad/s) and its acceleration (rad/s²), both in the axes
    of that attitude.

    >>> import flexsc
    >>> flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=(0.0, 1e-3, 0.0)).rate
    (0.0, 0.001, 0.0)
    """

    def __new__(
        cls,
        attitude: Sequence[float] | npt.NDArray[np.float64],
        rate: Sequence[float] | npt.NDArray[np.float64],
        acceleration: Sequence[float] | npt.NDArray[np.float64] | None = None,
    ) -> Aim: ...
    @property
    def attitude(self) -> _Four:
        """Attitude (w, x, y, z), which rotates vectors from the axes of the target to the inertial frame.

        >>> flexsc.Aim((0.0, 0.0, 0.0, 1.0), rate=(0.0, 0.0, 0.0)).attitude
        (0.0, 0.0, 0.0, 1.0)
        """
    @property
    def rate(self) -> _Three:
        """Rate in the axes of the target (rad/s).

        >>> flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=(1e-3, 0.0, 0.0)).rate
        (0.001, 0.0, 0.0)
        """
    @property
    def acceleration(self) -> _Three:
        """Acceleration in the axes of the target (rad/s²).

        >>> flexsc.Aim((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1e-4, 0.0)).acceleration
        (0.0, 0.0001, 0.0)
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __deepcopy__(self, _memo: object) -> Aim: ...

@final
class Sky:
    """The sky at an instant, in inertial axes.

    >>> class Nadir(flexsc.Guidance):
    ...     def aim(self, sky):
    ...         skies.append(sky)
    ...         return flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0))
    >>> skies = []
    >>> scenario = flexsc.Scenario.example("eclipse-snap").with_("duration", 2.0)
    >>> run = scenario.with_parts(guidance=Nadir()).simulate()
    >>> sky = skies[-1]
    """

    @property
    def now(self) -> Instant:
        """The instant: `sky.now - earlier` is the time between (s), without rounding before the difference.

        >>> sky.now.seconds
        2.0
        """
    @property
    def time(self) -> float:
        """The instant (s).

        >>> sky.time
        2.0
        """
    @property
    def position(self) -> _Three | None:
        """The position from the planet's centre (m), on an orbit.

        >>> 4.2e7 < float(numpy.linalg.norm(sky.position)) < 4.3e7
        True
        """
    @property
    def velocity(self) -> _Three | None:
        """The velocity (m/s), on an orbit.

        >>> 3e3 < float(numpy.linalg.norm(sky.velocity)) < 3.1e3
        True
        """
    @property
    def sun(self) -> _Three | None:
        """The direction to the Sun, when in sunlight.

        >>> sky.sun is None or round(float(numpy.linalg.norm(sky.sun)), 9) == 1.0
        True
        """
    @property
    def field(self) -> _Three | None:
        """The magnetic field (T), if there is one.

        >>> sky.field is None
        True
        """

@final
class Design:
    def __new__(cls) -> Design: ...
    @staticmethod
    def parse(text: str) -> Design: ...
    @property
    def text(self) -> str: ...
    @property
    def runs(self) -> int | None: ...
    def add_list(self, key: str, values: list[float]) -> None: ...
    def add_table(self, keys: list[str], points: npt.NDArray[np.float64]) -> None: ...
    def add_values(self, keys: list[str], points: list[list[str]]) -> None: ...
    def add_sample(self, method: str, count: int, ranges: list[tuple[str, float, float]]) -> None: ...
    def draw(self, method: str, points: int) -> None: ...
    def repeat(self, replicas: int) -> None: ...
    def share_noise(self, run: int) -> None: ...

@final
class Work:
    @staticmethod
    def create(
        scenario: Scenario,
        runs: tuple[int, int],
        design: Design,
        metrics: list[str] | None,
        part_s: float | None,
        yes: bool,
        drawn: bool,
        log: str,
    ) -> Work: ...
    @staticmethod
    def for_points(scenario: Scenario, design: Design, metrics: list[str], yes: bool) -> Work: ...
    @staticmethod
    def parse(manifest: str) -> Work: ...
    def difference(self, there: Work) -> str | None: ...
    def joined(self, there: Work) -> Work: ...
    @property
    def manifest(self) -> str: ...
    @property
    def hash(self) -> str: ...
    @property
    def runs(self) -> tuple[int, int]: ...
    @property
    def keys(self) -> list[str]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def flags(self) -> list[str]: ...
    @property
    def design(self) -> Design: ...
    @property
    def scenario(self) -> Scenario: ...
    def run(self, number: int) -> tuple[Scenario, int]: ...
    def missing(self, files: list[str]) -> list[tuple[int, int]]: ...
    def make(self, runs: tuple[int, int], jobs: int) -> tuple[dict[str, Any], list[_Summary]]: ...
    def sample_sizes(self) -> dict[str, int]: ...
    def make_at(
        self, runs: tuple[int, int], jobs: int, times: list[float], topics: list[str] | None
    ) -> tuple[dict[str, Any], list[_Summary], list[tuple[int, dict[str, dict[str, _Column]]]]]: ...
    def numbers(
        self, runs: tuple[int, int], jobs: int, metrics: list[str]
    ) -> tuple[npt.NDArray[np.float64], str | None]: ...
    def part(self, runs: tuple[int, int], jobs: int) -> tuple[str, bytes]: ...

@final
class Directory:
    @staticmethod
    def create(path: str | os.PathLike[str], work: Work, part: bool, force: bool) -> Directory: ...
    @staticmethod
    def open(path: str | os.PathLike[str]) -> Directory: ...
    @property
    def work(self) -> Work: ...
    def write_part(self, runs: tuple[int, int], jobs: int, log: str, force: bool) -> str: ...
    def write_statistics(self) -> None: ...
    def table(self, ending: str) -> bytes: ...
    def column(self, name: str) -> Any: ...
    def statistics(self) -> list[_Summary]: ...

@final
class Figure:
    @property
    def title(self) -> str: ...
    @property
    def panel_height(self) -> int: ...
    def svg(self) -> str: ...
    def save(
        self, path: str | os.PathLike[str], width: float | None, font: float | None, force: bool
    ) -> None: ...
    def panels(self) -> list[dict[str, Any]]: ...

@final
class Log:
    @staticmethod
    def open(path: str | os.PathLike[str]) -> Log: ...
    @staticmethod
    def read(path: str | os.PathLike[str], contents: bytes) -> Log: ...
    @property
    def path(self) -> Path: ...
    @property
    def contents(self) -> bytes: ...
    @property
    def topics(self) -> list[str]: ...
    @property
    def metadata(self) -> dict[str, str]: ...
    @property
    def scenario(self) -> str | None: ...
    def columns(self, topic: str) -> dict[str, _Column]: ...
    def frames(self, rate: float, exposure: float | None) -> tuple[dict[str, _Column], str]: ...

@final
class Simulator:
    def __new__(cls, scenario: Scenario, run: int) -> Simulator: ...
    @property
    def failed(self) -> str | None: ...
    @property
    def time(self) -> float: ...
    @property
    def done(self) -> bool: ...
    @property
    def axes(self) -> int: ...
    @property
    def command_unit(self) -> str: ...
    @property
    def command_limit(self) -> list[float]: ...
    @property
    def fields(self) -> list[tuple[str, str, str, int | None]]: ...
    def look(self) -> npt.NDArray[np.float64]: ...
    def estimated_attitude(self) -> list[float] | None: ...
    def steer(self, values: npt.NDArray[np.float64]) -> None: ...
    def step(self, dt: float) -> None: ...
    def run_until(self, time: float) -> None: ...
    def run_to_next(self, occasion: str, time: float) -> bool: ...
    def commands(self) -> Commands | None: ...
    def copy(self) -> Simulator: ...

@final
class RunAnswer:
    def __new__(cls, json: str, screen: str, all: str) -> RunAnswer: ...
    def __getnewargs__(self) -> tuple[str, str, str]: ...
    def screen(self, all: bool) -> str: ...
    def json(self) -> str: ...
    @property
    def copied(self) -> bool: ...

@final
class Commands:
    def __new__(cls, until: tuple[int, int], text: str) -> Commands: ...
    def __getnewargs__(self) -> tuple[tuple[int, int], str]: ...
    @property
    def none(self) -> bool: ...

@final
class ExportOptions:
    def __new__(
        cls,
        format: str,
        epoch: str | None,
        frame: str | None,
        center: str | None,
        object_id: str | None,
        speed: float | None,
        modes: bool,
    ) -> ExportOptions: ...

@final
class MotionSampler:
    def __new__(cls, scenario: Scenario, run: int, stepped: Commands | None) -> MotionSampler: ...
    def sample(self, times: list[float]) -> dict[str, dict[str, _Column]]: ...

@final
class Simulators:
    def __new__(
        cls, scenario: Scenario, runs: Sequence[int], threads: int, keeps: bool, started: bool
    ) -> Simulators: ...
    def __len__(self) -> int: ...
    @property
    def axes(self) -> int: ...
    @property
    def command_unit(self) -> str: ...
    @property
    def command_limit(self) -> list[float]: ...
    @property
    def fields(self) -> list[tuple[str, str, str, int | None]]: ...
    @property
    def runs(self) -> npt.NDArray[np.uint64]: ...
    @property
    def time(self) -> npt.NDArray[np.float64]: ...
    @property
    def done(self) -> npt.NDArray[np.bool_]: ...
    @property
    def failed(self) -> list[tuple[int, int, str]]: ...
    def reset(
        self, mask: npt.NDArray[np.bool_] | None, runs: npt.NDArray[np.uint64] | None
    ) -> npt.NDArray[np.float64]: ...
    def step(
        self, values: npt.NDArray[np.float64] | None, dt: float, mask: npt.NDArray[np.bool_] | None
    ) -> npt.NDArray[np.float64]: ...
    def look(self) -> npt.NDArray[np.float64]: ...
    def restore(
        self, simulators: Sequence[Simulator], runs: Sequence[int], mask: npt.NDArray[np.bool_] | None
    ) -> npt.NDArray[np.float64]: ...
    def one(self, index: int) -> Simulator: ...

_Given: TypeAlias = tuple[str, str, int, list[int | list[int]], Any]

def arrow_stream(columns: list[_Given], about: dict[str, str]) -> object: ...
def arrow_schema(columns: list[_Given], about: dict[str, str]) -> object: ...
def table_ending(out: str | os.PathLike[str]) -> str | None: ...
def answer_columns() -> list[str]: ...
def log_answer(log: Log) -> tuple[Scenario, RunAnswer]: ...
def compare(
    names: tuple[str, str], scenarios: tuple[Scenario, Scenario], answers: tuple[RunAnswer, RunAnswer]
) -> RunAnswer: ...
def campaign_answer(work: Work, columns: dict[str, Any]) -> RunAnswer: ...
def campaign_statistics(work: Work, columns: dict[str, Any], rows: int) -> list[_Summary]: ...
def campaign_figures(
    work: Work, columns: dict[str, Any], kind: str | None, metrics: list[str]
) -> list[tuple[str, Figure]]: ...
def directory_figures(
    path: str | os.PathLike[str], kind: str | None, metrics: list[str]
) -> list[tuple[str, Figure]]: ...
def export_fmu(
    scenario: Scenario,
    path: str | os.PathLike[str],
    fmi: int,
    part: str,
    library: str | os.PathLike[str],
) -> int: ...
def export_log(log: Log, options: ExportOptions, path: str | os.PathLike[str]) -> int: ...
def export_run(
    scenario: Scenario,
    run: int,
    options: ExportOptions,
    path: str | os.PathLike[str],
    stepped: Commands | None,
) -> int: ...
def log_figure(log: Log, name: str, scenario: Scenario | None) -> Figure: ...
def log_figures(log: Log, scenario: Scenario | None) -> list[str]: ...
def log_run(log: Log) -> tuple[Scenario, int, Commands, float, dict[str, Any]]: ...
def overlaid_figure(subject: str, runs: list[tuple[str, Figure]]) -> Figure: ...
def log_of(scenario: Scenario, run: int, log: str, stepped: Commands | None) -> Log: ...
def modes_figure(scenario: Scenario) -> Figure | None: ...
def sample_sizes(scenario: Scenario, run: int) -> dict[str, int]: ...
def simulate(
    scenario: Scenario, run: int, log: str, yes: bool, stepped: Commands | None, at: list[float] | None
) -> tuple[
    dict[str, Any], dict[str, dict[str, _Column]], RunAnswer, dict[str, dict[str, _Column]] | None
]: ...
def to_mcap(
    scenario: Scenario, run: int, log: str, path: str | os.PathLike[str], stepped: Commands | None
) -> int: ...
def plan_torque(scenario: Scenario, times: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...
def persistence(sensitivities: npt.NDArray[np.float64]) -> float: ...
def write(path: str | os.PathLike[str], data: bytes) -> None: ...
def matrix_market(
    path: str | os.PathLike[str],
) -> tuple[tuple[int, int], bool, npt.NDArray[np.uintp], npt.NDArray[np.uintp], npt.NDArray[np.float64]]: ...
def with_parts(scenario: Scenario, parts: Sequence[tuple[str, object]]) -> Scenario: ...
def beside_parts(text: str, name: str, parts: Sequence[tuple[str, object]]) -> Scenario: ...
def parts_of(scenario: Scenario) -> list[tuple[str, Any]]: ...
def text_beside_parts(scenario: Scenario) -> str: ...
def analysis(
    name: str, scenario: Scenario | None, options: dict[str, object]
) -> tuple[str, Scenario | None]: ...
def linearise(
    scenario: Scenario, at: float, period: float | None, delay: float | None, opened: str | None
) -> _Model: ...
def sampled(
    a: npt.NDArray[np.float64], b: npt.NDArray[np.float64], period: float, delay: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], int]: ...
def common_margins(
    matrices: _Matrices, period: float | None, signals: list[str], inputs: list[int]
) -> tuple[float, float, float]: ...
def examples() -> list[tuple[str, str]]: ...
def main(args: Sequence[str]) -> int: ...
