"""Each extra of the wheel alone, in an environment of its own: `python3 tests/extras.py WHEEL [EXTRA ...]`.

Without extras the wheel brings NumPy only; each extra installs, and what it is for works without the others.
"""

import json
import re
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RUN = "run = flexsc.Scenario.example('relay-fixed').with_('duration', 600.0).simulate()"
# What each extra is for. One that has no line is imported beside the package.
# Without extras, everything that walks through the package works: help, completion, `import *`.
WALK = (
    "import contextlib, inspect, io, rlcompleter; from flexsc import *; assert hasattr(flexsc, 'plot'); "
    "assert dict(inspect.getmembers(flexsc)).keys() == set(dir(flexsc)) == set(flexsc.__all__); "
    "assert rlcompleter.Completer({'flexsc': flexsc}).complete('flexsc.pl', 0) == 'flexsc.plot'; "
    "text = io.StringIO(); stack = contextlib.redirect_stdout(text); stack.__enter__(); help(flexsc); "
    "stack.__exit__(None, None, None); assert 'Simulator' in text.getvalue()"
)
USES = {
    "": f"import flexsc; {RUN}; assert run.at(12.5); {WALK}",
    "plot": f"import flexsc, flexsc.plot; {RUN}; assert flexsc.plot.draw(run, 'angle')",
    "control": "import flexsc; assert flexsc.Scenario.example('rotation-robust').linearise().control()",
    "dask": "import flexsc.dask",
    "gym": "import flexsc.gym; flexsc.gym.SpacecraftEnv('earth-observer').reset()",
    "matlab": "import flexsc, scipy.io",
    "nastran": "import flexsc, pyNastran",
}
# Those of `python -m pip list` that every environment has.
OWN = {"flexsc", "pip", "setuptools", "wheel"}


def extras() -> list[str]:
    """The extras of pyproject.toml, without that of the tests."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    table = text.split("[project.optional-dependencies]", 1)[1].split("\n[", 1)[0]
    return [name for name in re.findall(r"^([\w-]+) = \[", table, re.MULTILINE) if name != "test"]


def alone(wheel: Path, extra: str, directory: Path) -> list[str]:
    """Installs the wheel with an extra into an environment and uses it; what came with it."""
    python = directory / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    subprocess.run(
        [*pip, "install", "--no-compile", f"{wheel}[{extra}]" if extra else str(wheel)], check=True
    )
    subprocess.run([python, "-c", USES.get(extra, "import flexsc")], check=True)
    listing = [python, "-m", "pip", "--disable-pip-version-check", "list", "--format", "json"]
    listed = subprocess.run(listing, check=True, capture_output=True, text=True)
    return sorted({package["name"].lower() for package in json.loads(listed.stdout)} - OWN)


def main() -> None:
    wheel = Path(sys.argv[1]).resolve()
    names = sys.argv[2:] or ["", *extras()]
    # After the wheel without extras the environment is as bare as a new one with the wheel.
    groups = [names[:2], *([name] for name in names[2:])] if names[0] == "" else [[name] for name in names]
    for group in groups:
        with tempfile.TemporaryDirectory() as directory:
            venv.create(directory, with_pip=True)
            for extra in group:
                brought = alone(wheel, extra, Path(directory))
                print(f"{extra or 'no extra'}: {', '.join(brought)}", flush=True)
                if not extra and brought != ["numpy"]:
                    sys.exit(f"the wheel alone brings {brought}, and NumPy it should be")


if __name__ == "__main__":
    main()
