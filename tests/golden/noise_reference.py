"""Golden numbers of tests/spectra.rs, with flexsc and SciPy installed: noise of loops by Lyapunov equations.

Python assembles the loops, cut open at the measurement, with NumPy; it has the body and the settled gains of
filters from the engine. The inputs at that break are measured angles and rates, where the noise of the sensor
enters. `noise.csv` has the standard deviation of each measured output at the samples for each source, and
that in the middle between two samples from all noise (`middle`).
"""

from pathlib import Path

import flexsc
import numpy as np
from scipy.linalg import expm, solve_discrete_lyapunov

ROOT = Path(__file__).parents[2]


def rows(name: str, noises: dict[str, tuple[int, float]]) -> list[str]:
    """Rows of a scenario whose sources have a first input (0: angles, 1: rates) and a deviation."""
    scenario = flexsc.Scenario.load(ROOT / "scenarios" / f"{name}.toml")
    opened = scenario.linearise(loop="measurement")
    closed = opened.a - opened.b @ opened.c
    lines = []
    for source, (first, deviation) in noises.items():
        into = opened.b[:, first::2] * deviation
        covariance = solve_discrete_lyapunov(closed, into @ into.T, method="direct")
        variances = np.diag(opened.c @ covariance @ opened.c.T)
        lines += [
            f"{name},{output.name},{source},{float(np.sqrt(variance))!r}"
            for output, variance in zip(opened.outputs, variances.tolist(), strict=True)
        ]
    return lines


def middle(name: str) -> list[str]:
    """Deviations of the angles in the middle of a sample, from all noise of a body without delay."""
    scenario = flexsc.Scenario.load(ROOT / "scenarios" / f"{name}.toml")
    opened = scenario.linearise(loop="measurement")
    body = scenario.linearise().select(outputs=[output.name for output in opened.outputs])
    order = len(body.a)
    deviations = np.array([1e-4, 3e-5] * 3)
    into = opened.b * deviations
    closed = opened.a - opened.b @ opened.c
    covariance = solve_discrete_lyapunov(closed, into @ into.T, method="direct")
    # The torque held over a sample, from the change of the body over it.
    whole = expm(np.block([[body.a, body.b], [np.zeros((3, order + 3))]]) * opened.period)
    half = expm(np.block([[body.a, body.b], [np.zeros((3, order + 3))]]) * 0.5 * opened.period)
    flow, forced = whole[:order, :order], whole[:order, order:]
    torque = np.linalg.pinv(forced)
    size = len(closed)
    by_state = torque @ (closed[:order] - flow @ np.eye(order, size))
    by_noise = torque @ into[:order]
    at_state = half[:order, :order] @ np.eye(order, size) + half[:order, order:] @ by_state
    at_noise = half[:order, order:] @ by_noise
    variances = np.diag(
        body.c @ (at_state @ covariance @ at_state.T + at_noise @ at_noise.T) @ body.c.T
    ).tolist()
    return [
        f"{name},{output.name},middle,{float(np.sqrt(variance))!r}"
        for output, variance in zip(opened.outputs, variances, strict=True)
    ]


def main() -> None:
    lines = ["scenario,output,source,deviation"]
    lines += rows(
        "attitude-hold", {"sensor.sampled.noise": (0, 1e-4), "sensor.sampled.rate_noise": (1, 3e-5)}
    )
    lines += rows("slew-wheel-lqg", {"sensor.sampled.noise": (0, 1e-5)})
    lines += middle("attitude-hold")
    (ROOT / "tests/golden/noise.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
