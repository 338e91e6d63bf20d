"""All tests of flexsc, Rust and Python: `python3 tests/all.py`; `--quick` runs what a change needs first.

Each step prints about how long it takes on two cores from a clean checkout, and then how long it took. All
Rust is built with the profile `ci` and one set of features: nothing is compiled twice.
"""

import argparse
import contextlib
import os
import re
import shutil
import signal
import sys
import threading
import time
import venv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from commands import ROOT, SUMMARIES, run, side_by_side, succeeds

TARGET = ROOT / "target"
ENVIRONMENT = TARGET / "venv"
# pyNastran wants an older numpy than the newest Pythons have: it has an environment of its own.
NASTRAN = TARGET / "venv-nastran"
# The environment of `site/build.py`.
SITE = TARGET / "venv-site"
CI = ("--profile", "ci", "--quiet")
PIP = ("-m", "pip", "--quiet", "--disable-pip-version-check")
# Python tests that take long, and run beside the others: what pages say, executors, and type checkers.
PAGES = "tests/python/test_docs.py"
EXECUTORS = "tests/python/test_executor.py"
TYPES = "tests/python/test_types.py"
# The site runs all tutorials.
WITHOUT = ("-k", "not matplotlib_alone")
# Whether the wheel is in the environment, or could not be built or installed.
INSTALLED = threading.Event()
# So many inputs, the same on every machine: about 2 s each.
FUZZED = {
    "scenarios": "340",
    "structures": "750",
    "logs": "150",
    "arguments": "210",
    "live": "480",
    "parts": "200",
    "environment": "1200",
    "conditions": "420",
    "points": "720",
    "commands": "130",
    "lockstep": "70",
    "fmus": "240",
}
# Tests wait now and then: so many at a time, three on two cores.
THREADS = (os.cpu_count() or 1) + 1
# What codespell reads; its exceptions are in pyproject.toml.
WORDS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs", "scenarios", "site")
# Time limit of a step (s), so that one that waits for ever is named.
LONGEST_STEP = 1800


@dataclass
class Step:
    """One step: what it does, and about how long (s)."""

    name: str
    seconds: int
    work: Callable[[], str | None]


def tally(printed: str) -> str:
    """How many tests passed, failed not, and were left out."""
    passed, ignored = (
        sum(int(number) for number in re.findall(rf"(\d+) {words}", printed))
        for words in ("passed", "(?:ignored|skipped)")
    )
    return f"{passed} tests passed" + (f", {ignored} left out" if ignored else "")


def environment(path: Path) -> Path:
    """The Python of an environment, which is made if it is not there. `install` alone needs no pip in it."""
    within = path / ("Scripts" if os.name == "nt" else "bin")
    if not within.exists():
        venv.create(path, with_pip=path != NASTRAN)
    return within / "python"


def install(path: Path, *packages: str | Path) -> bool:
    """Installs packages into an environment, with uv or with pip; returns whether they are there.

    uv needs a tenth of the time, but has no part in the settings of pip, such as its index.
    """
    python, target = environment(ENVIRONMENT), ("--python", environment(path))
    uv = (python, "-m", "uv", "pip", "install", *target, *packages)
    return succeeds(*uv) or succeeds(python, *PIP, *target, "install", *packages)


def install_wheel(path: Path, extra: str, *packages: str) -> bool:
    """Installs the wheel in place of an earlier one into an environment, with an extra and packages."""
    return install(path, "--force-reinstall", "--no-deps", built()) and install(
        path, f"{built()}[{extra}]", *packages
    )


def form() -> None:
    python = environment(ENVIRONMENT)
    run("cargo", "fmt", "--all", "--check")
    run(python, *PIP, "install", "codespell", "ruff", "uv")
    run(python, "-m", "ruff", "check", ".")
    run(python, "-m", "ruff", "format", "--check", ".")
    run(python, "-m", "codespell_lib", *WORDS)


def crates() -> str | None:
    """Licences of all crates; and their sources and duplicates where cargo-deny is installed."""
    run(sys.executable, "release/licences.py", "--check")
    deny = shutil.which("cargo-deny")
    if deny is None:
        return "sources and duplicates are left out: `cargo install cargo-deny` lets them be checked"
    run(deny, "check", "bans", "licenses", "sources")
    return None


def lint() -> None:
    """clippy and rustdoc. Warnings are errors."""
    run("cargo", "clippy", *CI, "--workspace", "--all-targets", "--", "-Dwarnings")
    os.environ["RUSTDOCFLAGS"] = "-Dwarnings"
    run("cargo", "doc", *CI, "--workspace", "--lib", "--no-deps")


def compile_all() -> None:
    run("cargo", "build", *CI, "--workspace", "--bins", "--tests")


def packages() -> None:
    """Gets what the Python steps need of others. What cannot be installed is reported where it is needed."""
    text = (ROOT / "pyproject.toml").read_text("utf-8")

    def of_extra(name: str) -> list[str]:
        found = re.search(rf"^{name} = \[(.*)\]$", text, re.MULTILINE)
        assert found, name
        return re.findall(r'"([^"]+)"', found[1])

    install(ENVIRONMENT, *of_extra("test"))
    install(SITE, "-r", "site/requirements.txt")
    install(NASTRAN, *of_extra("nastran"), "pytest")


def build() -> None:
    """Builds; meanwhile the network brings packages."""
    side_by_side(compile_all, packages)


def wait_for_installation() -> None:
    """Waits for the installation of compilers that `.ci/run` has begun beside the first steps."""
    process = os.environ.get("FLEXSC_INSTALLATION")
    if process is not None:
        with contextlib.suppress(ChildProcessError):
            os.waitpid(int(process), 0)


def rust() -> str:
    wait_for_installation()
    command = ("cargo", "test", *CI, "--workspace", "--no-fail-fast")
    return tally(run(*command, "--", "--test-threads", str(THREADS)))


def lint_light() -> None:
    """clippy of the light build. Warnings are errors."""
    run("cargo", "clippy", *CI, "--", "-Dwarnings")


def rust_light() -> str:
    """All but the one test that takes a quarter of their time."""
    return tally(run("cargo", "test", *CI, "--", "--skip", "parts_combine"))


def fuzz() -> None:
    if os.name != "posix":
        return
    for surface, inputs in FUZZED.items():
        run(TARGET / "ci" / "flexsc-fuzz", "--surface", surface, "--inputs", inputs)


def wheel() -> None:
    wheels = TARGET / "wheels"
    shutil.rmtree(wheels, ignore_errors=True)
    os.environ["MATURIN_PEP517_ARGS"] = "--profile ci"
    run(environment(ENVIRONMENT), *PIP, "wheel", "--no-deps", "-w", wheels, ".")


def built() -> Path:
    wheels = list((TARGET / "wheels").glob("*.whl"))
    if len(wheels) != 1:
        sys.exit("the wheel was not built: what needs it was not run")
    return wheels[0]


def wait_for_wheel() -> None:
    """Waits until `python` has built and installed the wheel, or has failed."""
    INSTALLED.wait()
    built()


def python() -> str:
    """Builds and installs the wheel, for which the tests beside wait, and runs the other tests."""
    python = environment(ENVIRONMENT)
    try:
        wheel()
        if not install_wheel(ENVIRONMENT, "test"):
            sys.exit(f"{built()} cannot be installed with what its tests need")
    finally:
        INSTALLED.set()
    others = (f"--ignore={file}" for file in (PAGES, EXECUTORS, TYPES))
    return tally(run(python, "-m", "pytest", "tests/python", "-q", *others, *WITHOUT))


def beside(file: str) -> str:
    """Runs the tests of a file beside the others, as soon as the wheel is installed."""
    wait_for_wheel()
    return tally(run(environment(ENVIRONMENT), "-m", "pytest", file, "-q", *WITHOUT))


def extras() -> None:
    """The wheel alone, and with one extra: `tests/extras.py` without names tries them all, in two minutes."""
    wait_for_wheel()
    run(sys.executable, "tests/extras.py", built(), "", "plot")


def site() -> str:
    """The documentation: tutorials run, links lead somewhere, the search finds keys.

    With FLEXSC_PLAYGROUND in the environment, also the playground, which takes ten minutes to build.
    """
    wait_for_wheel()
    has_playground = bool(os.environ.get("FLEXSC_PLAYGROUND"))
    run(sys.executable, "site/build.py", *(["--playground"] if has_playground else []))
    run(sys.executable, "tests/site_search.py")
    if not has_playground:
        return "the playground is left out: FLEXSC_PLAYGROUND=1 builds and tests it"
    printed = run(sys.executable, "tests/site_browser.py").strip().splitlines()
    return f"the site in a browser: {printed[-1]}"


def nastran() -> str:
    """The tests that need pyNastran, where it can be installed."""
    wait_for_wheel()
    if not install_wheel(NASTRAN, "nastran", "pytest"):
        return "pyNastran cannot be installed here: the tests of tests/python/test_nastran*.py are left out"
    files = sorted(map(str, (ROOT / "tests/python").glob("test_nastran*.py")))
    # Python warns of pyNastran when it compiles it.
    warned = (f"-Wignore:invalid escape:{kind}" for kind in ("DeprecationWarning", "SyntaxWarning"))
    printed = run(environment(NASTRAN), "-m", "pytest", *files, "-q", *warned)
    return f"with pyNastran {tally(printed)}"


def tests() -> str:
    """The longest first, and the fuzzer while the wheel is built; who is done takes the next.

    Rust and Python tests at once: each alone leaves a core idle for a third of its time.
    """
    files = (partial(beside, file) for file in (PAGES, EXECUTORS, TYPES))
    return side_by_side(rust, python, fuzz, site, *files, extras, nastran, count=THREADS + 1)


STEPS = [
    Step("form of the code: rustfmt, ruff, spelling", 7, form),
    Step("licences, sources and duplicates of all crates", 5, crates),
    Step("clippy and rustdoc", 150, lint),
    Step("building the command, the tests and the fuzzer", 400, build),
    Step(
        "Rust tests, the wheel and Python tests, with an extra and with pyNastran, the site, and fuzzing",
        850,
        tests,
    ),
]
QUICK = [
    STEPS[0],
    Step("clippy of the light build", 60, lint_light),
    Step("Rust tests of the light build", 240, rust_light),
]
LEFT_OUT = """left out: clippy of the workspace, rustdoc, the licences of crates, the features `matrices`,
`papers`, `parquet` and `png` with their tests, the combinations of parts, the fuzzer, the wheel, the Python
tests and the site"""


def give_up(step: Step) -> None:
    """Ends everything, because a step takes too long."""
    print(f"\n`{step.name}` did not end within {LONGEST_STEP} s", flush=True)
    os._exit(1)


def perform(steps: Sequence[Step]) -> None:
    began = time.monotonic()
    about = sum(step.seconds for step in steps)
    print(f"{len(steps)} steps, about {about} s on two cores from a clean checkout", flush=True)
    times = []
    for number, step in enumerate(steps, 1):
        print(f"\n{number}/{len(steps)} {step.name} (about {step.seconds} s)", flush=True)
        start = time.monotonic()
        limit = threading.Timer(LONGEST_STEP, give_up, [step])
        limit.daemon = True
        limit.start()
        told = step.work()
        limit.cancel()
        times.append(time.monotonic() - start)
        print(f"{number}/{len(steps)} done in {times[-1]:.0f} s" + (f": {told}" if told else ""), flush=True)
    print(f"\nall passed in {time.monotonic() - began:.0f} s")
    for step, took in zip(steps, times, strict=True):
        print(f"{took:6.0f} s  {step.name}")
    print("\n" + "\n".join(SUMMARIES))


def main() -> None:
    if sys.version_info < (3, 10):
        sys.exit("flexsc needs Python 3.10 or newer")
    if shutil.which("cargo") is None:
        sys.exit("flexsc needs Rust: no `cargo` on the path")
    parser = argparse.ArgumentParser(description="All tests of flexsc, Rust and Python.")
    parser.add_argument("--quick", action="store_true", help="what a change needs first, in minutes")
    quick = parser.parse_args().quick
    # Packages are installed as sources: what Python compiles of them is kept.
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    # A shell's background jobs ignore Ctrl-C, and what they start inherits that: the tests send it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    perform(QUICK if quick else STEPS)
    if quick:
        print(LEFT_OUT)


if __name__ == "__main__":
    main()
