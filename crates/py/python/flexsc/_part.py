"""What the classes of `flexsc.scenario` have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar


class Part:
    """A part of a scenario: a table of its file, or one of the kinds that a table may be."""

    # The name of its kind, the keys that hold a kind without its name, and whether it holds one value.
    _tag: ClassVar[str | None] = None
    _bare: ClassVar[tuple[str, ...]] = ()
    _holds_one: ClassVar[bool] = False

    def to_dict(self) -> dict[str, Any]:
        """The part as nested dictionaries, as a scenario file has it; what is None is left out.

        >>> from flexsc.scenario import Relay
        >>> Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.3).to_dict()["relay"]["k_t"]
        0.3
        """
        content = self._content()
        return content if self._tag is None else {self._tag: content}

    def _content(self) -> Any:
        """What a kind holds."""
        names = [name for name in getattr(self, "__dataclass_fields__", ()) if not name.startswith("_")]
        if self._holds_one:
            return plain(getattr(self, names[0]))
        values = {name: value for name in names if (value := getattr(self, name)) is not None}
        # A name that Python keeps for itself ends with an underscore here.
        return {name.rstrip("_"): self._plain(name, value) for name, value in values.items()}

    def _plain(self, name: str, value: Any) -> Any:
        return value._content() if name in self._bare and isinstance(value, Part) else plain(value)


def plain(value: Any) -> Any:
    """A value with all of its parts as dictionaries."""
    if isinstance(value, Part):
        return value.to_dict()
    if isinstance(value, Mapping):
        return {key: plain(inner) for key, inner in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(inner) for inner in value]
    return value
