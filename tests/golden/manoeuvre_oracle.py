"""Golden numbers of planned rotations, in 60-digit arithmetic.

`python3 manoeuvre_oracle.py` writes `series-amplitudes.csv`, the amplitudes of the sine and the cosine series
for 20 and for 40 suppressed modes, by linear solves of their defining equations; and prints, for the paper's
spacecraft, the slopes of the first mode's amplitude, the peaks where the hub's own motion is commanded, and
what the undamped design leaves in the damped modes that it suppresses.
"""

import csv
from pathlib import Path

import mpmath as mp

mp.mp.dps = 60
T = mp.mpf(12)
SIGMA = 2 * mp.pi / T
ANGLE = mp.mpf(1.5707963267948966)
INERTIA = mp.mpf("4616.67")
FREQUENCIES = [3.330081535753227, 7.398419278191804, 14.16531246931957, 22.34864709558169]
PARTICIPATIONS = [-0.0043481157958017, 0.00058893779242022, -0.002719332646332, 0.00052334062803443]
CLAMPED = [0.9138573911382853, 5.3623318033933908, 13.638952997537382, 22.250622889420211]
GAINS = [0.93814258755383027, 0.022931897209876173, 0.0022873763849151629, 0.00028279734185240063]
WEIGHTS = [-1.6411559991243388, 33.731982488085307, -140.64526515645358, 312.19969139274811]


def series(kind, frequencies, inertia=INERTIA):
    """Amplitudes: the travel, and no response of an undamped mode at each frequency."""
    n = len(frequencies) + 1
    rows, right = mp.matrix(n, n), mp.matrix(n, 1)
    for k in range(n):
        harmonic = k + 1 if kind == "sine" else k + mp.mpf(1) / 2
        kappa = harmonic * SIGMA
        # Integral of (T - t) u, and the odd part of the transform, of each harmonic.
        rows[0, k] = T / kappa if kind == "sine" else 2 / kappa**2
        for j, w in enumerate(frequencies):
            top = kappa if kind == "sine" else mp.mpf(w)
            rows[j + 1, k] = top / (mp.mpf(w) ** 2 - kappa**2)
    right[0] = inertia * ANGLE
    return [mp.lu_solve(rows, right)[k] for k in range(n)]


def write():
    path = Path(__file__).with_name("series-amplitudes.csv")
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["kind", "modes", "k", "amplitude"])
        for count in (20, 40):
            # Doubles, as the test makes them.
            frequencies = [3.5 + 2.25 * j for j in range(count)]
            for kind in ("sine", "cosine"):
                mp.mp.dps = 120
                for k, amplitude in enumerate(series(kind, frequencies)):
                    table.writerow([kind, count, k + 1, mp.nstr(amplitude, 18)])
                mp.mp.dps = 60


def slopes():
    for p in range(1, 5):
        b = series("sine", FREQUENCIES[:p])
        w, step = FREQUENCIES[0], mp.mpf(10) ** -20
        shifted = w * (1 + step)
        spectrum = sum((k + 1) * b[k] / (shifted**2 - ((k + 1) * SIGMA) ** 2) for k in range(p + 1))
        amplitude = abs(PARTICIPATIONS[0] * 2 * SIGMA * mp.sin(shifted * T / 2) * spectrum) / shifted
        print(f"slope p={p}: {mp.nstr(amplitude / step, 12)}")


def motion():
    import numpy as np

    t = np.linspace(0.0, 12.0, 2_000_001)
    for p in range(5):
        b = [float(v) for v in series("sine", CLAMPED[:p], mp.mpf(1))]
        command = sum(b[k] * np.sin((k + 1) * float(SIGMA) * t) for k in range(p + 1))
        tip, elastic = 0.0 * t, 0.0 * t
        for w, gain, weight in zip(CLAMPED, GAINS, WEIGHTS, strict=True):
            x = 0.0 * t
            for k in range(p + 1):
                kappa = (k + 1) * float(SIGMA)
                x += b[k] * gain * (np.sin(kappa * t) - kappa / w * np.sin(w * t)) / (w * w - kappa * kappa)
            tip += weight * x
            elastic += gain * command - w * w * x
        torque = np.abs(float(INERTIA) * (command - elastic)).max()
        print(f"motion p={p}: tip {np.abs(tip).max():.10f} rad, hub torque {torque:.8f} N m")


def damped():
    for p in (1, 2):
        b = series("sine", FREQUENCIES[:p])
        for zeta in ("0.005", "0.02", "0.05"):
            total = 0
            for w, part in zip(FREQUENCIES[:p], PARTICIPATIONS[:p], strict=True):
                z = mp.mpf(zeta)
                pole = mp.mpc(-z * w, w * mp.sqrt(1 - z * z))
                swing = sum(
                    b[k] * (k + 1) * SIGMA * (mp.exp(pole * T) - 1) / (pole**2 + ((k + 1) * SIGMA) ** 2)
                    for k in range(p + 1)
                )
                total += abs(part * swing) / mp.im(pole)
            print(f"undamped design p={p}, zeta={zeta}: {mp.nstr(total, 10)} rad")


if __name__ == "__main__":
    write()
    slopes()
    motion()
    damped()
