"""The rules of deny.toml for every crate that is built in: `python3 tests/deny.py`.

Licences, sources and duplicates as `cargo deny check bans licenses sources` judges them, where that is not
installed.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    from pip._vendor import tomli as tomllib

ROOT = Path(__file__).resolve().parent.parent
CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"


def allows(expression, allowed):
    """Whether a licence expression can be met by licences that are allowed."""
    # Before SPDX expressions, a slash stood for a choice.
    words = re.findall(r"[()]|[^\s()]+", expression.replace("/", " OR "))

    def choice():
        met = both()
        while words and words[0] == "OR":
            words.pop(0)
            other = both()
            met = met or other
        return met

    def both():
        met = one()
        while words and words[0] == "AND":
            words.pop(0)
            other = one()
            met = met and other
        return met

    def one():
        name = words.pop(0)
        if name == "(":
            met = choice()
            words.pop(0)
            return met
        if words and words[0] == "WITH":
            name = " ".join([name, words.pop(0), words.pop(0)])
        return name in allowed

    return choice()


def is_older(version, skipped):
    """Whether a version is one that `1`, `0.2` or `0.2.1` stands for."""
    return version.split(".")[: skipped.count(".") + 1] == skipped.split(".")


def faults(rules, packages):
    """What is wrong, a line each."""
    wrong, versions = [], {}
    skips = {skip["crate"]: False for skip in rules["bans"]["skip"]}
    for package in packages:
        name, version = package["name"], package["version"]
        # Crates of this workspace have no source.
        if package["source"] not in (None, CRATES_IO):
            wrong.append(f"{name} {version} comes from {package['source']}")
        if not allows(package["license"] or "none", rules["licenses"]["allow"]):
            wrong.append(f"{name} {version} has a licence that is not allowed: {package['license']}")
        skipped = [key for key in skips if key.split("@")[0] == name and is_older(version, key.split("@")[1])]
        skips.update(dict.fromkeys(skipped, True))
        if not skipped:
            versions.setdefault(name, []).append(version)
    for name, several in versions.items():
        if len(several) > 1:
            wrong.append(f"{name} is there in several versions: {', '.join(several)}")
    wrong += [f"deny.toml skips {skip}, which is not there" for skip, used in skips.items() if not used]
    return wrong


def main():
    rules = tomllib.loads((ROOT / "deny.toml").read_text(encoding="utf-8"))
    command = ["cargo", "metadata", "--locked", "--all-features", "--format-version", "1"]
    told = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
    packages = json.loads(told)["packages"]
    wrong = faults(rules, packages)
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(packages)} crates keep to deny.toml")


if __name__ == "__main__":
    main()
