"""Every figure of `flexsc plot`, drawn with Matplotlib on your own axes (`pip install flexsc[plot]`).

`bode`, `nichols` and `poles` draw linear models; the other functions draw runs, logs and campaigns.

    >>> import matplotlib; matplotlib.use("agg")
    >>> import flexsc, flexsc.plot
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
    >>> flexsc.plot.figures(run)
    ['phase-plane', 'torque', 'angle', 'envelope', 'modes']
    >>> axes = flexsc.plot.draw(run, "angle")
    >>> axes.get_ylabel()
    'angle x (arcsec)'
    >>> figure = flexsc.plot.figure(run, "envelope")
    >>> len(figure.axes)
    2

The engine defines the contents, colours, names and units of a figure, so it looks the same as that of the
command. Axes hold values in SI units, so you can add your own data directly; only the tick labels are in the
unit of the label.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, overload

from flexsc import _html
from flexsc import _native as engine
from flexsc._axes_look import INCH, POINT, WIDTH, Look, frame, need_matplotlib, show_once
from flexsc._frequency_figures import bode, nichols, poles
from flexsc._log import Log
from flexsc._missing import reading
from flexsc._numpy import np
from flexsc._result import Result
from flexsc._table import Table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

__all__ = ["Source", "bode", "draw", "figure", "figures", "nichols", "poles"]

Single: TypeAlias = "Result | Log | Table | str | os.PathLike[str]"
"""A run, a log, a campaign or a sweep, or the path of a log file or of a campaign's directory."""
Source: TypeAlias = "Single | Sequence[Single] | Mapping[str, Single]"
"""A single source, or several runs or logs, which are drawn over each other; a dict gives them names."""

if TYPE_CHECKING:
    _On = TypeVar("_On", Figure, SubFigure)

# Matplotlib's markers, and how wide each is in pixels.
_MARKS = {
    "disc": ("o", 6.4),
    "dot": ("o", 3.2),
    "ring": ("o", 7.6),
    "triangle": ("^", 7.2),
    "square": ("s", 5.8),
    "diamond": ("D", 6.2),
    "cross": ("x", 6.4),
    "stroke": ("|", 6.0),
}


def figures(source: Source, metrics: Sequence[str] = ()) -> list[str]:
    """Return the names of the available figures, as in `flexsc plot`.

    Args:
        source: The source of the figure.
        metrics: For a campaign, the metrics to use; if omitted, the main ones that vary.

    Returns:
        For a run or a log, names such as `angle`; for a campaign, names such as `distribution-gain_final`.
        The names of a directory begin with that of the scenario; with logs it also has a `fan`.

    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
    >>> flexsc.plot.figures(run)[:2]
    ['phase-plane', 'torque']

    Raises:
        ValueError: There is nothing to draw, or no such metric.
        LogError: The log file cannot be read.
    """
    first, *others = _each(source).values()
    if others:
        each = [figures(single) for single in others]
        return [name for name in figures(first) if all(name in names for names in each)]
    log = _log(first)
    if log is not None:
        return engine.log_figures(log, _known(first))
    return list(_of_campaign(first, None, metrics))


def draw(source: Source, name: str, ax: Axes | None = None, panel: int = 0) -> Axes:
    """Draw one panel of a figure on axes.

    Args:
        source: The source of the figure.
        name: One of `figures(source)`; for a campaign also that of another metric, such as `scatter-duty`.
        ax: The axes; if omitted, those of a new figure.
        panel: The index of the panel in the figure, from the top; `figure` draws all of them.

    Returns:
        The axes, in SI units: `axes.plot(time_s, angle_rad)` adds to them.

    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
    >>> axes = flexsc.plot.draw(run, "angle")
    >>> axes.get_xlabel()
    'time (s)'

    Raises:
        ValueError: There is no such figure or panel.
        ImportError: Matplotlib is not installed.
    """
    need_matplotlib()
    found = drawn(source, name)
    panels = found.panels()
    if not 0 <= panel < len(panels):
        raise ValueError(f"figure {name!r} has panels 0 to {len(panels) - 1}, got {panel}")
    look = Look(ax)
    if ax is None:
        from matplotlib import pyplot

        height = (found.panel_height + 100) * INCH
        _, ax = pyplot.subplots(figsize=(WIDTH * INCH, height), layout="constrained")
        ax.set_title(found.title, fontsize=14 * POINT, pad=24)
    # Panels above the last leave the name of the time to it.
    name_below = panels[-1]["x"]["label"]
    _panel(ax, panels[panel], panels[panel]["x"]["label"] or name_below, found.panel_height, look)
    return ax


@overload
def figure(source: Source, name: str | None = None, on: None = None) -> Figure: ...
@overload
def figure(source: Source, name: str | None, on: _On) -> _On: ...
@overload
def figure(source: Source, name: str | None, on: Figure | SubFigure | None) -> Figure | SubFigure: ...
def figure(
    source: Source, name: str | None = None, on: Figure | SubFigure | None = None
) -> Figure | SubFigure:
    """Draw a figure with all of its panels.

    Args:
        source: The source of the figure; several runs have a colour each, and two their difference below.
        name: One of `figures(source)`; if omitted, the one that shows the source at a glance.
        on: An empty figure or subfigure; if omitted, a new one of the same size as that of the command.

    Returns:
        The figure; its `axes` are the panels, from the top.

    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
    >>> figure = flexsc.plot.figure(run, "angle")
    >>> len(figure.axes)
    1
    >>> longer = run.scenario.with_("law.relay.k_t", 0.34).simulate()
    >>> both = flexsc.plot.figure({"k_t 0.31": run, "k_t 0.34": longer}, "angle")
    >>> len(both.axes)                                 # the difference is below
    2

    Raises:
        ValueError: There is no such figure.
        ImportError: Matplotlib is not installed.
    """
    need_matplotlib()
    found = drawn(source, at_a_glance(source, name))
    panels = found.panels()
    is_own = on is None
    if on is None:
        from matplotlib import pyplot

        height = 30 + sum(_height(panel, found.panel_height) for panel in panels)
        on = pyplot.figure(figsize=(WIDTH * INCH, height * INCH), layout="constrained")
        show_once(on)
    on.suptitle(found.title, fontsize=14 * POINT if is_own else None)
    axes = on.subplots(len(panels), 1, squeeze=False)[:, 0]
    for ax, panel in zip(axes, panels, strict=True):
        _panel(ax, panel, panel["x"]["label"], found.panel_height, Look(None if is_own else ax))
    return on


def at_a_glance(source: Source, name: str | None) -> str:
    """Return the name of a figure; None stands for the figure that shows the source at a glance."""
    if name is not None:
        return name
    there = figures(source)
    if not there:
        raise ValueError("there is no figure of it")
    return next((name for name in _html.AT_A_GLANCE if name in there), there[0])


def _height(panel: dict[str, Any], plot: int) -> int:
    """The height of a panel with its strips, legend, numbers and name (pixels)."""
    below = 18 if panel["x"]["label"] else 0
    return plot + 22 + 24 + below + (30 if panel["bar"] else 0) + 14 * len(panel["strips"])


def _each(source: Source) -> dict[str, Single]:
    """The single sources by their names."""
    if isinstance(source, (Result, Log, Table, str, os.PathLike)):
        return {"": source}
    if not source:
        raise ValueError("a figure needs a run, a log or a campaign")
    if isinstance(source, Mapping):
        named: Any = source
        return dict(named)
    names = [_name(single) for single in source]
    numbered = [f"{name} {place}" for place, name in enumerate(names, 1)]
    return dict(zip(names if len(set(names)) == len(names) else numbered, source, strict=True))


def _name(single: Single) -> str:
    if isinstance(single, Log):
        return single.scenario.name if single.scenario else "log"
    return single.scenario.name if isinstance(single, (Result, Table)) else Path(single).stem


def _log(source: Single) -> engine.Log | None:
    """The log of a run, if the source is one."""
    if isinstance(source, Result):
        return source._native_log()
    if isinstance(source, Log):
        return source._native
    if isinstance(source, Table) or Path(source).is_dir():
        return None
    return reading(source, engine.Log.open)


def _known(source: Single) -> engine.Scenario | None:
    """The scenario of a run, with its parts in Python, which repeat it if a figure needs that."""
    return source.scenario._native if isinstance(source, Result) else None


def _of_campaign(source: Single, kind: str | None, metrics: Sequence[str]) -> dict[str, engine.Figure]:
    """The figures of a campaign, by names without that of the scenario if there is one only."""
    if isinstance(source, Table):
        drawn = source._figures(kind, metrics)
        before = f"{source.scenario.name}-"
        return {name.removeprefix(before): figure for name, figure in drawn}
    assert not isinstance(source, (Result, Log))
    drawn = engine.directory_figures(source, kind, list(metrics))
    return dict(drawn)


def drawn(source: Source, name: str) -> engine.Figure:
    """Return the figure of this name as the engine draws it."""
    each = _each(source)
    if len(each) > 1:
        several = [(own, drawn(single, name)) for own, single in each.items()]
        return engine.overlaid_figure(name.replace("-", " "), several)
    (single,) = each.values()
    log = _log(single)
    if log is not None:
        return engine.log_figure(log, name, _known(single))
    there = _of_campaign(single, None, ())
    if name not in there and isinstance(single, Table):
        kind, _, metric = name.partition("-")
        there = _of_campaign(single, kind, [metric] if metric else [])
    if name not in there:
        raise ValueError(f"there is no figure {name!r} for it; it has {', '.join(there)}")
    return there[name]


def _panel(ax: Axes, panel: dict[str, Any], below: str, plot: int, look: Look) -> None:
    """Draw a panel, in the command's look or with the sizes of a figure that is given."""
    _axis(ax, "x", ax.xaxis, panel["x"], look.ticks(8))
    _axis(ax, "y", ax.yaxis, panel["y"], look.ticks(max(2, plot // 28), is_upright=True))
    ax.set_xlabel(below, fontsize=look.size(12))
    ax.set_ylabel(panel["y"]["label"], fontsize=look.size(12))
    frame(ax, look.size(11))
    if panel["plain"]:
        ax.grid(visible=False)
    handles = [(_layer(ax, layer, order), layer["name"]) for order, layer in enumerate(panel["layers"], 2)]
    named = [(handle, name) for handle, name in handles if name and handle is not None]
    if named:
        ax.legend(
            *zip(*named, strict=True),
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=look.columns([name for _, name in named]),
            frameon=False,
            borderaxespad=0.1,
            fontsize=look.size(11),
            handlelength=1.6,
            columnspacing=1.4,
        )
    if panel["bar"]:
        _bar(ax, *panel["bar"])
    _words(ax, panel)
    _strips(ax, panel["strips"], panel["x"], bool(named or panel["remark"]))


def _words(ax: Axes, panel: dict[str, Any]) -> None:
    """Draw the notes of a panel, and the remark above its right end."""
    for text, x, y, colour in panel["notes"]:
        is_edge = math.isinf(x)
        ax.annotate(
            text,
            (panel["x"]["high"] if is_edge else x, y),
            xytext=(0.0, 4.0 * POINT),
            textcoords="offset points",
            ha="right" if is_edge else "center",
            va="bottom",
            color=colour,
            fontsize=10.5 * POINT,
        )
    if panel["remark"]:
        above = (0.0, 4.0 * POINT)
        ax.annotate(
            panel["remark"],
            (1.0, 1.0),
            xycoords="axes fraction",
            xytext=above,
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=11 * POINT,
        )


def _strips(ax: Axes, strips: list[Any], x: dict[str, Any], has_legend: bool) -> None:
    """Draw the strips of a panel above its legend."""
    from matplotlib.collections import LineCollection
    from matplotlib.transforms import offset_copy

    low, high = x["low"], x["high"]
    figure: Any = ax.figure
    for row, (name, spans) in enumerate(reversed(strips)):
        up = ((28 if has_legend else 10) + 14 * row) * POINT
        place = offset_copy(ax.get_xaxis_transform(), fig=figure, y=up, units="points")
        shown = [span for span in spans if span[0] < high and span[1] > low]
        bars = LineCollection(
            [[(max(start, low), 1.0), (min(end, high), 1.0)] for start, end, _, _ in shown],
            colors=[colour for _, _, _, colour in shown],
            linewidths=11 * POINT,
            capstyle="butt",
            transform=place,
            clip_on=False,
        )
        ax.add_collection(bars, autolim=False)
        style: dict[str, Any] = {"va": "center", "fontsize": 10 * POINT, "transform": place}
        ax.text(low, 1.0, f"{name}  ", ha="right", **style)
        for start, end, words, _ in shown:
            room = WIDTH * (min(end, high) - max(start, low)) / (high - low)
            if words and 6 * len(words) < room:
                ax.text((max(start, low) + min(end, high)) / 2, 1.0, words, ha="center", **style)


def _axis(ax: Axes, side: str, axis: Any, description: dict[str, Any], most: int) -> None:
    from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, NullFormatter

    if description["logarithmic"]:
        getattr(ax, f"set_{side}scale")("log")
        places, texts = zip(*description["ticks"], strict=True)
        axis.set_major_locator(FixedLocator(places))
        axis.set_major_formatter(FixedFormatter(texts))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(_in_units_of(description["factor"], most))
        axis.set_major_formatter(FuncFormatter(partial(_number, axis, description["factor"])))
    getattr(ax, f"set_{side}lim")(description["low"], description["high"])


def _in_units_of(factor: float, most: int) -> Any:
    """A locator of at most so many ticks at 1, 2 or 5 times a power of ten of a unit."""
    from matplotlib.ticker import MaxNLocator

    class Locator(MaxNLocator):
        def tick_values(self, vmin: float, vmax: float) -> Any:
            return np.asarray(super().tick_values(vmin / factor, vmax / factor)) * factor

    return Locator(nbins=most, steps=[1, 2, 5, 10])


def _number(axis: Any, factor: float, value: float, _: int | None = None) -> str:
    """The number at a tick, in the unit of the label, with the decimals that the step between ticks needs."""
    places = axis.get_majorticklocs()
    step = abs(places[1] - places[0]) / factor if len(places) > 1 else 1.0
    decimals = max(0, math.ceil(-1e-9 - math.log10(step)))
    scaled = value / factor
    if abs(scaled) < 1e-9 * step:
        return "0"
    text = f"{scaled:.{decimals}f}" if decimals <= 6 and abs(scaled) < 1e7 else f"{scaled:.1e}"
    if abs(scaled) >= 1e4 and "e" not in text:
        text = f"{scaled:,.{decimals}f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
    return text.replace("-", "\N{MINUS SIGN}")


def _layer(ax: Axes, layer: dict[str, Any], order: int) -> Any:
    """Draw a layer; what stands for it in the legend."""
    x, y = layer["points"]
    if not len(x):
        return None
    shape, colour, size = layer["shape"], layer["colour"], layer["size"]
    if shape == "line":
        return ax.plot(x, y, color=colour, linewidth=size * POINT, zorder=order)[0]
    if shape == "dashes":
        return ax.plot(x, y, color=colour, linewidth=POINT, linestyle=(0, (5, 4)), zorder=order)[0]
    if shape == "area":
        return _area(ax, layer, order)
    marker, across = _MARKS[shape]
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    if not ((left <= x) & (x <= right) & (low <= y) & (y <= high)).any():
        return None
    style: dict[str, Any] = {"markersize": across * POINT, "markeredgewidth": 0.0, "color": colour}
    if shape in ("cross", "stroke"):
        style |= {"markeredgewidth": (1.2 if shape == "cross" else 0.5) * POINT}
    if shape == "ring":
        style |= {"markerfacecolor": "none", "markeredgecolor": colour, "markeredgewidth": 1.2 * POINT}
    return ax.plot(x, y, linestyle="none", marker=marker, zorder=order, **style)[0]


def _area(ax: Axes, layer: dict[str, Any], order: int) -> Any:
    """Draw the polygons between gaps, which other axes cut off at their limits."""
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch

    points = layer["points"].T
    gaps = np.flatnonzero(~np.isfinite(points).all(axis=1))
    parts = [part[np.isfinite(part).all(axis=1)] for part in np.split(points, gaps)]
    look: dict[str, Any] = {"facecolor": layer["colour"], "alpha": layer["size"], "linewidth": 0.0}
    ax.add_collection(PolyCollection([p for p in parts if len(p) > 2], zorder=order, **look), autolim=False)
    return Patch(**look)


def _bar(ax: Axes, name: str, colours: list[str], edges: list[str]) -> None:
    """Draw what the colours of a map stand for, above it."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap

    classes = len(colours)
    shades = ScalarMappable(BoundaryNorm(range(classes + 1), classes), ListedColormap(colours))
    bar = ax.figure.colorbar(shades, ax=ax, location="top", shrink=0.6, aspect=40, pad=0.12)
    bar.set_ticks(list(range(1, classes)), labels=edges)
    bar.ax.tick_params(labelsize=10 * POINT, length=0)
    bar.outline.set_visible(False)
    bar.set_label(name, fontsize=11 * POINT)
