"""Figures of runs, logs and campaigns: by Matplotlib, and by the engine without it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar, overload

if TYPE_CHECKING:
    import os

    from matplotlib.figure import Figure, SubFigure

    On_ = TypeVar("On_", Figure, SubFigure)


class Drawable:
    """A run, a log or a table of a campaign, which has figures by name."""

    @overload
    def plot(self, name: str | None = None, on: None = None) -> Figure: ...
    @overload
    def plot(self, name: str | None, on: On_) -> On_: ...
    @overload
    def plot(self, name: str | None = None, *, on: On_) -> On_: ...
    def plot(self, name: str | None = None, on: Any = None) -> Any:
        """Draw a figure with Matplotlib (`pip install flexsc[plot]`).

        Args:
            name: One of `flexsc.plot.figures` of this object, such as `angle` of a run and
                `distribution-duty` of a campaign; if omitted, the one that shows it at a glance.
            on: An empty figure or subfigure, whose size and fonts are kept; if omitted, a new one.

        Returns:
            The figure, in SI units; its `axes` are the panels, from the top.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
        >>> figure = run.plot("angle")                                  # doctest: +SKIP

        Raises:
            ValueError: There is no such figure.
            ImportError: Matplotlib is not installed.
        """
        from flexsc import plot

        source: Any = self
        return plot.figure(source, name, on)

    def svg(self, name: str | None = None) -> str:
        """Return a figure as SVG, drawn by the engine as `flexsc plot` does, without Matplotlib.

        >>> import flexsc
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
        >>> run.svg("angle")[:4]
        '<svg'

        Raises:
            ValueError: There is no such figure.
        """
        from flexsc import plot

        source: Any = self
        return plot.drawn(source, plot.at_a_glance(source, name)).svg()

    def save(
        self,
        path: str | os.PathLike[str],
        name: str | None = None,
        *,
        width: float | None = None,
        font: float | None = None,
        force: bool = False,
    ) -> None:
        """Save a figure, drawn by the engine, as `.svg`, `.png` or `.pdf`.

        Args:
            path: The file. Another figure of flexsc is replaced.
            name: The name of the figure, as in `plot`.
            width: The width of the figure (mm), such as 88 for the column of a journal.
            font: The size of the letters of the names of the axes (pt).
            force: Replace a file that is no figure of flexsc.

        >>> import flexsc, pathlib, tempfile
        >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 3000.0).simulate()
        >>> with tempfile.TemporaryDirectory() as out:
        ...     run.save(pathlib.Path(out) / "angle.pdf", "angle", width=88.0)
        ...     (pathlib.Path(out) / "angle.pdf").read_bytes()[:4]
        b'%PDF'

        Raises:
            ValueError: There is no such figure, a size is not accepted, or the ending is another.
            FileExistsError: The file is no figure of flexsc, and `force` is not given.
            OSError: The file cannot be written.
        """
        from flexsc import plot

        source: Any = self
        plot.drawn(source, plot.at_a_glance(source, name)).save(path, width, font, force)
