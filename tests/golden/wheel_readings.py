"""Two readings of the wheel study, [Wheel11] and [Sukhanov], by NumPy and SciPy alone.

    python3 tests/golden/wheel_readings.py            # both readings, statement by statement
    python3 tests/golden/wheel_readings.py edges      # the neighbours of the second reading
    python3 tests/golden/wheel_readings.py search     # the search for it, some ten minutes on one core
    python3 tests/golden/wheel_readings.py relay      # a relay on the line x + (k_2/k_1) x'
    python3 tests/golden/wheel_readings.py angles     # the golden numbers of tests/wheel.rs

The papers give the modes, k_1 = 7.5 and k_2 = 275, and neither the wheel's constants k'_u (rad/s^2) and
k'_omega (1/s) nor the period T0 (s). They state settling times, and that k_1 and k_2 give the rigid
spacecraft a transient that is optimal in time. The first reading fits the settling times, the second one
the printed condition: damping of 0.7, at which the angle of a linear loop enters a band of 5 % soonest.

Bodies are columns: a simulation advances all of them at once, by Runge-Kutta steps of at most `STEP` seconds.
"""

import re
import sys
from functools import partial
from pathlib import Path

import numpy as np
from scipy.linalg import expm

ROOT = Path(__file__).resolve().parents[2]
GAINS = np.array([1.44, 0.21, 0.165, 0.72])
FREQUENCIES = np.array([0.3, 0.8, 1.0, 2.0])
ANGLE, BAND, K_1, K_2 = 0.06, 0.003, 7.5, 275.0
STEP = 0.1
# k'_u, k'_omega, T0, derivative.
BY_TIMES = (5e-4, 1e-4, 0.3, "raw")
BY_CONDITION = (3.3e-5, 1.295e-2, 4.5, "difference")


def ramp(t):
    """Ratio of the frequencies to their first values: to a third within 200 s."""
    return 1.0 - 2.0 / 3.0 * min(t, 200.0) / 200.0


def constant(_):
    return 1.0


def settle(
    loop,
    *,
    w=0.3,
    k_d=0.0,
    ratio=constant,
    duration=600.0,
    modes=4,
    k_1=K_1,
    k_2=K_2,
    step=STEP,
    level=None,
    at=None,
):
    """Time (s) of the last departure from the band, for each column; infinite if outside at the end.

    `loop` is (k'_u, k'_omega, T0, derivative) with arrays of the first two; `w` the first frequency
    (rad/s), to which the others keep their ratios; `k_d` a number, an array, or a function of the
    dominant mode's frequency. With `level` (rad/s^2) a relay in place of the linear law commands plus or
    minus this moment. With `at`, a list of samples, the angles (rad) of the first column there are
    returned instead.
    """
    k_u, k_omega, period, derivative = loop
    w = np.asarray(w, float)
    first = k_d(0.3) if callable(k_d) else k_d
    shape = np.broadcast(np.atleast_1d(k_u), k_omega, w, first, 1.0 if level is None else level).shape
    angles, rates = np.zeros((1 + modes, *shape)), np.zeros((1 + modes, *shape))
    angles[0] = ANGLE
    share = np.concatenate([[1.0], GAINS[:modes]])[:, None]
    square = np.zeros_like(angles)
    square[1:] = (FREQUENCIES[:modes, None] * w / 0.3) ** 2
    count = int(np.ceil(period / step - 1e-9))
    h = period / count
    last, before, kept = np.zeros(shape), None, []
    for sample in range(round(duration / period)):
        t = sample * period
        if at is not None and sample in at:
            kept.append(float(angles.sum(0)[0]))
        extra = k_d(w * ratio(t)) if callable(k_d) else k_d
        y = angles.sum(0) + (extra * angles[1] if modes else 0.0)
        if derivative == "exact":
            slope = rates.sum(0) + (extra * rates[1] if modes else 0.0)
        else:
            slope = np.zeros(shape) if before is None else y - before
            slope = slope / period if derivative == "difference" else slope
        before = y
        command = -(k_1 * y + k_2 * slope)
        drive = k_u * command if level is None else level * np.sign(command)

        def motion(angles, rates, t, drive=drive):
            moment = drive - k_omega * rates.sum(0)
            return rates, share * moment - square * ratio(t) ** 2 * angles

        for part in range(count):
            now = t + part * h
            a1, r1 = motion(angles, rates, now)
            a2, r2 = motion(angles + h / 2 * a1, rates + h / 2 * r1, now + h / 2)
            a3, r3 = motion(angles + h / 2 * a2, rates + h / 2 * r2, now + h / 2)
            a4, r4 = motion(angles + h * a3, rates + h * r3, now + h)
            angles = angles + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            rates = rates + h / 6 * (r1 + 2 * r2 + 2 * r3 + r4)
            last = np.where(np.abs(angles.sum(0)) > BAND, now + h, last)
    if at is not None:
        return kept
    return np.where(last > duration - 2 * period, np.inf, last)


def radius(loop, w, k_d=0.0, modes=4):
    """Spectral radius of the sampled loop at constant frequencies, from the exponential of its motion."""
    k_u, k_omega, period, derivative = loop
    size = 2 + 2 * modes
    rate, total = np.zeros(size), np.zeros(size)
    rate[1::2], total[0::2] = 1.0, 1.0
    share = np.zeros(size)
    share[1::2] = np.concatenate([[1.0], GAINS[:modes]])
    free = np.zeros((size + 1, size + 1))
    free[:size, :size] = -k_omega * np.outer(share, rate)
    free[:size, size] = k_u * share
    for mode in range(1 + modes):
        free[2 * mode, 2 * mode + 1] += 1.0
        if mode:
            free[2 * mode + 1, 2 * mode] -= (FREQUENCIES[mode - 1] * w / 0.3) ** 2
    held = expm(free * period)
    flow, step = held[:size, :size], held[:size, size]
    y, slope = total.copy(), rate.copy()
    if modes:
        y[2] += k_d
        slope[3] += k_d
    if derivative == "exact":
        return np.abs(np.linalg.eigvals(flow - np.outer(step, K_1 * y + K_2 * slope))).max()
    k_d2 = K_2 / (period if derivative == "difference" else 1.0)
    whole = np.zeros((size + 1, size + 1))
    whole[:size, :size] = flow - np.outer(step, (K_1 + k_d2) * y)
    whole[:size, size], whole[size, :size] = step * k_d2, y
    return np.abs(np.linalg.eigvals(whole)).max()


def damping(loop):
    """Damping ratio of the rigid body under the continuous law."""
    k_u, k_omega, period, derivative = loop
    return (k_omega + k_u * K_2 * (period if derivative == "raw" else 1.0)) / (2.0 * np.sqrt(k_u * K_1))


def region(loop, frequencies, gains):
    """The longest run of gains that settle within 200 s in a stable loop, at each frequency, or None."""
    found = []
    for w in frequencies:
        met = settle(loop, w=w, k_d=gains, duration=700.0) <= 200.0
        met &= np.array([radius(loop, w, gain) < 1.0 for gain in gains])
        best, start = None, None
        for index, good in enumerate([*met, False]):
            if good and start is None:
                start = index
            elif not good and start is not None:
                if best is None or index - start > best[1] - best[0] + 1:
                    best = (start, index - 1)
                start = None
        found.append(None if best is None else (gains[best[0]], gains[best[1]]))
    return found


def schedule(frequencies, found):
    """The middle of the region over the frequency, which equations (10) and (12) prescribe."""
    pairs = [(w, sum(edges) / 2) for w, edges in zip(frequencies, found, strict=True) if edges is not None]
    at, middle = zip(*pairs, strict=True)
    return lambda w: np.interp(w, at, middle)


def one(*arguments, **options):
    return float(settle(*arguments, **options)[0])


def statements(loop):
    """Each printed statement with the numbers that decide it, and whether it holds."""
    few = np.round(np.arange(0.05, 0.3501, 0.01), 2)
    usual = np.round(np.arange(-1.0, 6.001, 0.05), 2)
    found = region(loop, few, usual)
    scheduled = one(loop, k_d=schedule(few, found), ratio=ramp, duration=1000.0)
    fixed, without = (one(loop, k_d=gain, ratio=ramp, duration=1000.0) for gain in (1.2, 0.0))
    rigid, slow = one(loop, modes=0), one(loop, w=0.05, duration=2000.0)
    others = [(1.0, 1.5), (1.0, 2.0), (1.0, 4.0), (0.7, 1.0)]
    weights = [
        (
            one(loop, modes=0, k_1=K_1 * a, k_2=K_2 * b, duration=1000.0),
            one(loop, w=0.05, k_1=K_1 * a, k_2=K_2 * b, duration=2000.0),
        )
        for a, b in others
    ]
    fast = {w: one(loop, w=w) for w in (0.1, 0.12, 0.15, 0.2, 0.3, 0.5, 1.0)}
    many = region(loop, np.round(np.arange(0.05, 1.001, 0.05), 2), np.round(np.arange(-1.0, 6.001, 0.05), 2))
    low = region(loop, (0.05, 0.3), np.round(np.arange(-6.0, 6.001, 0.1), 1))
    above = max(radius(loop, w) for w in np.arange(0.05, 1.001, 0.025))
    middle = found[25]
    bands = np.array(
        [
            [radius((*loop[:2], t, loop[3]), w) for w in np.arange(0.05, 0.3, 0.01)]
            for t in np.arange(1, 30.1, 1)
        ]
    )
    unstable = bool(np.any((bands[:, 1:-1] >= 1) & (bands[:, :1] < 1) & (bands[:, -1:] < 1)))
    zeta = damping(loop)
    return [
        (
            "k_1, k_2 optimal in time for the rigid body",
            f"damping {zeta:.3f}, T_r {rigid:.1f}",
            abs(zeta - 0.7) < 0.03,
        ),
        (
            "other weights damp the mode sooner and lengthen the rigid transient",
            "; ".join(
                f"k_1 x{a:g} k_2 x{b:g}: rigid {r:.0f}, mode {s:.0f}"
                for (a, b), (r, s) in zip(others, weights, strict=True)
            )
            + f" (rigid {rigid:.0f}, mode {slow:.0f})",
            all(r > 1.05 * rigid and s < slow for r, s in (weights[0], weights[3])),
        ),
        (
            "T_r at most that of the rigid body",
            f"{scheduled:.1f}, rigid {rigid:.1f}",
            scheduled <= 1.01 * rigid,
        ),
        ("0.2 rad/s: at most 200 s", f"{fast[0.2]:.1f}", fast[0.2] <= 200),
        (
            "from 0.15 rad/s: at most 200 s",
            ", ".join(f"{w}: {time:.1f}" for w, time in fast.items()),
            all((time <= 200) == (w >= 0.15) for w, time in fast.items()),
        ),
        (
            "0.05 rad/s: slow, stable",
            f"{slow:.1f}, radius {radius(loop, 0.05):.6f}",
            slow > 200 and radius(loop, 0.05) < 1,
        ),
        ("drifting, k_d = 1.2: over 300 s", f"{fixed:.1f}", fixed > 300),
        ("drifting, scheduled: about 170 s", f"{scheduled:.1f}", abs(scheduled / 170 - 1) < 0.03),
        ("the extra loop makes it settle", f"k_d = 0: {without:.1f}", without > 1.5 * scheduled),
        (
            "gains from 0.05 to 1 rad/s",
            str([None if e is None else tuple(map(float, e)) for e in many]),
            None not in many,
        ),
        ("k_d(0.3) = 1.2, the middle", str(middle), middle is not None and abs(sum(middle) / 2 - 1.2) < 0.11),
        ("gains below -1 are admissible", str(low), any(e is not None and e[0] < -1.05 for e in low)),
        ("the higher modes are stable up to 1 rad/s", f"largest radius {above:.6f}", above < 1),
        (
            "stable with k_d = 1.2",
            f"{radius(loop, 0.3, 1.2):.6f}, {radius(loop, 0.1, 1.2):.6f}",
            max(radius(loop, w, 1.2) for w in few) < 1,
        ),
        ("an unstable band for some period", "", unstable),
    ]


def both():
    for name, loop in (("by the settling times", BY_TIMES), ("by the printed condition", BY_CONDITION)):
        rows = statements(loop)
        print(f"{name}: k'_u {loop[0]:g} rad/s^2, k'_omega {loop[1]:g} 1/s, T0 {loop[2]:g} s, {loop[3]}")
        for text, numbers, met in rows:
            print(f"  {'yes' if met else 'no ':3} {text}: {numbers}")
        print(f"  {sum(met for _, _, met in rows)} of {len(rows)}", flush=True)


def edges():
    """The rigid damping and the period around the second reading."""
    usual = np.round(np.arange(-1.0, 6.001, 0.05), 2)
    k_u, _, period, derivative = BY_CONDITION
    cases = [(zeta, period) for zeta in (0.69, 0.695, 0.6975, 0.7, 0.7025, 0.705, 0.71)] + [
        (0.7, 4.4),
        (0.7, 4.6),
    ]
    for zeta, period in cases:
        loop = (k_u, 2 * zeta * np.sqrt(k_u * K_1) - k_u * K_2, period, derivative)
        found = region(loop, (0.3,), usual)[0]
        times = [one(loop, k_d=gain, ratio=ramp, duration=1000.0) for gain in (1.2, 0.0, -0.5)]
        print(
            f"damping {zeta:.4f} T0 {period}: rigid {one(loop, modes=0):.1f}, drifting {times},"
            f" region at 0.3: {found}",
            flush=True,
        )


def candidates(derivative, period):
    """Loops of a grid over k'_u and the rigid damping that meet four settling times."""
    natural, zeta = (
        x.ravel() for x in np.meshgrid(np.arange(0.0135, 0.0201, 0.0005), np.arange(0.5, 1.021, 0.02))
    )
    k_u = natural**2 / K_1
    k_omega = 2 * zeta * natural - k_u * K_2 * (period if derivative == "raw" else 1.0)
    kept = k_omega >= 0
    for options, least, greatest in (
        ({"modes": 0, "duration": 500.0}, 0, 210),
        ({"w": 0.2, "duration": 500.0}, 0, 205),
        ({"w": 0.05, "duration": 800.0}, 200, 1e9),
        ({"k_d": 1.2, "ratio": ramp}, 295, 590),
    ):
        k_u, k_omega = k_u[kept], k_omega[kept]
        if k_u.size == 0:
            return []
        with np.errstate(over="ignore", invalid="ignore"):
            time = settle((k_u, k_omega, period, derivative), **options)
        kept = (time > least) & (time <= greatest)
    return [(float(a), float(b), period, derivative) for a, b in zip(k_u[kept], k_omega[kept], strict=True)]


def search():
    for derivative in ("difference", "exact", "raw"):
        for period in (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 4.5, 5.0, 6.0, 8.0, 10.0):
            for loop in candidates(derivative, period):
                times = [one(loop, k_d=gain, ratio=ramp) for gain in (1.2, 0.0, -0.5)]
                fast = [one(loop, w=w, duration=500.0) for w in (0.15, 0.12)]
                met = sum(
                    (
                        times[0] > 300,
                        times[1] > 1.4 * times[2],
                        fast[0] <= 200 < fast[1],
                        abs(damping(loop) - 0.7) < 0.03,
                    )
                )
                print(
                    f"{derivative} T0 {period} k'_u {loop[0]:.3e} k'_omega {loop[1]:.3e}"
                    f" damping {damping(loop):.2f}: drifting {times[0]:.0f}, {times[1]:.0f}, {times[2]:.0f};"
                    f" 0.15 and 0.12 rad/s {fast[0]:.0f}, {fast[1]:.0f}; {met} of 4",
                    flush=True,
                )


def relay():
    """A relay that reverses at half the angle, the time-optimal one of a rigid body."""
    line = K_2 / K_1
    level = ANGLE / (4.0 * line**2)
    print(f"level {level:.4e} rad/s^2, rigid transient {2.0 * np.sqrt(ANGLE / level):.1f} s")
    for period in (0.05, 0.3, 1.0, 2.0, 4.5):
        for derivative in ("exact", "difference"):
            for factor in (1.0, 1.5, 2.0):
                loop = (0.0, 0.0, period, derivative)
                options = {"level": factor * level, "step": 0.05}
                row = [one(loop, modes=0, **options), one(loop, w=0.2, duration=1000.0, **options)]
                row += [
                    one(loop, k_d=gain, ratio=ramp, duration=1000.0, **options) for gain in (1.2, 0.0, -0.5)
                ]
                print(
                    f"T0 {period} {derivative} level x{factor}: rigid, 0.2 rad/s, drifting 1.2, 0, -0.5:"
                    f" {np.round(row, 1)}",
                    flush=True,
                )


def angles():
    """Closed-loop angles (rad) of the second reading at multiples of 45 s, and its settling times (s)."""
    samples, fine = [10, 20, 40, 60], {"duration": 275.0, "step": 0.0045}
    for w, k_d in ((0.3, 0.0), (0.2, 0.0), (0.1, 0.0), (0.05, 0.0), (0.3, 1.2)):
        print(f"{w} rad/s, k_d {k_d}: {settle(BY_CONDITION, w=w, k_d=k_d, at=samples, **fine)}")
    scenario = (ROOT / "scenarios" / "wheel-scheduled-gain.toml").read_text("utf-8")
    points = np.array(re.findall(r"frequency = ([\d.]+), gain = (-?[\d.]+) }", scenario), float)
    by_table = partial(np.interp, xp=points[:, 0], fp=points[:, 1])
    for name, k_d in (("1.2", 1.2), ("0", 0.0), ("-0.5", -0.5), ("schedule", by_table)):
        print(f"drifting, k_d {name}: {settle(BY_CONDITION, k_d=k_d, ratio=ramp, at=samples, **fine)}")
        print(f"  settles at {one(BY_CONDITION, k_d=k_d, ratio=ramp, step=0.01):.2f}")
    for w in (0.2, 0.05):
        print(f"{w} rad/s settles at {one(BY_CONDITION, w=w, step=0.01):.2f}")


if __name__ == "__main__":
    {"angles": angles, "edges": edges, "search": search, "relay": relay}.get(
        (sys.argv[1:] or [""])[0], both
    )()
