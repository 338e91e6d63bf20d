"""Scenarios: from files, texts and dictionaries, changed, compared, pickled, refused."""

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from datetime import datetime, timedelta, timezone
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import SCENARIOS, shipped
from flexsc import Scenario, ScenarioError

ALL = sorted(path.stem for path in SCENARIOS.glob("*.toml"))


@pytest.mark.parametrize("name", ALL)
def test_a_scenario_survives_every_form(name: str) -> None:
    scenario = shipped(name)
    assert scenario.name == name
    assert Scenario(scenario.to_dict()) == scenario
    assert Scenario.parse(scenario.to_toml()) == scenario
    assert Scenario.parse((SCENARIOS / f"{name}.toml").read_text(), name=name) == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    assert copy.deepcopy(scenario) == scenario
    assert scenario != scenario.with_("seed", scenario.seed + 1)
    assert scenario != name


# Shortened, so that no run takes a second.
SHORTER = {
    "basilisk-momentum": 600.0,
    "blinded-tracker": 600.0,
    "cubesat-day": 900.0,
    "detumble-and-point": 600.0,
    "eclipse-snap": 600.0,
    "field-aligned": 600.0,
    "forty-two-leo": 300.0,
    "magnetic-unloading": 300.0,
    "molniya": 2000.0,
    "s2e-sample": 100.0,
    "sun-tracking": 400.0,
    "two-line-orbit": 600.0,
    "wheel-friction": 20.0,
    "wheel-run-up": 5.0,
}


@pytest.mark.parametrize("name", ALL)
def test_a_scenario_is_varied_in_every_way(name: str) -> None:
    scenario = shipped(name).with_("log.period", 1.0)
    if name in SHORTER:
        scenario = scenario.with_("duration", SHORTER[name])
    drawn = scenario.draw(1)
    assert pickle.loads(pickle.dumps(drawn)) == drawn
    assert drawn.to_dict().get("epoch") == scenario.to_dict().get("epoch")
    for table in (
        flexsc.campaign(scenario, runs=2, metrics=["goal"]),
        flexsc.sweep(scenario, "log.period", [1.0, 2.0], metrics=["goal"]),
    ):
        assert table["error"].tolist() == ["", ""]


def test_a_shipped_scenario_has_a_date() -> None:
    scenario = shipped("detumble-and-point")
    assert scenario.to_dict()["epoch"] == datetime(2027, 4, 16, 6, tzinfo=timezone.utc)
    assert "\nepoch = 2027-04-16T06:00:00Z\n" in scenario.to_toml()


def test_a_dictionary_is_as_good_as_a_file(fixed: Scenario) -> None:
    built = Scenario(
        {
            "about": "Two-sided relay law at k_t = 0.31, two undamped modes, no adaptation",
            "seed": np.int32(1),
            "duration": np.float32(20000.0),
            "body": {
                "planar": {
                    "angle": 4.5e-4,
                    "rate": np.array(2.2e-5),
                    "modes": (
                        {"frequency": 0.44, "gain": 0.0213, "displacement": 2.75e-6},
                        {"frequency": np.float64(0.755), "gain": 0.0216},
                    ),
                }
            },
            "law": {
                "relay": {"dead_zone": 5e-4, "hysteresis": 1e-4, "strong": 4e-5, "weak": 1e-6, "k_t": 0.31}
            },
            "estimator": {"envelope": {"form": "dynamic", "window": 500}},
        },
        name="relay-fixed",
    )
    assert built == fixed


def test_arrays_are_lists(adaptive: Scenario) -> None:
    bounds = "adaptation.random_search.bounds"
    changed = adaptive.with_(bounds, np.array([0.3, 0.35]))
    assert changed.to_dict()["adaptation"]["random_search"]["bounds"] == [0.3, 0.35]


def test_properties(adaptive: Scenario) -> None:
    assert (adaptive.seed, adaptive.duration) == (157, 20000.0)
    modes = adaptive.modes
    assert modes["frequency"].tolist() == [0.44, 0.755]
    assert modes["gain"].tolist() == [0.0213, 0.0216]
    assert modes["damping"].tolist() == [0.0, 0.0]
    np.testing.assert_allclose(modes["excitability"], modes["gain"] / modes["frequency"] ** 2, rtol=1e-15)
    assert repr(adaptive) == "<flexsc.Scenario relay-adaptive: 20000 s, 2 modes, seed 157>"
    np.testing.assert_allclose(modes["effective_inertia"], modes["gain"])
    assert modes["free_frequency"].tolist() == [0.44, 0.755]
    assert (modes["clamped_frequency"] < modes["frequency"]).all()
    rigid = adaptive.with_("body.planar.modes", [])
    assert rigid.modes["frequency"].shape == (0,)
    assert rigid.outputs == {}


def test_matrices_become_modes(fixed: Scenario, tmp_path: Path) -> None:
    mass = np.array([[10.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 3.0]])
    stiffness = np.array([[0.0, 0.0, 0.0], [0.0, 5.0, -1.0], [0.0, -1.0, 7.0]])
    tip = {"name": "tip", "weights": {"q2": 1.0}}
    matrices = {"mass": mass, "stiffness": stiffness, "outputs": [tip]}
    values = fixed.to_dict() | {"body": {"matrices": matrices}}
    inline = Scenario(values)
    exact = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)[1:])
    np.testing.assert_allclose(inline.modes["frequency"], exact, rtol=1e-12)
    held = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass[1:, 1:], stiffness[1:, 1:])).real))
    np.testing.assert_allclose(inline.modes["clamped_frequency"], held, rtol=1e-12)
    assert inline.outputs["tip"].shape == (3,)
    np.savez(tmp_path / "model.npz", M=mass, K=stiffness)
    path = str(tmp_path / "model.npz")
    files = matrices | {"mass": f"{path}:M", "stiffness": f"{path}:K"}
    read = Scenario(values | {"body": {"matrices": files}})
    np.testing.assert_array_equal(read.modes["gain"], inline.modes["gain"])
    (tmp_path / "model.npz").unlink()
    # The modes are known: only another body needs the file again.
    np.testing.assert_array_equal(read.with_("seed", 3).modes["gain"], inline.modes["gain"])
    with pytest.raises(ScenarioError, match=r"model\.npz"):
        read.with_("body.matrices.keep", 1)


def test_keys_are_set_in_a_copy(adaptive: Scenario) -> None:
    changed = adaptive.with_({"law.relay.k_t": 0.34, "seed": 3, "body.planar.modes[1].gain": 0.02})
    assert (adaptive.seed, changed.seed) == (157, 3)
    values = changed.to_dict()
    assert values["law"]["relay"]["k_t"] == 0.34
    assert values["body"]["planar"]["modes"][1]["gain"] == 0.02
    # Only what comes out has to be valid: neither of these is, without the other.
    law = adaptive.with_({"law.relay.dead_zone": 1e-5, "law.relay.hysteresis": 1e-6}).to_dict()["law"]
    assert (law["relay"]["dead_zone"], law["relay"]["hysteresis"]) == (1e-5, 1e-6)


def test_the_name_is_kept_whole(fixed: Scenario) -> None:
    values = {key: value for key, value in fixed.to_dict().items() if key != "name"}
    assert Scenario(values).name == "scenario"
    assert Scenario(values, name="a.b").name == "a.b"
    text = fixed.to_toml().replace('name = "relay-fixed"\n', "")
    assert Scenario.parse(text, name="a.b").name == "a.b"
    assert Scenario.parse(fixed.to_toml(), name="a.b").name == "relay-fixed"
    odd = fixed.with_({"name": 'quotes " and \u00e9\U0001f6f0', "about": "a \\ b\n\t\x7f\x00"})
    assert Scenario.parse(odd.to_toml()) == odd == pickle.loads(pickle.dumps(odd)) == Scenario(odd.to_dict())


@pytest.mark.parametrize(
    "epoch",
    [
        datetime(2026, 3, 20, 14, 46, tzinfo=timezone.utc),
        datetime(2026, 3, 20, 14, 46, 5, 120000, tzinfo=timezone(timedelta(hours=-3, minutes=-30))),
        datetime(2026, 3, 20, 14, 46, 5, 123456),
    ],
)
def test_epochs_are_dates(fixed: Scenario, epoch: datetime) -> None:
    scenario = fixed.with_("epoch", epoch)
    assert scenario.to_dict()["epoch"] == epoch
    assert Scenario(scenario.to_dict()) == scenario


def test_scenarios_go_to_other_processes(fixed: Scenario) -> None:
    short = fixed.with_("duration", 500.0)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        results = list(pool.map(Scenario.simulate, [short, short.with_("law.relay.k_t", 0.34)], [0, 0]))
    assert results[0].metrics["gain_final"] == 0.31
    assert results[1].metrics["gain_final"] == 0.34
    here = short.simulate()
    assert results[0].scenario == here.scenario
    np.testing.assert_array_equal(results[0]["command"]["time_s"], here["command"]["time_s"])


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("law.relay.k_t", 1.5, "`law.relay.k_t`: must be a number between 0 and 1, got 1.5"),
        ("law.relay.k_t", float("nan"), "`law.relay.k_t`: must be a number between 0 and 1, got NaN"),
        ("law.relay.k_t", np.float32("inf"), "`law.relay.k_t`: must be a number between 0 and 1, got inf"),
        ("law.relay.k_t", "0.3", '`law.relay.k_t`: found string "0.3", expected a number'),
        (
            "law.relay.k_t",
            None,
            "`law.relay`: missing key `k_t`",
        ),
        (
            "law.relay.k_t",
            {0.3},
            "`law.relay.k_t`: expected a number, a bool, a str, a list or a dict, found set",
        ),
        ("law.relay.k_t", 1j, "found complex"),
        ("law.relay.k_t", np.array([[0.3]]), "`law.relay.k_t`: found an array, expected a number"),
        ("law.relay.k_t", 2**64, "`law.relay.k_t`: found no whole number that fits 64 bits"),
        ("law.relay", {1: 0.3}, "`law.relay`: found a key of type int, expected a str"),
        ("law.relay", {"k_t": b"0.3"}, "`law.relay.k_t`: expected a number"),
        ("law.relay.kt", 0.3, "unknown key `kt`, expected one of `dead_zone`"),
        ("body.planar.modes[7].gain", 0.1, "there is no element 7: the array has 2"),
        ("law..k_t", 0.3, "not the path of a key"),
        ("seed", -1, "`seed`: found integer `-1`, expected a whole number"),
        ("name", "a/b", "`name` is used for file names"),
        ("name", "\ud800", "`name`: found a str that is not Unicode"),
        ("epoch", "2026-03-20", "expected a date and time without quotes"),
        ("adaptation.random_search.bounds", [0.32, 0.4], "must lie within the adaptation's bounds"),
    ],
)
def test_what_is_not_accepted_says_so(adaptive: Scenario, key: str, value: object, words: str) -> None:
    with pytest.raises(ScenarioError) as raised:
        adaptive.with_(key, value)
    assert words in str(raised.value)
    assert "relay-adaptive" in str(raised.value)


def test_errors_are_pointed_where_there_is_a_text(fixed: Scenario) -> None:
    with pytest.raises(ScenarioError) as raised:
        Scenario.parse(fixed.to_toml().replace("k_t = 0.31", "k_t = 3.1"), name="mine")
    lines = str(raised.value).splitlines()
    assert lines[0].startswith("mine:")
    assert "`law.relay.k_t`: must be a number between 0 and 1, got 3.1" in lines[0]
    assert lines[-1].strip(" |") == "^^^"


def test_errors_tell_every_mistake_with_its_key(fixed: Scenario) -> None:
    text = fixed.to_toml().replace("dead_zone", "deadzone").replace("k_t = 0.31", "k_t = 3.1")
    with pytest.raises(ScenarioError) as raised:
        Scenario.parse(text)
    by_key = {mistake["key"]: mistake for mistake in raised.value.mistakes}
    assert set(by_key) == {"law.relay.deadzone", "law.relay.k_t"}
    assert by_key["law.relay.deadzone"]["suggestion"] == "dead_zone"
    lines = text.splitlines()
    for mistake in by_key.values():
        name = mistake["key"].rpartition(".")[2]
        assert name in lines[mistake["line"] - 1]
        assert mistake["message"] in str(raised.value)
    for bad in ({"law": {"relay": {"k_t": None}}}, {"durations": 3.0}):
        with pytest.raises(ScenarioError) as raised:
            Scenario({"duration": 1.0, **bad})
        assert all(mistake["line"] is None for mistake in raised.value.mistakes)
        assert raised.value.mistakes[0]["key"] in ("law.relay.k_t", "durations")
    with pytest.raises(ScenarioError) as raised:
        fixed.with_("law.relay.k_t", 2.0)
    assert [mistake["key"] for mistake in raised.value.mistakes] == ["law.relay.k_t"]


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "missing key"),
        ({"duration": 1.0, "wings": 2}, "unknown key `wings`"),
        ({1: 2}, "found a key of type int, expected a str"),
        ({"\udfff": 2}, "found a str that is not Unicode"),
        ({"": 2, 'a"b': [1, {"c d": None}]}, '`"a"b"[1]."c d"`: expected a number'),
    ],
)
def test_dictionaries_that_are_no_scenario(values: Any, words: str) -> None:
    with pytest.raises(ScenarioError) as raised:
        Scenario(values, name="mine")
    assert words in str(raised.value)


def test_a_dictionary_within_itself_ends() -> None:
    values: dict[str, object] = {}
    values["body"] = values
    with pytest.raises(ScenarioError, match="nested too deep"):
        Scenario(values)


def test_wrong_types_are_type_errors(fixed: Scenario) -> None:
    wrong: Any = str(SCENARIOS / "relay-fixed.toml")
    with pytest.raises(TypeError, match=r"Scenario\.load reads a file"):
        Scenario(wrong)
    wrong = 3
    with pytest.raises(TypeError):
        Scenario.load(wrong)
    with pytest.raises(TypeError):
        fixed.with_({wrong: 2})


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"nowhere\.toml: No such file"):
        Scenario.load(tmp_path / "nowhere.toml")
    with pytest.raises(ScenarioError, match="not a file"):
        Scenario.load(tmp_path)
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(ScenarioError, match="line 1 is not UTF-8 text"):
        Scenario.load(tmp_path / "bytes.toml")


def test_schema_and_meanings(fixed: Scenario) -> None:
    assert set(fixed.to_dict()) <= set(flexsc.schema()["properties"])
    meanings = flexsc.metrics()
    assert meanings["cycle_period_s"]["unit"] == "s"
    assert set(fixed.simulate().metrics) <= set(meanings)


def test_rigid_cycles(fixed: Scenario) -> None:
    told = flexsc.papers.rigid_cycles(fixed)
    # Closed form at k_t = 0.31, 11 digits.
    assert told["cycles"][0]["sides"] == "two"
    assert told["cycles"][0]["period_s"] == pytest.approx(44.14235464, rel=1e-9)
    assert any(abs(r["k_t"] - 0.297777) < 1e-6 and r["harmonic"] == 3 for r in told["resonances"])


def test_examples_are_shipped_inside() -> None:
    assert set(flexsc.examples()) == set(ALL)
    assert Scenario.example("relay-fixed") == shipped("relay-fixed")
    assert flexsc.examples()["relay-fixed"] == shipped("relay-fixed").to_dict()["about"]
    with pytest.raises(KeyError):
        Scenario.example("relay-fixd")


def test_all_mistakes_come_at_once() -> None:
    text = shipped("relay-fixed").to_toml().replace("k_t =", "kt =").replace("duration =", "durations =")
    with pytest.raises(ScenarioError) as told:
        Scenario.parse(text)
    assert "did you mean `k_t`?" in str(told.value)
    assert "did you mean `duration`?" in str(told.value)


def test_an_example_that_does_not_exist_suggests_one() -> None:
    with pytest.raises(KeyError, match="did you mean 'relay-fixed'"):
        flexsc.Scenario.example("relay-fixd")


def test_a_path_that_is_nearly_a_key_is_suggested() -> None:
    with pytest.raises(ScenarioError, match=r"did you mean `law\.attitude\.bandwidth`"):
        shipped("earth-observer").with_("law.atitude.bandwidth", 0.2)


def test_a_scenario_is_saved_and_none_removes(tmp_path: Path) -> None:
    scenario = shipped("earth-observer")
    scenario.save(tmp_path / "study.toml")
    assert Scenario.load(tmp_path / "study.toml") == scenario
    with pytest.raises(FileExistsError, match="give force=True"):
        scenario.save(tmp_path / "study.toml")
    scenario.save(tmp_path / "study.toml", force=True)
    changed = scenario.with_({"sensor": {"sampled": {"period": 0.25}}, "estimator": None})
    assert "estimator" not in changed.to_dict()
    assert changed.get("sensor.sampled.period") == 0.25
    assert scenario.with_("target", None) == scenario.without("target")
    with pytest.raises(TypeError, match="with_ needs the value of 'duration'"):
        scenario.with_("duration")  # type: ignore[call-overload]


def test_own_disturbances_stay_when_keys_are_removed() -> None:
    class Nothing(flexsc.DisturbanceModel):
        period = 1.0

        def act(self, truth: flexsc.parts.Truth) -> list[float]:
            return [0.0, 0.0, 0.0]

    own = shipped("earth-observer").with_parts(disturbance=Nothing())
    assert list(own.without("target", "reference").own_parts) == ["disturbance 0"]
    with pytest.raises(ValueError, match="no file can hold parts written in Python: disturbance 0"):
        own.save("never.toml")
    # By its own name it goes, with those of the file; the parts of other roles stay.
    assert own.without("disturbance").own_parts == {}
    with pytest.raises(KeyError, match="disturbance"):
        own.without("disturbance").without("disturbance")
    path = str(shipped("earth-observer").to_dict()["name"]).encode()
    with pytest.raises(FileNotFoundError):
        Scenario.load(path)  # type: ignore[arg-type]
