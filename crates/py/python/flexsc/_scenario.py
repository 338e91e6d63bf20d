"""Scenarios: their keys and parts, and their runs."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING, Any, Literal, TypeVar, overload

from flexsc import _keys
from flexsc import _native as engine
from flexsc._plan import Plan
from flexsc._result import Detail, Result
from flexsc._scenario_analysis import ScenarioAnalysis
from flexsc._values import arrays, run_number, toml

if TYPE_CHECKING:
    import os

    from flexsc._part import Part
    from flexsc.parts import Actuator, Adaptation, Estimator, Law, Sensor, ThreeAxisLaw

P = TypeVar("P", bound="Part")


class Scenario(ScenarioAnalysis):
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

    __slots__ = ()

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
            ValueError: The part is one of your own, which `parts` has.
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
    def with_(self, key: str | Mapping[str, object], value: object = None, /) -> Scenario:
        """Return a scenario with new values: `with_("law.relay.k_t", 0.34)`, `with_({"seed": 3, ...})`.

        Keys are paths into the file, such as `body.planar.modes[0].frequency`. Several keys are set together:
        only the result has to be valid. A quantity may be a text with a unit, such as `"0.02 Hz"`.

        >>> import flexsc
        >>> scenario = flexsc.Scenario.example("relay-fixed")
        >>> scenario.with_("body.planar.modes[0].frequency", "0.02 Hz").modes["frequency"].round(4).tolist()
        [0.1257, 0.755]
        >>> scenario.with_({"seed": 3, "duration": 600.0})
        <flexsc.Scenario relay-fixed: 600 s, 2 modes, seed 3>

        Raises:
            ScenarioError: A key or a value is not accepted.
        """
        keys = {key: value} if isinstance(key, str) else key
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
    ) -> Scenario:
        """Return a scenario with your own parts in place of its parts, as `flexsc.parts` describes them.

        The objects are copied: later changes to them do not change the scenario. Give sensors and actuators
        of a list by their positions in it, `sensor={1: MyTracker()}`; a single one replaces the first. An
        actuator of a list keeps its `axes` and its `share`. In a scenario with modes of operation give laws
        by the names of their modes, `law={"point": MyLaw()}`, and in one with stages by the numbers of their
        stages; the other modes and stages keep their laws.
        A file cannot hold such parts: `to_toml` has empty tables for them, the log of a run cannot be
        repeated without the objects, and campaigns are not written to directories.

        >>> class Off(flexsc.Law):
        ...     period = 1.0
        ...     def decide(self, event):
        ...         return flexsc.Hold(0.0)
        >>> flexsc.Scenario.example("relay-fixed").with_parts(law=Off()).parts
        {'law': <...Off object at ...>}

        >>> flexsc.Scenario.example("safe-mode").with_parts(law={"safe": Off()}).parts
        {'law safe': <...Off object at ...>}

        Raises:
            TypeError: An object is not of the class of its role.
            ScenarioError: The parts do not fit the others, or a law has no place, because each mode has one.
        """
        from flexsc._roles import by_role

        return self._of(
            engine.with_parts(self._native, by_role(law, estimator, adaptation, actuator, sensor))
        )

    @property
    def parts(self) -> dict[str, object]:
        """Your own parts by role; sensors as `sensor 0`, actuators after the first as `actuator 1`, laws of
        modes as `law point`, and those of stages as `law 1`.

        >>> flexsc.Scenario.example("relay-fixed").parts                     # all of its parts are flexsc's
        {}
        """
        return dict(engine.parts_of(self._native))

    def with_law(
        self,
        controller: object,
        period: float | None = None,
        *,
        method: Literal["held", "tustin"] = "held",
        command: Literal["torque", "acceleration"] = "torque",
        limit: float | None = None,
        track: bool = False,
        inputs: Sequence[str] | None = None,
        outputs: Sequence[str] | None = None,
    ) -> Scenario:
        """Return a scenario with a linear controller as its law, `[law.state_space]`.

        Args:
            controller: Matrices (A, B, C, D), an object that has them, such as those of `control.ss`,
                `control.hinfsyn`, `scipy.signal.StateSpace` and `Linear.compensator`, or a gain K as
                `control.lqr` returns it, for u = -K x. About one axis its inputs are the error of the angle
                (rad) and, if it has two, the error of the rate (rad/s): the goal minus the measured or
                estimated value. Its output is the command. On three axes a controller of one output acts
                about each axis, a dict has one each for `roll`, `pitch` and `yaw`, and a controller with
                three outputs acts about all axes together.
            period: Sampling period (s) of a continuous-time controller; a discrete-time one has its own.
            method: Discretisation of a continuous-time controller: `held`, exact for errors held over a
                period, or `tustin`.
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
    ) -> Result:
        """Simulate the scenario. Other Python threads continue meanwhile.

        Args:
            run: Number of the run, which selects its noise. Keys of `[uncertain]` keep their values:
                `scenario.draw(3).simulate(3)` is run 3 of a campaign.
            log: `events` records all events (switchings, window means, adaptation). `full` adds the motion at
                each period of the scenario's log and at every switching. `none` records the metrics only.
                `scene` has the columns of `full`; a file written from it also has the scene for viewers.
            yes: Run even if the estimate is more than 10 h on one core, 4 GB of memory or 20 GB of logs.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 600.0).simulate(log="full")
        >>> run.metrics["switchings"], run["attitude"]["angle_rad"].shape
        (81, (6082,))

        Raises:
            SimulationError: The state is no longer finite, or the law switches without end.
            ValueError: The estimate exceeds these limits, and `yes` is not given.
        """
        return self._simulate(run_number(run), log, yes)

    def export_fmu(
        self,
        path: str | os.PathLike[str],
        *,
        fmi: Literal[2, 3] = 3,
        part: Literal["loop", "plant", "controller"] = "loop",
        library: str | os.PathLike[str] | None = None,
    ) -> int:
        """Write the scenario as an FMU, which other simulators import, and return the number of bytes.

        Args:
            path: The file, which is replaced if it exists.
            fmi: The version of the standard: 3, with exact events, or 2.
            part: `loop`, the closed loop; `plant`, the spacecraft with its sensors and actuators, whose
                commands are inputs; or `controller`, the laws, whose estimates and references are inputs.
            library: The library of FMUs; if omitted, that of this package.

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
        from flexsc._fmi_library import fmi_library

        return engine.export_fmu(self._native, path, fmi, part, library or fmi_library())

    def _simulate(
        self, run: int, log: Detail, yes: bool, stepped: engine.Commands | None = None, until: float = inf
    ) -> Result:
        """Simulate a run, or repeat one that was stepped."""
        began = time.perf_counter()
        metrics, topics, warnings = engine.simulate(self._native, run, log, yes, stepped)
        took = time.perf_counter() - began
        final = {name: arrays(columns) for name, columns in topics.items()}
        return Result(self, run, log, metrics, final, took, stepped, until, warnings)

    def __reduce__(self) -> tuple[Any, ...]:
        parts = engine.parts_of(self._native)
        if parts:
            return _beside, (engine.text_beside_parts(self._native), self.name, parts)
        return Scenario.parse, (self.to_toml(), self.name)


def _beside(text: str, name: str, parts: list[tuple[str, object]]) -> Scenario:
    return Scenario._of(engine.beside_parts(text, name, parts))
