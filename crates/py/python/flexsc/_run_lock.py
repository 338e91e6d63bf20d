"""The lock of runs that several threads read and advance."""

from __future__ import annotations

from _thread import RLock


class RunLock:
    """A lock under which runs are read and advanced. A thread may hold it several times.

    A part written in Python is called on a thread of the engine, while the thread that advances the runs
    holds the lock: were it to wait, neither would go on. Where there are such parts, none waits.
    """

    def __init__(self, waits: bool) -> None:
        self._lock = RLock()
        self._waits = waits

    def __enter__(self) -> None:
        if not self._lock.acquire(blocking=self._waits):
            raise RuntimeError("another thread is advancing the runs, whose parts are written in Python")

    def __exit__(self, *_: object) -> None:
        self._lock.release()
