"""Figures by Matplotlib: those of the command, with its names, colours, labels and values."""

import math
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import SCENARIOS, Command, shipped
from flexsc import Result

matplotlib: Any = pytest.importorskip("matplotlib")
pytest.importorskip("matplotlib.pyplot")
matplotlib.use("agg")
plot: Any = pytest.importorskip("flexsc.plot")


@pytest.fixture(autouse=True)
def _closed() -> Any:
    yield
    matplotlib.pyplot.close("all")


@pytest.fixture(scope="module")
def run() -> Result:
    return shipped("relay-adaptive").with_("duration", 4000.0).simulate()


# One of each kind that draws something of its own.
KINDS = [
    "relay-adaptive",
    "rotation-robust",
    "wheel-ekf",
    "iss-manoeuvre",
    "wheel-friction",
    "earth-observer",
]


@pytest.mark.parametrize("name", KINDS)
def test_figures_are_those_of_the_command(name: str, command: Command, tmp_path: Path) -> None:
    scenario = shipped(name)
    short = min(scenario.duration, 400.0)
    command("simulate", SCENARIOS / f"{name}.toml", "--set", f"duration={short}", "-o", tmp_path)
    command("plot", tmp_path / f"{name}.mcap", "--format", "svg", "-o", tmp_path / "svg")
    made = {path.stem.removeprefix(f"{name}-"): path for path in (tmp_path / "svg").iterdir()}
    result = scenario.with_("duration", short).simulate()
    # The command leaves out figures whose values are all zero.
    assert set(plot.figures(result)) >= set(made)
    for figure, path in made.items():
        texts = re.findall(r"<text[^>]*>\s*([^<]*?)\s*</text>", path.read_text())
        drawn = plot.figure(result, figure)
        assert drawn.get_suptitle()
        assert drawn.get_suptitle() not in texts
        # A map of a figure with a bar has axes for it.
        for axes in drawn.axes:
            for label in (axes.get_xlabel(), axes.get_ylabel()):
                assert not label or label in texts, (figure, label)
            legend = axes.get_legend()
            for entry in legend.get_texts() if legend else ():
                assert entry.get_text() in texts, (figure, entry.get_text())
        colours = {
            matplotlib.colors.to_hex(line.get_color()) for axes in drawn.axes for line in axes.get_lines()
        }
        assert all(colour.upper() in path.read_text() for colour in colours), (figure, colours)
        matplotlib.pyplot.close(drawn)


def test_axes_are_the_users_own_and_hold_si(run: Result) -> None:
    _, axes = matplotlib.pyplot.subplots()
    assert plot.draw(run, "angle", axes) is axes
    line = max(axes.get_lines(), key=lambda line: len(line.get_xdata()))
    times, angles = line.get_xdata(), line.get_ydata()
    seen = run.sample(np.clip(times, 0.0, 4000.0))["attitude"]["angle_rad"]
    # Between the rows of the log a line is a smooth curve.
    np.testing.assert_allclose(angles, seen, rtol=0.0, atol=1e-9)
    assert axes.get_ylabel() == "angle x (arcsec)"
    formatter = axes.yaxis.get_major_formatter()
    assert formatter(-100.0 * math.pi / 648000.0) == "\N{MINUS SIGN}100"
    assert axes.get_title() == ""
    below = plot.draw(run, "envelope", panel=0)
    assert below.get_xlabel() == "time (s)"
    assert [text.get_text() for text in below.get_xticklabels()][:3] == ["0", "500", "1000"]
    assert below.get_title().startswith("Relay adaptive: envelope")
    with pytest.raises(ValueError, match="figure 'angle' has panels 0 to 0, got 1"):
        plot.draw(run, "angle", panel=1)
    with pytest.raises(
        ValueError, match=r"there is no figure `wheel` for this log(.|\n)*hint: it has phase-plane"
    ):
        plot.draw(run, "wheel")


def test_a_figure_that_does_not_exist_is_named(run: Result) -> None:
    with pytest.raises(ValueError, match="no figure 'angel' for it; it has phase-plane"):
        plot.draw(run, "angel")


def test_logs_and_subfigures(run: Result, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    run.to_mcap(path)
    assert plot.figures(path) == plot.figures(flexsc.read_log(path)) == plot.figures(run)
    whole = matplotlib.pyplot.figure(layout="constrained")
    left, _ = whole.subfigures(1, 2)
    assert plot.figure(path, "gain", left) is left
    assert [axes.get_ylabel() for axes in left.axes] == ["gain k_t", "mean envelope (arcsec)"]


def test_runs_are_drawn_over_each_other_as_by_the_command(
    run: Result, command: Command, tmp_path: Path
) -> None:
    other = run.scenario.with_("law.relay.k_t", 0.34).simulate()
    for name, one in {"first": run, "second": other}.items():
        one.to_mcap(tmp_path / f"{name}.mcap")
    paths = [tmp_path / "first.mcap", tmp_path / "second.mcap"]
    command("plot", *paths, "--what", "angle", "--format", "svg", "-o", tmp_path / "both")
    drawn = (tmp_path / "both" / "first-angle.svg").read_text(encoding="utf-8")
    for several in (paths, {"first": run, "second": other}):
        assert plot.drawn(several, "angle").svg() == drawn
    # Runs of one scenario are numbered.
    figure = plot.figure([run, other], "angle")
    assert figure.axes[-1].get_ylabel() == "relay-adaptive 2 \N{MINUS SIGN} relay-adaptive 1 (arcsec)"
    assert plot.figures([run, other]) == plot.figures(run)
    with pytest.raises(ValueError, match="have other axes"):
        plot.figure([run, shipped("wheel-ekf").with_("duration", 30.0).simulate()], "angle")


def test_campaigns_have_figures(command: Command, tmp_path: Path) -> None:
    sampled = shipped("relay-sampled").with_("duration", 1500.0)
    table = flexsc.campaign(sampled, runs=30, out=tmp_path / "study")
    names = plot.figures(table)
    assert {name.partition("-")[0] for name in names} == {"distribution", "scatter"}
    there = plot.figures(flexsc.read_campaign(tmp_path / "study"))
    assert there == names
    assert [name.removeprefix("relay-sampled-") for name in plot.figures(tmp_path / "study")] == names
    metric = "torque_impulse_per_hour_nm_s"
    assert plot.figures(table, [metric]) == [f"distribution-{metric}", f"scatter-{metric}"]
    axes = plot.draw(table, f"scatter-{metric}")
    [points] = axes.get_lines()
    assert sorted(points.get_ydata()) == sorted(table[metric])
    assert any(np.array_equal(points.get_xdata(), table[key]) for key in table.varied)
    with pytest.raises(ValueError, match="there is no figure"):
        plot.draw(table, "fan")
    command(
        "simulate",
        SCENARIOS / "relay-sampled.toml",
        "--set",
        "duration=500",
        "--runs",
        "4",
        "--log",
        "events",
        "-o",
        "logs",
    )
    assert "relay-sampled-fan" in plot.figures(tmp_path / "logs")
    assert len(plot.figure(tmp_path / "logs", "relay-sampled-fan").axes) >= 2


def test_sweeps_have_curves_and_maps() -> None:
    fixed = shipped("relay-fixed").with_("duration", 1500.0)
    curve = flexsc.sweep(fixed, "law.relay.k_t", np.linspace(0.3, 0.36, 7))
    assert plot.figures(curve) == ["curve"]
    assert plot.draw(curve, "curve").get_ylabel().endswith("arcsec)")
    both = flexsc.sweep(
        fixed, {"law.relay.k_t": np.linspace(0.3, 0.36, 5), "law.relay.weak": [8e-7, 1e-6, 2e-6]}
    )
    name = "region-envelope_late_mean_rad"
    drawn = plot.figure(both, name)
    # The map, and the bar of its colours.
    assert len(drawn.axes) == 2
    assert drawn.axes[1].get_xlabel() == "envelope late mean (arcsec)" or drawn.axes[1].get_ylabel() != ""
    assert drawn.axes[0].get_ylabel() == "law.relay.weak (arcsec/s²)"


def test_a_notebook_shows_a_figure_once(run: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in Jupyter: the value of a cell is displayed, and then every figure of pyplot that is still open."""
    shown: list[Any] = []

    def display(value: Any) -> None:
        own = getattr(value, "_ipython_display_", None)
        if own is not None:
            own()
        else:
            shown.append(value)

    python: Any = ModuleType("IPython.display")
    python.display = display
    monkeypatch.setitem(sys.modules, "IPython.display", python)

    def end_of_cell(value: Any) -> list[Any]:
        shown.clear()
        if value is not None:
            display(value)
        for number in matplotlib.pyplot.get_fignums():
            display(matplotlib.pyplot.figure(number))
        matplotlib.pyplot.close("all")
        return list(shown)

    with monkeypatch.context() as notebook:
        notebook.setattr(matplotlib, "get_backend", lambda: "module://matplotlib_inline.backend_inline")
        last = run.plot("gain")
        assert end_of_cell(last) == [last]
        # A figure that is no value of the cell, and several of them.
        other, more = run.plot("gain"), run.plot("angle")
        assert end_of_cell(None) == [other, more]
        # Shown again, it is one like any other.
        assert end_of_cell(last) == [last]
        whole = matplotlib.pyplot.figure()
        assert end_of_cell(run.plot("gain", on=whole)) == [whole, whole]
    # Elsewhere a figure is pyplot's.
    kept = run.plot("gain")
    assert [matplotlib.pyplot.figure(number) for number in matplotlib.pyplot.get_fignums()] == [kept]
    assert not hasattr(kept, "_ipython_display_")


def test_without_matplotlib_only_drawing_fails() -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None; import flexsc; assert hasattr(flexsc, 'plot')\n"
        "run = flexsc.Scenario.example('relay-fixed').with_('duration', 100.0).simulate()\n"
        "assert 'angle' in flexsc.plot.figures(run); flexsc.plot.draw(run, 'angle')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "flexsc.plot needs Matplotlib: pip install 'flexsc[plot]'" in done.stderr
