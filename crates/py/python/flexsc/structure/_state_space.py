"""Modes from state-space matrices, x' = A x + B u, y = C x, such as those of the SLICOT collection."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from flexsc._numpy import np, npt
from flexsc.structure._modal_model import StateSpace

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]
    Complex = npt.NDArray[np.complex128]

# Poles nearer to each other than this, relatively, are those of modes with one frequency.
_ALIKE = 1e-8
# An input that pushes a mode by less than this part of what it pushes the others by is rounding.
_ROUNDING = 1e-12
# At how many frequencies the transfer function is computed from the matrices themselves.
SOLVED = 24
# Where motions drive each other, rounding gives eigenvectors a condition number of its inverse root.
_FULL = 1e7


def from_state_space(
    A: npt.ArrayLike,
    B: npt.ArrayLike,
    C: npt.ArrayLike,
    D: npt.ArrayLike | None = None,
    *,
    tolerance: float = 1e-6,
) -> StateSpace:
    """The modes of a structure that is given as x' = A x + B u, y = C x.

    A mode is scaled so that its rate q' is a unit vector of the state: from a state of mass-normalised
    displacements and rates they come back. Modes that no input pushes are left out.

    Args:
        A: System matrix, dense or sparse, in any coordinates.
        B: Input matrix.
        C: Output matrix.
        D: Feedthrough, which must be 0.
        tolerance: Relative deviation of the transfer function up to which modes stand for the matrices.

    Raises:
        ValueError: The matrices are not those of damped modes that inputs push; the text says why.

    >>> import flexsc
    >>> model = flexsc.from_state_space([[0, 1], [-4, -0.02]], [[0], [1]], [[0, 1]])
    >>> [round(float(frequency), 6) for frequency in model.frequencies]
    [2.0]
    """
    a, b, c = (_matrix(name, matrix) for name, matrix in (("A", A), ("B", B), ("C", C)))
    order = len(a)
    if a.shape != (order, order) or len(b) != order or c.shape[1] != order:
        raise ValueError(
            f"A, B, C: must have shapes (n, n), (n, inputs), (outputs, n), got {a.shape}, {b.shape}, "
            f"{c.shape}"
        )
    if D is not None and (through := np.abs(_matrix("D", D)).max(initial=0.0)) > 0.0:
        raise ValueError(f"D: must be 0, as no motion of modes feeds through, got {through:g}")
    motions = _decomposed(a)
    found = sorted(_modes(a, b, motions, tolerance), key=lambda mode: mode[0])
    if not found:
        raise ValueError("B: must push a mode, and pushes none")
    w, zeta, influences, displacements, rates = (np.array(column) for column in zip(*found, strict=True))
    model = StateSpace(w, zeta, influences, c @ displacements.T, c @ rates.T, 0.0)
    deviation, where = max(_deviation(model, a, b, c), _modal_deviation(model, motions, b, c))
    if deviation > tolerance:
        raise ValueError(
            f"A, B, C: must be those of modes, whose transfer function is off by a relative {deviation:.1e} "
            f"at {where:g} rad/s"
        )
    return StateSpace(w, zeta, influences, model.displacements, model.rates, deviation)


def _matrix(name: str, matrix: Any) -> Numbers:
    dense = matrix.toarray() if hasattr(matrix, "toarray") else matrix
    found = np.atleast_2d(np.asarray(dense, dtype=np.float64))
    if found.ndim != 2 or not np.isfinite(found).all():
        raise ValueError(f"{name}: must be a matrix of finite numbers")
    return found


class _Motions(NamedTuple):
    """Poles of oscillations, right eigenvectors as columns, left ones as rows, and the condition number."""

    poles: Complex
    right: Complex
    left: Complex
    condition: float


def _decomposed(a: Numbers) -> _Motions:
    poles, right = np.linalg.eig(a)
    _oscillating(poles)
    condition = float(np.linalg.cond(right))
    if not condition < _FULL:
        raise ValueError(
            f"A: must have motions that are modes of their own, and their condition number is "
            f"{condition:.1e}: some drive each other, or the state has scales too far apart"
        )
    left = np.asarray(np.linalg.inv(right), dtype=np.complex128)
    return _Motions(poles, right, left, condition)


def _modes(
    a: Numbers, b: Numbers, motions: _Motions, tolerance: float
) -> list[tuple[float, float, Numbers, Numbers, Numbers]]:
    """Frequency, damping ratio, influence of the inputs, states of a unit displacement and of a unit rate."""
    poles, right, left, condition = motions
    upper = _oscillating(poles)
    largest = np.linalg.norm(b, axis=0).max(initial=0.0)
    modes = []
    for group in _alike(poles, upper):
        count, frequency = len(group), float(np.abs(poles[group]).mean())
        decay = float(-2.0 * np.real(poles[group]).mean())
        # Where the inputs push in the space of these poles: along as many rates as there are modes.
        push = 2.0 * np.real(right[:, group] @ (left[group] @ b))
        directions, sizes, amounts = np.linalg.svd(push, full_matrices=False)
        beside = sizes[count] if len(sizes) > count else 0.0
        if beside > max(tolerance * sizes[0], _ROUNDING * condition * largest):
            raise ValueError(
                f"B: must push a mode along its rate alone, and at {frequency:g} rad/s does not, by a "
                f"relative {beside / sizes[0]:.1e}: this is no q'' + 2 zeta w q' + w² q = b u"
            )
        for rate, size, amount in zip(directions.T, sizes[:count], amounts, strict=False):
            if size > _ROUNDING * largest:
                sign = np.sign(amount[np.argmax(np.abs(amount))])
                displacement = a @ rate + decay * rate
                modes.append(
                    (
                        frequency,
                        decay / (2.0 * frequency),
                        sign * size * amount,
                        sign * displacement,
                        sign * rate,
                    )
                )
    return modes


def _oscillating(poles: Complex) -> npt.NDArray[np.intp]:
    """The poles of positive imaginary part, if all poles are of damped oscillations."""
    size = np.abs(poles)
    rounding = 1e-12 * size.max(initial=0.0)
    if (at_rest := size <= rounding).any():
        raise ValueError(
            f"A: must have elastic modes alone, and {at_rest.sum()} of its poles are 0: leave out the rigid "
            "body, whose motion follows from the inertia tensor"
        )
    if (poles.real > rounding).any():
        worst = poles[np.argmax(poles.real)]
        raise ValueError(f"A: must be stable, and has the pole {worst.real:g} {worst.imag:+g}i")
    if (real := np.abs(poles.imag) <= 1e-9 * size).any():
        listed = ", ".join(f"{pole:g}" for pole in np.sort(poles[real].real)[-4:])
        raise ValueError(
            f"A: must have modes that oscillate, and has real poles ({listed}): overdamped pairs, or the "
            "dynamics of sensors and actuators, which do not belong to the structure"
        )
    return np.flatnonzero(poles.imag > 0.0)


def _alike(poles: Complex, upper: npt.NDArray[np.intp]) -> list[list[int]]:
    """Groups of poles that are the same but for rounding."""
    groups: list[list[int]] = []
    for index in sorted(upper.tolist(), key=lambda index: abs(poles[index])):
        close = (
            group
            for group in reversed(groups[-8:])
            if abs(poles[group[0]] - poles[index]) <= _ALIKE * abs(poles[index])
        )
        if (group := next(close, None)) is not None:
            group.append(index)
        else:
            groups.append([index])
    return groups


def _places(model: StateSpace, most: int) -> Numbers:
    """Frequencies at and between the natural ones, of which many are thinned out."""
    w = model.frequencies
    places = np.concatenate([[0.5 * w[0]], w, np.sqrt(w[1:] * w[:-1]), [2.0 * w[-1]]])
    return np.asarray(places[:: 1 + len(places) // most])


def _deviation(model: StateSpace, a: Numbers, b: Numbers, c: Numbers) -> tuple[float, float]:
    """The largest relative deviation of the transfer function from that of the matrices, and where it is."""
    # Each costs a solution, in which threads of the linear algebra may wait for each other.
    places = _places(model, SOLVED)
    unit = np.eye(len(a))
    return _worst(
        model,
        places,
        (np.asarray(c @ np.linalg.solve(1j * w * unit - a, b), dtype=np.complex128) for w in places.tolist()),
    )


def _modal_deviation(model: StateSpace, motions: _Motions, b: Numbers, c: Numbers) -> tuple[float, float]:
    """The same from the sum over all poles, at and between all natural frequencies."""
    places, seen, pushed = _places(model, 10_000), c @ motions.right, motions.left @ b
    return _worst(model, places, (seen / (1j * w - motions.poles) @ pushed for w in places.tolist()))


def _worst(model: StateSpace, places: Numbers, exact: Iterable[Complex]) -> tuple[float, float]:
    worst = (0.0, float(places[0]))
    for place, own, true in zip(places.tolist(), model.response(places), exact, strict=True):
        size = float(np.linalg.norm(true))
        if size > 0.0:
            worst = max(worst, (float(np.linalg.norm(own - true)) / size, place))
    return worst
