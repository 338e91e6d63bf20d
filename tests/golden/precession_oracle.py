"""Matrices from the GCRF and from EME2000 to the mean equator and equinox of dates (IAU 2006).

They follow from the four angles of Fukushima and Williams, gamma, phi, psi and the obliquity, whose
polynomials hold the frame bias (Hilton et al., Celestial Mechanics and Dynamical Astronomy 94, 2006, and
Capitaine & Wallace, A&A 450, 2006), with 40 digits: another set than the three angles of the engine. The
bias from the GCRF to EME2000 is that of these angles at the date 2000. ERFA's `bp06` agrees to 1e-15.

`python tests/golden/precession_oracle.py > tests/golden/precession.csv`
"""

from mpmath import cos, mp, mpf, pi, sin

mp.dps = 40
ARCSECOND = pi / 648000
GAMMA = ["-0.052928", "10.556378", "0.4932044", "-0.00031238", "-0.000002788", "0.0000000260"]
PHI = ["84381.412819", "-46.811016", "0.0511268", "0.00053289", "-0.000000440", "-0.0000000176"]
PSI = ["-0.041775", "5038.481484", "1.5584175", "-0.00018522", "-0.000026452", "-0.0000000148"]
OBLIQUITY = ["84381.406", "-46.836769", "-0.0001831", "0.00200340", "-0.000000576", "-0.0000000434"]
# Seconds from 1970 (date --utc +%s): noon of 2000-01-01, 2006-06-26T18:52:04, 2020-06-01, 2026-03-20T14:46,
# 2026-11-29, 2050-01-01.
DATES = [946728000, 1151347924, 1590969600, 1774017960, 1795910400, 2524608000]


def angle(powers, t):
    return sum(mpf(power) * t**k for k, power in enumerate(powers)) * ARCSECOND


def about(axis, by):
    """Matrix of components along axes that are turned by an angle about one of them."""
    c, s = cos(by), sin(by)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    m = mp.eye(3)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, s, -s, c
    return m


def from_gcrf(seconds):
    t = (mpf(seconds) - 946728000) / (36525 * 86400)
    gamma, phi, psi, obliquity = (angle(powers, t) for powers in (GAMMA, PHI, PSI, OBLIQUITY))
    return about(0, -obliquity) * about(2, -psi) * about(0, phi) * about(2, gamma)


print("seconds_from_1970,frame," + ",".join(f"m{i}{j}" for i in range(3) for j in range(3)))
bias = from_gcrf(946728000)
for date in DATES:
    for frame, m in (("GCRF", from_gcrf(date)), ("EME2000", from_gcrf(date) * bias.T)):
        print(f"{date},{frame}," + ",".join(mp.nstr(m[i, j], 20) for i in range(3) for j in range(3)))
