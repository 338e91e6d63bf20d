"""Sliders in a notebook, which work without one."""

import flexsc
import pytest
from conftest import shipped

pytest.importorskip("ipywidgets", reason="the extra `explore` is not installed")


def test_a_slider_shows_the_run_at_its_value() -> None:
    scenario = shipped("earth-observer").with_("duration", 30.0)
    found = flexsc.explore(scenario, {"law.attitude.bandwidth": (0.1, 0.4)}, "pointing")
    slider, before = found.sliders["law.attitude.bandwidth"], found.shown.value
    assert (slider.min, slider.max, slider.value) == (0.1, 0.4, scenario.get("law.attitude.bandwidth"))
    assert "<svg" in before
    slider.value = 0.2
    assert found.scenario == scenario.with_("law.attitude.bandwidth", 0.2)
    assert found.shown.value != before
    run = found.scenario.simulate(log="full")
    assert run.answer.text().splitlines()[2] in found.shown.value
    # The picture is that of the run.
    (_, _, drawn) = run.svg("pointing").partition(">")
    assert drawn in found.shown.value
    # A short run follows each step.
    assert slider.continuous_update
    assert "application/vnd.jupyter.widget-view+json" in found._repr_mimebundle_()


def test_keys_have_ranges_values_and_errors() -> None:
    scenario = shipped("earth-observer").with_("duration", 5.0)
    allocation = "actuator.wheels.allocation"
    found = flexsc.explore(scenario, {allocation: ["pseudo_inverse", "least_largest"], "seed": (0, 9)})
    found.sliders[allocation].value = "least_largest"
    found.sliders["seed"].value = 4
    assert (found.scenario.get(allocation), found.scenario.seed) == ("least_largest", 4)
    # What the scenario refuses is shown in place of the picture, until it is right again.
    plain = flexsc.explore(scenario, {"law.attitude.bandwidth": (-1.0, 1.0)})
    plain.sliders["law.attitude.bandwidth"].value = -1.0
    assert "<svg" not in plain.shown.value
    assert "bandwidth" in plain.shown.value
    plain.sliders["law.attitude.bandwidth"].value = 0.2
    assert "<svg" in plain.shown.value
    assert flexsc.explore(scenario, ["law.attitude.bandwidth"]).sliders["law.attitude.bandwidth"].min > 0.0
    for keys, error, text in [
        (["law.attitude.width"], KeyError, "width"),
        (["law"], ValueError, "law"),
        ({"seed": (3, 3)}, ValueError, "must be"),
        ({"seed": (3, 4, 5)}, ValueError, "must be"),
        ({"seed": []}, ValueError, "must be"),
        (["spacecraft.rate[0]"], ValueError, "its range must be given"),
    ]:
        with pytest.raises(error, match=text):
            flexsc.explore(scenario, keys)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="sky"):
        flexsc.explore(scenario, ["duration"], "sky")
