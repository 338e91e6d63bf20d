"""The answer of a run in Python is that of the command."""

from __future__ import annotations

import pickle
from pathlib import Path

import flexsc
import pytest
from conftest import SCENARIOS, Command, json_lines, shipped
from test_mode_laws import Damper


@pytest.mark.parametrize("name", ["shaped-slew", "safe-mode", "wheel-ekf", "relay-adaptive", "canted-jets"])
def test_the_answer_is_the_commands(name: str, command: Command) -> None:
    [told] = json_lines(command("simulate", SCENARIOS / f"{name}.toml", "--log", "none", "--json"))
    run = flexsc.Scenario.example(name).simulate(log="none")
    assert run.answer.to_dict() == told["answer"]
    assert tuple(told["answer"].get("requirements", ())) == run.answer.requirements
    assert run.warnings == tuple(told.get("warnings", ()))
    text = run.answer.text()
    assert text.startswith(f"{name}   ")
    assert run.answer.verdict_text in " ".join(text.split())
    assert len(run.answer.text(all=True).splitlines()) >= len(text.splitlines())
    assert run.answer.verdict_text in run.answer._repr_html_()


def test_a_copy_of_a_run_has_its_answer() -> None:
    run = flexsc.Scenario.example("shaped-slew").simulate(log="none")
    copy = pickle.loads(pickle.dumps(run))
    assert copy.answer == run.answer
    assert copy.answer.text() == run.answer.text()
    assert hash(copy.answer) == hash(run.answer)


def test_two_sides_compare_as_the_command_does(tmp_path: Path, command: Command) -> None:
    scenario = flexsc.Scenario.example("half-turn")
    other = scenario.with_("reference.pointing.rms", "1 arcsec")
    run = other.simulate(log="full")
    run.to_mcap(tmp_path / "b.mcap")
    both = flexsc.compare(scenario, other)
    assert [answer["verdict"] for answer in both.answers] == ["met", "missed"]
    told = json_lines(command("compare", SCENARIOS / "half-turn.toml", tmp_path / "b.mcap", "--json"))[0]
    assert list(both.answers) == told["answers"]
    assert (
        [own["key"] for own in both.keys]
        == [own["key"] for own in told["keys"]]
        == ["reference.pointing.rms"]
    )
    # A result, a copy of it, its log and its path are the same side.
    for side in (
        run,
        pickle.loads(pickle.dumps(run)),
        flexsc.read_log(tmp_path / "b.mcap"),
        tmp_path / "b.mcap",
    ):
        assert flexsc.compare(scenario, side).answers == both.answers
    assert "1.82 arcsec (74 %)" in both.text()
    tables = [flexsc.campaign(side, runs=6) for side in (scenario, other)]
    campaigns = flexsc.compare(*tables)
    assert [answer["kind"] for answer in campaigns.answers] == ["campaign", "campaign"]
    assert campaigns.answers[0] == tables[0].answer.to_dict()
    with pytest.raises(ValueError, match="not one of each"):
        flexsc.compare(scenario, tables[0])


def test_a_log_of_own_parts_is_answered_from_its_rows(tmp_path: Path) -> None:
    run = shipped("earth-observer").with_("duration", 60.0).with_parts(law=Damper()).simulate(log="full")
    run.to_mcap(tmp_path / "own.mcap")
    answer = flexsc.read_log(tmp_path / "own.mcap").answer
    assert answer.verdict == run.answer.verdict
    assert "from rows every" in answer.text()
    assert answer.to_dict()["from_rows_s"] > 0.0
    # Rows have no larger errors than control cycles.
    lines = {line["head"]: line["text"] for line in answer.to_dict()["lines"]}
    assert lines["pointing"].startswith("54 to 60 s: error ")


def test_a_campaign_has_warnings_and_modes() -> None:
    filters = flexsc.campaign(flexsc.Scenario.example("wheel-ekf"), runs=4).answer
    assert {own["kind"] for own in filters.warnings} == {"filter"}
    assert filters.warnings[0]["runs"] <= 4
    modes = flexsc.campaign(flexsc.Scenario.example("safe-mode").with_("duration", 1500.0), runs=2).answer
    assert [own["mode"] for own in modes.by_mode] == ["detumble", "point", "safe"]
    assert [own["runs"] for own in modes.by_mode] == [2, 2, 0]
