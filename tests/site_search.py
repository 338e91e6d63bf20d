"""The search of the built site finds keys: `python3 tests/site_search.py`, after `python3 site/build.py`.

The keys are those that the shipped scenarios use, as they are written there.
"""

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "target/site"
HEADER = re.compile(r"^\[+([\w.]+)\]+")
KEY = re.compile(r"^(\w+) *=")
# Names that a scenario gives, and parts within parts: their keys are those of the part by itself.
NAMED = re.compile(r"\.shapes\.|^law\.(per_axis|stages)\.|\.unloading\.jets\.|^uncertain")
Entry = dict[str, Any]


def keys() -> Iterator[str]:
    """The paths of the keys of all shipped scenarios."""
    for path in sorted((ROOT / "scenarios").glob("*.toml")):
        table = ""
        for line in path.read_text("utf-8").splitlines():
            if header := HEADER.match(line):
                table = f"{header[1]}."
            elif (key := KEY.match(line)) and not NAMED.search(table + key[1]):
                yield table + key[1]


class Search:
    """The index, with the order that matters here.

    First is the title with the most words searched for, then with the fewest others, then the higher page.
    """

    def __init__(self, path: Path) -> None:
        index = json.loads(path.read_text("utf-8").removeprefix("var __index = "))
        self.separator = re.compile(index["config"]["separator"])
        self.entries: list[Entry] = index["docs"]
        self.titles = [self.words(re.sub(r"<[^>]*>", "", entry["title"])) for entry in self.entries]

    def words(self, text: str) -> set[str]:
        return {word for word in self.separator.split(text.lower()) if word}

    def best(self, query: str) -> Entry:
        words = self.words(query)
        order = [
            (len(words & title), -len(title - words), entry.get("boost", 1))
            for title, entry in zip(self.titles, self.entries, strict=True)
        ]
        return self.entries[order.index(max(order))]


def place(entry: Entry) -> str:
    """The row of a table that has the anchor of an entry, or the section."""
    path, _, anchor = entry["location"].partition("#")
    page = (SITE / path).read_text("utf-8")
    found = page.split(f'id="{anchor}"')
    if len(found) != 2:
        sys.exit(f"{path} has the anchor {anchor} {len(found) - 1} times")
    return re.split(r"</tr>" if "<td" in found[0][-20:] else r"<h[1-6]", found[1], maxsplit=1)[0]


def main() -> None:
    # The script is what pages read that are opened from a file system.
    search = Search(SITE / "search/search_index.js")
    found = {key: search.best(key) for key in keys()}
    for key, entry in found.items():
        name = key.rsplit(".", 1)[-1]
        text = place(entry)
        if not entry["location"].startswith("scenario/") or not re.search(rf"\b{name}\b", text):
            sys.exit(f"a search for {key} finds {entry['location']}, which does not name {name}")
    if len(found) < 150:
        sys.exit(f"only {len(found)} keys")
    expected = {
        "law.attitude.bandwidth": "scenario/laws.html#law.attitude.bandwidth",
        "sensor.gyro.period": "scenario/sensors.html#sensor.gyro.period",
        "appendage.drive": "scenario/spacecraft.html#appendage.drive",
        "[[target]]": "scenario/targets.html#target",
        "switch_on": "scenario/laws.html#law.phase_plane.switch_on",
    }
    for query, location in expected.items():
        if search.best(query)["location"] != location:
            sys.exit(f"a search for {query} finds {search.best(query)['location']}")
    for entry in search.entries:
        # Made pages repeat the names of keys: an attribute `bandwidth` is shorter than the key's path.
        if re.match(r"reference/(keys|python)[./]", entry["location"]) and entry.get("boost", 1) > 0.5:
            sys.exit(f"{entry['location']} ranks as high as the reference of scenarios")
        if re.match(r"scenario/.*#.*\.", entry["location"]):
            place(entry)
    print(f"the search finds {len(found)} keys")


if __name__ == "__main__":
    main()
