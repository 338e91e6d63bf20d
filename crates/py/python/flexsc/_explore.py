"""Sliders of keys in a notebook, over the pictures of the engine."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from flexsc import _html
from flexsc import _native as engine
from flexsc._named import library
from flexsc._values import checked, number_to_vary

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

# A run that takes longer (s) follows a slider when it is let go.
_SOON_S = 0.2


class Explorer:
    """Sliders of keys, with a figure and the answer of the run at their values.

    A notebook shows it as the last line of a cell. `flexsc.explore` makes it.

    >>> found = flexsc.explore(flexsc.Scenario.example("relay-fixed"), ["law.relay.k_t"])   # doctest: +SKIP
    """

    scenario: Scenario
    """The scenario with the values of the sliders.

    >>> found.scenario.get("law.relay.k_t")                             # doctest: +SKIP
    0.31
    """
    sliders: dict[str, Any]
    """The widget of each key.

    >>> found.sliders["law.relay.k_t"].value = 0.34                     # doctest: +SKIP
    """
    shown: Any
    """The widget of the figure and the answer, whose `value` is HTML.

    >>> found.shown.value[:4]                                           # doctest: +SKIP
    '<svg'
    """

    def __init__(
        self,
        scenario: Scenario,
        keys: Sequence[str] | Mapping[str, Sequence[Any]],
        figure: str | None,
        run: int,
    ) -> None:
        widgets = library("ipywidgets", "flexsc.explore")
        self.scenario = self._start = scenario
        self._figure, self._run = figure, run
        given = keys if isinstance(keys, Mapping) else dict.fromkeys(keys)
        self.sliders = {key: _slider(widgets, key, scenario.get(key), span) for key, span in given.items()}
        self.shown = widgets.HTML()
        self._widget = widgets.VBox([*self.sliders.values(), self.shown])
        for slider in self.sliders.values():
            slider.observe(self._show, "value")
        self._show()

    def _show(self, _: object = None) -> None:
        began = time.perf_counter()
        try:
            self.scenario = self._start.with_({key: slider.value for key, slider in self.sliders.items()})
            answer = self.scenario.simulate(self._run, "none").answer
            native = self.scenario._native
            log = engine.log_of(native, self._run, "full", None)
            drawn = _html.of_log(log, native, self._figure)
            self.shown.value = drawn + answer._repr_html_()
        except (engine.ScenarioError, engine.SimulationError) as error:
            self.shown.value = f"<pre>{escape(str(error))}</pre>"
        follows = time.perf_counter() - began < _SOON_S
        for slider in self.sliders.values():
            slider.continuous_update = follows

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self._widget._repr_mimebundle_(**options)


def _slider(widgets: Any, key: str, value: Any, span: Sequence[Any] | None) -> Any:
    """Return the widget of a key: of a range, or of a list of values."""
    look: dict[str, Any] = {
        "description": key,
        "style": {"description_width": "initial"},
        "layout": widgets.Layout(width="560px"),
    }
    if isinstance(span, list) and span:
        return widgets.SelectionSlider(options=span, value=value if value in span else span[0], **look)
    number = number_to_vary(key, value)
    if span is None and number == 0.0:
        raise ValueError(f"{key} is 0, so its range must be given: keys={{{key!r}: (low, high)}}")
    ends: Sequence[Any] = sorted((0.5 * number, 2.0 * number)) if span is None else span
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(f"the range of {key} must be (low, high), got {span!r}")
    low, high = ends
    look |= {"value": min(max(value, low), high)}
    if isinstance(value, int):
        return widgets.IntSlider(min=int(low), max=int(high), **look)
    return widgets.FloatSlider(min=low, max=high, step=(high - low) / 200, readout_format=".4g", **look)


def explore(
    scenario: Scenario,
    keys: Sequence[str] | Mapping[str, Sequence[Any]],
    figure: str | None = None,
    *,
    run: int = 0,
) -> Explorer:
    """Return sliders of keys, with a figure and the answer of the run at their values, for a notebook.

    Each step of a slider simulates the scenario, and the engine draws the run; `pip install flexsc[explore]`
    installs the widgets. A run that takes more than 0.2 s follows when the slider is let go.

    Args:
        scenario: The scenario.
        keys: The keys of numbers, from half their value to twice it, or a mapping from each key to its range,
            a tuple `(low, high)`, or to a list of values, such as words.
        figure: The name of the figure, as in `Result.plot`; if omitted, the one that shows a run at a glance.
        run: Number of the run, which selects its noise.

    Returns:
        The sliders; their `scenario` has the chosen values.

    >>> scenario = flexsc.Scenario.example("earth-observer")
    >>> found = flexsc.explore(scenario, {"law.attitude.bandwidth": (0.1, 0.4)})        # doctest: +SKIP
    >>> found.scenario.save("chosen.toml")                                              # doctest: +SKIP

    Raises:
        KeyError: There is no such key.
        ValueError: A key is not a number, or its range is not accepted; or there is no such figure.
        ImportError: ipywidgets is not installed.
    """
    return Explorer(checked(scenario), keys, figure, run)


Explorer.__module__ = "flexsc"
