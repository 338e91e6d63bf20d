"""Linear models, in continuous time or sampled exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from flexsc import _native as engine
from flexsc._deprecated import with_old_members
from flexsc._named import Brief, library
from flexsc._numpy import np, npt
from flexsc._signal import Signal, positions
from flexsc._values import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._margins import CommonMargins
    from flexsc._simulator import Simulator
    from flexsc._simulators import Simulators


Break = Literal["command", "torque", "measurement"]
"""The point at which a loop is opened."""


@with_old_members
@dataclass(frozen=True, eq=False, repr=False)
class Linear(Brief):
    """A linear model: x' = a x + b u, y = c x + d u, or with a sampling period x[k+1] = a x[k] + b u[k].

    >>> model = flexsc.Scenario.example("relay-fixed").linearise()
    >>> model.a.shape, [state.name for state in model.states[:3]]
    ((6, 6), ['rigid_angle', 'rigid_rate', 'mode0_displacement'])
    """

    a: npt.NDArray[np.float64]
    """Shape (states, states).

    >>> model.a.shape
    (6, 6)
    """
    b: npt.NDArray[np.float64]
    """Shape (states, inputs).

    >>> model.b.shape                                                   # the torque of the actuator
    (6, 1)
    """
    c: npt.NDArray[np.float64]
    """Shape (outputs, states).

    >>> model.c.shape
    (8, 6)
    """
    d: npt.NDArray[np.float64]
    """Shape (outputs, inputs).

    >>> model.d.tolist()[0]
    [0.0]
    """
    states: tuple[Signal, ...]
    """The names and units of the states.

    >>> [state.unit for state in model.states[:2]]
    ['rad', 'rad/s']
    """
    inputs: tuple[Signal, ...]
    """The names and units of the inputs.

    >>> model.inputs
    (Signal(name='torque', unit='rad/s²'),)
    """
    outputs: tuple[Signal, ...]
    """The names and units of the outputs.

    >>> [output.name for output in model.outputs[:2]]
    ['angle', 'rate']
    """
    period: float | None = None
    """Sampling period (s); None for continuous time.

    >>> model.period is None, flexsc.Scenario.example("relay-fixed").linearise(period=0.5).period
    (True, 0.5)
    """

    @classmethod
    def _of(cls, model: engine._Model) -> Linear:
        """Return a model of the engine."""
        matrices, signals, period = model
        states, inputs, outputs = (tuple(Signal(*each) for each in kind) for kind in signals)
        return cls(*matrices, states, inputs, outputs, period)

    def eigenfrequencies(self) -> npt.NDArray[np.float64]:
        """Return the natural frequencies |s| of the poles (rad/s), increasing; a pair of poles counts once.

        For a sampled model s = log(z)/period, below the Nyquist frequency. Rigid motion has the frequency 0.

        >>> flexsc.Scenario.example("relay-fixed").linearise().eigenfrequencies()
        array([0.   , 0.   , 0.44 , 0.755])
        """
        poles: Any = np.linalg.eigvals(self.a).astype(np.complex128)
        if self.period is not None:
            # What was a state for one period alone has no frequency.
            poles = np.log(poles[np.abs(poles) > 1e-12]) / self.period
        upper = poles[poles.imag >= 0.0]
        # Two rigid poles come out of rounding as a pair near 0.
        found = np.where(np.abs(upper) < 1e-7 * max(1.0, np.abs(upper).max(initial=0.0)), 0.0, np.abs(upper))
        missing = self._rigid() - int(np.count_nonzero(found == 0.0))
        return np.sort(np.concatenate([found, np.zeros(max(missing, 0))]))

    def poles(self) -> dict[str, npt.NDArray[Any]]:
        """Return the poles with their frequencies and damping ratios, by increasing frequency.

        Returns:
            Columns of shape (states,): `pole`, s (1/s) or for a sampled model z; `frequency`, the natural
            frequency |s| (rad/s); and `damping`, the damping ratio -Re(s)/|s|, negative for an unstable pole.
            For a sampled model s = log(z)/period, below the Nyquist frequency; a pole z = 0 has an infinite
            frequency. Rigid motion has the frequency 0 and no damping ratio (NaN).

        >>> poles = flexsc.Scenario.example("relay-sampled").linearise().poles()
        >>> poles["frequency"][2::2].round(3), poles["damping"][2::2].round(3)
        (array([ 0.62,  1.45,  2.9 ,  5.3 , 10.  ]), array([0.003, 0.004, 0.005, 0.005, 0.006]))
        """
        from flexsc._frequency_response import poles

        return poles(self)

    def frequency_grid(self) -> npt.NDArray[np.float64]:
        """Return frequencies (rad/s) that follow the resonances, on which `response` and figures are.

        They are 1 % apart from a tenth of the lowest natural frequency to ten times the highest, or to the
        Nyquist frequency of a sampled model, and as dense about each pole as its resonance is narrow: the
        largest value on them is within 1e-6 of the true peak if it is at least four times the rest of the
        response there.

        >>> grid = flexsc.Scenario.example("relay-sampled").linearise().frequency_grid()
        >>> grid[[0, -1]].round(3), int((abs(grid - 0.62) < 0.003 * 0.62).sum()) > 200
        (array([6.2e-02, 1.0e+02]), True)
        """
        from flexsc._frequency_response import frequency_grid

        return frequency_grid(self)

    def response(self, frequencies: npt.ArrayLike | None = None) -> npt.NDArray[np.complex128]:
        """Return the frequency response c (s - a)^-1 b + d at s = jw, or at z = exp(jw period).

        Args:
            frequencies: Frequencies w (rad/s) of shape (frequencies,); if omitted, `frequency_grid()`.

        Returns:
            Complex numbers of shape (frequencies, outputs, inputs), NaN at a frequency that is a pole.

        >>> model = flexsc.Scenario.example("relay-sampled").linearise().select(outputs=["angle"])
        >>> model.response([0.01, 0.02]).shape
        (2, 1, 1)

        Raises:
            ValueError: The frequencies are not finite numbers of this shape.
        """
        from flexsc._frequency_response import response

        return response(self, frequencies)

    def bode(
        self, axes: tuple[Axes, Axes] | None = None, frequencies: npt.ArrayLike | None = None
    ) -> tuple[Axes, Axes]:
        """Draw the frequency response: `flexsc.plot.bode`, for magnitude (dB) and phase (degrees).

        >>> import matplotlib; matplotlib.use("agg")
        >>> magnitude, phase = flexsc.Scenario.example("rotation-robust").linearise(loop="command").bode()

        Raises:
            ValueError: There would be more than 24 lines, or the frequencies are not accepted.
            ImportError: Matplotlib is not installed.
        """
        from flexsc.plot import bode

        return bode(self, axes, frequencies)

    def nichols(self, ax: Axes | None = None, frequencies: npt.ArrayLike | None = None) -> Axes:
        """Draw a Nichols chart: `flexsc.plot.nichols`, phase (degrees) against magnitude (dB).

        >>> import matplotlib; matplotlib.use("agg")
        >>> axes = flexsc.Scenario.example("rotation-robust").linearise(loop="command").nichols()

        Raises:
            ValueError: There would be more than 24 lines, or the frequencies are not accepted.
            ImportError: Matplotlib is not installed.
        """
        from flexsc.plot import nichols

        return nichols(self, ax, frequencies)

    def spectral_radius(self) -> float:
        """Return the largest magnitude |z| of the poles of a sampled model: it is stable below 1.

        Raises:
            ValueError: The model is one of continuous time.

        >>> scenario = flexsc.Scenario.example("earth-observer")
        >>> scenario.linearise(loop="command").closed().spectral_radius() < 1.0
        True
        """
        if self.period is None:
            raise ValueError(
                "only a sampled model has a spectral radius: give `linearise` a period or a loop"
            )
        return float(np.abs(np.linalg.eigvals(self.a)).max(initial=0.0))

    def _rigid(self) -> int:
        """The number of poles at rest."""
        at_rest = self.a if self.period is None else self.a - np.eye(len(self.a))
        return 2 * (len(self.a) - int(np.linalg.matrix_rank(at_rest)))

    def select(self, inputs: Sequence[str] | None = None, outputs: Sequence[str] | None = None) -> Linear:
        """Return the model with only the named inputs and outputs.

        >>> flexsc.Scenario.example("relay-fixed").linearise().select(outputs=["angle"]).c.shape
        (1, 6)

        Raises:
            KeyError: There is no signal of this name.
        """
        into, out = positions(inputs, self.inputs), positions(outputs, self.outputs)
        return Linear(
            self.a,
            self.b[:, into],
            self.c[out],
            self.d[out][:, into],
            self.states,
            tuple(self.inputs[k] for k in into),
            tuple(self.outputs[k] for k in out),
            self.period,
        )

    def sampled(self, period: float, delay: float = 0.0) -> Linear:
        """Return the exact model at samples `period` (s) apart: inputs are held and act `delay` (s) late.

        Inputs still in the delay are states, after the others.

        >>> flexsc.Scenario.example("relay-fixed").linearise().sampled(0.5, delay=0.7).a.shape
        (8, 8)

        Raises:
            ValueError: The model is sampled already, or a time is not accepted.
        """
        if self.period is not None:
            raise ValueError("a model that is sampled already cannot be sampled")
        a, b, waiting = engine.sampled(self.a, self.b, period, delay)
        c = np.hstack([self.c, np.zeros((len(self.c), len(a) - len(self.a)))])
        under_way = tuple(
            Signal(f"{signal.name}_{back + 1}_ago", signal.unit)
            for back in range(waiting)
            for signal in self.inputs
        )
        states = self.states + under_way
        return Linear(a, b, c, self.d, states, self.inputs, self.outputs, period)

    def closed(self) -> Linear:
        """Close the loop that `linearise(loop=...)` opened: the inputs are added at the break.

        >>> scenario = flexsc.Scenario.example("rotation-robust")
        >>> scenario.linearise(loop="command").closed().spectral_radius() < 1.0
        True
        """
        if self.b.shape[1] != self.c.shape[0]:
            raise ValueError("only a model with as many outputs as inputs can be closed as a loop")
        # What the outputs of one sample pass on to later ones of the same model: 1 + d has an inverse.
        back = np.linalg.inv(np.eye(len(self.d)) + self.d)
        a = self.a - self.b @ back @ self.c
        return Linear(
            a,
            self.b @ back,
            back @ self.c,
            self.d @ back,
            self.states,
            self.inputs,
            self.outputs,
            self.period,
        )

    def compensator(
        self, gain: npt.ArrayLike, observer: npt.ArrayLike, outputs: Sequence[str] | None = None
    ) -> Linear:
        """Return the compensator of a regulator and an observer that were designed for this model.

        Its inputs are the errors of the measured outputs, its outputs are the commands u = -K x of the
        estimated state: x' = A x + B u + L (y - C x - D u). `Scenario.with_law` makes it a law.

        Args:
            gain: K of shape (inputs, states), as `control.lqr` or `control.dlqr` returns it.
            observer: L of shape (states, outputs), as `control.lqe` or `control.dlqe` returns it.
            outputs: The measured outputs; None for all.

        >>> body = {"planar": {"inertia": 2.0}}
        >>> scenario = flexsc.Scenario({"duration": 60.0, "body": body, "law": {"open": {}}})
        >>> model = scenario.linearise().select(outputs=["angle"])
        >>> law = model.compensator([[2.0, 4.0]], [[2.0], [1.0]])
        >>> scenario.with_law(law, period=0.1).linearise(loop="command").closed().spectral_radius() < 1.0
        True

        Raises:
            KeyError: There is no output of this name.
            ValueError: A matrix has another shape.
        """
        model = self.select(outputs=outputs)
        order, inputs = model.b.shape
        k, into = (np.array(matrix, dtype=np.float64, ndmin=2) for matrix in (gain, observer))
        for name, matrix, shape in (("gain", k, (inputs, order)), ("observer", into, (order, len(model.c)))):
            if matrix.shape != shape:
                raise ValueError(f"{name} must have the shape {shape}, got {matrix.shape}")
        # With the sign of the error, the state is minus the estimate.
        a = model.a - model.b @ k - into @ (model.c - model.d @ k)
        d = np.zeros((inputs, len(model.c)))
        states = tuple(Signal(f"expected_{state.name}", state.unit) for state in model.states)
        return Linear(a, into, k, d, states, model.outputs, model.inputs, model.period)

    def state_of(self, simulator: Simulator | Simulators) -> npt.NDArray[np.float64]:
        """Return the state of the model where a run is, so that the model can continue from there.

        On one axis the state is that of the simulator by its names. On three axes the rigid angles are the
        pointing error less the rotation of the hub by the modes. Torques that still act are states of models
        with a delay shorter than a period. The model describes small deviations from rest: it continues as
        the run does up to the second order of the deviation.

        Args:
            simulator: A run of the scenario of the model, or `Simulators` for many.

        Returns:
            The state, of shape (states,), or (copies, states).

        >>> scenario = flexsc.Scenario.example("relay-sampled")
        >>> sim, model = flexsc.Simulator(scenario), scenario.linearise(period=0.5)
        >>> sim.step(-2.0, 10.0)
        >>> predicted = model.a @ model.state_of(sim) + model.b @ [1.0]
        >>> sim.step(1.0, 0.5)
        >>> bool(abs(predicted - model.state_of(sim)).max() < 1e-12)
        True

        Raises:
            ValueError: The simulator does not have a state of the model, such as that of a filter, a law, or
                a command under way; the text names it.
        """
        from flexsc._model_state import state_of

        return state_of(self, simulator)

    def common_margins(self, inputs: Sequence[str] | None = None) -> CommonMargins:
        """Return the margins of a loop that `linearise(loop=...)` opened: how far its commands may be off.

        The commands are multiplied together by a real factor, or by a complex number of magnitude 1. For a
        loop of one command these are the gain and phase margins of Nyquist's criterion.

        Args:
            inputs: The commands that are off; None for all. The others are as they should be, so their loops
                stay closed. A name without its number, such as `command_roll`, means all samples of that
                command.

        >>> opened = flexsc.Scenario.example("earth-observer").linearise(loop="command")
        >>> margins = opened.common_margins(["command_roll"])
        >>> margins.gain_below < 1.0 < margins.gain_above
        True

        Raises:
            KeyError: There is no command of this name.
            ValueError: The model is no opened loop, or the closed loop is not stable.
        """
        from flexsc._margins import common_margins

        return common_margins(self, inputs)

    def control(self) -> Any:
        """Return the model as a `control.StateSpace` of python-control, which must be installed.

        >>> flexsc.Scenario.example("relay-fixed").linearise().control().nstates  # doctest: +SKIP
        6
        """
        control = library("control", "Linear.control")
        names = {
            kind: [signal.name for signal in signals]
            for kind, signals in (("states", self.states), ("inputs", self.inputs), ("outputs", self.outputs))
        }
        period = 0 if self.period is None else self.period
        return control.ss(self.a, self.b, self.c, self.d, period, remove_useless_states=False, **names)

    def scipy(self) -> Any:
        """Return the model as a `scipy.signal.StateSpace` of SciPy, which must be installed.

        >>> flexsc.Scenario.example("relay-fixed").linearise(period=0.5).scipy().dt     # doctest: +SKIP
        0.5
        """
        signal = library("scipy.signal", "Linear.scipy", "scipy")
        times = {} if self.period is None else {"dt": self.period}
        return signal.StateSpace(self.a, self.b, self.c, self.d, **times)

    def __repr__(self) -> str:
        time = "continuous" if self.period is None else f"every {self.period:g} s"
        parts = {"state": self.states, "input": self.inputs, "output": self.outputs}
        shape = ", ".join(counted(len(signals), part) for part, signals in parts.items())
        return f"<flexsc.Linear {time}: {shape}>"


for _class in (Linear, Signal):
    _class.__module__ = "flexsc"
