"""What a user writes, for the type checker; it runs too."""

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import flexsc
import flexsc.parts
import numpy as np
import numpy.typing as npt

path = Path(__file__).parents[2] / "scenarios" / "relay-sampled.toml"
scenario: flexsc.Scenario = flexsc.Scenario.load(path).with_("duration", 600.0)
scenario = scenario.with_({"law.relay.k_t": 0.34, "seed": 3})
duration: float = scenario.duration
frequency: npt.NDArray[np.float64] = scenario.modes["frequency"]

result: flexsc.Result = scenario.simulate(run=1, log="full")
time: npt.NDArray[Any] = result["command"]["time_s"]
switchings: int = result.metrics["switchings"]
topics: list[str] = [topic for topic in result if topic in result]
with tempfile.TemporaryDirectory() as directory:
    size: int = result.to_mcap(Path(directory) / "run.mcap", log="events")
    log: flexsc.Log = flexsc.read_log(Path(directory) / "run.mcap")
    logged: flexsc.Metrics = log.metrics
end: str = log.metadata["end"]
unit: str = result.metrics.unit("switchings")
row: dict[str, dict[str, Any]] = result.at(12.5)
samples: flexsc.Samples = result.sample(np.linspace(0.0, 10.0, 5))
topic: flexsc.Topic = samples["attitude"]
capsule: object = topic.__arrow_c_stream__()
built: flexsc.Scenario = flexsc.Scenario(
    name="ringing",
    duration=100.0,
    body=flexsc.scenario.Planar(modes=[flexsc.scenario.Mode(frequency=0.44, gain=0.02, displacement=1e-5)]),
    law=flexsc.scenario.Open(),
    sensor=[flexsc.scenario.Sampled(period=0.5)],
)
built = built.with_("law", flexsc.scenario.Pd(k_p=1.0, k_d=1.0, period=0.5))
hashed: int = hash(built)
pd: flexsc.scenario.Pd = built.part("law", flexsc.scenario.Pd)
# A key with a default has a value in a scenario, and no None in its type.
wheels = flexsc.Scenario.example("earth-observer").part("actuator", flexsc.scenario.Wheels)
weaker: flexsc.scenario.Wheels = replace(wheels, torque=0.5 * wheels.torque)
damped: flexsc.Scenario = built.with_("law", replace(pd, k_d=2.0))
figures: list[str] = flexsc.plot.figures(result)
axes = flexsc.plot.draw(result, figures[0])
axes.set_title("mine")
again: flexsc.Scenario | None = log.scenario

table: flexsc.Table = flexsc.campaign(scenario, runs=range(4), jobs=2, seed=1)
mean: float = table.statistics()["duty"]["mean"]
duty: npt.NDArray[Any] = flexsc.sweep(scenario, "law.relay.k_t", np.linspace(0.3, 0.35, 3))["duty"]
swept: flexsc.Table = flexsc.sweep(scenario, "law.relay.k_t", [0.3, 0.35])
both: flexsc.Table = flexsc.sweep(scenario, {"law.relay.k_t": [0.3], "body.planar.angle": np.zeros(2)})
pairs: flexsc.Table = flexsc.sweep(scenario, points=[{"law.relay.k_t": 0.3, "seed": 2}])
ranges = {"law.relay.k_t": (0.28, 0.40), "body.planar.angle": (0.0, 1e-3)}
sobol: flexsc.Table = flexsc.sweep(scenario, ranges, sample=("sobol", 4), metrics=["duty"])
duties: npt.NDArray[np.float64] = flexsc.evaluate(scenario, ["law.relay.k_t"], [[0.3], [0.31]], "duty")
unit = flexsc.metrics()["duty"]["unit"]
slopes: flexsc.Sensitivities = flexsc.sensitivities(scenario, ["body.planar.inertia"], ["duty"], step=0.1)
slope: float = slopes["duty"]["body.planar.inertia"]
tuned: flexsc.Scenario = flexsc.optimise(scenario, ["law.relay.k_t"], "duty", maxiter=2).scenario
sim: flexsc.Simulator = flexsc.Simulator(scenario, run=1)
switched: bool = sim.run_until("switching", limit=100.0)
before: flexsc.Snapshot = sim.snapshot()
sim.step(1e-6, 0.5)
angle: float = float(sim.clone().state["angle"])
sim.restore(before)
sims: flexsc.Simulators = flexsc.Simulators(scenario, 4, jobs=1)
moved: flexsc.Quantities = sims.step(np.zeros(4), 0.5)
angles: npt.NDArray[np.float64] = sims.reset(sims.done)["angle"]
turn: flexsc.Scenario = flexsc.Scenario.load(path.with_name("rotation-sine.toml"))
turn = turn.with_({"manoeuvre.command": {"sine": {"suppress": 1}}, "manoeuvre.time": 40.0})
plan: flexsc.Plan = turn.plan(band=0.05)
command: npt.NDArray[Any] = plan.torque(np.linspace(0.0, 40.0, 5))
peak: float = plan["peak_torque_nm"]
rows: list[dict[str, Any]] = plan.compare()
model: flexsc.StateSpace = flexsc.from_state_space(np.array([[0, 1], [-4, -0.02]]), [[0], [1]], [[0, 1]])
structure: flexsc.Structure = model.structure(arm=2.0, inputs=("yaw",), outputs=("yaw",)).keep([0])
station: flexsc.Scenario = model.scenario(np.eye(3), thrust=1.0, arm=2.0, inputs=("yaw",), outputs=("yaw",))
with tempfile.TemporaryDirectory() as directory:
    modes: Path = flexsc.structure.write_scenario(station, Path(directory) / "station.toml")
    read: flexsc.Structure = flexsc.from_csv(modes, {"yaw": (2.0, 0.0, 0.0)})
try:
    flexsc.Scenario({"duration": 1.0})
except flexsc.ScenarioError as error:
    message: str = str(error)
else:
    raise AssertionError("a scenario needs a body")


class Damper(flexsc.Law):
    period = 0.5

    def decide(self, event: flexsc.parts.Event) -> flexsc.Hold:
        return flexsc.Hold(-1e-3 * event.angle - 1e-2 * event.rate, after=0.25)


own: flexsc.Scenario = scenario.with_parts(law=Damper())
brought: object = own.own_parts["law"]
held: float | None = flexsc.Hold(1e-3).torque
linear: flexsc.Linear = scenario.linearise(period=0.5)
pole: npt.NDArray[Any] = linear.poles()["pole"]
response: npt.NDArray[np.complex128] = linear.select(outputs=["angle"]).response([0.1, 0.2])
magnitude, phase = linear.select(outputs=["angle"]).bode()
phase.set_title("mine")
flexsc.plot.poles(linear, ax=magnitude)
here: npt.NDArray[np.float64] = linear.state_of(flexsc.Simulator(scenario))
system: npt.NDArray[np.float64] = linear.a
names: list[str] = [signal.name for signal in linear.states]
led: flexsc.Scenario = scenario.with_law(([], [], [], [[1e-3, 1e-2]]), period=0.5)


class Push(flexsc.DisturbanceModel):
    period = 0.5
    points = ("tip",)

    def act(self, truth: flexsc.parts.Truth) -> flexsc.Load:
        return flexsc.Load(force=[0.0, 1e-3, 0.0] if truth.sun is None else None)


class Still(flexsc.Guidance):
    def aim(self, sky: flexsc.parts.Sky) -> flexsc.Aim:
        return flexsc.Aim((1.0, 0.0, 0.0, 0.0), rate=np.zeros(3))


loads: flexsc.DisturbanceModel = flexsc.CompiledDisturbance(1, period=0.1, points=("tip",))
kept: flexsc.Samples | None = scenario.simulate(at=[1.0, 2.0]).samples
drawing: str = result.svg("angle")
ensemble = flexsc.campaign(scenario, 3, at=np.linspace(0.0, 1.0, 3), topics=["attitude"])
few: flexsc.Table = ensemble[ensemble["duty"] > 0.0][:2].sorted("duty")
without_noise: flexsc.Scenario = scenario.with_({"uncertain": None, "duration": 20.0})
if TYPE_CHECKING:
    result.plot("angle").savefig("angle.pdf")
    few.plot().savefig("few.pdf")
    log.plot().savefig("log.pdf")
