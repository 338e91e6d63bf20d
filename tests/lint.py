#!/usr/bin/env python3
"""Runs the compiler on a crate of this workspace, and clippy beside it: RUSTC_WORKSPACE_WRAPPER in `all.py`.

`cargo clippy` would check all third-party crates again, which takes four times as long as the lints. Here
clippy gets the arguments of the compiler for each crate that is built. A warning of either fails the build.

A crate is compiled a second time for its unit tests, which are quick: with less or no optimisation, which
cargo can set for a crate, and not for its tests alone. No result depends on how much a crate is optimised. A
library that has unit tests is linted with them, once. With `FLEXSC_LINTS=benches` only the benchmarks are
linted, which the full build does not have, and a warning of the compiler fails the build.
"""

import os
import re
import subprocess
import sys
import tempfile


def linted(arguments: list[str], out: str) -> list[str]:
    """The arguments of the compiler for clippy, whose only output is metadata that nothing reads."""
    changed = []
    for before, argument in zip(["", *arguments], arguments, strict=False):
        if before == "--out-dir":
            argument = out
        elif argument.startswith("--emit="):
            argument = "--emit=metadata"
        elif argument.startswith("--json="):
            # Cargo waits for one set of artifacts, the compiler's.
            kinds = argument.removeprefix("--json=").split(",")
            argument = "--json=" + ",".join(kind for kind in kinds if kind != "artifacts")
        changed.append(argument)
    return [*changed, "-Dwarnings"]


def lightened(arguments: list[str]) -> list[str]:
    """The arguments of the compiler for tests: what they call in other crates is optimised."""
    if "--test" not in arguments:
        return arguments
    # Unit tests of these run for longer than it takes to optimise them.
    heavy = {"flexsc_control", "flexsc_dynamics", "flexsc_numerics", "flexsc_spacecraft"} & set(arguments)
    level = "opt-level=1" if heavy else "opt-level=0"
    less = {"opt-level=3": level, "opt-level=1": level, "codegen-units=1": "codegen-units=4"}
    return [less.get(argument, argument) for argument in arguments]


def has_unit_tests(manifest: str) -> bool:
    """Whether cargo compiles a library a second time, with its unit tests."""
    library = re.search(r"^\[lib\]\n(?:(?!\[).*\n)*", manifest, re.MULTILINE)
    return library is None or "\ntest = false\n" not in library.group(0)


def is_linted_later(arguments: list[str]) -> bool:
    """Whether these are the arguments for a library that is compiled with its unit tests as well."""
    if "--test" in arguments or "bin" in arguments:
        return False
    with open(os.path.join(os.environ["CARGO_MANIFEST_DIR"], "Cargo.toml"), encoding="utf-8") as manifest:
        return has_unit_tests(manifest.read())


def main() -> int:
    command = lightened(sys.argv[1:])
    # Cargo also asks for the version, and builds crates that the command does not name.
    if "--crate-name" not in command or "CARGO_PRIMARY_PACKAGE" not in os.environ:
        return subprocess.run(command, check=False, close_fds=False).returncode
    if os.environ.get("FLEXSC_LINTS") == "benches":
        lint = ["clippy-driver"] if os.environ["CARGO_PKG_NAME"] == "flexsc-bench" else []
        return subprocess.run([*lint, *command, "-Dwarnings"], check=False, close_fds=False).returncode
    if is_linted_later(command):
        return subprocess.run([*command, "-Dwarnings"], check=False, close_fds=False).returncode
    with tempfile.TemporaryDirectory() as out, tempfile.TemporaryFile() as told:
        lint = ["clippy-driver", *linted(command, out)]
        # Both inherit cargo's jobserver, which says how many threads there may be.
        with subprocess.Popen(lint, stderr=told, close_fds=False) as clippy:
            compiled = subprocess.run(command, check=False, close_fds=False).returncode
        told.seek(0)
        # After the compiler's output, so that no line of either is torn.
        sys.stderr.buffer.write(told.read())
        return compiled or clippy.returncode


if __name__ == "__main__":
    sys.exit(main())
