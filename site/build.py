"""Builds the documentation site into target/site: `python3 site/build.py`.

It needs the wheel that `pip wheel --no-deps -w target/wheels .` makes, and makes it if there is none. With
`--playground` it builds the engine for browsers first, and says so if it cannot; without, the site has the
one that is in target/playground, if any.
"""

import os
import subprocess
import sys
import venv
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import playground

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = ROOT / "target" / "venv-site"


def run(*command: str | Path) -> None:
    """Runs a command, which must succeed."""
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run([str(word) for word in command], cwd=ROOT, env=environment, check=False)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed with {done.returncode}")


def main() -> None:
    if "--playground" in sys.argv[1:] and (reason := playground.build()):
        print(f"the site has no playground: {reason}")
    if not ENVIRONMENT.exists():
        venv.create(ENVIRONMENT, with_pip=True)
    python = ENVIRONMENT / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    pip = (python, "-m", "pip", "--quiet", "--disable-pip-version-check", "install")
    wheels = ROOT / "target" / "wheels"
    if not list(wheels.glob("*.whl")):
        run(python, "-m", "pip", "--quiet", "wheel", "--no-deps", "-w", wheels, ".")
    (wheel,) = wheels.glob("*.whl")
    run(*pip, "-r", "site/requirements.txt", wheel)
    run(*pip, "--force-reinstall", "--no-deps", wheel)
    run(python, "-m", "mkdocs", "build", "--strict", "--quiet", "--config-file", "site/mkdocs.yml")
    print(f"the site is {ROOT / 'target/site/index.html'}")


if __name__ == "__main__":
    main()
