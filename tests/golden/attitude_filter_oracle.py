"""An attitude filter in forty digits: attitude-filter-out.csv, from the readings in attitude-filter-in.csv.

    pip install mpmath
    python3 tests/golden/attitude_filter_oracle.py tests/golden

A multiplicative filter of attitude and bias that lives at exposures, k = 4, 8, ..; an attitude arrives two
readings after its exposure, and what the filter says between is predicted from the last one that is there.
The covariance that noise adds is that of Van Loan. Innovations and errors are rotation vectors. The
normalised innovations of the first exposures are printed.
"""

import csv
import sys

from mpmath import atan2, cos, diag, expm, eye, matrix, mp, mpf, norm, sin, sqrt, zeros

mp.dps = 40
STEP = mpf("0.25")
WHITE, WALK = mpf("3e-6"), mpf("1e-8")
PRIOR = ["0.7993727299752185", "0.3608413571102264", "-0.480412696190943", "0.0006284181452525265"]
ROWS = [1, 2, 6, 40, 160]


def times(a, b):
    w, x, y, z = a
    p, q, r, s = b
    return [
        w * p - x * q - y * r - z * s,
        w * q + x * p + y * s - z * r,
        w * r - x * s + y * p + z * q,
        w * s + x * r - y * q + z * p,
    ]


def turned(q, by):
    angle = norm(by)
    part = sin(angle / 2) / angle if angle else mpf(1) / 2
    q = times(q, [cos(angle / 2), *(part * x for x in by)])
    length = sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def vector(a, b):
    """The rotation vector from one attitude to another."""
    w, *v = times([a[0], -a[1], -a[2], -a[3]], b)
    length = sqrt(sum(x * x for x in v))
    angle = 2 * atan2(length, abs(w)) * (1 if w > 0 else -1)
    return matrix([angle / length * x for x in v])


def predicted(state, reading):
    q, b, p = state
    w = reading - b
    f = zeros(6)
    f[:3, :3] = matrix([[0, w[2], -w[1]], [-w[2], 0, w[0]], [w[1], -w[0], 0]])
    f[:3, 3:] = -eye(3)
    loan = zeros(12)
    loan[:6, :6], loan[6:, 6:] = -f, f.T
    loan[:6, 6:] = diag([WHITE**2] * 3 + [WALK**2] * 3)
    whole = expm(loan * STEP)
    flow = whole[6:, 6:].T
    return turned(q, w * STEP), b, flow * p * flow.T + flow * whole[:6, 6:]


def corrected(state, measured):
    q, b, p = state
    axes = matrix([["0.6", 0, "0.8"], [0, 1, 0], ["-0.8", 0, "0.6"]])
    noise = axes * diag([mpf("2.4e-5") ** 2] * 2 + [mpf("1.5e-4") ** 2]) * axes.T
    inverse = (p[:3, :3] + noise) ** -1
    gain = p[:, :3] * inverse
    off = vector(q, measured)
    error = gain * off
    left = eye(6)
    left[:, :3] -= gain
    p = left * p * left.T + gain * noise * gain.T
    return (turned(q, error[:3]), b + error[3:, 0], p), (off.T * inverse * off)[0]


def main(folder):
    with open(f"{folder}/attitude-filter-in.csv") as file:
        read = [[mpf(cell) for cell in row] for row in list(csv.reader(file))[1:]]
    prior = diag([mpf("1e-3") ** 2] * 3 + [mpf("1e-5") ** 2] * 3)
    state, at = ([mpf(x) for x in PRIOR], matrix([0, 0, 0]), prior), 0
    lines, told = [], []
    for k in ROWS:
        while at + 4 <= k - 2:
            for _ in range(4):
                at += 1
                state = predicted(state, matrix(read[at][2:5]))
            state, nis = corrected(state, read[at][5:9])
            told.append(nis)
        q, b, p = state
        for later in range(at + 1, k + 1):
            q, b, p = predicted((q, b, p), matrix(read[later][2:5]))
        error = matrix([*vector(q, read[k][9:13]), *(matrix(read[k][13:16]) - b)])
        nees = (error.T * p**-1 * error)[0]
        lines.append([k, k * STEP, *q, *b, *(sqrt(p[i, i]) for i in range(6)), nees])
    header = "k,t_s,q0,q1,q2,q3,b1,b2,b3,s_theta1,s_theta2,s_theta3,s_b1,s_b2,s_b3,nees"
    with open(f"{folder}/attitude-filter-out.csv", "w") as file:
        print(header, file=file)
        for k, t, *values in lines:
            print(",".join([str(k), str(float(t)), *(f"{float(x):.16e}" for x in values)]), file=file)
    print(*(f"{float(nis):.16g}" for nis in told[:3]))


if __name__ == "__main__":
    main(sys.argv[1])
