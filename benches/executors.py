"""Measures what executors add to a campaign: a process pool and Dask, with tasks of several lengths.

pip install . 'flexsc[dask]'
python3 benches/executors.py        # 90 s on two cores; prints the overheads of docs/campaigns.md
"""

import os
import tempfile
import time
from concurrent.futures import Executor, ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import flexsc
from distributed import Client, LocalCluster
from flexsc import Scenario
from flexsc.dask import _Executor

WORKERS = 2
WORK_S = 16.0
TASKS_S = (0.25, 0.5, 1.0, 2.0)


def nothing(_: int) -> None:
    """A task that does nothing."""


def timed(executor: Executor, study: Scenario, runs: int, task_s: float) -> tuple[float, float, int]:
    """Wall time (s) of a campaign, the sum of what its runs took (s), and the number of its tasks."""
    tasks: list[tuple[int, int]] = []
    with tempfile.TemporaryDirectory() as out:
        began = time.perf_counter()
        flexsc.campaign(
            study,
            runs,
            out=out,
            executor=executor,
            task_s=task_s,
            progress=lambda *done: tasks.append(done),
        )
        wall = time.perf_counter() - began
        from flexsc._native import Directory

        seconds = Directory.open(out).column("seconds")
    return wall, float(seconds.sum()), len(tasks)


def each_task(executor: Executor, count: int) -> float:
    """Time (s) of a task that does nothing, many at once."""
    began = time.perf_counter()
    for future in [executor.submit(nothing, index) for index in range(count)]:
        future.result()
    return (time.perf_counter() - began) / count


def main() -> None:
    study = Scenario.example("wheel-ekf").with_("duration", 300.0)
    began = time.perf_counter()
    flexsc.campaign(study, 400, jobs=WORKERS)
    runs = int(400 * WORK_S / (time.perf_counter() - began) / WORKERS) * WORKERS
    rows: list[tuple[Any, ...]] = []
    with (
        ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool,
        LocalCluster(
            n_workers=WORKERS, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        executors = {"process pool": pool, "Dask": _Executor(client)}
        for executor in executors.values():
            flexsc.campaign(study, 200, executor=executor)
        for task_s in TASKS_S:
            for name, executor in executors.items():
                wall, inside, tasks = timed(executor, study, runs, task_s)
                rows.append((name, task_s, tasks, inside / tasks, wall, 100 * (wall * WORKERS / inside - 1)))
        nothings = {name: each_task(executor, 2000) for name, executor in executors.items()}
    print(f"{runs} runs on {WORKERS} workers, {os.cpu_count()} cores\n")
    print(
        "| executor | `task_s` | tasks | a task, s | wall, s | beyond the runs |\n|---|---|---|---|---|---|"
    )
    for name, task_s, tasks, each, wall, more in sorted(rows, key=lambda row: row[:2]):
        print(f"| {name} | {task_s} | {tasks} | {each:.2f} | {wall:.1f} | {more:.1f} % |")
    for name, each in nothings.items():
        print(f"\nA task that does nothing: {name} {1e3 * each:.2f} ms")


if __name__ == "__main__":
    main()
