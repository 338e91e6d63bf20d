"""Pages of the shipped scenarios, the page of the playground, and the links that open a scenario there."""

from __future__ import annotations

import base64
import html
import re
import zlib
from pathlib import Path

import flexsc
import gallery
from playground import is_built

ROOT = Path(__file__).resolve().parents[1]
TOML = re.compile(r"^```toml\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
BLOCK = re.compile(
    r"(?:^ {4}\S.*\n(?:(?:^ {4}.*)?\n)*)|^```(?:sh|text|bash|python)\n.*?^```\n", re.MULTILINE | re.DOTALL
)
NAMED = re.compile(r"scenarios/([\w-]+)\.toml|--like ([\w-]+)|Scenario\.example\(\"([\w-]+)\"\)")


def opening(text: str) -> str:
    """The comment at the start of a scenario, as Markdown."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").removeprefix(" "))
    return html.escape("\n".join(lines), quote=False).replace("[", "\\[")


def pages() -> dict[str, str]:
    """A page for each shipped scenario, and their index."""
    index = "# Scenarios\n\nThe command has them built in: `flexsc new NAME --like SCENARIO` copies one.\n\n"
    index += "| scenario | shows |\n|---|---|\n"
    made = {}
    for name, about in sorted(flexsc.examples().items()):
        text = (ROOT / f"scenarios/{name}.toml").read_text("utf-8")
        index += f"| [`{name}`]({name}.md) | {about} |\n"
        there = f"[Open in the playground](../playground.md#{name}){{ .md-button }}\n\n" if is_built() else ""
        tiles = "".join(
            f"![{tile.title}](../gallery/{tile.name}.svg)\n\n"
            for tile in gallery.TILES
            if tile.scenario == name
        )
        made[f"examples/{name}.md"] = (
            f"# {name}\n\n{about}.\n\n{opening(text)}\n\n{there}{tiles}"
            f"    flexsc new mine --like {name}\n\n<div data-search-exclude markdown>\n\n"
            f"```toml\n{text.rstrip()}\n```\n\n</div>\n"
        )
    return {"examples/index.md": index} | made


def playground() -> str:
    """The page of the playground."""
    page = (ROOT / "site/playground/page.html").read_text("utf-8")
    return (
        "---\nhide: [navigation, toc, footer]\nsearch:\n  boost: 2\n---\n\n# Playground\n\n"
        '<link rel="stylesheet" href="playground/style.css">\n\n'
        f"{page}\n"
        '<script src="playground/gallery.js"></script>\n<script src="playground/load.js"></script>\n'
    )


def packed(name: str, text: str) -> str:
    """A scenario as the playground has it in its address."""
    squeezed = zlib.compressobj(9, zlib.DEFLATED, -15)
    bytes_ = squeezed.compress(f"{name}\n{text}".encode()) + squeezed.flush()
    return "toml=" + base64.urlsafe_b64encode(bytes_).decode("ascii").rstrip("=")


def is_accepted(text: str) -> bool:
    """True if a text is a whole scenario."""
    try:
        flexsc.Scenario.parse(text)
    except flexsc.ScenarioError:
        return False
    return True


def linked(markdown: str, above: str) -> str:
    """A page with a link to the playground below each example that is a scenario."""

    def link(fragment: str, words: str) -> str:
        return f'<p class="open"><a href="{above}playground.html#{fragment}">{words}</a></p>\n'

    before = ""

    def of_text(match: re.Match[str]) -> str:
        nonlocal before
        whole = next((text for text in (match[1], before + match[1]) if is_accepted(text)), None)
        before += match[1] + "\n"
        return (
            match[0]
            if whole is None
            else match[0] + "\n" + link(packed("mine", whole), "open in the playground")
        )

    seen: set[str] = set()

    def of_name(match: re.Match[str]) -> str:
        names = dict.fromkeys(next(filter(None, groups)) for groups in NAMED.findall(match[0]))
        new = [name for name in names if name not in seen and name in flexsc.examples()]
        seen.update(new)
        return match[0] + "".join("\n" + link(name, f"open {name} in the playground") for name in new)

    return BLOCK.sub(of_name, TOML.sub(of_text, markdown))
