"""The look of axes: that of the figures of the command."""

from __future__ import annotations

from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Pixels of the command's figures in inches, and in points.
INCH = 1.0 / 96.0
POINT = 0.75
WIDTH = 800
GRID = "#e1e1e1"
FRAME = "#787878"


def need_matplotlib() -> None:
    """Raise an ImportError with the command that installs Matplotlib, if it is missing."""
    try:
        import_module("matplotlib")
    except ImportError as error:
        raise ImportError("flexsc.plot needs Matplotlib: pip install 'flexsc[plot]'") from error


def frame(ax: Axes) -> None:
    """Set grid, ticks and frame of axes."""
    ax.tick_params(labelsize=11 * POINT, length=0, pad=4)
    ax.grid(color=GRID, linewidth=0.6 * POINT)
    ax.set_axisbelow(True)
    for spine in ax.spines.values():
        spine.set(color=FRAME, linewidth=0.8 * POINT)


def show_once(figure: Figure) -> None:
    """Let a notebook that shows the figures of a cell at its end show this one once, also as its value."""
    from matplotlib import get_backend

    if "inline" in get_backend():
        shown: Any = figure
        # Notebooks call it in place of their own display of a value.
        shown._ipython_display_ = partial(_display, figure)


def _display(figure: Any) -> None:
    """Display a figure of pyplot, which then is one like any other."""
    display = import_module("IPython.display").display
    pyplot: Any = import_module("matplotlib.pyplot")
    del figure._ipython_display_
    pyplot.close(figure)
    display(figure)
