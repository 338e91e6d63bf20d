"""release/licences.py takes one of several licences, and finds its text."""

import importlib.util
from pathlib import Path

import pytest

PATH = Path(__file__).parents[2] / "release" / "licences.py"
spec = importlib.util.spec_from_file_location("licences", PATH)
assert spec is not None
assert spec.loader is not None
licences = importlib.util.module_from_spec(spec)
spec.loader.exec_module(licences)


@pytest.mark.parametrize(
    ("expression", "chosen"),
    [
        ("MIT", ["MIT"]),
        ("MIT OR Apache-2.0", ["Apache-2.0"]),
        ("MIT/Apache-2.0", ["Apache-2.0"]),
        ("Unlicense OR MIT", ["MIT"]),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", ["Apache-2.0", "Unicode-3.0"]),
        ("Apache-2.0 WITH LLVM-exception OR MIT", ["Apache-2.0 WITH LLVM-exception"]),
        ("GPL-3.0 OR Zlib", ["Zlib"]),
    ],
)
def test_one_of_several_licences_is_taken(expression: str, chosen: list[str]) -> None:
    assert licences.chosen(expression) == chosen


def test_each_crate_has_the_text_of_its_licence(tmp_path: Path) -> None:
    (tmp_path / "LICENSE-MIT").write_text("MIT\n\nPermission is hereby granted, free of charge, to A")
    (tmp_path / "LICENSE-ZLIB").write_text("This software is provided 'as-is', by A")
    (tmp_path / "NOTICE").write_text("A wrote it. \r\n")
    crate = {"name": "a", "version": "1", "authors": [], "manifest_path": str(tmp_path / "Cargo.toml")}
    found = dict(licences.licence_texts(crate | {"license": "MIT AND Zlib"}))
    assert found["MIT"].endswith("to A")
    assert found["Zlib"].endswith("by A")
    assert found["notice"] == "A wrote it."
    with pytest.raises(SystemExit, match="a 1 has no text of BSD-3-Clause"):
        list(licences.licence_texts(crate | {"license": "BSD-3-Clause"}))


def test_the_file_names_every_crate_of_the_lock_file_that_is_linked() -> None:
    text = licences.FILE.read_text(encoding="utf-8")
    for name in ("flexsc", "serde", "plotters", "zstd-sys", "numpy", "tungstenite"):
        assert f" {name} " in text or f": {name}," in text, name
    assert "Bitstream Vera Fonts Copyright" in text
