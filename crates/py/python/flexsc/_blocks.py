"""Laws and estimators as discrete-time blocks of a linear loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc._sampling import held
from flexsc._signal import Signal

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Matrix = npt.NDArray[np.float64]

AXES = ("roll", "pitch", "yaw")


@dataclass
class Block:
    """x[k+1] = a x + b u, y = c x + d u, and the names of its states."""

    a: Matrix
    b: Matrix
    c: Matrix
    d: Matrix
    states: list[Signal]

    def then(self, after: Block) -> Block:
        """This block and one that takes what it gives."""
        import numpy as np

        none = np.zeros((len(self.a), len(after.a)))
        return Block(
            np.block([[self.a, none], [after.b @ self.c, after.a]]),
            np.vstack([self.b, after.b @ self.d]),
            np.hstack([after.d @ self.c, after.c]),
            after.d @ self.d,
            self.states + after.states,
        )

    @classmethod
    def beside(cls, blocks: Sequence[Block]) -> Block:
        """Blocks that know nothing of each other."""
        a, b, c, d = (_diagonal([getattr(block, name) for block in blocks]) for name in "abcd")
        return cls(a, b, c, d, [state for block in blocks for state in block.states])

    @classmethod
    def gain(cls, d: Matrix) -> Block:
        """A block without states."""
        import numpy as np

        return cls(np.zeros((0, 0)), np.zeros((0, d.shape[1])), np.zeros((len(d), 0)), d, [])


def kind_of(part: str | Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return the kind of a part and its keys: a part without keys is a word."""
    return (part, {}) if isinstance(part, str) else next(iter(part.items()))


def refused(name: str, why: str) -> ValueError:
    """The error of a loop that is not linear."""
    return ValueError(f"{name}: {why}")


@dataclass
class LinearLaw:
    """A law about one axis or about three, from angles and rates, axis by axis, to its commands."""

    period: float
    block: Block
    is_acceleration: bool
    inertia: Any
    """The inertia tensor in its model, if it has its own."""


def law_about(
    name: str, keys: Mapping[str, Any], filters: Sequence[Any], axis: int, prefix: str
) -> LinearLaw:
    """Return the law about an axis; `filters` are the coefficients of its filters."""
    import numpy as np

    law = keys["law"]
    if "per_axis" in law:
        law = law["per_axis"][AXES[axis]]
    kind, own = kind_of(law)
    if kind not in ("pd", "attitude", "state_space"):
        raise refused(name, f"the law `{kind}` is not linear: a loop has `pd`, `attitude` or `state_space`")
    if own.get("extra"):
        raise refused(name, "law.pd.extra is not supported in linear loops: leave it out")
    period = float(own["period"])
    if kind == "attitude":
        return LinearLaw(period, _attitude(own, period, filters, prefix), True, own.get("inertia"))
    if kind == "pd":
        k_p, k_d, way = float(own["k_p"]), float(own["k_d"]), own["differentiation"]
        if way == "exact":
            return LinearLaw(period, Block.gain(-np.array([[k_p, k_d]])), False, None)
        k_d = k_d / period if way == "difference" else k_d
        before = [Signal(f"{prefix}law_last_angle", "rad")]
        a, b = np.zeros((1, 1)), np.array([[1.0, 0.0]])
        block = Block(a, b, np.array([[k_d]]), -np.array([[k_p + k_d, 0.0]]), before)
        return LinearLaw(period, block, False, None)
    is_acceleration = own.get("command", "torque") == "acceleration"
    return LinearLaw(period, _state_space(own, period, prefix, 1, 2), is_acceleration, None)


def law_about_three_axes(name: str, keys: Mapping[str, Any]) -> LinearLaw | None:
    """Return the law about three axes together, if the scenario has one."""
    import numpy as np

    kind, own = kind_of(keys["law"])
    if kind != "state_space" or not own.get("inputs"):
        return None
    inputs, outputs = own["inputs"], own.get("outputs") or list(AXES)
    # What an angle or a rate is in the inputs.
    read = np.zeros((len(inputs), 6))
    for row, each in enumerate(inputs):
        if each.startswith("wheel"):
            why = f"the input `{each}` of the law is no state of the body: a linear loop has angles and rates"
            raise refused(name, why)
        if each.startswith("quaternion_"):
            # The vector part is half the angle.
            read[row, 2 * "xyz".index(each[-1])] = 0.5
        else:
            axis, _, of_rate = each.partition("_")
            read[row, 2 * AXES.index(axis) + bool(of_rate)] = 1.0
    period = float(own["period"])
    block = _state_space(own, period, "", len(outputs), len(inputs))
    written = np.zeros((3, len(outputs)))
    for column, axis in enumerate(outputs):
        written[AXES.index(axis), column] = 1.0
    block.b, block.d = block.b @ read, written @ block.d @ read
    block.c = written @ block.c
    return LinearLaw(period, block, own.get("command", "torque") == "acceleration", None)


def _attitude(own: Mapping[str, Any], period: float, filters: Sequence[Any], prefix: str) -> Block:
    """The law `attitude`: its integral, then its filters."""
    import numpy as np

    wn, damping = float(own["bandwidth"]), float(own["damping"])
    d = -np.array([[wn**2, 2.0 * damping * wn]])
    block = Block.gain(d)
    if own.get("integral"):
        c = np.array([[-(wn**2) / float(own["integral"]["time"])]])
        states = [Signal(f"{prefix}integral", "rad s")]
        block = Block(np.eye(1), np.array([[period, 0.0]]), c, d, states)
    for index, ((b0, b1, b2), (a1, a2)) in enumerate(filters):
        states = [Signal(f"{prefix}filter{index}_{k}", "rad/s²") for k in range(2)]
        a, b = np.array([[-a1, 1.0], [-a2, 0.0]]), np.array([[b1 - a1 * b0], [b2 - a2 * b0]])
        block = block.then(Block(a, b, np.array([[1.0, 0.0]]), np.array([[b0]]), states))
    return block


def _state_space(own: Mapping[str, Any], period: float, prefix: str, outputs: int, inputs: int) -> Block:
    """The law `state_space`, from its inputs; from angle and rate about one axis."""
    import numpy as np

    order = len(own.get("a", []))
    count = len((own.get("b") or own["d"])[0])
    b = np.array(own.get("b", []), dtype=np.float64).reshape(order, count)
    d = np.array(own.get("d") or [[0.0] * count] * outputs, dtype=np.float64)
    a = np.array(own.get("a", []), dtype=np.float64).reshape(order, order)
    c = np.array(own.get("c") or [[]] * outputs, dtype=np.float64).reshape(outputs, order)
    a, b, c, d = _at_samples(a, b, c, d, period, own.get("of", "samples"))
    c, d = float(own.get("gain", 1.0)) * c, float(own.get("gain", 1.0)) * d
    # e is what is wanted less what is believed; one input is the angle alone.
    wide = np.zeros((order, inputs)), np.zeros((outputs, inputs))
    wide[0][:, :count], wide[1][:, :count] = -b, -d
    return Block(a, wide[0], c, wide[1], [Signal(f"{prefix}law{k}", "") for k in range(order)])


def estimator(observers: Sequence[Mapping[str, Any]], prefixes: Sequence[str]) -> tuple[Block, Matrix]:
    """Return Kalman filters with their steady gains, from measured angles and rates to those that laws read,
    and what a torque about each axis, held over a period, adds to their states.

    The states are those that the filter expects before a sample.
    """
    import numpy as np

    blocks, pushes = [], []
    for filter_values, prefix in zip(observers, prefixes, strict=True):
        transition, push = np.array(filter_values["transition"]), np.array(filter_values["push"])
        order = len(push)
        seen = np.zeros((2, order))
        seen[0, 0::2] = seen[1, 1::2] = 1.0
        # After a sample the state is kept x + learnt y.
        kept, learnt = np.eye(order), np.zeros((order, 2))
        for row, gain in enumerate(np.array(filter_values["gains"])):
            learnt = learnt - np.outer(gain, seen[row] @ learnt)
            learnt[:, row] += gain
            kept = kept - np.outer(gain, seen[row] @ kept)
        read = seen if not filter_values["rigid"] else np.eye(2, order)
        names = ["rigid_angle", "rigid_rate"]
        names += [f"mode{k}_{what}" for k in range(order // 2 - 1) for what in ("displacement", "rate")]
        states = [
            Signal(f"{prefix}expected_{each}", "rad/s" if each.endswith("rate") else "rad") for each in names
        ]
        blocks.append(Block(transition @ kept, transition @ learnt, read @ kept, read @ learnt, states))
        pushes.append((push / float(filter_values["inertia"])).reshape(-1, 1))
    return Block.beside(blocks), _diagonal(pushes)


def _at_samples(
    a: npt.NDArray[np.float64],
    b: npt.NDArray[np.float64],
    c: npt.NDArray[np.float64],
    d: npt.NDArray[np.float64],
    h: float,
    of: str,
) -> tuple[npt.NDArray[np.float64], ...]:
    """Matrices as the law `state_space` samples them."""
    import numpy as np

    order = len(a)
    if of == "samples" or order == 0:
        return a, b, c, d
    if of == "held":
        return *held(a, b, h), c, d
    inverse = np.linalg.inv(np.eye(order) - 0.5 * h * a)
    c = c @ inverse
    return inverse @ (np.eye(order) + 0.5 * h * a), inverse @ b * h, c, d + c @ b * (0.5 * h)


def _diagonal(blocks: Sequence[npt.NDArray[np.float64]]) -> npt.NDArray[np.float64]:
    import numpy as np

    whole = np.zeros((sum(len(block) for block in blocks), sum(block.shape[1] for block in blocks)))
    row = column = 0
    for block in blocks:
        whole[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return whole
