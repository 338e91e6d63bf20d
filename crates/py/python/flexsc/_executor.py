"""Campaigns on executors: tasks write whole parts to their final location and return only names."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from flexsc import _native as engine
from flexsc._table import Table, of_directory

Span = tuple[int, int]
"""The first run of a part and the run after its last."""

# A task that a scheduler gave up, since its workers died, is handed in again so often.
_AGAIN = 10
# What schedulers call such an end. Names, so that none of them has to be installed.
_GIVEN_UP = {"KilledWorker", "FutureCancelledError", "CancelledError", "LostWorkerError"}
# How often it is looked whether an executor still lives (s).
_LOOK = 1.0
# A task has at most so many parts: what is lost with a worker.
_MOST_PARTS = 64
_MANIFEST = "manifest.toml"
# Where the parts are.
_RUNS = "runs"


class Local:
    """A directory that all workers can reach by the same path."""

    def __init__(self, path: str) -> None:
        self.name = os.path.abspath(path)
        self._directory: engine.Directory | None = None

    def begin(self, work: engine.Work, part: bool, force: bool) -> engine.Work:
        """Create the directory or continue in an existing one; it is locked until `end`."""
        self._directory = engine.Directory.create(self.name, work, part, force)
        return self._directory.work

    def missing(self, work: engine.Work) -> list[Span]:
        """The missing parts."""
        return work.missing(os.listdir(os.path.join(self.name, _RUNS)))

    def finish(self) -> None:
        """Write the table of the statistics."""
        if self._directory is not None:
            self._directory.write_statistics()

    def end(self) -> None:
        """Release the lock for other processes."""
        self._directory = None

    def table(self) -> Table:
        """The rows present so far."""
        return of_directory(self.name)


class Remote:
    """A location that fsspec supports, such as a bucket."""

    def __init__(self, name: str) -> None:
        self.name = name

    def _files(self) -> tuple[Any, str]:
        return _file_system(self.name)

    def begin(self, work: engine.Work, part: bool, force: bool) -> engine.Work:
        """Write the manifest, or continue an existing campaign."""
        files, root = self._files()
        files.makedirs(f"{root}/{_RUNS}", exist_ok=True)
        at = f"{root}/{_MANIFEST}"
        if files.exists(at) and not force:
            there = engine.Work.parse(files.cat_file(at).decode())
            difference = work.difference(there)
            if difference is not None:
                raise ValueError(f"{self.name}: contains another campaign ({difference})")
            whole = work.joined(there)
            if not part and whole.runs != work.runs:
                held, asked = (end - start for start, end in (there.runs, work.runs))
                raise ValueError(f"{at}: holds {held} runs of this campaign, and {asked} would replace them")
            if whole.runs != there.runs:
                _put(files, at, whole.manifest.encode())
            return whole
        parts = [name for name in _names(files, f"{root}/{_RUNS}") if name.startswith("part-")]
        if parts and not force:
            raise ValueError(f"{self.name}/{_RUNS}/{parts[0]}: exists, but its campaign is unknown")
        for name in parts:
            files.rm_file(f"{root}/{_RUNS}/{name}")
        _put(files, at, work.manifest.encode())
        return work

    def missing(self, work: engine.Work) -> list[Span]:
        """The missing parts."""
        files, root = self._files()
        return work.missing(_names(files, f"{root}/{_RUNS}"))

    def finish(self) -> None:
        """Do nothing: whoever reads the rows has their statistics."""

    def end(self) -> None:
        """Do nothing: a bucket has no lock, and a part that is written twice has the same contents."""

    def table(self) -> Table:
        """The rows present so far, through a directory of this process."""
        files, root = self._files()
        kept = _Temporary()
        (kept.path / _RUNS).mkdir()
        files.get_file(f"{root}/{_MANIFEST}", str(kept.path / _MANIFEST))
        for name in _names(files, f"{root}/{_RUNS}"):
            if name.endswith(".parquet"):
                files.get_file(f"{root}/{_RUNS}/{name}", str(kept.path / _RUNS / name))
        return of_directory(kept.path, kept)


class _Temporary:
    """A directory that exists as long as this object."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="flexsc-"))

    def __del__(self) -> None:
        shutil.rmtree(self.path, ignore_errors=True)


def place(path: str | os.PathLike[str]) -> Local | Remote:
    """Return the location of a campaign from its path or its URL."""
    name = os.fspath(path)
    return Remote(name.rstrip("/")) if "://" in name else Local(name)


def run(
    work: engine.Work,
    out: str | os.PathLike[str] | None,
    executor: Executor | None,
    jobs: int,
    task_s: float,
    force: bool,
    progress: Callable[[int, int], None] | None,
    log: str = "none",
    is_part: bool = False,
) -> Table:
    """Run the missing parts of a campaign, and return all of its rows.

    A location that has the ending of a table is one file, which is written at the end.
    """
    file = None if out is None else _File.of(out, log, force)
    kept = _Temporary() if out is None or file is not None else None
    store = Local(str(kept.path)) if kept is not None else place(out or "")
    work = store.begin(work, is_part, force)
    total = work.runs[1] - work.runs[0]
    missing = store.missing(work)
    left = sum(end - start for start, end in missing)

    def done(parts: Sequence[Span]) -> None:
        nonlocal left
        left -= sum(end - start for start, end in parts)
        if progress is not None:
            progress(total - left, total)

    try:
        if executor is None:
            for part in missing:
                _write(store.name, work.hash, [part], jobs, log, force)
                done([part])
        elif kept is None:
            distribute(
                executor,
                missing,
                task_s,
                done,
                lambda parts: (_write, store.name, work.hash, parts, jobs, log, force),
            )
        else:

            def keep(results: list[tuple[str, bytes]]) -> None:
                for name, data in results:
                    (kept.path / _RUNS / name).write_bytes(data)

            distribute(
                executor, missing, task_s, done, lambda parts: (_bytes, work.manifest, parts, jobs), keep
            )
        if kept is None:
            store.finish()
    finally:
        store.end()
    if kept is None:
        return store.table()
    if file is not None:
        file.write(engine.Directory.open(str(kept.path)))
    return of_directory(kept.path, kept)


class _File(NamedTuple):
    """One file for all rows, on this machine or where fsspec reaches."""

    name: str
    ending: str

    @classmethod
    def of(cls, out: str | os.PathLike[str], log: str, force: bool) -> _File | None:
        """Return the file that `out` names, which must not exist unless `force`; None for a directory."""
        name = os.fspath(out)
        ending = engine.table_ending(name)
        if ending is None:
            return None
        if log != "none":
            raise ValueError(f"out: {name} cannot contain the logs of `log`: give a directory")
        if not force and (_exists(name) if "://" in name else os.path.lexists(name)):
            raise ValueError(f"out: {name} already exists\n\nhint: `force=True` replaces it")
        return cls(name, ending)

    def write(self, rows: engine.Directory) -> None:
        """Write the rows."""
        data = rows.table(self.ending)
        if "://" in self.name:
            files, path = _file_system(self.name)
            _put(files, path, data)
        else:
            os.makedirs(os.path.dirname(self.name) or ".", exist_ok=True)
            engine.write(self.name, data)


def distribute(
    executor: Executor,
    missing: list[Span],
    task_s: float,
    done: Callable[[Sequence[Span]], None],
    task: Callable[[list[Span]], tuple[Any, ...]],
    keep: Callable[[Any], None] | None = None,
) -> None:
    """Submit parts as tasks, some more than there are workers, and collect their results."""
    waiting = missing[::-1]
    again: list[tuple[list[Span], int]] = []
    out: dict[Future[Any], tuple[list[Span], int]] = {}
    workers = getattr(executor, "_max_workers", None) or _threads_of(executor)
    most = 2 * workers + 2
    # How long a part takes (s), by those that are done.
    parts_done, seconds = 0, 0.0
    while waiting or again or out:
        while (waiting or again) and len(out) < most:
            if again:
                parts, tries = again.pop()
            else:
                size = round(task_s * parts_done / seconds) if seconds > 0.0 else 1
                # At the end workers share what is left.
                size = min(max(size, 1), _MOST_PARTS, max(len(waiting) // most, 1))
                parts, tries = [waiting.pop() for _ in range(min(size, len(waiting)))], 0
            out[executor.submit(*task(parts))] = (parts, tries)
        ended = wait(out, _LOOK, FIRST_COMPLETED).done
        if not ended:
            # The tasks of a dead executor end with nothing.
            getattr(executor, "check", lambda: None)()
        for future in ended:
            parts, tries = out.pop(future)
            try:
                took, results = future.result()
            except Exception as error:
                if type(error).__name__ not in _GIVEN_UP or tries == _AGAIN:
                    for other in out:
                        other.cancel()
                    raise
                again.append((parts, tries + 1))
                continue
            if keep is not None:
                keep(results)
            parts_done, seconds = parts_done + len(parts), seconds + took
            done(parts)


def _threads_of(executor: Executor) -> int:
    """Return the number of tasks that an executor of Dask runs at once; if it is unknown, a large number."""
    client = getattr(executor, "_client", None)
    if client is None:
        return 64
    return max(sum(int(threads) for threads in client.nthreads().values()), 1)


@lru_cache(maxsize=4)
def _opened(name: str, _hash: str) -> engine.Directory:
    return engine.Directory.open(name)


@lru_cache(maxsize=4)
def _parsed(manifest: str) -> engine.Work:
    return engine.Work.parse(manifest)


@lru_cache(maxsize=4)
def _work_at(name: str, _hash: str) -> engine.Work:
    files, root = _file_system(name)
    return engine.Work.parse(files.cat_file(f"{root}/{_MANIFEST}").decode())


def _write(
    name: str, hashed: str, parts: Sequence[Span], jobs: int, log: str, force: bool
) -> tuple[float, None]:
    """Run parts and write them to the campaign's location: a worker's task. Return its duration (s)."""
    began = time.perf_counter()
    if "://" not in name:
        for part in parts:
            _opened(name, hashed).write_part(part, jobs, log, force)
    else:
        files, root = _file_system(name)
        for part in parts:
            file, data = _work_at(name, hashed).part(part, jobs)
            _put(files, f"{root}/{_RUNS}/{file}", data)
    return time.perf_counter() - began, None


def _bytes(manifest: str, parts: Sequence[Span], jobs: int) -> tuple[float, list[tuple[str, bytes]]]:
    """Run parts, and return their files."""
    began = time.perf_counter()
    results = [_parsed(manifest).part(part, jobs) for part in parts]
    return time.perf_counter() - began, results


def _file_system(name: str) -> tuple[Any, str]:
    try:
        core = import_module("fsspec.core")
    except ImportError:
        raise ImportError(f"{name}: places other than directories need fsspec: pip install fsspec") from None
    files, root = core.url_to_fs(name)
    return files, str(root).rstrip("/")


def _exists(name: str) -> bool:
    files, path = _file_system(name)
    return bool(files.exists(path))


def _names(files: Any, root: str) -> list[str]:
    # What other processes wrote is not in a listing that was kept; a bucket has no empty directories.
    files.invalidate_cache()
    if not files.exists(root):
        return []
    return [str(path).rpartition("/")[2] for path in files.ls(root, detail=False)]


def _put(files: Any, path: str, data: bytes) -> None:
    """Write a file atomically: under another name, and then renamed."""
    partial = f"{path}.{uuid.uuid4().hex}.partial"
    files.pipe_file(partial, data)
    files.mv(partial, path)
