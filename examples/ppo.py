"""An agent of Stable-Baselines3 learns to point a flexible spacecraft by proximal policy optimisation (PPO).

The spacecraft has to turn by 82 degrees to its target, under at most 1 N m about each axis, commanded once a
second; its four modes vibrate in the turn. Each episode draws the initial rate and the lowest frequency.

    pip install 'flexsc[gym]' stable-baselines3
    python examples/ppo.py               # 100 000 steps, two minutes
    python examples/ppo.py 1000000
"""

import sys
from typing import Any

import flexsc
import numpy as np
import torch
from flexsc.gym import Quadratic, SpacecraftEnv, stable_baselines
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecMonitor

# An error of 0.5 rad and a rate of 0.2 rad/s cost 1 each.
OPTIONS: dict[str, Any] = {"dt": 1.0, "limit": 1.0, "reward": Quadratic(error=0.5, rate=0.2)}
EPISODES = 16


def spacecraft() -> flexsc.Scenario:
    """100 s of the spacecraft with keys that each episode draws (rad/s)."""
    drawn: dict[str, object] = {f"spacecraft.rate[{axis}]": {"uniform": [-0.004, 0.004]} for axis in range(3)}
    drawn["appendage[0].modes[0].frequency"] = {"uniform": [0.65, 0.85]}
    keys = {"spacecraft.rate": [0.0, 0.0, 0.0], "duration": 100.0, "uncertain": drawn}
    return flexsc.Scenario.example("four-clamped-modes").with_(keys)


def flown(model: PPO, scenario: flexsc.Scenario) -> tuple[float, float]:
    """Return the mean return of episodes without exploration, and the mean error at their end (rad)."""
    env = SpacecraftEnv(scenario, **OPTIONS)
    returns, errors = [], []
    for episode in range(EPISODES):
        observation, _ = env.reset(seed=1000 + episode)
        total, ended = 0.0, False
        while not ended:
            action, _ = model.predict(observation, deterministic=True)
            observation, reward, terminated, truncated, _ = env.step(action)
            total, ended = total + reward, terminated or truncated
        returns.append(total)
        errors.append(np.linalg.norm(env.simulators.state["error"]))
    return float(np.mean(returns)), float(np.mean(errors))


def main() -> None:
    # Networks as small as these are fastest on one thread.
    torch.set_num_threads(1)
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    scenario = spacecraft()
    venv = VecMonitor(stable_baselines(scenario, 32, **OPTIONS))
    model = PPO(
        "MlpPolicy",
        venv,
        learning_rate=1e-3,
        n_steps=64,
        batch_size=512,
        gamma=0.95,
        seed=1,
        device="cpu",
        policy_kwargs={"log_std_init": -0.5},
    )
    print(f"{'':>16}  mean return  mean error at the end (rad)")
    for name, learnt in ("before", 0), (f"{steps} steps", steps):
        if learnt:
            model.learn(learnt)
        print("{:>16}  {:11.1f}  {:.4f}".format(name, *flown(model, scenario)), flush=True)


if __name__ == "__main__":
    main()
