"""A control program in lockstep with `flexsc serve`: the sensors of each cycle in, its commands out.

The module uses the standard library alone: flight software in Python may take a copy of this one file to
where flexsc is not installed. Start the server in a terminal,

    flexsc serve scenarios/earth-observer.toml

and run the law:

    from flexsc.lockstep import Client

    with Client() as client:
        for cycle in client:
            angle, rate = cycle["estimate.error"], cycle["estimate.rate"]
            client.command([-0.01 * a - 0.16 * w for a, w in zip(angle, rate)], "acceleration")

Packets are CCSDS Space Packets. They may be lost, repeated or damaged on their way: the law is stepped once
for each cycle, and an answer that was lost is sent again.
"""

from __future__ import annotations

import os
import socket
import struct
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

__all__ = ["Client", "Cycle", "LockstepError", "Quantity"]

VERSION = 1
"""The version of the packets."""

Quantity = Literal["torque", "rate_change", "acceleration", "moment"]
"""The quantity of a command: N m, rad/s, rad/s² or A m²."""

_HELLO, _WELCOME, _REFUSAL, _REQUEST, _SENSORS, _COMMAND, _END, _FAREWELL = range(0x2F0, 0x2F8)
_TELECOMMANDS = (_HELLO, _REQUEST, _COMMAND, _FAREWELL)
_QUANTITIES: tuple[Quantity, ...] = ("torque", "rate_change", "acceleration", "moment")
_ENDS = ("complete", "interrupted", "failed")
_STATUS = ("none", "held", "new")
_PACES = ("free", "real-time", "step")
_CODES = {"u8": "B", "u32": "I", "u64": "Q", "i64": "q", "f64": "d"}
_REPEAT = 0.02
_HELLO_REPEAT = 0.1


class LockstepError(Exception):
    """The server has refused the client, or is silent, or its run has failed.

    >>> Client(port=1, timeout=0.1)                                     # where no server is
    Traceback (most recent call last):
    flexsc.lockstep.LockstepError: no server answers there: start `flexsc serve` first
    """


def _table() -> list[int]:
    table: list[int] = []
    for byte in range(256):
        value = byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021 if value & 0x8000 else value << 1) & 0xFFFF
        table.append(value)
    return table


_TABLE = _table()


def _checksum(data: bytes) -> int:
    """Return the cyclic redundancy check of a packet, x^16 + x^12 + x^5 + 1 from all ones."""
    value = 0xFFFF
    for byte in data:
        value = (value << 8 & 0xFFFF) ^ _TABLE[value >> 8 ^ byte]
    return value


def _opened(packet: bytes) -> tuple[int, bytes] | None:
    """Return the identifier and the content of a whole packet; None of a damaged one."""
    if len(packet) < 9:
        return None
    first, sequence, length = struct.unpack_from(">HHH", packet)
    identifier = first & 0x7FF
    is_telecommand = identifier in _TELECOMMANDS
    if length + 7 != len(packet) or first >> 11 != is_telecommand << 1 or sequence >> 14 != 3:
        return None
    if _checksum(packet[:-2]) != int.from_bytes(packet[-2:], "big"):
        return None
    return identifier, packet[6:-2]


@dataclass(frozen=True)
class _Field:
    offset: int
    form: struct.Struct
    is_scalar: bool
    components: tuple[str, ...]
    unit: str


class Cycle(Mapping[str, "float | int | str | tuple[float, ...]"]):
    """The sensors of a cycle, by the names of their fields, such as `gyro.rate` or `estimate.angle`.

    A field with components is a tuple. `gyro.status` is `none` before the first reading, `new` if a reading
    has come since the last cycle, and else `held`.

    >>> cycle = client.receive()                                        # of the `Client` below
    >>> cycle["gyro.status"], len(cycle["estimate.rate"])
    ('new', 3)
    """

    __slots__ = ("_content", "_fields", "number")

    number: int
    """The number of the cycle, from 0.

    >>> cycle.number
    1
    """

    def __init__(self, fields: dict[str, _Field], content: bytes) -> None:
        self._fields = fields
        self._content = content
        self.number = self._integer("cycle")

    def _integer(self, name: str) -> int:
        field = self._fields[name]
        return int(field.form.unpack_from(self._content, field.offset)[0])

    @property
    def time(self) -> float:
        """The simulated time (s), rounded to a double; `time_s` and `time_fs` are exact.

        >>> cycle.time
        0.25
        """
        whole, part = self._integer("time_s"), self._integer("time_fs")
        if whole < 9000:
            return (whole * 10**15 + part) / 1e15
        return whole + part / 1e15

    def numbers(self, name: str) -> tuple[float, ...]:
        """Return the numbers of a field, one for each component: a tuple also where there is one.

        >>> cycle.numbers("cycle"), len(cycle.numbers("gyro.rate"))
        ((1,), 3)

        Raises:
            KeyError: There is no such field.
        """
        field = self._fields[name]
        return field.form.unpack_from(self._content, field.offset)

    def __getitem__(self, name: str) -> float | int | str | tuple[float, ...]:
        values = self.numbers(name)
        if name.endswith(".status"):
            return _STATUS[int(values[0])]
        return values[0] if self._fields[name].is_scalar else values

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"<flexsc.lockstep.Cycle {self.number} at {self.time:g} s>"


class Client:
    """A connection to a server, whose cycles are iterated over.

    Args:
        host: The host of the server.
        port: The port of the server.
        tcp: Whether the server was started with `--tcp`.
        layout: The expected layout of the packets; None for any. The server refuses another one.
        timeout: The longest silence of the server (s).

    Raises:
        LockstepError: The server refuses the client, or does not answer.

    >>> from flexsc.lockstep import Client
    >>> client = Client(port=port)                                  # of `flexsc serve earth-observer.toml`
    """

    axes: int
    """The number of axes with commands: 1 or 3.

    >>> client.axes
    3
    """
    period: float
    """The period of the cycles (s).

    >>> client.period
    0.25
    """
    layout: int
    """The layout of the packets, a hash of their description.

    >>> 0 < client.layout < 2**64
    True
    """
    pace: str
    """The pace of the run: `free`, `real-time` or `step`.

    >>> client.pace
    'free'
    """
    units: dict[str, str]
    """The unit of each field.

    >>> client.units["gyro.rate"], client.units["gyro.status"]
    ('rad/s', '')
    """
    components: dict[str, tuple[str, ...]]
    """The names of the components of each field.

    >>> client.components["estimate.rate"]
    ('x', 'y', 'z')
    """
    end: str | None
    """How the run has ended, `complete`, `interrupted` or `failed`; None before.

    >>> client.end is None
    True
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 5010,
        *,
        tcp: bool = False,
        layout: int | None = None,
        timeout: float = 10.0,
    ) -> None:
        self.timeout = timeout
        self.end = None
        self._counts = [0] * 8
        self._buffer = b""
        self._tcp = tcp
        self._answer: bytes | None = None
        self._cycle: Cycle | None = None
        self._socket = self._connect(host, port)
        try:
            self._greet(layout or 0)
        except BaseException:
            self._socket.close()
            raise

    def _connect(self, host: str, port: int) -> socket.socket:
        kind = socket.SOCK_STREAM if self._tcp else socket.SOCK_DGRAM
        try:
            family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=kind)[0]
            connection = socket.socket(family, kind, protocol)
        except OSError as error:
            raise LockstepError(f"cannot reach {host}:{port}: {error}") from None
        try:
            connection.settimeout(self.timeout)
            connection.connect(address)
            if self._tcp:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError as error:
            connection.close()
            raise LockstepError(f"cannot reach {host}:{port}: {error}") from None
        return connection

    def _greet(self, layout: int) -> None:
        nonce = int.from_bytes(os.urandom(4), "big")
        hello = struct.pack(">IIHQ", 0, nonce, VERSION, layout)
        began = time.monotonic()
        self._send(_HELLO, hello)
        while True:
            received = self._receive(_HELLO_REPEAT)
            if received is None:
                if time.monotonic() - began > self.timeout:
                    raise LockstepError("no server answers there: start `flexsc serve` first")
                if not self._tcp:
                    self._send(_HELLO, hello)
                continue
            identifier, content = received
            if identifier == _REFUSAL:
                raise LockstepError(content[8:].decode("utf-8", "replace"))
            if identifier == _WELCOME and struct.unpack_from(">I", content, 4)[0] == nonce:
                break
        self._session, _, version, self.layout, pace = struct.unpack_from(">IIHQB", content)
        if version != VERSION:
            raise LockstepError(f"the server has version {version} of the packets, and this client {VERSION}")
        self.pace = _PACES[pace]
        self._read_layout(content[struct.calcsize(">IIHQB") :].decode("utf-8"))

    def _read_layout(self, text: str) -> None:
        head, *lines = text.splitlines()
        words = head.split()
        self.axes = int(words[3])
        whole, part = int(words[5]), int(words[6])
        self.period = (whole * 10**15 + part) / 1e15
        self._fields: dict[str, _Field] = {}
        offset = 0
        for line in lines:
            name, form, components, unit = line.split(" ", 3)
            names = () if components == "-" else tuple(components.split(","))
            packed = struct.Struct(f">{len(names) or 1}{_CODES[form]}")
            self._fields[name] = _Field(offset, packed, not names, names, "" if unit == "-" else unit)
            offset += packed.size
        self._length = offset
        self._command = struct.Struct(f">IQ{self.axes}B{self.axes}d")
        self.units = {name: field.unit for name, field in self._fields.items()}
        self.components = {name: field.components for name, field in self._fields.items()}

    def _send(self, identifier: int, content: bytes) -> None:
        kind = identifier - _HELLO
        first = (identifier in _TELECOMMANDS) << 12 | identifier
        packet = struct.pack(">HHH", first, 0xC000 | self._counts[kind], len(content) + 1) + content
        self._counts[kind] = (self._counts[kind] + 1) & 0x3FFF
        packet += _checksum(packet).to_bytes(2, "big")
        try:
            self._socket.sendall(packet)
        except ConnectionRefusedError:
            # A datagram to a server that is not there yet, or not any more.
            pass
        except OSError as error:
            raise LockstepError(f"the server has gone: {error}") from None

    def _receive(self, wait: float) -> tuple[int, bytes] | None:
        """Return the next packet within a time; None without one, and of a damaged one."""
        self._socket.settimeout(wait)
        try:
            packet = self._read_stream() if self._tcp else self._socket.recv(65535)
        except (TimeoutError, ConnectionRefusedError):
            return None
        except OSError as error:
            raise LockstepError(f"the server has gone: {error}") from None
        return _opened(packet)

    def _read_stream(self) -> bytes:
        while True:
            if len(self._buffer) >= 6:
                length = int.from_bytes(self._buffer[4:6], "big") + 7
                if len(self._buffer) >= length:
                    packet, self._buffer = self._buffer[:length], self._buffer[length:]
                    return packet
            piece = self._socket.recv(65536)
            if not piece:
                raise LockstepError("the server has closed the connection")
            self._buffer += piece

    def receive(self) -> Cycle | None:
        """Return the next cycle, once; None at the end of the run.

        >>> client.receive()
        <flexsc.lockstep.Cycle 0 at 0 s>
        >>> client.command([0.0, 0.0, 0.0])

        Raises:
            LockstepError: The server is silent, or the run has failed.
        """
        if self.end is not None:
            return None
        expected = 0 if self._cycle is None else self._cycle.number + 1
        request = struct.pack(">IQ", self._session, expected)
        if self.pace == "step":
            self._send(_REQUEST, request)
        began = time.monotonic()
        while True:
            received = self._receive(_REPEAT if self.pace == "step" and not self._tcp else self.timeout)
            if received is None:
                if time.monotonic() - began > self.timeout:
                    raise LockstepError(f"the server has been silent for {self.timeout:g} s")
                if self.pace == "step" and not self._tcp:
                    self._send(_REQUEST, request)
                continue
            identifier, content = received
            if identifier == _REFUSAL:
                raise LockstepError(content[8:].decode("utf-8", "replace"))
            if struct.unpack_from(">I", content)[0] != self._session:
                continue
            if identifier == _END:
                self._send(_FAREWELL, struct.pack(">I", self._session))
                self.end = _ENDS[content[-1]]
                return None
            if identifier != _SENSORS or len(content) != self._length:
                continue
            number = struct.unpack_from(">Q", content, 4)[0]
            if number == expected:
                self._cycle, self._answer = Cycle(self._fields, content), None
                return self._cycle
            if number + 1 == expected and self._answer is not None:
                # The answer was lost, or the packet is a repetition of one that was answered.
                self._send(_COMMAND, self._answer)

    def command(
        self, values: Sequence[float] | float, quantity: Quantity | Sequence[Quantity] = "torque"
    ) -> None:
        """Answer the cycle with the commands about the axes, which act from its time on.

        Args:
            values: The commands in SI units: one for each axis, or a number for one axis.
            quantity: The quantity of all commands, or of each.

        >>> client.command([-0.01 * angle for angle in cycle["estimate.error"]], "acceleration")

        Raises:
            ValueError: No cycle has been received, or the number of values is not that of the axes.
        """
        each = [float(values)] if isinstance(values, (int, float)) else [float(value) for value in values]
        quantities = [quantity] * self.axes if isinstance(quantity, str) else list(quantity)
        if len(each) != self.axes or len(quantities) != self.axes:
            given = f"{len(each)} values and {len(quantities)} quantities"
            raise ValueError(f"there are {self.axes} axes, got {given}")
        self._reply([_QUANTITIES.index(word) for word in quantities], each)

    def hold(self) -> None:
        """Answer the cycle without commands: those in force stay, as if the cycle had not been.

        >>> client.hold()

        Raises:
            ValueError: No cycle has been received.
        """
        self._reply([len(_QUANTITIES)] * self.axes, [0.0] * self.axes)

    def _reply(self, codes: Sequence[int], values: Sequence[float]) -> None:
        if self._cycle is None:
            raise ValueError("no cycle has been received yet")
        self._answer = self._command.pack(self._session, self._cycle.number, *codes, *values)
        self._send(_COMMAND, self._answer)

    def __iter__(self) -> Iterator[Cycle]:
        while (cycle := self.receive()) is not None:
            yield cycle

    def close(self) -> None:
        """Close the connection; a run that goes on ends when the server misses the client.

        >>> client.close()
        """
        self._socket.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
