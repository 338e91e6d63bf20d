"""Figures by the engine alone, and Matplotlib's in the sizes of a paper."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import flexsc
import pytest
from conftest import command_path, shipped


def test_the_engine_draws_what_the_command_draws(tmp_path: Path) -> None:
    run = shipped("relay-fixed").with_("duration", 600.0).simulate(log="full")
    run.save(tmp_path / "angle.svg", "angle")
    run.to_mcap(tmp_path / "run.mcap")
    command = [command_path(), "plot", "run.mcap", "--what", "angle", "-o", "of-command.svg"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert (tmp_path / "angle.svg").read_text() == (tmp_path / "of-command.svg").read_text()
    assert run.svg("angle") == (tmp_path / "angle.svg").read_text()
    assert flexsc.read_log(tmp_path / "run.mcap").svg("angle") == run.svg("angle")
    table = flexsc.campaign(shipped("relay-sampled").with_("duration", 600.0), 8)
    assert table.svg().startswith("<svg")


def test_files_have_the_format_of_their_ending_and_the_width_that_is_asked(tmp_path: Path) -> None:
    run = shipped("relay-fixed").with_("duration", 600.0).simulate()
    for ending, head in ((".svg", b"<svg"), (".png", b"\x89PNG"), (".pdf", b"%PDF")):
        path = tmp_path / f"angle{ending}"
        run.save(path, "angle", width=88.0)
        assert path.read_bytes().startswith(head)
    assert 'width="88.000mm"' in (tmp_path / "angle.svg").read_text()
    run.save(tmp_path / "angle.svg", "torque")  # another figure of its own
    other = tmp_path / "mine.svg"
    other.write_text("<svg>mine</svg>")
    with pytest.raises(FileExistsError, match="is no figure of flexsc"):
        run.save(other, "angle")
    assert other.read_text() == "<svg>mine</svg>"
    run.save(other, "angle", force=True)
    with pytest.raises(ValueError, match=r"must end in \.svg, \.png or \.pdf"):
        run.save(tmp_path / "angle.bmp", "angle")
    with pytest.raises(ValueError, match="the width must be 30 to 400 mm"):
        run.save(tmp_path / "wide.svg", "angle", width=1000.0)
    with pytest.raises(ValueError, match="there is no figure 'angel'"):
        run.svg("angel")


def test_the_bare_wheel_needs_no_matplotlib() -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "import flexsc\n"
        "run = flexsc.Scenario.example('relay-fixed').with_('duration', 50.0).simulate()\n"
        "assert run.svg('angle').startswith('<svg')\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_figure_fits_the_column_of_a_journal() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    from matplotlib import pyplot

    run = shipped("earth-observer").with_("duration", 60.0).simulate(log="full")
    with matplotlib.rc_context({"font.size": 6.0}):
        figure, axes = pyplot.subplots(2, 1, figsize=(3.4, 3.2), layout="constrained")
        flexsc.plot.draw(run, "pointing", axes[0])
        figure.canvas.draw()
        assert axes[0].xaxis.label.get_fontsize() == 6.0
        legend = axes[0].get_legend()
        width = axes[0].get_window_extent().width
        assert legend is None or legend.get_window_extent().width < 1.3 * width
        ticks = [text.get_window_extent() for text in axes[0].get_xticklabels() if text.get_text()]
        shown = [box for box in ticks if 0.0 < box.x0 < figure.bbox.width]
        assert all(one.x1 < other.x0 for one, other in pairwise(shown))
        pyplot.close(figure)
    figure = run.plot("pointing")
    assert figure.axes[0].xaxis.label.get_fontsize() == 9.0
    pyplot.close(figure)
