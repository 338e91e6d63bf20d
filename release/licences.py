"""Writes the licence texts of the crates that are built into flexsc: `python3 release/licences.py`.

The crates are those of the command, the Python module and the library of FMUs, on all systems, by the lock
file. Wheels, FMUs and release archives contain the file. `--check` compares it, and writes nothing.
"""

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "crates/cosim/licences.txt"
# Crates that are distributed.
BUILT = ("flexsc", "flexsc-py", "flexsc-fmi")
# Where a crate offers several licences, the first of these: one text serves all crates under Apache-2.0.
ORDER = (
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "MIT",
    "Zlib",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Unicode-3.0",
    "CC0-1.0",
)
# Words by which the text of a licence is known.
WORDS = {
    "Apache-2.0": "apache license version 2.0",
    "Apache-2.0 WITH LLVM-exception": "llvm exceptions to the apache 2.0 license",
    "MIT": "permission is hereby granted, free of charge",
    "Zlib": "this software is provided 'as-is'",
    "BSD-2-Clause": "redistribution and use in source and binary forms",
    "BSD-3-Clause": "neither the name",
    "Unicode-3.0": "unicode license v3",
    "CC0-1.0": "cc0 1.0 universal",
}
# The font of figures, whose licence is in the font alone.
FONT = "DejaVuSans.ttf"
RULE = "=" * 100
HEAD = """Licences of flexsc, and of the crates that are built into its command, its Python module and FMUs.

flexsc is licensed under MIT or Apache-2.0, whichever you choose; both texts are below. Crates that can be had
under several licences are listed with the one that flexsc takes. release/licences.py writes this file.
"""


def crates() -> list[dict[str, Any]]:
    """The crates of crates.io that are linked, in the order of their names."""
    command = ["cargo", "metadata", "--locked", "--all-features", "--format-version", "1"]
    found = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)
    packages = {package["id"]: package for package in found["packages"]}
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    todo = [one for one, package in packages.items() if package["name"] in BUILT]
    within = set(todo)
    while todo:
        for dependency in nodes[todo.pop()]["deps"]:
            kinds = {kind["kind"] for kind in dependency["dep_kinds"]}
            package = packages[dependency["pkg"]]
            # A macro runs in the compiler only, as what it depends on.
            is_macro = any("proc-macro" in target["kind"] for target in package["targets"])
            if None in kinds and not is_macro and package["id"] not in within:
                within.add(package["id"])
                todo.append(package["id"])
    linked = (packages[one] for one in within if packages[one]["source"])
    return sorted(linked, key=lambda package: (package["name"], package["version"]))


def chosen(expression: str) -> list[str]:
    """The licences that are taken of an expression, all of which hold."""
    words = re.findall(r"[()]|[^\s()]+", expression.replace("/", " OR "))

    def either() -> list[str]:
        found = [both()]
        while words and words[0] == "OR":
            words.pop(0)
            found.append(both())
        known = [one for one in found if all(name in ORDER for name in one)]
        return min(known or found, key=lambda one: [ORDER.index(name) for name in one if name in ORDER])

    def both() -> list[str]:
        found = one()
        while words and words[0] == "AND":
            words.pop(0)
            found = found + one()
        return found

    def one() -> list[str]:
        name = words.pop(0)
        if name == "(":
            found = either()
            words.pop(0)
            return found
        if words and words[0] == "WITH":
            words.pop(0)
            name = f"{name} WITH {words.pop(0)}"
        return [name]

    return either()


def tidy(text: str) -> str:
    """A text with the line ends of this file, without blanks at the ends of lines."""
    lines = [line.rstrip() for line in text.replace("\r\n", "\n").replace("\f", "").split("\n")]
    return "\n".join(lines).strip("\n")


def texts(package: dict[str, Any]) -> Iterator[tuple[Path, str]]:
    """The licence files of a crate."""
    folder = Path(package["manifest_path"]).parent
    for path in sorted(folder.rglob("*")):
        is_named = re.match(r"(?i)(licen[cs]e|copying|copyright|notice|unlicense)", path.name)
        if is_named and path.is_file() and path.suffix not in (".rs", ".py", ".c", ".h"):
            yield path, tidy(path.read_text(encoding="utf-8", errors="replace"))


def plain(text: str) -> str:
    """The words of a text, for comparisons."""
    return re.sub(r"[^a-z0-9.,' ]+", "", re.sub(r"\s+", " ", text.lower().replace("\u2019", "'"))).replace(
        "license, version", "license version"
    )


def font_licence(path: Path) -> str:
    """The copyright and the licence that a font states in its table of names."""
    data = path.read_bytes()

    def number(at: int) -> int:
        return int.from_bytes(data[at : at + 2], "big")

    tables = range(12, 12 + 16 * number(4), 16)
    (table,) = (at for at in tables if data[at : at + 4] == b"name")
    start = int.from_bytes(data[table + 8 : table + 12], "big")
    texts = start + number(start + 4)
    found = {}
    for record in range(start + 6, start + 6 + 12 * number(start + 2), 12):
        if number(record) == 3:  # Windows, in UTF-16
            at = texts + number(record + 10)
            found[number(record + 6)] = data[at : at + number(record + 8)].decode("utf-16-be")
    return tidy(f"{found[0]}\n\n{found[13]}")


def licence_texts(package: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The name and the text of each licence that is taken for a crate, and its notices."""
    files = list(texts(package))
    for name in chosen(package["license"]):
        fitting = [text for _, text in files if plain(WORDS[name]) in plain(text)]
        if name == "BSD-2-Clause":
            fitting = [text for text in fitting if plain(WORDS["BSD-3-Clause"]) not in plain(text)] or fitting
        if name == "Apache-2.0":
            yield name, tidy((ROOT / "LICENSE-APACHE").read_text(encoding="utf-8"))
        elif fitting:
            # A crate can have texts of what it contains, beside its own.
            yield from ((name, text) for text in dict.fromkeys(fitting))
        elif name == "MIT":
            # The crate has no text: the standard one, with the authors that it names.
            authors = ", ".join(re.sub(r"\s*<.*?>", "", author) for author in package["authors"])
            text = tidy((ROOT / "LICENSE-MIT").read_text(encoding="utf-8"))
            holder = authors or f"the authors of {package['name']}"
            yield name, re.sub(r"(?m)^Copyright.*$", f"Copyright (c) {holder}", text)
        else:
            sys.exit(f"{package['name']} {package['version']} has no text of {name}")
    for path, text in files:
        if path.name.lower().startswith("notice"):
            yield "notice", text
    for font in Path(package["manifest_path"]).parent.rglob(FONT):
        yield f"font {FONT}", font_licence(font)


def written() -> str:
    """The whole file."""
    own = [("Apache-2.0", "LICENSE-APACHE"), ("MIT", "LICENSE-MIT")]
    users = {(name, tidy((ROOT / file).read_text(encoding="utf-8"))): ["flexsc"] for name, file in own}
    for package in crates():
        for found in licence_texts(package):
            users.setdefault(found, []).append(f"{package['name']} {package['version']}")
    order = sorted(users.items(), key=lambda item: (-len(item[1]), item[1]))
    parts = [HEAD]
    for (name, text), names in order:
        parts.append(f"{RULE}\n{name}: {', '.join(names)}\n{RULE}\n\n{text}\n")
    return "\n".join(parts)


def main() -> None:
    is_check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not is_check:
        sys.exit(__doc__)
    text = written()
    if not is_check:
        FILE.write_text(text, encoding="utf-8", newline="\n")
    elif not FILE.is_file() or FILE.read_text(encoding="utf-8") != text:
        sys.exit(f"{FILE.relative_to(ROOT)} is not current: python3 release/licences.py")
    print(f"{FILE.relative_to(ROOT)}: {len(text) / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
