"""Keys of a scenario: tables in docs/scenario, an anchor where a page has a key, and an entry of the search.

A page has a line ``Keys: `flexsc schema sensor.gyro` `` where the site has the table that this command gives.
"""

from __future__ import annotations

import html
import itertools
import json
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

Schema = dict[str, Any]
FOLDER = Path(__file__).resolve().parents[1] / "docs/scenario"
CODE = re.compile(r"`([^`]+)`")
CELL = re.compile(r"(?<!\\)\|")
TABLE = re.compile(r"Keys: `flexsc schema ([\w.]+)`")
COMMAND = shutil.which("flexsc", path=str(Path(sys.executable).parent)) or "flexsc"


class Place(NamedTuple):
    """Line of a page, counted from 0."""

    page: str
    line: int


class Section(NamedTuple):
    """Section of a page: its heading, and the tables of a scenario that the heading names."""

    heading: Place
    names: list[str]


class Keys:
    """The keys of a schema by their paths, and the places that describe them.

    A key has the row of a table that names it. A key that stands in text only has the heading of its section.
    """

    def __init__(self, schema: Schema, folder: Path = FOLDER) -> None:
        self.schema = schema
        self.descriptions: dict[str, str] = {}
        self.places: dict[str, Place] = {}
        owners: dict[tuple[str, str], list[str]] = {}
        for owner, path, description in self._walk(schema, "", "", ()):
            self.descriptions.setdefault(path, description)
            owners.setdefault((owner, path.rsplit(".", 1)[-1]), []).append(path)
        pages = sorted(folder.glob("*.md"))
        self.tables = {
            match[1].strip("."): rows(match[1].strip("."))
            for page in pages
            for line in page.read_text("utf-8").split("\n")
            if (match := TABLE.match(line))
        }
        self.sections: list[Section] = []
        for page in pages:
            self.sections += self._read(page)
        # A type has the same keys wherever it stands: one place is enough.
        for paths in owners.values():
            if not any(path in self.places for path in paths):
                path, place = self._nearest(paths)
                self.places[path] = place

    def expanded(self, markdown: str) -> tuple[list[str], dict[int, str]]:
        """The lines of a page with its tables of keys, and the key in each line of such a table."""
        lines: list[str] = []
        paths: dict[int, str] = {}
        heading = ""
        for line in markdown.split("\n"):
            if not (match := TABLE.match(line)):
                heading = line if line.startswith("#") else heading
                lines.append(line)
                continue
            table = match[1].strip(".")
            if table and f"[{table}]" not in heading:
                lines += [f"`[{table}]`:", ""]
            lines += ["| key | unit | default | meaning |", "|---|---|---|---|"]
            for key in self.tables[table]:
                path = f"{table}.{key['key']}" if table else key["key"]
                # The keys of a table within it, which has a place of its own, stand there.
                if not any(len(own) > len(table) and path.startswith(f"{own}.") for own in self.tables):
                    paths[len(lines)] = path.replace("[i]", "").replace(".NAME", "")
                    default = key["default"]
                    cells = (f"`{key['key']}`", key["unit"], code(default), key["meaning"])
                    lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        return lines, paths

    def anchored(self, page: str, markdown: str) -> str:
        """The Markdown of a page with its tables, and with an anchor at each key."""
        lines, _ = self.expanded(markdown)
        for key, place in self.places.items():
            if place.page == page and not self._is_heading(key):
                anchor = f'<a id="{key}"></a>'
                line = lines[place.line]
                start = 2 if line.startswith("|") else len(line)
                lines[place.line] = line[:start] + anchor + line[start:]
        return "\n".join(lines)

    def link(self, path: str) -> str | None:
        """The address of a key from a folder beside `scenario`."""
        place = self.places.get(path)
        return place and f"../scenario/{place.page}#{path}"

    def entries(self) -> list[dict[str, str]]:
        """The entries of the search."""
        return [
            {
                "location": f"scenario/{place.page.removesuffix('.md')}.html#{key}",
                "title": key,
                "text": f"<p>{html.escape(self.descriptions[key])}</p>",
            }
            for key, place in self.places.items()
            if not self._is_heading(key)
        ]

    def _is_heading(self, key: str) -> bool:
        """True if a heading names the key alone, and so has the anchor: `## `[[target]]``."""
        return "." not in key and Section(self.places[key], [key]) in self.sections

    def _walk(
        self, of: Schema, path: str, owner: str, within: tuple[str, ...]
    ) -> Iterator[tuple[str, str, str]]:
        """The type, path and description of each key below a place of the schema."""
        if "$ref" in of:
            name = of["$ref"].rsplit("/", 1)[1]
            if name not in within and isinstance(self.schema["$defs"][name], dict):
                yield from self._walk(self.schema["$defs"][name], path, name, (*within, name))
        branches = [branch for key in ("oneOf", "anyOf", "allOf") for branch in of.get(key, ())]
        for branch in [*branches, of.get("items")]:
            if isinstance(branch, dict):
                yield from self._walk(branch, path, owner, within)
        for key, inner in of.get("properties", {}).items():
            if key != "own":  # a part of a program's own
                full = f"{path}.{key}" if path else key
                yield owner, full, inner.get("description", of.get("description", ""))
                yield from self._walk(inner, full, owner, within)

    def _read(self, path: Path) -> list[Section]:
        """Finds the keys in the tables of a page, and returns its sections."""
        sections: list[Section] = []
        fenced, head, kind = False, [""], ""
        lines, paths = self.expanded(path.read_text("utf-8"))
        for number, line in enumerate(lines):
            place = Place(path.name, number)
            if number in paths:
                if paths[number] in self.descriptions:
                    self.places.setdefault(paths[number], place)
                continue
            if line.startswith("```"):
                fenced = not fenced
            elif line.startswith("#") and not fenced:
                names = [code.strip("[]") for code in CODE.findall(line)]
                sections.append(Section(place, names))
            if not line.startswith("|"):
                head = [""]
                continue
            cells = [cell.strip() for cell in CELL.split(line)[1:-1]]
            if head == [""]:
                head, kind = cells, ""
                continue
            names = sections[-1].names or [""]
            if head[0] == "kind":
                kind = "".join(CODE.findall(cells[0])).strip("[]") or kind
                names, cells = [kind], cells[1:]
            elif not head[0].startswith("key"):
                continue
            within = "".join(f".{code}" for code in CODE.findall(head[0]))
            for key in written(cells[0]):
                for found in self._found([name + within for name in names], key):
                    self.places.setdefault(found, place)
        return sections

    def _found(self, names: list[str], key: str) -> list[str]:
        """The paths of a key in the tables that a heading names, or else in those above them."""
        while any(names):
            found = [f"{name}.{key}" for name in names if f"{name}.{key}" in self.descriptions]
            if found:
                return found
            names = [name.rpartition(".")[0] for name in names]
        return [key] if key in self.descriptions else []

    def _nearest(self, paths: list[str]) -> tuple[str, Place]:
        """The path, of several of one key, whose table is nearest to a heading, and the place of that."""

        def depth(path: str, section: Section) -> int:
            above = [name for name in section.names if path == name or path.startswith(f"{name}.")]
            return path.count(".") - max((name.count(".") for name in above), default=-2)

        def pages(path: str) -> Iterator[str]:
            for section in self.sections:
                if any(name.startswith(f"{path}.") for name in section.names):
                    yield section.heading.page

        path, nearest = min(itertools.product(paths, self.sections), key=lambda pair: depth(*pair))
        if depth(path, nearest) > path.count(".") + 1:
            # The kinds of a part: the title of their page.
            page = Counter(pages(path)).most_common(1)[0][0]
            return path, Place(page, 0)
        return path, nearest.heading


def rows(table: str) -> list[dict[str, str]]:
    """The keys of a table as the command has them."""
    done = subprocess.run(
        [COMMAND, "schema", table or ".", "--json"], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def code(default: str) -> str:
    """A default in a cell: a value is code, `required` a word."""
    return default if default in ("", "required") else f"`{default}`"


def written(cell: str) -> Iterator[str]:
    """The keys of a cell as paths: `rotor.speed`, `.limit` are `rotor.speed` and `rotor.limit`."""
    above = ""
    for code in CODE.findall(cell):
        key = re.sub(r"\[\w*\]", "", code)
        key = above + key if key.startswith(".") else key
        above = key.rpartition(".")[0]
        yield key
