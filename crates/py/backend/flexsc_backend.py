"""The build backend of the wheel: maturin's, which also puts the library of FMUs into the package.

Cargo builds that library with the module, on which the command depends; nothing is compiled for it alone.
"""

import base64
import hashlib
import io
import json
import os
import shlex
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import maturin
from maturin import (
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "add_library",
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "library_name",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

ROOT = Path(__file__).resolve().parents[3]
PACKAGE = ROOT / "crates/py/python/flexsc"


def library_name(target: str = "") -> str:
    """The file name of the library on a target, by default that of this machine."""
    system = target or sys.platform
    if "win32" in system or "windows" in system:
        return "flexsc_fmi.dll"
    return "libflexsc_fmi.dylib" if "darwin" in system else "libflexsc_fmi.so"


def _option(arguments: list[str], name: str) -> str:
    """The value of an option, or nothing."""
    for place, word in enumerate(arguments):
        if word == name and place + 1 < len(arguments):
            return arguments[place + 1]
        if word.startswith(f"{name}="):
            return word.partition("=")[2]
    return ""


def _built_library(settings: Mapping[str, Any] | None) -> Path:
    """The library that the build of the module has made."""
    given = [(settings or {}).get(key) or "" for key in ("maturin.build-args", "build-args")]
    words = " ".join(" ".join(value) if isinstance(value, list) else value for value in given)
    arguments = shlex.split(f"{words} {os.environ.get('MATURIN_PEP517_ARGS', '')}")
    target = _option(arguments, "--target") or os.environ.get("CARGO_BUILD_TARGET", "")
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    told = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
    directory = Path(_option(arguments, "--target-dir") or json.loads(told)["target_directory"])
    profile = _option(arguments, "--profile") or "release"
    library = directory / target / profile / "deps" / library_name(target)
    if not library.is_file():
        sys.exit(f"{library} is not there: the build of the module makes it")
    return library


def _packed(library: Path) -> bytes:
    """A ZIP archive of the library, a third of its size, out of which the engine takes it."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        # With the same date, equal libraries have equal archives.
        entry = zipfile.ZipInfo(library.name)
        entry.compress_type = zipfile.ZIP_DEFLATED
        archive.writestr(entry, library.read_bytes(), compresslevel=9)
    return packed.getvalue()


def add_library(wheel: Path, library: Path) -> None:
    """Add the library, packed, to the package in a wheel, and to its record."""
    data = _packed(library)
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    name = f"flexsc/{library.name}.zip"
    changed = wheel.with_suffix(".partial")
    with (
        zipfile.ZipFile(wheel) as before,
        zipfile.ZipFile(changed, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as after,
    ):
        entries = before.infolist()
        (record,) = (entry for entry in entries if entry.filename.endswith(".dist-info/RECORD"))
        for entry in entries:
            if entry is not record and entry.filename != name:
                after.writestr(entry, before.read(entry))
        own = zipfile.ZipInfo(name, record.date_time)
        own.external_attr = 0o644 << 16
        after.writestr(own, data)
        lines = before.read(record).decode().splitlines()
        lines = [line for line in lines if not line.startswith(f"{name},")]
        lines.insert(-1, f"{name},sha256={digest},{len(data)}")
        after.writestr(record, "\n".join(lines) + "\n")
    changed.replace(wheel)


def build_wheel(
    wheel_directory: str,
    config_settings: Mapping[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Build the wheel, with the library."""
    name: str = maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
    add_library(Path(wheel_directory) / name, _built_library(config_settings))
    return name


def build_editable(
    wheel_directory: str,
    config_settings: Mapping[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Build what makes the sources importable, with the library beside them."""
    name: str = maturin.build_editable(wheel_directory, config_settings, metadata_directory)
    library = _built_library(config_settings)
    (PACKAGE / f"{library.name}.zip").write_bytes(_packed(library))
    return name
