"""Relays about three axes of a flexible body at small angles, in 40 digits with mpmath.

For tests/small_angles.rs: prints `time, axis` of every switching within 120 s, with a continuous sensor, and
then a line `end` with the rotation, the rates and the displacements of the modes at 120 s.

theta'' = J^-1 M and q'' + 2 zeta w q' + w² q = phi . M under constant torques M; relay i reads
theta_i + sum phi_i q. Crossings are bracketed on a grid of 0.01 s, with Newton's method between, and not by
bounds.

    python3 small_angles_oracle.py > small_angles.csv
"""

from mpmath import cos, exp, findroot, matrix, mp, mpf, sin, sqrt

mp.dps = 40

INERTIA = [["100", "6", "-9"], ["6", "80", "4"], ["-9", "4", "60"]]
RATES = ["3e-5", "-2e-5", "1e-5"]
# Frequency (rad/s), damping ratio, displacement at the start, rotation of the hub.
MODES = [
    ("0.7", "0.01", "2e-4", ["0.05", "0.02", "-0.03"]),
    ("1.9", "0.004", "0", ["-0.01", "0.04", "0.03"]),
    ("3.1", "0", "-1e-4", ["0.02", "-0.03", "0.04"]),
]
DISTURBANCE = ["0", "2e-5", "0"]
# Strong and weak torque about each axis (N m).
RELAYS = [("8e-3", "2e-4"), ("5e-3", "1e-4"), ("4e-3", "1e-4")]
# Numbers of a scenario file are doubles.
ZONE, BACK, K_T = mpf(5e-4), mpf(5e-4 - 1e-4), mpf(0.33)
STEP, END = mpf("0.01"), mpf(120)


def number(text):
    return mpf(float(text))


class Segment:
    """Motion under constant torques."""

    def __init__(self, start, state, torque, inverse):
        self.start, (self.angles, self.rates, self.modes) = start, state
        self.acceleration = inverse * torque
        self.torque = torque

    def at(self, t):
        h = t - self.start
        angles = self.angles + self.rates * h + self.acceleration * (h * h / 2)
        rates = self.rates + self.acceleration * h
        modes = []
        for (w, zeta, _, phi), (q, v) in zip(PARAMETERS, self.modes, strict=True):
            rest = sum(phi[i] * self.torque[i] for i in range(3)) / w**2
            d, x = zeta * w, q - rest
            f = sqrt(w * w - d * d)
            c, s, e = cos(f * h), sin(f * h), exp(-d * h)
            b = (v + d * x) / f
            modes.append((rest + e * (x * c + b * s), e * ((b * f - d * x) * c - (x * f + d * b) * s)))
        return angles, rates, modes

    def angle(self, axis, t):
        angles, _, modes = self.at(t)
        return angles[axis] + sum(p[3][axis] * q for p, (q, _) in zip(PARAMETERS, modes, strict=True))

    def gap(self, axis, level):
        """The angle about an axis less a level, as a function of time."""
        return lambda t: self.angle(axis, t) - level


class Relay:
    """The law: coasts under a weak torque, pushes at a boundary, and brakes for a part of the push."""

    def __init__(self, strong, weak):
        self.strong, self.weak = number(strong), number(weak)
        self.coast(+1)

    def coast(self, sign):
        self.phase, self.torque, self.until = "coast", sign * self.weak, None

    def guards(self):
        """Pairs of a level and the direction (+1: at or above) that trip."""
        if self.phase == "coast":
            return [(ZONE, +1), (-ZONE, -1)]
        return [(self.side * BACK, -self.side)] if self.phase == "push" else []

    def decide(self, now, direction):
        if self.phase == "coast":
            self.phase, self.side, self.pushed = "push", direction, now
            self.torque = -direction * self.strong
        elif self.phase == "push":
            # The weak torque opposes the motion that the push leaves.
            self.phase, self.torque = "brake", self.side * self.strong
            self.until = now + K_T * (now - self.pushed)
        else:
            self.coast(self.side)


PARAMETERS = [(number(w), number(z), number(q), [number(p) for p in phi]) for w, z, q, phi in MODES]


def main():
    inverse = matrix([[number(x) for x in row] for row in INERTIA]) ** -1
    relays = [Relay(*torques) for torques in RELAYS]
    state = (matrix([0, 0, 0]), matrix([number(r) for r in RATES]), [(p[2], mpf(0)) for p in PARAMETERS])
    now = mpf(0)
    while True:
        torque = matrix([relay.torque + number(d) for relay, d in zip(relays, DISTURBANCE, strict=True)])
        segment = Segment(now, state, torque, inverse)
        timeouts = [(relay.until, axis, 0) for axis, relay in enumerate(relays) if relay.until]
        first = min(timeouts, default=(END, None, 0))
        t = now
        found = []
        while t < first[0] and not found:
            here = min(t + STEP, first[0])
            for axis, relay in enumerate(relays):
                for level, direction in relay.guards():
                    if direction * (segment.angle(axis, here) - level) >= 0:
                        gap = segment.gap(axis, level)
                        root = findroot(gap, (t, here), solver="anderson", tol=1e-60)
                        found.append((root, axis, direction))
            t = here
        instant, axis, direction = min([*found, first])
        if instant >= END:
            break
        state, now = segment.at(instant), instant
        relays[axis].decide(instant, direction)
        print(f"{mp.nstr(instant, 22, strip_zeros=False)},{axis}")
    angles, rates, modes = segment.at(END)
    print("end," + ",".join(mp.nstr(x, 20) for x in [*angles, *rates, *(q for q, _ in modes)]))


if __name__ == "__main__":
    main()
