"""The answer of a run in Python is that of the command."""

from __future__ import annotations

import pickle

import flexsc
import pytest
from conftest import SCENARIOS, Command, json_lines


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
