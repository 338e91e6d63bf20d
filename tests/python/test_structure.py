"""Structures from elsewhere: state-space matrices, CSV files, Nastran."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from scipy.io import savemat
from scipy.sparse import csc_matrix

Numbers = npt.NDArray[np.float64]

W = np.array([0.6, 1.4, 1.4, 5.0, 40.0])
ZETA = np.array([0.005, 0.01, 0.01, 0.002, 0.3])
B2 = np.array([[0.1, 0, 2e-6], [0, 0.4, 0.03], [0.3, -0.2, 0.1], [1e-3, 2.0, 0], [0.5, 0.5, 0.5]])
C2 = np.array([[2e-3, 1e-4, 0.0, 3e-5, 1e-3], [0.0, 5e-5, 2e-4, 1e-4, -1e-3], [1e-6, 2e-3, 3e-4, 0.0, 1e-3]])
INERTIA = [[5e6, 0, 0], [0, 8e6, 0], [0, 0, 9e6]]


def second_order() -> tuple[Numbers, Numbers, Numbers]:
    """Modes as in the SLICOT collection: a state of displacements and rates, two modes of one frequency."""
    none = np.zeros((5, 5))
    a = np.block([[none, np.eye(5)], [-np.diag(W**2), -np.diag(2 * ZETA * W)]])
    return a, np.vstack([np.zeros((5, 3)), B2]), np.hstack([np.zeros((3, 5)), C2])


def mixed(change: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """The same in other coordinates of the state."""
    a, b, c = second_order()
    return change @ a @ np.linalg.inv(change), change @ b, c @ np.linalg.inv(change)


def test_modes_of_a_second_order_form_come_back() -> None:
    a, b, c = second_order()
    sparse: Any = csc_matrix(b)
    model = flexsc.from_state_space(a, sparse, c, np.zeros((3, 3)))
    np.testing.assert_allclose(model.frequencies, W, rtol=1e-12)
    np.testing.assert_allclose(model.dampings, ZETA, rtol=1e-9)
    assert model.deviation < 1e-10
    alone = [0, 3, 4]
    for mode in alone:
        sign = np.sign(model.inputs[mode] @ B2[mode])
        np.testing.assert_allclose(sign * model.inputs[mode], B2[mode], atol=1e-12)
        np.testing.assert_allclose(sign * model.rates[:, mode], C2[:, mode], atol=1e-13)
    # Of two modes with one frequency only what both do together is told.
    np.testing.assert_allclose(model.rates[:, 1:3] @ model.inputs[1:3], C2[:, 1:3] @ B2[1:3], atol=1e-13)
    np.testing.assert_allclose(model.displacements, 0.0, atol=1e-12)


def test_modes_in_other_coordinates_have_the_transfer_function() -> None:
    rng = np.random.default_rng(1)
    a, b, c = mixed(np.linalg.qr(rng.normal(size=(10, 10)))[0] @ np.diag(rng.uniform(0.5, 2.0, 10)))
    model = flexsc.from_state_space(a, b, c)
    frequencies = np.array([0.01, 0.6, 1.0, 1.4, 4.9, 39.0, 300.0])
    exact = np.array([c @ np.linalg.solve(1j * w * np.eye(10) - a, b) for w in frequencies])
    own = model.response(frequencies)
    assert (np.abs(own - exact).max(axis=(1, 2)) < 1e-8 * np.abs(exact).max(axis=(1, 2))).all()
    assert own.shape == (7, 3, 3)


def test_angles_are_displacements() -> None:
    a, b, c = second_order()
    model = flexsc.from_state_space(a, b, np.hstack([c[:, 5:], c[:, :5]]))
    np.testing.assert_allclose(np.abs(model.displacements[:, 0]), C2[:, 0], atol=1e-13)
    with pytest.raises(ValueError, match="measures: must be what the outputs are, and they are not rates"):
        model.structure(arm=1.0)
    gyro = model.structure(arm=1.0, measures="angle").shapes["gyro"]
    np.testing.assert_allclose(np.abs(gyro[0, 3:]), C2[:, 0], atol=1e-13)


def broken(index: int, value: Numbers) -> tuple[Numbers, ...]:
    matrices = list(second_order())
    matrices[index] = value
    return tuple(matrices)


def poles(*pairs: tuple[float, float]) -> Numbers:
    """Matrix of second-order systems with these stiffnesses and drags."""
    none = np.zeros((5, 5))
    stiffness, drag = np.array([*pairs, *zip(W[len(pairs) :] ** 2, [0.01] * 5, strict=False)]).T
    return np.block([[none, np.eye(5)], [-np.diag(stiffness), -np.diag(drag)]])


PUSHED = np.vstack([np.eye(5)[:, :3], B2])
COUPLED = poles() - np.block([[np.zeros((5, 10))], [np.zeros((5, 5)), 0.02 * np.ones((5, 5))]])
# The first of two alike drives the second.
CHAIN = np.block([[np.zeros((2, 2)), np.eye(2)], [np.array([[-1.0, 0.0], [1.0, -1.0]]), -0.02 * np.eye(2)]])
BAD: list[tuple[tuple[Any, ...], str]] = [
    (broken(0, poles((1.0, 3.0))), r"real poles \(-2.61803, -0.381966\): overdamped pairs"),
    (broken(0, poles((1.0, -0.1))), r"A: must be stable, and has the pole 0.05 \+0.998749i"),
    (broken(0, poles((0.0, 0.0), (0.0, 0.0))), "4 of its poles are 0: leave out the rigid body"),
    (broken(1, PUSHED), "B: must push a mode along its rate alone, and at 0.6 rad/s does not"),
    (broken(0, COUPLED), "B: must push a mode along its rate alone"),
    ((*second_order(), np.eye(3)), "D: must be 0, as no motion of modes feeds through, got 1"),
    ((CHAIN, np.eye(4)[:, [2]], np.eye(4)[[1]]), "A: must have motions that are modes of their own"),
    (broken(1, np.zeros((10, 3))), "B: must push a mode, and pushes none"),
    (
        broken(1, np.zeros((9, 3))),
        r"must have shapes \(n, n\), \(n, inputs\), \(outputs, n\), got \(10, 10\), \(9, 3\)",
    ),
    (broken(2, np.full((3, 10), np.nan)), "C: must be a matrix of finite numbers"),
]


@pytest.mark.parametrize(("matrices", "why"), BAD, ids=[why[:30] for _, why in BAD])
def test_what_is_no_modal_model_is_refused(matrices: tuple[Any, ...], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        flexsc.from_state_space(*matrices)


def test_what_nearly_are_modes_is_taken_where_that_is_asked_for() -> None:
    a, b, c = second_order()
    a[5:, 5:] -= 1e-4  # a drag that couples the modes a little
    with pytest.raises(ValueError, match="B: must push a mode along its rate alone"):
        flexsc.from_state_space(a, b, c)
    model = flexsc.from_state_space(a, b, c, tolerance=0.01)
    assert 1e-6 < model.deviation < 0.01
    with pytest.raises(ValueError, match="whose transfer function is off by a relative"):
        flexsc.from_state_space(*second_order(), tolerance=1e-17)


@pytest.mark.parametrize("kind", ["force", "torque"])
def test_a_scenario_has_the_influence_of_the_matrices(kind: Any) -> None:
    model = flexsc.from_state_space(*second_order())
    arm = {"roll": 2.0, "pitch": 4.0, "yaw": 5.0}
    scenario = model.scenario(INERTIA, thrust=10.0, arm=arm, kind=kind, unit=20.0, duration=60.0)
    # A jet is half a unit of an input that is a force, and arm/2 of one that is a torque.
    lever = np.array([2.0, 4.0, 5.0])
    pushes = B2 * (0.5 if kind == "force" else 0.5 * lever)
    acceleration = 10.0 * lever / np.diag(INERTIA)
    influence = scenario.modes["influence"]
    np.testing.assert_allclose(influence[[0, 3, 4]], (C2.T * pushes / acceleration)[[0, 3, 4]], atol=1e-9)
    run = scenario.with_("law.phase_plane.targets", [{"from": 1.0, "pitch": 0.05}]).simulate(log="full")
    assert run["vibrations"]["modes.displacement"].shape == (601, 5)
    assert run.metrics["elastic_energy_peak_j"] > 0.0


def test_inputs_and_outputs_may_be_in_any_order() -> None:
    a, b, c = second_order()
    model = flexsc.from_state_space(a, b, c)
    turned = flexsc.from_state_space(a, b[:, [2, 0, 1]], c[[1, 2, 0]])
    whole = model.structure(arm=1.0)
    same = turned.structure(arm=1.0, inputs=("yaw", "roll", "pitch"), outputs=("pitch", "yaw", "roll"))
    for point, shape in whole.shapes.items():
        np.testing.assert_allclose(np.abs(same.shapes[point][[0, 3]]), np.abs(shape[[0, 3]]), atol=1e-12)
    part = model.structure(arm=1.0, inputs=("roll", None, None), outputs=(None, None, "yaw"))
    assert not part.shapes["pitch"].any()
    assert not part.shapes["gyro"][:, 3:5].any()
    for names in (("roll",), ("roll", "roll", "yaw"), ("x", "y", "z")):
        with pytest.raises(ValueError, match="inputs: must "):
            model.structure(arm=1.0, inputs=names)
    with pytest.raises(ValueError, match="arm: must be given for pitch"):
        model.structure(arm={"roll": 1.0})


def test_a_scenario_is_written_with_its_modes_beside_it(tmp_path: Path) -> None:
    scenario = flexsc.from_state_space(*second_order()).scenario(
        INERTIA, thrust=10.0, arm=3.0, duration=30.0, name="station", body={"rate": [1e-3, 0.0, 0.0]}
    )
    table = flexsc.structure.write_scenario(scenario, tmp_path / "station.toml")
    assert table == tmp_path / "station-modes.csv"
    read = flexsc.Scenario.load(tmp_path / "station.toml")
    assert read.to_dict()["body"]["spatial"]["modes"] == str(table)
    run, again = scenario.simulate(log="full"), read.simulate(log="full")
    assert run.metrics == again.metrics
    np.testing.assert_array_equal(run["vibrations"]["modes.rate"], again["vibrations"]["modes.rate"])
    structure = flexsc.from_csv(table, {"roll": (0.0, 3.0, 0.0)})
    assert structure.body(INERTIA)["modes"] == [
        {key: mode[key] for key in ("frequency", "damping", "shapes")}
        for mode in scenario.to_dict()["body"]["spatial"]["modes"]
    ]
    uncertain = scenario.with_("uncertain", {"body.spatial.modes[0].frequency": {"relative_uniform": 0.1}})
    flexsc.structure.write_scenario(uncertain, tmp_path / "uncertain.toml")
    drawn = [flexsc.Scenario.load(tmp_path / "uncertain.toml").draw(run).modes["frequency"] for run in (0, 1)]
    assert drawn[0][0] != drawn[1][0]
    np.testing.assert_array_equal(drawn[0], uncertain.draw(0).modes["frequency"])
    with pytest.raises(ValueError, match="must have modes in itself"):
        flexsc.structure.write_scenario(read, tmp_path / "again.toml")


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_what_cannot_be_written_keeps_what_was_there(tmp_path: Path) -> None:
    import resource

    scenario = flexsc.from_state_space(*second_order()).scenario(INERTIA, thrust=10.0, arm=3.0, duration=30.0)
    for name in ("station.toml", "station-modes.csv"):
        (tmp_path / name).write_text("kept")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    # Python ignores the signal beside it, so that this is like a full disk.
    resource.setrlimit(resource.RLIMIT_FSIZE, (50, before[1]))
    try:
        with pytest.raises(OSError, match="File too large") as raised:
            flexsc.structure.write_scenario(scenario, tmp_path / "station.toml")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert Path(raised.value.filename).parent == tmp_path
    assert all(path.read_text() == "kept" for path in tmp_path.iterdir())
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("name", ["station.toml", "station-modes.csv"])
@pytest.mark.skipif(sys.platform == "win32", reason="links and pipes of POSIX")
def test_links_and_pipes_in_the_way_are_not_followed(tmp_path: Path, name: str) -> None:
    scenario = flexsc.from_state_space(*second_order()).scenario(INERTIA, thrust=10.0, arm=3.0, duration=30.0)
    (tmp_path / "victim").write_text("mine")
    in_the_way = tmp_path / f"{name}.partial"
    in_the_way.symlink_to("victim")
    with pytest.raises(OSError, match="in the way"):
        flexsc.structure.write_scenario(scenario, tmp_path / "station.toml")
    assert (tmp_path / "victim").read_text() == "mine"
    assert in_the_way.is_symlink()
    in_the_way.unlink()
    os.mkfifo(in_the_way)
    with pytest.raises(OSError, match="in the way"):
        flexsc.structure.write_scenario(scenario, tmp_path / "station.toml")


def test_a_table_of_modes_is_read(tmp_path: Path) -> None:
    file = tmp_path / "modes.csv"
    file.write_text("# a boom\nfrequency, tip.tz, root.ry, tip.tx\n1.5, 3e-3, 2e-5, -0.5\n\n4, 1, 2, 3\n")
    structure = flexsc.from_csv(file, {"tip": (10.0, 0.0, 0.0)})
    np.testing.assert_array_equal(structure.frequencies, [1.5, 4.0])
    np.testing.assert_array_equal(structure.dampings, [0.0, 0.0])
    np.testing.assert_array_equal(structure.shapes["tip"], [[-0.5, 0, 3e-3, 0, 0, 0], [3, 0, 1, 0, 0, 0]])
    np.testing.assert_array_equal(structure.shapes["root"][0], [0, 0, 0, 0, 2e-5, 0])
    assert structure.positions == {"tip": (10.0, 0.0, 0.0), "root": (0.0, 0.0, 0.0)}
    second = structure.keep([False, True])
    second.to_csv(tmp_path / "second.csv")
    assert (tmp_path / "second.csv").read_text() == "frequency,tip.tx,tip.tz,root.ry\n4.0,3.0,1.0,2.0\n"
    with pytest.raises(ValueError, match="inertia: must be given"):
        structure.body()
    for text, why in (
        ("", "must have a header"),
        ("frequency,zeta\n", "line 1: must name columns .* got `zeta`"),
        ("tip.tx\n", "line 1: must have a column `frequency`"),
        ("frequency,tip.tx\n1,2\n3\n", "line 3: must have 2 numbers, as the header, got 1"),
        ("frequency,tip.tx\n#\n1,x\n", "line 3: `tip.tx` must be a number, got `x`"),
    ):
        file.write_text(text)
        with pytest.raises(ValueError, match=why):
            flexsc.from_csv(file)
    file.write_text("frequency,tip.tx\n1,2\n")
    with pytest.raises(ValueError, match="positions: must be of points of the file"):
        flexsc.from_csv(file, {"tap": (0.0, 0.0, 0.0)})


def test_the_command_checks_a_file(tmp_path: Path) -> None:
    a, b, c = second_order()
    frequencies = np.geomspace(0.01, 100.0, 50)
    exact = np.array([c @ np.linalg.solve(1j * w * np.eye(10) - a, b) for w in frequencies])
    magnitudes = np.abs(exact).transpose(0, 2, 1).reshape(50, 9)

    def run(*arguments: str, exits: int = 0) -> str:
        command = [sys.executable, "-m", "flexsc.structure", "model.mat", *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == exits, done.stderr
        return done.stdout + done.stderr

    savemat(tmp_path / "model.mat", {"A": csc_matrix(a), "B": b, "C": c, "w": frequencies, "mag": magnitudes})
    told = run("--check", "-o", "model.toml", "--duration", "20")
    assert "5 modes of 0.6 to 40 rad/s" in told
    off = told.split("`mag` at 50 frequencies   off by ")[1].split()[0]
    assert float(off) < 1e-9
    assert "times faster than real time" in told
    assert flexsc.Scenario.load(tmp_path / "model.toml").duration == 20.0
    savemat(tmp_path / "model.mat", {"A": a, "B": b, "C": c, "w": frequencies, "mag": 1.1 * magnitudes})
    assert "off by 9.1e-02" in run("--check", "--duration", "20")
    savemat(tmp_path / "model.mat", {"A": a, "B": b})
    assert "must have 'C'" in run(exits=2)
    savemat(tmp_path / "model.mat", {"A": a, "B": b, "C": c, "D": np.eye(3)})
    assert "D: must be 0" in run(exits=2)
