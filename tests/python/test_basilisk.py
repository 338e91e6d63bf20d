"""A spacecraft and a law of flexsc in simulations of Basilisk."""

from __future__ import annotations

import re
import warnings
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped

pytest.importorskip("Basilisk", reason="Basilisk is not installed: pip install bsk")
# Its modules warn about NumPy and SWIG while they are imported.
pytestmark = pytest.mark.filterwarnings("ignore")

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def basilisk() -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        guest: Any = import_module("flexsc.basilisk")
        messaging: Any = import_module("Basilisk.architecture.messaging")
        force: Any = import_module("Basilisk.simulation.extForceTorque")
        craft: Any = import_module("Basilisk.simulation.spacecraft")
        navigation: Any = import_module("Basilisk.simulation.simpleNav")
        simulations: Any = import_module("Basilisk.utilities.SimulationBaseClass")
        macros: Any = import_module("Basilisk.utilities.macros")

    return SimpleNamespace(
        guest=guest,
        messages=messaging,
        base=simulations,
        nano=macros.sec2nano,
        Spacecraft=craft.Spacecraft,
        Torque=force.ExtForceTorque,
        Navigation=navigation.SimpleNav,
    )


def task(basilisk: Any, step: float, *models: Any) -> Any:
    simulation = basilisk.base.SimBaseClass()
    process = simulation.CreateNewProcess("process")
    process.addTask(simulation.CreateNewTask("task", basilisk.nano(step)))
    for model in models:
        simulation.AddModelToTask("task", model)
    return simulation


def advance(basilisk: Any, simulation: Any, time: float) -> None:
    simulation.ConfigureStopTime(basilisk.nano(time))
    simulation.ExecuteSimulation()


def test_torques_of_messages_act_like_those_of_a_simulator(basilisk: Any, tmp_path: Path) -> None:
    scenario = shipped("earth-observer").with_("duration", 20.0)
    spacecraft = basilisk.guest.Spacecraft(scenario)
    torque = basilisk.messages.CmdTorqueBodyMsg()
    spacecraft.cmdTorqueInMsg.subscribeTo(torque)
    simulation = task(basilisk, 0.25, spacecraft)
    recorder = spacecraft.scStateOutMsg.recorder()
    simulation.AddModelToTask("task", recorder)
    simulation.InitializeSimulation()
    own = flexsc.Simulator(scenario)
    for cycle in range(80):
        command = [0.01 * np.sin(cycle), -0.02, 0.005 * cycle]
        payload = basilisk.messages.CmdTorqueBodyMsgPayload()
        payload.torqueRequestBody = command
        torque.write(payload, basilisk.nano(0.25 * cycle))
        advance(basilisk, simulation, 0.25 * (cycle + 1))
        own.step(command, 0.25)
        attitude = basilisk.guest.attitude_of(spacecraft.scStateOutMsg.read().sigma_BN)
        np.testing.assert_allclose(attitude, own.state["attitude"], rtol=0, atol=1e-15)
        np.testing.assert_array_equal(spacecraft.scStateOutMsg.read().omega_BN_B, own.state["rate"])
        speeds = spacecraft.rwSpeedOutMsg.read().wheelSpeeds
        np.testing.assert_array_equal(speeds[:4], own.state["wheel_speeds"])
    assert len(recorder.times()) == 81
    spacecraft.simulator.to_mcap(tmp_path / "guest.mcap", "full")
    own.to_mcap(tmp_path / "own.mcap", "full")
    assert (tmp_path / "guest.mcap").read_bytes() == (tmp_path / "own.mcap").read_bytes()


def test_a_rigid_body_tumbles_as_in_basilisk(basilisk: Any) -> None:
    inertia = [[900.0, 12.0, -8.0], [12.0, 600.0, 5.0], [-8.0, 5.0, 1100.0]]
    rate = [0.02, -0.05, 0.03]
    body = {"spatial": {"inertia": inertia, "rate": rate}}
    scenario = flexsc.Scenario({"duration": 60.0, "law": {"open": {}}, "body": body}, name="tumble")
    guest = basilisk.guest.Spacecraft(scenario)
    own = basilisk.Spacecraft()
    own.hub.mHub = 100.0
    own.hub.IHubPntBc_B = inertia
    own.hub.omega_BN_BInit = [[value] for value in rate]
    simulation = task(basilisk, 0.02, guest, own)
    simulation.InitializeSimulation()
    advance(basilisk, simulation, 60.0)
    one, other = guest.scStateOutMsg.read(), own.scStateOutMsg.read()
    np.testing.assert_allclose(one.sigma_BN, other.sigma_BN, rtol=0, atol=1e-9)
    np.testing.assert_allclose(one.omega_BN_B, other.omega_BN_B, rtol=0, atol=1e-10)


def test_a_law_of_flexsc_holds_a_spacecraft_of_basilisk(basilisk: Any) -> None:
    inertia = [[250.0, 6.0, -4.0], [6.0, 300.0, 5.0], [-4.0, 5.0, 220.0]]
    keys: dict[str, Any] = {
        "duration": 200.0,
        "body": {"spatial": {"inertia": inertia}},
        "law": {"attitude": {"period": 0.5, "bandwidth": 0.1, "damping": 0.8}},
        "sensor": {"sampled": {"period": 0.25, "rate_noise": 1e-9}},
    }
    law = basilisk.guest.Controller(flexsc.Scenario(keys, name="hold"), period=0.25)
    craft, effector = basilisk.Spacecraft(), basilisk.Torque()
    craft.hub.mHub = 100.0
    craft.hub.IHubPntBc_B = inertia
    craft.hub.sigma_BNInit = [[0.1], [-0.05], [0.08]]
    craft.addDynamicEffector(effector)
    effector.cmdTorqueInMsg.subscribeTo(law.cmdTorqueOutMsg)
    navigation = basilisk.Navigation()
    navigation.scStateInMsg.subscribeTo(craft.scStateOutMsg)
    law.attNavInMsg.subscribeTo(navigation.attOutMsg)
    simulation = task(basilisk, 0.25, navigation, law, effector, craft)
    simulation.InitializeSimulation()
    advance(basilisk, simulation, 0.0)
    first = np.array(law.cmdTorqueOutMsg.read().torqueRequestBody)
    error = 2.0 * np.array(basilisk.guest.attitude_of([0.1, -0.05, 0.08])[1:])
    np.testing.assert_allclose(first, np.array(inertia) @ (-(0.1**2) * error), rtol=1e-12)
    advance(basilisk, simulation, 150.0)
    final = craft.scStateOutMsg.read()
    assert np.linalg.norm(final.sigma_BN) < 1e-5
    assert np.linalg.norm(final.omega_BN_B) < 1e-5
    # It begins anew.
    simulation.InitializeSimulation()
    advance(basilisk, simulation, 0.0)
    np.testing.assert_array_equal(law.cmdTorqueOutMsg.read().torqueRequestBody, first)


def test_what_does_not_fit_is_refused(basilisk: Any) -> None:
    with pytest.raises(ValueError, match="has one axis"):
        basilisk.guest.Spacecraft(shipped("relay-fixed"))
    with pytest.raises(ValueError, match="estimator reads sensors of its own"):
        basilisk.guest.Controller(shipped("earth-observer"), 0.25)
    short = basilisk.guest.Spacecraft(shipped("earth-observer").with_("duration", 1.0))
    short.Reset(0)
    with pytest.raises(ValueError, match="lasts 1 s: set a longer `duration`"):
        short.UpdateState(basilisk.nano(2.0))


def test_the_page_runs(basilisk: Any, capsys: pytest.CaptureFixture[str]) -> None:
    page = (ROOT / "docs" / "basilisk.md").read_text("utf-8")
    names: dict[str, Any] = {}
    for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(block, names)
    printed = capsys.readouterr().out
    rate, end, error = map(float, re.findall(r"[\d.]+e-\d+", printed))
    assert 5e-3 < rate < 9e-3
    assert end < 1e-4
    assert error < 1e-3
