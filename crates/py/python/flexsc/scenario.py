"""The parts of a scenario as classes, for editors and type checkers.

    >>> import flexsc
    >>> from flexsc.scenario import Mode, Planar, Relay
    >>> scenario = flexsc.Scenario(
    ...     name="two-sided",
    ...     duration=600.0,
    ...     body=Planar(angle=4.5e-4, modes=[Mode(frequency=0.44, gain=0.0213)]),
    ...     law=Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.31),
    ... )
    >>> scenario.to_dict()["law"]["relay"]["k_t"]
    0.31

Their keys, units and meanings are those of a scenario file. A key that is left out, or None, has its
default. Parts of which a file has several, such as its `[[sensor]]`, are a list. What values have to be is
checked when a scenario is made of them; all mistakes are told at once.
"""

# Made by crates/py/scenario_classes.py: a change here is lost.

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, TypedDict, Union

from flexsc._part import Part

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = [
    "Accelerometer",
    "ActiveDamping",
    "Actuator",
    "Adaptation",
    "Adaptive",
    "Added",
    "Appendage",
    "AppendageDrive",
    "AttitudeAt",
    "AttitudeEstimator",
    "AttitudeFilterInitial",
    "AttitudeLaw",
    "AttitudeTarget",
    "BDot",
    "BangBang",
    "Biquad",
    "Body",
    "Choice",
    "ClampedMode",
    "Command",
    "Common",
    "Compensation",
    "Complementary",
    "Correlated",
    "Cosine",
    "DampingGuards",
    "Dead",
    "Dipole",
    "Distribution",
    "Disturbance",
    "Drag",
    "DragPlate",
    "Drift",
    "DrivePoint",
    "Each",
    "Ei",
    "ElasticStates",
    "Envelope",
    "Environment",
    "Estimator",
    "ExtendedKalman",
    "Extra",
    "Failure",
    "Fault",
    "Filter",
    "FilterForm",
    "Friction",
    "Gain",
    "Given",
    "Gradient",
    "GravityGradient",
    "Groups",
    "Gyro",
    "Harmonic",
    "Hold",
    "Ideal",
    "Imbalance",
    "Initial",
    "Integral",
    "Jets",
    "Kalman",
    "Kepler",
    "Keys",
    "Law",
    "Lead",
    "Log",
    "LogUniform",
    "LowPass",
    "MagneticField",
    "Magnetometer",
    "Magnetorquers",
    "Manoeuvre",
    "Matrices",
    "MinimumEnergy",
    "MinimumPeak",
    "Mode",
    "NamedPoint",
    "Normal",
    "Notch",
    "ObserverForm",
    "Open",
    "Output",
    "Pair",
    "Panels",
    "Pd",
    "PerAxis",
    "Periodic",
    "PhasePlane",
    "Planar",
    "Point",
    "Pointing",
    "Polynomial",
    "Profile",
    "Pulses",
    "Ramp",
    "RandomSearch",
    "Recurrence",
    "RecurrenceWeights",
    "Reference",
    "RelativeNormal",
    "RelativeUniform",
    "Relay",
    "RigidRate",
    "Rotor",
    "Rows",
    "Sampled",
    "Scaled",
    "SceneSpec",
    "Schedule",
    "ScheduledGain",
    "Section",
    "Sensor",
    "Shape",
    "Shaper",
    "Silent",
    "Sine",
    "SineCommand",
    "Sinusoid",
    "SolarPressure",
    "Spacecraft",
    "Spatial",
    "SpatialMode",
    "SpeedBias",
    "Stage",
    "Stages",
    "StarTracker",
    "StateSpace",
    "StuckFailure",
    "StuckFault",
    "Sum",
    "SunSensor",
    "Table",
    "Tachometer",
    "Target",
    "Thermal",
    "Thruster",
    "Thrusters",
    "Tracker",
    "Truth",
    "Turn",
    "Uniform",
    "Unloading",
    "UnscentedKalman",
    "Vector",
    "Wheel",
    "Wheels",
    "Zv",
    "Zvd",
    "Zvdd",
]

Vector: TypeAlias = Union[Sequence[float], "npt.NDArray[Any]"]
"""Numbers in a row: a list, a tuple or an array of shape (n,)."""
Rows: TypeAlias = Union[Sequence[Sequence[float]], "npt.NDArray[Any]"]
"""Rows of numbers: lists in a list, or an array of shape (rows, columns)."""


@dataclass(frozen=True, kw_only=True)
class Accelerometer(Part):
    """The specific force at a point of a spacecraft, for the log alone."""

    _tag: ClassVar[str | None] = "accelerometer"

    period: float
    """Period of its samples (s)."""
    watch_only: bool | None = None
    """That nothing reads it, which has to be said: it is logged and changes nothing. Default: false."""
    point: str | None = None
    """The point of the structure at which it is; default: the first of the body's points."""
    along: Rows | None = None
    """The directions along which it measures, one to three of any length in the hub's axes while nothing is
    bent; default: x, y and z.
    """
    noise: float | Vector | None = None
    """Standard deviation of the white noise along each (m/s²). Default: 0.0."""
    bias: float | Vector | None = None
    """Constant error along each (m/s²). Default: 0.0."""
    bias_random_walk: float | Vector | None = None
    """Random walk of the bias along each (m/s² for the square root of a second). Default: 0.0."""
    resolution: float | Vector | None = None
    """Quantum of the output along each (m/s²); 0 for none. Default: 0.0."""
    scale: float | Vector | None = None
    """Relative error of the scale along each. Default: 0.0."""
    latency: float | None = None
    """Time from a sample to when it is told (s). Default: 0.0."""
    faults: Sequence[Fault] | None = None
    """Times at which it fails."""


@dataclass(frozen=True, kw_only=True)
class ActiveDamping(Part):
    """Active damping."""

    threshold: Vector | None = None
    """Elastic rates beyond which the jets push, about each axis (rad/s); default: 1.5 times the amplitude
    of the limit cycle that the delay makes, and at least what two whole cycles change, of the mode that
    a long burn excites most.
    """
    release: float | None = None
    """Part of the threshold at which they end. Default: 0.5."""
    pulse_width: bool | None = None
    """Whether a pulse is no longer than it takes to stop the elastic motion; else it fills the cycle.
    Default: true.
    """
    predictor: bool | None = None
    """Whether the elastic rate is predicted to the middle of the coming pulse. Default: true."""
    guards: DampingGuards | None = None
    """What keeps it from doing harm."""


@dataclass(frozen=True, kw_only=True)
class Adaptive(Part):
    """The rigid rates and elastic modes of a spatial body, by adaptive observers."""

    _tag: ClassVar[str | None] = "adaptive"

    form: ObserverForm | None = None
    """Form of the observers."""
    trackers: Given | None = None
    """What they track; default: the dominant modes of the body."""
    count: int | None = None
    """How many modes of the body each axis tracks; default: 2, and 1 in the form `recurrence`."""
    merge: float | None = None
    """Ratio of frequencies below which modes of the body are tracked as one. Default: 0.08."""
    cross_axis: bool | None = None
    """Whether an axis accounts for the jets of the others; default: it does in the form `gradient`."""
    frequency_error: float | None = None
    """By which part the frequencies are off at the start. Default: 0.0."""
    influence_error: float | None = None
    """By which part the influences are off at the start. Default: 0.0."""
    adapt: bool | None = None
    """Whether frequencies and influences are identified. Default: true."""


@dataclass(frozen=True, kw_only=True)
class Added(Part):
    """It gives something beside what it should."""

    _tag: ClassVar[str | None] = "added"

    from_: float
    """When it begins (s)."""
    to: float | None = None
    """When it ends (s); default: with the run."""
    about: Literal["roll", "pitch", "yaw"] | None = None
    """The axis of which it fails, on a body with three; default: of all."""
    wheel: int | None = None
    """The wheel that fails, counted from 1; default: all do."""
    thruster: str | None = None
    """The thruster that fails, of jets; default: all do."""
    constant: float | None = None
    """A constant: a torque (N m), of magnetorquers a moment (A m²), of jets a thrust (N). Default: 0.0."""
    sines: Sequence[Sine] | None = None
    """Torques that are sines of the time."""


@dataclass(frozen=True, kw_only=True)
class Appendage(Part):
    """An appendage, clamped to the hub at its root."""

    name: str
    """Name."""
    mass: float
    """Mass (kg)."""
    centre: Vector | None = None
    """Centre of mass from the root (m), in its own axes."""
    inertia: Rows | None = None
    """Inertia tensor about its centre of mass (kg m²), row by row, in its own axes; default: it is a point
    mass.
    """
    at: Vector | None = None
    """Where its root is, from the point O of the spacecraft (m)."""
    turned: Turn | Sequence[Turn] | None = None
    """How its axes are turned against those of the body."""
    drive: AppendageDrive | None = None
    """What turns it during a run about an axis through its root; default: nothing."""
    plate: Literal["x", "y"] | None = None
    """The axis along which a thin plate in the plane of its own x and y stretches: first moments then
    follow from rotations.
    """
    points: Sequence[NamedPoint] | None = None
    """Named points of the appendage, from its root in its own axes."""
    modes: Sequence[ClampedMode] | str | None = None
    """Its modes with the root held: a table, or the path of a CSV file or of results of a finite-element
    program. Without any it is rigid.
    """
    damping: float | Vector | None = None
    """Damping ratios of the modes of results."""
    keep: int | None = None
    """How many of the modes of results are kept, those with the lowest frequencies; default: all."""
    thermal: Thermal | None = None
    """How sunlight bends it; default: it does not."""
    units: Literal["m", "mm"] | None = None
    """The units of results: metres and kilograms where it is left out."""


@dataclass(frozen=True, kw_only=True)
class AppendageDrive(Part):
    """A drive."""

    about: Vector
    """The axis through the root, in the axes of the appendage, of any length but 0."""
    angle: float | None = None
    """Angle at the start (rad), 0 where the appendage is as it is `turned`. Default: 0.0."""
    rate: float | None = None
    """It turns at this rate (rad/s)."""
    from_: float | None = None
    """It begins to turn at this time (s); default: it turns from the start on."""
    until: float | None = None
    """It begins to stop at this time (s); default: it does not."""
    acceleration: float | None = None
    """How fast its rate changes (rad/s²); default: at once."""
    table: Sequence[DrivePoint] | None = None
    """Angles at times, with constant rates between."""
    track: Literal["sun"] | None = None
    """What it follows."""
    normal: Vector | None = None
    """What faces the Sun, a direction in the axes of the appendage across the drive's; default: z."""


@dataclass(frozen=True, kw_only=True)
class AttitudeAt(Part):
    """A row of the table."""

    time: float
    """Time since the target begins (s); of the first row 0."""
    roll: float | None = None
    """Roll (rad). Default: 0.0."""
    pitch: float | None = None
    """Pitch (rad). Default: 0.0."""
    yaw: float | None = None
    """Yaw (rad). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class AttitudeEstimator(Part):
    """Attitude and gyro bias of a spatial body, by a multiplicative extended Kalman filter."""

    _tag: ClassVar[str | None] = "attitude"

    form: FilterForm | Literal["extended", "steady"] | None = None
    """How its gains are found. Default: "extended"."""
    angle_random_walk: float | None = None
    """Angle random walk of the gyro (rad/sqrt(s)), the same about each axis; default: the largest of the
    gyro's own.
    """
    rate_random_walk: float | None = None
    """Rate random walk of the gyro's bias (rad/s^1.5); default: the largest of the gyro's own."""
    attitude_noise: Vector | None = None
    """Standard deviation of a measured attitude about each axis of what measures it (rad); default: the
    sensor's own.
    """
    field_noise: float | None = None
    """Standard deviation of a measured magnetic field along each axis (T); default: the magnetometer's own.
    """
    sun_noise: float | None = None
    """Standard deviation of a measured direction to the Sun (rad); default: the Sun sensor's own."""
    initial: AttitudeFilterInitial | None = None
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] | None = None
    """What the filter takes for attitude and bias at the start. Default: "drawn"."""
    elastic: ElasticStates | None = None
    """Elastic modes that it knows too; none by default."""
    assess: Vector | None = None
    """When the metrics judge the filter, from one time to another (s); always by default."""
    watch_only: bool | None = None
    """Whether it is there to be assessed only: no law reads it."""


@dataclass(frozen=True, kw_only=True)
class AttitudeFilterInitial(Part):
    """Standard deviations of an attitude filter's estimate at the start, the same about each axis."""

    angle: float | None = None
    """Of the attitude (rad). Default: 0.001."""
    bias: float | None = None
    """Of the bias (rad/s). Default: 1e-05."""


@dataclass(frozen=True, kw_only=True)
class AttitudeLaw(Part):
    """Sampled feedback of the attitude, as an acceleration."""

    _tag: ClassVar[str | None] = "attitude"

    period: float
    """Period of its samples (s)."""
    bandwidth: float
    """Bandwidth wn (rad/s): the natural frequency of the error of a rigid body."""
    damping: float | None = None
    """Damping ratio zeta of the error. Default: 0.7."""
    inertia: Rows | None = None
    """The inertia tensor that the law takes a body with three axes to have (kg m²), row by row; default:
    that which it has.
    """
    error: Literal["quaternion", "rodrigues"] | None = None
    """How a rotation counts as an error, on a body with three axes."""
    integral: Integral | None = None
    """The integral of the error; none by default."""
    rate_limit: float | None = None
    """Largest rate at which an error is taken back (rad/s); no limit by default."""
    filters: Sequence[Filter] | None = None
    """What the fed-back acceleration goes through, in this order."""


@dataclass(frozen=True, kw_only=True)
class AttitudeTarget(Part):
    """An attitude to turn to: yaw, then pitch about the turned axis, then roll about the one turned twice.
    """

    from_: float
    """From when on (s)."""
    frame: Literal["inertial", "nadir", "sun"] | None = None
    """The axes that its attitude is from."""
    roll: float | None = None
    """Roll (rad). Default: 0.0."""
    pitch: float | None = None
    """Pitch (rad). Default: 0.0."""
    yaw: float | None = None
    """Yaw (rad). Default: 0.0."""
    acceleration: float | None = None
    """Largest acceleration of a turn about one axis to it (rad/s²); default: it is there at once."""
    rate_limit: float | None = None
    """Largest rate of that turn (rad/s); no limit by default."""
    profile: Literal["trapezoid", "versine"] | None = None
    """How the rate of that turn rises and falls."""
    command: Command | None = None
    """In place of `acceleration`, a command planned for the turn, which may leave modes at rest."""
    duration: float | None = None
    """How long the turn by that command takes (s)."""
    shaper: Shaper | None = None
    """What takes modes out of the turn: its acceleration is convolved with impulses."""
    table: Sequence[AttitudeAt] | None = None
    """In place of one attitude, a table in time: splines of roll, pitch and yaw, at rest at both ends."""


@dataclass(frozen=True, kw_only=True)
class BDot(Part):
    """Magnetic moments against the change of the field, of a body that tumbles."""

    _tag: ClassVar[str | None] = "b_dot"

    period: float
    """Period of its commands (s)."""
    gain: float
    """Moment for each unit of the change of the field (A m² s/T)."""


@dataclass(frozen=True, kw_only=True)
class BangBang(Part):
    """Full one way, then full the other: the least peak that turns the rigid body."""

    _tag: ClassVar[str | None] = "bang_bang"


@dataclass(frozen=True, kw_only=True)
class Biquad(Part):
    """b0 + b1/z + b2/z² over 1 + a1/z + a2/z², as they are."""

    _tag: ClassVar[str | None] = "biquad"

    b: Vector
    """b0, b1, b2."""
    a: Vector
    """a1, a2."""


@dataclass(frozen=True)
class Choice(Part):
    """One of these values, each as likely."""

    _tag: ClassVar[str | None] = "choice"
    _holds_one: ClassVar[bool] = True

    value: Vector


@dataclass(frozen=True, kw_only=True)
class ClampedMode(Part):
    """A mode of an appendage clamped at its root, mass-normalised: the integral of phi_i . phi_j dm is 1
    for i = j, else 0. Vectors are in the axes of the appendage, and r is the position from its root.
    """

    frequency: float
    """Natural frequency O with the root held (rad/s)."""
    damping: float | None = None
    """Damping ratio zeta with the root held: 0 undamped, 1 critical. Default: 0.0."""
    translation: Vector | None = None
    """Participation in translation, the integral of phi dm (sqrt(kg))."""
    along: Vector | None = None
    """Of a point mass, in place of `translation`: the direction in which the whole of it swings, of any
    length.
    """
    rotation: Vector | None = None
    """Participation in rotation about the root, the integral of r x phi dm (sqrt(kg) m)."""
    moments: Rows | None = None
    """First moments about the root, the integral of r phi' dm (sqrt(kg) m), row by row: rows along r,
    columns along phi.
    """
    displacement: float | None = None
    """Modal displacement at the start (m sqrt(kg)). Default: 0.0."""
    rate: float | None = None
    """Its rate at the start (m sqrt(kg)/s). Default: 0.0."""
    shapes: Mapping[str, Shape] | None = None
    """The mode's shape at each point of the appendage, by the point's name, against the held root."""


@dataclass(frozen=True)
class Common(Part):
    """All by one ratio."""

    _tag: ClassVar[str | None] = "common"
    _holds_one: ClassVar[bool] = True

    value: Profile


@dataclass(frozen=True, kw_only=True)
class Compensation(Part):
    """What drives take the friction of their wheels to be."""

    coulomb: float | Vector | None = None
    """Coulomb friction (N m), of each or of all. Default: 0.0."""
    viscous: float | Vector | None = None
    """Viscous friction (N m s/rad), of each or of all. Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Complementary(Part):
    """Constant ones that give the error a bandwidth and a damping ratio."""

    _tag: ClassVar[str | None] = "complementary"

    bandwidth: float
    """Bandwidth (rad/s): below it the attitude is that of the sensors, above it that of the gyro."""
    damping: float | None = None
    """Damping ratio. Default: 0.7."""


@dataclass(frozen=True, kw_only=True)
class Correlated(Part):
    """Keys of `[uncertain]` that are drawn together. Behind each stands a standard normal number: these
    numbers have the correlations, and each key keeps its own distribution. Of normal distributions they
    are the correlations themselves.
    """

    keys: Sequence[str]
    """The keys."""
    matrix: Rows
    """The correlations: symmetric, with ones on the diagonal, in the order of the keys."""


@dataclass(frozen=True, kw_only=True)
class Cosine(Part):
    """A series of cosines ([Rotation], equations (25) to (30))."""

    _tag: ClassVar[str | None] = "cosine"

    suppress: int | None = None
    """So many modes of the lowest frequencies. Default: 0."""
    zeros: Sequence[Target] | None = None
    """Zeros beside them."""


@dataclass(frozen=True, kw_only=True)
class DampingGuards(Part):
    """Guards of active damping."""

    dead_zone: bool | None = None
    """No pulse that would kick the rigid motion out of the dead zone. Default: true."""
    eligibility: bool | None = None
    """Without the predictor, only modes whose phase factor is 0.5 or more. Default: true."""
    residual: bool | None = None
    """Only while the observer's innovations are small. Default: true."""
    watchdog: bool | None = None
    """A pause where the pushes do not help. Default: true."""


@dataclass(frozen=True, kw_only=True)
class Dead(Part):
    """It gives nothing."""

    _tag: ClassVar[str | None] = "dead"

    from_: float
    """When it begins (s)."""
    to: float | None = None
    """When it ends (s); default: with the run."""
    about: Literal["roll", "pitch", "yaw"] | None = None
    """The axis of which it fails, on a body with three; default: of all."""
    wheel: int | None = None
    """The wheel that fails, counted from 1; default: all do."""
    thruster: str | None = None
    """The thruster that fails, of jets; default: all do."""


@dataclass(frozen=True, kw_only=True)
class Dipole(Part):
    """A magnetic moment in the field of a dipole."""

    moment: Vector
    """Magnetic moment of the body (A m²), in its axes."""
    strength: float | None = None
    """Field over the magnetic equator at the radius R of a circular orbit (T), mu/R³: around the Earth mu
    is 7.8e15 T m³; left out, the environment's magnetic field counts.
    """
    inclination: float | None = None
    """Inclination of that orbit to the magnetic equator (rad)."""
    from_node: float | None = None
    """Angle from the ascending node at the start (rad)."""
    orbit_rate: float | None = None
    """Rate of that orbit (rad/s)."""
    local: Vector | None = None
    """How the local axes lie at the start, as of a gravity gradient."""


@dataclass(frozen=True, kw_only=True)
class Disturbance(Part):
    """A disturbance: a torque about an axis, or a force at a point."""

    about: Literal["roll", "pitch", "yaw"] | None = None
    """The axis about which it acts, of a body with three."""
    torque: float | None = None
    """Torque (N m). Default: 0.0."""
    sines: Sequence[Sine] | None = None
    """Sines of the time in the torque beside it, of a `[spacecraft]`."""
    force: Vector | None = None
    """In place of a torque, on a body with three axes a force in its axes (N): a leak, a jet that is stuck,
    a push.
    """
    point: str | None = None
    """Name of the point at which the force acts; default: the first."""
    noise: float | None = None
    """Spectral density of a white noise in the torque beside it ((N m)² s): each draw is held for `period`.
    Default: 0.0.
    """
    pulse: Pulses | None = None
    """Pulses in place of a steady torque or force."""
    period: float | None = None
    """How long a draw of the noise is held (s)."""
    from_: float | None = None
    """When it begins (s). Default: 0.0."""
    to: float | None = None
    """When it ends (s); default: with the run."""


@dataclass(frozen=True, kw_only=True)
class Drag(Part):
    """Drag of the atmosphere."""

    density: float
    """Density at a distance of the orbit's semi-major axis (kg/m³)."""
    plates: Sequence[DragPlate]
    """The plates."""
    scale_height: float | None = None
    """Height in which it falls to 1/e (m); default: it is the same everywhere."""
    coefficient: float | None = None
    """Drag coefficient. Default: 2.2."""
    rotation: float | None = None
    """How fast the atmosphere turns with the planet (rad/s); default: as the Earth does. Default:
    7.292115e-05.
    """


@dataclass(frozen=True, kw_only=True)
class DragPlate(Part):
    """A plate, of which one side counts."""

    area: float
    """Area (m²)."""
    normal: Vector
    """Its outward normal in the body's axes, of any length."""
    at: Vector
    """Its middle (m): from the point O of a spacecraft, or from the centre of mass of a spatial body."""


@dataclass(frozen=True, kw_only=True)
class DrivePoint(Part):
    """An angle at a time."""

    time: float
    """Time since the start (s)."""
    angle: float
    """Angle (rad)."""


@dataclass(frozen=True)
class Each(Part):
    """Each by its own, in the order of the modes."""

    _tag: ClassVar[str | None] = "each"
    _holds_one: ClassVar[bool] = True

    value: Sequence[Profile]


@dataclass(frozen=True, kw_only=True)
class Ei(Part):
    """Extra insensitive: three impulses that leave a little vibration, and little more over a wider band."""

    _tag: ClassVar[str | None] = "ei"

    modes: Sequence[int] | None = None
    """Indices of the modes."""
    vibration: float | None = None
    """Vibration that is left at the mode's frequency, relative to that of one impulse. Default: 0.05."""


@dataclass(frozen=True, kw_only=True)
class ElasticStates(Part):
    """Elastic modes as states of the filter."""

    modes: Sequence[int]
    """Which free modes, by their index."""
    noise: float
    """By how much random forces let the rate of each mode walk (m sqrt(kg)/s^1.5)."""
    frequencies: Vector | None = None
    """Their natural frequencies as the filter knows them (rad/s); default: the body's own."""
    factor: float | None = None
    """What these are multiplied by: the filter's error. Default: 1.0."""
    displacement: float | None = None
    """Standard deviation of each displacement at the start (m sqrt(kg)). Default: 0.001."""
    rate: float | None = None
    """Standard deviation of each rate at the start (m sqrt(kg)/s); default: that of the displacement times
    the frequency.
    """
    feeds: Literal["modes", "hub", "rigid"] | None = None
    """What the law reads: angle and rate as if the body were rigid, or those of the hub; default: rigid."""


@dataclass(frozen=True, kw_only=True)
class Envelope(Part):
    """The envelope of the elastic modes and its window means."""

    _tag: ClassVar[str | None] = "envelope"

    window: float
    """Length of the windows over which the envelope is averaged (s)."""
    form: Literal["dynamic", "trigonometric", "truth"] | None = None
    """How the phasors are followed. Default: "dynamic"."""
    modes: Sequence[Mode] | None = None
    """The modes of the monitor's model; default: they are the body's own."""


@dataclass(frozen=True, kw_only=True)
class Environment(Part):
    """What surrounds a body with three axes. The torques add up."""

    orbit: Kepler | None = None
    """The orbit on which the body is; default: there is none, or one of those below."""
    magnetic_field: MagneticField | None = None
    """The magnetic field of the orbit's planet."""
    sun: Vector | Literal["epoch"] | None = None
    """The direction to the Sun in inertial axes, of any length, or by the date of the start; the orbit's
    planet throws a shadow.
    """
    gravity_gradient: GravityGradient | None = None
    """Gravity gradient of a circular orbit."""
    solar_pressure: SolarPressure | None = None
    """Pressure of sunlight."""
    dipole: Dipole | None = None
    """A magnetic moment of the body in the field of its planet."""
    drag: Drag | None = None
    """Drag of the atmosphere on plates."""
    torque: Vector | None = None
    """A torque that is constant in inertial axes (N m)."""


@dataclass(frozen=True, kw_only=True)
class ExtendedKalman(Part):
    """The motion and the natural frequencies, by an extended Kalman filter."""

    _tag: ClassVar[str | None] = "extended_kalman"

    modes: Sequence[Mode] | None = None
    """The modes of the filter's model; default: they are the body's own at the start."""
    moment_noise: float | None = None
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float | None = None
    """Standard deviation of the measured angle (rad); default: that of the sensor."""
    initial: Initial | None = None
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] | None = None
    """What the filter takes for the state at the start. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] | None = None
    """What makes a mode the dominant one. Default: "excitability"."""
    assess: Vector | None = None
    """When the metrics judge the filter, from one time to another (s); always by default."""
    feeds: Literal["modes", "hub", "rigid"] | None = None
    """What the law reads of it: `modes` for the dominant mode alone, beside angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for those of the body as if it
    were rigid. By default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool | None = None
    """Whether it is there to be assessed only: no law reads it."""
    ratios: Literal["common", "each"] | None = None
    """Which frequencies drift together. Default: "common"."""
    ratio: float | None = None
    """Ratio that the filter takes the frequencies to have at the start. Default: 1.0."""
    ratio_sd: float | None = None
    """Standard deviation of that ratio. Default: 0.03."""
    ratio_rate_sd: float | None = None
    """Standard deviation of its rate at the start, which is taken for 0 (1/s). Default: 0.003."""
    ratio_noise: float | None = None
    """Spectral density of the white noise in a ratio (1/s). Default: 1e-08."""
    ratio_rate_noise: float | None = None
    """Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08."""
    bounds: Vector | None = None
    """`[low, high]` of a ratio; the filter that reaches them has lost the body."""
    substeps: int | None = None
    """Steps in which a period is predicted. Default: 2."""
    gate: float | None = None
    """While the dominant mode's amplitude is below so many standard deviations of the angle, the ratios
    learn nothing. Default: 3.0.
    """


@dataclass(frozen=True, kw_only=True)
class Friction(Part):
    """Friction: c Omega + t sgn Omega of a wheel that turns, and up to its breakaway torque of one at rest.
    """

    coulomb: float | Vector | None = None
    """Coulomb friction t (N m), of each or of all. Default: 0.0."""
    viscous: float | Vector | None = None
    """Viscous friction c (N m s/rad), of each or of all. Default: 0.0."""
    breakaway: float | Vector | None = None
    """Torque up to which the bearing holds a wheel at rest (N m); default: that of Coulomb."""


@dataclass(frozen=True)
class Gain(Part):
    """A constant gain."""

    _tag: ClassVar[str | None] = "gain"
    _holds_one: ClassVar[bool] = True

    value: float


@dataclass(frozen=True, kw_only=True)
class Given(Part):
    """Modes to track about each axis. The influence has an element for each group of jets: roll, pitch,
    yaw, or the axis alone where `cross_axis` is false.
    """

    roll: Sequence[Tracker] | None = None
    """About x."""
    pitch: Sequence[Tracker] | None = None
    """About y."""
    yaw: Sequence[Tracker] | None = None
    """About z."""


@dataclass(frozen=True, kw_only=True)
class Gradient(Part):
    """Recursive gradient with exact pulses."""

    _tag: ClassVar[str | None] = "gradient"

    damping: float | None = None
    """Damping ratio of the modes, which is not identified. Default: 0.005."""
    rigid_gain: float | None = None
    """Gain of the rigid rate: the part of an innovation that it takes. Default: 0.03."""
    elastic_gain: float | None = None
    """Gain of each elastic rate; default: 0.15 for one mode and 0.1 for several."""
    rate: float | None = None
    """Rate of the identification, 0 for none. Sufficient for its convergence: below 0.05 over the number of
    modes. Default: 0.02.
    """
    gate: float | None = None
    """While a mode's elastic rate is below this amplitude (rad/s), its frequency learns nothing. Default:
    5e-06.
    """
    influence_bounds: Vector | None = None
    """Between which multiples of its value at the start an influence is looked for."""
    reach: float | None = None
    """A frequency without bounds of its own is looked for from its value divided by this to its value times
    this. Default: 2.0.
    """


@dataclass(frozen=True, kw_only=True)
class GravityGradient(Part):
    """Gravity gradient."""

    orbit_rate: float | None = None
    """Rate of a circular orbit (rad/s); default: the environment's orbit counts."""
    local: Vector | None = None
    """How the local axes of that orbit lie at the start, a unit quaternion [w, x, y, z] that turns vectors
    of the local axes (x along the velocity, y against the orbit's normal, z nadir) into inertial ones;
    default: they are the inertial ones then.
    """


@dataclass(frozen=True, kw_only=True)
class Groups(Part):
    """The groups: for each axis, names of the thrusters that turn the body about it one way and the other.
    """

    roll: Pair
    """About x."""
    pitch: Pair
    """About y."""
    yaw: Pair
    """About z."""


@dataclass(frozen=True, kw_only=True)
class Gyro(Part):
    """A rate gyro, read in each cycle of the law; the angle, or the attitude, is known exactly."""

    _tag: ClassVar[str | None] = "gyro"

    point: str | None = None
    """The point of the structure at which it is, on a body with three axes; default: the first of the
    body's points.
    """
    period: float | None = None
    """Period of its samples (s); default: that of the law."""
    noise: float | Vector | None = None
    """Standard deviation of the white noise about each axis (rad/s). Default: 0.0."""
    bias: float | Vector | None = None
    """Constant error about each axis (rad/s). Default: 0.0."""
    resolution: float | Vector | None = None
    """Quantum of the output about each axis (rad/s); 0 for none. Default: 0.0."""
    angle_random_walk: float | Vector | None = None
    """Angle random walk about each axis (rad/sqrt(s)), of one that integrates."""
    rate_random_walk: float | Vector | None = None
    """Rate random walk of the bias about each axis (rad/s^1.5), of one that integrates."""
    quantum: float | Vector | None = None
    """Quantum of the angle about each axis (rad), of one that integrates: what is left is counted with the
    next; 0 for none.
    """
    scale: float | Vector | None = None
    """Relative error of the scale about each axis."""
    misalignment: Rows | None = None
    """What each axis, a row, measures of the rates about the others (rad), on a body with three; the
    diagonal is 0.
    """
    faults: Sequence[Fault] | None = None
    """Times at which it fails; where the body points is known all the same."""


@dataclass(frozen=True, kw_only=True)
class Harmonic(Part):
    """A harmonic of the imbalance."""

    order: float
    """Its order k: periods in a turn of the wheel, whole or not."""
    force: float | None = None
    """The force across the axis for each (rad/s)² (kg m). Default: 0.0."""
    torque: float | None = None
    """The torque across the axis for each (rad/s)² (kg m²). Default: 0.0."""
    axial: float | None = None
    """The force along the axis for each (rad/s)² (kg m), as cos(k th + phase). Default: 0.0."""
    phase: float | None = None
    """Its phase (rad). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Hold(Part):
    """In each period the mean of what the manoeuvre commands over it, and the feedback at its start."""

    _tag: ClassVar[str | None] = "hold"

    period: float
    """Period (s)."""
    faults: Sequence[Failure] | None = None
    """Times at which it fails."""


@dataclass(frozen=True, kw_only=True)
class Ideal(Part):
    """The command itself, at every instant."""

    _tag: ClassVar[str | None] = "ideal"

    faults: Sequence[Failure] | None = None
    """Times at which it fails."""


@dataclass(frozen=True, kw_only=True)
class Imbalance(Part):
    """Imbalance of wheels, as the body feels it at their speed Omega and angle th. Each force and torque is
    its coefficient times Omega², along e1 cos(k th + phase) + e2 sin(k th + phase), where e1 is z x a of
    the wheel's axis a, or x of one along z, and e2 is a x e1.
    """

    static: float | Vector | None = None
    """Static imbalance (kg m), of each or of all: the force once a turn. Default: 0.0."""
    dynamic: float | Vector | None = None
    """Dynamic imbalance (kg m²), of each or of all: the torque once a turn. Default: 0.0."""
    phase: float | Vector | None = None
    """By how much the torque is ahead of the force (rad), of each or of all. Default: 0.0."""
    harmonics: Sequence[Harmonic] | None = None
    """What there is beside once a turn, alike for all wheels."""
    point: str | None = None
    """The point of the structure at which the wheels are mounted; default: the first of the body's points.
    """
    positions: Rows | None = None
    """Where each wheel is, from that point (m); default: at it."""


@dataclass(frozen=True, kw_only=True)
class Initial(Part):
    """Standard deviations of a filter's estimate at the start."""

    angle: float | None = None
    """Of the rigid angle (rad). Default: 0.0001."""
    rate: float | None = None
    """Of the rigid rate (rad/s). Default: 0.0001."""
    displacement: float | None = None
    """Of the displacement of the mode with the largest k/w² (rad); of the others a tenth. Default: 0.002."""
    mode_rate: float | None = None
    """Of the rate of that mode (rad/s); of the others a tenth. Default: 0.0006."""


@dataclass(frozen=True, kw_only=True)
class Integral(Part):
    """The integral of the error."""

    time: float
    """Its time constant t (s)."""
    limit: float
    """Largest integral (rad s). It stands still as well while the torque or the rate is at its limit and
    the error would make it larger.
    """


@dataclass(frozen=True, kw_only=True)
class Jets(Part):
    """Thrusters at points of a spatial body."""

    _tag: ClassVar[str | None] = "jets"

    specific_impulse: float
    """Specific impulse (s)."""
    thrusters: Sequence[Thruster]
    """The thrusters."""
    minimum_on: float | None = None
    """Shortest pulse (s). Default: 0.0."""
    quantum: float | None = None
    """Quantum of a pulse's length (s); 0 for none. Default: 0.0."""
    period: float | None = None
    """Period of the pulses (s); default: that of the law."""
    delay: int | None = None
    """Whole cycles from a command to its pulses: 0, or 1 where computing it takes a cycle. Default: 0."""
    allocation: Literal["groups", "least_propellant"] | None = None
    """How what is demanded becomes pulses."""
    force_free: bool | None = None
    """Of `least_propellant`, whether the forces of the pulses shall cancel."""
    groups: Groups | None = None
    """Of `groups`, which of them act together."""
    faults: Sequence[Failure] | None = None
    """Times at which they fail."""


@dataclass(frozen=True, kw_only=True)
class Kalman(Part):
    """The motion, by a Kalman filter with constant natural frequencies."""

    _tag: ClassVar[str | None] = "kalman"

    modes: Sequence[Mode] | None = None
    """The modes of the filter's model; default: they are the body's own at the start."""
    moment_noise: float | None = None
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float | None = None
    """Standard deviation of the measured angle (rad); default: that of the sensor."""
    initial: Initial | None = None
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] | None = None
    """What the filter takes for the state at the start. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] | None = None
    """What makes a mode the dominant one. Default: "excitability"."""
    assess: Vector | None = None
    """When the metrics judge the filter, from one time to another (s); always by default."""
    feeds: Literal["modes", "hub", "rigid"] | None = None
    """What the law reads of it: `modes` for the dominant mode alone, beside angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for those of the body as if it
    were rigid. By default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool | None = None
    """Whether it is there to be assessed only: no law reads it."""


@dataclass(frozen=True, kw_only=True)
class Kepler(Part):
    """A Kepler orbit. Inertial axes are those of the planet's equator: z along its axis of rotation."""

    semi_major_axis: float
    """Semi-major axis (m), of a circular orbit its radius."""
    eccentricity: float | None = None
    """Eccentricity. Default: 0.0."""
    inclination: float | None = None
    """Inclination to the equator (rad). Default: 0.0."""
    node: float | None = None
    """Angle from the inertial x to the ascending node (rad). Default: 0.0."""
    perigee: float | None = None
    """Angle from the node to the perigee (rad). Default: 0.0."""
    anomaly: float | None = None
    """Mean anomaly at the start (rad), of a circular orbit the angle from the perigee. Default: 0.0."""
    gravity: float | None = None
    """The planet's gravity (m³/s²); default: the Earth's. Default: 398600441800000.0."""
    planet_radius: float | None = None
    """Radius of the planet (m), which throws the shadow; default: the Earth's at its equator. Default:
    6378137.0.
    """


@dataclass(frozen=True, kw_only=True)
class Lead(Part):
    """(1 + s/zero)/(1 + s/pole): a lead with the zero below the pole, else a lag."""

    _tag: ClassVar[str | None] = "lead"

    zero: float
    """The zero (rad/s)."""
    pole: float
    """The pole (rad/s)."""


@dataclass(frozen=True, kw_only=True)
class Log(Part):
    """What a full log holds."""

    period: float | None = None
    """Period at which a full log holds the motion (s); default: 0.1 or the first of 0.2, 0.5, 1, 2, 5 and
    so on of which the duration has at most 10 000.
    """
    scene: SceneSpec | None = None
    """How a log with a scene draws the run."""


@dataclass(frozen=True)
class LogUniform(Part):
    """Uniform in the logarithm between two positive values."""

    _tag: ClassVar[str | None] = "log_uniform"
    _holds_one: ClassVar[bool] = True

    value: Vector


@dataclass(frozen=True, kw_only=True)
class LowPass(Part):
    """w²/(s² + 2 zeta w s + w²)."""

    _tag: ClassVar[str | None] = "low_pass"

    frequency: float
    """The frequency w (rad/s)."""
    damping: float | None = None
    """The damping ratio zeta. Default: 0.7071067811865476."""


@dataclass(frozen=True, kw_only=True)
class MagneticField(Part):
    """A tilted dipole: B = (a/R)³ (3 (g.r) r - g) with r the direction from the planet's centre and g,
    which points south.
    """

    coefficients: Vector | None = None
    """The first coefficients g11, h11 and g10 of the field (T), a vector in axes that turn with the planet:
    z along its axis, x through its meridian 0; default: the Earth's of IGRF-13 for 2020.
    """
    radius: float | None = None
    """The radius a at which they are (m); default: the Earth's mean one. Default: 6371200.0."""
    rotation: float | None = None
    """How fast the planet turns (rad/s); default: the Earth's. Default: 7.292115e-05."""
    meridian: float | None = None
    """Angle from the inertial x to the meridian 0 at the start (rad). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Magnetometer(Part):
    """The magnetic field."""

    _tag: ClassVar[str | None] = "magnetometer"

    period: float
    """Period of its samples (s)."""
    point: str | None = None
    """The point of the structure at which it is; default: the first of the body's points."""
    noise: float | Vector | None = None
    """Standard deviation of the white noise along each axis (T). Default: 0.0."""
    bias: float | Vector | None = None
    """Constant error along each axis (T). Default: 0.0."""
    resolution: float | Vector | None = None
    """Quantum of the output along each axis (T); 0 for none. Default: 0.0."""
    scale: float | Vector | None = None
    """Relative error of the scale along each axis. Default: 0.0."""
    misalignment: Rows | None = None
    """What each axis, a row, measures of the field along the others (rad); the diagonal is 0."""
    latency: float | None = None
    """Time from a sample to when it is told (s). Default: 0.0."""
    faults: Sequence[Fault] | None = None
    """Times at which it fails."""


@dataclass(frozen=True, kw_only=True)
class Magnetorquers(Part):
    """Magnetic moments of a spatial body in the field of its planet."""

    _tag: ClassVar[str | None] = "magnetorquers"

    moment: float | Vector
    """Largest magnetic moment along each axis (A m²): one number for all, or three."""
    faults: Sequence[Failure] | None = None
    """Times at which they fail."""


@dataclass(frozen=True, kw_only=True)
class Manoeuvre(Part):
    """A manoeuvre as a scenario describes it. The body's modes rest at its start."""

    _bare: ClassVar[tuple[str, ...]] = ("model", )

    angle: float
    """The angle by which the rigid body turns (rad)."""
    command: Command
    """What turns the body."""
    time: float | None = None
    """Time of the manoeuvre (s). By default, the shortest that the peak torque allows."""
    peak_torque: float | None = None
    """Largest torque (N m); beside a time, a limit that the plan has to keep."""
    start_rate: float | None = None
    """Rate before (rad/s): that of the body at its start. Default: 0.0."""
    end_rate: float | None = None
    """Rate after (rad/s). Default: 0.0."""
    shaper: Shaper | None = None
    """What the command is convolved with; it takes a part of the time."""
    model: Planar | None = None
    """The body that the plan is made for; default: the body itself. A campaign that draws keys of the body
    puts the body as it is written here: the plan does not depend on what is drawn.
    """


@dataclass(frozen=True, kw_only=True)
class Matrices(Part):
    """The matrices of a structure."""

    _tag: ClassVar[str | None] = "matrices"

    mass: Rows | str
    """Mass matrix, symmetric and positive definite (kg m² for angles, kg for displacements)."""
    stiffness: Rows | str
    """Stiffness matrix, symmetric, without strain in the rotation only (N m/rad for angles, N/m for
    displacements).
    """
    coordinates: Sequence[str] | None = None
    """Names of the coordinates; default: `q0`, `q1` and so on."""
    hub: int | None = None
    """Index of the coordinate that is the hub's angle, counted from 0. Default: 0."""
    rotation: Vector | None = None
    """Displacement of each coordinate under a unit rigid rotation; default: only the hub's angle turns, and
    all other coordinates are relative to it.
    """
    drive: Literal["torque", "motion"] | None = None
    """What is commanded. Default: "torque"."""
    damping: float | Vector | None = None
    """Damping ratio of all modes, or one for each that is kept. Default: 0.0."""
    damping_matrix: Rows | str | None = None
    """Damping matrix, symmetric, without resistance to the rotation (N m s/rad for angles, N s/m for
    displacements); it adds to those ratios, and may couple the modes.
    """
    keep: int | None = None
    """How many of the lowest modes are kept; default: all up to 1e3 rad/s."""
    angle: float | None = None
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float | None = None
    """Rigid rate at the start (rad/s). Default: 0.0."""
    outputs: Sequence[Sum] | None = None
    """Sums of coordinates that are observed beside the hub's angle."""


@dataclass(frozen=True, kw_only=True)
class MinimumEnergy(Part):
    """The least integral of the command's square."""

    _tag: ClassVar[str | None] = "minimum_energy"

    suppress: int | None = None
    """So many modes of the lowest frequencies. Default: 0."""
    zeros: Sequence[Target] | None = None
    """Zeros beside them."""


@dataclass(frozen=True, kw_only=True)
class MinimumPeak(Part):
    """The least peak."""

    _tag: ClassVar[str | None] = "minimum_peak"

    suppress: int | None = None
    """So many modes of the lowest frequencies. Default: 0."""


@dataclass(frozen=True, kw_only=True)
class Mode(Part):
    """An elastic mode as a scenario describes it ([Silaev], equation (1), with damping added)."""

    frequency: float
    """Natural frequency w (rad/s)."""
    gain: float
    """Modal gain k: modal acceleration for each unit of the rigid body's."""
    damping: float | None = None
    """Damping ratio zeta: 0 undamped, 1 critical. Default: 0.0."""
    displacement: float | None = None
    """Displacement at the start (rad). Default: 0.0."""
    rate: float | None = None
    """Rate at the start (rad/s). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class NamedPoint(Part):
    """A point of the structure."""

    name: str
    """Name."""
    position: Vector | None = None
    """Position (m): from the centre of mass, of a spacecraft's hub from its point O, of an appendage from
    its root.
    """


@dataclass(frozen=True, kw_only=True)
class Normal(Part):
    """Normal with this mean and standard deviation."""

    _tag: ClassVar[str | None] = "normal"

    mean: float
    """Mean."""
    sd: float
    """Standard deviation."""


@dataclass(frozen=True, kw_only=True)
class Notch(Part):
    """(s² + 2 depth zeta w s + w²)/(s² + 2 zeta w s + w²)."""

    _tag: ClassVar[str | None] = "notch"

    frequency: float
    """The frequency w (rad/s)."""
    depth: float
    """The gain there, below 1."""
    damping: float | None = None
    """The damping ratio zeta of the denominator: the notch is the wider the larger it is. Default: 0.6."""


@dataclass(frozen=True, kw_only=True)
class Open(Part):
    """None: what a scenario with a manoeuvre has by default."""

    _tag: ClassVar[str | None] = "open"


@dataclass(frozen=True, kw_only=True)
class Output(Part):
    """A coordinate that is observed beside the hub's angle: y = rigid x_r + sum modes[i] x_i."""

    name: str
    """Name, such as `tip`."""
    modes: Vector
    """Weight of each mode's displacement, in the order of the modes."""
    unit: str | None = None
    """Unit. Default: "rad"."""
    rigid: float | None = None
    """Weight of the rigid angle. Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Pair(Part):
    """The two groups of an axis."""

    plus: Sequence[str]
    """Those that push to positive rates."""
    minus: Sequence[str]
    """Those that push to negative rates."""


@dataclass(frozen=True, kw_only=True)
class Panels(Part):
    """A hub with panels of hinged sections."""

    _tag: ClassVar[str | None] = "panels"

    hub_inertia: float
    """Moment of inertia of the hub alone (kg m²)."""
    root: float
    """Distance of the first hinge from the axis (m)."""
    sections: Sequence[Section]
    """Sections of each panel, from the hub outwards."""
    count: int | None = None
    """Number of equal panels. Default: 2."""
    kinematics: Literal["linear", "exact"] | None = None
    """How the sections turn. Default: "linear"."""
    tolerance: float | None = None
    """Error of each step of the exact kinematics (rad). Default: 1e-12."""
    drive: Literal["torque", "motion"] | None = None
    """What is commanded. Default: "torque"."""
    damping: float | Vector | None = None
    """Damping ratio of all modes, or one for each that is kept. Default: 0.0."""
    keep: int | None = None
    """How many of the lowest modes are kept; default: all up to 1e3 rad/s."""
    angle: float | None = None
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float | None = None
    """Rigid rate at the start (rad/s). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Pd(Part):
    """Sampled proportional and derivative feedback of the angle."""

    _tag: ClassVar[str | None] = "pd"

    k_p: float
    """Proportional gain (N m/rad; for a wheel, units of its command for each rad)."""
    k_d: float
    """Derivative gain (N m s/rad; without the second where the difference is raw)."""
    period: float
    """Period of its samples (s)."""
    differentiation: Literal["exact", "difference", "raw"] | None = None
    """How the derivative is taken. Default: "exact"."""
    error: Literal["quaternion", "rodrigues"] | None = None
    """How a rotation counts as an error, on a body with three axes."""
    extra: Extra | None = None
    """The extra loop over the dominant mode."""
    limit: float | None = None
    """Largest torque (N m); no limit by default."""
    track: bool | None = None
    """Whether it follows a manoeuvre while it lasts; else it takes over when the manoeuvre ends."""


@dataclass(frozen=True, kw_only=True)
class PerAxis(Part):
    """A law of its own about each of three axes."""

    _tag: ClassVar[str | None] = "per_axis"

    roll: Law
    """About x."""
    pitch: Law
    """About y."""
    yaw: Law
    """About z."""


@dataclass(frozen=True, kw_only=True)
class Periodic(Part):
    """A torque in the body's axes, constant + amplitude sin(2 pi t/period + phase) about each."""

    constant: Vector | None = None
    """Constant part (N m)."""
    amplitude: Vector | None = None
    """Amplitude of the periodic part (N m)."""
    period: float | None = None
    """Its period (s): of a station in a low orbit about 5560 s. Default: 5560.0."""
    phase: Vector | None = None
    """Its phase at the start (rad)."""


@dataclass(frozen=True, kw_only=True)
class PhasePlane(Part):
    """A relay in the phase plane, with pulses of measured length."""

    _tag: ClassVar[str | None] = "phase_plane"

    period: float
    """Cycle of gyro, estimator, law and jets (s)."""
    dead_zone: float
    """Half width of the angles that are left alone (rad)."""
    rate_limit: float
    """Largest rate at which the law turns the body (rad/s)."""
    switch_on: float
    """The jets begin to fire where the rate is further than this from where it should be (rad/s), near and
    beyond the edges of the dead zone where it is less far.
    """
    switch_off: float
    """They end where it is nearer than this (rad/s), at which rate the body returns at least."""
    slope: float | None = None
    """Largest rate of the return for each unit of the angle beyond the dead zone (1/s). Default: 0.05."""
    braking: float | None = None
    """Part of the jets' acceleration that slowing down may take. Default: 0.5."""
    targets: Sequence[AttitudeTarget] | None = None
    """Attitudes to turn to, in the order of their times; before the first it is the inertial one."""
    damping: ActiveDamping | None = None
    """What the jets do against elastic motion while they have nothing else to do; default: nothing."""


@dataclass(frozen=True, kw_only=True)
class Planar(Part):
    """One angle and any number of elastic modes."""

    _tag: ClassVar[str | None] = "planar"

    inertia: float | None = None
    """Moment of inertia (kg m²). By default, it is 1, and every torque is a reduced moment (rad/s²).
    Default: 1.0.
    """
    angle: float | None = None
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float | None = None
    """Rigid rate at the start (rad/s). Default: 0.0."""
    drive: Literal["torque", "motion"] | None = None
    """What is commanded. Default: "torque"."""
    damping_matrix: Rows | None = None
    """Damping that couples the modes, beside their own ratios (1/s): x_i'' has also -sum_j
    `damping_matrix`[i][j] x_j'.
    """
    modes: Sequence[Mode] | None = None
    """Elastic modes."""
    outputs: Sequence[Output] | None = None
    """Coordinates that are observed beside the hub's angle."""


@dataclass(frozen=True, kw_only=True)
class Point(Part):
    """A point of a profile."""

    time: float
    """Time (s)."""
    ratio: float
    """Ratio there."""


@dataclass(frozen=True, kw_only=True)
class Pointing(Part):
    """What is asked of the pointing over a part of the run."""

    window: Vector
    """From when to when (s) the angle beyond the target counts, for the metric `pointing_rms_rad`."""
    rms: float | None = None
    """What its root mean square is to be at most (rad), for the metric `requirement`; default: nothing is
    asked.
    """


@dataclass(frozen=True, kw_only=True)
class Polynomial(Part):
    """A polynomial of the angle."""

    _tag: ClassVar[str | None] = "polynomial"

    degree: int
    """Its degree: 3, 5, 7, 9, 11 or 13."""


@dataclass(frozen=True, kw_only=True)
class Pulses(Part):
    """A train of pulses: on from the start of each period."""

    period: float
    """From the start of one pulse to that of the next (s)."""
    on: float
    """How long each lasts (s)."""


@dataclass(frozen=True, kw_only=True)
class Ramp(Part):
    """From 1 on a straight line to another ratio, which holds from then on."""

    _tag: ClassVar[str | None] = "ramp"

    time: float
    """How long it lasts (s)."""
    to: float
    """The ratio after it."""
    from_: float | None = None
    """When it begins (s). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class RandomSearch(Part):
    """Random search with learning, by the window means of the envelope."""

    _tag: ClassVar[str | None] = "random_search"

    step: float
    """Largest move of the gain in one window, delta `k_t`."""
    bounds: Vector
    """The gain stays between these two."""
    tunes: str | None = None
    """The number of the law that is tuned: `k_t` of a relay, `k_p` or `k_d` of a PD law."""
    tolerance: float | None = None
    """A relative change of the mean below this counts as settled, `delta_0`. Default: 0.05."""
    settled: int | None = None
    """Consecutive settled windows after which the gain is frozen (the paper's six). Default: 6."""
    memory: int | None = None
    """Consecutive falls of the mean after which one rise is ignored (the paper's four); 0 for never.
    Default: 4.
    """
    earliest_freeze: float | None = None
    """The gain is not frozen before this time, `T_min` (s). Default: 10000.0."""
    freeze: bool | None = None
    """Whether the gain is ever frozen. Default: true."""


@dataclass(frozen=True, kw_only=True)
class Recurrence(Part):
    """The recurrence of [Timakov14]."""

    _tag: ClassVar[str | None] = "recurrence"

    damping: float | None = None
    """Damping ratio of the mode, which is not identified. Default: 0.005."""
    coast: RecurrenceWeights | None = None
    """W1 to W3, for cycles in which no thruster fired."""
    active: RecurrenceWeights | None = None
    """W5 to W7, for cycles in which one did."""
    frequency_gain: float | None = None
    """W4 times the amplitude of the elastic rate, kappa. With the weights as they are left out it converges
    below 0.043. Default: 0.006.
    """
    influence_gain: float | None = None
    """W8 times the absolute value of what it learns from. Default: 0.25."""
    gate: float | None = None
    """While the elastic rate is below this amplitude (rad/s), the frequency learns nothing. Default: 5e-06.
    """
    influence_bounds: Vector | None = None
    """Between which multiples of its value at the start the influence is looked for."""
    reach: float | None = None
    """A frequency without bounds of its own is looked for from its value divided by this to its value times
    this. Default: 3.0.
    """


@dataclass(frozen=True, kw_only=True)
class RecurrenceWeights(Part):
    """What parts of an innovation the estimates take."""

    rigid: float
    """The rigid rate: W1 or W5."""
    elastic: float
    """The elastic rate: W2 or W6."""
    next: float
    """The elastic rate of the next sample, taken off: W3 or W7."""


@dataclass(frozen=True, kw_only=True)
class Reference(Part):
    """Levels of other runs that the metrics compare with."""

    envelope: float | None = None
    """Mean envelope without adaptation (rad), for the metric `envelope_reduction`; default: the mean over
    the run's own first window.
    """
    band: float | None = None
    """Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s` and
    `settling_time_s`. By default, what is promised: after a manoeuvre a thousandth of its angle, by a PD
    law 5 % of the distance at which the goal begins, by a relay its dead zone and its hysteresis.
    """
    pointing: Pointing | None = None
    """What is asked of the pointing of a body with three axes over a part of the run."""


@dataclass(frozen=True)
class RelativeNormal(Part):
    """The scenario's own value, times a normal factor of mean 1 and this standard deviation."""

    _tag: ClassVar[str | None] = "relative_normal"
    _holds_one: ClassVar[bool] = True

    value: float


@dataclass(frozen=True)
class RelativeUniform(Part):
    """The scenario's own value, times a factor uniform on 1 - this to 1 + this."""

    _tag: ClassVar[str | None] = "relative_uniform"
    _holds_one: ClassVar[bool] = True

    value: float


@dataclass(frozen=True, kw_only=True)
class Relay(Part):
    """Relay with dead zone, hysteresis and a timed brake."""

    _tag: ClassVar[str | None] = "relay"

    dead_zone: float
    """Half width of the dead zone, eps (rad)."""
    hysteresis: float
    """Hysteresis, gamma (rad): how far back inside a boundary the brake begins."""
    strong: float
    """Strong torque `m_u` (N m; rad/s² on a body without inertia)."""
    weak: float
    """Weak torque `m_eps` in the dead zone (N m; rad/s² on a body without inertia)."""
    k_t: float
    """Braking gain: duration of the brake for each second of the push."""
    sides: Literal["two", "one"] | None = None
    """Which boundaries of the dead zone push back. Default: "two"."""


@dataclass(frozen=True, kw_only=True)
class RigidRate(Part):
    """The rigid rates of a spatial body."""

    _tag: ClassVar[str | None] = "rigid_rate"

    correction: float
    """Part l of the innovation by which each sample corrects the rate."""
    rate: float | Vector | None = None
    """What the rates are believed to be before the first sample (rad/s). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Rotor(Part):
    """A wheel that stores momentum."""

    inertia: float
    """Moment of inertia (kg m²)."""
    speed: float | None = None
    """Speed at the start (rad/s). Default: 0.0."""
    speed_limit: float | None = None
    """Largest speed (rad/s), at which no torque drives it further; no limit by default."""


@dataclass(frozen=True, kw_only=True)
class Sampled(Part):
    """A sample at each period, held until the next: guards are tested at samples."""

    _tag: ClassVar[str | None] = "sampled"

    period: float
    """Period of the samples (s)."""
    noise: float | None = None
    """Standard deviation of the white noise (rad). Default: 0.0."""
    bias: float | None = None
    """Constant error (rad). Default: 0.0."""
    resolution: float | None = None
    """Quantum of the output (rad); 0 for none. Default: 0.0."""
    rate_noise: float | None = None
    """Standard deviation of the white noise of a rate gyro (rad/s); default: there is no gyro, and the rate
    is the difference of the last two angles over the period.
    """
    point: str | None = None
    """The point of the structure at which it is, on a body with three axes; default: the first of the
    body's points.
    """
    faults: Sequence[Fault] | None = None
    """Times at which the sensor fails."""


@dataclass(frozen=True, kw_only=True)
class Scaled(Part):
    """It gives a part of what it should."""

    _tag: ClassVar[str | None] = "scaled"

    from_: float
    """When it begins (s)."""
    factor: float
    """The part; below 0, it acts the other way."""
    to: float | None = None
    """When it ends (s); default: with the run."""
    about: Literal["roll", "pitch", "yaw"] | None = None
    """The axis of which it fails, on a body with three; default: of all."""
    wheel: int | None = None
    """The wheel that fails, counted from 1; default: all do."""
    thruster: str | None = None
    """The thruster that fails, of jets; default: all do."""


@dataclass(frozen=True, kw_only=True)
class SceneSpec(Part):
    """How a run is drawn."""

    period: float | None = None
    """Period of the frames (s); default: that of the log, and at least 0.04 s."""
    bending: float | None = None
    """How many times the elastic motion is drawn as large as it is; default: so many times that what the
    actuator or the initial state excites shows.
    """
    turning: float | None = None
    """How many times the rotation of the body is drawn as large as it is; default: so many times that it
    shows.
    """


@dataclass(frozen=True)
class Schedule(Part):
    """A gain that follows the estimated frequency: straight lines between points, held before the first and
    after the last.
    """

    _tag: ClassVar[str | None] = "schedule"
    _holds_one: ClassVar[bool] = True

    value: Sequence[ScheduledGain]


@dataclass(frozen=True, kw_only=True)
class ScheduledGain(Part):
    """A point of a schedule."""

    frequency: float
    """Frequency of the dominant mode (rad/s)."""
    gain: float
    """Gain there."""


@dataclass(frozen=True, kw_only=True)
class Section(Part):
    """A section of a panel."""

    length: float
    """Length l (m)."""
    mass_per_length: float
    """Mass for each unit of length m (kg/m)."""
    hinge_stiffness: float
    """Stiffness c of the hinge at the inner end (N m/rad)."""
    tip_mass: float | None = None
    """Mass mu lumped at the outer end (kg). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class Shape(Part):
    """The shape of a mode at a point."""

    translation: Vector | None = None
    """Displacement of the point for a unit of the mode (1/sqrt(kg))."""
    rotation: Vector | None = None
    """Rotation at the point for a unit of the mode (rad/(m sqrt(kg)))."""


@dataclass(frozen=True, kw_only=True)
class Silent(Part):
    """It gives no number."""

    _tag: ClassVar[str | None] = "silent"

    from_: float
    """When it begins (s)."""
    to: float | None = None
    """When it ends (s); default: with the run."""


@dataclass(frozen=True, kw_only=True)
class Sine(Part):
    """amplitude sin(frequency t + phase), t from the start of the run."""

    amplitude: float
    """Amplitude (N m)."""
    frequency: float
    """Frequency (rad/s)."""
    phase: float | None = None
    """Phase at the start of the run (rad); pi/2 makes a cosine. Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class SineCommand(Part):
    """A series of sines ([Rotation], equations (19) to (24))."""

    _tag: ClassVar[str | None] = "sine"

    suppress: int | None = None
    """So many modes of the lowest frequencies. Default: 0."""
    zeros: Sequence[Target] | None = None
    """Zeros beside them."""


@dataclass(frozen=True, kw_only=True)
class Sinusoid(Part):
    """1 + amplitude (cos(2 pi (t + phase)/period) - cos(2 pi phase/period)): panels that follow the Sun on
    an orbit.
    """

    _tag: ClassVar[str | None] = "sinusoid"

    amplitude: float
    """Half of what lies between the smallest and the largest ratio."""
    period: float
    """Period (s)."""
    phase: float | None = None
    """Time on the cosine at the start of the run (s). Default: 0.0."""


@dataclass(frozen=True, kw_only=True)
class SolarPressure(Part):
    """Pressure of sunlight."""

    force: Vector
    """The force (N), in inertial axes."""
    at: Vector
    """Where it acts, the centre of pressure (m): from the point O of a spacecraft, or from the centre of
    mass of a spatial body.
    """
    shadow: Rows | None = None
    """When there is none, [from, to] (s): the body is in shadow, beside that of the orbit's planet."""


@dataclass(frozen=True, kw_only=True)
class Spacecraft(Part):
    """A spacecraft: its rigid hub, to which the appendages are clamped. Positions are from a point O of the
    user's choice, in the axes of the hub, which are the body's.
    """

    mass: float
    """Mass of the hub alone (kg)."""
    inertia: Rows
    """Inertia tensor of the hub alone about its centre of mass, with wheels locked in it (kg m²), row by
    row.
    """
    centre: Vector | None = None
    """Centre of mass of the hub alone (m)."""
    attitude: Vector | None = None
    """Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into inertial
    ones.
    """
    rate: Vector | None = None
    """Rates at the start (rad/s), in the body's axes: of the spacecraft as a whole, which are those of the
    hub while nothing vibrates.
    """
    whole_damping: bool | None = None
    """Whether the damping of the free modes is kept whole even where what is beside the diagonal of its
    matrix hardly counts.
    """
    points: Sequence[NamedPoint] | None = None
    """Named points of the hub, at which jets push and gyros look. By default, there is one at O, named
    `hub`.
    """


@dataclass(frozen=True, kw_only=True)
class Spatial(Part):
    """Three axes, and modes with shapes at points of the structure."""

    _tag: ClassVar[str | None] = "spatial"

    inertia: Rows
    """Inertia tensor about the centre of mass (kg m²), row by row: symmetric, positive definite."""
    attitude: Vector | None = None
    """Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into inertial
    ones.
    """
    rate: Vector | None = None
    """Rates at the start (rad/s), in the body's axes."""
    points: Sequence[NamedPoint] | None = None
    """Named points of the structure, at which jets push and gyros look."""
    modes: Sequence[SpatialMode] | str | None = None
    """Elastic modes: a table, or the path of a CSV file."""
    disturbance: Periodic | None = None
    """A torque that the surroundings exert; none by default."""


@dataclass(frozen=True, kw_only=True)
class SpatialMode(Part):
    """A mass-normalised elastic mode."""

    frequency: float
    """Natural frequency w (rad/s)."""
    damping: float | None = None
    """Damping ratio zeta: 0 undamped, 1 critical. Default: 0.0."""
    displacement: float | None = None
    """Modal displacement at the start (m sqrt(kg)). Default: 0.0."""
    rate: float | None = None
    """Its rate at the start (m sqrt(kg)/s). Default: 0.0."""
    shapes: Mapping[str, Shape] | None = None
    """The mode's shape at each point, by the point's name."""


@dataclass(frozen=True, kw_only=True)
class SpeedBias(Part):
    """A speed at which four wheels turn beside what the torque asks of them, two one way and two the other.
    """

    speed: float
    """The speed (rad/s), of the first one."""
    gain: float
    """How fast they are brought there (1/s)."""


@dataclass(frozen=True, kw_only=True)
class Stage(Part):
    """A law that acts from a time on."""

    law: Law
    """The law."""
    from_: float | None = None
    """From when on (s); of the first 0. Default: 0.0."""


@dataclass(frozen=True)
class Stages(Part):
    """Laws one after the other."""

    _tag: ClassVar[str | None] = "stages"
    _holds_one: ClassVar[bool] = True

    value: Sequence[Stage]


@dataclass(frozen=True, kw_only=True)
class StarTracker(Part):
    """The attitude at exposures, told later."""

    _tag: ClassVar[str | None] = "star_tracker"

    period: float
    """Period of its exposures (s)."""
    point: str | None = None
    """The point of the structure at which it is; default: the first of the body's points."""
    noise: Vector | None = None
    """Standard deviation of the white noise about each of its axes (rad): x and y across its boresight, z
    about it.
    """
    axes: Vector | None = None
    """The rotation from the body's axes to its own, [w, x, y, z]: it turns its vectors into the body's;
    default: they are the body's.
    """
    latency: float | None = None
    """Time from an exposure to when it is told (s). Default: 0.0."""
    blackout_rate: float | None = None
    """Rate of the body at the tracker from which on it sees nothing (rad/s); default: it always sees."""
    faults: Sequence[Fault] | None = None
    """Times at which it fails."""


@dataclass(frozen=True, kw_only=True)
class StateSpace(Part):
    """A sampled compensator, by its matrices."""

    _tag: ClassVar[str | None] = "state_space"

    period: float
    """Period of its samples (s)."""
    a: Rows | None = None
    """Matrix A, row by row; default: there are no states."""
    b: Rows | None = None
    """Matrix B: a row for each state, a column for the error of the angle (rad) and, if there are two, of
    the rate (rad/s).
    """
    c: Rows | None = None
    """Matrix C: one row."""
    d: Rows | None = None
    """Matrix D: one row; default: it is zero."""
    of: Literal["samples", "held", "tustin"] | None = None
    """What the matrices are of. Default: "samples"."""
    command: Literal["torque", "acceleration"] | None = None
    """What it commands. Default: "torque"."""
    limit: float | None = None
    """Largest command, in its unit; no limit by default."""
    track: bool | None = None
    """Whether it follows a manoeuvre while it lasts; else it takes over when the manoeuvre ends."""


@dataclass(frozen=True, kw_only=True)
class StuckFailure(Part):
    """It gives the same all the time."""

    _tag: ClassVar[str | None] = "stuck"

    from_: float
    """When it begins (s)."""
    to: float | None = None
    """When it ends (s); default: with the run."""
    about: Literal["roll", "pitch", "yaw"] | None = None
    """The axis of which it fails, on a body with three; default: of all."""
    wheel: int | None = None
    """The wheel that fails, counted from 1; default: all do."""
    thruster: str | None = None
    """The thruster that fails, of jets; default: all do."""
    at: float | None = None
    """What: a torque (N m), of magnetorquers a moment (A m²), of jets the part of their thrust; default:
    what is given when it begins.
    """


@dataclass(frozen=True, kw_only=True)
class StuckFault(Part):
    """It repeats the last measurement before the failure."""

    _tag: ClassVar[str | None] = "stuck"

    from_: float
    """When it begins (s)."""
    to: float | None = None
    """When it ends (s); default: with the run."""


@dataclass(frozen=True, kw_only=True)
class Sum(Part):
    """A sum of coordinates that is observed."""

    name: str
    """Name, such as `tip`."""
    weights: Vector | Mapping[str, float]
    """Weight of each coordinate."""
    unit: str | None = None
    """Unit. Default: "rad"."""


@dataclass(frozen=True, kw_only=True)
class SunSensor(Part):
    """The direction to the Sun."""

    _tag: ClassVar[str | None] = "sun_sensor"

    period: float
    """Period of its samples (s)."""
    boresight: Vector | None = None
    """The middle of its field of view in the body's axes, of any length; default: z."""
    field_of_view: float | None = None
    """Half of the angle of the field of view (rad); default: it sees all around. Default:
    3.141592653589793.
    """
    point: str | None = None
    """The point of the structure at which it is; default: the first of the body's points."""
    noise: float | Vector | None = None
    """Standard deviation of the white noise along each axis (rad). Default: 0.0."""
    bias: float | Vector | None = None
    """Constant error along each axis (rad). Default: 0.0."""
    resolution: float | Vector | None = None
    """Quantum of the output along each axis (rad); 0 for none. Default: 0.0."""
    scale: float | Vector | None = None
    """Relative error of the scale along each axis. Default: 0.0."""
    misalignment: Rows | None = None
    """What each axis, a row, measures of the direction along the others (rad); the diagonal is 0."""
    latency: float | None = None
    """Time from a sample to when it is told (s). Default: 0.0."""
    faults: Sequence[Fault] | None = None
    """Times at which it fails."""


@dataclass(frozen=True)
class Table(Part):
    """Straight lines between points, held before the first and after the last."""

    _tag: ClassVar[str | None] = "table"
    _holds_one: ClassVar[bool] = True

    value: Sequence[Point]


@dataclass(frozen=True, kw_only=True)
class Tachometer(Part):
    """The speeds of wheels, which their drives know by it; it tells nothing of the body."""

    _tag: ClassVar[str | None] = "tachometer"

    period: float
    """Period of the readings (s)."""
    pulses: int | None = None
    """Pulses in a turn: a reading is those of a period over the period, what is left counts in the next. By
    default, the speed at the instant is read.
    """
    noise: float | None = None
    """Standard deviation of the white noise of each reading (rad/s). Default: 0.0."""
    faults: Sequence[Fault] | None = None
    """Times at which they fail: then the drives keep the last reading."""


@dataclass(frozen=True, kw_only=True)
class Target(Part):
    """A zero of the command's spectrum, at a mode or near it."""

    mode: int
    """Index of the mode."""
    shift: float | None = None
    """Shift of its frequency, relative to it. Default: 0.0."""
    times: int | None = None
    """So many times: each time more flattens the spectrum there by one derivative with frequency. Default:
    1.
    """


@dataclass(frozen=True, kw_only=True)
class Thermal(Part):
    """Thermal bending."""

    deflection: Vector
    """By how much each mode is displaced in sunlight beyond the shadow, in the end (m sqrt(kg))."""
    time_constant: float
    """Time constant with which it gets there (s)."""


@dataclass(frozen=True, kw_only=True)
class Thruster(Part):
    """One thruster."""

    name: str
    """Name."""
    point: str
    """The point of the structure to which it is fixed."""
    direction: Vector
    """Direction of the force on the body, of length 1."""
    thrust: float
    """Thrust (N)."""
    offset: Vector | None = None
    """Its nozzle from there (m)."""


@dataclass(frozen=True, kw_only=True)
class Thrusters(Part):
    """In each period one pulse of full torque, centred in it, with the impulse that a hold would have."""

    _tag: ClassVar[str | None] = "thrusters"

    torque: float | Vector
    """Torque of a pulse (N m); one, or one for each of three axes."""
    period: float
    """Period of the pulses (s)."""
    minimum_on: float | None = None
    """Shortest pulse (s). Default: 0.0."""
    quantum: float | None = None
    """Quantum of a pulse's length (s); 0 for none. Default: 0.0."""
    faults: Sequence[Failure] | None = None
    """Times at which they fail."""


@dataclass(frozen=True, kw_only=True)
class Tracker(Part):
    """A mode as an observer of one channel begins with it."""

    frequency: float
    """Natural frequency (rad/s)."""
    influence: Vector
    """Influence of each input: the jump of the elastic rate in this channel for a unit jump of the rigid
    rate that the input makes about its own axis ([Timakov14], page 41; dimensionless).
    """
    bounds: Vector | None = None
    """`[low, high]` between which the frequency is looked for (rad/s); default: up to the middle between it
    and its neighbours.
    """


@dataclass(frozen=True, kw_only=True)
class Truth(Part):
    """The true dominant mode, as an ideal observer gives it."""

    _tag: ClassVar[str | None] = "truth"

    feeds: Literal["modes", "hub", "rigid"] | None = None
    """What the law reads of it beside the dominant mode: `modes` for angle and rate as measured, `hub`, or
    `rigid`; left out, `modes` for a law that reads the dominant mode, else `hub`.
    """


@dataclass(frozen=True, kw_only=True)
class Turn(Part):
    """A turn about a fixed axis."""

    about: Vector
    """The axis, of any length but 0."""
    by: float
    """The angle (rad)."""


@dataclass(frozen=True)
class Uniform(Part):
    """Uniform between two values."""

    _tag: ClassVar[str | None] = "uniform"
    _holds_one: ClassVar[bool] = True

    value: Vector


@dataclass(frozen=True, kw_only=True)
class Unloading(Part):
    """How wheels are unloaded: by jets or by magnetorquers."""

    _bare: ClassVar[tuple[str, ...]] = ("jets", "magnetorquers", )

    above: float
    """Momentum of the wheels together beyond which it begins (N m s)."""
    below: float
    """Momentum below which it ends (N m s)."""
    torque: float | None = None
    """Largest mean torque of the jets about each axis over their cycles (N m), which the wheels take up
    meanwhile.
    """
    jets: Jets | None = None
    """The jets, with a period of their own and without a delay."""
    magnetorquers: Magnetorquers | None = None
    """The magnetorquers."""
    gain: float | None = None
    """Of magnetorquers, the part of the momentum across the field that they take in a second (1/s)."""
    period: float | None = None
    """Of magnetorquers, the period of their commands (s)."""


@dataclass(frozen=True, kw_only=True)
class UnscentedKalman(Part):
    """The same by an unscented Kalman filter."""

    _tag: ClassVar[str | None] = "unscented_kalman"

    modes: Sequence[Mode] | None = None
    """The modes of the filter's model; default: they are the body's own at the start."""
    moment_noise: float | None = None
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float | None = None
    """Standard deviation of the measured angle (rad); default: that of the sensor."""
    initial: Initial | None = None
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] | None = None
    """What the filter takes for the state at the start. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] | None = None
    """What makes a mode the dominant one. Default: "excitability"."""
    assess: Vector | None = None
    """When the metrics judge the filter, from one time to another (s); always by default."""
    feeds: Literal["modes", "hub", "rigid"] | None = None
    """What the law reads of it: `modes` for the dominant mode alone, beside angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for those of the body as if it
    were rigid. By default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool | None = None
    """Whether it is there to be assessed only: no law reads it."""
    ratios: Literal["common", "each"] | None = None
    """Which frequencies drift together. Default: "common"."""
    ratio: float | None = None
    """Ratio that the filter takes the frequencies to have at the start. Default: 1.0."""
    ratio_sd: float | None = None
    """Standard deviation of that ratio. Default: 0.03."""
    ratio_rate_sd: float | None = None
    """Standard deviation of its rate at the start, which is taken for 0 (1/s). Default: 0.003."""
    ratio_noise: float | None = None
    """Spectral density of the white noise in a ratio (1/s). Default: 1e-08."""
    ratio_rate_noise: float | None = None
    """Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08."""
    bounds: Vector | None = None
    """`[low, high]` of a ratio; the filter that reaches them has lost the body."""
    substeps: int | None = None
    """Steps in which a period is predicted. Default: 2."""
    gate: float | None = None
    """While the dominant mode's amplitude is below so many standard deviations of the angle, the ratios
    learn nothing. Default: 3.0.
    """


@dataclass(frozen=True, kw_only=True)
class Wheel(Part):
    """A flywheel on a motor with back-EMF."""

    _tag: ClassVar[str | None] = "wheel"

    gain: float
    """Torque for each unit of the law's command (N m; k'_u of [Wheel11, Sukhanov] times the body's
    inertia).
    """
    back_emf: float | None = None
    """Torque for each unit of the rate (N m s; k'_omega times the body's inertia). Default: 0.0."""
    opposes: Literal["body_rate", "rigid_rate"] | None = None
    """The rate that the back-EMF opposes. Default: "body_rate"."""
    rotor: Rotor | None = None
    """The wheel."""
    dead_zone: float | None = None
    """Commands of less than this are not executed. Default: 0.0."""
    quantum: float | None = None
    """Quantum of the command; 0 for none. Default: 0.0."""
    limit: float | None = None
    """Largest command; no limit by default."""
    delay: float | None = None
    """Time from a sample to the command that is computed from it (s). Default: 0.0."""
    faults: Sequence[Failure] | None = None
    """Times at which what its motor gives of a command fails; its back-EMF stays."""


@dataclass(frozen=True, kw_only=True)
class Wheels(Part):
    """Reaction wheels about axes of their own."""

    _tag: ClassVar[str | None] = "wheels"

    inertia: float
    """Moment of inertia of each about its axis (kg m²)."""
    arrangement: Literal["orthogonal", "pyramid"] | None = None
    """How they are arranged; default: their `axes` are given."""
    cant: float | None = None
    """Of a pyramid, the angle of each axis above the plane of x and y (rad); default: the one with equal
    torques about all three axes, 0.6155 rad.
    """
    axes: Rows | None = None
    """The axis of each wheel in the body's axes, of any length."""
    torque: float | None = None
    """Largest torque of each motor (N m); no limit by default. A torque that asks more of one is made
    smaller as a whole: it keeps its axis.
    """
    momentum: float | None = None
    """Largest momentum of each about its axis (N m s), at which no torque drives it further; no limit by
    default.
    """
    speed_limit: float | None = None
    """Largest speed of each (rad/s), at which no torque drives it further; no limit by default."""
    speeds: Vector | None = None
    """Speed of each at the start, relative to the body (rad/s); default: 0."""
    friction: Friction | None = None
    """Friction in their bearings; none by default."""
    compensation: Compensation | None = None
    """Torque that their drives add against friction, by the speeds that they know; none by default."""
    imbalance: Imbalance | None = None
    """Imbalance; default: they have none."""
    allocation: Literal["pseudo_inverse", "least_largest"] | None = None
    """Which of all torques that give what is wanted are taken. Default: "pseudo_inverse"."""
    speed_bias: SpeedBias | None = None
    """Of four wheels, a speed that torques which cancel each other keep; none by default."""
    unloading: Unloading | None = None
    """How jets or magnetorquers unload them; default: none do."""
    faults: Sequence[Failure] | None = None
    """Times at which their motors fail."""


@dataclass(frozen=True, kw_only=True)
class Zv(Part):
    """Zero vibration: two impulses for each mode."""

    _tag: ClassVar[str | None] = "zv"

    modes: Sequence[int] | None = None
    """Indices of the modes."""


@dataclass(frozen=True, kw_only=True)
class Zvd(Part):
    """Zero vibration and derivative: three impulses."""

    _tag: ClassVar[str | None] = "zvd"

    modes: Sequence[int] | None = None
    """Indices of the modes."""


@dataclass(frozen=True, kw_only=True)
class Zvdd(Part):
    """Zero vibration and two derivatives: four impulses."""

    _tag: ClassVar[str | None] = "zvdd"

    modes: Sequence[int] | None = None
    """Indices of the modes."""


Actuator: TypeAlias = Ideal | Hold | Thrusters | Wheel | Wheels | Jets | Magnetorquers
"""The kinds of actuator. Those of one angle act on a body with three axes about each."""
Adaptation: TypeAlias = RandomSearch
"""The kinds of adaptation."""
Body: TypeAlias = Planar | Matrices | Panels | Spatial
"""The kinds of body."""
Command: TypeAlias = SineCommand | Cosine | BangBang | MinimumEnergy | MinimumPeak | Polynomial
"""The kinds of command."""
Distribution: TypeAlias = Uniform | LogUniform | Normal | RelativeUniform | RelativeNormal | Choice
"""The distribution of one key of the scenario."""
Drift: TypeAlias = Common | Each
"""How the frequencies of a body drift."""
Estimator: TypeAlias = (
    Envelope
    | Truth
    | Kalman
    | ExtendedKalman
    | UnscentedKalman
    | AttitudeEstimator
    | RigidRate
    | Adaptive
)
"""The kinds of estimator."""
Extra: TypeAlias = Gain | Schedule
"""The extra loop over the dominant mode: its gain is k_d of the papers."""
Failure: TypeAlias = Dead | Scaled | StuckFailure | Added
"""A failure of an actuator."""
Fault: TypeAlias = StuckFault | Silent
"""A failure of the sensor, gyro included."""
Filter: TypeAlias = Notch | LowPass | Lead | Biquad
"""The kinds of filter."""
FilterForm: TypeAlias = Complementary
"""How gains are found."""
Law: TypeAlias = Relay | Pd | AttitudeLaw | StateSpace | Open | PhasePlane | PerAxis | BDot | Stages
"""The kinds of law."""
ObserverForm: TypeAlias = Gradient | Recurrence
"""The forms of an observer."""
Profile: TypeAlias = Ramp | Sinusoid | Table
"""A profile of the ratio over time."""
Sensor: TypeAlias = Sampled | Gyro | StarTracker | Magnetometer | SunSensor | Tachometer | Accelerometer
"""The kinds of sensor."""
Shaper: TypeAlias = Zv | Zvd | Zvdd | Ei
"""The kinds of shaper."""


class Keys(TypedDict, total=False):
    """The keys of a scenario, as `flexsc.Scenario` takes them."""

    about: str
    """What the study is about."""

    seed: int
    """Seed of all randomness."""

    duration: float
    """Simulated time (s)."""

    epoch: datetime
    """Date and time of the start; a log counts its time from here."""

    body: Body
    """What is controlled, if it is not a `spacecraft`."""

    spacecraft: Spacecraft
    """A spacecraft that is controlled, put together from its parts: the hub."""

    appendage: Sequence[Appendage]
    """What is clamped to the hub of the spacecraft."""

    drift: Drift
    """How the natural frequencies drift; default: they do not."""

    sensor: Sensor | Literal["continuous"] | Sequence[Sensor | Literal["continuous"]]
    """How the motion is measured: one sensor, or an array of several."""

    estimator: Estimator
    """What is estimated."""

    adaptation: Adaptation
    """What is adapted."""

    manoeuvre: Manoeuvre
    """What is planned ahead."""

    law: Law
    """What commands the torque. Only a scenario with a manoeuvre can do without."""

    actuator: Actuator | Literal["ideal"]
    """How the commanded torque is executed."""

    disturbance: Sequence[Disturbance]
    """Disturbance torques."""

    environment: Environment
    """What surrounds a body with three axes; default: nothing."""

    log: Log
    """What a full log holds."""

    target: Sequence[AttitudeTarget]
    """Attitudes that a body with three axes shall turn to, in the order of their times; before the first it
    is the inertial one. A law `phase_plane` may have them of its own.
    """

    reference: Reference
    """What the metrics compare with."""

    uncertain: Mapping[str, Distribution]
    """Distributions of keys that a campaign draws anew for each run."""

    correlated: Sequence[Correlated]
    """Keys of `uncertain` that are drawn together."""
