"""Runs tests/site_browser.mjs, the site in a real Chromium, or says what is missing for it."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def missing() -> str | None:
    """What the test needs and is not here."""
    if not (ROOT / "target/site/playground.html").is_file():
        return "the site has no playground"
    if not (ROOT / "target/playground-packages/node_modules/playwright-core").is_dir():
        return "there is no playwright-core"
    return None if browser() else "there is no Chromium"


def browser() -> str | None:
    return shutil.which("chromium") or shutil.which("chromium-headless-shell")


def main() -> None:
    if reason := missing():
        print(f"SKIPPED: {reason}")
        return
    command = ROOT / "target/ci/flexsc"
    native = str(command) if command.is_file() else shutil.which("flexsc") or "flexsc"
    done = subprocess.run(["node", "tests/site_browser.mjs", str(browser()), native], cwd=ROOT, check=False)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
