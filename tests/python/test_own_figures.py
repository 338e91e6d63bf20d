"""Figures of runs with parts in Python, and of their logs, which are drawn from their rows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import flexsc
import flexsc.plot
import pytest
from conftest import Command, shipped
from flexsc import _native as engine
from test_mode_laws import Damper


class Seek(flexsc.Adaptation):
    """Raises the gain in small steps."""

    tunes = "k_t"

    def start(self, value: float, draws: Any) -> None:
        self.value = value

    def learn(self, time: float, measured: float) -> float:
        self.value = min(self.value + 1e-3, 0.4)
        return self.value


def pointing() -> flexsc.Scenario:
    return shipped("earth-observer").with_("duration", 60.0).with_parts(law=Damper())


def seeking() -> flexsc.Scenario:
    return shipped("relay-adaptive").with_("duration", 2000.0).with_parts(adaptation=Seek())


def svg(log: flexsc.Log, name: str) -> str:
    return str(engine.log_figure(log._native, name, None).svg())


def test_a_full_log_is_drawn_as_its_run(tmp_path: Path, command: Command) -> None:
    pytest.importorskip("matplotlib").use("agg")
    for number, scenario in enumerate((pointing(), seeking())):
        run = scenario.simulate(log="full")
        names = flexsc.plot.figures(run)
        assert ("pointing" if number == 0 else "gain") in names
        path = tmp_path / f"own{number}.mcap"
        run.to_mcap(path)
        log = flexsc.read_log(path)
        assert flexsc.plot.figures(log) == names
        for name in names:
            assert svg(log, name) == flexsc.plot.drawn(run, name).svg()
        assert flexsc.plot.figure(log, names[0]).axes
        assert "<svg" in run._repr_html_()
        log.export(tmp_path / f"own{number}.glb")
        command("plot", path, "--format", "svg", "-o", tmp_path / "figures")
        command("layout", path, "-o", tmp_path / f"own{number}.json")


def test_a_run_of_events_is_repeated_with_its_parts(tmp_path: Path, command: Command) -> None:
    for scenario, name in ((pointing(), "pointing"), (seeking(), "envelope")):
        run = scenario.simulate()
        assert flexsc.plot.drawn(run, name).svg()
        assert "<svg" in run._repr_html_()
        path = tmp_path / f"{name}.mcap"
        run.to_mcap(path)
        with pytest.raises(ValueError, match="only the program of its parts"):
            flexsc.plot.drawn(flexsc.read_log(path), name)
        done = command("plot", path, "--what", name, exits=2)
        assert b"only the program of its parts" in done.stderr
