"""A flexsc spacecraft, or a flexsc law, as a model of a Basilisk simulation.

`Spacecraft` moves like the scenario's body with its flexible appendages, exactly between two calls of its
task: it takes a torque and gives its state, in Basilisk's messages. `Controller` is the law of a scenario:
it takes attitude and rate, and gives a torque. Basilisk (`pip install bsk`) has to be installed.

    spacecraft = flexsc.basilisk.Spacecraft(flexsc.Scenario.example("earth-observer"))
    spacecraft.cmdTorqueInMsg.subscribeTo(controller.cmdTorqueOutMsg)
    controller.attNavInMsg.subscribeTo(spacecraft.attNavOutMsg)
    simulation.AddModelToTask("task", spacecraft)
    simulation.AddModelToTask("task", controller)

The names of messages are Basilisk's. Attitudes are modified Rodrigues parameters, from the inertial frame to
the body frame; translation is not part of the scenario's motion, and is 0 in the messages.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from flexsc._scenario import Scenario
from flexsc._simulator import Simulator
from flexsc.parts import Actuator, Demanded, Reading, Sensor, Truth

if TYPE_CHECKING:
    # As far as this module uses them; Basilisk has no types of its own.
    messaging: Any

    class _SysModel:
        ModelTag: str
        moduleID: int

else:
    try:
        from Basilisk.architecture import messaging
        from Basilisk.architecture.sysModel import SysModel as _SysModel
    except ModuleNotFoundError as error:
        text = f"flexsc.basilisk needs Basilisk: pip install bsk ({error})"
        raise ModuleNotFoundError(text, name="Basilisk") from error

__all__ = ["Controller", "Spacecraft", "attitude_of", "mrp_of"]

_NANO = 1e-9


def mrp_of(attitude: Iterable[float]) -> list[float]:
    """Return the modified Rodrigues parameters of an attitude (w, x, y, z), at most a turn of 180 degrees.

    >>> from flexsc.basilisk import mrp_of
    >>> mrp_of([1.0, 0.0, 0.0, 0.0])
    [0.0, 0.0, 0.0]
    """
    w, *vector = (float(part) for part in attitude)
    sign = -1.0 if w < 0.0 else 1.0
    return [sign * part / (1.0 + sign * w) for part in vector]


def attitude_of(sigma: Iterable[float]) -> list[float]:
    """Return the attitude (w, x, y, z) of modified Rodrigues parameters.

    >>> from flexsc.basilisk import attitude_of
    >>> attitude_of([0.0, 0.0, 1.0])
    [0.0, 0.0, 0.0, 1.0]
    """
    vector = [float(part) for part in sigma]
    square = sum(part * part for part in vector)
    return [(1.0 - square) / (1.0 + square), *(2.0 * part / (1.0 + square) for part in vector)]


class Spacecraft(_SysModel):
    """The spacecraft of a scenario: a torque in, its state out.

    At each call of its task it moves to the present time under the torque that it had at its last call, and
    gives its state. A torque that is commanded at a time acts from that time on, through the scenario's
    actuator with its limits. The scenario's own law acts until a message with a torque is connected.

    Args:
        scenario: A scenario of three axes. Its duration has to last as long as the simulation.
        run: Number of the run, which selects its noise.
    """

    def __init__(self, scenario: Scenario, run: int = 0) -> None:
        super().__init__()
        self.ModelTag = scenario.name
        self.scStateOutMsg = messaging.SCStatesMsg()
        """True attitude and rate."""
        self.attNavOutMsg = messaging.NavAttMsg()
        """Attitude and rate by the scenario's sensors and estimator, at their last sample."""
        self.rwSpeedOutMsg = messaging.RWSpeedMsg()
        """Speeds of the wheels (rad/s), of a scenario with wheels."""
        self.cmdTorqueInMsg = messaging.CmdTorqueBodyMsgReader()
        """Commanded torque (N m) in body axes."""
        self.scenario = scenario
        self._run = run
        self._start(0)

    def _start(self, nanos: int) -> None:
        self.simulator = Simulator(self.scenario, self._run)
        """The run, whose `result` and `to_mcap` are those of the simulation so far."""
        if self.simulator.axes != 3:
            raise ValueError(f"{self.scenario.name} has one axis, and Basilisk's messages three")
        self._began = self._reached = nanos
        self._command: list[float] | None = None

    def Reset(self, CurrentSimNanos: int) -> None:
        """Begin the run anew: Basilisk calls it before the first step."""
        self._start(CurrentSimNanos)
        self._write(CurrentSimNanos)

    def UpdateState(self, CurrentSimNanos: int) -> None:
        """Move to the present time and give the state: Basilisk calls it at the rate of the task."""
        step = CurrentSimNanos - self._reached
        if step > 0:
            # A command of this very time, by a model before this one, acts from now on.
            self._read(before=CurrentSimNanos)
            if self.simulator.time + step * _NANO > self.scenario.duration * (1.0 + 1e-12):
                raise ValueError(
                    f"{self.scenario.name} lasts {self.scenario.duration:g} s: set a longer `duration`, "
                    f'with_("duration", ...)'
                )
            self.simulator.step(self._command, step * _NANO)
            self._reached = CurrentSimNanos
        self._read(before=CurrentSimNanos + 1)
        self._write(CurrentSimNanos)

    def _read(self, before: int) -> None:
        """Take the commanded torque if it was written before a time."""
        message = self.cmdTorqueInMsg
        if not message.isLinked():
            return
        if not message.isWritten():
            self._command = [0.0, 0.0, 0.0]
        elif message.timeWritten() < before:
            self._command = list(message().torqueRequestBody)

    def _write(self, nanos: int) -> None:
        state, estimate = self.simulator.state, self.simulator.believed
        sigma, omega = mrp_of(state["attitude"]), [float(rate) for rate in state["rate"]]
        true = messaging.SCStatesMsgPayload()
        true.sigma_BN, true.omega_BN_B = sigma, omega
        self.scStateOutMsg.write(true, nanos, self.moduleID)
        known = messaging.NavAttMsgPayload()
        known.timeTag = (nanos - self._began) * _NANO
        known.sigma_BN = mrp_of(self.simulator._native.estimated_attitude() or state["attitude"])
        known.omega_BN_B = [float(rate) for rate in estimate["rate"]]
        self.attNavOutMsg.write(known, nanos, self.moduleID)
        if "wheel_speeds" in state:
            speeds = messaging.RWSpeedMsgPayload()
            listed = [float(speed) for speed in state["wheel_speeds"]]
            speeds.wheelSpeeds = listed + [0.0] * (len(speeds.wheelSpeeds) - len(listed))
            self.rwSpeedOutMsg.write(speeds, nanos, self.moduleID)


class Controller(_SysModel):
    """The law of a scenario: attitude and rate in, a torque out.

    At each call of its task, the law's sensor reads the message, and a law whose sample it is commands a
    torque about each axis, before the actuator. The law has the scenario's targets, inertia and settings;
    the motion of the scenario's own body is not used.

    Args:
        scenario: A scenario of three axes with a sampled law and without an estimator, which would need its
        own sensors:
            `scenario.without("estimator")`.
        period: Period of the task (s); the law's period is a multiple of it.
    """

    def __init__(self, scenario: Scenario, period: float) -> None:
        super().__init__()
        if scenario.get("estimator") is not None:
            raise ValueError(
                f'{scenario.name}: its estimator reads sensors of its own; leave it out, without("estimator")'
            )
        self.ModelTag = f"{scenario.name} law"
        self.attNavInMsg = messaging.NavAttMsgReader()
        """Attitude and rate that the law reads."""
        self.cmdTorqueOutMsg = messaging.CmdTorqueBodyMsg()
        """Commanded torque (N m) in body axes."""
        self._port = _MessageSensor(period)
        self._demand = _TorqueDemand()
        self._period = period
        single: dict[str, object] = {
            "sensor": {"sampled": {"period": period, "rate_noise": 1e-9}},
            "actuator": {"ideal": {}},
        }
        self.scenario = scenario.with_(single).with_parts(sensor=self._port, actuator=self._demand)
        self._simulator: Simulator | None = None
        self._began = 0

    def Reset(self, CurrentSimNanos: int) -> None:
        """Begin anew: the law starts at the next call."""
        self._simulator = None
        self._demand.torque = [0.0] * 3
        self.cmdTorqueOutMsg.write(messaging.CmdTorqueBodyMsgPayload(), CurrentSimNanos, self.moduleID)

    def UpdateState(self, CurrentSimNanos: int) -> None:
        """Let the law decide on the present message: Basilisk calls it at the rate of the task."""
        message = self.attNavInMsg()
        self._port.attitude = attitude_of(message.sigma_BN)
        self._port.rate = list(message.omega_BN_B)
        if self._simulator is None:
            self._simulator = Simulator(self.scenario)
            self._began = CurrentSimNanos
        now, last = (CurrentSimNanos - self._began) * _NANO, self.scenario.duration
        if now > last * (1.0 + 1e-12):
            raise ValueError(f'the law lasts {last:g} s: set a longer `duration`, with_("duration", ...)')
        # Half a period later, everything that is due now has been done.
        time = min(now + 0.5 * self._period, last)
        if time < self._simulator.time:
            raise ValueError(f"the period of the task is not the {self._period:g} s of the law's sensor")
        self._simulator.run_until(time)
        payload = messaging.CmdTorqueBodyMsgPayload()
        payload.torqueRequestBody = self._demand.torque
        self.cmdTorqueOutMsg.write(payload, CurrentSimNanos, self.moduleID)


class _MessageSensor(Sensor):
    """A sensor that reads what a message said. All copies are one object."""

    rate_noise = 0.0
    attitude: Sequence[float] = (1.0, 0.0, 0.0, 0.0)
    rate: Sequence[float] = (0.0, 0.0, 0.0)

    def __init__(self, period: float) -> None:
        self.period = period

    def read(self, truth: Truth) -> Reading:
        return Reading(attitude=self.attitude, rate=self.rate)

    def copy(self) -> _MessageSensor:
        return self


class _TorqueDemand(Actuator):
    """An actuator that keeps the demanded torque, and gives none. All copies are one object."""

    torque: list[float] = [0.0, 0.0, 0.0]  # noqa: RUF012

    def command(self, demanded: Demanded) -> list[float]:
        self.torque = list(demanded.values)
        return [0.0, 0.0, 0.0]

    def copy(self) -> _TorqueDemand:
        return self
