"""Linear controllers as laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal

from flexsc._linear import Linear
from flexsc._numpy import np, npt
from flexsc._values import AXES

if TYPE_CHECKING:
    Matrix = npt.NDArray[np.float64]


_ERRORS = (*AXES, *(f"{axis}_rate" for axis in AXES))
# The words of a file for methods of discretisation.
_METHODS = {"zoh": "held", "held": "held", "tustin": "tustin"}
# What a name of an output may begin with, beside the axis alone.
_QUANTITIES = ("torque", "acceleration", "command")


@dataclass(frozen=True)
class Settings:
    """How a controller is sampled, and its command."""

    period: float | None
    method: Literal["zoh", "tustin", "held"]
    command: Literal["torque", "acceleration"]
    limit: float | None
    track: bool


@dataclass
class _Controller:
    """Matrices, the period (s) of a sampled controller, and the names that its signals have."""

    a: Matrix
    b: Matrix
    c: Matrix
    d: Matrix
    step: float | None
    unspecified: bool
    """Whether it is in discrete time without a period: `dt=True` of python-control."""
    inputs: list[str] | None = None
    outputs: list[str] | None = None


def law_of(
    controller: object, settings: Settings, inputs: Sequence[str] | None, outputs: Sequence[str] | None
) -> dict[str, Any]:
    """Return the keys of a law `state_space`, for one controller or for one per axis."""
    if isinstance(controller, Mapping):
        if inputs is not None or outputs is not None:
            raise ValueError("inputs and outputs are those of one controller about three axes together")
        if set(controller) != set(AXES):
            names = ", ".join(map(str, controller))
            raise ValueError(f"controllers must be given for {', '.join(AXES)}, got {names}")
        return {"per_axis": {axis: law_of(controller[axis], settings, None, None) for axis in AXES}}
    found = _controller(controller)
    if settings.method not in _METHODS:
        raise ValueError(f"method must be 'zoh' or 'tustin', got {settings.method!r}")
    keys: dict[str, Any] = {
        "period": _period(found, settings.period),
        "of": "samples" if found.step is not None or found.unspecified else _METHODS[settings.method],
        "command": settings.command,
        "d": found.d,
    }
    if len(found.a):
        keys |= {"a": found.a, "b": found.b, "c": found.c}
    if settings.limit is not None:
        keys["limit"] = settings.limit
    if settings.track:
        keys["track"] = True
    if found.d.shape[0] != 1 or inputs is not None or outputs is not None:
        keys["outputs"] = _outputs(found, outputs, settings.command)
        keys["inputs"] = _inputs(found, inputs)
    return {"state_space": keys}


def _period(controller: _Controller, period: float | None) -> float:
    """The period of its samples (s)."""
    step = controller.step
    if step is not None and period is not None and period != step:
        raise ValueError(f"period must be that of the controller, {step} s, or left out, got {period}")
    if step is not None:
        return step
    if period is None:
        raise ValueError("a controller of continuous time, or of no period of its own, needs a period")
    return period


def _inputs(controller: _Controller, given: Sequence[str] | None) -> list[str]:
    """The names of the inputs of a controller about three axes, checked by the scenario."""
    count = controller.d.shape[1]
    names = list(given) if given is not None else controller.inputs
    if names is None:
        if count not in (3, 6):
            why = "3, the errors of roll, pitch and yaw, or 6 with their rates, or as many as `inputs` names"
            raise ValueError(
                f"a controller about three axes must have inputs for {why}, got {count}: states that are not "
                "measured need an observer, as in `Linear.compensator`"
            )
        return list(_ERRORS[:count])
    if len(names) != count:
        raise ValueError(f"inputs must name {count} inputs of the controller, got {len(names)}: {names}")
    return names


def _outputs(controller: _Controller, given: Sequence[str] | None, command: str) -> list[str]:
    """The axes of the outputs of a controller about three axes."""
    count = controller.d.shape[0]
    names = list(given) if given is not None else controller.outputs
    if names is None:
        if count != 3:
            raise ValueError(
                f"a controller must have one output, about its axis, or three about {', '.join(AXES)}, "
                f"or as many as `outputs` names, got {count}"
            )
        return list(AXES)
    if len(names) != count:
        raise ValueError(f"outputs must name {count} outputs of the controller, got {len(names)}: {names}")
    axes = []
    for name in names:
        quantity, _, axis = name.rpartition("_")
        if axis not in AXES or quantity not in ("", *_QUANTITIES):
            accepted = ", ".join((*AXES, *(f"{command}_{each}" for each in AXES)))
            raise ValueError(f"outputs must be among {accepted}, got {name!r}")
        if quantity in ("torque", "acceleration") and quantity != command:
            raise ValueError(f"the output {name!r} needs command={quantity!r}, got {command!r}")
        axes.append(axis)
    return axes


def _controller(controller: object) -> _Controller:
    """Return a controller by its matrices."""
    if hasattr(controller, "num") and hasattr(controller, "den"):
        # A transfer function, which its own library realises.
        realise = getattr(controller, "to_ss", None) or partial(import_module("control").ss, controller)
        controller = realise()
    if isinstance(controller, Linear):
        names = [[signal.name for signal in signals] for signals in (controller.inputs, controller.outputs)]
        parts = controller.a, controller.b, controller.c, controller.d
        return _Controller(*_shaped(parts), controller.period, False, *names)
    if _has_matrices(controller):
        dt = getattr(controller, "dt", None)
        is_period = isinstance(dt, (int, float)) and not isinstance(dt, bool) and dt > 0.0
        labels = [_labels(controller, kind) for kind in ("input_labels", "output_labels")]
        step = float(dt) if is_period and isinstance(dt, (int, float)) else None
        return _Controller(
            *_shaped([getattr(controller, name) for name in "ABCD"]), step, dt is True, *labels
        )
    if isinstance(controller, Sequence) and len(controller) and _has_matrices(controller[0]):
        # What a synthesis returns begins with the controller, as (K, CL, gamma, rcond) of control.hinfsyn.
        return _controller(controller[0])
    if isinstance(controller, Sequence) and len(controller) == 4:
        return _Controller(*_shaped(controller), None, False)
    gain: Any = controller
    if isinstance(controller, Sequence) and len(controller) == 3 and np.ndim(controller[0]) == 2:
        # (K, S, E) of control.lqr.
        gain = controller[0]
    try:
        gain = np.array(gain, dtype=np.float64)
    except (TypeError, ValueError):
        gain = None
    if gain is None or gain.ndim != 2:
        kind = type(controller).__name__
        what = "a controller is (A, B, C, D), has A, B, C and D as control.StateSpace does, or is a gain K"
        raise TypeError(f"{what}, got {kind}")
    return _Controller(*_shaped((np.zeros((0, 0)), np.zeros((0, gain.shape[1])), [], gain)), None, False)


def _has_matrices(controller: object) -> bool:
    return all(hasattr(controller, name) for name in "ABCD")


def _labels(controller: object, kind: str) -> list[str] | None:
    """The names of signals, if they were given: those of python-control begin with u[0] and y[0]."""
    labels = getattr(controller, kind, None)
    if labels is None or any("[" in str(label) for label in labels):
        return None
    return [str(label) for label in labels]


def _shaped(parts: Sequence[object]) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return matrices of fitting shapes, also of a controller without states."""
    a, b, c, d = (np.array(part, dtype=np.float64, ndmin=2) for part in parts)
    order = 0 if a.size == 0 else len(a)
    rows, inputs = d.shape
    expected = {"A": (a, (order, order)), "B": (b, (order, inputs)), "C": (c, (rows, order))}
    for name, (matrix, shape) in expected.items():
        if matrix.size != shape[0] * shape[1] or (order and matrix.shape != shape):
            raise ValueError(f"{name} must have the shape {shape}, of D {d.shape}, got {matrix.shape}")
    return a.reshape(order, order), b.reshape(order, inputs), c.reshape(rows, order), d
