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


class Look:
    """Sizes of a panel: those of the command, or of `rcParams` and of axes that are given."""

    def __init__(self, ax: Axes | None = None) -> None:
        self.width = self.height = None
        if ax is not None:
            figure: Any = ax.figure
            box = ax.get_window_extent()
            self.width, self.height = box.width / figure.dpi, box.height / figure.dpi

    def size(self, pixels: float) -> float | None:
        """Return the size of letters (pt); None for that of `rcParams`."""
        return pixels * POINT if self.width is None else None

    def ticks(self, most: int, is_upright: bool = False) -> int:
        """Return how many ticks fit along an axis."""
        length = self.height if is_upright else self.width
        return most if length is None else max(2, min(most, int(length / (0.3 if is_upright else 0.65))))

    def columns(self, names: list[str]) -> int:
        """Return how many names of a legend fit beside each other."""
        longest = max(map(len, names), default=1)
        most = len(names)
        return most if self.width is None else max(1, min(most, int(self.width / (0.35 + 0.08 * longest))))


def frame(ax: Axes, size: float | None = 11 * POINT) -> None:
    """Set grid, ticks and frame of axes, with numbers of a size (pt), or of that of `rcParams`."""
    ax.tick_params(length=0, pad=4)
    if size is not None:
        ax.tick_params(labelsize=size)
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
