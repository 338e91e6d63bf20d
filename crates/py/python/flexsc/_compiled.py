"""The common base of parts that are compiled functions, called by their address without Python."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import NoReturn, TypeVar

from flexsc._own_part import OwnPart

Self_ = TypeVar("Self_", bound="Compiled")


class Compiled(OwnPart):
    """A part given by a function: a `cfunc` of numba, a function of `ctypes`, or an address. A wrong address
    crashes the process.
    """

    address: int
    """The address of the function.

    >>> flexsc.CompiledLaw(4096, period=0.25).address
    4096
    """
    states: tuple[float, ...]
    """Its states at the start of a run.

    >>> flexsc.CompiledLaw(4096, period=0.25, states=(0.0, 1.0)).states
    (0.0, 1.0)
    """

    def _keep(self, function: object, states: Sequence[float]) -> None:
        self._function = function
        if isinstance(function, int):
            self.address = function
        elif isinstance(address := getattr(function, "address", None), int):
            self.address = address
        else:
            self.address = ctypes.cast(function, ctypes.c_void_p).value or 0  # type: ignore[arg-type]
        self.states = tuple(float(state) for state in states)

    def _never(self, _: object) -> NoReturn:
        raise NotImplementedError("a compiled part is called by its address")

    def copy(self: Self_) -> Self_:
        """Return the part itself: its states are copied for each run.

        >>> law = flexsc.CompiledLaw(4096, period=0.25)
        >>> law.copy() is law
        True
        """
        return self

    def __reduce__(self) -> tuple[object, ...]:
        raise TypeError("a compiled part is an address in this process and cannot be pickled")
