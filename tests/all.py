"""All tests of flexsc, Rust and Python: `python3 tests/all.py`.

Formatting and lints, the Rust tests, then the Python wheel in an environment of its own and its tests.
"""

import os
import shutil
import signal
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = ROOT / "target" / "venv"


def run(*command):
    print("+", " ".join(map(str, command)), flush=True)
    done = subprocess.run(command, cwd=ROOT, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def main():
    if sys.version_info < (3, 10):
        sys.exit("flexsc needs Python 3.10 or newer")
    if shutil.which("cargo") is None:
        sys.exit("flexsc needs Rust: no `cargo` on the path")
    # A shell's background jobs ignore Ctrl-C, and what they start inherits that: the tests send it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    binaries = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
    if not binaries.exists():
        venv.create(ENVIRONMENT, with_pip=True)
    python = binaries / "python"
    run("cargo", "fmt", "--all", "--check")
    run("cargo", "clippy", "--release", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings")
    run("cargo", "test", "--release", "--quiet")
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", ".[test]")
    run(python, "-m", "ruff", "check", ".")
    run(python, "-m", "ruff", "format", "--check", ".")
    run(python, "-m", "pytest", "tests/python", "-q")


if __name__ == "__main__":
    main()
