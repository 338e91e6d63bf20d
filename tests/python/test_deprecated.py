"""Names of earlier versions: each works, and says what its name is now."""

import re
from pathlib import Path

import flexsc
import flexsc.papers
import flexsc.scenario
import flexsc.structure
import pytest
from conftest import shipped
from flexsc._deprecated import RENAMED

ROOT = Path(__file__).parents[2]
MODULES = [name for name in RENAMED if name.startswith("flexsc.")]


@pytest.mark.parametrize("old", MODULES)
def test_a_name_of_a_module_is_that_of_its_new_place(old: str) -> None:
    def found(name: str) -> object:
        place, _, member = name.removeprefix("flexsc.").rpartition(".")
        return getattr(getattr(flexsc, place) if place else flexsc, member)

    with pytest.warns(DeprecationWarning, match=re.escape(f"{old} is now {RENAMED[old]}, and")) as told:
        assert found(old) is found(RENAMED[old])
    # It is the user's line that is named.
    assert told[0].filename == __file__
    assert old.rpartition(".")[2] not in flexsc.__all__


def test_members_and_keywords_have_their_old_names() -> None:
    scenario = shipped("attitude-hold")
    with pytest.warns(DeprecationWarning, match=r"Scenario\.parts is now Scenario\.own_parts"):
        assert scenario.parts == {}  # type: ignore[attr-defined]
    noise = scenario.spectrum()
    with pytest.warns(DeprecationWarning, match=r"NoiseSpectrum\.frequency is now") as told:
        assert noise.frequency is noise.frequency_hz  # type: ignore[attr-defined]
    assert told[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="nyquist_hz"):
        assert noise.nyquist == noise.nyquist_hz  # type: ignore[attr-defined]
    opened = scenario.linearise(loop="command")
    with pytest.warns(DeprecationWarning, match=r"Linear\.margins is now Linear\.common_margins"):
        assert opened.margins(["command_roll"]).phase > 0.5  # type: ignore[attr-defined]
    table = flexsc.campaign(shipped("relay-sampled").with_("duration", 60.0), 4)
    with pytest.warns(DeprecationWarning, match=r"Table\.worst\(smallest=\) is now Table\.worst\(least=\)"):
        assert table.worst("duty", smallest=True) == table.worst("duty", least=True)  # type: ignore[call-arg]
    with pytest.raises(AttributeError, match="'Scenario' object has no attribute 'part_s'"):
        scenario.part_s  # type: ignore[attr-defined]  # noqa: B018
    with pytest.raises(AttributeError, match="'flexsc' has no attribute 'identity'"):
        flexsc.identity  # type: ignore[attr-defined]  # noqa: B018


def test_every_old_name_is_in_the_documentation() -> None:
    text = (ROOT / "docs/python.md").read_text("utf-8")
    for old, new in RENAMED.items():
        if "papers" not in new:
            assert f"`{old.removeprefix('flexsc.')}`" in text, old
    assert "`flexsc.papers`" in text
