"""The documentation does what it says: its commands and its Python run as they stand, page by page.

What cannot run here is left out: lines with a placeholder in capitals, live runs, clusters, and `reproduce`,
which has a test of its own. Campaigns are cut short.
"""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import command_path

ROOT = Path(__file__).parents[2]
# What package indexes show.
PACKAGE = ROOT / "crates/py/README.md"
PAGES = [ROOT / "README.md", PACKAGE, *sorted((ROOT / "docs").rglob("*.md"))]
VERBS = (
    "check|completions|cycle|damping|examples|export|export-fmu|identify|layout|log|map|merge|modes|new|observer|"
    "plan|plot|schema|simulate|sweep|top|tune"
)
ELSEWHERE = re.compile(r"\b[A-Z]{3,}\b|--live|--scheduler|study\.toml|part-0|\.\.\.|/shared")
BLOCK = re.compile(r"(?:^ {4}.*\n)+|^```(?:sh|text|bash)?\n(?:.*\n)*?```", re.MULTILINE)
# How many runs a call in Python has.
CALL = re.compile(r"(\bcampaign\(\w+, (?:runs=)?)\d[\d_]{2,}\b")
CODE = re.compile(r"(<!-- not run: .*? -->\n+)?^```python\n((?:.*\n)*?)```", re.MULTILINE)
# Libraries that a page shows and that the tests do without: a block that needs one is left out.
OPTIONAL = {
    "Basilisk",
    "brahe",
    "cma",
    "control",
    "dask",
    "duckdb",
    "numba",
    "pandas",
    "polars",
    "ray",
    "xarray",
}
RUN = """
names = {"__name__": "__main__"}
for block in BLOCKS:
    try:
        exec(block, names)
    except ModuleNotFoundError as missing:
        if missing.name not in OPTIONAL:
            raise
"""


def code(page: Path) -> list[str]:
    """The blocks of Python of a page, but for those that say why they are not run."""
    blocks = [block for skipped, block in CODE.findall(page.read_text("utf-8")) if not skipped]
    return [CALL.sub(r"\g<1>12", block) for block in blocks]


def commands(page: Path) -> list[str]:
    """The commands of a page, without the comments behind them."""
    lines: list[str] = []
    for block in BLOCK.findall(page.read_text("utf-8")):
        for line in re.findall(
            rf"^ *((?:flexsc|cargo run --release --) (?:{VERBS}) .*)$", block, re.MULTILINE
        ):
            command = re.split(r"\s{3,}|\s+#|\s+>", line.replace("cargo run --release --", "flexsc"))[0]
            lines += [part.strip() for part in command.split("&&") if not ELSEWHERE.search(part)]
    return lines


@pytest.mark.parametrize(
    "page",
    [page for page in PAGES if code(page) or commands(page)],
    ids=lambda page: str(page.relative_to(ROOT)),
)
def test_what_a_page_says_runs(page: Path, tmp_path: Path) -> None:
    for folder in ("scenarios", "docs/images"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    if page.name in {"start.md", "data-sheets.md"}:
        written = re.findall(r"```toml\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
        (tmp_path / "mine.toml").write_text("\n".join(written), "utf-8")

    def run(*words: str) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)

    for line in commands(page):
        short = re.sub(r"--row \d{2,}", "--row 1", re.sub(r"--runs \d{3,}", "--runs 2", line))
        # One of the faults of a scenario, once.
        short = re.sub(r"--vary active_fault\b(?!=)", "--vary 'active_fault=gyro out'", short)
        short = re.sub(r"--replicas \d+", "--replicas 1", short)
        done = run(command_path(), *shlex.split(short)[1:])
        # With fewer runs or as the page says, a requirement may be missed.
        expected = (0, 3) if "requirement" in done.stderr else (0,)
        assert done.returncode in expected, f"{line}\n{done.stderr}"
    script = f"BLOCKS = {code(page)!r}\nOPTIONAL = {OPTIONAL!r}\n{RUN}"
    done = run(sys.executable, "-W", "error", "-c", script)
    assert done.returncode == 0, done.stderr


def test_a_package_index_can_show_its_page() -> None:
    assert f'readme = "{PACKAGE.relative_to(ROOT)}"' in (ROOT / "pyproject.toml").read_text("utf-8")
    text = PACKAGE.read_text("utf-8")
    links = re.findall(r"\]\(([^)]*)\)", text)
    assert len(links) > 4
    for link in links:
        place = link.removeprefix("https://github.com/flexsc/flexsc/blob/main/")
        assert place != link, "an index cannot follow a relative link"
        assert (ROOT / place).is_file(), place
    assert "{%" not in text
    assert "<!--" not in text
