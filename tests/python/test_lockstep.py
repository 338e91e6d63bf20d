"""Lockstep: a control program in Python, a link that loses packets, and the packets in another parser."""

from __future__ import annotations

import random
import re
import socket
import struct
import subprocess
import threading
import warnings
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import flexsc
import pytest
from conftest import SCENARIOS, command_path
from flexsc import lockstep
from flexsc.lockstep import Client, Cycle, LockstepError, Quantity
from test_examples import described, run_text

ROOT = Path(__file__).parents[2]
WN, ZETA = 0.1, 0.8

Server = tuple["subprocess.Popen[str]", int]


@contextmanager
def serving(where: Path, *options: str, name: str = "earth-observer") -> Generator[Server, None, None]:
    """A server on a free port, which ends with the block."""
    arguments = ["serve", SCENARIOS / f"{name}.toml", "--bind", "127.0.0.1:0", *options]
    server = subprocess.Popen(
        [command_path(), *map(str, arguments)], cwd=where, stderr=subprocess.PIPE, text=True
    )
    assert server.stderr
    try:
        for line in server.stderr:
            if found := re.match(r"  serve +\w+ [\d.]+:(\d+),", line):
                yield server, int(found[1])
                break
        else:
            raise AssertionError(f"exit code {server.wait()}")
    finally:
        server.kill()
        server.communicate()


def ended(server: subprocess.Popen[str], exits: int = 0) -> str:
    _, err = server.communicate(timeout=60)
    assert server.returncode == exits, err
    return err


def test_the_examples_of_the_client_run(tmp_path: Path) -> None:
    source = described(Path(lockstep.__file__))
    client, cycle = source["Client"], source["Cycle"]
    texts = [client.text]
    texts += [text for name, text in client.members.items() if name not in {"command", "hold", "close"}]
    texts += [cycle.text, *cycle.members.values()]
    texts += [client.members[name] for name in ("command", "hold", "close")]
    assert len(texts) == 16
    with serving(tmp_path) as (_, port):
        names: dict[str, Any] = {"port": port}
        for text in [*texts, source["LockstepError"].text]:
            assert run_text("flexsc.lockstep", text, names) > 0, text


class LossyLink:
    """A link of datagrams that loses a share of the packets in each direction."""

    def __init__(self, server: int, share: float, seed: int) -> None:
        self.near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.far = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.near.bind(("127.0.0.1", 0))
        self.far.connect(("127.0.0.1", server))
        self.port: int = self.near.getsockname()[1]
        self.lost = 0
        self._client: Any = None
        self._open = True
        self._threads: list[threading.Thread] = []
        for source, up in [(self.near, True), (self.far, False)]:
            source.settimeout(0.05)
            carry = threading.Thread(target=self._carry, args=(source, up, share, seed + up), daemon=True)
            carry.start()
            self._threads.append(carry)

    def _carry(self, source: socket.socket, up: bool, share: float, seed: int) -> None:
        draws = random.Random(seed)
        while self._open:
            try:
                packet, sender = source.recvfrom(65535)
            except OSError:
                continue
            if up:
                self._client = sender
            if draws.random() < share:
                self.lost += 1
            elif up:
                self.far.send(packet)
            else:
                self.near.sendto(packet, self._client)

    def close(self) -> None:
        self._open = False
        for carry in self._threads:
            carry.join()
        self.near.close()
        self.far.close()


def attitude_law(cycle: Cycle) -> list[float]:
    """The law of the Earth observer, to the bit."""
    names = ["estimate.error", "reference.angle", "estimate.rate", "reference.rate", "reference.acceleration"]
    rows = zip(*map(cycle.numbers, names), strict=True)
    return [
        -(WN * WN * (error - angle) + 2.0 * ZETA * WN * (rate - reference)) + acceleration
        for error, angle, rate, reference, acceleration in rows
    ]


def messages(path: Path) -> list[tuple[str, int, bytes]]:
    reader = pytest.importorskip("mcap.reader")
    with path.open("rb") as file:
        all_messages = reader.make_reader(file).iter_messages(log_time_order=False)
        return [(channel.topic, message.log_time, message.data) for _, channel, message in all_messages]


def test_a_law_in_python_with_losses_gives_the_run_of_the_scenario(tmp_path: Path) -> None:
    """1000 s of the Earth observer with 1 % losses; the law is that of the scenario."""
    settings = ["--set", "duration=999.9", "--log", "full"]
    scenario = SCENARIOS / "earth-observer.toml"
    own = [command_path(), "simulate", str(scenario), *settings, "-o", "own.mcap"]
    subprocess.run(own, cwd=tmp_path, check=True, capture_output=True)
    with serving(tmp_path, *settings, "-o", "served.mcap") as (server, port):
        link = LossyLink(port, 0.01, 5)
        with Client(port=link.port) as client:
            assert (client.axes, client.period, client.pace) == (3, 0.25, "free")
            assert client.units["gyro.rate"] == "rad/s"
            assert client.components["star_tracker.attitude"] == ("w", "x", "y", "z")
            numbers: list[int] = []
            for cycle in client:
                numbers.append(cycle.number)
                client.command(attitude_law(cycle), "acceleration")
            assert client.end == "complete"
        link.close()
        told = ended(server)
    assert numbers == list(range(4000))
    assert link.lost > 20
    print(re.findall(r"  lockstep.*", told), link.lost)
    assert messages(tmp_path / "served.mcap") == messages(tmp_path / "own.mcap")


def test_the_bytes_are_those_of_a_simulator_with_the_same_torques(tmp_path: Path) -> None:
    """The torques of a law on the true motion, in this process and in lockstep."""

    def torques(error: Any, rate: Any) -> list[float]:
        return [-3.0 * float(a) - 40.0 * float(w) for a, w in zip(error, rate, strict=True)]

    keys = {"duration": 20.0, "sensor": "continuous"}
    scenario = flexsc.Scenario.load(SCENARIOS / "earth-observer.toml").without("estimator").with_(keys)
    (tmp_path / "exact.toml").write_text(scenario.to_toml(), "utf-8")
    sim = flexsc.Simulator(scenario)
    while not sim.done:
        sim.step(torques(sim.measured["error"], sim.measured["rate"]), 0.25)
    sim.to_mcap(tmp_path / "own.mcap", "full")
    options = ["--log", "full", "-o", "served.mcap"]
    with serving(tmp_path, *options, name=str(tmp_path / "exact")) as (server, port):
        with Client(port=port) as client:
            for cycle in client:
                client.command(torques(cycle["estimate.angle"], cycle["estimate.rate"]))
        ended(server)
    assert (tmp_path / "served.mcap").read_bytes() == (tmp_path / "own.mcap").read_bytes()


@pytest.mark.parametrize("transport", ["udp", "tcp"])
@pytest.mark.parametrize("pace", ["free", "step"])
def test_one_program_serves_every_transport_and_pace(tmp_path: Path, transport: str, pace: str) -> None:
    options = [f"--{transport}", "--pace", pace, "--set", "duration=5", "--log", "none"]
    with serving(tmp_path, *options) as (server, port):
        with Client(port=port, tcp=transport == "tcp") as client:
            assert client.pace == pace
            cycles = list(client_cycles(client))
        assert [cycle.time for cycle in cycles] == [0.25 * number for number in range(20)]
        ended(server)


def client_cycles(client: Client) -> Iterator[Cycle]:
    quantities: list[Quantity] = ["acceleration", "acceleration", "acceleration"]
    for cycle in client:
        client.command(attitude_law(cycle), quantities)
        yield cycle


def test_a_client_is_told_why_it_cannot_begin(tmp_path: Path) -> None:
    with pytest.raises(LockstepError, match="no server answers"):
        Client(port=1, timeout=0.3)
    with pytest.raises(LockstepError, match=r"cannot reach 127\.0\.0\.1:1"):
        Client(port=1, tcp=True)
    with serving(tmp_path, "--set", "duration=2", "--log", "none", "--timeout", "1") as (server, port):
        with pytest.raises(LockstepError, match="the client expects 0000000000000007"):
            Client(port=port, layout=7)
        with Client(port=port) as client:
            with pytest.raises(ValueError, match="no cycle"):
                client.command([0.0] * 3)
            with pytest.raises(LockstepError, match="another client controls this run"):
                Client(port=port)
            cycle = client.receive()
            assert cycle is not None
            assert cycle.number == 0
            assert cycle["gyro.status"] == "new"
            with pytest.raises(ValueError, match="3 axes"):
                client.command([0.0] * 2)
            client.command([float("nan")] * 3)
            with pytest.raises(LockstepError, match="the command about axis 1 is NaN"):
                client.receive()
        assert "the command about axis 1 is NaN" in ended(server, exits=1)


def test_the_program_of_the_page_runs(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "serve.md").read_text("utf-8")
    (program,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    with serving(tmp_path, "--set", "duration=20") as (server, port):
        names: dict[str, Any] = {}
        exec(program.replace("Client()", f"Client(port={port})"), names)
        assert "goal" in ended(server)


@pytest.fixture
def description(tmp_path: Path) -> Callable[..., Any]:
    """The packets of a scenario, as space_packet_parser reads their description."""
    parser = pytest.importorskip(
        "space_packet_parser", reason="space_packet_parser reads XTCE: pip install space_packet_parser"
    )

    def read(*options: str) -> Any:
        scenario = SCENARIOS / "earth-observer.toml"
        done = subprocess.run(
            [command_path(), "serve", str(scenario), "--describe", *options], capture_output=True, check=True
        )
        path = tmp_path / "packets.xml"
        path.write_bytes(done.stdout)
        return parser.load_xtce(path)

    return read


def test_another_parser_reads_every_field_to_the_bit(tmp_path: Path, description: Callable[..., Any]) -> None:
    definition = description()
    with serving(tmp_path, "--set", "duration=5", "--log", "none") as (server, port):
        with Client(port=port) as client:
            received: list[bytes] = []
            receive, send = client._socket.recv, client._socket.sendall
            sent: list[bytes] = []

            class Tapped:
                """The client's socket, with a copy of all packets."""

                def recv(self, size: int) -> bytes:
                    received.append(receive(size))
                    return received[-1]

                def sendall(self, packet: bytes) -> None:
                    sent.append(packet)
                    send(packet)

                def __getattr__(self, name: str) -> Any:
                    return getattr(tapped, name)

            tapped = client._socket
            client._socket = Tapped()  # type: ignore[assignment]
            cycles = list(client_cycles(client))
            layout, components = client._fields, client.components
            client._socket = tapped
        ended(server)
    sensors = [packet for packet in received if packet[1] == 0xF4][: len(cycles)]
    assert len(sensors) == len(cycles) == 20
    for packet, cycle in zip(sensors, cycles, strict=True):
        read = parse(definition, packet)
        assert (read["apid"], read["packet_type"], read["sequence_flags"]) == (0x2F4, 0, 3)
        checked = 0
        for name in layout:
            for index, component in enumerate(components[name] or [""]):
                known = cycle.numbers(name)[index]
                found = read["_".join([name.replace(".", "_"), *([component] if component else [])])]
                if name.endswith(".status"):
                    assert found == cycle[name]
                    assert found.raw_value == known
                elif isinstance(known, int):
                    assert int(found) == known
                else:
                    assert struct.pack(">d", found) == struct.pack(">d", known)
                checked += 1
        assert len(read) == checked + 8, "and the header and the checksum"
        assert read["packet_error_control"] == int.from_bytes(packet[-2:], "big")
    commands = [packet for packet in sent if packet[1] == 0xF5]
    read = parse(definition, commands[3])
    assert (read["apid"], read["packet_type"], int(read["cycle"])) == (0x2F5, 1, 3)
    assert read["command_quantity_z"] == "acceleration"
    known_command = attitude_law(cycles[3])
    assert [float(read[f"command_value_{axis}"]) for axis in "xyz"] == known_command
    last = parse(definition, next(packet for packet in received if packet[1] == 0xF6))
    assert (last["end"], int(last["time_s"])) == ("complete", 5)


def test_the_description_is_valid(tmp_path: Path, description: Callable[..., Any]) -> None:
    etree = pytest.importorskip("lxml.etree", reason="lxml checks schemas: pip install lxml")
    description()
    package: Any = pytest.importorskip("space_packet_parser")
    schema = Path(package.__file__).parent / "xtce" / "schemas" / "SpaceSystem.xsd"
    # The schema refers to one of the web, of which it uses three attributes.
    names = {"base": "anyURI", "lang": "language", "space": "string"}
    attributes = "".join(f'<xs:attribute name="{name}" type="xs:{kind}"/>' for name, kind in names.items())
    head = (
        'xmlns:xs="http://www.w3.org/2001/XMLSchema" targetNamespace="http://www.w3.org/XML/1998/namespace"'
    )
    (tmp_path / "xml.xsd").write_text(f"<xs:schema {head}>{attributes}</xs:schema>", "utf-8")
    text = re.sub(r'schemaLocation="[^"]*xml\.xsd"', 'schemaLocation="xml.xsd"', schema.read_text("utf-8"))
    (tmp_path / "xtce.xsd").write_text(text, "utf-8")
    checker = etree.XMLSchema(etree.parse(str(tmp_path / "xtce.xsd")))
    assert checker.validate(etree.parse(str(tmp_path / "packets.xml"))), checker.error_log


def parse(definition: Any, packet: bytes) -> dict[str, Any]:
    """The fields of a packet."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        parsed = definition.parse_bytes(packet)
    return dict(parsed)
