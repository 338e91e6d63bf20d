"""What is shown: metrics with units, texts, and HTML with a figure."""

import json
import pickle
from xml.etree import ElementTree

import flexsc
import pytest
from conftest import shipped
from flexsc import Scenario


def figures(html: str) -> list[ElementTree.Element]:
    """The SVG within some HTML, which is whole."""
    start = [at for at in range(len(html)) if html.startswith("<svg", at)]
    return [ElementTree.fromstring(html[at : html.index("</svg>", at) + 6]) for at in start]


def test_metrics_know_their_units(fixed: Scenario) -> None:
    metrics = fixed.with_("duration", 600.0).simulate().metrics
    assert metrics.unit("cycle_period_s") == "s"
    assert metrics.unit("switchings") == ""
    # The body has no moment of inertia.
    assert metrics.unit("torque_impulse_per_hour_nm_s") == "rad/s"
    assert "cycle" in metrics.doc("cycle_period_s")
    assert set(metrics) <= set(flexsc.metrics())
    assert "switchings: 81" in repr(metrics)
    with pytest.raises(KeyError, match="no metric 'speed'; there are "):
        metrics.unit("speed")
    again = pickle.loads(pickle.dumps(metrics))
    assert dict(again)["switchings"] == 81
    assert again.unit("cycle_period_s") == "s"
    assert json.loads(json.dumps({"switchings": metrics["switchings"]})) == {"switchings": 81}


@pytest.mark.parametrize(
    ("name", "axis"),
    [
        ("relay-fixed", "angle x (arcsec)"),
        ("rotation-sine", "angle of the hub"),
        ("iss-manoeuvre", "pointing error (deg)"),
    ],
)
def test_runs_are_shown_with_a_figure(name: str, axis: str) -> None:
    scenario = shipped(name)
    run = scenario.with_("duration", min(scenario.duration, 300.0)).simulate()
    html = run._repr_html_()
    [figure] = figures(html)
    assert "width:560px" in figure.get("style", "")
    text = " ".join(element.text or "" for element in figure.iter() if element.tag.endswith("text"))
    assert axis in text
    # The whole is well-formed, and has a row for each metric and each topic.
    whole = ElementTree.fromstring(f"<div>{html}</div>")
    first = [row[0].text for table in whole.iter("table") for row in table.iter("tr")]
    assert first == ["metric", *run.metrics, "topic", *run.topics]
    # A run that takes long is not repeated for it.
    run._took = 60.0
    assert figures(run._repr_html_()) == []


def test_scenarios_and_tables_are_shown(sampled: Scenario) -> None:
    [figure] = figures(sampled._repr_html_())
    assert "natural frequency (Hz)" in "".join(figure.itertext())
    assert "&lt;b&gt;" in sampled.with_("about", "<b>")._repr_html_()
    rigid = shipped("relay-fixed").with_("body.planar.modes", [])
    assert figures(rigid._repr_html_()) == []
    table = flexsc.campaign(sampled, runs=8)
    [figure] = figures(table._repr_html_())
    assert "8 runs" in "".join(figure.itertext())
    assert figures(flexsc.campaign(sampled, runs=1)._repr_html_()) == []
    # Without keys that vary there is no scatter.
    for same in ("relay-fixed", "wheel-ekf"):
        plain = flexsc.campaign(shipped(same).with_("duration", 300.0), runs=3)
        assert "3 runs" in plain._repr_html_()


def test_results_of_tools_are_tables() -> None:
    margins = shipped("earth-observer").margins()
    assert repr(margins).startswith("StabilityMargins(modulus=0.5773, disk=0.7528; command_roll: gain ")
    opened = shipped("earth-observer").linearise(loop="command")
    common = opened.common_margins()
    assert common.to_dict() == {
        "gain_below": common.gain_below,
        "gain_above": common.gain_above,
        "phase": common.phase,
    }
    assert opened == pickle.loads(pickle.dumps(opened))
    assert opened != shipped("earth-observer").linearise()
    assert opened.to_dict()["inputs"][0] == {"name": opened.inputs[0].name, "unit": opened.inputs[0].unit}
    run = shipped("relay-fixed").with_("duration", 50.0).simulate()
    plan = shipped("rotation-sine").plan()
    derivatives = flexsc.sensitivities(shipped("rotation-sine"), ["manoeuvre.angle"], ["peak_torque_nm"])
    budget = shipped("slew-wheel-lqg").budget(runs=2)
    for shown in (margins, opened, common, run.metrics, plan, derivatives, budget):
        whole = ElementTree.fromstring(f"<div>{shown._repr_html_()}</div>")
        assert sum(1 for _ in whole.iter("tr")) > 1
    assert len(repr(budget)) < 1000


def test_results_of_tools_become_frames() -> None:
    pytest.importorskip("pandas")
    margins = shipped("earth-observer").margins()
    frames = margins.to_pandas()
    assert frames["fields"]["modulus"] == margins.modulus
    assert frames["loops"].set_index("name")["gain_above"]["command_roll"] == (
        margins.loops["command_roll"].gain_above
    )


def test_parts_are_shown_as_they_are_written() -> None:
    assert repr(flexsc.Reading(angle=1.0)) == "Reading(angle=1.0)"
    hold = flexsc.ThreeAxisHold([1.0, 2.0, 3.0], after=0.5)
    assert repr(flexsc.Effort([0.0, 0.0, 0.0])) == "Effort(torques=[0.0, 0.0, 0.0])"
    assert eval(repr(flexsc.Reading(angle=0.0)), vars(flexsc)).angle == 0.0
    for part in (hold, flexsc.Effort([1.0], after=0.5), flexsc.Load([1.0, 0.0, 0.0], after=1.0)):
        assert eval(repr(part), vars(flexsc)) == part
