#!/usr/bin/env python3
"""Compiles and checks a crate of this workspace: RUSTC_WORKSPACE_WRAPPER in `all.py`.

`cargo clippy`, `cargo doc` and a `cargo check` of the light build would each check all third-party crates
again, which takes longer than what they are for. Here the checks get the arguments that cargo gives the
compiler for a crate. A warning of the compiler or of a check fails the build. The checks are:

- clippy. It compiles the tests in place of the compiler, and checks what has no unit tests beside it.
- rustdoc, which warns of links that lead nowhere, or to what is private.
- the light build, which consists of the workspace's default members without features. The metadata of its
  libraries is in `target/release/light`. Third-party crates are those of the full build: `features.py`
  compares their features.

Tests are compiled with less or no optimisation, which cargo can set for a crate, but not for its tests alone.
The Python module is not optimised: that takes 20 s, and the Python tests take as long without it. No result
depends on either. Benchmarks are checked, and not built.
"""

import contextlib
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# The feature of `flexsc-flight` that the light build has as well.
KEPT = 'feature="std"'
# Options whose values are arguments of their own.
PAIRED = ("-C", "-L", "--cfg", "--check-cfg", "--crate-name", "--crate-type", "--extern", "--out-dir")
# Crates whose unit tests run for longer than it takes to optimise them, with the level that takes least time.
HEAVY = {"flexsc_dynamics": "2", "flexsc_numerics": "1", "flexsc_spacecraft": "1"}

# Each option with its value, if that is an argument of its own.
Options = list[list[str]]


def options(arguments: list[str]) -> Options:
    """The compiler's arguments, put in pairs."""
    words = iter(arguments)
    return [[word, next(words)] if word in PAIRED else [word] for word in words]


def lightened(arguments: list[str]) -> list[str]:
    """The arguments of the compiler for tests and the Python module: what they call is optimised."""
    if "--test" not in arguments and "_native" not in arguments:
        return arguments
    level = "opt-level=" + next((HEAVY[argument] for argument in arguments if argument in HEAVY), "0")
    less = {f"opt-level={more}": level for more in (1, 2, 3)} | {"codegen-units=1": "codegen-units=4"}
    return [less.get(argument, argument) for argument in arguments]


def checked(given: Options, out: Path) -> list[str]:
    """The arguments of the compiler for a check, whose only output is metadata."""
    changed = []
    for name, *value in given:
        if name == "--out-dir":
            changed += [name, str(out)]
        elif name.startswith("--emit="):
            changed.append("--emit=metadata")
        elif name.startswith("--json="):
            # Cargo waits for one set of artifacts, the compiler's.
            changed.append(name.replace(",artifacts", ""))
        else:
            changed += [name, *value]
    return [*changed, "-Dwarnings"]


def light(given: Options, manifest: str, out: Path) -> list[str]:
    """The arguments of the compiler for the metadata of a crate in the light build."""
    named = re.findall(r"^([\w-]+) = \{[^}]*\boptional = true", manifest, re.MULTILINE)
    optional = [name.replace("-", "_") for name in named]
    changed = []
    for name, *value in given:
        if name == "--cfg" and value[0].startswith("feature=") and value != [KEPT]:
            continue
        if name == "--extern":
            crate, _, path = value[0].partition("=")
            if crate in optional:
                continue
            if crate.startswith("flexsc_"):
                own = (out / Path(path).name).with_suffix(".rmeta")
                if not own.is_file():
                    sys.exit(f"error: {own} is not there: run `cargo clean --release --workspace`")
                value = [f"{crate}={own}"]
        changed.append([name, *value])
    return [*checked(changed, out), "-L", f"dependency={out}"]


def run(*commands: list[str]) -> int:
    """Runs commands side by side, the first of which tells cargo of artifacts; returns a failure's code."""
    codes = []
    with contextlib.ExitStack() as stack:
        others = []
        for command in commands[1:]:
            told = stack.enter_context(tempfile.TemporaryFile())
            # All inherit cargo's jobserver, which says how many threads there may be.
            process = subprocess.Popen(command, stdout=told, stderr=told, close_fds=False)
            others.append((stack.enter_context(process), told))
        codes.append(subprocess.run(commands[0], check=False, close_fds=False).returncode)
        # After the compiler's output, so that no line of either is torn.
        for process, told in others:
            codes.append(process.wait())
            told.seek(0)
            sys.stderr.buffer.write(told.read())
    return next((code for code in codes if code != 0), 0)


def has_unit_tests(manifest: str) -> bool:
    """Whether cargo compiles a library a second time, with its unit tests."""
    library = re.search(r"^\[lib\]\n(?:(?!\[).*\n)*", manifest, re.MULTILINE)
    return library is None or "\ntest = false\n" not in library.group(0)


def is_light(package: Path) -> bool:
    """Whether the light build has a package."""
    members = re.search(r"^default-members = .*", (ROOT / "Cargo.toml").read_text("utf-8"), re.MULTILINE)
    assert members
    return f'"{os.path.relpath(package, ROOT)}"' in members.group(0)


def main() -> int:
    command = lightened(sys.argv[1:])
    # Cargo also asks for the version, and build scripts of other crates try what the compiler can do.
    if "--out-dir" not in command or not os.environ.get("CARGO_PKG_NAME", "").startswith("flexsc"):
        return subprocess.run(command, check=False, close_fds=False).returncode
    compiler, given = command[0], options(command[1:])
    clippy, rustdoc = (str(Path(compiler).with_name(name)) for name in ("clippy-driver", "rustdoc"))
    package = Path(os.environ["CARGO_MANIFEST_DIR"])
    if package.name == "benches":
        metadata = (re.sub("^--emit=.*", "--emit=dep-info,metadata", argument) for argument in command)
        return run([clippy, *metadata, "-Dwarnings"])
    if "--test" in command:
        return run([clippy, *command, "-Dwarnings"])
    manifest = (package / "Cargo.toml").read_text("utf-8")
    if is_light(package):
        place = Path(command[command.index("--out-dir") + 1]).parent / "light"
        place.mkdir(exist_ok=True)
        # First: crates that depend on this one are compiled as soon as the compiler has its metadata.
        if code := run([compiler, *light(given, manifest, place)]):
            return code
    with tempfile.TemporaryDirectory() as out:
        check = checked(given, Path(out))
        stable = [argument for argument in check if not argument.startswith("--emit=")]
        beside = [[rustdoc, *stable]]
        if "bin" in command or not has_unit_tests(manifest):
            beside.append([clippy, compiler, *check])
        return run([*command, "-Dwarnings"], *beside)


if __name__ == "__main__":
    sys.exit(main())
