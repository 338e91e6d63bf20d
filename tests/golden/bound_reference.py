"""Golden numbers of tests/bound.rs: SciPy's exponentials of state matrices, and dense sums over time.

The range of an output is max over x(0) and u of c e^(At) x(0) + int c e^(A(t - s)) b u(s) ds. Its rows are
stepped with expm(A h). Integrals of |h| are Simpson sums over steps of h = 1e-4 s, except where h changes its
sign: linear there. Extremes over time are those of a parabola through the largest sample and its
neighbours. `python tests/golden/bound_reference.py` writes tests/golden/bound.csv.
"""

from pathlib import Path

import numpy as np
import tomllib
from scipy.linalg import expm

ROOT = Path(__file__).parents[2]
STEP = 1e-4


def system(modes, gyro, jets, axis, rate, factors=(1.0, 1.0)):
    """Return A, B and c of the modes alone, with the output about an axis at the sensor."""
    count = len(modes)
    a, b, c = np.zeros((2 * count, 2 * count)), np.zeros((2 * count, 3)), np.zeros(2 * count)
    for k, mode in enumerate(modes):
        w, zeta = mode["frequency"] * factors[0], mode["damping"] * factors[1]
        a[2 * k, 2 * k + 1] = 1.0
        a[2 * k + 1, 2 * k : 2 * k + 2] = [-w * w, -2.0 * zeta * w]
        b[2 * k + 1] = mode["shapes"][jets]["rotation"]
        c[2 * k + rate] = mode["shapes"][gyro]["rotation"][axis]
    return a, b, c


def rows(a, c, until):
    """Return c e^(At) at steps from 0 to `until`."""
    count = round(until / STEP)
    step, block = expm(a * STEP), [c]
    for _ in range(999):
        block.append(block[-1] @ step)
    block = np.array(block)
    large, found = expm(a * STEP * 1000), [block]
    while 1000 * len(found) <= count:
        found.append(found[-1] @ large)
    return np.concatenate(found)[: count + 1]


def ranges(a, b, c, start, constant, varying, until):
    """Return the times, and the lower and upper end of the range at each."""
    g = rows(a, c, until)
    h = g @ b
    middle = (g[:-1] @ expm(a * STEP / 2)) @ b
    del g
    simpson = STEP / 6.0 * (h[:-1] + 4.0 * middle + h[1:])
    size = np.abs(simpson)
    crossed = np.sign(h[:-1]) != np.sign(h[1:])
    first, last = np.abs(h[:-1]), np.abs(h[1:])
    linear = STEP * 0.5 * (first**2 + last**2) / np.where(crossed, first + last, 1.0)
    size = np.where(crossed, linear, size)
    step = np.concatenate([np.zeros((1, 3)), np.cumsum(simpson, axis=0)])
    reach = np.concatenate([np.zeros((1, 3)), np.cumsum(size, axis=0)])
    g = rows(a, c, until)
    low, high = np.zeros(len(g)), np.zeros(len(g))
    for ends, values in [(start.T, g), (constant.T, step)]:
        low += np.minimum(values * ends[0], values * ends[1]).sum(axis=1)
        high += np.maximum(values * ends[0], values * ends[1]).sum(axis=1)
    mean, half = varying.mean(axis=1), 0.5 * (varying[:, 1] - varying[:, 0])
    low += step @ mean - reach @ half
    high += step @ mean + reach @ half
    return np.arange(len(g)) * STEP, low, high


def peak(values):
    """Return the largest value of a parabola through the largest sample and its neighbours."""
    k = int(np.argmax(values))
    if k in (0, len(values) - 1):
        return values[k]
    before, at, after = values[k - 1 : k + 2]
    bend = 2.0 * at - before - after
    return at + (after - before) ** 2 / (8.0 * bend) if bend > 0.0 else at


def claim(scenario, index, factors=(1.0, 1.0)):
    """Return the range of a claim of a scenario, and the times at which its ends pass given parts of it."""
    spec, body = scenario["bound"][index], scenario["body"]["spatial"]
    axis = ["roll", "pitch", "yaw"].index(spec["output"].removesuffix("_rate"))
    rate = int(spec["output"].endswith("_rate"))
    a, b, c = system(body["modes"], "camera", "wheels", axis, rate, factors)
    start = np.array([spec["start"][key] for _ in body["modes"] for key in ("displacements", "rates")])
    names = [f"torque_{name}" for name in ("roll", "pitch", "yaw")]
    inputs = [
        np.array([spec.get(key, {}).get(name, [0.0, 0.0]) for name in names], dtype=float)
        for key in ("constant_inputs", "varying_inputs")
    ]
    times, low, high = ranges(a, b, c, start, *inputs, spec.get("until", scenario["duration"]))
    least, most = -peak(-low), peak(high)
    limit = 0.8 * most
    k = int(np.argmax(high > limit))
    crossing = times[k - 1] + STEP * (limit - high[k - 1]) / (high[k] - high[k - 1])
    return least, most, limit, crossing


def main() -> None:
    """Write the golden numbers."""
    scenario = tomllib.loads((ROOT / "scenarios/bounded-jitter.toml").read_text())
    lines = ["claim,frequency_factor,damping_factor,low,high,limit,crossing_s"]
    for index, factors in [(0, (1.0, 1.0)), (1, (1.0, 1.0)), (1, (0.98, 0.8)), (1, (1.02, 1.2))]:
        numbers = ",".join(f"{number:.10e}" for number in claim(scenario, index, factors))
        lines.append(f"{index},{factors[0]},{factors[1]},{numbers}")
    (ROOT / "tests/golden/bound.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
