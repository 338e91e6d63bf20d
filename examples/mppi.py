"""A slew by model-predictive path-integral control (MPPI), whose roll-outs are of the spacecraft itself.

A spacecraft with four flexible modes turns by 82 degrees under at most 1 N m about each axis. Each second the
controller tries hundreds of sequences of torques from the present state, and weights them by their costs.

    python examples/mppi.py              # some seconds
    python examples/mppi.py 128 40       # roll-outs, seconds
"""

import sys

import flexsc
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

DT = 1.0  # s, over which a torque is held
HORIZON = 20  # steps
LIMIT = 1.0  # N m
TEMPERATURE = 0.05  # of the standard deviation of the costs


def cost(state: flexsc.Quantities) -> Array:
    """Return the costs of states: squares of the errors (rad), the rates (rad/s) and the modes' rates."""
    squares: Array = (state["error"] ** 2).sum(1) + 20.0 * (state["rate"] ** 2).sum(1)
    squares += 0.01 * (state["mode_rates"] ** 2).sum(1)
    return squares


def planned(
    rollouts: flexsc.Simulators, sim: flexsc.Simulator, mean: Array, random: np.random.Generator
) -> Array:
    """Return the mean torques (N m) of roll-outs from the present state, weighted by their costs."""
    rollouts.restore(sim)
    # The search is as wide as the target is far; one roll-out keeps the last plan.
    error, rate = (float(np.linalg.norm(sim.state[name])) for name in ("error", "rate"))
    spread = min(0.5, 0.02 + error + 5.0 * rate)
    tried = mean[:, None] + spread * random.normal(size=(HORIZON, len(rollouts), 3))
    tried[:, 0] = mean
    tried = np.clip(tried, -LIMIT, LIMIT)
    costs = np.zeros(len(rollouts))
    for torques in tried:
        costs += cost(rollouts.step(torques, DT))
    costs += 10.0 * cost(rollouts.state)
    weights = np.exp(-(costs - costs.min()) / (TEMPERATURE * costs.std()))
    mean_torques: Array = np.einsum("r,hra->ha", weights / weights.sum(), tried)
    return mean_torques


def main() -> None:
    count, duration = (int(sys.argv[1]), float(sys.argv[2])) if len(sys.argv) == 3 else (256, 80.0)
    sim = flexsc.Simulator(flexsc.Scenario.example("four-clamped-modes").with_("duration", 1000.0))
    rollouts = flexsc.Simulators.of(sim, count)
    random, mean = np.random.default_rng(1), np.zeros((HORIZON, 3))
    print("time (s)  error (rad)  rate (rad/s)  largest torque (N m)")
    while True:
        error, rate = (float(np.linalg.norm(sim.state[name])) for name in ("error", "rate"))
        if sim.time % 10.0 == 0.0:
            print(f"{sim.time:8.0f}  {error:11.5f}  {rate:12.6f}  {np.abs(mean[0]).max():20.3f}")
        if sim.time >= duration:
            break
        mean = planned(rollouts, sim, mean, random)
        sim.step(mean[0], DT)
        # The next plan begins with the rest of this one.
        mean = np.vstack([mean[1:], np.zeros(3)])


if __name__ == "__main__":
    main()
