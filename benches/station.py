"""700 s of the space station by NumPy and by Basilisk, beside the engine's benchmark.

pip install mpmath numpy scipy bsk   # Basilisk may be left out
python3 benches/station.py           # Python 3.11 or newer
"""

import contextlib
import io
import sys
import time
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parent.parent
DURATION, STEP = 700.0, 0.02


def by_numpy():
    """CPU time (s) of the loop of iss-manoeuvre-off as tests/golden has it: RK4 of 0.01 s, exact modes."""
    sys.path.insert(0, str(ROOT / "tests" / "golden"))
    import station_oracle

    began = time.process_time()
    with contextlib.redirect_stdout(io.StringIO()):
        station_oracle.station()
    return time.process_time() - began


def by_basilisk():
    """CPU time (s) of Basilisk's hub and a spring-mass-damper for each mode, RK4 of 0.02 s, no law."""
    from Basilisk.simulation import linearSpringMassDamper, spacecraft
    from Basilisk.utilities import SimulationBaseClass, macros

    study = tomllib.loads((ROOT / "scenarios" / "iss-manoeuvre-off.toml").read_text())
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("dynamics")
    process.addTask(simulation.CreateNewTask("task", macros.sec2nano(STEP)))
    hub = spacecraft.Spacecraft()
    hub.hub.mHub = 382e3
    hub.hub.IHubPntBc_B = study["body"]["spatial"]["inertia"]
    hub.hub.omega_BN_BInit = [[1e-5], [3e-4], [-7e-4]]
    effectors = []
    for index, mode in enumerate(study["body"]["spatial"]["modes"]):
        effector, w, mass = linearSpringMassDamper.LinearSpringMassDamper(), mode["frequency"], 500.0
        effector.k, effector.c, effector.massInit = mass * w * w, 2 * mode["damping"] * w * mass, mass
        effector.r_PB_B = [[-20.0 + 3 * index], [10.0], [0.0]]
        effector.pHat_B = [[0.0], [0.0], [1.0]]
        effector.rhoInit = 0.01
        hub.addStateEffector(effector)
        effectors.append(effector)
    simulation.AddModelToTask("task", hub)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(DURATION))
    began = time.process_time()
    simulation.ExecuteSimulation()
    return time.process_time() - began


def peers():
    """Name and CPU time (s) of each peer; None for one that is not installed."""
    rows = []
    for name, work in [
        ("NumPy, the same loop, RK4 of 0.01 s and exact modes", by_numpy),
        ("Basilisk, hub and 12 effectors alone, RK4 of 0.02 s", by_basilisk),
    ]:
        try:
            rows.append((name, work()))
        except ModuleNotFoundError:
            rows.append((name, None))
    return rows


if __name__ == "__main__":
    for name, seconds in peers():
        print(f"{name}: {'not installed' if seconds is None else f'{seconds:.3g} s'}")
