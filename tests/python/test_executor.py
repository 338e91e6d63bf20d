"""Campaigns on executors, in directories and in buckets: the same rows everywhere, and after any death."""

from __future__ import annotations

import csv
import json
import os
import random
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import command_path
from flexsc import Scenario, Table


@pytest.fixture(scope="module")
def study() -> Scenario:
    """A relay with an uncertain gain and rate, some milliseconds a run."""
    return Scenario(
        {
            "duration": 800.0,
            "seed": 7,
            "body": {
                "planar": {
                    "angle": 4.5e-4,
                    "rate": 2.2e-5,
                    "modes": [{"frequency": 0.44, "gain": 0.0213, "displacement": 2.75e-6}],
                }
            },
            "law": {
                "relay": {"dead_zone": 5e-4, "hysteresis": 1e-4, "strong": 4e-5, "weak": 1e-6, "k_t": 0.31}
            },
            "estimator": {"envelope": {"window": 100.0}},
            "uncertain": {
                "law.relay.k_t": {"uniform": [0.3, 0.32]},
                "body.planar.rate": {"relative_normal": 0.1},
            },
        },
        "study",
    )


def same(one: Table, other: Table) -> None:
    """Two tables have the same rows."""
    assert list(one) == list(other)
    assert one.varied == other.varied
    for name in one:
        a, b = one[name], other[name]
        assert a.dtype == b.dtype, name
        if a.dtype == object:
            assert len(a) == len(b)
            for mine, theirs in zip(a, b, strict=True):
                np.testing.assert_array_equal(mine, theirs, err_msg=name)
        else:
            np.testing.assert_array_equal(a, b, err_msg=name)
    assert one.statistics().keys() == other.statistics().keys()
    for name, told in one.statistics().items():
        assert repr(told) == repr(other.statistics()[name])


@pytest.fixture(scope="module")
def whole(study: Scenario) -> Table:
    """A campaign of 600 runs, in this process."""
    return flexsc.campaign(study, 600, jobs=1)


def processes(count: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(count, mp_context=get_context("spawn"))


def test_rows_are_the_same_on_any_executor(study: Scenario, whole: Table, tmp_path: Path) -> None:
    same(whole, flexsc.campaign(study, 600, jobs=8))
    for count in (1, 8):
        with ThreadPoolExecutor(count) as pool:
            out = tmp_path / f"threads-{count}"
            same(whole, flexsc.campaign(study, 600, out=out, executor=pool, task_s=0.1))
            same(whole, flexsc.read_campaign(out))
    with processes(2) as pool:
        same(whole, flexsc.campaign(study, 600, executor=pool, task_s=0.1))
        same(whole, flexsc.campaign(study, 600, out=tmp_path / "p", executor=pool, task_s=0.1))
        # It is all there: nothing is handed in.
        told: list[tuple[int, int]] = []
        flexsc.campaign(
            study, 600, out=tmp_path / "p", executor=pool, progress=lambda *done: told.append(done)
        )
        assert told == []


def test_a_directory_of_the_command_is_the_same(study: Scenario, whole: Table, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(study.to_toml())
    command = [sys.executable, "-m", "flexsc", "simulate", "study.toml", "--runs", "600", "-o", "out"]
    subprocess.run([*command, "--table", "parquet"], cwd=tmp_path, check=True, capture_output=True)
    table = flexsc.read_campaign(tmp_path / "out")
    same(whole, table)
    assert table.scenario.name == "study"
    # And Python goes on where the command was.
    parts = sorted((tmp_path / "out/runs").glob("part-*"))
    before = {path.name: path.read_bytes() for path in parts}
    assert before
    parts[0].unlink()
    same(whole, flexsc.campaign(study, 600, out=tmp_path / "out"))
    assert {path.name for path in (tmp_path / "out/runs").glob("part-*")} == set(before)


def test_tables_of_others_read_the_parts(study: Scenario, whole: Table, tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow.parquet")
    flexsc.campaign(study, 600, out=tmp_path / "out")
    rows = arrow.read_table(tmp_path / "out/runs", filters=[("switchings", ">", 0)])
    assert rows.num_rows == int((whole["switchings"] > 0).sum())
    np.testing.assert_array_equal(np.sort(rows["run"].to_numpy()), whole["run"][whole["switchings"] > 0])


def test_places_that_fsspec_knows(study: Scenario, whole: Table, tmp_path: Path) -> None:
    fsspec = pytest.importorskip("fsspec")
    with ThreadPoolExecutor(2) as pool:
        out = "memory://bucket/study"
        same(whole, flexsc.campaign(study, 600, out=out, executor=pool, task_s=0.1))
        same(whole, flexsc.read_campaign(out))
        files = fsspec.filesystem("memory")
        names = [path.rpartition("/")[2] for path in files.ls("/bucket/study/runs", detail=False)]
        assert not [name for name in names if "partial" in name]
        files.rm_file("/bucket/study/runs/" + next(name for name in names if name.startswith("part-")))
        same(whole, flexsc.campaign(study, 600, out=out, executor=pool))
        with pytest.raises(ValueError, match="another campaign"):
            flexsc.campaign(study.with_("duration", 700.0), 600, out=out, executor=pool)
        # More runs continue it, as in a directory.
        more = flexsc.campaign(study, 700, out=out, executor=pool)
        assert more.rows == 700
        assert (more["switchings"][:600] == whole["switchings"]).all()
        with pytest.raises(ValueError, match="holds 700 runs of this campaign, and 5 would replace them"):
            flexsc.campaign(study, 5, out=out, executor=pool)
        files.rm_file("/bucket/study/manifest.toml")
        with pytest.raises(ValueError, match="its campaign is unknown"):
            flexsc.campaign(study, 700, out=out, executor=pool)
        flexsc.campaign(study, 700, out=out, executor=pool, force=True)
        fewer = flexsc.campaign(study.with_("duration", 700.0), 20, out=out, executor=pool, force=True)
        assert fewer.rows == 20
    with processes(2) as pool:
        same(whole, flexsc.campaign(study, 600, out=f"file://{tmp_path}/out", executor=pool, task_s=0.1))


def test_a_broken_pool_is_an_error_and_the_same_call_goes_on(
    study: Scenario, whole: Table, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with processes(2) as pool:

        def kill(done: int, total: int) -> None:
            for pid in pool._processes or {}:
                os.kill(pid, signal.SIGKILL)

        with pytest.raises(BrokenProcessPool):
            flexsc.campaign(study, 600, out=out, executor=pool, task_s=0.05, progress=kill)
    assert 0 < len(flexsc.read_campaign(out)) < 600
    with processes(2) as pool:
        same(whole, flexsc.campaign(study, 600, out=out, executor=pool))


def test_a_killed_process_leaves_whole_parts(study: Scenario, whole: Table, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(study.to_toml())
    script = """
        import flexsc
        from concurrent.futures import ThreadPoolExecutor
        with ThreadPoolExecutor(2) as pool:
            study = flexsc.Scenario.load("study.toml")
            flexsc.campaign(study, 600, out="out", executor=pool, task_s=0.05)
    """
    moments = random.Random(3)
    for _ in range(5):
        child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], cwd=tmp_path)
        time.sleep(moments.uniform(0.1, 0.6))
        child.kill()
        child.wait()
    same(whole, flexsc.campaign(study, 600, out=tmp_path / "out"))
    assert not list((tmp_path / "out").rglob("*.partial"))


def test_another_campaign_is_not_replaced(study: Scenario, tmp_path: Path) -> None:
    flexsc.campaign(study, 20, out=tmp_path)
    with pytest.raises(ValueError, match="another campaign"):
        flexsc.campaign(study.with_("duration", 700.0), 20, out=tmp_path)
    assert flexsc.campaign(study.with_("duration", 700.0), 20, out=tmp_path, force=True).rows == 20
    study = study.with_("duration", 700.0)
    # Fewer runs than there are would be rows of other runs; a range adds to those that are there.
    with pytest.raises(
        ValueError, match=r"holds 20 runs of this campaign, and 3 would replace them(.|\n)*force=True"
    ):
        flexsc.campaign(study, 3, out=tmp_path)
    assert flexsc.read_campaign(tmp_path).rows == 20
    assert flexsc.campaign(study, range(20, 24), out=tmp_path).rows == 24
    assert flexsc.campaign(study, 3, out=tmp_path, force=True)["run"].tolist() == [0, 1, 2]
    values = {"law.relay.k_t": [0.30, 0.31, 0.32]}
    flexsc.sweep(study, values, out=tmp_path / "sweep")
    assert flexsc.sweep(study, values, out=tmp_path / "sweep", runs=range(1, 2)).rows == 3
    with pytest.raises(ValueError, match="is not a campaign"):
        flexsc.read_campaign(tmp_path / "nowhere")


@pytest.mark.parametrize("ending", ["csv", "parquet"])
@pytest.mark.parametrize("pool", [None, "threads"])
def test_a_path_with_the_ending_of_a_table_is_one_file(
    study: Scenario, tmp_path: Path, ending: str, pool: str | None
) -> None:
    out = tmp_path / "new" / f"rows.{ending}"
    with ThreadPoolExecutor(2) as threads:
        executor = threads if pool else None
        table = flexsc.campaign(study, 6, out=out, executor=executor)
        assert out.is_file()
        same(table, flexsc.campaign(study, 6))
        if ending == "csv":
            with out.open(newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            assert [int(row["run"]) for row in rows] == table["run"].tolist()
            assert [float(row["duty"]) for row in rows] == table["duty"].tolist()
        else:
            read = pytest.importorskip("pyarrow.parquet").read_table(out)
            assert read["duty"].to_pylist() == table["duty"].tolist()
        before = out.read_bytes()
        with pytest.raises(ValueError, match=r"already exists(.|\n)*force=True"):
            flexsc.campaign(study, 3, out=out, executor=executor)
        assert out.read_bytes() == before
        assert flexsc.campaign(study, 3, out=out, executor=executor, force=True).rows == 3
        assert out.read_bytes() != before
        bucket = f"memory://{pool}/rows.{ending}"
        flexsc.campaign(study, 2, out=bucket, executor=executor)
        assert pytest.importorskip("fsspec").filesystem("memory").exists(f"/{pool}/rows.{ending}")
        with pytest.raises(ValueError, match="already exists"):
            flexsc.campaign(study, 2, out=bucket, executor=executor)
    assert [path.name for path in out.parent.iterdir()] == [out.name]


def test_other_endings_and_inputs_are_no_place_for_rows(study: Scenario, tmp_path: Path) -> None:
    with pytest.raises(
        ValueError, match=r"out: \S+rows\.svg cannot be written as \.svg(.|\n)*\.csv or \.parquet"
    ):
        flexsc.campaign(study, 2, out=tmp_path / "rows.svg")
    with pytest.raises(ValueError, match="cannot contain the logs"):
        flexsc.campaign(study, 2, out=tmp_path / "rows.csv", log="events")
    points = tmp_path / "points.csv"
    points.write_text("law.relay.k_t\n0.3\n")
    with pytest.raises(ValueError, match="the table of the points"):
        flexsc.sweep(study, points=points, out=points, force=True)
    assert list(tmp_path.iterdir()) == [points]
    # The version of a directory is no ending.
    assert flexsc.campaign(study, 2, out=tmp_path / "v1.2").rows == 2
    assert (tmp_path / "v1.2" / "manifest.toml").is_file()


def test_some_metrics_and_designs(study: Scenario) -> None:
    table = flexsc.campaign(study, 64, metrics=["switchings", "goal"], sample="sobol")
    assert list(table) == ["run", "seed", *table.varied, "switchings", "goal", "error"]
    # A Sobol sequence fills each half of a range with half of the points.
    assert (table["law.relay.k_t"] < 0.31).sum() == 32
    twice = flexsc.campaign(study, 10, replicas=2)
    assert (twice["law.relay.k_t"][::2] == twice["law.relay.k_t"][1::2]).all()
    with pytest.raises(ValueError, match=r"no metric `switching`[\s\S]*did you mean `switchings`"):
        flexsc.campaign(study, 2, metrics=["switching"])
    with pytest.raises(ValueError, match="sample must be one of"):
        flexsc.campaign(study, 2, sample="halton")  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """A scheduler and two workers, each a process of its own, over TCP."""
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, protocol="tcp://"
    )
    with cluster, distributed.Client(cluster) as client:
        yield client


@pytest.mark.filterwarnings("ignore")
def test_dask_survives_the_deaths_of_workers(
    cluster: Any, study: Scenario, whole: Table, tmp_path: Path
) -> None:
    from flexsc.dask import campaign

    same(whole, campaign(cluster, study, 600, task_s=0.1))
    moments = random.Random(5)

    def kill(done: int, total: int) -> None:
        # A worker that begins anew has no process yet.
        pids = [nanny.pid for nanny in cluster.cluster.workers.values() if nanny.pid]
        if len(pids) == 2 and len(killed) < 4 and moments.random() < 0.3:
            os.kill(moments.choice(pids), signal.SIGKILL)
            killed.append(done)

    killed: list[int] = []
    out = tmp_path / "out"
    same(whole, campaign(cluster, study, 600, out=out, task_s=0.05, progress=kill))
    assert killed


def test_the_command_hands_a_campaign_to_a_scheduler(study: Scenario, whole: Table, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "study.toml").write_text(study.to_toml())
    told = tmp_path / "scheduler.json"
    begun: list[subprocess.Popen[bytes]] = []

    def start(*arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", *arguments, "--scheduler-file", str(told), "--no-dashboard"]
        process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.DEVNULL)
        begun.append(process)
        return process

    worker = ("worker", "--no-nanny", "--nthreads", "1")
    try:
        start("scheduler", "--host", "127.0.0.1", "--port", "0")
        address = _address(told)
        first = start(*worker)
        start(*worker)
        command = [command_path(), "simulate", "study.toml", "--runs", "600", "-o", "out"]
        handed = subprocess.Popen(
            [*command, "--scheduler", address], cwd=tmp_path, stderr=subprocess.PIPE, env=dict(os.environ)
        )
        while not list((tmp_path / "out").glob("runs/*.parquet")) and handed.poll() is None:
            time.sleep(0.02)
        first.kill()
        start(*worker)
        _, errors = handed.communicate(timeout=120)
        assert handed.returncode == 0, errors.decode()
        assert "600 runs" in errors.decode()
    finally:
        for process in begun:
            process.kill()
            process.wait()
    same(whole, flexsc.read_campaign(tmp_path / "out"))
    ran = subprocess.run(
        [*command, "--scheduler", address, "--json"], cwd=tmp_path, capture_output=True, check=False
    )
    assert ran.returncode == 2
    assert b"leave out --json" in ran.stderr


def _address(told: Path) -> str:
    """Return the address in a scheduler's file, which exists a moment before it is written."""
    deadline = time.monotonic() + 60.0
    while not (told.exists() and told.read_text().rstrip().endswith("}")) and time.monotonic() < deadline:
        time.sleep(0.1)
    return str(json.loads(told.read_text())["address"])


def _scheduler(path: Path) -> tuple[list[subprocess.Popen[bytes]], str]:
    """Start a scheduler and a worker, each a process of its own; the scheduler is the first."""
    told = path / "scheduler.json"
    command = [sys.executable, "-m", "dask"]
    options = ("--scheduler-file", str(told), "--no-dashboard")
    begun = [
        subprocess.Popen(
            [*command, *arguments, *options], cwd=path, stderr=subprocess.DEVNULL, env=_impatient()
        )
        for arguments in (("scheduler", "--host", "127.0.0.1", "--port", "0"), ("worker", "--no-nanny"))
    ]
    return begun, _address(told)


def _impatient() -> dict[str, str]:
    """An environment in which Dask waits 3 s, not 30 s, for a scheduler to come back."""
    return {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "3s"}


LONG = """
    import sys, flexsc, flexsc.dask
    from distributed import Client
    with Client(sys.argv[1]) as client:
        study = flexsc.Scenario.load("study.toml").with_("duration", 20000.0)
        try:
            flexsc.dask.campaign(client, study, 100_000, out="out", task_s=0.2)
        except OSError as error:
            print(error)
"""


def test_the_death_of_a_scheduler_is_an_error(study: Scenario, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "study.toml").write_text(study.to_toml())
    begun, address = _scheduler(tmp_path)
    command = [command_path(), "simulate", "study.toml", "--runs", "100000", "--set", "duration=20000"]
    try:
        script = [sys.executable, "-c", textwrap.dedent(LONG), address]
        pipe = subprocess.PIPE
        first = subprocess.Popen(script, cwd=tmp_path, stdout=pipe, stderr=pipe, env=_impatient())
        begun.append(first)
        other = [*command, "-o", "other", "--scheduler", address]
        second = subprocess.Popen(other, cwd=tmp_path, stderr=pipe, env=_impatient())
        begun.append(second)
        for out in ("out", "other"):
            deadline = time.monotonic() + 300.0
            while not list(tmp_path.glob(f"{out}/runs/*.parquet")):
                assert time.monotonic() < deadline, f"no runs in {out}"
                time.sleep(0.02)
        begun[0].kill()
        told, errors = first.communicate(timeout=120)
        # The loss shows first in the campaign, or in a transfer of the library.
        assert b"connection to the scheduler is lost" in told or b"closed" in told, (told, errors)
        _, told = second.communicate(timeout=120)
        assert second.returncode == 1
        assert b"hint" not in told
        # The loss shows first in the campaign, or in a transfer of the library.
        assert b"connection to the scheduler is lost" in told or b"closed" in told
    finally:
        for process in begun:
            process.kill()
            process.wait()
    # The directory is free.
    shorter = flexsc.read_campaign(tmp_path / "out")
    assert 0 < len(shorter) < 100_000
    for out in ("out", "other"):
        force = [command_path(), "simulate", "study.toml", "--runs", "1", "-o", out, "--force"]
        ran = subprocess.run(force, cwd=tmp_path, capture_output=True, check=False)
        assert ran.returncode == 0, ran.stderr.decode()


@pytest.mark.parametrize("signal_number", [signal.SIGTERM, signal.SIGKILL])
def test_a_command_that_ends_takes_its_python_along(
    study: Scenario, tmp_path: Path, signal_number: signal.Signals
) -> None:
    pytest.importorskip("distributed")
    (tmp_path / "study.toml").write_text(study.to_toml())
    begun, address = _scheduler(tmp_path)
    command = [command_path(), "simulate", "study.toml", "--runs", "100000", "--set", "duration=20000"]
    command += ["-o", "out", "--scheduler", address]
    try:
        handed = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.DEVNULL, env=_impatient())
        begun.append(handed)
        deadline = time.monotonic() + 60.0
        while not list(tmp_path.glob("out/runs/*.parquet")) and time.monotonic() < deadline:
            time.sleep(0.02)
        handed.send_signal(signal_number)
        assert handed.wait(timeout=10) == (130 if signal_number == signal.SIGTERM else -signal.SIGKILL)
        # Its Python held the lock.
        again = [command_path(), "simulate", "study.toml", "--runs", "1", "-o", "out", "--force"]
        deadline = time.monotonic() + 10.0
        ran = subprocess.run(again, cwd=tmp_path, capture_output=True, check=False)
        while b"another process" in ran.stderr and time.monotonic() < deadline:
            time.sleep(0.2)
            ran = subprocess.run(again, cwd=tmp_path, capture_output=True, check=False)
        assert b"another process" not in ran.stderr, ran.stderr.decode()
    finally:
        for process in begun:
            process.kill()
            process.wait()
