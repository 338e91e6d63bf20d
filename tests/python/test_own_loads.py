"""Disturbances and guidance of one's own, in Python and compiled, against shipped ones and against SciPy."""

from __future__ import annotations

import ctypes
import math
import pickle
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import MappingProxyType
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import shipped
from flexsc.parts import Draws, Sky, Truth

DOUBLES = ctypes.POINTER(ctypes.c_double)
FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double, DOUBLES, DOUBLES, DOUBLES)


class Steady(flexsc.DisturbanceModel):
    """A torque and a force that do not change."""

    period = 1000.0

    def __init__(self, torque: Any = None, force: Any = None, points: tuple[str, ...] = ()) -> None:
        self.torque, self.force, self.points = torque, force, points

    def act(self, truth: Truth) -> flexsc.Load:
        return flexsc.Load(self.torque, self.force)


class Slosh(flexsc.DisturbanceModel):
    """A fluid about the z axis: an inertia on a spring and a damper, by the symplectic Euler method."""

    period = 0.002
    inertia, stiffness, damper = 4.0, 1.0, 0.05  # kg m², N m/rad, N m s/rad
    signals = MappingProxyType({"angle": "rad"})

    def start(self, axes: int, draws: Draws) -> None:
        self.angle = self.rate = 0.0

    def act(self, truth: Truth) -> flexsc.Load:
        assert truth.attitude is not None
        turned = 2.0 * math.atan2(truth.attitude[3], truth.attitude[0])
        torque = self.stiffness * (turned - self.angle) + self.damper * (truth.rigid[2] - self.rate)
        self.rate += self.period * torque / self.inertia
        self.angle += self.period * self.rate
        return flexsc.Load([0.0, 0.0, -torque])


class Spin(flexsc.Guidance):
    """A target that turns about the z axis with an acceleration; both may be drawn."""

    def __init__(self, rate: float = 1e-3, acceleration: float = 2e-5, spread: float = 0.0) -> None:
        self.rate, self.acceleration, self.spread = rate, acceleration, spread

    def start(self, draws: Draws) -> None:
        self.rate *= 1.0 + self.spread * draws.stream("spin").normal()

    def aim(self, sky: Sky) -> flexsc.Aim:
        half = 0.5 * (self.rate * sky.time + 0.5 * self.acceleration * sky.time**2)
        rate = self.rate + self.acceleration * sky.time
        return flexsc.Aim(
            (math.cos(half), 0.0, 0.0, math.sin(half)), (0.0, 0.0, rate), (0.0, 0.0, self.acceleration)
        )


def observer(seconds: float = 20.0) -> flexsc.Scenario:
    """A flexible spacecraft with wheels, gyro, star tracker and attitude filter."""
    return shipped("earth-observer").with_("duration", seconds)


def free(seconds: float) -> flexsc.Scenario:
    """A rigid body that turns about z without control."""
    body = {"spatial": {"inertia": [[20, 0, 0], [0, 20, 0], [0, 0, 10]], "rate": [0.0, 0.0, 0.01]}}
    return flexsc.Scenario({"duration": seconds, "body": body, "law": {"open": {}}, "log": {"period": 0.1}})


def same(one: flexsc.Result, other: flexsc.Result, topics: tuple[str, ...]) -> None:
    for topic in topics:
        for column in one[topic]:
            np.testing.assert_array_equal(one[topic][column], other[topic][column])


@FUNCTION
def nothing(now, since, truth, states, load):  # type: ignore[no-untyped-def]
    """No load, and no time of the next call."""


@FUNCTION
def at_once(now, since, truth, states, load):  # type: ignore[no-untyped-def]
    """No load, and a time that rounds to this instant."""
    load[6] = 1e-16


@pytest.mark.parametrize(
    "load", [{"torque": [0.0, 1e-3, 0.0]}, {"force": [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], "after": 0.5}]
)
def test_a_pickled_load_is_the_load(load: dict[str, Any]) -> None:
    made = flexsc.Load(**load)
    assert pickle.loads(pickle.dumps(made)) == made
    assert (made.torque is None, made.force is None) == ("torque" not in load, "force" not in load)


def test_a_remark_says_that_linear_analyses_leave_out_a_disturbance() -> None:
    own = observer().with_parts(disturbance=Steady([0.0, 1e-3, 0.0]))
    assert [remark for remark in own.remarks if remark not in observer().remarks] == [
        "`disturbance` acts in runs alone: margins, noise, linear models and the linear part of budgets "
        "leave out one that is written in Python or compiled"
    ]


@pytest.mark.parametrize(
    ("own", "keys"),
    [
        (Steady(torque=[0.0, 1e-3, 0.0]), {"about": "pitch", "torque": 1e-3}),
        (Steady(force=[0.0, 0.0, 2e-3]), {"force": [0.0, 0.0, 2e-3]}),
        (Steady(force=[[0.0, 0.0, 2e-3]], points=("bench",)), {"force": [0, 0, 2e-3], "point": "bench"}),
    ],
)
def test_a_constant_load_is_that_of_a_shipped_disturbance(own: Steady, keys: dict[str, Any]) -> None:
    scenario = observer()
    mine = scenario.with_parts(disturbance=own).simulate(log="full")
    theirs = scenario.with_("disturbance", [keys]).simulate(log="full")
    same(mine, theirs, ("rates", "torques", "vibrations"))


def test_torques_and_forces_at_several_points_add_up() -> None:
    scenario = observer()
    forces = [[0.0, 0.0, 2e-3], [1e-3, 0.0, 0.0]]
    both = Steady(force=forces, points=("bus", "bench"))
    each = {
        index: Steady(force=force, points=(name,))
        for index, (force, name) in enumerate(zip(forces, ("bus", "bench"), strict=True))
    }
    one = scenario.with_parts(disturbance=both).simulate(log="full")
    two = scenario.with_parts(disturbance=each).simulate(log="full")
    difference = one["rates"]["axes.rate_rad_s"] - two["rates"]["axes.rate_rad_s"]
    assert np.abs(difference).max() < 1e-11
    # A torque at a point turns the body as one at another, and excites the modes through that point.
    torque = Steady(torque=[[1e-3, 0.0, 0.0]], points=("bus",))
    hub = {"about": "roll", "torque": 1e-3}
    mine = scenario.with_parts(disturbance=torque).simulate(log="full")["rates"]["axes.rate_rad_s"]
    theirs = scenario.with_("disturbance", [hub]).simulate(log="full")["rates"]["axes.rate_rad_s"]
    np.testing.assert_allclose(mine, theirs, rtol=0.0, atol=1e-11)


def test_slosh_is_the_coupled_motion() -> None:
    integrate = pytest.importorskip("scipy.integrate")
    scenario = free(20.0)
    run = scenario.with_parts(disturbance=Slosh()).simulate(log="full")
    spring, damper = Slosh.stiffness, Slosh.damper

    def motion(_: float, y: npt.NDArray[np.float64]) -> list[float]:
        torque = spring * (y[0] - y[2]) + damper * (y[1] - y[3])
        return [y[1], -torque / 10.0, y[3], torque / Slosh.inertia]

    times = run["rates"]["time_s"]
    exact = integrate.solve_ivp(
        motion, (0.0, 20.0), [0.0, 0.01, 0.0, 0.0], t_eval=times, rtol=1e-10, atol=1e-13
    )
    rate = run["rates"]["axes.rigid_rad_s"][:, 2]
    assert np.abs(rate - exact.y[1]).max() < 2e-5 * 0.01 / 2e-3
    assert np.abs(run["own_disturbance"]["angle"] - exact.y[2]).max() < 2e-4
    # The momentum of body and fluid is conserved to the step.
    assert run.at(20.0)["rates"]["axes.rigid_rad_s"][2] < 0.01


def test_guidance_gives_the_reference() -> None:
    scenario = observer(60.0)
    run = scenario.with_parts(guidance=Spin(rate=1e-4, acceleration=2e-6)).simulate(log="full")
    assert run.metrics["pointing_error_end_rad"] < 2e-4
    rate = 1e-4 + 2e-6 * 60.0
    assert run.at(60.0)["rates"]["axes.rigid_rad_s"][2] == pytest.approx(rate, abs=2e-5)
    assert "target" not in run.scenario.to_dict()


def test_campaigns_and_processes_take_both() -> None:
    scenario = observer(10.0).with_parts(
        disturbance={0: Steady([1e-3, 0.0, 0.0]), 1: Steady(force=[0.0, 1e-3, 0.0])},
        guidance=Spin(spread=0.5),
    )
    assert list(scenario.own_parts) == ["disturbance 0", "disturbance 1", "guidance"]
    table = flexsc.campaign(scenario, 4)
    errors = table["pointing_error_end_rad"]
    assert len(set(errors.tolist())) == 4
    assert [
        scenario.simulate(run=run).metrics["pointing_error_end_rad"] for run in range(4)
    ] == errors.tolist()
    with ProcessPoolExecutor(2) as pool:
        np.testing.assert_array_equal(
            flexsc.campaign(scenario, 4, executor=pool)["pointing_error_end_rad"], errors
        )
    again = pickle.loads(pickle.dumps(scenario))
    assert again.simulate().metrics == scenario.simulate().metrics
    # Keys change beside the parts.
    assert list(scenario.with_("duration", 5.0).own_parts) == list(scenario.own_parts)


def test_a_mode_has_a_guidance_of_its_own() -> None:
    scenario = shipped("safe-mode")
    names = [mode["name"] for mode in scenario.to_dict()["mode"]]
    own = scenario.with_parts(guidance={names[-1]: Spin()})
    assert list(own.own_parts) == [f"guidance {names[-1]}"]
    assert own.with_("duration", 5.0).simulate().metrics is not None
    with pytest.raises(
        flexsc.ScenarioError, match="guidance: must be one of `detumble`, `point`, `safe`, got `nowhere`"
    ):
        scenario.with_parts(guidance={"nowhere": Spin()})
    with pytest.raises(flexsc.ScenarioError, match="has no modes of operation"):
        observer().with_parts(guidance={"point": Spin()})


def test_a_mode_alone_keeps_its_guidance_and_the_others_their_targets() -> None:
    scenario = shipped("safe-mode").with_("duration", 5.0).with_("spacecraft.rate", [0.0, 0.0, 0.0])
    own = scenario.with_parts(guidance={"point": Spin()})
    alone = own.in_mode("point")
    assert list(alone.own_parts) == ["guidance"]
    topics = ("pointing", "rates")
    whole = scenario.in_mode("point").with_parts(guidance=Spin())
    same(alone.simulate(log="full"), whole.simulate(log="full"), topics)
    safe = own.in_mode("safe")
    assert list(safe.own_parts) == []
    assert safe.get("target") == scenario.in_mode("safe").get("target")

    # Without targets of modes that of the scenario stays, unless the guidance is for all modes.
    modes = [
        {key: value for key, value in mode.items() if key != "target"} for mode in scenario.to_dict()["mode"]
    ]
    shared = scenario.with_("mode", modes).with_("target", [{"from": 0.0, "frame": "nadir"}])
    of_mode, of_all = shared.with_parts(guidance={"point": Spin()}), shared.with_parts(guidance=Spin())
    assert of_mode.get("target") == shared.get("target")
    same(of_mode.simulate(log="full"), shared.simulate(log="full"), topics)
    assert "target" not in of_all.to_dict()
    assert list(of_all.own_parts) == ["guidance"]


def test_an_error_at_the_last_time_or_between_samples_is_raised() -> None:
    class Late(Spin):
        fails_between = (20.125, math.inf)

        def aim(self, sky: Sky) -> flexsc.Aim:
            start, end = self.fails_between
            if start < sky.time < end:
                raise RuntimeError("late")
            return super().aim(sky)

    # No sensor and no law has a sample at these times: the rows alone call the guidance.
    scenario = observer(20.13).with_("log.period", 0.01).with_parts(guidance=Late())
    with pytest.raises(RuntimeError, match="late"):
        scenario.simulate(log="full")
    with pytest.raises(RuntimeError, match="late"):
        scenario.simulate(log="none", at=[20.13])
    Late.fails_between = (10.11, 10.19)
    with pytest.raises(RuntimeError, match="late"):
        scenario.simulate(log="none", at=[10.13])
    run = scenario.simulate(log="none")
    with pytest.raises(RuntimeError, match="late"):
        run.sample([10.13])


def test_what_cannot_be_is_refused() -> None:
    one = shipped("rotation-robust").with_("duration", 1.0)
    with pytest.raises(flexsc.ScenarioError, match=r"`guidance` gives attitudes of a body with three axes"):
        one.with_parts(guidance=Spin())
    with pytest.raises(flexsc.ScenarioError, match=r"names points of a body with three axes"):
        one.with_parts(disturbance=Steady(1.0, points=("tip",)))
    with pytest.raises(
        flexsc.ScenarioError, match=r"must be one of the body's points, `bus`, `bench`, got `tip`"
    ):
        observer().with_parts(disturbance=Steady(points=("tip",)))
    with pytest.raises(ValueError, match="a force acts on a body with three axes"):
        one.with_parts(disturbance=Steady(force=[1.0, 0.0, 0.0])).simulate()
    with pytest.raises(ValueError, match=r"torque must be of shape \(3,\), got \(2,\)"):
        observer().with_parts(disturbance=Steady([1.0, 0.0])).simulate()
    with pytest.raises(ValueError, match=r"torque must be of shape \(2, 3\), got \(3,\)"):
        observer().with_parts(disturbance=Steady([1.0, 0.0, 0.0], points=("bus", "bench"))).simulate()
    with pytest.raises(ValueError, match="torque must be finite, got NaN"):
        observer().with_parts(disturbance=Steady([math.nan, 0.0, 0.0])).simulate()
    with pytest.raises(TypeError, match=r"disturbance 0 must be an object of a flexsc\.DisturbanceModel"):
        observer().with_parts(disturbance=Spin())  # type: ignore[arg-type]

    class Once(flexsc.DisturbanceModel):
        def act(self, truth: Truth) -> list[float]:
            return [0.0, 0.0, 0.0]

    class Wrong(flexsc.Guidance):
        def aim(self, sky: Sky) -> Any:
            return (1.0, 0.0, 0.0, 0.0)

    class Failing(flexsc.Guidance):
        def aim(self, sky: Sky) -> flexsc.Aim:
            return flexsc.Aim((2.0, 0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0))

    with pytest.raises(ValueError, match="must give the time of its next call"):
        observer().with_parts(disturbance=Once()).simulate()
    with pytest.raises(ValueError, match="must give the time of its next call"):
        observer().with_parts(disturbance=flexsc.CompiledDisturbance(nothing)).simulate()
    with pytest.raises(RuntimeError, match="a compiled disturbance gave"):
        observer().with_parts(disturbance=flexsc.CompiledDisturbance(at_once)).simulate()
    with pytest.raises(ValueError, match=r"aim must return a flexsc\.Aim, got shape \(4,\)"):
        observer().with_parts(guidance=Wrong()).simulate()
    with pytest.raises(ValueError, match="attitude must be a unit quaternion"):
        observer().with_parts(guidance=Failing()).simulate()


def test_compiled_loads_are_those_of_python() -> None:
    @FUNCTION
    def drag(now, since, truth, states, load):  # type: ignore[no-untyped-def]
        for axis in range(3):
            load[axis] = -1e-2 * truth[7 + axis]
        states[0] += 1.0

    @FUNCTION
    def spin(now, since, sky, constants, aim):  # type: ignore[no-untyped-def]
        half = 0.5 * (constants[0] * now + 0.5 * constants[1] * now**2)
        aim[0], aim[3] = math.cos(half), math.sin(half)
        aim[6], aim[9] = constants[0] + constants[1] * now, constants[1]

    class Drag(flexsc.DisturbanceModel):
        period = 0.1

        def act(self, truth: Truth) -> list[float]:
            return [-1e-2 * rate for rate in truth.rigid]

    scenario = observer()
    compiled = scenario.with_parts(
        disturbance=flexsc.CompiledDisturbance(drag, period=0.1, states=[0.0]),
        guidance=flexsc.CompiledGuidance(spin, states=[1e-3, 2e-5]),
    ).simulate(log="full")
    python = scenario.with_parts(disturbance=Drag(), guidance=Spin()).simulate(log="full")
    same(compiled, python, ("rates", "torques", "pointing", "vibrations"))


def test_a_compiled_law_about_three_axes_is_that_of_python() -> None:
    gain = np.hstack([0.01 * np.eye(3), 0.16 * np.eye(3)])

    @FUNCTION
    def coupled(now, since, motion, states, hold):  # type: ignore[no-untyped-def]
        for axis in range(3):
            hold[axis] = (
                -0.01 * motion[axis] - 0.16 * (motion[3 + axis] - motion[9 + axis]) + motion[12 + axis]
            )

    class Coupled(flexsc.ThreeAxisLaw):
        period = 0.25

        def decide(self, event: flexsc.parts.ThreeAxisEvent) -> flexsc.ThreeAxisHold:
            return flexsc.ThreeAxisHold(
                accelerations=[
                    -gain[axis, axis] * event.angles[axis]
                    - gain[axis, 3 + axis] * (event.rates[axis] - event.goal_rates[axis])
                    + event.goal_accelerations[axis]
                    for axis in range(3)
                ]
            )

    scenario = observer(60.0)
    law = flexsc.CompiledThreeAxisLaw(coupled, period=0.25, command="acceleration")
    same(
        scenario.with_parts(law=law).simulate(log="full"),
        scenario.with_parts(law=Coupled()).simulate(log="full"),
        ("rates", "torques", "pointing"),
    )
    with pytest.raises(flexsc.ScenarioError, match=r"flexsc\.CompiledLaw"):
        shipped("rotation-robust").with_parts(law=law)

    @FUNCTION
    def broken(now, since, motion, states, hold):  # type: ignore[no-untyped-def]
        hold[1] = math.inf

    with pytest.raises(RuntimeError, match="a compiled law gave commands"):
        scenario.with_parts(law=flexsc.CompiledThreeAxisLaw(broken, period=0.25)).simulate()


def test_a_table_is_that_of_constant_torques_and_forces(tmp_path: Path) -> None:
    scenario = observer()
    torques = [[1.0, 1e-3], [3.5, -2e-3], [7.0, 0.0]]
    forces = [[0.0, 0.0, 0.0, 2e-3], [5.0, 1e-3, 0.0, 0.0]]
    bounds = [*zip(torques, [*torques[1:], [20.0, 0.0]], strict=True)]
    steps: list[dict[str, Any]] = [
        {"about": "pitch", "torque": torque, "from": start, "to": end} for (start, torque), (end, _) in bounds
    ]
    steps += [
        {"force": forces[0][1:], "point": "bench", "to": 5.0},
        {"force": forces[1][1:], "point": "bench", "from": 5.0},
    ]
    tables: list[dict[str, Any]] = [
        {"about": "pitch", "table": torques},
        {"table": forces, "point": "bench"},
    ]
    mine = scenario.with_("disturbance", tables).simulate(log="full")
    theirs = scenario.with_("disturbance", steps).simulate(log="full")
    same(mine, theirs, ("rates", "torques", "vibrations"))
    # A file with a header, beside the scenario.
    rows = "\n".join(",".join(map(str, row)) for row in torques)
    (tmp_path / "measured.csv").write_text(f"time,torque\n{rows}\n")
    (tmp_path / "study.toml").write_text(
        scenario.to_toml() + '\n[[disturbance]]\nabout = "pitch"\ntable = "measured.csv"\n'
    )
    of_file = flexsc.Scenario.load(tmp_path / "study.toml").simulate(log="full")
    same(of_file, scenario.with_("disturbance", tables[:1]).simulate(log="full"), ("rates", "torques"))
    # About one axis.
    one = shipped("rotation-robust").with_("duration", 20.0)
    table = one.with_("disturbance", [{"table": torques}]).simulate(log="full")
    constant = [{key: value for key, value in step.items() if key != "about"} for step in steps[:3]]
    same(table, one.with_("disturbance", constant).simulate(log="full"), ("rate", "torque"))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"about": "roll", "table": [[0.0, 1.0]]}, "must have from 2 to 1000000 rows, got 1"),
        ({"about": "roll", "table": [[1.0, 1.0], [1.0, 2.0]]}, "row 2: must have increasing times"),
        ({"about": "roll", "table": [[0.0, 1.0], [1.0, 1.0, 2.0]]}, "row 2: must have a time"),
        ({"about": "roll", "table": "nowhere.csv"}, "nowhere.csv"),
        ({"table": [[0.0, 1.0], [1.0, 2.0]]}, "must be given for a torque"),
        (
            {"force": [1, 0, 0], "table": [[0, 1, 0, 0], [1, 2, 0, 0]]},
            "takes the place of a constant `force`",
        ),
        ({"about": "roll", "table": [[0, 1, 0, 0], [1, 2, 0, 0]]}, "applies only to a torque"),
    ],
)
def test_a_table_that_is_none_is_refused(keys: dict[str, Any], words: str) -> None:
    with pytest.raises(flexsc.ScenarioError) as raised:
        observer().with_("disturbance", [keys])
    assert words in str(raised.value)
