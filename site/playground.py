"""Builds the playground, the engine in a page, into target/playground: `python3 site/playground.py`.

It needs a Rust compiler with the standard library of wasm32-unknown-unknown, clang and npm. The compiler is
that of rustup with `rustup target add wasm32-unknown-unknown`, or Debian's with the source of its library:
`rustc-web`, `rust-web-src` and an LLD of the same LLVM. `wasm-opt` (binaryen) makes it smaller, if it is
there.
"""

from __future__ import annotations

import base64
import gzip
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "site/playground"
MADE = ROOT / "target/playground"
TARGET = "wasm32-unknown-unknown"
# Folder in which the playground is built; it becomes MADE once it is whole.
NEW = ROOT / "target/playground-new"
# Node's packages, beside which esbuild runs.
PACKAGES = ROOT / "target/playground-packages"
DEBIAN = Path("/usr/bin/rustc")
# What takes little time: nothing that no export reaches, and equal functions once.
LIGHT = ("--remove-unused-module-elements", "--duplicate-function-elimination", "--vacuum")
# Functions of the module.
EXPORTED = ("flexsc_allocate", "flexsc_answer", "flexsc_result")
MOST_BYTES = 4_000_000


class Absent(Exception):
    """Something that the playground is built with is not here."""


def said(*command: str | Path) -> str:
    """What a command prints."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


def compiler() -> tuple[dict[str, str], list[str]]:
    """The environment and the options of cargo with which it builds for WebAssembly.

    Raises:
        Absent: There is no such compiler.
    """
    library = Path(said("rustc", "--print", "sysroot").strip()) / "lib/rustlib" / TARGET
    if library.is_dir():
        return {}, []
    debian = "Debian's rustc-web, rust-web-src and lld"
    why = f"no Rust library for {TARGET}: `rustup target add {TARGET}`, or {debian}"
    if not DEBIAN.exists():
        raise Absent(why)
    sources = Path(said(DEBIAN, "--print", "sysroot").strip()) / "lib/rustlib/src/rust/library"
    linkers = sorted(Path("/usr/bin").glob("wasm-ld-*"), key=lambda path: int(path.name.rpartition("-")[2]))
    if not sources.is_dir() or not linkers:
        raise Absent(why)
    environment = {
        "RUSTC": str(DEBIAN),
        # Its standard library is compiled from source, which stable compilers do for themselves alone.
        "RUSTC_BOOTSTRAP": "1",
        "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER": str(linkers[-1]),
    }
    return environment, ["-Zbuild-std=std,panic_abort"]


def number(code: bytes, at: int) -> tuple[int, int]:
    """A number of WebAssembly (LEB128) at a place, and the place after it."""
    value = shift = 0
    while True:
        byte = code[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at


def coded(value: int) -> bytes:
    """A number as WebAssembly has it."""
    made = bytearray()
    while True:
        made.append(value & 0x7F | (0x80 if value > 0x7F else 0))
        value >>= 7
        if value == 0:
            return bytes(made)


def without_other_exports(code: bytes) -> bytes:
    """A module that exports its memory and functions alone: crates that it depends on export thousands."""
    at, made = 8, bytearray(code[:8])
    while at < len(code):
        kind, (length, start) = code[at], number(code, at + 1)
        body = code[start : start + length]
        if kind == 7:
            count, place = number(body, 0)
            kept = []
            for _ in range(count):
                size, name = number(body, place)
                _, end = number(body, name + size + 1)
                if body[name : name + size].decode() in (*EXPORTED, "memory"):
                    kept.append(body[place:end])
                place = end
            body = coded(len(kept)) + b"".join(kept)
        made += bytes([kind]) + coded(len(body)) + body
        at = start + length
    return bytes(made)


def engine() -> bytes:
    """The engine as WebAssembly."""
    own, options = compiler()
    if shutil.which("clang") is None:
        raise Absent("no clang, which compiles the C of zstd for WebAssembly")
    folder = ROOT / "target/web"
    words = [
        "cargo",
        "rustc",
        "--quiet",
        "--locked",
        "--profile",
        "web",
        "--target",
        TARGET,
        "-p",
        "flexsc-web",
        "--features",
        "page",
    ]
    exported = [word for name in EXPORTED for word in ("-C", f"link-arg=--export={name}")]
    environment = {**os.environ, **own, "CARGO_TARGET_DIR": str(folder)}
    command = [*words, "--bin", "flexsc-web", *options, "--", *exported]
    # Warnings of another compiler and another processor are of no interest here.
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    built = folder / TARGET / "web/flexsc-web.wasm"
    trimmed = built.with_suffix(".trimmed.wasm")
    trimmed.write_bytes(without_other_exports(built.read_bytes()))
    if (optimiser := shutil.which("wasm-opt")) is None:
        return trimmed.read_bytes()
    small = built.with_suffix(".small.wasm")
    features = (
        "--enable-bulk-memory",
        "--enable-sign-ext",
        "--enable-mutable-globals",
        "--enable-nontrapping-float-to-int",
    )
    subprocess.run([optimiser, *LIGHT, *features, trimmed, "-o", small], check=True)
    return small.read_bytes()


def bundle() -> None:
    """The scripts of the page."""
    if shutil.which("npm") is None:
        raise Absent("no npm")
    shutil.copytree(SOURCE, PACKAGES, dirs_exist_ok=True)
    npm = ["npm", "ci", "--no-audit", "--no-fund", "--silent", "--ignore-scripts"]
    subprocess.run(npm, cwd=PACKAGES, check=True)
    subprocess.run(["node", "bundle.mjs", NEW], cwd=PACKAGES, check=True)


def packed(data: bytes) -> bytes:
    """Data as a gzip file, 4 % smaller where `zopfli` is installed."""
    try:
        from zopfli.gzip import compress
    except ImportError:
        return gzip.compress(data, 9, mtime=0)
    return compress(data, numiterations=1)


def is_built() -> bool:
    """True if the playground has been built."""
    return MADE.is_dir()


def build() -> str | None:
    """Builds the playground; returns the reason if it cannot be built here."""
    began = time.monotonic()
    for folder in (MADE, NEW):
        shutil.rmtree(folder, ignore_errors=True)
    NEW.mkdir(parents=True)
    scripts = [NEW / name for name in ("main.js", "model.js")]
    try:
        bundle()
        module = packed(engine())
    except Absent as absent:
        return str(absent)
    files = {"engine.wasm": module} | {script.name: packed(script.read_bytes()) for script in scripts}
    for name, data in files.items():
        (NEW / f"{name}.gz").write_bytes(data)
        text = base64.b64encode(data).decode("ascii")
        (NEW / f"{name}.gz.js").write_text(f'(self.FLEXSC_FILES ??= {{}})["{name}"]="{text}";\n', "ascii")
    for script in scripts:
        script.unlink()
    shutil.copyfile(SOURCE / "style.css", NEW / "style.css")
    # What is in base64 is for pages that are opened from a folder.
    sent = (path for path in sorted(NEW.iterdir()) if not path.name.endswith(".gz.js"))
    sizes = {path.name: path.stat().st_size for path in sent}
    if sum(sizes.values()) > MOST_BYTES:
        raise SystemExit(f"the playground is above {MOST_BYTES} bytes: {sizes}")
    NEW.rename(MADE)
    took = time.monotonic() - began
    print(f"the playground has {sum(sizes.values()) / 1e6:.2f} MB, built in {took:.0f} s: {sizes}")
    return None


if __name__ == "__main__":
    if reason := build():
        sys.exit(f"the playground cannot be built: {reason}")
