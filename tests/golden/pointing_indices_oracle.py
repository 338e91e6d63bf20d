"""Pointing indices of ten runs of 600 s, by direct sums over every window.

The numbers are those of crates/core/src/metrics/pointing_index/tests.rs.

Runs r = 0..9, t = 0..599 s:
e = (r - 4.5) 2e-6 + (r mod 3 - 1) 1e-8 t + (3 + .4 r) 1e-6 sin(2 pi t/37 + .7 r).
Windows of 60 samples; PDE between windows that start 300 samples apart; order statistics ceil(P n).

Result (temporal 95 %, ensemble 95 %, ensemble 90 %, mixed 95 %):
APE      1.724567287820698e-05 1.887333392557536e-05 1.782729689861405e-05 1.418000000000001e-05
MPE      1.452724950792573e-05 1.519157323392090e-05 1.362700060344873e-05 1.247915722532795e-05
end      7.294397322598224e-06 7.331944764396158e-06 6.905929359468850e-06 6.254608568565470e-06
middle   7.789029757360907e-06 7.796561226530243e-06 7.319785771729352e-06 6.963480804605929e-06
uniform  7.172144590624965e-06 7.784933362871975e-06 7.292733462631508e-06 5.885141489739773e-06
PDE      3.797752597077720e-06 3.800039478792343e-06 3.753292172363373e-06 3.626771460733629e-06
"""

import numpy as np

WINDOW, SHIFT = 60, 300


def error(run):
    """Return the error (rad) of a run at each second."""
    t = np.arange(600.0)
    wave = (3 + 0.4 * run) * 1e-6 * np.sin(2 * np.pi * t / 37 + 0.7 * run)
    return (run - 4.5) * 2e-6 + (run % 3 - 1) * 1e-8 * t + wave


def quantile(values, level):
    """Return the order statistic ceil(level n)."""
    return np.sort(values)[int(np.ceil(level * len(values) * (1 - 4e-16))) - 1]


def index(e, kind):
    """Return the values of an index of an error."""
    count = len(e) - WINDOW + 1
    mean = np.array([e[i : i + WINDOW].mean() for i in range(count)])
    consecutive = range(0, count, WINDOW)
    return np.abs(
        {
            "APE": lambda: e,
            "MPE": lambda: mean,
            "end": lambda: e[WINDOW - 1 :] - mean,
            "middle": lambda: e[WINDOW // 2 :][:count] - mean,
            "uniform": lambda: np.concatenate([e[i : i + WINDOW] - mean[i] for i in consecutive]),
            "PDE": lambda: mean[SHIFT:] - mean[:-SHIFT],
        }[kind]()
    )


for kind in ("APE", "MPE", "end", "middle", "uniform", "PDE"):
    runs = [index(error(run), kind) for run in range(10)]
    most = [values.max() for values in runs]
    numbers = (
        max(quantile(values, 0.95) for values in runs),
        quantile(most, 0.95),
        quantile(most, 0.9),
        quantile(np.concatenate(runs), 0.95),
    )
    print(f"{kind:8}", *(f"{number:.15e}" for number in numbers))
