"""tests/deny.py finds what breaks the rules of deny.toml."""

import importlib.util
from pathlib import Path
from typing import Any

import pytest

PATH = Path(__file__).parent.parent / "deny.py"
spec = importlib.util.spec_from_file_location("deny", PATH)
assert spec is not None
assert spec.loader is not None
deny = importlib.util.module_from_spec(spec)
spec.loader.exec_module(deny)

RULES: dict[str, Any] = {
    "licenses": {"allow": ["MIT", "Zlib", "Apache-2.0 WITH LLVM-exception"]},
    "bans": {"skip": [{"crate": "old@0.2"}]},
}


def crate(
    name: str, version: str = "1.0.0", licence: str | None = "MIT", source: str | None = deny.CRATES_IO
) -> dict[str, str | None]:
    return {"name": name, "version": version, "license": licence, "source": source}


GOOD = [crate("a"), crate("ours", source=None), crate("old", "0.2.7"), crate("old", "0.3.0")]


@pytest.mark.parametrize(
    ("expression", "allowed"),
    [
        ("MIT", True),
        ("MIT OR GPL-3.0", True),
        ("GPL-3.0/MIT", True),
        ("GPL-3.0 AND MIT", False),
        ("GPL-3.0 OR MIT AND Zlib", True),
        ("(GPL-3.0 OR MIT) AND GPL-2.0", False),
        ("(GPL-3.0 OR MIT) AND Zlib", True),
        ("Apache-2.0", False),
        ("Apache-2.0 WITH LLVM-exception OR GPL-3.0", True),
    ],
)
def test_licences(expression: str, allowed: bool) -> None:
    assert deny.allows(expression, RULES["licenses"]["allow"]) == allowed


def test_what_keeps_to_the_rules() -> None:
    assert deny.faults(RULES, GOOD) == []


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (crate("b", source="git+https://example.org/b"), "b 1.0.0 comes from git+https://example.org/b"),
        (crate("b", source="registry+https://example.org"), "b 1.0.0 comes from"),
        (crate("b", licence="GPL-3.0"), "b 1.0.0 has a licence that is not allowed: GPL-3.0"),
        (crate("b", licence=None), "b 1.0.0 has a licence that is not allowed: None"),
        (crate("a", "2.0.0"), "a is there in several versions: 1.0.0, 2.0.0"),
        (crate("old", "0.20.0"), "old is there in several versions: 0.3.0, 0.20.0"),
    ],
)
def test_what_breaks_the_rules(bad: dict[str, str | None], words: str) -> None:
    (fault,) = deny.faults(RULES, [*GOOD, bad])
    assert words in fault


def test_a_rule_for_nothing() -> None:
    assert deny.faults(RULES, GOOD[:2]) == ["deny.toml skips old@0.2, which is not there"]
