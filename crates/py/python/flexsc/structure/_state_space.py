"""Modes from state-space matrices, x' = A x + B u, y = C x, such as those of the SLICOT collection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt
from flexsc.structure._modal_model import StateSpace

if TYPE_CHECKING:
    Numbers = npt.NDArray[np.float64]
    Complex = npt.NDArray[np.complex128]

# Poles nearer to each other than this, relatively, are those of modes with one frequency.
_ALIKE = 1e-8
# An input that pushes a mode by less than this part of what it pushes the others by is rounding.
_ROUNDING = 1e-12
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
    found = sorted(_modes(a, b, tolerance), key=lambda mode: mode[0])
    if not found:
        raise ValueError("B: must push a mode, and pushes none")
    w, zeta, influences, displacements, rates = (np.array(column) for column in zip(*found, strict=True))
    model = StateSpace(w, zeta, influences, c @ displacements.T, c @ rates.T, 0.0)
    deviation, where = _deviation(model, a, b, c)
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


def _modes(a: Numbers, b: Numbers, tolerance: float) -> list[tuple[float, float, Numbers, Numbers, Numbers]]:
    """Frequency, damping ratio, influence of the inputs, states of a unit displacement and of a unit rate."""
    poles, right = np.linalg.eig(a)
    upper = _oscillating(poles)
    condition = np.linalg.cond(right)
    if not condition < _FULL:
        raise ValueError(
            f"A: must have motions that are modes of their own, and their condition number is "
            f"{condition:.1e}: some drive each other, or the state has scales too far apart"
        )
    left = np.linalg.inv(right)
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


def _deviation(model: StateSpace, a: Numbers, b: Numbers, c: Numbers) -> tuple[float, float]:
    """The largest relative deviation of the transfer function from that of the matrices, and where it is."""
    w = model.frequencies
    places = np.concatenate([[0.5 * w[0]], w, np.sqrt(w[1:] * w[:-1]), [2.0 * w[-1]]])
    # So many tell; each costs a solution.
    places = places[:: 1 + len(places) // 400]
    own = model.response(places)
    worst = (0.0, float(places[0]))
    for place, seen in zip(places.tolist(), own, strict=True):
        exact = c @ np.linalg.solve(1j * place * np.eye(len(a)) - a, b)
        size = float(np.linalg.norm(exact))
        if size > 0.0:
            worst = max(worst, (float(np.linalg.norm(seen - exact)) / size, place))
    return worst
