"""Builds a wheel for a target, or the source distribution, into dist/.

`python release/wheel.py x86_64-unknown-linux-gnu`, or `python release/wheel.py sdist`.

Linux wheels are linked by zig against an old C library, so that they run on old systems. A target other than
that of the machine needs its standard library: `rustup target add TARGET`.
"""

import os
import subprocess
import sys
import tarfile
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = ROOT / "target" / "venv-release"
# The linker sees all crates at once: smaller and faster, in several times the time.
LINK_ONCE = ("--config", 'profile.release.lto="fat"')
MAX_BYTES = 10 * 2**20


def add_library(python: Path, target: str) -> None:
    """Adds the library of FMUs, which was built with the module, to the newest wheel in dist/."""
    wheel = max((ROOT / "dist").glob("flexsc-*.whl"), key=lambda path: path.stat().st_mtime)
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / target / "release" / "deps"
    code = "import sys, pathlib as p, flexsc_backend as b; "
    code += "b.add_library(p.Path(sys.argv[1]), p.Path(sys.argv[2]) / b.library_name(sys.argv[3]))"
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "crates/py/backend")}
    subprocess.run([python, "-c", code, wheel, built, target], env=environment, check=True)


def fit_lock(archive: Path) -> None:
    """Takes crates that a source distribution lacks out of its lock file: it then builds with `--locked`."""
    with tempfile.TemporaryDirectory() as name:
        with tarfile.open(archive) as packed:
            members = packed.getmembers()
            packed.extractall(name, filter="data")
        (folder,) = Path(name).iterdir()
        metadata = [
            "cargo",
            "metadata",
            "--format-version",
            "1",
            "--manifest-path",
            folder / "crates/py/Cargo.toml",
        ]
        subprocess.run([*metadata, "--offline"], stdout=subprocess.DEVNULL, check=True)
        subprocess.run([*metadata, "--locked"], stdout=subprocess.DEVNULL, check=True)
        with tarfile.open(archive, "w:gz", format=tarfile.PAX_FORMAT) as packed:
            for member in members:
                if member.name == f"{folder.name}/Cargo.lock":
                    member.size = (folder / "Cargo.lock").stat().st_size
                with (Path(name) / member.name).open("rb") as data:
                    packed.addfile(member, data)


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    target = sys.argv[1]
    if not ENVIRONMENT.exists():
        venv.create(ENVIRONMENT, with_pip=True)
    scripts = ENVIRONMENT / ("Scripts" if os.name == "nt" else "bin")
    pip = [scripts / "python", "-m", "pip", "--quiet", "--disable-pip-version-check", "install"]
    subprocess.run([*pip, "maturin>=1.9.4,<2", "ziglang"], check=True)
    # maturin finds zig on the path of its environment.
    environment = {**os.environ, "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}"}
    command = [scripts / "maturin", "sdist", "--out", "dist"]
    if target != "sdist":
        command = [scripts / "maturin", "build", "--release", *LINK_ONCE, "--out", "dist", "--target", target]
        command += ["--compression-level", "9"]
        if "linux" in target:
            command += ["--zig", "--compatibility", "musllinux_1_2" if "musl" in target else "manylinux_2_17"]
    subprocess.run([str(word) for word in command], cwd=ROOT, env=environment, check=True)
    if target == "sdist":
        fit_lock(max((ROOT / "dist").glob("flexsc-*.tar.gz"), key=lambda path: path.stat().st_mtime))
    else:
        add_library(scripts / "python", target)
    for made in sorted((ROOT / "dist").glob("flexsc-*")):
        print(f"{made.name}  {made.stat().st_size / 2**20:.1f} MiB")
        if made.suffix == ".whl" and made.stat().st_size > MAX_BYTES:
            sys.exit(f"{made.name} is above {MAX_BYTES / 2**20:.0f} MiB")


if __name__ == "__main__":
    main()
