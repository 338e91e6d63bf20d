"""Pointing indices of a sine over windows that begin at any time: the numbers of tests/spectra.rs.

    pip install mpmath
    python3 tests/golden/sine_indices_oracle.py

The rms of each index over the start of the window, for sines of amplitude 1, by quadrature of the
definitions alone: the mean over the window, the sine less that mean at any time, at the end and in the
middle, the straight line of least squares about its mean, and the difference of the means of two windows.
"""

from mpmath import mp, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 30


def rms(of):
    """The rms of a function of the phase."""
    return sqrt(quad(lambda phase: of(phase) ** 2, [0, pi / 2, pi, 3 * pi / 2, 2 * pi]) / (2 * pi))


def indices(frequency, length, separation):
    def mean(phase, start=0):
        ends = [start, start + length / 2, start + length]
        return quad(lambda t: sin(frequency * t + phase), ends) / length

    def slope(phase):
        moment = quad(lambda t: (t - length / 2) * sin(frequency * t + phase), [0, length / 2, length])
        return 12 / length**3 * moment

    def spread(phase):
        own = mean(phase)
        square = quad(lambda t: (sin(frequency * t + phase) - own) ** 2, [0, length / 2, length])
        return sqrt(square / length)

    found = {
        "mpe": rms(mean),
        "rpe_uniform": rms(spread),
        "rpe_end": rms(lambda phase: sin(frequency * length + phase) - mean(phase)),
        "rpe_middle": rms(lambda phase: sin(frequency * length / 2 + phase) - mean(phase)),
        "smear": rms(lambda phase: slope(phase) * length / sqrt(mpf(12))),
        "pde": rms(lambda phase: mean(phase, separation) - mean(phase)),
    }
    found["beyond_smear"] = sqrt(found["rpe_uniform"] ** 2 - found["smear"] ** 2)
    return found


for frequency in ("157.0796326794896619", "30", "600"):
    print("frequency", frequency, "rad/s, windows of 0.01 s, 0.173 s apart")
    for name, value in indices(mpf(frequency), mpf("0.01"), mpf("0.173")).items():
        print(f"  {name:12}", nstr(value, 17))
