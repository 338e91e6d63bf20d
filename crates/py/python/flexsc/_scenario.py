"""Scenarios: their keys and parts, their runs and their analyses."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from math import inf, nan
from typing import TYPE_CHECKING, Any, Final, Literal, TypeVar, overload

from flexsc import _keys
from flexsc import _native as engine
from flexsc._analysis import analysis
from flexsc._answer import Answer
from flexsc._deprecated import with_old_members
from flexsc._missing import reading
from flexsc._named import no_such
from flexsc._numpy import np, npt
from flexsc._plan import Plan
from flexsc._result import Detail, Result
from flexsc._signature import LateSignature, of_scenario
from flexsc._values import arrays, counted, document, plain, run_number, toml

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self, Unpack

    from flexsc._linear import Break, Linear
    from flexsc._part import Part
    from flexsc._sample_times import SampleTimes
    from flexsc.parts import (
        Actuator,
        Adaptation,
        DisturbanceModel,
        Estimator,
        Guidance,
        Law,
        Sensor,
        ThreeAxisLaw,
    )
    from flexsc.results import (
        NoiseSpectrum,
        OutputBound,
        PointingBudget,
        StabilityMargins,
        TunedScenario,
        WorstCase,
    )
    from flexsc.scenario import Keys

# The value that `with_` was not given.
_NOT_GIVEN: Final = object()
P = TypeVar("P", bound="Part")
# Name of a stability margin.
Margin = Literal["modulus", "disk", "gain", "phase", "delay"]


@with_old_members
class Scenario:
    """A study: everything that a scenario file contains. It is valid and immutable.

    Args:
        values: The keys of a scenario file, as nested dictionaries. NumPy numbers and arrays are accepted;
            the `epoch` is a `datetime`.
        name: The name of the scenario if `values` has none; also used in errors.
        keys: Keys in addition to those of `values`, or replacing them. Parts may be classes of
            `flexsc.scenario`, whose keys an editor completes.

    Raises:
        ScenarioError: A key is unknown, missing, or has a value that is not accepted.

    >>> import flexsc
    >>> from flexsc.scenario import Mode, Open, Planar
    >>> body = Planar(modes=[Mode(frequency=0.44, gain=0.02, displacement=1e-5)])
    >>> flexsc.Scenario(name="ringing", duration=100.0, body=body, law=Open())
    <flexsc.Scenario ringing: 100 s, 1 mode, seed 0>
    """

    __slots__ = ("_native",)
    _native: engine.Scenario
    if not TYPE_CHECKING:
        # For `help`, and for the completion of keys in notebooks.
        __signature__ = LateSignature(of_scenario)

    def __init__(
        self, values: Mapping[str, object] | None = None, name: str = "scenario", **keys: Unpack[Keys]
    ) -> None:
        if values is not None and not isinstance(values, Mapping):
            hint = "Scenario.load reads a file, Scenario.parse a text"
            raise TypeError(f"a scenario is made of a dict, not of a {type(values).__name__}; {hint}")
        given = {key: value for key, value in keys.items() if value is not None}
        text = document(name, {"name": name, **(values or {}), **given})
        self._native = engine.Scenario.from_values(text, name)

    @classmethod
    def _of(cls, native: engine.Scenario) -> Self:
        scenario = cls.__new__(cls)
        scenario._native = native
        return scenario

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a scenario file.

        >>> import flexsc, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = pathlib.Path(folder) / "mine.toml"
        ...     length = path.write_text(flexsc.Scenario.example("relay-fixed").to_toml())
        ...     flexsc.Scenario.load(path)
        <flexsc.Scenario relay-fixed: 20000 s, 2 modes, seed 1>

        Raises:
            FileNotFoundError: There is no such file. The error is a `ScenarioError` too.
            ScenarioError: The file cannot be read or is not accepted; the text gives the line, the key and
                the accepted values.
        """
        return cls._of(reading(path, engine.Scenario.load))

    @classmethod
    def parse(cls, text: str, name: str = "scenario") -> Self:
        """Read a scenario from TOML text. `name` is its name if the text has none; it is also used in errors.

        >>> import flexsc
        >>> text = "duration = 60.0\\n[body.planar]\\nangle = 1e-3\\n[law.open]"
        >>> flexsc.Scenario.parse(text, "drifting")
        <flexsc.Scenario drifting: 60 s, 0 modes, seed 0>

        Raises:
            ScenarioError: The text is not accepted.
        """
        return cls._of(engine.Scenario.parse(text, name))

    @classmethod
    def example(cls, name: str) -> Self:
        """Read a shipped scenario by its name, one of `flexsc.examples()`.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").duration
        20000.0

        Raises:
            KeyError: There is no scenario of this name.
        """
        examples = dict(engine.examples())
        if name not in examples:
            raise no_such("no example", name, examples)
        return cls.parse(examples[name], name)

    @property
    def name(self) -> str:
        """Name of the study.

        >>> flexsc.Scenario.example("relay-fixed").name
        'relay-fixed'
        """
        return self._native.name

    @property
    def seed(self) -> int:
        """Seed of all randomness.

        >>> flexsc.Scenario.example("relay-fixed").with_("seed", 3).seed
        3
        """
        return self._native.seed

    @property
    def duration(self) -> float:
        """Simulated time (s).

        >>> flexsc.Scenario.example("relay-fixed").duration
        20000.0
        """
        return self._native.duration

    @property
    def remarks(self) -> list[str]:
        """Remarks on values that are accepted and probably not meant, such as a damping ratio above 1, and on
        own disturbances, which linear analyses leave out.

        The command prints them as notes before a run.

        >>> scenario = flexsc.Scenario.example("wheel-scheduled-gain")
        >>> scenario.with_("body.planar.modes[0].damping", 5.0).remarks[0].partition(" and ")[0]
        '`body.planar.modes[0].damping` is a ratio,'
        """
        return self._native.remarks

    @property
    def modes(self) -> dict[str, npt.NDArray[np.float64]]:
        """The elastic modes, as arrays of shape (modes,).

        For a single-axis body: `frequency` (rad/s), `period` (s), `damping` (ratio), `gain` (response of the
        angle per unit of reduced torque), `excitability`, the gain divided by the squared frequency (s²),
        `effective_inertia`, the gain times the moment of inertia (kg m²), and `free_frequency` and
        `clamped_frequency` (rad/s), with the hub free and with the hub held; NaN where a value does not
        apply.

        For a spatial body: `frequency`, `period` and `damping`, and `influence` of shape (modes, 3): the jump
        of the elastic rate at the gyro per jump of the rigid rate that the jets cause about x, y and z.

        >>> flexsc.Scenario.example("relay-fixed").modes["period"].round(2).tolist()         # s
        [14.28, 8.32]
        """
        from flexsc._modes import modes

        return modes(self._native)

    def poles(self, wheel_speed: float | None = None) -> dict[str, npt.NDArray[np.float64]]:
        """Return the poles of a spacecraft whose wheels turn on a `mount` or another part.

        Without the loop, `frequency` (rad/s) and `damping` (ratio) of each oscillation in arrays, whirl
        included; empty without `points` of the wheels on such a part.

        Args:
            wheel_speed: Speed of these wheels (rad/s); if omitted, each has that of the start.

        >>> flexsc.Scenario.example("earth-observer").poles()["frequency"].size
        0
        """
        from flexsc._modes import poles

        return poles(self._native, wheel_speed)

    @property
    def outputs(self) -> dict[str, npt.NDArray[np.float64]]:
        """The observed coordinates by name: their weights on rigid angle and modes, of shape (1 + modes,).

        >>> list(flexsc.Scenario.example("rotation-robust").outputs)
        ['section_1', 'section_2', 'section_3', 'section_4']
        """
        from flexsc._modes import outputs

        return outputs(self._native)

    def to_dict(self) -> dict[str, Any]:
        """The scenario with all its defaults, as a dictionary that `Scenario(...)` accepts.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").to_dict()["law"]["relay"]["k_t"]
        0.31
        """
        values: dict[str, Any] = plain(self._native.to_json())
        return values

    def to_toml(self) -> str:
        """The scenario with all its defaults, as TOML.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").to_toml().splitlines()[0]
        'name = "relay-fixed"'
        """
        return self._native.to_toml()

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Save the scenario as a file, which `Scenario.load` and the command read; it has all defaults.

        Paths of files that the scenario names, such as those of modes, are absolute.

        >>> import flexsc, pathlib, tempfile
        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> with tempfile.TemporaryDirectory() as out:
        ...     scenario.save(pathlib.Path(out) / "study.toml")
        ...     flexsc.Scenario.load(pathlib.Path(out) / "study.toml") == scenario
        True

        Raises:
            ValueError: The scenario has parts written in Python, which no file can hold.
            FileExistsError: The file is there, and `force` is not given.
            OSError: The file cannot be written.
        """
        if self.own_parts:
            raise ValueError(f"no file can hold parts written in Python: {', '.join(self.own_parts)}")
        if not force and os.path.lexists(path):
            raise FileExistsError(f"{os.fspath(path)} is there: give force=True to replace it")
        engine.write(path, self.to_toml().encode())

    def get(self, key: str) -> Any:
        """Return the value of a key, as in `to_dict`: its default if it is not set, and None without one.

        Args:
            key: The path of the key, such as `law.relay.k_t` or `body.planar.modes[0].frequency`.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> scenario.get("law.relay.k_t"), scenario.get("body.planar.modes[0].damping"), scenario.get("epoch")
        (0.31, 0.0, None)

        Raises:
            KeyError: There is no such key; the text has those that there are.
        """
        return _keys.get(self, key)

    @overload
    def part(self, key: str) -> Any: ...
    @overload
    def part(self, key: str, kind: type[P]) -> P: ...
    def part(self, key: str, kind: type[P] | None = None) -> Any:
        """Return the part at a key as a class of `flexsc.scenario`, with its defaults.

        A list of parts, such as `sensor`, is a list of classes, and a table of them, such as `uncertain`, a
        dict. A value that is no part is that of `get`. `with_` sets the part again, as it is or changed.

        Args:
            key: The path of the key, such as `actuator`, `sensor[1]` or `body.planar.modes[0]`.
            kind: The class that the part has to be; an editor then completes its keys.

        >>> import flexsc
        >>> from dataclasses import replace
        >>> from flexsc.scenario import Wheels
        >>> observer = flexsc.Scenario.example("earth-observer")
        >>> wheels = observer.part("actuator", Wheels)
        >>> weaker = observer.with_("actuator", replace(wheels, torque=0.5 * wheels.torque))      # N m
        >>> weaker.get("actuator.wheels.torque") / observer.get("actuator.wheels.torque")
        0.5

        Raises:
            KeyError: There is no such key; the text has those that there are.
            TypeError: The part is of another class.
            ValueError: The part is one of your own, which `own_parts` has.
        """
        from flexsc._part_reader import part_at

        return part_at(self, key, kind)

    def without(self, *keys: str) -> Scenario:
        """Return a scenario without some keys: what they were for has its default, or is left out.

        An element of an array, such as `sensor[1]`, is removed from it.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled")
        >>> "uncertain" in scenario.without("uncertain").to_dict()
        False
        >>> scenario.without("body.planar.modes[0]", "body.planar.modes[1]").modes["frequency"].shape
        (3,)

        Raises:
            KeyError: A key is not set.
            ScenarioError: The scenario needs the key.
        """
        return _keys.without(self, keys)

    @overload
    def with_(self, key: str, value: object, /) -> Scenario: ...
    @overload
    def with_(self, keys: Mapping[str, object], /) -> Scenario: ...
    def with_(self, key: str | Mapping[str, object], value: object = _NOT_GIVEN, /) -> Scenario:
        """Return a scenario with new values: `with_("law.relay.k_t", 0.34)`, `with_({"seed": 3, ...})`.

        Keys are paths into the file, such as `body.planar.modes[0].frequency`. Several keys are set together:
        only the result has to be valid. A quantity may be a text with a unit, such as `"0.02 Hz"`. None
        removes a key, as `without` does.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> scenario.with_("body.planar.modes[0].frequency", "0.02 Hz").modes["frequency"].round(4).tolist()
        [0.1257, 0.755]
        >>> scenario.with_({"seed": 3, "duration": 600.0})
        <flexsc.Scenario relay-fixed: 600 s, 2 modes, seed 3>

        Raises:
            KeyError: A key that is to be removed is not set.
            ScenarioError: A key or a value is not accepted.
        """
        if isinstance(key, str) and value is _NOT_GIVEN:
            raise TypeError(f"with_ needs the value of {key!r}")
        keys = {key: value} if isinstance(key, str) else key
        removed = [name for name, value in keys.items() if value is None]
        if removed:
            changes = {name: value for name, value in keys.items() if value is not None}
            return _keys.without(self, removed, changes)
        return self._of(self._native.with_keys([(k, toml(self.name, k, v)) for k, v in keys.items()]))

    def in_mode(self, name: str, /) -> Scenario:
        """Return a scenario in which one `[[mode]]` of operation acts throughout, for linear tools.

        Of a law with `stages`, `name` is the index of the stage that acts throughout.

        >>> flexsc.Scenario.example("safe-mode").in_mode("point")
        <flexsc.Scenario safe-mode: 9000 s, 0 modes, seed 0>
        >>> quiet = flexsc.Scenario.example("orbit-correction").in_mode("0")
        >>> quiet.get("law.attitude.bandwidth"), quiet.margins().modulus > 0.5
        (0.05, True)

        Raises:
            ScenarioError: There is no such mode, or its parts do not fit without those of others.
        """
        return self._of(self._native.in_mode(name))

    def with_parts(
        self,
        *,
        law: Law
        | ThreeAxisLaw
        | Mapping[str, Law | ThreeAxisLaw]
        | Mapping[int, Law | ThreeAxisLaw]
        | None = None,
        sensor: Sensor | Mapping[int, Sensor] | None = None,
        estimator: Estimator | None = None,
        adaptation: Adaptation | None = None,
        actuator: Actuator | Mapping[int, Actuator] | None = None,
        disturbance: DisturbanceModel | Mapping[int, DisturbanceModel] | None = None,
        guidance: Guidance | Mapping[str, Guidance] | None = None,
    ) -> Scenario:
        """Return a scenario with your own parts in place of its parts, as `flexsc.parts` describes them.

        The objects are copied: later changes to them do not change the scenario. Give sensors and actuators
        of a list by their positions in it, `sensor={1: MyTracker()}`; a single one replaces the first. An
        actuator of a list keeps its `axes` and its `share`. In a scenario with modes of operation give laws
        by the names of their modes, `law={"point": MyLaw()}`, and in one with stages by the numbers of their
        stages; the other modes and stages keep their laws. A disturbance is added to those of the scenario,
        several with numbers of their own, `disturbance={0: Slosh(), 1: Cooler()}`. A guidance replaces all
        targets, or that of a mode, `guidance={"point": MyGuidance()}`.
        A file cannot hold such parts: `to_toml` has empty tables for them, the log of a run cannot be
        repeated without the objects, and campaigns are not written to directories.

        >>> class Off(flexsc.Law):
        ...     period = 1.0
        ...     def decide(self, event):
        ...         return flexsc.Hold(0.0)
        >>> flexsc.Scenario.example("relay-fixed").with_parts(law=Off()).own_parts
        {'law': <...Off object at ...>}

        >>> flexsc.Scenario.example("safe-mode").with_parts(law={"safe": Off()}).own_parts
        {'law safe': <...Off object at ...>}

        Raises:
            TypeError: An object is not of the class of its role.
            ScenarioError: The parts do not fit the others, or a law has no place, because each mode has one.
        """
        from flexsc._roles import by_role

        return self._of(
            engine.with_parts(
                self._native, by_role(law, estimator, adaptation, actuator, sensor, disturbance, guidance)
            )
        )

    @property
    def own_parts(self) -> dict[str, object]:
        """Your own parts by role; sensors as `sensor 0`, actuators after the first as `actuator 1`, laws of
        modes as `law point`, and those of stages as `law 1`; disturbances as `disturbance 0`, guidance of
        modes as `guidance point`.

        >>> flexsc.Scenario.example("relay-fixed").own_parts                 # all of its parts are flexsc's
        {}
        """
        return dict(engine.parts_of(self._native))

    def with_law(
        self,
        controller: object,
        period: float | None = None,
        *,
        method: Literal["zoh", "tustin", "held"] = "zoh",
        command: Literal["torque", "acceleration"] = "torque",
        limit: float | None = None,
        track: bool = False,
        inputs: Sequence[str] | None = None,
        outputs: Sequence[str] | None = None,
    ) -> Scenario:
        """Return a scenario with a linear controller as its law, `[law.state_space]`.

        Args:
            controller: Matrices (A, B, C, D), an object that has them, such as those of `control.ss`,
                `control.hinfsyn`, `scipy.signal.StateSpace` and `Linear.compensator`, a transfer function of
                python-control or SciPy, or a gain K as `control.lqr` returns it, for u = -K x. About one axis
                its inputs are the error of the angle (rad) and, if it has two, the error of the rate (rad/s):
                the goal minus the measured or estimated value. Its output is the command. On three axes a
                controller of one output acts about each axis, a dict has one each for `roll`, `pitch` and
                `yaw`, and a controller with three outputs acts about all axes together.
            period: Sampling period (s) of a continuous-time controller; a discrete-time one has its own.
            method: Discretisation of a continuous-time controller: `zoh`, exact for errors held over a
                period (`held` in a file), or `tustin`.
            command: Whether the output is a `torque` (N m) or an `acceleration` (rad/s²).
            limit: Largest command; None without a limit.
            track: Whether the law follows a manoeuvre while it lasts.
            inputs: The inputs of a controller about three axes together, by the names of
                `law.state_space.inputs`; None for those of the controller, or for the errors of `roll`,
                `pitch` and `yaw`, and with six also those of their rates.
            outputs: The axes of its outputs; None for those of the controller, or `roll`, `pitch`, `yaw`.

        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> pd = scenario.with_law(([], [], [], [[0.04, 0.3]]), 0.25)
        >>> pd.to_dict()["law"]["state_space"]["d"]
        [[0.04, 0.3]]

        The gain of a linear quadratic regulator about three axes:

        >>> import numpy as np
        >>> gain = np.hstack([4.0 * np.eye(3), 60.0 * np.eye(3)])
        >>> coupled = flexsc.Scenario.example("attitude-hold").with_law(gain, 0.25)
        >>> coupled.to_dict()["law"]["state_space"]["inputs"][2:4]
        ['yaw', 'roll_rate']

        Raises:
            ScenarioError: The matrices are not accepted, or do not go with the other parts.
            ValueError: The period is missing, or shapes or names do not fit.
        """
        from flexsc._controllers import Settings, law_of

        settings = Settings(period, method, command, limit, track)
        return self.with_("law", law_of(controller, settings, inputs, outputs))

    def draw(self, run: int) -> Scenario:
        """Return the scenario of one run of a campaign, with its `[uncertain]` keys drawn and set.

        `scenario.draw(57).simulate(run=57)` is run 57 of `campaign(scenario)`; `Table.row` returns the
        scenario of a row of any campaign or sweep.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-sampled").with_("duration", 100.0)
        >>> run = scenario.draw(2).simulate(run=2)
        >>> run.metrics["duty"] == flexsc.campaign(scenario, range(2, 3))["duty"].item()
        True

        Raises:
            ScenarioError: The drawn values do not make a valid scenario.
        """
        return self._of(self._native.draw(run_number(run)))

    def plan(self, band: float = 0.1) -> Plan:
        """Return the plan of the manoeuvre; its residuals allow for a relative frequency error `band`.

        >>> import flexsc
        >>> plan = flexsc.Scenario.example("rotation-sine").plan()
        >>> plan["peak_torque_nm"] > 0.0
        True

        Raises:
            ValueError: The scenario has no manoeuvre, or the band is not between 0 and 1.
        """
        return Plan(self, band)

    def simulate(
        self,
        run: int = 0,
        log: Detail = "events",
        yes: bool = False,
        *,
        at: npt.ArrayLike | None = None,
    ) -> Result:
        """Simulate the scenario. Other Python threads continue meanwhile.

        Args:
            run: Number of the run, which selects its noise. Keys of `[uncertain]` keep their values:
                `scenario.draw(3).simulate(3)` is run 3 of a campaign.
            log: `events` records all events (switchings, window means, adaptation). `full` adds the motion at
                each period of the scenario's log and at every switching. `none` records the metrics only.
                `scene` has the columns of `full`; a file written from it also has the scene for viewers.
            yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.
            at: Times (s), of shape (times,) and in any order, at which the exact motion is kept as `samples`,
                in the same run.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0).simulate(log="full")
        >>> run.metrics["switchings"], run["attitude"]["angle_rad"].shape
        (81, (6082,))

        Raises:
            SimulationError: The state is no longer finite, or the law switches without end.
            ValueError: The estimate exceeds these limits, and `yes` is not given, a time is not within the
                run, or the motion at `at` has more than 200 000 000 values.
        """
        if at is None:
            return self._simulate(run_number(run), log, yes)
        from flexsc._sample_times import SampleTimes

        times = SampleTimes(at, self.duration)
        times.check_size(engine.sample_sizes(self._native, run_number(run)))
        return self._simulate(run_number(run), log, yes, times=times)

    def linearise(
        self,
        at: float = 0.0,
        *,
        period: float | None = None,
        delay: float | None = None,
        loop: Break | None = None,
    ) -> Linear:
        """Return the scenario's body at rest as a linear model, or its open loop.

        The states are rigid motion and modes. The inputs are the torques of the actuator (N m). The outputs
        are the measured quantities, angles and rates at the sensor with their elastic parts, followed by all
        states. The momentum of the wheels couples the axes; the environment and limits are left out.

        Args:
            at: The time (s) whose natural frequencies are used if they drift.
            period: Sampling period (s), over which inputs are held; None for continuous time.
            delay: The delay of the inputs (s); None for the delay of the scenario's wheel.
            loop: Return the open loop of a linear law (`pd`, `attitude` with its integral and filters,
                `state_space`), with the Kalman filter or attitude filter that the law reads, sampled with the
                law's period (or the shortest with which all parts repeat) and opened at the `command` of the
                law, at the `torque` of the actuator, or at the `measurement` of angles and rates. The signs
                are those of negative feedback: `closed()` closes the loop again.

        >>> flexsc.Scenario.example("relay-fixed").linearise(period=0.5).a.shape
        (6, 6)

        Raises:
            ScenarioError: The body is not a linear system, because it has driven appendages, or the loop is
                not linear: the key, and the reason.
            ValueError: A time is not accepted, or there is no such point.
        """
        from flexsc._linear import Linear

        return Linear._of(engine.linearise(self._native, at, period, delay, loop))

    def margins(self, loop: Break = "command") -> StabilityMargins:
        """Return the stability margins of the scenario's loop, opened at a point: `flexsc margins`.

        Each signal at the break has gain, phase and delay margins at every crossing, a modulus and a disk
        margin, with the loops of the others closed; all signals together have a modulus and a disk margin.

        Args:
            loop: The point: the `command` of the law, the `torque` of the actuator, or the `measurement` of
                angles and rates.

        >>> margins = flexsc.Scenario.example("wheel-fast-mode").margins()
        >>> margins.loops["command"].gain_crossings["frequency"].round(3)[:3]
        array([0.015])

        Raises:
            ScenarioError: The loop is not linear: the key, and the reason.
            ValueError: The closed loop is not stable: its worst pole; or there is no such point.
        """
        from flexsc.results import StabilityMargins

        found = analysis("margins", self, opened=loop)
        for each in found["loops"] if found["samples"] > 1 else ():
            each["delay_s"] = nan
        return StabilityMargins._read(found)

    def tune(
        self,
        ranges: Mapping[str, tuple[float, float]],
        *,
        objective: str = "margin",
        keep: Sequence[str] = (),
        loop: Break = "command",
        bandwidth: float | None = None,
        corners: bool = True,
    ) -> TunedScenario:
        """Return the scenario with the best keys for an objective, within limits: `flexsc tune --vary`.

        The worst of all plants counts: the nominal one, and the corners of `[uncertain]`.

        Args:
            ranges: The least and the largest value of each key, such as `{"law.pd.k_d": (10.0, 400.0)}`.
            objective: `"margin"`, the least modulus margin of all signals together, is maximised.
                `"settling"`, the time after a step of the target in which the angles settle within 5 %, is
                minimised, and so is the rms of the pointing index of the `[[requirement]]` of another name,
                or the value in a run of one over time.
            keep: Limits that all plants keep: `"margin>=0.5"`, `"settling<=60"` (s), or the name of a
                `[[requirement]]` with its own limit.
            loop: The point at which the loops are opened.
            bandwidth: A frequency (rad/s) at which the loop gain of the nominal plant stays 1 or more.
            corners: Whether there is a plant for each corner of the uncertain keys.

        >>> scenario = flexsc.Scenario.example("earth-observer")
        >>> tuned = scenario.tune({"law.attitude.damping": (0.4, 1.5)}, bandwidth=0.1)
        >>> tuned.least_margin > tuned.least_margin_before
        True

        Raises:
            ScenarioError: A key cannot be tuned, the loop is not linear, or there is no requirement of the
                name: the key, and the reason.
            ValueError: The loop of a plant is not stable with the keys of the scenario, or a text of
                `objective` or `keep` is not one of these.
        """
        from flexsc.results import TunedScenario

        if isinstance(keep, str):
            raise TypeError(f"keep: must be a sequence of texts, such as [{keep!r}], got a text")
        keys = [(key, (float(low), float(high))) for key, (low, high) in ranges.items()]
        options = {"opened": loop, "objective": objective, "keep": list(keep), "bandwidth": bandwidth}
        return TunedScenario._read(analysis("tune", self, keys=keys, is_nominal=not corners, **options))

    def spectrum(
        self,
        signals: Sequence[str] | None = None,
        window: float | None = None,
        separation: float | None = None,
        speeds: npt.ArrayLike | None = None,
        pixel: float | None = None,
        smear: float | None = None,
        diffraction: float | None = None,
    ) -> NoiseSpectrum:
        """Return the noise of the scenario's loop, exact from its linear model: `flexsc spectrum`.

        The noise is that of the sensors, of their rounding, of random torques and of machines. Limits and
        steady disturbances are left out; the body is about its target at rest. The lines of unbalanced wheels
        are over their speed, with the same indices over windows.

        Args:
            signals: Names of outputs, such as `roll`, `roll_rate`, `command_roll`, `mode0_displacement` and
                `line_of_sight0_x`; `["all"]` for all of them, None for measured angles and lines of sight.
            window: Length (s) of windows for pointing indices, of the noise and of the lines of wheels.
            separation: Time (s) from the start of a window to that of the next, for differences of means.
            speeds: Speeds (rad/s) of the wheels for the lines of their imbalance; None for 48 up to their
                largest.
            pixel: Angle (rad) of a pixel: `mtf` then has the contrast that the motion leaves an image at its
                Nyquist frequency, over exposures of `window`, or without one over a long exposure.
            smear: Steady rate (rad/s) of the image during exposures of `window`: its factor is in `image`.
            diffraction: Wavelength over the diameter of a circular aperture (rad): its factor is in `image`.

        >>> spectrum = flexsc.Scenario.example("attitude-hold").spectrum(["roll", "command_roll"])
        >>> spectrum.sources
        ('sensor.sampled.noise', 'sensor.sampled.rate_noise')
        >>> spectrum.outputs["command_roll"].unit
        'N m'

        Raises:
            ScenarioError: A part has no linear model: the key, and the reason.
            ValueError: The closed loop is not stable, noise grows without limit, or there is no such output.
        """
        from flexsc._noise import noise_spectrum

        return noise_spectrum(self, signals, window, separation, speeds, pixel, smear, diffraction)

    def budget(self, runs: int = 20, jobs: int | None = None) -> PointingBudget:
        """Return the pointing budget of the scenario's `[[requirement]]` tables: `flexsc budget`.

        Each pointing index has its levels at 68.3, 95.5 and 99.7 %, temporal, ensemble and mixed: by the
        order statistics of a campaign, by convolution of its error sources, and by the rule of k sigma.

        Args:
            runs: Number of runs of the campaign over the noise and the uncertain keys.
            jobs: Number of threads; if omitted, one per core.

        >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
        >>> [index.unit for index in budget.indices]
        ['rad', 'rad']

        Raises:
            ValueError: The scenario has no requirement on a pointing index, or a run fails.
        """
        from flexsc.results import PointingBudget

        if runs < 1:
            raise ValueError(f"runs must be 1 or more, got {runs}")
        return PointingBudget._read(analysis("budget", self, runs=runs, jobs=jobs or 0))

    def bound(self) -> list[OutputBound]:
        """Return the guaranteed ranges of the outputs that the scenario's `[[bound]]` names: `flexsc bound`.

        Each is over all states at the start, inputs in time, frequencies and damping ratios of the claim. It
        has the verdict about its limits.

        >>> import flexsc
        >>> [bound.verdict for bound in flexsc.Scenario.example("bounded-jitter").bound()]
        ['proved', 'proved']

        Raises:
            ScenarioError: The scenario has no claims, or its body or a claim is not accepted: the key, and
                the reason.
        """
        from flexsc.results import OutputBound

        found = analysis("bounds", self)
        for witness in filter(None, (each["witness"] for each in found)):
            witness["scenario"] = type(self).parse(witness["scenario"]) if "scenario" in witness else None
        return [OutputBound._read(each) for each in found]

    def worst(
        self,
        metric: str | None = None,
        *,
        requirement: str | None = None,
        margin: Margin | None = None,
        signal: str | None = None,
        window: float | None = None,
        loop: Break = "command",
        least: bool = False,
        points: int = 200,
        jobs: int | None = None,
    ) -> WorstCase:
        """Return the worst case over the scenario's `[uncertain]` keys: `flexsc worst`.

        Half of the points are spread over the ranges of the keys; searches from the worst of them use the
        others. What is found is a witness: it can be worse, but not better. All runs have the same noise.

        Args:
            metric: A metric, or an element `NAME[i]` of a list of them.
            requirement: A requirement of the scenario, by its name, in place of a metric.
            margin: A stability margin in place of a metric, the least of all loops: `modulus`, `disk`,
                `gain`, `phase` or `delay`.
            signal: An output of the linear loop in place of a metric, such as `line_of_sight0_x`: its rms
                under
                the imbalance of the wheels at their worst speed.
            window: Length (s) of windows within which the signal moves against its mean.
            loop: The point at which the loops are opened for a margin.
            least: Whether small values of the metric are bad.
            points: Largest number of points, each of which is a run, or a loop of a margin.
            jobs: Number of threads of the runs; if omitted, one per core.

        >>> worst = flexsc.Scenario.example("slew-wheel-lqg").worst("settling_time_s", points=10)
        >>> worst.value >= worst.nominal
        True

        Raises:
            ScenarioError: The scenario has no uncertain keys, or no linear loop: the key, and the reason.
            ValueError: There is no such quantity, or it has no value at any point.
        """
        from flexsc.results import WorstCase

        given = {"metric": metric, "requirement": requirement, "margin": margin, "signal": signal}
        chosen = [(kind, name) for kind, name in given.items() if name is not None]
        if len(chosen) != 1:
            names = ", ".join(each["name"] for each in self.to_dict().get("requirement", ()))
            there = f"; the requirements are {names}" if names else ""
            raise ValueError(f"give one of metric, requirement, margin and signal, got {len(chosen)}{there}")
        if least and metric is None:
            raise ValueError("least is for a metric: it is known of a requirement, a margin and a signal")
        [(kind, name)] = chosen
        options = {"kind": kind, "name": name, "opened": loop, "window": window, "is_least": least}
        return WorstCase._read(analysis("worst", self, **options, points=points, jobs=jobs or 0))

    def report(self, path: str | os.PathLike[str], runs: int = 100, *, force: bool = False) -> bool:
        """Write a page for a design review, and return whether all its verdicts are good: `flexsc report`.

        The page has the conclusions, requirements, the spacecraft, a time line, margins and noise of each
        mode, claims, budgets and a campaign with their figures, and the command that repeats each.

        Args:
            path: The page, `FILE.html`.
            runs: Number of runs of the campaign; 0 leaves it out.
            force: Whether a file of other content is replaced.

        >>> import flexsc, pathlib, tempfile
        >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 40.0)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     page = pathlib.Path(folder) / "study.html"
        ...     met = scenario.report(page, runs=0)
        ...     met, page.stat().st_size > 20_000
        (True, True)

        Raises:
            ValueError: The page cannot be written, or the scenario has parts that are written in Python.
        """
        from flexsc._report import report

        return report(self, path, runs, force)

    def export_c(
        self,
        path: str | os.PathLike[str],
        *,
        name: str | None = None,
        calls: int = 20_000,
        guests: Sequence[Literal["cfs", "fprime"]] = (),
        language: Literal["c", "rust"] = "c",
        force: bool = False,
    ) -> list[Path]:
        """Write the control system as C99 for a flight computer, and return its files: `flexsc export-c`.

        The C is translated from the Rust code that runs call. A driver replays the calls of a run and
        compares their outputs by bits: `make check` in the directory.

        Args:
            path: The directory.
            name: Prefix of all names in C; None for the scenario's name.
            calls: Largest number of calls of the run that are recorded as vectors.
            guests: Frameworks of flight software for which the control system is also written: as an app of
                cFS, as a component of F Prime.
            language: `c`, or `rust` for a crate without the standard library, whose `cargo test` compares.
            force: Whether files of other content are replaced.

        >>> import flexsc, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     files = flexsc.Scenario.example("relay-sampled").export_c(folder, name="relay")
        ...     [file.name for file in files if file.name.startswith("relay")]
        ['relay.c', 'relay.h', 'relay.icd.json']

        Raises:
            ValueError: The law has no code for flight, or a file exists with other content.
        """
        from flexsc._flight_code import export_c

        return export_c(self, path, name, calls, guests, language, force)

    def export_fmu(
        self,
        path: str | os.PathLike[str],
        *,
        fmi: Literal[2, 3] = 3,
        part: Literal["loop", "plant", "controller"] = "loop",
        library: str | os.PathLike[str] | None = None,
        sources: bool = False,
    ) -> int:
        """Write the scenario as an FMU, which other simulators import, and return the number of bytes.

        Args:
            path: The file, which is replaced if it exists.
            fmi: The version of the standard: 3, with exact events, or 2.
            part: `loop`, the closed loop; `plant`, the spacecraft with its sensors and actuators, whose
                commands are inputs; or `controller`, the laws, whose estimates and references are inputs.
            library: The library of FMUs, or a ZIP archive of it; if omitted, that of this package.
            sources: With the part `controller`: its exported C, with attitude filter and modes, in place of a
                library, for any platform.

        >>> import flexsc, pathlib, tempfile
        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> with tempfile.TemporaryDirectory() as out:
        ...     size = scenario.export_fmu(pathlib.Path(out) / "relay.fmu")
        ...     size == (pathlib.Path(out) / "relay.fmu").stat().st_size
        True

        Raises:
            ValueError: The scenario has parts written in Python, its laws cannot run alone as a `controller`,
                or the library is not there.
        """
        from flexsc import _command
        from flexsc._fmi_library import fmi_library

        if sources:
            if library is not None:
                raise ValueError("library: an FMU with sources has none")
            options = ["--part", part, "--fmi", str(fmi), "--sources"]
            _command.run(self, "export-fmu", path, options, force=True)
            return os.stat(path).st_size
        return engine.export_fmu(self._native, path, fmi, part, library or fmi_library())

    def _simulate(
        self,
        run: int,
        log: Detail,
        yes: bool,
        stepped: engine.Commands | None = None,
        until: float = inf,
        times: SampleTimes | None = None,
    ) -> Result:
        """Simulate a run, or repeat one that was stepped."""
        began = time.perf_counter()
        at = None if times is None else times.grown
        metrics, topics, answer, seen = engine.simulate(self._native, run, log, yes, stepped, at)
        took = time.perf_counter() - began
        final = {name: arrays(columns) for name, columns in topics.items()}
        sampled = None if times is None or seen is None else (times, seen)
        return Result(self, run, log, metrics, final, took, stepped, until, Answer(answer), sampled)

    def __reduce__(self) -> tuple[Any, ...]:
        parts = engine.parts_of(self._native)
        if parts:
            return _beside, (engine.text_beside_parts(self._native), self.name, parts)
        return Scenario.parse, (self.to_toml(), self.name)

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, Scenario) else NotImplemented

    def __hash__(self) -> int:
        # Two scenarios are equal with zeros of either sign, but differ as texts.
        return hash(self.to_toml().replace("-0.0", "0.0"))

    def __repr__(self) -> str:
        return f"<flexsc.Scenario {self.name}: {self._about()}>"

    def _about(self) -> str:
        return f"{self.duration:g} s, {counted(self._native.mode_count, 'mode')}, seed {self.seed}"

    def _repr_html_(self) -> str:
        from flexsc import _html

        values = self.to_dict()
        figure = engine.modes_figure(self._native)
        text = _html.folded("all keys", _html.pre(self.to_toml()))
        shown = _html.picture(figure) if figure else ""
        return _html.heading(self.name, self._about()) + _html.line(values.get("about", "")) + shown + text


def _beside(text: str, name: str, parts: list[tuple[str, object]]) -> Scenario:
    return Scenario._of(engine.beside_parts(text, name, parts))
