"""Measures what a step of many runs together costs: CPU time of all threads, whatever else runs.

pip install . 'flexsc[gym]'
python3 benches/stepping.py        # half a minute on two cores; prints the times of docs/stepping.md
"""

import time
from collections.abc import Callable

import flexsc
import numpy as np
from flexsc.gym import SpacecraftEnv, SpacecraftVectorEnv

STEPS = 200_000
COPIES = 1000

WHEELS = {"wheels": {"arrangement": "pyramid", "inertia": 0.05, "torque": 0.5, "momentum": 1000.0}}


def with_wheels() -> flexsc.Scenario:
    """Three axes with four clamped modes, four wheels and nothing else."""
    values = flexsc.Scenario.example("four-clamped-modes").to_dict()
    values |= {"name": "wheels", "law": {"open": {}}, "actuator": WHEELS, "duration": 1e4}
    return flexsc.Scenario(values)


def cost(step: Callable[[int], object], copies: int) -> tuple[float, float]:
    """CPU time and wall time of a step of one copy (us)."""
    step(0)
    count = max(1, STEPS // copies)
    cpu, wall = time.process_time(), time.perf_counter()
    for index in range(1, count + 1):
        step(index)
    each = 1e6 / (count * copies)
    return (time.process_time() - cpu) * each, (time.perf_counter() - wall) * each


def main() -> None:
    scenario = with_wheels()
    random = np.random.default_rng(1)
    print("| | copies | CPU time of a step (us) | wall time (us) |")
    print("|---|---|---|---|")

    def told(name: str, copies: int, step: Callable[[int], object]) -> None:
        cpu, wall = cost(step, copies)
        print(f"| {name} | {copies} | {cpu:.2f} | {wall:.2f} |", flush=True)

    for copies in (COPIES, 10_000):
        sims = flexsc.Simulators(scenario, copies)
        commands = random.uniform(-0.2, 0.2, (8, copies, 3))
        told("new commands every 0.1 s", copies, lambda index, s=sims, c=commands: s.step(c[index % 8], 0.1))
        told("the same command", copies, lambda index, s=sims: s.step(None, 0.1))
    sims = flexsc.Simulators(flexsc.Scenario.example("four-clamped-modes").with_("duration", 1e4), COPIES)
    told("the law of the scenario, each second", COPIES, lambda index: sims.step(None, 0.1))
    envs = SpacecraftVectorEnv(scenario, num_envs=COPIES)
    envs.reset(seed=1)
    actions = random.uniform(-1.0, 1.0, (8, COPIES, 3))
    told("`SpacecraftVectorEnv`", COPIES, lambda index: envs.step(actions[index % 8]))
    sim, command = flexsc.Simulator(scenario), np.array([0.1, 0.0, -0.1])
    told("one `Simulator`, state read", 1, lambda index: (sim.step(command, 0.05), sim.state["rate"]))
    sim = flexsc.Simulator(scenario)
    told("one `Simulator`", 1, lambda index: sim.step(command, 0.05))
    env = SpacecraftEnv(scenario, dt=0.05)
    env.reset(seed=1)
    action = np.array([0.01, 0.0, -0.01], dtype=np.float32)
    told("one `SpacecraftEnv`", 1, lambda index: env.step(action))


if __name__ == "__main__":
    main()
