"""Linear controllers as laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from flexsc._linear import Linear

_AXES = ("roll", "pitch", "yaw")


def law_of(
    controller: object,
    period: float | None,
    method: Literal["held", "tustin"],
    command: Literal["torque", "acceleration"],
    limit: float | None,
    track: bool,
) -> dict[str, Any]:
    """Return the keys of a law `state_space`, for one controller or for one per axis."""
    if isinstance(controller, Mapping):
        if set(controller) != set(_AXES):
            found = ", ".join(map(str, controller))
            raise ValueError(f"controllers must be given for {', '.join(_AXES)}, got {found}")
        each = {axis: law_of(controller[axis], period, method, command, limit, track) for axis in _AXES}
        return {"per_axis": each}
    a, b, c, d, step = _matrices(controller)
    if method not in ("held", "tustin"):
        raise ValueError(f"method must be 'held' or 'tustin', got {method!r}")
    if step is None and period is None:
        raise ValueError("a controller of continuous time, or of no period of its own, needs a period")
    if step is not None and period is not None and period != step:
        raise ValueError(f"period must be that of the controller, {step} s, or left out, got {period}")
    if d.shape[0] != 1:
        why = "one for each axis is given as a dict of 'roll', 'pitch' and 'yaw'"
        raise ValueError(f"a controller has one output, the command about its axis, got {d.shape[0]}: {why}")
    keys: dict[str, Any] = {
        "period": period if step is None else step,
        "of": "samples" if step is not None or _unspecified(controller) else method,
        "command": command,
        "d": d,
    }
    if len(a):
        keys |= {"a": a, "b": b, "c": c}
    if limit is not None:
        keys["limit"] = limit
    if track:
        keys["track"] = True
    return {"state_space": keys}


def _unspecified(controller: object) -> bool:
    """Whether it is in discrete time without a period: `dt=True` of python-control."""
    return getattr(controller, "dt", None) is True


def _matrices(controller: object) -> tuple[Any, Any, Any, Any, float | None]:
    """Return the matrices of a controller and its period; None for continuous time."""
    import numpy as np

    step: object = None
    if isinstance(controller, Linear):
        parts: Sequence[object] = (controller.a, controller.b, controller.c, controller.d)
        step = controller.period
    elif all(hasattr(controller, name) for name in "ABCD"):
        parts = [getattr(controller, name) for name in "ABCD"]
        step = getattr(controller, "dt", None)
    elif isinstance(controller, Sequence) and len(controller) == 4:
        parts = controller
    else:
        kind = type(controller).__name__
        what = "a controller is (A, B, C, D), or has A, B, C and D as control.StateSpace does"
        raise TypeError(f"{what}, got {kind}")
    a, b, c, d = (np.array(part, dtype=np.float64, ndmin=2) for part in parts)
    order = 0 if a.size == 0 else len(a)
    inputs = d.shape[1]
    a, b, c = a.reshape(order, order), b.reshape(order, inputs), c.reshape(len(d), order)
    is_period = isinstance(step, (int, float)) and not isinstance(step, bool) and step > 0.0
    return a, b, c, d, float(step) if is_period and isinstance(step, (int, float)) else None
