"""Figures of margins, noise, budgets, bounds, worst cases and tunings with Matplotlib."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, cast

from flexsc._axes_look import FRAME, INCH, POINT, WIDTH, frame, need_matplotlib
from flexsc._numpy import np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from flexsc.results import (
        IndexBudget,
        NoiseSpectrum,
        OutputBound,
        StabilityMargins,
        TunedScenario,
        WorstCase,
    )

_GREY, _BLUE, _RED = "0.55", "tab:blue", "tab:red"


class MarginsFigure:
    """What margins have besides their numbers."""

    @property
    def settling(self) -> dict[str, float]:
        """Time (s) in which all angles settle within 5 % after a step of the target about each axis.

        >>> list(margins.settling), max(margins.settling.values()) < 100.0
        (['roll', 'pitch', 'yaw'], True)
        """
        longest: dict[str, float] = {}
        for each in cast("StabilityMargins", self).settling_times:
            longest[each.step] = max(each.time, longest.get(each.step, 0.0))
        return longest

    def __repr__(self) -> str:
        """Return the least margins of all loops together and of each."""
        margins = cast("StabilityMargins", self)
        each = ", ".join(
            f"{name}: gain {loop.gain_below:.3g} to {loop.gain_above:.3g}, phase {loop.phase:.3g} rad"
            for name, loop in margins.loops.items()
        )
        return f"StabilityMargins(modulus={margins.modulus:.4g}, disk={margins.disk:.4g}; {each})"

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest singular values of sensitivity and complementary sensitivity over frequency.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: frequency (rad/s) against the largest singular value (dB). A point marks the largest
            one of S, the inverse of the modulus margin.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> margins.plot().get_xlabel()
        'frequency (rad/s)'
        """
        margins = cast("StabilityMargins", self)
        ax = _axes(ax, "Largest singular values")
        for values, name, colour in (
            (margins.sensitivity, "sensitivity S", _BLUE),
            (margins.complementary, "complementary T", _GREY),
        ):
            ax.plot(
                margins.frequency, 20.0 * np.log10(values), color=colour, linewidth=1.4 * POINT, label=name
            )
        peak = int(np.argmax(margins.sensitivity))
        value = 20.0 * np.log10(margins.sensitivity[peak])
        ax.plot([margins.frequency[peak]], [value], color=_RED, marker="o", markersize=4 * POINT)
        ax.axvline(pi / margins.period, color=FRAME, linewidth=POINT, linestyle=(0, (5, 4)))
        ax.set_xscale("log")
        return _labelled(ax, "frequency (rad/s)", "largest singular value (dB)")


class NoiseFigure:
    """Figure of the noise of a loop."""

    def plot(self, output: str | None = None, axes: tuple[Axes, Axes] | None = None) -> tuple[Axes, Axes]:
        """Draw the density of an output by source, and its cumulative rms.

        Args:
            output: Name of the output; if omitted, the first.
            axes: The axes for density and rms; if omitted, those of a new figure.

        Returns:
            The axes: frequency (Hz) against density (unit² per Hz), and against the rms up to it.

        Raises:
            KeyError: There is no output of this name.
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> density, rms = flexsc.Scenario.example("attitude-hold").spectrum().plot("yaw")
        >>> density.get_ylabel(), rms.get_xlabel()
        ('density ((rad)²/Hz)', 'frequency (Hz)')
        """
        spectrum = cast("NoiseSpectrum", self)
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
                    above.plot(spectrum.frequency_hz, density, linewidth=POINT, label=source)
        label = "all" if len(spectrum.sources) > 1 else "".join(spectrum.sources)
        above.plot(spectrum.frequency_hz, noise.density, color="black", linewidth=1.4 * POINT, label=label)
        below.plot(spectrum.frequency_hz, noise.cumulative_rms, color="black", linewidth=1.4 * POINT)
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


class BudgetFigure:
    """Figure of a pointing budget."""

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the levels of the index by campaign, convolution and rule, with the limit.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: probability against the level, in the unit of the index.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> index.plot().get_xlabel()
        'probability'
        """
        budget = cast("IndexBudget", self)
        ax = _axes(ax, f"{budget.name}: {budget.description}")
        levels = sorted(budget.levels)
        places = range(len(levels))
        ways = {"campaign": "-", "convolution": "--", "rule": ":"}
        colours = {"temporal": _RED, "ensemble": _GREY, "mixed": _BLUE}
        for word, colour in colours.items():
            for way, dashes in ways.items():
                values = [getattr(budget.levels[level][word], way) for level in levels]
                if np.isnan(values).any():
                    continue
                ax.plot(
                    places,
                    values,
                    dashes,
                    color=colour,
                    marker="o",
                    markersize=3 * POINT,
                    label=f"{word}, {way}",
                )
        ax.axhline(budget.limit, color="black", linewidth=1.4 * POINT, label="limit")
        ax.set_xticks(list(places), [f"{100.0 * level:g} %" for level in levels])
        ax.set_ylim(bottom=0.0)
        return _labelled(ax, "probability", f"level ({budget.unit})")


class BoundFigure:
    """Figure of a guaranteed range."""

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the guaranteed range over time, with the limits and the points at which it is attained.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: time (s) against the output, in its unit.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> bound.plot().get_ylabel()
        'roll, elastic (rad)'
        """
        bound = cast("OutputBound", self)
        ax = _axes(ax, f"Guaranteed range of {bound.output}")
        ax.fill_between(
            bound.rows["time"], bound.rows["low"], bound.rows["high"], color=_BLUE, alpha=0.3, label="range"
        )
        for limit in bound.limits or ():
            ax.axhline(limit, color=_RED, linewidth=1.4 * POINT)
        ax.plot(
            bound.attained_at,
            bound.attained,
            linestyle="none",
            color="black",
            marker="o",
            markersize=3 * POINT,
        )
        elastic = ", elastic" if bound.elastic else ""
        return _labelled(ax, "time (s)", f"{bound.output}{elastic} ({bound.unit})")


class WorstFigure:
    """Figure and text of a worst case."""

    def __repr__(self) -> str:
        """Return the quantity with its values."""
        case = cast("WorstCase", self)
        return f"WorstCase(quantity={case.quantity!r}, value={case.value:.4g}, nominal={case.nominal:.4g})"

    def plot(self, axes: Sequence[Axes] | None = None) -> tuple[Axes, ...]:
        """Draw the value at each point over each uncertain key, with the worst point in red.

        Args:
            axes: The axes, one for each key; if omitted, those of a new figure.

        Returns:
            The axes: the key against the quantity, in its unit.

        Raises:
            ValueError: The number of axes is not that of the keys.
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> [ax.get_xlabel()[-13:] for ax in worst.plot()]
        ['[0].frequency', '[1].frequency']
        """
        case = cast("WorstCase", self)
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
        return tuple(axes)


class TuningFigure:
    """Figure of a tuning."""

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the modulus margin of each plant before and after tuning.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: the plants, sorted by their margin before, against the margin.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> tuned.plot().get_ylabel()
        'modulus margin'
        """
        tuned = cast("TunedScenario", self)
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
