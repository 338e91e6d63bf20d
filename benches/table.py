"""Measures the engine beside its peers in one run, and writes the table of docs/benchmarks.md.

pip install scipy mpmath control bsk  # python-control and Basilisk (bsk) may be left out
python3 benches/table.py              # prints the tables
python3 benches/table.py --write      # and puts them into docs/benchmarks.md
python3 benches/table.py --write day  # the CubeSat's day alone; FORTY_TWO as in benches/day/beside.py
"""

import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

from day import beside

ROOT = Path(__file__).resolve().parent.parent
RUN = "run of 20000 s"
W, K = (0.44, 0.755), (0.0213, 0.0216)
EPS, GAM, STRONG, WEAK, K_T = 5e-4, 1e-4, 4e-5, 1e-6, 0.3389


def criterion(group, name):
    """Median time (s) of a benchmark, by criterion."""
    path = (
        ROOT
        / "target"
        / "criterion"
        / group.replace("/", "_")
        / name.replace("/", "_")
        / "new"
        / "estimates.json"
    )
    return json.loads(path.read_text())["median"]["point_estimate"] * 1e-9


def dop853(end):
    """CPU time (s) of SciPy's DOP853 with events, switching by switching, and the number of switchings."""
    from scipy.integrate import solve_ivp

    def field(m):
        return lambda t, s: [s[1], m, s[3], K[0] * m - W[0] ** 2 * s[2], s[5], K[1] * m - W[1] ** 2 * s[4]]

    def level(value, direction):
        def event(t, s):
            return s[0] + s[2] + s[4] - value

        event.terminal, event.direction = True, direction
        return event

    def advance(state, t, m, until, events):
        return solve_ivp(
            field(m), (t, until), state, method="DOP853", rtol=1e-9, atol=1e-14, events=events or None
        )

    began = time.process_time()
    state, t, m, count = [4.5e-4, 2.2e-5, 2.75e-6, 0.0, 0.0, 0.0], 0.0, WEAK, 0
    while True:
        run = advance(state, t, m, end, [level(EPS, 1), level(-EPS, -1)])
        if run.status != 1:
            return time.process_time() - began, count
        side = 1 if len(run.t_events[0]) else -1
        state, t, pushed, count = run.y[:, -1], run.t[-1], run.t[-1], count + 1
        run = advance(state, t, -side * STRONG, end, [level(side * (EPS - GAM), -side)])
        if run.status != 1:
            return time.process_time() - began, count
        state, t, count = run.y[:, -1], run.t[-1], count + 1
        until = t + K_T * (t - pushed)
        if until > end:
            return time.process_time() - began, count
        run = advance(state, t, side * STRONG, until, None)
        state, t, count, m = run.y[:, -1], run.t[-1], count + 1, side * WEAK


def eigenproblem(order):
    """Wall and CPU time (s) of SciPy's eigh on the matrices of the engine's benchmark, the median of nine."""
    import numpy as np
    from scipy.linalg import eigh

    apart = np.abs(np.subtract.outer(np.arange(order), np.arange(order)))
    mass = 1.0 / (1.0 + apart)
    mass[0, :] = mass[:, 0] = np.arange(order)
    mass[0, 0] = 1e9
    stiffness = np.where(apart == 0, 2000.0, np.where(apart == 1, -1000.0, 0.0))
    stiffness[0, :] = stiffness[:, 0] = 0.0
    times = []
    for _ in range(9):
        began = time.perf_counter(), time.process_time()
        eigh(stiffness, mass)
        times.append((time.perf_counter() - began[0], time.process_time() - began[1]))
    return sorted(times)[4]


def campaign(jobs):
    """Wall time (s) of 4000 adaptive runs on so many threads."""
    command = ["target/release/flexsc", "simulate", "scenarios/relay-adaptive.toml", "--runs", "4000"]
    began = time.perf_counter()
    subprocess.run([*command, "--jobs", str(jobs)], cwd=ROOT, check=True, stderr=subprocess.DEVNULL)
    return time.perf_counter() - began


def logs():
    """Sizes (bytes) of the events log and of the full log at 0.1 s."""
    sizes = []
    for detail in ("events", "full"):
        out = ROOT / "target" / "benchmark-logs"
        command = [
            "target/release/flexsc",
            "simulate",
            "scenarios/relay-fixed.toml",
            "--log",
            detail,
            "--set",
            "log.period=0.1",
            "-o",
            str(out),
        ]
        subprocess.run(command, cwd=ROOT, check=True, stderr=subprocess.DEVNULL)
        sizes.append((out / "relay-fixed.mcap").stat().st_size)
    return sizes


def duration(seconds):
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def loop():
    """The table of the sampled loop."""
    from loops import peers

    def one(name):
        return criterion("sampled loop", name)

    whole = one("400 s")
    rows = [
        ("flexsc, matrices and settling time", whole),
        ("flexsc, the same with another gain", one("400 s, another gain")),
        ("flexsc, with a command that is shaped", one("400 s, shaped command")),
        *peers(),
    ]
    lines = ["", "| 400 s of a sampled loop: 1333 samples, 11 states | CPU time | ratio |", "|---|---|---|"]
    for name, seconds in rows:
        told = ("not installed", "") if seconds is None else (duration(seconds), f"{seconds / whole:.3g}")
        lines.append(f"| {name} | {told[0]} | {told[1]} |")
    lines += [
        "",
        f"- Its spectral radius takes {duration(one('spectral radius'))}; a map of 96 frequencies and 200"
        f" periods from 0.1 to 2 s {duration(one('map of 96 x 200'))} on one thread, one of as many cells"
        f" with 1333 samples each {duration(one('map of 96 x 200, 0.3 s'))}.",
    ]
    return lines


def spatial():
    """The table of the space station."""
    import station

    def one(name):
        return criterion("station, 700 s", name)

    plain = one("12")
    rows = [
        ("flexsc, 12 modes, phase-plane law", plain),
        ("flexsc, the same with adaptive observers and active damping", one("damped")),
        ("flexsc, 135 modes, phase-plane law", one("135")),
        *station.peers(),
    ]
    lines = ["", "| 700 s of the space station's turn: 3500 cycles | CPU time | ratio |", "|---|---|---|"]
    for name, seconds in rows:
        told = ("not installed", "") if seconds is None else (duration(seconds), f"{seconds / plain:.3g}")
        lines.append(f"| {name} | {told[0]} | {told[1]} |")
    return lines


def filtered(name):
    return criterion("filter", name)


def side_by_side():
    """The rows of runs in lanes, on processors that have them."""
    group, many = "64 runs of 20000 s", 64
    yardstick = criterion(group, "yardstick") / many
    lines = [
        "",
        "| one of 64 runs with k_t from 0.28 to 0.40, all metrics | time | to the yardstick |",
        "|---|---|---|",
    ]
    rows = [("hand-written yardstick, events only", "yardstick"), ("flexsc, one by one", "one by one")]
    rows += [(f"flexsc, side by side, {name}", name) for name in ("AVX2", "AVX-512", "NEON")]
    for text, name in rows:
        if (
            name in ("AVX2", "AVX-512", "NEON")
            and not (ROOT / "target" / "criterion" / group / name).is_dir()
        ):
            continue
        time = criterion(group, name) / many
        lines.append(f"| {text} | {duration(time)} | {time / yardstick:.3g} |")
    return lines


def table():
    subprocess.run(["cargo", "build", "--release"], cwd=ROOT, check=True)
    subprocess.run(["cargo", "bench", "-p", "flexsc-bench", "--bench", "engine"], cwd=ROOT, check=True)
    events = criterion(RUN, "events only")
    scipy_time, scipy_events = dop853(2000.0)
    rows = [
        ("hand-written yardstick, two modes, this law only", criterion(RUN, "yardstick")),
        ("flexsc, events only", events),
        ("flexsc, every switching kept in memory", criterion(RUN, "events in memory")),
        ("flexsc, 40 window means of the envelope", criterion(RUN, "40 window means")),
        ("flexsc, window means and all metrics", criterion(RUN, "windows and metrics")),
        ("flexsc, window means, metrics and MCAP log", criterion(RUN, "windows, metrics, log")),
        ("RK4 at 1e-4 s, Rust (measured over 200 s)", 100 * criterion("fixed step, 200 s", "RK4 at 1e-4 s")),
        ("SciPy DOP853 with events, rtol 1e-9 (measured over 2000 s)", 10 * scipy_time),
    ]
    lines = ["| 20 000 s of relay-quiet: 2526 switchings | time | ratio to events only |", "|---|---|---|"]
    lines += [f"| {name} | {duration(t)} | {t / events:.3g} |" for name, t in rows]
    lines += side_by_side()
    lines += ["", "| modes | time of a run | per mode, relative to 200 |", "|---|---|---|"]
    per_mode = criterion("modes", "200") / 200
    for count in (2, 20, 50, 100, 200):
        t = criterion("modes", str(count))
        lines.append(f"| {count} | {duration(t)} | {t / count / per_mode:.2f} |")
    lines += loop()
    lines += spatial()
    solved, (wall, cpu) = criterion("structure", "1000"), eigenproblem(1000)
    dense = criterion("log", "dense MCAP")
    cores = os.cpu_count() or 1
    one, all_cores = campaign(1), campaign(cores)
    small, large = logs()
    lines += [
        "",
        f"- One event costs {duration(events / 2526)}; SciPy found {scipy_events} switchings in 2000 s.",
        f"- A sample of an extended Kalman filter of 12 states takes {duration(filtered('ekf step'))}, of an"
        f" unscented one {duration(filtered('ukf step'))}; 600 s of wheel-scheduled-gain, whose frequencies"
        f" drift, {duration(filtered('run of 600 s, mode known'))}, of wheel-ekf"
        f" {duration(filtered('run of 600 s, extended filter'))}, all metrics included.",
        f"- A dense log is written at {4 * 200_000 / dense / 1e6:.2f} million messages/s on one core,"
        " simulation included.",
        f"- The modes of a structure of order 1000 take {duration(solved)} on one core; SciPy's eigh"
        f" {duration(wall)} ({duration(cpu)} of CPU time on {cores} cores).",
        f"- 4000 adaptive runs: {one:.2f} s on one thread, {all_cores:.2f} s on {cores}:"
        f" {one / all_cores:.2f} times faster.",
        f"- Log of relay-fixed: {small / 1e3:.0f} kB with all switchings, {large / 1e6:.1f} MB with the full"
        " state every 0.1 s.",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    made = {"table": table, "day": beside.table}
    for name in made.keys() & set(sys.argv[1:]) or made:
        text = made[name]()
        print(text)
        if "--write" in sys.argv[1:]:
            page = ROOT / "docs" / "benchmarks.md"
            pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
            page.write_text(pattern.sub(lambda m, text=text: m[1] + text + m[2], page.read_text()))
