"""Commands of `all.py`: what they print is shown in order, also of those that run side by side."""

import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What the runners of tests say at their ends.
SUMMARY = re.compile(r"^(test result: .*|(?:=+ )?\d+ (?:passed|failed).* in [\d.]+ ?s.*)$", re.MULTILINE)
SUMMARIES: list[str] = []


class Out(threading.local):
    """Where a thread shows what its commands print: at once, or of work side by side when it is done."""

    kept: bytearray | None = None

    def show(self, piece: bytes) -> None:
        if self.kept is None:
            sys.stdout.buffer.write(piece)
            sys.stdout.flush()
        else:
            self.kept += piece


OUT = Out()


def run(*command: str | Path, within: Path = ROOT) -> str:
    """Runs a command, which must succeed, and returns what it printed, which is also shown."""
    words = [str(word) for word in command]
    OUT.show(f"+ {' '.join(words)}\n".encode())
    printed = bytearray()
    errors = None if OUT.kept is None else subprocess.STDOUT
    with subprocess.Popen(words, cwd=within, stdout=subprocess.PIPE, stderr=errors) as process:
        assert process.stdout is not None
        while piece := os.read(process.stdout.fileno(), 4096):
            OUT.show(piece)
            printed += piece
    if process.returncode != 0:
        sys.exit(f"{command[0]} failed with {process.returncode}")
    text = printed.decode(errors="replace")
    SUMMARIES.extend(match.group(0) for match in SUMMARY.finditer(text))
    return text


def succeeds(*command: str | Path) -> bool:
    """Runs a command, whose output is not shown."""
    null = subprocess.DEVNULL
    return subprocess.run(command, cwd=ROOT, check=False, stdout=null, stderr=null).returncode == 0


def side_by_side(*works: Callable[[], str | None], count: int = 2) -> str:
    """Work that keeps one core busy, `count` at a time: each shows what it printed when it is done."""

    def kept(work: Callable[[], str | None]) -> tuple[bytes, str | SystemExit | None]:
        OUT.kept = bytearray()
        try:
            told: str | SystemExit | None = work()
        except SystemExit as failure:
            told = failure
        printed, OUT.kept = bytes(OUT.kept), None
        return printed, told

    results = []
    with ThreadPoolExecutor(count) as pool:
        for done in as_completed([pool.submit(kept, work) for work in works]):
            printed, told = done.result()
            OUT.show(printed)
            results.append(told)
    for told in results:
        if isinstance(told, SystemExit):
            raise told
    return ", ".join(str(told) for told in results if told)
