"""The look of axes: that of the figures of the command."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
