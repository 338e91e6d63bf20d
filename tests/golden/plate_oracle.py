"""The first bending mode of a uniform cantilever: the numbers of tests/plate_mode.rs and of a `plate`.

    pip install mpmath
    python3 tests/golden/plate_oracle.py

The shape solves the Euler-Bernoulli equation with a clamped and a free end; its constants come from the
boundary conditions, its integrals from quadrature, so that no closed form of a textbook is assumed.
"""

from mpmath import cos, cosh, diff, findroot, mp, mpf, nstr, quad, sin, sinh, sqrt

mp.dps = 40

root = findroot(lambda b: cos(b) * cosh(b) + 1, mpf("1.875"))
sigma = (cosh(root) + cos(root)) / (sinh(root) + sin(root))


def bare(x):
    b = root * x
    return cosh(b) - cos(b) - sigma * (sinh(b) - sin(b))


norm = sqrt(quad(lambda x: bare(x) ** 2, [0, 1]))


def shape(x):
    return bare(x) / norm


# No moment and no shear at the free end.
assert abs(diff(shape, 1, 2)) < mpf("1e-25")
assert abs(diff(shape, 1, 3)) < mpf("1e-20")
print("root", nstr(root, 25), "sigma", nstr(sigma, 25))
print("translation over sqrt(m)     ", nstr(quad(shape, [0, 1]), 20))
print("rotation over sqrt(m) L      ", nstr(quad(lambda x: x * shape(x), [0, 1]), 20))
for at in ("0.25", "0.5", "0.8", "1"):
    x = mpf(at)
    displacement, slope = nstr(shape(x), 20), nstr(diff(shape, x), 20)
    print(f"at {at} L: displacement sqrt(m)", displacement, " slope sqrt(m) L", slope)
