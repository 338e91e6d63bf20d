"""NumPy, imported when it is first used, so that `import flexsc` stays quick."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
else:
    from importlib import import_module

    class _Later:
        """A module that is imported for its first attribute."""

        def __init__(self, name: str) -> None:
            self._name = name

        def __getattr__(self, name: str) -> object:
            value = getattr(import_module(self._name), name)
            setattr(self, name, value)
            return value

    np, npt = _Later("numpy"), _Later("numpy.typing")

__all__ = ["np", "npt"]
