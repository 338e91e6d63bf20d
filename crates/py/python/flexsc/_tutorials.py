"""The tutorials as notebooks, and the command `python -m flexsc tutorials` that lists and writes them."""

from __future__ import annotations

import json
import os
import sys
from argparse import ArgumentParser
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

_ENDING = ".ipynb"


def texts() -> dict[str, str]:
    """Return the notebooks by name, as JSON."""
    found = [
        entry for entry in files("flexsc").joinpath("tutorials").iterdir() if entry.name.endswith(_ENDING)
    ]
    return {
        entry.name.removesuffix(_ENDING): entry.read_text("utf-8")
        for entry in sorted(found, key=lambda entry: entry.name)
    }


def subjects() -> dict[str, str]:
    """Return the tutorials by name: the headings of their notebooks."""
    return {name: json.loads(text)["cells"][0]["source"][0].strip("# \n") for name, text in texts().items()}


def write(directory: str | os.PathLike[str], force: bool = False) -> list[Path]:
    """Write the notebooks into a directory, which is made if it does not exist, and return their paths.

    Raises:
        FileExistsError: There is another file of the name of one, and `force` is not given.
        OSError: A file cannot be written.
    """
    there = Path(directory)
    paths = {there / f"{name}{_ENDING}": text for name, text in texts().items()}
    for path, text in paths.items():
        if path.exists() and not force and path.read_text("utf-8", errors="replace") != text:
            raise FileExistsError(f"{path} exists and is another file: --force replaces it")
    there.mkdir(parents=True, exist_ok=True)
    for path, text in paths.items():
        path.write_text(text, "utf-8", newline="\n")
    return list(paths)


def main(arguments: Sequence[str]) -> int:
    """Run the command with its own arguments, and return its exit code."""
    parser = ArgumentParser("flexsc tutorials", description="List the tutorials, or write them as notebooks.")
    parser.add_argument(
        "-o", "--out", metavar="DIR", help="directory for the notebooks; without it they are listed"
    )
    parser.add_argument("--force", action="store_true", help="replace other files of the same names")
    given = parser.parse_args(arguments)
    if given.out is None:
        for name, subject in subjects().items():
            print(f"{name:10} {subject}")
        return 0
    try:
        written = write(given.out, given.force)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    for path in written:
        print(path)
    return 0
