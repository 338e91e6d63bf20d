"""Campaigns on Dask: `flexsc.dask.campaign(client, ...)`, and `python -m flexsc.dask SCHEDULER DIR`.

The extra `flexsc[dask]` installs the dependencies. flexsc must also be installed on the workers.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from _thread import interrupt_main
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from importlib import import_module
from threading import Thread
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._campaign import campaign as _campaign
from flexsc._design import Sample
from flexsc._executor import Local, run
from flexsc._progress import Progress
from flexsc._result import Detail
from flexsc._scenario import Scenario
from flexsc._table import Table

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["campaign"]


def campaign(
    client: Client,
    scenario: Scenario,
    runs: int | range = 1000,
    jobs: int | None = None,
    seed: int | None = None,
    yes: bool = False,
    *,
    metrics: str | Sequence[str] | None = None,
    sample: Sample = "random",
    replicas: int = 1,
    out: str | os.PathLike[str] | None = None,
    log: Detail = "none",
    task_s: float = 1.0,
    force: bool = False,
    progress: Progress = None,
) -> Table:
    """Simulate many runs of a scenario on the workers of a Dask cluster.

    Workers write their rows to `out`, a directory that all of them can reach or a location that `fsspec`
    supports; without it the rows return through this process. Rows do not depend on the number of workers or
    on the loss of workers: the task of a lost worker is repeated by another one.

    Args:
        client: The client of a scheduler.
        scenario: The scenario from which the runs are drawn.
        runs: The number of runs, or their range (of step 1).
        jobs, seed, yes, metrics, sample, replicas, out, log, task_s, force, progress: As in
            `flexsc.campaign`.

    Raises:
        ScenarioError, ValueError, OSError: As in `flexsc.campaign`.
    """
    return _campaign(
        scenario,
        runs,
        jobs,
        seed,
        yes,
        metrics=metrics,
        sample=sample,
        replicas=replicas,
        out=out,
        log=log,
        executor=_Executor(client),
        task_s=task_s,
        force=force,
        progress=progress,
    )


class _Executor(Executor):
    """Tasks on the workers of a client. A task whose workers are lost ends with an error."""

    def __init__(self, client: Any) -> None:
        self._client = client
        # A task that nobody keeps is given up by its scheduler.
        self._kept: dict[Any, Future[Any]] = {}

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Submit a task. A deleted part is made again: tasks are not identified by their arguments."""
        result: Future[Any] = Future()
        try:
            task = self._client.submit(fn, *args, **kwargs, pure=False, retries=10)
        except Exception:
            # A client that lost its scheduler closes between two checks.
            self.check()
            raise
        self._kept[task] = result

        def done(task: Any) -> None:
            try:
                result.set_result(task.result())
            except BaseException as error:
                result.set_exception(error)
            finally:
                self._kept.pop(task, None)

        task.add_done_callback(done)
        return result

    def check(self) -> None:
        """Raise an error if the scheduler is lost: its tasks never end.

        A client waits for its scheduler to come back, for `distributed.comm.timeouts.connect`, and closes.
        """
        status = self._client.status
        if status not in ("running", "connecting", "newly-created"):
            raise OSError("the connection to the scheduler is lost: the same call continues the campaign")

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Cancel the unfinished tasks; the client stays open."""
        for task in list(self._kept):
            task.cancel()


def main(arguments: list[str] | None = None) -> int:
    """Run the missing parts of a campaign directory on the workers of a scheduler."""
    parser = argparse.ArgumentParser("python -m flexsc.dask", description=main.__doc__)
    parser.add_argument("--until-stdin-closes", action="store_true", help="end when standard input is closed")
    parser.add_argument("scheduler", help="address of the scheduler, such as tcp://10.0.0.1:8786")
    parser.add_argument("directory", help="directory of a campaign, which all workers reach")
    given = parser.parse_args(arguments)
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        print("error: a Dask scheduler needs dask: pip install 'flexsc[dask]'", file=sys.stderr)
        return 2
    if given.until_stdin_closes:
        Thread(target=_end_with_stdin, daemon=True).start()
    work = engine.Directory.open(given.directory).work
    began = time.monotonic()

    def progress(done: int, total: int) -> None:
        took = time.monotonic() - began
        print(f"\r{done} of {total} runs, {took:.0f} s", end="", file=sys.stderr, flush=True)

    try:
        with distributed.Client(given.scheduler) as client:
            run(work, Local(given.directory).name, _Executor(client), 0, 1.0, False, progress)
    except OSError as error:
        print(f"\nerror: {error}", file=sys.stderr)
        return 1
    except ValueError as error:
        # An address that is none; `flexsc --scheduler` knows it by this code.
        print(f"\nerror: {given.scheduler}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    print(file=sys.stderr)
    return 0


def _end_with_stdin() -> None:
    """End this process once whoever started it has ended, or asks for that."""
    while os.read(0, 4096):
        pass
    interrupt_main()
    # What does not listen to an interrupt is ended all the same; no file is left half written.
    time.sleep(1.0)
    os._exit(130)


if __name__ == "__main__":
    sys.exit(main())
