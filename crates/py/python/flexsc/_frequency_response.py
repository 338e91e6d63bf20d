"""Poles of linear models, and their responses over frequencies that follow the resonances."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from flexsc._linear import Linear

    Values = npt.NDArray[np.float64]

# Frequencies in a decade, away from resonances.
_DECADE = 200
# Poles with less of the critical damping than this have frequencies of their own.
_DAMPED = 0.5
# Half widths from a pole within which frequencies are evenly apart, and their number: a peak that stands out
# four times from what is around it lies in there, and is met to (0.25 / 200)^2 / 2 of its height.
_NEAR, _COUNT = 0.25, 201
# Ratio of the distances of two frequencies from a pole, farther away.
_APART = 1.05
# Half width of an undamped resonance, for the frequencies around it.
_UNDAMPED = 1e-6
# Numbers of a batch of matrices, 32 MB.
_BATCH = 2_000_000


def _eigenvalues(model: Linear) -> tuple[npt.NDArray[np.complex128], npt.NDArray[np.complex128]]:
    """The poles of a model, and the same as s (1/s): log(z)/period for a sampled one."""
    found: Any = np.linalg.eigvals(model.a).astype(np.complex128)
    if model.period is None:
        return found, found
    s = np.full(len(found), -np.inf, dtype=np.complex128)
    # What was a state for one period alone is forgotten at once.
    lasting = np.abs(found) > 1e-12
    s[lasting] = np.log(found[lasting]) / model.period
    return found, s


def poles(model: Linear) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of `Linear.poles`."""
    found, s = _eigenvalues(model)
    finite = np.isfinite(s)
    frequency = np.abs(s)
    rigid = frequency < 1e-7 * max(1.0, frequency[finite].max(initial=0.0))
    damping = np.ones(len(s))
    damping[finite] = -s[finite].real / np.where(rigid, 1.0, frequency)[finite]
    frequency[rigid], damping[rigid] = 0.0, np.nan
    order = np.lexsort((s.imag, frequency))
    return {"pole": found[order], "frequency": frequency[order], "damping": damping[order]}


def frequency_grid(model: Linear) -> Values:
    """Return the frequencies of `Linear.frequency_grid`."""
    _, s = _eigenvalues(model)
    size = np.abs(s)
    seen = s[np.isfinite(size) & (size > 1e-7 * max(1.0, size[np.isfinite(size)].max(initial=0.0)))]
    nyquist = np.inf if model.period is None else np.pi / model.period
    typical = np.abs(seen) if len(seen) else np.array([1.0 if nyquist == np.inf else 0.1 * nyquist])
    low = min(0.1 * float(typical.min()), 0.1 * nyquist)
    high = min(10.0 * float(typical.max()), nyquist)
    count = max(2, round(_DECADE * np.log10(high / low)) + 1)
    grids = [np.geomspace(low, high, count)]
    grids += [_around(pole) for pole in seen if pole.imag > 0.0 and -pole.real < _DAMPED * abs(pole)]
    whole = np.unique(np.concatenate(grids))
    return whole[(whole >= low) & (whole <= high)]


def around_zeros(model: Linear, output: int, into: int) -> Values:
    """Return frequencies around the zeros from an input to an output, at which the phase turns."""
    order = len(model.a)
    whole = np.zeros((order + 1, order + 1))
    whole[:order, :order], whole[:order, order] = model.a, model.b[:, into]
    whole[order, :order], whole[order, order] = model.c[output], model.d[output, into]
    finite = np.eye(order + 1)
    finite[order, order] = 0.0
    # The zeros s of the pencil by 1/(s - shift), of which zeros at infinity are 0; no zero is at the shift.
    shift = 0.61803 * (1.0 + float(np.abs(model.a).max(initial=0.0)) ** 0.5)
    try:
        inverse: Any = np.linalg.eigvals(np.linalg.solve(whole - shift * finite, finite)).astype(
            np.complex128
        )
    except np.linalg.LinAlgError:
        # The output does not see the input.
        return np.zeros(0)
    zeros = shift + 1.0 / inverse[np.abs(inverse) > 1e-9 * np.abs(inverse).max(initial=0.0)]
    if model.period is not None:
        zeros = np.log(zeros[np.abs(zeros) > 1e-12]) / model.period
    sharp = zeros[(zeros.imag > 0.0) & (np.abs(zeros.real) < _DAMPED * np.abs(zeros))]
    return np.concatenate([np.zeros(0), *(_around(zero, 7, 1.5) for zero in sharp)])


def _around(root: complex, count: int = _COUNT, apart: float = _APART) -> Values:
    """Frequencies around a pole or a zero, by its half width."""
    size, centre = abs(root), root.imag
    half = abs(root.real)
    near = np.linspace(-_NEAR, _NEAR, count)
    if half < 1e-9 * size:
        # The response is infinite at the pole itself.
        half, near = _UNDAMPED * size, near[near != 0.0]
    # From where the others are as dense.
    end = 0.2 * size / half
    steps = max(0, int(np.ceil(np.log(end / _NEAR) / np.log(apart))))
    far = _NEAR * apart ** np.arange(1, steps + 1)
    around: Any = centre + half * np.concatenate([-far, near, far])
    values: Values = around
    return values


def response(model: Linear, frequencies: npt.ArrayLike | None) -> npt.NDArray[np.complex128]:
    """Return the values of `Linear.response`."""
    w = frequency_grid(model) if frequencies is None else np.asarray(frequencies, dtype=np.float64)
    if w.ndim != 1 or not np.isfinite(w).all():
        raise ValueError(f"frequencies must be finite numbers of shape (frequencies,), got {w!r}")
    at: Any = 1j * w if model.period is None else np.exp(1j * w * model.period)
    order = len(model.a)
    found = np.empty((len(w), *model.d.shape), dtype=np.complex128)
    batch = max(1, _BATCH // max(1, order * order))
    for first in range(0, len(w), batch):
        part = at[first : first + batch]
        found[first : first + batch] = _values(model, part)
    return found


def _values(model: Linear, at: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
    """c (z - a)^-1 b + d, without a value where z is a pole."""
    whole = at[:, None, None] * np.eye(len(model.a)) - model.a
    try:
        inner: Any = np.linalg.solve(whole, model.b.astype(np.complex128)[None])
    except np.linalg.LinAlgError:
        if len(at) == 1:
            return np.full((1, *model.d.shape), complex(np.nan, np.nan))
        middle = len(at) // 2
        return np.concatenate([_values(model, at[:middle]), _values(model, at[middle:])])
    values: npt.NDArray[np.complex128] = model.c @ inner + model.d
    return values
