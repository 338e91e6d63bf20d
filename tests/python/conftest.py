"""What the tests of the Python package share: the shipped scenarios and the command."""

import importlib.util
import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import flexsc
import pytest

ROOT = Path(__file__).parents[2]
SCENARIOS = ROOT / "scenarios"

Command = Callable[..., "subprocess.CompletedProcess[bytes]"]


def shipped(name: str) -> flexsc.Scenario:
    return flexsc.Scenario.load(SCENARIOS / f"{name}.toml")


def command_path() -> str:
    """The `flexsc` that was installed with the package under test."""
    found = shutil.which("flexsc", path=str(Path(sys.executable).parent))
    assert found, "the command is installed beside Python"
    return found


@pytest.fixture(autouse=True)
def no_open_figures() -> Iterator[None]:
    """Closes the figures of a test, of which Matplotlib warns when there are many."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def command(tmp_path: Path) -> Command:
    """Runs the command in a directory of the test's own."""

    def run(*arguments: str | Path, exits: int = 0) -> "subprocess.CompletedProcess[bytes]":
        done = subprocess.run(
            [command_path(), *map(str, arguments)], cwd=tmp_path, capture_output=True, check=False
        )
        assert done.returncode == exits, done.stderr.decode()
        return done

    return run


def json_lines(done: "subprocess.CompletedProcess[bytes]") -> list[dict[str, Any]]:
    return [json.loads(line) for line in done.stdout.splitlines()]


@pytest.fixture(scope="session")
def adaptive() -> flexsc.Scenario:
    return shipped("relay-adaptive")


@pytest.fixture(scope="session")
def fixed() -> flexsc.Scenario:
    return shipped("relay-fixed")


@pytest.fixture(scope="session")
def sampled() -> flexsc.Scenario:
    """A scenario with noise and uncertain keys, shortened."""
    return shipped("relay-sampled").with_("duration", 1000.0)


def class_generator(name: str) -> Any:
    """The program `crates/py/NAME.py`, which writes classes from a schema."""
    path = ROOT / "crates" / "py" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
