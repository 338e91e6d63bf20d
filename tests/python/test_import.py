"""What an import brings: little, quickly; the rest when it is asked for."""

import subprocess
import sys

import flexsc
import pytest


def told(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_an_import_brings_nothing_big() -> None:
    big = ["numpy", "matplotlib", "scipy", "pyarrow", "dataclasses", "flexsc.scenario", "flexsc.structure"]
    assert told(f"import sys, flexsc; print([name for name in {big} if name in sys.modules])") == "[]"


def test_what_is_left_for_later_is_there() -> None:
    names = "flexsc.scenario.Planar.__name__, flexsc.from_csv.__name__, flexsc.structure.__name__"
    assert told(f"import flexsc; print({names})") == "Planar from_csv flexsc.structure"
    assert set(flexsc.__all__) <= set(dir(flexsc))
    for name in set(flexsc.__all__) - {"plot"}:
        assert getattr(flexsc, name) is not None
    with pytest.raises(AttributeError, match="module 'flexsc' has no attribute 'wings'"):
        flexsc.wings  # type: ignore[attr-defined]  # noqa: B018


def test_the_module_is_the_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "flexsc", "--version"], capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == f"flexsc {flexsc.__version__}"
