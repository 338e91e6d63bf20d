"""What MkDocs adds to docs/: references, tutorials with their outputs, formulas, gallery, playground."""

from __future__ import annotations

import html
import json
import re
import sys
from pathlib import Path
from typing import Any

import flexsc
from latex2mathml.converter import convert
from mkdocs.plugins import event_priority
from mkdocs.structure.files import File, Files

sys.path.insert(0, str(Path(__file__).parent))
import gallery
import playground
import reference
import search
import tutorials
from scenario_keys import Keys

import examples

ROOT = Path(__file__).resolve().parents[1]
MATH = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.DOTALL)
# Comments that mark the numbers of a page for its test.
MARK = re.compile(r"<!--.*?-->\n?", re.DOTALL)
# Letters of a formula within a text that may be wider than a narrow screen.
WIDE = 60
KEYS = Keys(flexsc.schema())
# Pages that end with what tests make and compare.
WHOLE = {"combinations.md": "tests/frozen/combinations.md", "papers.md": "tests/frozen/papers.md"}


def on_config(config: Any) -> Any:
    """Adds the playground to the menu, where it has been built."""
    if playground.is_built():
        config.nav.insert(1, {"Playground": "playground.md"})
    return config


def on_files(files: Files, config: Any) -> Files:
    """Adds the pages that are made."""
    pictures = gallery.pictures()
    readme = pictures.pop(gallery.README)
    if (ROOT / "docs" / gallery.README).read_text("utf-8") != readme:
        raise SystemExit(f"docs/{gallery.README} is not current: python3 site/gallery.py")
    for path, svg in pictures.items():
        files.append(File.generated(config, path, content=svg))
    if playground.is_built():
        files.append(File.generated(config, "playground.md", content=examples.playground()))
        for path in sorted(playground.MADE.iterdir()):
            files.append(File.generated(config, f"playground/{path.name}", content=path.read_bytes()))
        hashes = f"globalThis.FLEXSC_GALLERY={json.dumps(gallery.known())};"
        files.append(File.generated(config, "playground/gallery.js", content=hashes))
    # Links of the changelog count from the repository.
    changelog = (
        (ROOT / "CHANGELOG.md")
        .read_text()
        .replace("](docs/", "](")
        .replace("](SECURITY.md", "](../SECURITY.md")
    )
    changelog = f"---\nsearch:\n  exclude: true\n---\n\n{changelog}"
    made = {**reference.pages(KEYS), **examples.pages(), "changelog.md": changelog}
    for path, text in made.items():
        files.append(File.generated(config, path, content=text))
    for source in sorted((ROOT / "docs/tutorials").glob("*.py")):
        for path, content in tutorials.made(source).items():
            files.append(File.generated(config, f"tutorials/{path}", content=content))
        files.remove(files.get_file_from_path(f"tutorials/{source.name}"))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Adds tables and anchors, drops the marks of numbers, and links files outside docs/ on GitHub."""
    if page.file.src_uri.startswith("scenario/"):
        markdown = KEYS.anchored(page.file.name + ".md", markdown)
    if page.file.src_uri in WHOLE:
        made = (ROOT / WHOLE[page.file.src_uri]).read_text("utf-8")
        markdown += "\n" + made[re.search("^## ", made, re.MULTILINE).start() :]
    if page.file.src_uri == "index.md":
        buttons = "[Install](install.md){ .md-button }"
        if playground.is_built():
            buttons = f"[Try it in the browser](playground.md){{ .md-button .md-button--primary }} {buttons}"
        markdown = markdown.replace("<!-- start -->", buttons)
        markdown = markdown.replace("<!-- gallery -->", gallery.page(playground.is_built()))
    if page.file.src_uri == "install.md" and playground.is_built():
        markdown = markdown.replace("<!-- playground -->", " This site has it: [open it](playground.md).")
    if playground.is_built() and not page.file.src_uri.startswith(("examples/", "reference/")):
        markdown = examples.linked(markdown, "../" * page.file.src_uri.count("/"))
    above = "../" * (1 + page.file.src_uri.count("/"))
    return MARK.sub("", markdown).replace(f"]({above}", "](https://github.com/flexsc/flexsc/blob/main/")


def on_page_content(content: str, **_: Any) -> str:
    """Turns formulas into MathML, which browsers draw without a script."""

    def formula(match: re.Match[str]) -> str:
        display = "block" if match[2] == "[" else "inline"
        text = html.unescape(match[3].strip())
        # What the converter does not know, or sets too narrowly.
        text = text.replace(r"\begin{aligned}", r"\begin{array}{rl}").replace(
            r"\end{aligned}", r"\end{array}"
        )
        text = text.replace(r"\begin{bmatrix}", r"{\begin{bmatrix}").replace(
            r"\end{bmatrix}", r"\end{bmatrix}}"
        )
        drawn = convert(text, display=display)
        # A wide formula scrolls within its box.
        if display == "block":
            return f'<div class="formula">{drawn}</div>'
        return f'<span class="formula">{drawn}</span>' if len(text) > WIDE else drawn

    return MATH.sub(formula, content)


# After the index is written, and before it becomes a script.
@event_priority(-50)
def on_post_build(config: Any, **_: Any) -> None:
    """Adds each key of a scenario to the index of the search, and what readers call a page."""
    path = Path(config.site_dir) / "search/search_index.json"
    index = json.loads(path.read_text("utf-8"))
    index["docs"] += KEYS.entries()
    search.add_synonyms(index["docs"])
    path.write_text(json.dumps(index, separators=(",", ":")), "utf-8")
