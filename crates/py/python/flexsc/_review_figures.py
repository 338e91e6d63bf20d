"""Figures of margins, noise, budgets, bounds, worst cases and tunings with Matplotlib."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from flexsc._axes_look import FRAME, INCH, POINT, WIDTH, frame, need_matplotlib
from flexsc._numpy import np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from flexsc._budget import IndexBudget
    from flexsc._loop_margins import StabilityMargins
    from flexsc._noise import NoiseSpectrum
    from flexsc._output_bounds import OutputBound
    from flexsc._structured_tuning import TunedScenario
    from flexsc._worst_case import WorstCase

_GREY, _BLUE, _RED = "0.55", "tab:blue", "tab:red"


def singular_values(margins: StabilityMargins, ax: Axes | None) -> Axes:
    """Draw the largest singular values of S and T over frequency."""
    ax = _axes(ax, "Largest singular values")
    for values, name, colour in (
        (margins.sensitivity, "sensitivity S", _BLUE),
        (margins.complementary, "complementary T", _GREY),
    ):
        ax.plot(margins.frequency, 20.0 * np.log10(values), color=colour, linewidth=1.4 * POINT, label=name)
    peak = int(np.argmax(margins.sensitivity))
    value = 20.0 * np.log10(margins.sensitivity[peak])
    ax.plot([margins.frequency[peak]], [value], color=_RED, marker="o", markersize=4 * POINT)
    ax.axvline(pi / margins.period, color=FRAME, linewidth=POINT, linestyle=(0, (5, 4)))
    ax.set_xscale("log")
    return _labelled(ax, "frequency (rad/s)", "largest singular value (dB)")


def noise_density(
    spectrum: NoiseSpectrum, output: str | None, axes: tuple[Axes, Axes] | None
) -> tuple[Axes, Axes]:
    """Draw the density of an output by source, and its cumulative rms."""
    need_matplotlib()
    name = next(iter(spectrum.outputs)) if output is None else output
    noise = spectrum.outputs[name]
    if axes is None:
        from matplotlib import pyplot

        size = (WIDTH * INCH, 560 * INCH)
        figure, (above, below) = pyplot.subplots(2, 1, sharex=True, figsize=size, layout="constrained")
        figure.suptitle(f"Noise of {name}", fontsize=14 * POINT)
    else:
        above, below = axes
    if len(spectrum.sources) > 1:
        for source, density in noise.density_by_source.items():
            if density.any():
                above.plot(spectrum.frequency, density, linewidth=POINT, label=source)
    label = "all" if len(spectrum.sources) > 1 else "".join(spectrum.sources)
    above.plot(spectrum.frequency, noise.density, color="black", linewidth=1.4 * POINT, label=label)
    below.plot(spectrum.frequency, noise.cumulative_rms, color="black", linewidth=1.4 * POINT)
    for ax, title in ((above, f"density (({noise.unit})²/Hz)"), (below, f"rms up to it ({noise.unit})")):
        frame(ax)
        ax.set_xscale("log")
        ax.set_ylabel(title, fontsize=12 * POINT)
    top = float(noise.density.max(initial=0.0))
    if top > 0.0:
        above.set_yscale("log")
        above.set_ylim(max(float(noise.density[noise.density > 0.0].min()), 1e-8 * top), 2.0 * top)
    below.set_xlabel("frequency (Hz)", fontsize=12 * POINT)
    above.legend(frameon=False, fontsize=10 * POINT)
    return above, below


def index_budget(budget: IndexBudget, ax: Axes | None) -> Axes:
    """Draw the levels of an index, by campaign, convolution and rule, with the limit."""
    ax = _axes(ax, f"{budget.name}: {budget.description}")
    levels = sorted(budget.levels)
    places = range(len(levels))
    ways = {"campaign": "-", "convolution": "--", "rule": ":"}
    colours = {"temporal": _RED, "ensemble": _GREY, "mixed": _BLUE}
    for word, colour in colours.items():
        for way, dashes in ways.items():
            values = [getattr(budget.levels[level][word], way) for level in levels]
            if None in values:
                continue
            ax.plot(
                places, values, dashes, color=colour, marker="o", markersize=3 * POINT, label=f"{word}, {way}"
            )
    ax.axhline(budget.limit, color="black", linewidth=1.4 * POINT, label="limit")
    ax.set_xticks(list(places), [f"{100.0 * level:g} %" for level in levels])
    ax.set_ylim(bottom=0.0)
    return _labelled(ax, "probability", f"level ({budget.unit})")


def output_range(bound: OutputBound, ax: Axes | None) -> Axes:
    """Draw the guaranteed range of an output over time, with its limits."""
    ax = _axes(ax, f"Guaranteed range of {bound.output}")
    ax.fill_between(
        bound.rows["time"], bound.rows["low"], bound.rows["high"], color=_BLUE, alpha=0.3, label="range"
    )
    for limit in bound.limits or ():
        ax.axhline(limit, color=_RED, linewidth=1.4 * POINT)
    ax.plot(
        bound.attained_at, bound.attained, linestyle="none", color="black", marker="o", markersize=3 * POINT
    )
    elastic = ", elastic" if bound.elastic else ""
    return _labelled(ax, "time (s)", f"{bound.output}{elastic} ({bound.unit})")


def worst_points(case: WorstCase, axes: Sequence[Axes] | None) -> list[Axes]:
    """Draw the values of a search over each uncertain key, with the worst point."""
    need_matplotlib()
    count = len(case.keys)
    if axes is None:
        from matplotlib import pyplot

        figure, given = pyplot.subplots(
            1, count, sharey=True, squeeze=False, figsize=(WIDTH * INCH, 320 * INCH), layout="constrained"
        )
        figure.suptitle(f"Worst case of {case.quantity}", fontsize=14 * POINT)
        axes = list(given[0])
    if len(axes) != count:
        raise ValueError(f"axes: must be {count}, one for each uncertain key, got {len(axes)}")
    unit = f" ({case.unit})" if case.unit else ""
    for place, (ax, key) in enumerate(zip(axes, case.keys, strict=True)):
        ax.plot(
            case.points[:, place],
            case.values,
            linestyle="none",
            color=_GREY,
            marker="o",
            markersize=3 * POINT,
        )
        ax.plot([case.keys[key]], [case.value], color=_RED, marker="o", markersize=5 * POINT)
        frame(ax)
        ax.set_xlabel(key, fontsize=10 * POINT)
    axes[0].set_ylabel(f"{case.quantity}{unit}", fontsize=12 * POINT)
    return list(axes)


def tuned_margins(tuned: TunedScenario, ax: Axes | None) -> Axes:
    """Draw the margins of all plants before and after, sorted by those before."""
    ax = _axes(ax, "Modulus margin of each plant")
    order = sorted(range(len(tuned.plants)), key=lambda plant: tuned.plants[plant].margin_before)
    for name, colour, values in (
        ("before", _GREY, [tuned.plants[plant].margin_before for plant in order]),
        ("tuned", _BLUE, [tuned.plants[plant].margin for plant in order]),
    ):
        ax.plot(values, color=colour, marker="o", markersize=3 * POINT, linewidth=POINT, label=name)
    ax.set_ylim(bottom=0.0)
    return _labelled(ax, "plants, by their margin before", "modulus margin")


def _axes(ax: Axes | None, title: str) -> Axes:
    need_matplotlib()
    if ax is not None:
        return ax
    from matplotlib import pyplot

    figure, new = pyplot.subplots(figsize=(WIDTH * INCH, 340 * INCH), layout="constrained")
    figure.suptitle(title, fontsize=14 * POINT)
    return new


def _labelled(ax: Axes, x: str, y: str) -> Axes:
    frame(ax)
    ax.set_xlabel(x, fontsize=12 * POINT)
    ax.set_ylabel(y, fontsize=12 * POINT)
    ax.legend(frameon=False, fontsize=10 * POINT)
    return ax
