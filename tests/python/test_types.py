"""Types: the stub says what the engine has, and a user's code checks."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
USAGE = Path(__file__).with_name("usage.py")
TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.py"))
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def run(*arguments: str | Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", *map(str, arguments)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stub_is_that_of_the_engine() -> None:
    run("mypy.stubtest", "flexsc._native")


def test_the_package_is_typed() -> None:
    run("mypy", "--strict", "--package", "flexsc")


def test_usage_tests_tutorials_and_examples_are_typed() -> None:
    makers = sorted((ROOT / "crates" / "py").glob("*.py"))
    run("mypy", "--strict", *sorted(USAGE.parent.glob("*.py")), *makers, *TUTORIALS, *EXAMPLES)


def test_pyright_agrees() -> None:
    # Pyright as wheels of PyPI; what is checked is in pyproject.toml.
    pytest.importorskip("basedpyright", reason="basedpyright has no wheel for this platform")
    run("basedpyright", "--project", ROOT, "--pythonpath", sys.executable)


def test_the_usage_runs() -> None:
    done = subprocess.run([sys.executable, USAGE], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
