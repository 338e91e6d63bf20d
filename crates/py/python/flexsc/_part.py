"""The common base of the classes of `flexsc.scenario`.

The classes are what `dataclasses.dataclass(frozen=True, kw_only=True)` makes, with one constructor for all of
them: to generate one for each takes most of the time of their import.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

from flexsc._signature import LateSignature

if TYPE_CHECKING:
    from inspect import Signature

    from typing_extensions import Self, dataclass_transform
else:

    def dataclass_transform(**_: object) -> Callable[[type[Any]], type[Any]]:
        return lambda transformed: transformed


# The field of a key that is left out. Its type is that of the key, as it has a value in every scenario.
DEFAULT: Any = None


def _signature(part: type[Part]) -> Signature:
    """The signature of a class: its keys, with None as the default of those that may be left out."""
    from inspect import Parameter, Signature

    kind = Parameter.POSITIONAL_OR_KEYWORD if part._holds_one else Parameter.KEYWORD_ONLY
    return Signature(
        [
            Parameter(
                name,
                kind,
                default=Parameter.empty if name in part._needed else None,
                annotation=part.__annotations__[name],
            )
            for name in part._names
        ]
    )


class _LateFields:
    """The fields of a class for `dataclasses`, which is imported only with them."""

    def __get__(self, instance: object, owner: type[Part]) -> dict[str, Any]:
        from dataclasses import field, make_dataclass

        fields = [
            (name, owner.__annotations__[name], field() if name in owner._needed else field(default=None))
            for name in owner._names
        ]
        made: Any = make_dataclass(owner.__name__, fields, frozen=True, kw_only=not owner._holds_one)
        found: dict[str, Any] = made.__dataclass_fields__
        return found


@dataclass_transform(kw_only_default=True, frozen_default=True)
class Part:
    """A part of a scenario: a table of its file, or one of the kinds that a table may be.

    Parts are immutable, and equal if their keys have equal values. The functions of `dataclasses`, such as
    `replace` and `fields`, accept them.

    >>> from flexsc.scenario import Mode
    >>> Mode(frequency=0.44, gain=0.02)
    Mode(frequency=0.44, gain=0.02)
    >>> Mode(frequency=0.44, gain=0.02) == Mode(gain=0.02, frequency=0.44)
    True
    """

    # The name of its kind, the keys that hold a kind without its name, and whether it holds one value.
    _tag: ClassVar[str | None] = None
    _bare: ClassVar[tuple[str, ...]] = ()
    _holds_one: ClassVar[bool] = False
    # Its keys, and those that cannot be left out.
    _names: ClassVar[tuple[str, ...]] = ()
    _needed: ClassVar[tuple[str, ...]] = ()
    _known: ClassVar[frozenset[str]] = frozenset()

    if not TYPE_CHECKING:
        __signature__ = LateSignature(_signature)
        __dataclass_fields__ = _LateFields()

        def __init__(self, *values: object, **keys: object) -> None:
            if values:
                keys = self._with_position(values, keys)
            cls = type(self)
            if not keys.keys() <= cls._known or any(name not in keys for name in cls._needed):
                self._refuse(keys)
            self.__dict__.update((name, value) for name, value in keys.items() if value is not None)

    def __init_subclass__(cls, *, kw_only: bool = True) -> None:
        cls._names = tuple(name for name in cls.__annotations__ if not name.startswith("_"))
        cls._needed = tuple(name for name in cls._names if name not in cls.__dict__)
        cls._known = frozenset(cls._names)
        cls._holds_one = not kw_only
        if not kw_only:
            setattr(cls, "__match_args__", cls._names)  # noqa: B010, mypy knows it as final

    def _with_position(self, values: tuple[object, ...], keys: dict[str, object]) -> dict[str, object]:
        """The keys, with the value of a kind that holds one given by its position."""
        name = type(self).__name__
        if not self._holds_one or len(values) != 1:
            raise TypeError(f"{name} takes keywords only: {', '.join(self._names)}")
        if self._names[0] in keys:
            raise TypeError(f"{name} got {self._names[0]!r} twice")
        return {self._names[0]: values[0], **keys}

    def _refuse(self, keys: Mapping[str, object]) -> NoReturn:
        """Raise the error of keys that the part does not have, or lacks."""
        name = type(self).__name__
        for key in keys:
            if key not in self._known:
                from flexsc._named import no_such

                raise TypeError(no_such(f"{name} has no key", key, self._names).args[0])
        lacking = ", ".join(repr(key) for key in self._needed if key not in keys)
        raise TypeError(f"{name} needs {lacking}")

    def __setattr__(self, name: str, value: object) -> NoReturn:
        from dataclasses import FrozenInstanceError

        raise FrozenInstanceError(f"cannot assign to {name!r}: parts are immutable")

    def __delattr__(self, name: str) -> NoReturn:
        from dataclasses import FrozenInstanceError

        raise FrozenInstanceError(f"cannot delete {name!r}: parts are immutable")

    def __replace__(self, /, **changes: object) -> Self:
        return type(self)(**{**self._given(), **changes})

    def __eq__(self, other: object) -> bool:
        return _hashable(self) == _hashable(other) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(_hashable(self))

    def __repr__(self) -> str:
        keys = ", ".join(f"{name}={value!r}" for name, value in self._given().items())
        return f"{type(self).__name__}({keys})"

    def _given(self) -> dict[str, Any]:
        """The keys that have a value, in the order of the class."""
        return {name: value for name in self._names if (value := getattr(self, name)) is not None}

    def to_dict(self) -> dict[str, Any]:
        """Return the part as nested dictionaries, as a scenario file has it; what is None is left out.

        >>> from flexsc.scenario import Relay
        >>> Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.3).to_dict()["relay"]["k_t"]
        0.3
        """
        content = self._content()
        return content if self._tag is None else {self._tag: content}

    def _content(self) -> Any:
        """What a kind holds."""
        if self._holds_one:
            return plain(getattr(self, self._names[0]))
        # A name that Python keeps for itself ends with an underscore here.
        return {name.rstrip("_"): self._plain(name, value) for name, value in self._given().items()}

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


def _hashable(value: Any) -> Any:
    """A value that compares and hashes: arrays and lists as tuples, mappings as sets of pairs."""
    if isinstance(value, Part):
        return type(value), _hashable(value._given())
    if isinstance(value, Mapping):
        return frozenset((key, _hashable(inner)) for key, inner in value.items())
    if hasattr(value, "tolist"):  # an array or a scalar of numpy
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return tuple(_hashable(inner) for inner in value)
    return value
