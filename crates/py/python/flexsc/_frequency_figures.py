"""Figures of linear models with Matplotlib: Bode and Nichols charts, and maps of poles."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING, Any

from flexsc._axes_look import FRAME, INCH, POINT, WIDTH, frame, need_matplotlib
from flexsc._frequency_response import around_zeros
from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._linear import Linear

    Values = npt.NDArray[np.float64]

# More lines than this are no figure.
_MOST = 24
# Closed-loop magnitudes (dB) of the contours of a Nichols chart.
_CONTOURS = (0.0, 3.0, 6.0, 12.0)


def bode(
    model: Linear, axes: tuple[Axes, Axes] | None = None, frequencies: npt.ArrayLike | None = None
) -> tuple[Axes, Axes]:
    """Draw the frequency response of a linear model: magnitude and phase.

    There is a line for each pair of an input and an output. An opened loop has one for each command from
    itself to itself; the other commands are open there. `Linear.select` chooses inputs and outputs.

    Args:
        model: The model, in continuous time or sampled.
        axes: The axes for magnitude and phase; if omitted, those of a new figure.
        frequencies: Frequencies (rad/s); if omitted, `Linear.frequency_grid()` and others about the zeros.

    Returns:
        The axes: frequency (rad/s) against magnitude (dB, 20 log10 of the ratio in SI units), and against
        phase (degrees).

    Raises:
        ValueError: There would be more than 24 lines, or the frequencies are not accepted.
        ImportError: Matplotlib is not installed.

    >>> import matplotlib; matplotlib.use("agg")
    >>> model = flexsc.Scenario.example("relay-fixed").linearise().select(outputs=["angle"])
    >>> magnitude, phase = flexsc.plot.bode(model)
    >>> magnitude.get_ylabel(), phase.get_xlabel()
    ('magnitude (dB)', 'frequency (rad/s)')
    """
    need_matplotlib()
    w, lines = _lines(model, frequencies)
    if axes is None:
        from matplotlib import pyplot

        figure, (above, below) = pyplot.subplots(
            2, 1, sharex=True, figsize=(WIDTH * INCH, 560 * INCH), layout="constrained"
        )
        figure.suptitle("Frequency response", fontsize=14 * POINT)
    else:
        above, below = axes
    for name, magnitude, phase in lines:
        above.plot(w, magnitude, linewidth=1.4 * POINT, label=name)
        below.plot(w, phase, linewidth=1.4 * POINT, label=name)
    for ax, label in ((above, "magnitude (dB)"), (below, "phase (degrees)")):
        frame(ax)
        ax.set_xscale("log")
        ax.set_xlim(w[0], w[-1])
        ax.set_ylabel(label, fontsize=12 * POINT)
        if model.period is not None:
            ax.axvline(pi / model.period, color=FRAME, linewidth=POINT, linestyle=(0, (5, 4)))
    _degrees(below, "y")
    below.set_xlabel("frequency (rad/s)", fontsize=12 * POINT)
    _legend(above)
    return above, below


def nichols(model: Linear, ax: Axes | None = None, frequencies: npt.ArrayLike | None = None) -> Axes:
    """Draw a Nichols chart of a linear model: magnitude over phase, as of an opened loop.

    The lines are those of `bode`. Dashed contours have the closed-loop magnitudes 0, 3, 6 and 12 dB, for
    loops of negative feedback; crosses are the critical points, 0 dB at -180 degrees and at whole turns from
    there.

    Args:
        model: The model, such as `Scenario.linearise(loop="command")` returns it.
        ax: The axes; if omitted, those of a new figure.
        frequencies: Frequencies (rad/s); if omitted, `Linear.frequency_grid()` and others about the zeros.

    Returns:
        The axes: phase (degrees) against magnitude (dB).

    Raises:
        ValueError: There would be more than 24 lines, or the frequencies are not accepted.
        ImportError: Matplotlib is not installed.

    >>> import matplotlib; matplotlib.use("agg")
    >>> opened = flexsc.Scenario.example("rotation-robust").linearise(loop="command")
    >>> flexsc.plot.nichols(opened).get_xlabel()
    'phase (degrees)'
    """
    need_matplotlib()
    _, lines = _lines(model, frequencies)
    ax = _axes("Nichols chart") if ax is None else ax
    for name, magnitude, phase in lines:
        ax.plot(phase, magnitude, linewidth=1.4 * POINT, label=name)
    phases = np.concatenate([phase[np.isfinite(phase)] for _, _, phase in lines] or [np.array([-180.0])])
    first, last = (int(np.floor((edge + 360.0) / 360.0)) for edge in (phases.min(), phases.max()))
    turns = [-180.0 + 360.0 * turn for turn in range(min(first, 0), max(last, 0) + 1)]
    for level in _CONTOURS:
        phase, magnitude = _contour(level)
        for at in turns:
            ax.plot(phase + at, magnitude, color=FRAME, linewidth=0.6 * POINT, linestyle=(0, (5, 4)))
    ax.plot(turns, np.zeros(len(turns)), linestyle="none", marker="+", color=FRAME, markersize=10 * POINT)
    frame(ax)
    _degrees(ax, "x")
    ax.set_xlabel("phase (degrees)", fontsize=12 * POINT)
    ax.set_ylabel("magnitude (dB)", fontsize=12 * POINT)
    _legend(ax)
    return ax


def poles(model: Linear, ax: Axes | None = None) -> Axes:
    """Draw the poles of a linear model in the complex plane, with the limit of stability.

    Args:
        model: The model, in continuous time or sampled.
        ax: The axes; if omitted, those of a new figure.

    Returns:
        The axes: real against imaginary part, of s (1/s), or of z with the unit circle for a sampled model.

    Raises:
        ImportError: Matplotlib is not installed.

    >>> import matplotlib; matplotlib.use("agg")
    >>> flexsc.plot.poles(flexsc.Scenario.example("relay-fixed").linearise()).get_ylabel()
    'imaginary part (1/s)'
    """
    need_matplotlib()
    found: Any = model.poles()["pole"]
    ax = _axes("Poles") if ax is None else ax
    frame(ax)
    limit: dict[str, Any] = {"color": FRAME, "linewidth": POINT, "zorder": 1}
    if model.period is None:
        ax.axvline(0.0, **limit)
    else:
        turn = np.linspace(0.0, 2.0 * np.pi, 361)
        ax.plot(np.cos(turn), np.sin(turn), **limit)
        ax.set_aspect("equal", adjustable="datalim")
    ax.plot(found.real, found.imag, linestyle="none", marker="x", markersize=8 * POINT)
    unit = " (1/s)" if model.period is None else ""
    ax.set_xlabel(f"real part{unit}", fontsize=12 * POINT)
    ax.set_ylabel(f"imaginary part{unit}", fontsize=12 * POINT)
    return ax


def _lines(
    model: Linear, frequencies: npt.ArrayLike | None
) -> tuple[Values, list[tuple[str, Values, Values]]]:
    """The frequencies, and the name, magnitude (dB) and phase (degrees) of each line."""
    pairs = list(_pairs(model))
    if len(pairs) > _MOST:
        raise ValueError(
            f"the model has {len(model.outputs)} outputs and {len(model.inputs)} inputs, {len(pairs)} lines; "
            f"a figure has at most {_MOST}: choose some with select(inputs=, outputs=)"
        )
    w = _with_zeros(model, pairs) if frequencies is None else np.asarray(frequencies, dtype=np.float64)
    values = model.response(w)
    lines = []
    for out, into in pairs:
        value = values[:, out, into]
        with np.errstate(divide="ignore"):
            magnitude = 20.0 * np.log10(np.abs(value))
        name = model.outputs[out].name
        if len(model.inputs) > 1 and name != model.inputs[into].name:
            name = f"{name} / {model.inputs[into].name}"
        lines.append((name, magnitude, _phase(value)))
    return w, lines


def _with_zeros(model: Linear, pairs: list[tuple[int, int]]) -> Values:
    """The grid of a model, and frequencies around the zeros of the lines."""
    grid = model.frequency_grid()
    more = [around_zeros(model, *pair) for pair in pairs]
    whole: Values = np.unique(np.concatenate([grid, *more]))
    inside: Values = whole[(whole >= grid[0]) & (whole <= grid[-1])]
    return inside


def _pairs(model: Linear) -> Iterator[tuple[int, int]]:
    """Outputs and inputs of the lines: of an opened loop each command and itself."""
    if len(model.inputs) > 1 and model.inputs == model.outputs:
        yield from ((k, k) for k in range(len(model.inputs)))
    else:
        yield from ((out, into) for into in range(len(model.inputs)) for out in range(len(model.outputs)))


def _phase(values: npt.NDArray[np.complex128]) -> Values:
    """The continuous phase (degrees), from between -360 and 0 on; none where there is no value."""
    phase = np.full(len(values), np.nan)
    there = np.isfinite(values)
    phase[there] = np.degrees(np.unwrap(np.angle(values[there])))
    if there.any():
        # 180 to rounding is -180, as of a body at low frequencies.
        phase -= 360.0 * np.ceil((phase[there][0] - 1.0) / 360.0)
    return phase


def _contour(level: float) -> tuple[Values, Values]:
    """Phase (degrees from the critical point) and magnitude (dB) of loops with a closed-loop magnitude."""
    turn = np.linspace(1e-3, 2.0 * np.pi - 1e-3, 721)
    closed = 10.0 ** (level / 20.0) * np.exp(1j * turn)
    opened = closed / (1.0 - closed)
    return np.degrees(np.angle(-opened)), 20.0 * np.log10(np.abs(opened))


def _axes(title: str) -> Axes:
    from matplotlib import pyplot

    _, ax = pyplot.subplots(figsize=(WIDTH * INCH, 480 * INCH), layout="constrained")
    ax.set_title(title, fontsize=14 * POINT, pad=24)
    return ax


def _degrees(ax: Axes, side: str) -> None:
    """Ticks at multiples of 45, 90 or 180 degrees and so on."""
    from matplotlib.ticker import MaxNLocator

    axis = ax.xaxis if side == "x" else ax.yaxis
    axis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 1.5, 3, 4.5, 9, 10]))


def _legend(ax: Axes) -> None:
    if len(ax.get_legend_handles_labels()[0]) > 1:
        ax.legend(frameon=False, fontsize=10 * POINT)
