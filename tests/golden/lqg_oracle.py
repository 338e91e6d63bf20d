"""Golden numbers of tests/lqg.rs, by NumPy and SciPy: this program writes `lqg.csv`.

A body with two modes, a sampled angle without noise, a Kalman filter that knows the modes wrongly and the
disturbance not at all, and a PD law on what it believes; it stays at 0, or follows a slew. From sample to
sample the motion is SciPy's matrix exponential; the filter is the textbook's, in Joseph's form with whole
matrices. The slew's sine series comes from its two conditions, the travel and no response of the first
mode, and its integrals are written out.
"""

import csv
from pathlib import Path

import numpy as np
from scipy.linalg import expm

INERTIA = 120.0
PERIOD = 0.5
# Frequency (rad/s), gain, damping ratio of each mode: of the body, and as the filter knows them.
BODY = [(0.9, 0.5, 0.005), (2.3, 0.2, 0.0)]
KNOWN = [(0.95, 0.45, 0.01), (2.2, 0.25, 0.0)]
START = np.array([0.02, -1e-3, 1e-3, 2e-3, -4e-4, 1e-3])
K_P, K_D = 4.0, 40.0
ANGLE_NOISE, MOMENT_NOISE = 1e-4, 1e-8
SPREAD = np.array([1e-3, 1e-3, 2e-3, 6e-4, 2e-4, 6e-5])
# N m, between two times (s) that are instants of the law.
DISTURBANCE, FROM, TO = 0.05, 20.0, 50.0
TIMES = [10.0, 30.0, 60.0, 120.0]
SEEN = np.array([1.0, 0.0] * 3)


def system(modes, back_emf, opposes):
    """z' = A z + g m, z = (rigid angle, rate, first mode, its rate, ...); back-EMF in 1/s."""
    a, g = np.zeros((6, 6)), np.zeros(6)
    a[0, 1] = g[1] = 1.0
    for i, (w, gain, damping) in enumerate(modes):
        x = 2 + 2 * i
        a[x, x + 1], a[x + 1, x], a[x + 1, x + 1], g[x + 1] = 1.0, -w * w, -2.0 * damping * w, gain
    felt = np.array([0.0, 1.0] * 3) if opposes == "body_rate" else np.eye(6)[1]
    return a - back_emf * np.outer(g, felt), g


def held(modes, back_emf, opposes, period):
    """Transition over a period, and what a unit of the reduced moment that is held adds."""
    a, g = system(modes, back_emf, opposes)
    whole = np.zeros((7, 7))
    whole[:6, :6], whole[:6, 6] = a * period, g * period
    whole = expm(whole)
    return whole[:6, :6], whole[:6, 6], g


class Slew:
    """A sine series of two harmonics that turns the rigid body, and leaves the first mode at rest."""

    def __init__(self, angle, time, rate, inertia=INERTIA):
        self.angle, self.time, self.rate, self.inertia = angle, time, rate, inertia
        self.kappa = 2.0 * np.pi / time * np.array([1.0, 2.0])
        rows = [time / self.kappa, self.kappa / (BODY[0][0] ** 2 - self.kappa**2)]
        self.b = np.linalg.solve(rows, [inertia * (angle - rate * time), 0.0])

    def impulse(self, t):
        t = min(t, self.time)
        return self.b @ ((1.0 - np.cos(self.kappa * t)) / self.kappa)

    def travel(self, t):
        t = min(t, self.time)
        return self.b @ ((t - np.sin(self.kappa * t) / self.kappa) / self.kappa)

    def goal(self, t):
        return (
            START[0] + self.rate * t + self.travel(t) / self.inertia,
            self.rate + self.impulse(t) / self.inertia,
        )

    def torque(self, t, back_emf):
        """Means over the next period: the torque, and what back-EMF takes at the rate of the rigid body."""
        end = t + PERIOD
        rate = self.rate + (self.travel(end) - self.travel(t)) / PERIOD / self.inertia
        return (self.impulse(end) - self.impulse(t)) / PERIOD + back_emf * rate


def run(feeds, unit=1.0, back_emf=0.0, opposes="body_rate", delay=0.0, slew=None, tracks=True):
    """Angles and the filter's innovations at TIMES; `unit` is in N m, back-EMF in N m s."""
    free = [held(BODY, back_emf / INERTIA, opposes, span) for span in (delay, PERIOD - delay)]
    carry, shove, g = held(KNOWN, back_emf / INERTIA, opposes, PERIOD)
    noise = MOMENT_NOISE * PERIOD * np.outer(g, g)
    z, covariance = START.copy(), np.diag(SPREAD**2)
    if slew:
        # The modes rest at its start.
        z[1:] = 0.0
        z[1] = slew.rate
    mean = z.copy()
    believes = {"hub": (SEEN, np.roll(SEEN, 1)), "rigid": (np.eye(6)[0], np.eye(6)[1])}[feeds]
    out, last, moment = {}, 0.0, 0.0
    for k in range(round(TIMES[-1] / PERIOD) + 1):
        t = k * PERIOD
        if k > 0:
            acts = DISTURBANCE / INERTIA if FROM <= t - PERIOD < TO else 0.0
            for (move, push, _), given in zip(free, (last, moment), strict=True):
                z = move @ z + push * (given + acts)
            mean = carry @ mean + shove * (delay * last + (PERIOD - delay) * moment) / PERIOD
            covariance = carry @ covariance @ carry.T + noise
        innovation = SEEN @ z - SEEN @ mean
        gain = covariance @ SEEN / (SEEN @ covariance @ SEEN + ANGLE_NOISE**2)
        left = np.eye(6) - np.outer(gain, SEEN)
        mean = mean + gain * innovation
        covariance = left @ covariance @ left.T + ANGLE_NOISE**2 * np.outer(gain, gain)
        angle, rate = (row @ mean for row in believes)
        wanted, turning = slew.goal(t) if slew else (0.0, 0.0)
        last = moment
        moment = -unit * (K_P * (angle - wanted) + K_D * (rate - turning)) / INERTIA
        if slew:
            # A law that does not track waits for the slew's end.
            moment = moment if tracks or t >= slew.time else 0.0
            moment += slew.torque(t, back_emf) / INERTIA
        if t in TIMES:
            out[t] = (SEEN @ z, innovation)
    return [out[t] for t in TIMES]


def write():
    wheel = {"unit": 0.8, "back_emf": 0.6}
    turn, spin = Slew(0.5, 40.0, 0.0), Slew(0.9, 40.0, 0.01)
    loops = {
        "hold": {},
        "wheel": wheel,
        "rigid wheel": wheel | {"opposes": "rigid_rate"},
        "late wheel": wheel | {"delay": 0.2},
        "hold turn": {"slew": turn},
        "wheel turn": wheel | {"slew": turn},
        "late wheel turn": wheel | {"slew": turn, "delay": 0.2},
        "waiting wheel turn": wheel | {"slew": turn, "tracks": False},
        "wheel turn as planned": wheel | {"slew": Slew(0.5, 40.0, 0.0, 100.0)},
        "wheel spin": wheel | {"slew": spin},
    }
    with Path(__file__).with_name("lqg.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["loop", "feeds", "time_s", "angle_rad", "innovation_rad"])
        for name, arguments in loops.items():
            for feeds in ("hub", "rigid"):
                rows = zip(TIMES, run(feeds, **arguments), strict=True)
                table.writerows([name, feeds, t, f"{x:.15e}", f"{n:.15e}"] for t, (x, n) in rows)


if __name__ == "__main__":
    write()
