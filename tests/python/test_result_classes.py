"""The classes of results: as the engine declares its results, and as its JSON has them."""

import copy
import dataclasses
import math
import pickle

import flexsc
import numpy as np
import pytest
from conftest import class_generator
from flexsc import results
from flexsc._analysis import analysis


def test_the_file_is_what_the_schema_gives() -> None:
    made = class_generator("result_classes")
    assert made.FILE.read_text(encoding="utf-8") == made.written(analysis("results"))


def test_every_class_has_its_fields_from_json() -> None:
    scenario = flexsc.Scenario.example("attitude-hold")
    margins, found = scenario.margins("torque"), analysis("margins", scenario, opened="torque")
    assert margins.disk_phase == found["disk"]["phase_rad"]
    assert margins.disk_gains == tuple(found["disk"]["gains"])
    assert margins.independent_disk == found["independent_disk"]["alpha"]
    assert margins.delay == (math.inf if found["common_delay_s"] is None else found["common_delay_s"])
    assert [each.time for each in margins.settling_times] == [each["time_s"] for each in found["settling"]]
    assert margins.settling["roll"] == max(each.time for each in margins.settling_times[:3])
    roll = margins.loops["torque_roll"]
    assert roll.gain_crossings["delay"].tolist() == [each["delay_s"] for each in found["loops"][0]["gain"]]
    assert not roll.gain_crossings["delay"].flags.writeable
    single = flexsc.Scenario.example("wheel-fast-mode").margins()
    assert math.isnan(single.independent_disk)
    assert single.independent_disk_gains is None


def test_results_are_immutable_values() -> None:
    scenario = flexsc.Scenario.example("attitude-hold")
    margins = scenario.margins()
    assert margins == copy.deepcopy(margins) == pickle.loads(pickle.dumps(margins)) == scenario.margins()
    assert type(margins).__module__ == "flexsc"
    with pytest.raises(dataclasses.FrozenInstanceError):
        margins.samples = 2  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        margins.frequency[0] = 0.0


def test_every_class_is_in_the_package() -> None:
    kinds = {name for name in results.__all__ if dataclasses.is_dataclass(getattr(results, name))}
    assert kinds <= set(flexsc.__all__)
    assert all(np.ndarray.__name__ not in str(getattr(flexsc, name).__doc__) for name in kinds)
