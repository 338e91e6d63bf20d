"""The documentation does what it says: its Python and its commands run as they stand, page by page.

What cannot run here is left out: lines with a placeholder in capitals, live runs, clusters. Campaigns are cut short.
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
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
# `flexsc reproduce` runs the commands of this page.
COMMANDS = [page for page in PAGES if page.name != "papers.md"]
ELSEWHERE = re.compile(r"\b[A-Z]{3,}\b|--live|--scheduler|study\.toml|part-0|\.\.\.|\[PAPER\]|/shared")
CODE = re.compile(r"(<!-- not run: .*? -->\n+)?^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)


def blocks(page: Path) -> list[str]:
    """The Python of a page, but what says why it is not run."""
    return [code for skipped, code in CODE.findall(page.read_text(encoding="utf-8")) if not skipped]


def commands(page: Path) -> list[str]:
    """The commands of a page, without the comments behind them."""
    lines = []
    for block in re.findall(
        r"(?:^ {4}.*\n)+|^```(?:sh|text|bash)?\n.*?^```",
        page.read_text(encoding="utf-8"),
        re.DOTALL | re.MULTILINE,
    ):
        for line in re.findall(r"^ *(flexsc [a-z].*)$", block, re.MULTILINE):
            line = re.split(r"\s{3,}|\s+#", line)[0]
            lines += [part.strip() for part in line.split("&&") if not ELSEWHERE.search(part)]
    return lines


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with what a clone has."""
    for folder in ("scenarios", "docs/images"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page)], ids=name)
def test_the_python_of_a_page_runs(page: Path, place: Path) -> None:
    code = "\n".join(blocks(page))
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", [page for page in COMMANDS if commands(page)], ids=name)
def test_the_commands_of_a_page_run(page: Path, place: Path) -> None:
    written = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    if page.name == "start.md":
        (place / "mine.toml").write_text("\n".join(written), encoding="utf-8")
    for line in commands(page):
        short = re.sub(r"--runs \d{3,}", "--runs 60", line)
        words = shlex.split(short)
        done = subprocess.run([command_path(), *words[1:]], capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
