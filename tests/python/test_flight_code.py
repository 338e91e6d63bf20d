"""The control system of a scenario as C99, from Python."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import flexsc
import pytest


def test_the_control_system_is_exported_and_replays_the_run(tmp_path: Path) -> None:
    scenario = flexsc.Scenario.example("wheel-scheduled-gain")
    files = scenario.export_c(tmp_path / "flight", name="wheel", calls=300)
    assert {file.name for file in files} >= {"wheel.c", "wheel.h", "driver.c", "vectors.bin", "Makefile"}
    if shutil.which("make") is None or shutil.which("gcc") is None:
        pytest.skip("make and gcc are not installed")
    done = subprocess.run(
        [
            "make",
            "-C",
            str(tmp_path / "flight"),
            "check",
            "CYCLES=1000",
            f"HASH={hash_of(tmp_path / 'flight')}",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "134 calls equal" in done.stdout


def hash_of(folder: Path) -> str:
    """Return the hash of 1000 cycles in the description of an exported control system."""
    lines = (folder / "README.md").read_text(encoding="utf-8").splitlines()
    (row,) = [line for line in lines if line.startswith("| 1000 |")]
    return row.split("|")[2].strip()


def test_guests_are_written_beside_the_control_system(tmp_path: Path) -> None:
    scenario = flexsc.Scenario.example("relay-sampled")
    files = scenario.export_c(tmp_path / "flight", name="relay", calls=10, guests=["cfs", "fprime"])
    names = {str(file.relative_to(tmp_path / "flight")) for file in files}
    assert {
        "cfs/relay_app/fsw/src/relay_app.c",
        "fprime/Components/RelayControl/RelayControl.fpp",
    } <= names
    with pytest.raises(ValueError, match="'vxworks' is none of cfs, fprime"):
        scenario.export_c(tmp_path / "other", guests=["vxworks"])  # type: ignore[list-item]


def test_a_crate_of_rust_is_written(tmp_path: Path) -> None:
    scenario = flexsc.Scenario.example("relay-sampled")
    files = scenario.export_c(tmp_path / "flight", name="relay", calls=10, language="rust")
    names = {str(file.relative_to(tmp_path / "flight")) for file in files}
    assert {"Cargo.toml", "src/lib.rs", "src/control_system.rs", "tests/replay.rs"} <= names
    with pytest.raises(ValueError, match="'ada' is none of c, rust"):
        scenario.export_c(tmp_path / "other", language="ada")  # type: ignore[arg-type]


def test_a_law_without_plain_code_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"law\.open"):
        flexsc.Scenario.example("rotation-cosine").export_c(tmp_path / "flight")
    assert not (tmp_path / "flight").exists()
    scenario = flexsc.Scenario.example("relay-sampled")
    scenario.export_c(tmp_path / "flight", name="relay")
    (tmp_path / "flight" / "relay.c").write_text("changed", encoding="utf-8")
    with pytest.raises(ValueError, match="already exists"):
        scenario.export_c(tmp_path / "flight", name="relay")
    scenario.export_c(tmp_path / "flight", name="relay", force=True)
