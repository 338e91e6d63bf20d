"""Builds the command for a target into dist/, with checksum, licences and bill of materials (CycloneDX).

`python release/binary.py x86_64-unknown-linux-gnu`; the crates are those of the lock file.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
DIST = ROOT / "dist"
# The linker sees all crates at once: smaller and faster, in several times the time.
LINK_ONCE = ("--config", 'profile.release.lto="fat"')


def cargo(*words: str) -> bytes:
    """Runs cargo, which must succeed, and returns what it printed."""
    return subprocess.run(["cargo", *words], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout


def materials(target: str) -> dict[str, Any]:
    """The crates that are in the command, as a CycloneDX document."""
    found = json.loads(
        cargo(
            "metadata", "--locked", "--format-version", "1", "--features", "full", "--filter-platform", target
        )
    )
    packages = {package["id"]: package for package in found["packages"]}
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    (command,) = (package["id"] for package in packages.values() if package["name"] == "flexsc")
    within, todo = {command}, [command]
    while todo:
        for dependency in nodes[todo.pop()]["deps"]:
            kinds = {kind["kind"] for kind in dependency["dep_kinds"]}
            if None in kinds and dependency["pkg"] not in within:
                within.add(dependency["pkg"])
                todo.append(dependency["pkg"])
    components = []
    for package in sorted(
        (packages[one] for one in within), key=lambda package: (package["name"], package["version"])
    ):
        components.append(
            {
                "type": "application" if package["id"] == command else "library",
                "name": package["name"],
                "version": package["version"],
                "purl": f"pkg:cargo/{package['name']}@{package['version']}",
                "licenses": [{"expression": package["license"]}] if package["license"] else [],
            }
        )
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "components": components}


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    target = sys.argv[1]
    features = ("-p", "flexsc", "--features", "full")
    cargo("build", "--release", *LINK_ONCE, "--locked", *features, "--target", target)
    suffix = ".exe" if "windows" in target else ""
    version = json.loads(cargo("metadata", "--no-deps", "--format-version", "1"))["packages"][0]["version"]
    DIST.mkdir(exist_ok=True)
    name = f"flexsc-{version}-{target}"
    binary = DIST / f"{name}{suffix}"
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / target / "release" / f"flexsc{suffix}"
    shutil.copyfile(built, binary)
    binary.chmod(0o755)
    # The library of FMUs, which the build of the command makes: `flexsc export-fmu --library`.
    system = "windows" if suffix else "darwin" if "darwin" in target else "linux"
    library = {"windows": "flexsc_fmi.dll", "darwin": "libflexsc_fmi.dylib", "linux": "libflexsc_fmi.so"}[
        system
    ]
    made = DIST / f"{name}-{library}"
    shutil.copyfile(built.parent / "deps" / library, made)
    (DIST / f"{name}.cdx.json").write_text(json.dumps(materials(target), indent=1), encoding="utf-8")
    # The licences of the crates in both.
    shutil.copyfile(ROOT / "crates/cosim/licences.txt", DIST / f"{name}-licences.txt")
    digest = hashlib.sha256(binary.read_bytes()).hexdigest()
    sums = f"{digest}  {binary.name}\n{hashlib.sha256(made.read_bytes()).hexdigest()}  {made.name}\n"
    (DIST / f"{name}.sha256").write_text(sums, encoding="utf-8")
    print(f"{binary}\n{digest}")


if __name__ == "__main__":
    main()
