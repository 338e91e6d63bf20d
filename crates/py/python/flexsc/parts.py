"""Your own parts: a law, an estimator, a sensor, an actuator, an adaptation, a disturbance or a guidance
as a Python object.

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

import copyreg
from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

from flexsc._laws import CompiledLaw, CompiledThreeAxisLaw, Law, ThreeAxisLaw
from flexsc._native import (
    Aim,
    Authority,
    Demanded,
    Draws,
    Effort,
    Event,
    Hold,
    Instant,
    Known,
    Load,
    Reading,
    Setting,
    Sky,
    Stream,
    Taken,
    ThreeAxisEvent,
    ThreeAxisHold,
    Truth,
)
from flexsc._own_part import OwnPart
from flexsc._surroundings import CompiledDisturbance, CompiledGuidance, DisturbanceModel, Guidance

__all__ = [
    "Actuator",
    "Adaptation",
    "Aim",
    "Authority",
    "CompiledDisturbance",
    "CompiledGuidance",
    "CompiledLaw",
    "CompiledThreeAxisLaw",
    "Demanded",
    "DisturbanceModel",
    "Draws",
    "Effort",
    "Estimator",
    "Event",
    "Guidance",
    "Hold",
    "Instant",
    "Known",
    "Law",
    "Load",
    "Reading",
    "Sensor",
    "Setting",
    "Sky",
    "Stream",
    "Taken",
    "ThreeAxisEvent",
    "ThreeAxisHold",
    "ThreeAxisLaw",
    "Truth",
]


def _of_keys(kind: type[Any], keys: dict[str, Any]) -> Any:
    return kind(**keys)


def _keep_keys(kind: type[Any], names: Sequence[str]) -> None:
    """Let objects of a class of the engine be pickled and shown as its keywords, without those that are None
    or False, as by default."""

    def keys(part: Any) -> dict[str, Any]:
        found = {name: getattr(part, name) for name in names}
        return {name: value for name, value in found.items() if value is not None and value is not False}

    def shown(part: Any) -> str:
        return f"{kind.__name__}({', '.join(f'{name}={value!r}' for name, value in keys(part).items())})"

    copyreg.pickle(kind, lambda part: (_of_keys, (kind, keys(part))))
    setattr(kind, "__repr__", shown)  # noqa: B010, mypy knows it as a method


_keep_keys(Reading, ("angle", "attitude", "rate", "vector", "inertial", "is_direction"))
_keep_keys(ThreeAxisHold, ("torques", "accelerations", "moments", "after", "until", "state"))
_keep_keys(Effort, ("torques", "after"))
_keep_keys(Load, ("torque", "force", "after"))
_keep_keys(Aim, ("attitude", "rate", "acceleration"))


# Tracebacks, `help` and pickles of classes name the place where users find them.
for _class in (
    CompiledDisturbance,
    CompiledGuidance,
    CompiledLaw,
    CompiledThreeAxisLaw,
    DisturbanceModel,
    Guidance,
    Law,
    ThreeAxisLaw,
):
    _class.__module__ = __name__
del _class


class Estimator(OwnPart):
    """An estimator: at each sample it computes estimates about all axes from the measurements.

    >>> class Direct(Estimator):
    ...     def take(self, taken):
    ...         return taken.measured
    """

    def start(self, known: Known) -> None:
        """Start a run with the known data of the scenario.

        >>> class Filter(Direct):
        ...     def start(self, known):
        ...         self.frequencies = [mode[0] for mode in known.modes[0]]    # rad/s
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(estimator=Filter()).simulate()
        """

    @abstractmethod
    def take(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Process a sample.

        Returns:
            Angle (rad) and rate (rad/s) about each axis, of shape (axes, 2), with angles relative to the
            target. With displacement (rad), rate (rad/s) and frequency (rad/s) of the dominant mode appended,
            the shape is (axes, 5). None leaves the estimate unchanged.

        >>> class Halved(Estimator):
        ...     def take(self, taken):
        ...         return [(0.5 * angle, rate) for angle, rate in taken.measured]     # rad, rad/s
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(estimator=Halved()).simulate()
        """

    def given(self, now: Instant, moments: tuple[float, float, float]) -> None:
        """Accept the reduced moments (rad/s²) about each axis that the actuator gives from now on.

        >>> class Observer(Direct):
        ...     def given(self, now, moments):
        ...         self.acceleration = moments[0]                             # rad/s²
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(estimator=Observer()).simulate()
        """

    def carry(self, taken: Taken) -> Sequence[Sequence[float]] | None:
        """Propagate the estimate from the last sample to now, if a law decides between samples.

        `taken` has the time and the target, but no measurements. The return value is that of `take`. The
        method must not change the estimator.

        >>> class Carrying(Direct):
        ...     def take(self, taken):
        ...         self.last, self.state = taken.now, taken.measured
        ...         return self.state
        ...     def carry(self, taken):
        ...         h = taken.now - self.last                                  # s
        ...         return [(angle + h * rate, rate) for angle, rate in self.state]
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(estimator=Carrying()).simulate()
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

        >>> class Known(Direct):
        ...     def attitude(self, now):
        ...         return (1.0, 0.0, 0.0, 0.0), numpy.zeros(3), 1e-8 * numpy.eye(6)
        >>> scenario = flexsc.Scenario.example("earth-observer").with_("duration", 10.0)
        >>> metrics = scenario.with_parts(estimator=Known()).simulate().metrics
        >>> metrics["attitude_estimate_error_rms_rad"] < 1e-2
        True
        """
        return None

    def shift(self, by: tuple[float, float, float]) -> None:
        """Accept a change of target: angles are now larger by `by` (rad) about each axis.

        >>> class Shifting(Direct):
        ...     offset = numpy.zeros(3)
        ...     def shift(self, by):
        ...         self.offset = self.offset + by                             # rad
        >>> estimator = Shifting()
        >>> estimator.shift((0.0, 0.0, 0.1))
        >>> estimator.offset.tolist()
        [0.0, 0.0, 0.1]
        """


class Sensor(OwnPart):
    """A sensor, which is read at samples.

    >>> class Encoder(Sensor):
    ...     period = 0.25
    ...     def read(self, truth):
    ...         return Reading(angle=round(truth.angle / 1e-6) * 1e-6)
    """

    period: float | str
    """Period of its samples (s, or a text such as "250 ms").

    >>> Encoder().period
    0.25
    """
    angle_noise: float = 0.0
    """Standard deviation of the measured angle (rad), as used by filters.

    >>> class Coarse(Encoder):
    ...     angle_noise = 1e-5 / 12.0**0.5                                 # steps of 1e-5 rad
    >>> round(Coarse().angle_noise, 9)
    2.887e-06
    """
    rate_noise: float | None = None
    """Standard deviation of the measured rate (rad/s); None for a sensor that does not measure the rate.

    >>> class Gyrometer(Encoder):
    ...     rate_noise = 1e-6
    ...     def read(self, truth):
    ...         return Reading(angle=truth.angle, rate=truth.rate[0])
    >>> Gyrometer().rate_noise
    1e-06
    """

    def start(self, axes: int, draws: Draws) -> None:
        """Start a run of a body with 1 or 3 axes; take noise from streams of `draws`, so that runs are
        repeatable.

        >>> class Noisy(Encoder):
        ...     def start(self, axes, draws):
        ...         self.noise = draws.stream("encoder")
        ...     def read(self, truth):
        ...         return Reading(angle=truth.angle + 1e-6 * self.noise.normal())     # rad
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(sensor=Noisy()).simulate()
        """

    @abstractmethod
    def read(self, truth: Truth) -> Reading | None:
        """Return a measurement; None if the sensor is silent.

        >>> class Dropping(Encoder):
        ...     def read(self, truth):
        ...         return Reading(angle=truth.angle) if truth.time % 1.0 < 0.5 else None
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(sensor=Dropping()).simulate()
        """


class Actuator(OwnPart):
    """An actuator, which converts the demands of laws into torques about all axes.

    >>> class Servo(Actuator):
    ...     limit = 0.05
    ...     def command(self, demanded):
    ...         return [max(-0.05, min(0.05, value)) for value in demanded.values]
    """

    limit: float | Sequence[float] | None = None
    """Largest torque about every axis (N m), or one value per axis; None without a limit.

    >>> Servo().limit
    0.05
    """

    def start(self, settings: Sequence[Setting]) -> None:
        """Start a run with the settings of each axis.

        >>> class Started(Servo):
        ...     def start(self, settings):
        ...         self.inertias = [setting.inertia for setting in settings]  # kg m²
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(actuator=Started()).simulate()
        """

    @abstractmethod
    def command(self, demanded: Demanded) -> Effort | Sequence[float]:
        """Return the torques (N m) about each axis from now on, of shape (axes,).

        `Effort(torques, after=s)` requests another call after `s` seconds, with the same demands.

        >>> class Pulsed(Servo):
        ...     def command(self, demanded):
        ...         return Effort(demanded.values if demanded.time % 1.0 < 0.5 else [0.0], after=0.5)
        >>> scenario = flexsc.Scenario.example("rotation-robust").with_("duration", 1.0)
        >>> run = scenario.with_parts(actuator=Pulsed()).simulate()
        """


class Adaptation(OwnPart):
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
    """The parameter, by its key within the law's table; of a law of your own, one of its `tunable`.

    >>> Descent().tunes
    'k_t'
    """
    objective: str = "envelope_mean"
    """Quantity measured over each window, as `objective` of `[adaptation.random_search]`.

    >>> class Quiet(Descent):
    ...     objective = "pointing_error_rms"
    ...     window = 100.0                                                 # s
    >>> Quiet().objective
    'pointing_error_rms'
    """
    window: float | str | None = None
    """Length of the windows (s); None for `envelope_mean`, which has those of the `[estimator.envelope]`.

    >>> Descent().window is None                                        # windows of the envelope
    True
    """

    def start(self, value: float, draws: Draws) -> None:
        """Start a run with the initial value of the parameter.

        >>> adaptation = Descent()
        >>> adaptation.start(0.31, None)
        >>> adaptation.value
        0.31
        """

    @abstractmethod
    def learn(self, time: float, measured: float) -> float | None:
        """Process the objective, such as the mean envelope (rad), over the window that ends now (s).

        Returns:
            The new value of the parameter; None leaves it unchanged.

        >>> adaptation = Descent()
        >>> adaptation.start(0.31, None)
        >>> round(adaptation.learn(100.0, 2e-6), 4)                        # s, rad
        0.3101
        """
