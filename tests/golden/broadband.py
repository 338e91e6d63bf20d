"""Reference of tests/machines.rs: the bench of optics.py under broadband forces and lines on its wheel
unit, in a sampled loop.

White noise through the filters of the density's corners, the free body without its translation, and a law
on the hub's rotation whose torque is held over a sample: covariances by Van Loan and a discrete Lyapunov
equation, over time by quadrature. The windows are those that begin at any time: a mean over their starts.
pip install numpy scipy
"""

from functools import cache
from itertools import pairwise

import numpy as np
from optics import SPIN, Bench, across
from scipy.linalg import expm, solve_discrete_lyapunov
from scipy.optimize import minimize_scalar

HUB = np.diag([4.2, 3.9, 4.8])
LOWER, UPPER = 2 * np.pi * 5.0, 2 * np.pi * 120.0
DENSITY = 1e-6
BANDWIDTH = 2 * np.pi * 0.05
FILTERS = np.array(
    [
        [0, 1, 0, 0],
        [-(UPPER**2), -1.4 * UPPER, 0, 0],
        [0, 0, 0, 1],
        [UPPER**2, 0, -(LOWER**2), -1.4 * LOWER],
    ]
)
SHAPED = np.array([UPPER**2, 0, -(LOWER**2), -1.4 * LOWER])


def bench():
    """Mass, damping, stiffness of the free body at rest; loads of the wheel unit, line of sight."""
    free = Bench(0.0, mounted=False, loop=False)
    return free.m, free.d, free.k, free.wheel.T, free.sight


def system():
    """The body with the filters: its rates, its noise, its torques, and the line of sight."""
    m, d, k, loads, sight = bench()
    carried = m[3:, :3] @ np.linalg.inv(m[:3, :3])
    inverse = np.linalg.inv(m[3:, 3:] - carried @ m[:3, 3:])
    forces = inverse @ (loads[3:] - carried @ loads[:3])
    a, noise, torque = np.zeros((24, 24)), np.zeros((24, 3)), np.zeros((24, 3))
    a[:6, 6:12] = np.eye(6)
    a[6:12, :6], a[6:12, 6:12] = -inverse @ k[3:, 3:], -inverse @ d[3:, 3:]
    torque[6:12] = inverse[:, :3]
    for axis in range(3):
        first = 12 + 4 * axis
        a[first : first + 4, first : first + 4] = FILTERS
        a[6:12, first : first + 4] = np.outer(forces[:, axis], SHAPED)
        noise[first + 1, axis] = np.sqrt(DENSITY / 2)
    return a, noise, torque, np.hstack([sight[:, 3:], np.zeros((2, 18))])


def over(a, noise, torque, time):
    """The flow over a time, the covariance of what the noise adds, and the effect of constant torques."""
    order = len(a)
    both = expm(np.block([[-a, noise @ noise.T], [np.zeros_like(a), a.T]]) * time)
    flow = both[order:, order:].T
    held = expm(np.block([[a, torque], [np.zeros((3, order + 3))]]) * time)[:order, order:]
    covariance = flow @ both[:order, order:]
    return flow, (covariance + covariance.T) / 2, held


def hub_law():
    """The bolted bench with its law: see `system`."""
    gain = np.hstack([HUB * BANDWIDTH**2, np.zeros((3, 3)), 1.4 * BANDWIDTH * HUB, np.zeros((3, 15))])
    return (*system(), gain)


def deviations(period, exposure, parts=None):
    """The rms about x and y at the samples, over time, of means over exposures, and of straight lines.

    `parts`: rates, noise, torques, line of sight and the gain of the law, by default those of the bolted
    bench.
    """
    a, noise, torque, sight, gain = parts or hub_law()
    order = len(a)

    def closed(time):
        flow, added, held = over(a, noise, torque, time)
        return flow - held @ gain, added

    flow, added = closed(period)
    p = settled(flow, added)
    at, weights = np.polynomial.legendre.leggauss(16)
    squares = np.zeros(2)
    for place, weight in zip(0.5 * (at + 1), 0.5 * weights, strict=True):
        after, more = closed(period * place)
        squares += weight * np.diag(sight @ (after @ p @ after.T + more) @ sight.T)
    # The torque that is held, the integral of the line of sight and that of the integral, as further states.
    size = order + 7
    big, drawn = np.zeros((size, size)), np.zeros((size, 3))
    big[:order, :order], big[:order, order : order + 3], drawn[:order] = a, torque, noise
    big[order + 3 : order + 5, :order], big[order + 5 :, order + 3 : order + 5] = sight, np.eye(2)
    none = np.zeros((size, 3))
    sample = np.eye(size)
    sample[order : order + 3] = 0
    sample[order : order + 3, :order] = -gain
    # The mean, and the root of the mean square of the best straight line about it, from both integrals.
    mean, line = np.zeros((2, size)), np.zeros((2, size))
    mean[:, order + 3 : order + 5] = np.eye(2) / exposure
    line[:, order + 3 : order + 5], line[:, order + 5 :] = np.eye(2) / 2, -np.eye(2) / exposure
    line *= 12 / exposure / np.sqrt(12)

    def mean_squares(start):
        covariance = np.zeros((size, size))
        covariance[:order, :order] = p
        covariance = sample @ covariance @ sample.T
        edges = [start] + [k * period for k in range(1, 2000) if start < k * period < start + exposure]
        edges.append(start + exposure)
        flow, added, _ = over(big, drawn, none, start)
        covariance = flow @ covariance @ flow.T + added
        covariance[order + 3 :], covariance[:, order + 3 :] = 0, 0
        for begin, end in pairwise(edges):
            flow, added, _ = over(big, drawn, none, end - begin)
            covariance = flow @ covariance @ flow.T + added
            if end < edges[-1]:
                covariance = sample @ covariance @ sample.T
        return np.array([np.diag(rows @ covariance @ rows.T) for rows in (mean, line)])

    within = sum(
        weight * mean_squares(period * place)
        for place, weight in zip(0.5 * (at + 1), 0.5 * weights, strict=True)
    )
    return np.sqrt(np.array([np.diag(sight @ p @ sight.T), squares, *within]))


def variance_of_load():
    """The variance of a load with a density of 1 between the corners."""
    both = expm(np.block([[-FILTERS, np.diag([0, 0.5, 0, 0])], [np.zeros((4, 4)), FILTERS.T]]) * 1e-3)
    flow = both[4:, 4:].T
    return SHAPED @ solve_discrete_lyapunov(flow, flow @ both[:4, 4:]) @ SHAPED


@cache
def body():
    """The body without filters: its rates, its torques, the line of sight, and the columns of its loads."""
    m, _, _, loads, _ = bench()
    a, _, torque, sight = system()
    carried = m[3:, :3] @ np.linalg.inv(m[:3, :3])
    inverse = np.linalg.inv(m[3:, 3:] - carried @ m[:3, 3:])
    columns = np.vstack([np.zeros((6, 6)), inverse @ (loads[3:] - carried @ loads[:3])])
    return a[:12, :12], torque[:12], sight[:, :12], columns


@cache
def flow_of_body(time):
    """The flow of the body over a time, and the effect of constant torques."""
    a, torque, _, _ = body()
    flow, _, held = over(a, np.zeros((12, 1)), torque, time)
    return flow, held


def line(period, w, load):
    """The complex amplitudes about x and y at w, and the mean square, under a force and a torque cos(w t)."""
    a, _, sight, columns = body()
    column = columns @ load
    gain = np.hstack([HUB * BANDWIDTH**2, np.zeros((3, 3)), 1.4 * BANDWIDTH * HUB, np.zeros((3, 3))])
    own = np.linalg.solve(1j * w * np.eye(12) - a, column)

    def after(start, time):
        flow, held = flow_of_body(time)
        return flow @ (start - own) + own * np.exp(1j * w * time) - held @ (gain @ start)

    def closed(time):
        flow, held = flow_of_body(time)
        return flow - held @ gain

    turn = np.exp(1j * w * period)
    start = np.linalg.solve(turn * np.eye(12) - closed(period), after(np.zeros(12, complex), period))
    at, weights = np.polynomial.legendre.leggauss(24)
    amplitude, square = np.zeros(2, complex), np.zeros(2)
    for place, weight in zip(0.5 * (at + 1) * period, 0.5 * weights, strict=True):
        value = sight @ after(start, place)
        amplitude += weight * value * np.exp(-1j * w * place)
        square += weight * np.abs(value) ** 2 / 2
    return amplitude, square


def cooler(period, f):
    """The mean squares of the line of sight under a cooler of two harmonics, and its peaks."""
    first, one = line(period, 2 * np.pi * f, np.array([0.01, 0, 0.02, 0, 0, 0]))
    second, other = line(period, 4 * np.pi * f, np.array([0, 0.003, 0, 2e-4, 0, 0]))
    angles = np.linspace(0, 2 * np.pi, 2_001)
    waves = np.outer(first, np.exp(1j * angles)) + np.outer(second * np.exp(1j), np.exp(2j * angles))
    return one + other, np.abs(waves.real).max(axis=1)


def worst(period, low, high):
    """The worst frequency of the cooler (Hz) for each axis, with the rms and the peak there."""
    # The law has peaks at both sides of multiples of half its sampling rate.
    near = [k / period / 2 + np.linspace(-0.1, 0.1, 401) for k in range(1, 100)]
    grid = np.unique(np.concatenate([np.linspace(low, high, 601), *near]))
    grid = grid[(grid >= low) & (grid <= high)]
    found = []
    for about in range(2):
        sizes = [cooler(period, f)[0][about] for f in grid]
        best = int(np.argmax(sizes))
        ends = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
        f = minimize_scalar(
            lambda f, about=about: -cooler(period, f)[0][about] * 1e12,
            bounds=ends,
            method="bounded",
            options={"xatol": 1e-9},
        ).x
        square, peak = cooler(period, f)
        found.append((f, np.sqrt(square[about]), peak[about]))
    return found


# Fine mirror: frequency, damping, period, gain and noise of its guidance sensor.
MIRROR, MIRROR_DAMPING, MIRROR_PERIOD, GAIN, NOISE = 2 * np.pi * 300, 0.6, 1e-3, 0.25, 2e-8
WHIRL = 2 * np.pi * 50


def mounted(sampled, *, held=False):
    """The bench with its wheel on the mount: rates, noise, torques, line of sight, and the law."""
    own = Bench(WHIRL, loop=not sampled, held=held)
    # The published bench holds the hub's place; without that its displacement follows from the rest.
    first = 0 if held else 3
    m, d, k = own.m[first:, first:], own.d[first:, first:], own.k[first:, first:]
    loads = own.wheel.T[first:]
    if not held:
        carried = own.m[3:, :3] @ np.linalg.inv(own.m[:3, :3])
        m, loads = m - carried @ own.m[:3, 3:], loads - carried @ own.wheel.T[:3]
    inverse, n = np.linalg.inv(m), len(m)
    hub = slice(3 - first, 6 - first)
    size = 2 * n + 12
    a, noise, torque = np.zeros((size, size)), np.zeros((size, 3)), np.zeros((size, 3))
    a[:n, n : 2 * n] = np.eye(n)
    a[n : 2 * n, :n], a[n : 2 * n, n : 2 * n] = -inverse @ k, -inverse @ d
    torque[n : 2 * n] = inverse[:, hub]
    for axis in range(3):
        place = 2 * n + 4 * axis
        a[place : place + 4, place : place + 4] = FILTERS
        a[n : 2 * n, place : place + 4] = np.outer(inverse @ loads[:, axis], SHAPED)
        noise[place + 1, axis] = np.sqrt(DENSITY / 2)
    sight = np.hstack([own.sight[:, first:], np.zeros((2, n + 12))])
    gain = np.zeros((3, size))
    gain[:, hub] = HUB * BANDWIDTH**2
    # The law adds the gyroscopic torque of the wheel.
    gain[:, n + hub.start : n + hub.stop] = 1.4 * BANDWIDTH * HUB + momentum()
    return a, noise, torque, sight, gain


def momentum():
    """The product with the momentum of the wheel."""
    return across(np.array([0, SPIN * WHIRL, 0]))


def settled(flow, added):
    """The covariance after many periods, by doubling: states that nothing moves are no matter."""
    for _ in range(60):
        added = added + flow @ added @ flow.T
        flow = flow @ flow
    return added


def behind_mirror(period, *, held=False):
    """The rms about x and y before and behind the mirror; a law of period 0 is continuous."""
    a, noise, torque, sight, gain = mounted(period > 0, held=held)
    body = len(a)
    # Torques that are held, and about each axis the mirror's angle, rate, command, waiting mean and integral.
    size = body + 13
    big, drawn = np.zeros((size, size)), np.zeros((size, 3))
    big[:body, :body], drawn[:body] = a, noise
    big[:body, body : body + 3] = torque
    exposure, error = np.eye(size), np.zeros((2, size))
    reading = np.zeros((size, size))
    for axis in range(2):
        angle, rate, command, waiting, integral = range(body + 3 + 5 * axis, body + 8 + 5 * axis)
        big[angle, rate] = 1
        big[rate, [angle, rate, command]] = [-(MIRROR**2), -2 * MIRROR_DAMPING * MIRROR, MIRROR**2]
        error[axis, :body], error[axis, angle] = sight[axis], -1
        big[integral] = error[axis]
        exposure[command, waiting] = GAIN
        exposure[waiting] = 0
        exposure[waiting, integral] = 1 / MIRROR_PERIOD
        exposure[integral] = 0
        reading[waiting, waiting] = NOISE**2
    sample = np.eye(size)
    sample[body : body + 3] = 0
    sample[body : body + 3, :body] = -gain
    steps = round(period / MIRROR_PERIOD) if period else 1
    none = np.zeros((size, 3))
    flow, added, _ = over(big, drawn, none, MIRROR_PERIOD)
    whole, covariance = np.eye(size), np.zeros((size, size))
    for step in range(steps):
        jump = sample @ exposure if period and step == 0 else exposure
        whole = flow @ jump @ whole
        covariance = flow @ (jump @ covariance @ jump.T + reading) @ flow.T + added
    covariance = settled(whole, covariance)
    at, weights = np.polynomial.legendre.leggauss(12)
    before = np.hstack([sight, np.zeros((2, 13))])
    squares = np.zeros((2, 2))
    inner = [over(big, drawn, none, MIRROR_PERIOD * place)[:2] for place in 0.5 * (at + 1)]
    for step in range(steps):
        jump = sample @ exposure if period and step == 0 else exposure
        start = jump @ covariance @ jump.T + reading
        for (after, more), weight in zip(inner, 0.5 * weights / steps, strict=True):
            now = after @ start @ after.T + more
            squares += weight * np.array([np.diag(before @ now @ before.T), np.diag(error @ now @ error.T)])
        covariance = flow @ start @ flow.T + added
    return np.sqrt(squares)


if __name__ == "__main__":
    np.set_printoptions(precision=12)
    print("variance of the load", variance_of_load())
    for period in (0.001, 0.01):
        print(period, "s: at samples, over time, means over 20 ms", deviations(period, 0.02))
    # The last line is an integral over frequency by Gauss's rule of 12 nodes in 245 and in 379 intervals
    # that the poles grade, equal to 12 digits; published of a covariance: 1.62842083e-8 and 1.67331416e-8.
    published = [[6.331786872e-8, 6.739483245e-8], [1.628420930653e-8, 1.673314563969e-8]]
    np.testing.assert_allclose(behind_mirror(0, held=True), published, rtol=1e-8)
    for period in (0.01, 0.001):
        print("on the mount, before and behind the mirror, law at", period, "s:", behind_mirror(period))
    # Means, what is left of them, and straight lines over an exposure: published, and with the law at 1 kHz.
    for exposure, published in [
        (
            0.02,
            [6.084687896e-8, 6.489090236e-8, 1.751598768e-8, 1.819983944e-8, 1.669027316e-8, 1.734886398e-8],
        ),
        (0.004, [6.320227947e-8, 6.727683672e-8, 3.82418245e-9, 3.98630886e-9]),
    ]:
        *open_loop, gain = mounted(False, held=True)
        for period, parts in [(0.01, (*open_loop, 0 * gain)), (0.001, mounted(True))]:
            _, over_time, means, lines = deviations(period, exposure, parts)
            found = np.array([*means, *np.sqrt(over_time**2 - means**2), *lines])
            if period == 0.01:
                np.testing.assert_allclose(found[: len(published)], published, rtol=2e-8)
        print("on the mount, means, jitter and straight lines over", exposure, "s, law at 1 kHz", found)
    square, peak = cooler(0.01, 51.0)
    print("cooler at 51 Hz:", np.sqrt(square), peak)
    print("worst of 51 Hz within 10 %:", worst(0.01, 45.9, 56.1))
