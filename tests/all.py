"""All tests of flexsc, Rust and Python: `python3 tests/all.py`.

Formatting and lints, the Rust tests, a minute of fuzzing, then the Python wheel in an environment of its own
and its tests.
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
# pyNastran wants an older numpy than the newest Pythons have: it has an environment of its own.
NASTRAN = ROOT / "target" / "venv-nastran"


def run(*command):
    print("+", " ".join(map(str, command)), flush=True)
    done = subprocess.run(command, cwd=ROOT, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def binaries(environment):
    """The programs of an environment, which is made if it is not there."""
    within = environment / ("Scripts" if os.name == "nt" else "bin")
    if not within.exists():
        venv.create(environment, with_pip=True)
    return within


def nastran():
    """The tests that need pyNastran, where it can be installed."""
    python = binaries(NASTRAN) / "python"
    options = ("--quiet", "--disable-pip-version-check")
    install = (python, "-m", "pip", "install", *options, ".[nastran]", "pytest")
    print("+", " ".join(map(str, install)), flush=True)
    if subprocess.run(install, cwd=ROOT, check=False).returncode != 0:
        print("pyNastran cannot be installed here: tests/python/test_nastran.py is left out", flush=True)
        return
    run(python, "-m", "pytest", "tests/python/test_nastran.py", "-q")


def papers():
    """docs/papers.md is what the program computes."""
    out = ROOT / "target" / "reproduce"
    run(ROOT / "target" / "release" / "flexsc", "reproduce", "-o", out, "--docs", out)
    made, kept = (path / "papers.md" for path in (out, ROOT / "docs"))
    if made.read_bytes() != kept.read_bytes():
        sys.exit(f"{kept} is not what `flexsc reproduce` makes: see {made}")


def crates():
    """Licences, sources and duplicates of all crates: by `cargo deny` too, where it is installed."""
    run(sys.executable, "tests/deny.py")
    if shutil.which("cargo-deny") is not None:
        run("cargo", "deny", "check", "bans", "licenses", "sources")


def main():
    if sys.version_info < (3, 10):
        sys.exit("flexsc needs Python 3.10 or newer")
    if shutil.which("cargo") is None:
        sys.exit("flexsc needs Rust: no `cargo` on the path")
    # A shell's background jobs ignore Ctrl-C, and what they start inherits that: the tests send it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    python = binaries(ENVIRONMENT) / "python"
    run("cargo", "fmt", "--all", "--check")
    crates()
    run("cargo", "clippy", "--release", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings")
    run("cargo", "test", "--release", "--quiet")
    papers()
    if os.name == "posix":
        run("cargo", "run", "--release", "--quiet", "-p", "flexsc-fuzz", "--", "--seconds", "12")
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", ".[test]")
    run(python, "-m", "ruff", "check", ".")
    run(python, "-m", "ruff", "format", "--check", ".")
    run(python, "-m", "pytest", "tests/python", "-q")
    nastran()


if __name__ == "__main__":
    main()
