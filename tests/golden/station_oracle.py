"""Golden numbers of tests/spatial.rs: `python3 tests/golden/station_oracle.py` prints them.

Modes by SciPy's matrix exponential, tumbling by Taylor series of 30 digits (mpmath), and the whole loop of
scenarios/iss-manoeuvre-off.toml without noise by Runge-Kutta steps of 0.01 s, on which all pulses begin and
end. It takes about a minute.
"""

import pathlib

import mpmath
import numpy as np
import tomllib
from scipy.linalg import expm


def mode_matrix(w, zeta):
    """Of (q', w q), driven by an acceleration that is constant."""
    return np.array([[-2 * zeta * w, -w, 1.0], [w, 0, 0], [0, 0, 0]])


def modes():
    np.set_printoptions(precision=15)
    for f, zeta, t in [(0.2, 0.005, 0.2), (1.1, 0.0, 0.37), (0.05, 0.9, 3.1), (0.05, 1.7, 3.1)]:
        print(f"Phi f={f} zeta={zeta} t={t}:", expm(mode_matrix(2 * np.pi * f, zeta) * t)[:2, :2].ravel())
    matrix = mode_matrix(2 * np.pi * 0.2, 0.005)
    for tau in [0.2, 0.05]:
        pushed = expm(matrix * tau) @ [0, 0, 1]
        b = expm(matrix * (0.2 - tau)) @ np.r_[pushed[:2], 0]
        print(f"b tau={tau}:", b[:2])
    # Three accelerations one after the other from a start in motion.
    state = np.array([0.3, -0.2, 0.0])
    for push, tau in [(0.7, 0.13), (-1.1, 0.05), (0.0, 0.62)]:
        state = expm(matrix * tau) @ np.r_[state[:2], push]
    print("three pieces:", state[:2])


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def tumbling():
    mpmath.mp.dps = 30
    inertia = mpmath.matrix([[5, 0.4, -0.2], [0.4, 3, 0.1], [-0.2, 0.1, 2]])
    inverse = inertia**-1

    def rate(torque):
        def of(_, y):
            w = mpmath.matrix(y[4:])
            momentum = inertia * w
            turn = inverse * mpmath.matrix([m + t for m, t in zip(cross(momentum, w), torque, strict=True)])
            q, v = y[0], y[1:4]
            spin = cross(v, w)
            vector = [(q * w[i] + spin[i]) / 2 for i in range(3)]
            return [-(v[0] * w[0] + v[1] * w[1] + v[2] * w[2]) / 2, *vector, *turn]

        return of

    for torque in [(0, 0, 0), (0.02, -0.01, 0.03)]:
        start = [1, 0, 0, 0, mpmath.mpf("0.3"), mpmath.mpf("-0.2"), mpmath.mpf("0.5")]
        solution = mpmath.odefun(rate([mpmath.mpf(str(t)) for t in torque]), 0, start)
        print("tumbling", torque, "at 40 s:", [mpmath.nstr(v, 17) for v in solution(40)])


def quaternion(roll, pitch, yaw):
    def times(a, b):
        return np.r_[a[0] * b[0] - a[1:] @ b[1:], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])]

    def about(axis, angle):
        return np.r_[np.cos(angle / 2), np.sin(angle / 2) * np.eye(3)[axis]]

    return times(times(about(2, yaw), about(1, pitch)), about(0, roll)), times


class Lines:
    """Switching lines about an axis, as docs/scenario/laws.md states them."""

    def __init__(self, law, jets, strength):
        self.slope, self.limit = 0.05, law["rate_limit"]
        self.on, self.off = law["switch_on"], law["switch_off"]
        self.brake = 0.5 * min(strength)
        self.least = max(max(strength) * max(jets["minimum_on"], jets["quantum"]), self.on / 1000)
        self.on, self.limit = max(self.on, self.least), max(self.limit, 2 * self.least)
        self.slow = max(self.off, 2 * self.least)
        zone = law["dead_zone"]
        self.edge = max(zone - self.slow / self.slope, zone / 2)
        self.steep = max(self.slope, 2 * self.least / (zone - self.edge))

    def back(self, beyond):
        if beyond <= 0:
            return 0.0
        slow = min(self.slow, self.steep * beyond, np.sqrt(2 * self.brake * beyond))
        return min(self.limit, max(min(self.slope, self.brake / self.limit) * beyond, slow))

    def wanted(self, angle):
        return -np.sign(angle) * self.back(abs(angle) - self.edge)

    def allowed(self, ahead):
        """How much too fast the body may go on towards an edge that lies at +edge."""
        beyond = ahead - self.edge
        room = self.back(beyond) / 2 if beyond > 0 else np.sqrt(-2 * self.brake * beyond)
        return min(max(room, self.least), self.on)


def station():
    path = pathlib.Path(__file__).parents[2] / "scenarios" / "iss-manoeuvre-off.toml"
    study = tomllib.loads(path.read_text())
    body, law, jets = study["body"]["spatial"], study["law"]["phase_plane"], study["actuator"]["jets"]
    inertia = np.array(body["inertia"])
    inverse = np.linalg.inv(inertia)
    position = {p["name"]: np.array(p.get("position", [0, 0, 0])) for p in body["points"]}
    thrusters = {t["name"]: t for t in jets["thrusters"]}
    groups = {}
    for axis, name in enumerate(["roll", "pitch", "yaw"]):
        for sign, key in [(1, "plus"), (-1, "minus")]:
            torque, forces, thrust = np.zeros(3), np.zeros(len(body["modes"])), 0.0
            for each in (thrusters[n] for n in jets["groups"][name][key]):
                force = each["thrust"] * np.array(each["direction"])
                offset = np.array(each.get("offset", [0, 0, 0]))
                torque += np.cross(position[each["point"]] + offset, force)
                thrust += each["thrust"]
                for i, mode in enumerate(body["modes"]):
                    shape = mode["shapes"][each["point"]]
                    forces[i] += np.dot(shape["translation"], force)
                    forces[i] += np.dot(shape["rotation"], np.cross(offset, force))
            groups[axis, sign] = torque, forces, thrust / (jets["specific_impulse"] * 9.80665)
    strength = {key: abs(torque[key[0]]) / inertia[key[0], key[0]] for key, (torque, _, _) in groups.items()}

    lines = [Lines(law, jets, [strength[a, 1], strength[a, -1]]) for a in range(3)]
    step, cycle = 0.01, law["period"]
    flows = []
    for mode in body["modes"]:
        flows.append(expm(mode_matrix(mode["frequency"], mode["damping"]) * step))
    free = np.array([f[:2, :2] for f in flows])
    forced = np.array([f[:2, 2] for f in flows])
    seen = np.array([mode["shapes"][study["sensor"]["gyro"]["point"]]["rotation"] for mode in body["modes"]])

    goal, times = quaternion(*(law["targets"][0][k] for k in ["roll", "pitch", "yaw"]))
    begins, rest = law["targets"][0]["from"], np.array([1.0, 0, 0, 0])

    def change(q, w, torque):
        turn = inverse @ (torque - np.cross(w, inertia @ w))
        return 0.5 * times(q, np.r_[0, w]), turn

    q, w, bending = rest.copy(), np.zeros(3), np.zeros((len(flows), 2))
    estimate, drift, executed, queued = (np.zeros(3) for _ in range(4))
    firing = [False] * 3
    part = study["estimator"]["rigid_rate"]["correction"]
    pulses, fuel, peak, first = 0, 0.0, 0.0, []

    def changes(on):
        return np.array([on[a] * strength[a, 1 if on[a] >= 0 else -1] for a in range(3)])

    last = round(study["duration"] / cycle)
    for k in range(last + 1):
        target = goal if k * cycle >= begins - 1e-9 else rest
        error = times(target * [1, -1, -1, -1], q)
        error = 2 * np.sign(error[0]) * error[1:]
        predicted = estimate + changes(executed) + drift
        innovation = w + seen.T @ bending[:, 0] - predicted
        estimate = predicted + part * innovation
        drift = drift + part**2 / 4 * innovation
        command = np.zeros(3)
        for a in range(3):
            excess = estimate[a] + changes(queued)[a] - lines[a].wanted(error[a])
            allowed = lines[a].allowed(error[a] if excess > 0 else -error[a])
            if abs(excess) > allowed:
                firing[a] = True
            elif abs(excess) < min(law["switch_off"], allowed / 2):
                firing[a] = False
            if firing[a]:
                sign = -1 if excess > 0 else 1
                on = round(min(cycle, abs(excess) / strength[a, sign]) / jets["quantum"]) * jets["quantum"]
                firing[a] = on >= jets["minimum_on"] - 1e-12
                command[a] = sign * on if firing[a] else 0.0
        executed, queued = queued, command
        energy = 0.5 * (bending**2).sum()
        peak = max(peak, energy)
        for a in range(3):
            if executed[a]:
                pulses += 1
                fuel += abs(executed[a]) * groups[a, np.sign(executed[a])][2]
                first.append((round(k * cycle, 1), a, round(executed[a], 2)))
        if k == last:
            break
        for sub in range(round(cycle / step)):
            torque, forces = np.zeros(3), np.zeros(len(flows))
            for a in range(3):
                if abs(executed[a]) > step * sub + 1e-9:
                    torque = torque + groups[a, np.sign(executed[a])][0]
                    forces = forces + groups[a, np.sign(executed[a])][1]
            a1, b1 = change(q, w, torque)
            a2, b2 = change(q + step / 2 * a1, w + step / 2 * b1, torque)
            a3, b3 = change(q + step / 2 * a2, w + step / 2 * b2, torque)
            a4, b4 = change(q + step * a3, w + step * b3, torque)
            q = q + step / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            w = w + step / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
            q /= np.linalg.norm(q)
            bending = np.einsum("nij,nj->ni", free, bending) + forced * forces[:, None]
    print("station: pulses", pulses, "fuel", float(fuel), "peak", float(peak), "end", float(energy))
    print("  q", q.tolist(), "w", w.tolist())
    print("  first pulses", first[:3], "last", first[-3:])


if __name__ == "__main__":
    modes()
    tumbling()
    station()
