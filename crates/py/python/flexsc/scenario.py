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

Their keys, units and meanings are those of a scenario file. A key that is left out has its default: its
field is None until a scenario is made of the part, and `Scenario.part` returns it with all defaults. A
table of which there are several kinds, such as `[law]`, has a class for each kind, and a union of them,
`LawKind`. Parts of which a file has several, such as its `[[sensor]]`, are a list. What values have to be
is checked when a scenario is made of them; all mistakes are reported at once.
"""

# Made by crates/py/scenario_classes.py: a change here is lost.

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, TypedDict, Union

from flexsc._part import DEFAULT, Part

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = [
    "Accelerometer",
    "ActiveDamping",
    "ActuatorKind",
    "AdaptationKind",
    "Adaptive",
    "Added",
    "AltitudeOrbit",
    "Appendage",
    "AppendageDrive",
    "Assigned",
    "AttitudeAt",
    "AttitudeEstimator",
    "AttitudeFilterInitial",
    "AttitudeLaw",
    "BDot",
    "BangBang",
    "Biquad",
    "BodyKind",
    "Bound",
    "Burn",
    "Choice",
    "ClampedMode",
    "CommandKind",
    "Common",
    "Compensation",
    "Complementary",
    "ControlMomentGyros",
    "Correlated",
    "Cosine",
    "CraigBampton",
    "DampingGuards",
    "Dead",
    "Dipole",
    "DistributionKind",
    "Disturbance",
    "Drag",
    "DragPlate",
    "DriftKind",
    "DrivePoint",
    "Each",
    "EarthSensor",
    "Ei",
    "ElasticStates",
    "ElementMessage",
    "Envelope",
    "Environment",
    "EphemerisOrbit",
    "EstimatorKind",
    "Exclusion",
    "ExtendedKalman",
    "ExtraKind",
    "FailureKind",
    "FaultKind",
    "FilterFormKind",
    "FilterKind",
    "FineMirror",
    "Friction",
    "Gain",
    "Gate",
    "Given",
    "Gradient",
    "GravityGradient",
    "Groups",
    "Gyro",
    "Harmonic",
    "Hinge",
    "HoldActuator",
    "Ideal",
    "Imbalance",
    "Inertial",
    "Initial",
    "Integral",
    "Invalid",
    "Jets",
    "Kalman",
    "Kepler",
    "Keys",
    "LawKind",
    "Lead",
    "LineOfSight",
    "LitPlate",
    "LoadDensity",
    "LoadHarmonic",
    "LoadLines",
    "LogContents",
    "LogUniform",
    "LowPass",
    "MagneticField",
    "Magnetometer",
    "Magnetorquers",
    "Manoeuvre",
    "Matrices",
    "MeasuredPath",
    "MinimumEnergy",
    "MinimumPeak",
    "Mode",
    "ModeExit",
    "ModeTarget",
    "Mount",
    "NamedPoint",
    "Normal",
    "Notch",
    "NullMotion",
    "ObserverFormKind",
    "Open",
    "OperatingMode",
    "OpticalElement",
    "Orbit",
    "Outlier",
    "Output",
    "Pair",
    "Panels",
    "PartWithFailure",
    "PartWithFault",
    "Pd",
    "PerAxis",
    "Periodic",
    "PhasePlane",
    "Planar",
    "Point",
    "PointedAxis",
    "Pointing",
    "Polynomial",
    "ProfileKind",
    "Pulses",
    "Ramp",
    "RandomSearch",
    "Recurrence",
    "RecurrenceWeights",
    "Reference",
    "RelativeNormal",
    "RelativeUniform",
    "Relay",
    "Requirement",
    "RigidRate",
    "Robustness",
    "Rotor",
    "Rows",
    "RunFault",
    "Sampled",
    "Scaled",
    "SceneSpec",
    "Schedule",
    "ScheduledGain",
    "Section",
    "SensorKind",
    "Shape",
    "ShapedZero",
    "ShaperKind",
    "Silent",
    "Sine",
    "SineCommand",
    "Sinusoid",
    "Site",
    "SkyDirectionKind",
    "SmallAngles",
    "SolarPressure",
    "Spacecraft",
    "Spatial",
    "SpatialMode",
    "SpeedBias",
    "Stage",
    "Stages",
    "StarTracker",
    "StateSpaceLaw",
    "StuckFailure",
    "StuckFault",
    "Sum",
    "SunCell",
    "SunCells",
    "SunSensor",
    "TableProfile",
    "Tachometer",
    "Target",
    "Thermal",
    "Thruster",
    "Thrusters",
    "TitleBlock",
    "Tracker",
    "TruthEstimator",
    "Turn",
    "TwoLineOrbit",
    "Uniform",
    "UniformPlate",
    "UnitPair",
    "Unloading",
    "Unloads",
    "UnscentedKalman",
    "Vector",
    "Wheel",
    "Wheels",
    "Zero",
    "Zv",
    "Zvd",
    "Zvdd",
]

Vector: TypeAlias = Union[Sequence[float], "npt.NDArray[Any]"]
"""Numbers in a row: a list, a tuple or an array of shape (n,)."""
Rows: TypeAlias = Union[Sequence[Sequence[float]], "npt.NDArray[Any]"]
"""Rows of numbers: lists in a list, or an array of shape (rows, columns)."""


class Accelerometer(Part):
    """The specific force at a point of a spacecraft, for the log only.

    Args:
        period: Period of its samples (s).
        watch_only: Must be true: no law or estimator reads an accelerometer; its readings are only logged.
            Default: false.
        point: Point of the structure at which it is mounted; default: the first of the body's points.
        along: Measurement directions: one to three, of any length, in the hub's axes with the structure
            undeformed; default: x, y and z.
        noise: Standard deviation of the white noise along each (m/s²). Default: 0.0.
        bias: Constant error along each (m/s²). Default: 0.0.
        bias_random_walk: Random walk of the bias along each (m/s² per square root of a second). Default:
            0.0.
        resolution: Quantum of the output along each (m/s²); 0 for none. Default: 0.0.
        scale: Relative error of the scale along each. Default: 0.0.
        latency: Time from a sample to its output (s). Default: 0.0.
        faults: Intervals in which the accelerometer fails.
    """

    _tag: ClassVar[str | None] = "accelerometer"

    period: float
    """Period of its samples (s)."""
    watch_only: bool = DEFAULT
    """Must be true: no law or estimator reads an accelerometer; its readings are only logged. Default:
    false.
    """
    point: str = DEFAULT
    """Point of the structure at which it is mounted; default: the first of the body's points."""
    along: Rows = DEFAULT
    """Measurement directions: one to three, of any length, in the hub's axes with the structure undeformed;
    default: x, y and z.
    """
    noise: float | Vector = DEFAULT
    """Standard deviation of the white noise along each (m/s²). Default: 0.0."""
    bias: float | Vector = DEFAULT
    """Constant error along each (m/s²). Default: 0.0."""
    bias_random_walk: float | Vector = DEFAULT
    """Random walk of the bias along each (m/s² per square root of a second). Default: 0.0."""
    resolution: float | Vector = DEFAULT
    """Quantum of the output along each (m/s²); 0 for none. Default: 0.0."""
    scale: float | Vector = DEFAULT
    """Relative error of the scale along each. Default: 0.0."""
    latency: float = DEFAULT
    """Time from a sample to its output (s). Default: 0.0."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the accelerometer fails."""


class ActiveDamping(Part):
    """Active damping.

    Args:
        threshold: Elastic rate about each axis above which the jets fire (rad/s), three numbers, of which
            one axis uses the first; default, for the mode that a long burn excites most: 1.5 times the
            amplitude of the limit cycle due to the delay, and at least the change by two whole cycles of
            firing.
        release: Fraction of the threshold at which the pulses of active damping stop. Default: 0.5.
        pulse_width: Whether a pulse is only as long as it takes to stop the elastic motion; otherwise it
            fills the cycle. Default: true.
        predictor: Whether the elastic rate is predicted for the middle of the next pulse. Default: true.
        guards: Guards against exciting the motion.
    """

    threshold: Vector = DEFAULT
    """Elastic rate about each axis above which the jets fire (rad/s), three numbers, of which one axis uses
    the first; default, for the mode that a long burn excites most: 1.5 times the amplitude of the limit
    cycle due to the delay, and at least the change by two whole cycles of firing.
    """
    release: float = DEFAULT
    """Fraction of the threshold at which the pulses of active damping stop. Default: 0.5."""
    pulse_width: bool = DEFAULT
    """Whether a pulse is only as long as it takes to stop the elastic motion; otherwise it fills the cycle.
    Default: true.
    """
    predictor: bool = DEFAULT
    """Whether the elastic rate is predicted for the middle of the next pulse. Default: true."""
    guards: DampingGuards = DEFAULT
    """Guards against exciting the motion."""


class Adaptive(Part):
    """Adaptive observers of the rigid rates and elastic modes of a spatial body.

    Args:
        form: Form of the observers; default: `gradient`.
        trackers: The modes to track about each axis, on three axes, such as `roll = [{ frequency = 1.7,
            influence = [0, 0, 3], bounds = [1.0, 2.4] }]`; an axis that is left out tracks none. Default:
            the dominant modes of the body.
        count: Number of modes that each axis tracks; default: 2, or 1 in the form `recurrence`.
        merge: Relative frequency difference below which modes of the body are tracked as one: the
            influences add up, the frequency is their mean weighted by these. Default: 0.08.
        cross_axis: Whether an axis accounts for the jets of the other axes; default: true in the form
            `gradient`, else false.
        frequency_error: Relative error of the frequencies at the start; a frequency stays within its
            bounds. Default: 0.0.
        influence_error: Relative error of the influences at the start. Default: 0.0.
        adapt: Whether frequencies and influences are identified. Default: true.
    """

    _tag: ClassVar[str | None] = "adaptive"

    form: ObserverFormKind = DEFAULT
    """Form of the observers; default: `gradient`."""
    trackers: Given = DEFAULT
    """The modes to track about each axis, on three axes, such as `roll = [{ frequency = 1.7, influence =
    [0, 0, 3], bounds = [1.0, 2.4] }]`; an axis that is left out tracks none. Default: the dominant modes
    of the body.
    """
    count: int = DEFAULT
    """Number of modes that each axis tracks; default: 2, or 1 in the form `recurrence`."""
    merge: float = DEFAULT
    """Relative frequency difference below which modes of the body are tracked as one: the influences add
    up, the frequency is their mean weighted by these. Default: 0.08.
    """
    cross_axis: bool = DEFAULT
    """Whether an axis accounts for the jets of the other axes; default: true in the form `gradient`, else
    false.
    """
    frequency_error: float = DEFAULT
    """Relative error of the frequencies at the start; a frequency stays within its bounds. Default: 0.0."""
    influence_error: float = DEFAULT
    """Relative error of the influences at the start. Default: 0.0."""
    adapt: bool = DEFAULT
    """Whether frequencies and influences are identified. Default: true."""


class Added(Part):
    """An error added to the commanded output.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
        about: Axis that fails, on a body with three; default: all.
        wheel: Wheel that fails, counted from 1; default: all.
        gimbal: Gimbal of `control_moment_gyros` that fails, counted from 1; default: all.
        thruster: Thruster of `jets` that fails; default: all.
        constant: Constant part: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate
            (rad/s), for jets a thrust (N). Default: 0.0.
        sines: Sine torques.
    """

    _tag: ClassVar[str | None] = "added"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""
    about: Literal["roll", "pitch", "yaw"] = DEFAULT
    """Axis that fails, on a body with three; default: all."""
    wheel: int = DEFAULT
    """Wheel that fails, counted from 1; default: all."""
    gimbal: int = DEFAULT
    """Gimbal of `control_moment_gyros` that fails, counted from 1; default: all."""
    thruster: str = DEFAULT
    """Thruster of `jets` that fails; default: all."""
    constant: float = DEFAULT
    """Constant part: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate (rad/s), for
    jets a thrust (N). Default: 0.0.
    """
    sines: Sequence[Sine] = DEFAULT
    """Sine torques."""


class AltitudeOrbit(Part):
    """An orbit by its altitude. Inertial axes are those of the planet's equator: z along its axis of
    rotation.

    Args:
        altitude: Altitude above the planet's radius at the equator (m); of an ellipse, the semi-major axis
            less the radius.
        ltan: Mean local time of the ascending node: `"10:30"`, `"6 h"`, or seconds since midnight; with the
            inclination left out, the orbit is Sun-synchronous. It needs the scenario's `epoch`.
        eccentricity: Eccentricity. Default: 0.0.
        inclination: Inclination to the equator (rad); default: with `ltan`, that of a Sun-synchronous
            orbit, else 0.
        node: Angle from the inertial x to the ascending node (rad), in place of `ltan`; default: 0.
        perigee: Angle from the node to the perigee (rad). Default: 0.0.
        anomaly: Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee. Default:
            0.0.
        gravity: Gravitational parameter of the planet (m³/s²); default: the Earth's. Default:
            398600441800000.0.
        planet_radius: Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
            Default: 6378137.0.
        j2: Coefficient J2 of the planet's oblateness, as of Kepler elements; default: with `ltan` that of
            the Earth, else a sphere.
    """

    altitude: float
    """Altitude above the planet's radius at the equator (m); of an ellipse, the semi-major axis less the
    radius.
    """
    ltan: str | float = DEFAULT
    """Mean local time of the ascending node: `"10:30"`, `"6 h"`, or seconds since midnight; with the
    inclination left out, the orbit is Sun-synchronous. It needs the scenario's `epoch`.
    """
    eccentricity: float = DEFAULT
    """Eccentricity. Default: 0.0."""
    inclination: float = DEFAULT
    """Inclination to the equator (rad); default: with `ltan`, that of a Sun-synchronous orbit, else 0."""
    node: float = DEFAULT
    """Angle from the inertial x to the ascending node (rad), in place of `ltan`; default: 0."""
    perigee: float = DEFAULT
    """Angle from the node to the perigee (rad). Default: 0.0."""
    anomaly: float = DEFAULT
    """Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee. Default: 0.0."""
    gravity: float = DEFAULT
    """Gravitational parameter of the planet (m³/s²); default: the Earth's. Default: 398600441800000.0."""
    planet_radius: float = DEFAULT
    """Radius of the planet (m), for its shadow; default: the Earth's equatorial radius. Default: 6378137.0.
    """
    j2: bool | float = DEFAULT
    """Coefficient J2 of the planet's oblateness, as of Kepler elements; default: with `ltan` that of the
    Earth, else a sphere.
    """


class Appendage(Part):
    """An appendage, clamped to the hub at its root.

    Args:
        name: Name.
        mass: Mass (kg).
        centre: Centre of mass from the root (m), in its own axes.
        inertia: Inertia tensor about its centre of mass (kg m²), row by row, in its own axes; default:
            zero, a point mass.
        at: Position of its root from the point O of the spacecraft (m).
        turned: Rotation of its axes relative to those of the body.
        drive: Drive that turns it about an axis through its root during a run; default: none.
        hinge: Hinge at its root, on which it swings as a rigid body at any angle, in place of `modes`;
            default: none.
        mount: Mount that carries it as a rigid body, in place of `modes`: an isolator of a wheel, a cooler
            or a package of gyros; default: none.
        plate: For a thin plate in the plane of its own x and y: the axis along which it extends, from which
            first moments follow with the participations in rotation; or size and first frequency of a
            uniform panel, in place of `modes`, `centre` and `inertia`.
        points: Named points of the appendage, measured from its root in its own axes; a name is unique in
            the spacecraft.
        modes: Clamped modes: a table, or the path of a CSV file or of finite-element results: `.f06` of
            Nastran or MYSTRAN, `.dat` of CalculiX or its `.frd` with the deck beside it, `.flex` or `.txt`
            of 42. Without modes it is rigid.
        craig_bampton: Craig-Bampton model in place of `modes`; `damping` is then needed, and `mass`,
            `centre` and `inertia` are compared with it. Default: none.
        damping: Damping ratio of modes read from finite-element results, or a list with one for each;
            required where the file has none, as all but those of 42.
        keep: Number of modes to keep from finite-element results, 1 to 200, lowest frequencies first;
            default: all.
        frequency_factor: Factor on its natural frequencies, whichever way they are given; damping ratios
            and shapes stay. Default: 1.
        thermal: Thermal bending in sunlight; default: none.
        units: Units of finite-element results, except for 42, whose files are in SI units: `m` (metres,
            kilograms), `mm` (millimetres, tonnes), `in` (inches, pound-force seconds squared an inch), or
            `length` (`m`, `cm`, `mm`, `in`, `ft`) and `mass` (`kg`, `g`, `t`, `lb`, `slug`, `slinch`);
            default: `m`.
    """

    name: str
    """Name."""
    mass: float
    """Mass (kg)."""
    centre: Vector = DEFAULT
    """Centre of mass from the root (m), in its own axes."""
    inertia: Rows = DEFAULT
    """Inertia tensor about its centre of mass (kg m²), row by row, in its own axes; default: zero, a point
    mass.
    """
    at: Vector = DEFAULT
    """Position of its root from the point O of the spacecraft (m)."""
    turned: Turn | Sequence[Turn] = DEFAULT
    """Rotation of its axes relative to those of the body."""
    drive: AppendageDrive = DEFAULT
    """Drive that turns it about an axis through its root during a run; default: none."""
    hinge: Hinge = DEFAULT
    """Hinge at its root, on which it swings as a rigid body at any angle, in place of `modes`; default:
    none.
    """
    mount: Mount = DEFAULT
    """Mount that carries it as a rigid body, in place of `modes`: an isolator of a wheel, a cooler or a
    package of gyros; default: none.
    """
    plate: Literal["x", "y"] | UniformPlate = DEFAULT
    """For a thin plate in the plane of its own x and y: the axis along which it extends, from which first
    moments follow with the participations in rotation; or size and first frequency of a uniform panel,
    in place of `modes`, `centre` and `inertia`.
    """
    points: Sequence[NamedPoint] = DEFAULT
    """Named points of the appendage, measured from its root in its own axes; a name is unique in the
    spacecraft.
    """
    modes: Sequence[ClampedMode] | str = DEFAULT
    """Clamped modes: a table, or the path of a CSV file or of finite-element results: `.f06` of Nastran or
    MYSTRAN, `.dat` of CalculiX or its `.frd` with the deck beside it, `.flex` or `.txt` of 42. Without
    modes it is rigid.
    """
    craig_bampton: CraigBampton = DEFAULT
    """Craig-Bampton model in place of `modes`; `damping` is then needed, and `mass`, `centre` and `inertia`
    are compared with it. Default: none.
    """
    damping: float | Vector = DEFAULT
    """Damping ratio of modes read from finite-element results, or a list with one for each; required where
    the file has none, as all but those of 42.
    """
    keep: int = DEFAULT
    """Number of modes to keep from finite-element results, 1 to 200, lowest frequencies first; default:
    all.
    """
    frequency_factor: float = DEFAULT
    """Factor on its natural frequencies, whichever way they are given; damping ratios and shapes stay.
    Default: 1.
    """
    thermal: Thermal = DEFAULT
    """Thermal bending in sunlight; default: none."""
    units: str | UnitPair = DEFAULT
    """Units of finite-element results, except for 42, whose files are in SI units: `m` (metres, kilograms),
    `mm` (millimetres, tonnes), `in` (inches, pound-force seconds squared an inch), or `length` (`m`,
    `cm`, `mm`, `in`, `ft`) and `mass` (`kg`, `g`, `t`, `lb`, `slug`, `slinch`); default: `m`.
    """


class AppendageDrive(Part):
    """A drive.

    Args:
        about: Axis through the root, in the axes of the appendage, of any nonzero length.
        angle: Angle at the start (rad); at 0 the appendage has the orientation given by `turned`. Default:
            0.0.
        rate: Constant rate of the drive (rad/s).
        from_: Time at which it begins to turn (s); default: the start of the run.
        until: Time at which it begins to stop (s); default: it does not stop.
        acceleration: Acceleration with which its rate changes (rad/s²), which rounds the corners of a
            table; default: the rate jumps, and excites the modes and the hub.
        table: Table of angles over time, with constant rates between the points, at rest before the first
            and after the last.
        track: Object that the drive tracks.
        normal: Direction that is turned to the Sun, in the axes of the appendage, perpendicular to the
            drive's axis; default: z.
    """

    about: Vector
    """Axis through the root, in the axes of the appendage, of any nonzero length."""
    angle: float = DEFAULT
    """Angle at the start (rad); at 0 the appendage has the orientation given by `turned`. Default: 0.0."""
    rate: float = DEFAULT
    """Constant rate of the drive (rad/s)."""
    from_: float = DEFAULT
    """Time at which it begins to turn (s); default: the start of the run."""
    until: float = DEFAULT
    """Time at which it begins to stop (s); default: it does not stop."""
    acceleration: float = DEFAULT
    """Acceleration with which its rate changes (rad/s²), which rounds the corners of a table; default: the
    rate jumps, and excites the modes and the hub.
    """
    table: Sequence[DrivePoint] = DEFAULT
    """Table of angles over time, with constant rates between the points, at rest before the first and after
    the last.
    """
    track: Literal["sun"] = DEFAULT
    """Object that the drive tracks."""
    normal: Vector = DEFAULT
    """Direction that is turned to the Sun, in the axes of the appendage, perpendicular to the drive's axis;
    default: z.
    """


class Assigned(Part):
    """An actuator of a list: exactly one of the kinds, and which part of the demand it executes.

    Args:
        ideal: The command itself, at every instant.
        hold: A zero-order hold: the mean of the manoeuvre's command over each period, and the feedback at
            its start.
        thrusters: One pulse of full torque per period, centred in it, with the same impulse as a zero-order
            hold.
        wheel: A flywheel on a motor with back-EMF.
        wheels: Reaction wheels about axes of their own.
        control_moment_gyros: Control moment gyros of a spacecraft.
        jets: Thrusters at points of a spatial body.
        magnetorquers: Magnetorquers of a spatial body in the field of its planet.
        axes: Axes about which it executes the demand, on a body with three; default: all.
        share: Share of the demand about these axes; default: 1. The shares of all actuators about an axis
            must sum to 1.
        unloads: For `jets` or `magnetorquers`: how they unload the `wheels` or `control_moment_gyros` of
            the list. They then execute no demand.
    """

    _bare: ClassVar[tuple[str, ...]] = (
        "ideal",
        "hold",
        "thrusters",
        "wheel",
        "wheels",
        "control_moment_gyros",
        "jets",
        "magnetorquers",
    )

    ideal: Ideal = DEFAULT
    """The command itself, at every instant."""
    hold: HoldActuator = DEFAULT
    """A zero-order hold: the mean of the manoeuvre's command over each period, and the feedback at its
    start.
    """
    thrusters: Thrusters = DEFAULT
    """One pulse of full torque per period, centred in it, with the same impulse as a zero-order hold."""
    wheel: Wheel = DEFAULT
    """A flywheel on a motor with back-EMF."""
    wheels: Wheels = DEFAULT
    """Reaction wheels about axes of their own."""
    control_moment_gyros: ControlMomentGyros = DEFAULT
    """Control moment gyros of a spacecraft."""
    jets: Jets = DEFAULT
    """Thrusters at points of a spatial body."""
    magnetorquers: Magnetorquers = DEFAULT
    """Magnetorquers of a spatial body in the field of its planet."""
    axes: Sequence[Literal["roll", "pitch", "yaw"]] = DEFAULT
    """Axes about which it executes the demand, on a body with three; default: all."""
    share: float = DEFAULT
    """Share of the demand about these axes; default: 1. The shares of all actuators about an axis must sum
    to 1.
    """
    unloads: Unloads = DEFAULT
    """For `jets` or `magnetorquers`: how they unload the `wheels` or `control_moment_gyros` of the list.
    They then execute no demand.
    """


class AttitudeAt(Part):
    """A row of the table.

    Args:
        time: Time since the start of the target (s); 0 in the first row.
        roll: Roll (rad). Default: 0.0.
        pitch: Pitch (rad). Default: 0.0.
        yaw: Yaw (rad). Default: 0.0.
    """

    time: float
    """Time since the start of the target (s); 0 in the first row."""
    roll: float = DEFAULT
    """Roll (rad). Default: 0.0."""
    pitch: float = DEFAULT
    """Pitch (rad). Default: 0.0."""
    yaw: float = DEFAULT
    """Yaw (rad). Default: 0.0."""


class AttitudeEstimator(Part):
    """A multiplicative extended Kalman filter of the attitude and gyro bias of a spatial body.

    Args:
        form: How the gains are computed. Default: "extended".
        angle_random_walk: Angle random walk of the gyro (rad/sqrt(s)), the same about each axis; default:
            the largest of the gyro's own, which for one that samples the rate is its noise times the root
            of the period.
        rate_random_walk: Rate random walk of the gyro's bias (rad/s^1.5); default: the largest of the
            gyro's own, with a `bias_instability` as the walk that it is over a short time.
        attitude_noise: Standard deviation of a measured attitude about each axis of its sensor (rad);
            default: the sensor's own.
        field_noise: Standard deviation of a measured magnetic field along each axis (T); default: the
            magnetometer's own.
        field_degree: Degree of the magnetic field that the filter takes as the reference of magnetometers,
            from 1 to that of the environment's; default: the environment's field itself, without a model
            error. The error of a lower degree is correlated in time: cover it by `field_noise`.
        sun_noise: Standard deviation of a measured direction to the Sun (rad); default: that of the Sun
            sensor or cells.
        earth_noise: Standard deviation of a measured direction to the planet (rad); default: the Earth
            sensor's own.
        gate: Limits within which it accepts readings.
        initial: Standard deviations of the estimate at the start.
        prior: Initial estimate of attitude and bias. Default: "drawn".
        elastic: Elastic modes as further states; none by default.
        assess: Interval over which the metrics assess the filter (s); default: the whole run.
        watch_only: Whether the filter runs for assessment only: the law does not read it.
    """

    _tag: ClassVar[str | None] = "attitude"

    form: FilterFormKind | Literal["extended", "steady"] = DEFAULT
    """How the gains are computed. Default: "extended"."""
    angle_random_walk: float = DEFAULT
    """Angle random walk of the gyro (rad/sqrt(s)), the same about each axis; default: the largest of the
    gyro's own, which for one that samples the rate is its noise times the root of the period.
    """
    rate_random_walk: float = DEFAULT
    """Rate random walk of the gyro's bias (rad/s^1.5); default: the largest of the gyro's own, with a
    `bias_instability` as the walk that it is over a short time.
    """
    attitude_noise: Vector = DEFAULT
    """Standard deviation of a measured attitude about each axis of its sensor (rad); default: the sensor's
    own.
    """
    field_noise: float = DEFAULT
    """Standard deviation of a measured magnetic field along each axis (T); default: the magnetometer's own.
    """
    field_degree: int = DEFAULT
    """Degree of the magnetic field that the filter takes as the reference of magnetometers, from 1 to that
    of the environment's; default: the environment's field itself, without a model error. The error of a
    lower degree is correlated in time: cover it by `field_noise`.
    """
    sun_noise: float = DEFAULT
    """Standard deviation of a measured direction to the Sun (rad); default: that of the Sun sensor or
    cells.
    """
    earth_noise: float = DEFAULT
    """Standard deviation of a measured direction to the planet (rad); default: the Earth sensor's own."""
    gate: Gate = DEFAULT
    """Limits within which it accepts readings."""
    initial: AttitudeFilterInitial = DEFAULT
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] = DEFAULT
    """Initial estimate of attitude and bias. Default: "drawn"."""
    elastic: ElasticStates = DEFAULT
    """Elastic modes as further states; none by default."""
    assess: Vector = DEFAULT
    """Interval over which the metrics assess the filter (s); default: the whole run."""
    watch_only: bool = DEFAULT
    """Whether the filter runs for assessment only: the law does not read it."""


class AttitudeFilterInitial(Part):
    """Standard deviations of an attitude filter's estimate at the start, the same about each axis.

    Args:
        angle: Standard deviation of the attitude (rad). Default: 0.001.
        bias: Standard deviation of the bias (rad/s). Default: 1e-05.
    """

    angle: float = DEFAULT
    """Standard deviation of the attitude (rad). Default: 0.001."""
    bias: float = DEFAULT
    """Standard deviation of the bias (rad/s). Default: 1e-05."""


class AttitudeLaw(Part):
    """Sampled feedback of the attitude, as an acceleration.

    Args:
        period: Period of its samples (s).
        bandwidth: Bandwidth wn (rad/s): the natural frequency of the error of a rigid body.
        damping: Damping ratio zeta of the error. Default: 0.7.
        inertia: Inertia tensor in the law's model of a body with three axes (kg m²), row by row; default:
            the body's own in each run, so write it out to study its errors.
        error: How a rotation is converted into an error, on a body with three axes; default: `quaternion`.
        integral: Integral of the error; none by default.
        rate_limit: Largest rate at which an error is corrected (rad/s); no limit by default.
        filters: Filters of the fed-back acceleration, applied in this order.
    """

    _tag: ClassVar[str | None] = "attitude"

    period: float
    """Period of its samples (s)."""
    bandwidth: float
    """Bandwidth wn (rad/s): the natural frequency of the error of a rigid body."""
    damping: float = DEFAULT
    """Damping ratio zeta of the error. Default: 0.7."""
    inertia: Rows = DEFAULT
    """Inertia tensor in the law's model of a body with three axes (kg m²), row by row; default: the body's
    own in each run, so write it out to study its errors.
    """
    error: Literal["quaternion", "rodrigues"] = DEFAULT
    """How a rotation is converted into an error, on a body with three axes; default: `quaternion`."""
    integral: Integral = DEFAULT
    """Integral of the error; none by default."""
    rate_limit: float = DEFAULT
    """Largest rate at which an error is corrected (rad/s); no limit by default."""
    filters: Sequence[FilterKind] = DEFAULT
    """Filters of the fed-back acceleration, applied in this order."""


class BDot(Part):
    """Magnetic moments against the measured change of the field, to detumble a body.

    Args:
        period: Period of its commands (s).
        gain: Magnetic moment per unit rate of change of the field (A m² s/T).
    """

    _tag: ClassVar[str | None] = "b_dot"

    period: float
    """Period of its commands (s)."""
    gain: float
    """Magnetic moment per unit rate of change of the field (A m² s/T)."""


class BangBang(Part):
    """Full torque one way, then full torque the other way: the smallest peak that turns the rigid body."""

    _tag: ClassVar[str | None] = "bang_bang"


class Biquad(Part):
    """(b0 + b1/z + b2/z²)/(1 + a1/z + a2/z²), with the coefficients as given.

    Args:
        b: b0, b1, b2.
        a: a1, a2.
    """

    _tag: ClassVar[str | None] = "biquad"

    b: Vector
    """b0, b1, b2."""
    a: Vector
    """a1, a2."""


class Bound(Part):
    """Claim that an output of the linear body stays within limits, from every state at the start and under
    every input of given ranges. The control loop does not act in it, and a run does not read it.

    Args:
        output: Output of the linear model, such as `rate` about one axis and `yaw_rate` about three.
        elastic: True if the output is without the rigid motion. Default: false.
        limits: Limits [low, high] of the output, in its unit; default: none, and the range is computed
            alone.
        until: End of the interval of time from the start (s); default: the `duration`.
        start: Range [low, high] of states at the start, by the names of the linear model, in their units;
            `displacements` and `rates` stand for all modes. Other states are 0.
        constant_inputs: Range [low, high] of inputs that are constant in time, such as `torque_yaw`.
        varying_inputs: Range [low, high] within which inputs vary in time in any way, such as `torque_yaw`.
        frequency_error: Largest deviation of each natural frequency, as a part of its value. Default: 0.0.
        damping_error: Largest deviation of each damping ratio, as a part of its value. Default: 0.0.
    """

    output: str
    """Output of the linear model, such as `rate` about one axis and `yaw_rate` about three."""
    elastic: bool = DEFAULT
    """True if the output is without the rigid motion. Default: false."""
    limits: Vector = DEFAULT
    """Limits [low, high] of the output, in its unit; default: none, and the range is computed alone."""
    until: float = DEFAULT
    """End of the interval of time from the start (s); default: the `duration`."""
    start: Mapping[str, Vector] = DEFAULT
    """Range [low, high] of states at the start, by the names of the linear model, in their units;
    `displacements` and `rates` stand for all modes. Other states are 0.
    """
    constant_inputs: Mapping[str, Vector] = DEFAULT
    """Range [low, high] of inputs that are constant in time, such as `torque_yaw`."""
    varying_inputs: Mapping[str, Vector] = DEFAULT
    """Range [low, high] within which inputs vary in time in any way, such as `torque_yaw`."""
    frequency_error: float = DEFAULT
    """Largest deviation of each natural frequency, as a part of its value. Default: 0.0."""
    damping_error: float = DEFAULT
    """Largest deviation of each damping ratio, as a part of its value. Default: 0.0."""


class Burn(Part):
    """Force commanded in an interval.

    Args:
        from_: Start (s).
        to: End (s).
        force: Force on the body, in body axes (N).
    """

    from_: float
    """Start (s)."""
    to: float
    """End (s)."""
    force: Vector
    """Force on the body, in body axes (N)."""


class Choice(Part, kw_only=False):
    """One of these values, with equal probability."""

    _tag: ClassVar[str | None] = "choice"

    value: Sequence[float | str]


class ClampedMode(Part):
    """A mass-normalised mode of an appendage clamped at its root: the integral of phi_i . phi_j dm is 1 for
    i = j, else 0. Vectors are in the axes of the appendage, and r is the position from its root.

    Args:
        frequency: Natural frequency O with the root held (rad/s).
        damping: Damping ratio zeta with the root held: 0 undamped, 1 critical. Default: 0.0.
        translation: Participation in translation, the integral of phi dm (sqrt(kg)).
        along: For a point mass, in place of `translation`: the direction in which all of its mass swings,
            of any length.
        rotation: Participation in rotation about the root, the integral of r x phi dm (sqrt(kg) m).
        moments: First moments about the root, the integral of r phi' dm (sqrt(kg) m), row by row: rows
            along r, columns along phi. `rotation` follows from them, and is left out or agrees.
        displacement: Modal displacement at the start (m sqrt(kg)). Default: 0.0.
        rate: Modal rate at the start (m sqrt(kg)/s). Default: 0.0.
        shapes: Shape of the mode at each point of the appendage, relative to the fixed root, by the name of
            the point.
    """

    frequency: float
    """Natural frequency O with the root held (rad/s)."""
    damping: float = DEFAULT
    """Damping ratio zeta with the root held: 0 undamped, 1 critical. Default: 0.0."""
    translation: Vector = DEFAULT
    """Participation in translation, the integral of phi dm (sqrt(kg))."""
    along: Vector = DEFAULT
    """For a point mass, in place of `translation`: the direction in which all of its mass swings, of any
    length.
    """
    rotation: Vector = DEFAULT
    """Participation in rotation about the root, the integral of r x phi dm (sqrt(kg) m)."""
    moments: Rows = DEFAULT
    """First moments about the root, the integral of r phi' dm (sqrt(kg) m), row by row: rows along r,
    columns along phi. `rotation` follows from them, and is left out or agrees.
    """
    displacement: float = DEFAULT
    """Modal displacement at the start (m sqrt(kg)). Default: 0.0."""
    rate: float = DEFAULT
    """Modal rate at the start (m sqrt(kg)/s). Default: 0.0."""
    shapes: Mapping[str, Shape] = DEFAULT
    """Shape of the mode at each point of the appendage, relative to the fixed root, by the name of the
    point.
    """


class Common(Part, kw_only=False):
    """All frequencies have one ratio."""

    _tag: ClassVar[str | None] = "common"

    value: ProfileKind


class Compensation(Part):
    """Friction of the wheels as the drives model it.

    Args:
        coulomb: Coulomb friction (N m): one number for all wheels, or one for each. Default: 0.0.
        viscous: Viscous friction (N m s/rad): one number for all wheels, or one for each. Default: 0.0.
    """

    coulomb: float | Vector = DEFAULT
    """Coulomb friction (N m): one number for all wheels, or one for each. Default: 0.0."""
    viscous: float | Vector = DEFAULT
    """Viscous friction (N m s/rad): one number for all wheels, or one for each. Default: 0.0."""


class Complementary(Part):
    """Constant: from a bandwidth and a damping ratio of the error.

    Args:
        bandwidth: Bandwidth (rad/s): below it the attitude follows the sensors, above it the gyro.
        damping: Damping ratio. Default: 0.7.
    """

    _tag: ClassVar[str | None] = "complementary"

    bandwidth: float
    """Bandwidth (rad/s): below it the attitude follows the sensors, above it the gyro."""
    damping: float = DEFAULT
    """Damping ratio. Default: 0.7."""


class ControlMomentGyros(Part):
    """Control moment gyros of a spacecraft.

    Args:
        momentum: Angular momentum of each rotor, which is constant (N m s).
        arrangement: Arrangement; default: given by `gimbal_axes` and `spin_axes`.
        cant: For a pyramid: angle of each gimbal axis from z (rad); default: 0.9553 rad (54.74 degrees),
            with about equal momentum in all directions.
        gimbal_axes: Gimbal axis of each in the body's axes, of any length.
        spin_axes: Direction of the momentum of each with its gimbal at angle 0, of any length, at right
            angles to its gimbal axis.
        angles: Gimbal angles at the start (rad); default: 0.
        rate_limit: Largest gimbal rate (rad/s); no limit by default. If a demanded torque exceeds it, all
            rates are scaled down, and the torque keeps its axis.
        period: Time between updates of the gimbal rates, beside those at the law's commands (s); default:
            at these alone.
        steering: How the demanded torque becomes gimbal rates. Default: "singularity_robust".
        robust: The weight of `singularity_robust` steering.
        null_motion: Null motion towards preferred gimbal angles; none by default.
        faults: Intervals in which the gimbal rates fail: of all, or of the `gimbal` of a number from 1.
    """

    _tag: ClassVar[str | None] = "control_moment_gyros"

    momentum: float
    """Angular momentum of each rotor, which is constant (N m s)."""
    arrangement: Literal["pyramid"] = DEFAULT
    """Arrangement; default: given by `gimbal_axes` and `spin_axes`."""
    cant: float = DEFAULT
    """For a pyramid: angle of each gimbal axis from z (rad); default: 0.9553 rad (54.74 degrees), with
    about equal momentum in all directions.
    """
    gimbal_axes: Rows = DEFAULT
    """Gimbal axis of each in the body's axes, of any length."""
    spin_axes: Rows = DEFAULT
    """Direction of the momentum of each with its gimbal at angle 0, of any length, at right angles to its
    gimbal axis.
    """
    angles: Vector = DEFAULT
    """Gimbal angles at the start (rad); default: 0."""
    rate_limit: float = DEFAULT
    """Largest gimbal rate (rad/s); no limit by default. If a demanded torque exceeds it, all rates are
    scaled down, and the torque keeps its axis.
    """
    period: float = DEFAULT
    """Time between updates of the gimbal rates, beside those at the law's commands (s); default: at these
    alone.
    """
    steering: Literal["pseudo_inverse", "singularity_robust"] = DEFAULT
    """How the demanded torque becomes gimbal rates. Default: "singularity_robust"."""
    robust: Robustness = DEFAULT
    """The weight of `singularity_robust` steering."""
    null_motion: NullMotion = DEFAULT
    """Null motion towards preferred gimbal angles; none by default."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the gimbal rates fail: of all, or of the `gimbal` of a number from 1."""


class Correlated(Part):
    """Correlated keys of `[uncertain]`. Each key is drawn from a standard normal number; the matrix
    correlates these numbers, and each key keeps its own distribution. For normal distributions these are
    the correlations of the keys.

    Args:
        keys: The keys.
        matrix: The correlations: symmetric, with ones on the diagonal, in the order of the keys.
    """

    keys: Sequence[str]
    """The keys."""
    matrix: Rows
    """The correlations: symmetric, with ones on the diagonal, in the order of the keys."""


class Cosine(Part):
    """A series of cosines ([Rotation], equations (25) to (30)).

    Args:
        suppress: Number of modes left at rest, lowest frequencies first. Default: 0.
        zeros: Further zeros.
    """

    _tag: ClassVar[str | None] = "cosine"

    suppress: int = DEFAULT
    """Number of modes left at rest, lowest frequencies first. Default: 0."""
    zeros: Sequence[ShapedZero] = DEFAULT
    """Further zeros."""


class CraigBampton(Part):
    """Craig-Bampton model of an appendage, as its supplier hands it over: `MXX` and `KXX` of Nastran.

    Args:
        mass: Reduced mass matrix: rows of the root's displacements and rotations, and of modes that are
            clamped there.
        stiffness: Reduced stiffness matrix, in the same order.
        interface: Rows of the root, from 0: displacements along x, y and z, rotations about them.
    """

    mass: Rows | str
    """Reduced mass matrix: rows of the root's displacements and rotations, and of modes that are clamped
    there.
    """
    stiffness: Rows | str
    """Reduced stiffness matrix, in the same order."""
    interface: Sequence[int] = DEFAULT
    """Rows of the root, from 0: displacements along x, y and z, rotations about them."""


class DampingGuards(Part):
    """Guards of active damping.

    Args:
        dead_zone: Suppress pulses after which the rigid motion would need one. Default: true.
        eligibility: Without the predictor, damp only modes whose phase factor is at least 0.5. Default:
            true.
        residual: Act only while the observer tracks: the mean square innovation is below a tenth of that of
            the elastic rate, or below (3.16e-6 rad/s)². Default: true.
        watchdog: Pause active damping for 300 cycles if the mean elastic rate of 75 cycles with a pulse
            exceeds 0.9 times that of the 75 before. Default: true.
    """

    dead_zone: bool = DEFAULT
    """Suppress pulses after which the rigid motion would need one. Default: true."""
    eligibility: bool = DEFAULT
    """Without the predictor, damp only modes whose phase factor is at least 0.5. Default: true."""
    residual: bool = DEFAULT
    """Act only while the observer tracks: the mean square innovation is below a tenth of that of the
    elastic rate, or below (3.16e-6 rad/s)². Default: true.
    """
    watchdog: bool = DEFAULT
    """Pause active damping for 300 cycles if the mean elastic rate of 75 cycles with a pulse exceeds 0.9
    times that of the 75 before. Default: true.
    """


class Dead(Part):
    """No output.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
        about: Axis that fails, on a body with three; default: all.
        wheel: Wheel that fails, counted from 1; default: all.
        gimbal: Gimbal of `control_moment_gyros` that fails, counted from 1; default: all.
        thruster: Thruster of `jets` that fails; default: all.
    """

    _tag: ClassVar[str | None] = "dead"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""
    about: Literal["roll", "pitch", "yaw"] = DEFAULT
    """Axis that fails, on a body with three; default: all."""
    wheel: int = DEFAULT
    """Wheel that fails, counted from 1; default: all."""
    gimbal: int = DEFAULT
    """Gimbal of `control_moment_gyros` that fails, counted from 1; default: all."""
    thruster: str = DEFAULT
    """Thruster of `jets` that fails; default: all."""


class Dipole(Part):
    """A magnetic moment in the field of a dipole.

    Args:
        moment: Magnetic moment of the body (A m²), in its axes.
        strength: Field over the magnetic equator at the radius R of a circular orbit (T), mu/R³; for the
            Earth mu is 7.8e15 T m³. Default: the environment's magnetic field.
        inclination: Inclination of that orbit to the magnetic equator (rad).
        from_node: Angle from the ascending node at the start (rad).
        orbit_rate: Rate of that orbit (rad/s).
        local: Orientation of the local axes at the start, as for a gravity gradient.
    """

    moment: Vector
    """Magnetic moment of the body (A m²), in its axes."""
    strength: float = DEFAULT
    """Field over the magnetic equator at the radius R of a circular orbit (T), mu/R³; for the Earth mu is
    7.8e15 T m³. Default: the environment's magnetic field.
    """
    inclination: float = DEFAULT
    """Inclination of that orbit to the magnetic equator (rad)."""
    from_node: float = DEFAULT
    """Angle from the ascending node at the start (rad)."""
    orbit_rate: float = DEFAULT
    """Rate of that orbit (rad/s)."""
    local: Vector = DEFAULT
    """Orientation of the local axes at the start, as for a gravity gradient."""


class Disturbance(Part):
    """A disturbance: a torque about an axis, or a force at a point.

    Args:
        about: Axis about which it acts at the first point, on a body with three, where a torque must have
            one.
        torque: Torque (N m). Default: 0.0.
        sines: Sine terms added to the torque, on a `[spacecraft]`: amplitude sin(frequency t + phase), t
            from the start of the run.
        force: Force in the body's axes (N) in place of a torque, on a body with three axes: a leak, a stuck
            jet, a push.
        point: Name of the point at which the force, the density or the lines act; default: the first.
        noise: Spectral density of white noise added to the torque ((N m)² s); each draw is held for
            `period`. Default: 0.0.
        pulse: Pulses in place of a steady torque or force, each at the start of a period.
        period: Time for which a draw of the noise is held (s).
        table: Torques (s, N m) or forces in the body's axes (s, N, N, N) over time, or the path of a .csv
            file, in place of constant ones; times are from the start of the run. Each is held until the
            next, the last until `to`.
        density: Broadband force and torque at the point in place of a steady force, by their spectral
            densities.
        lines: Sinusoidal force and torque at the point in place of a steady force: the lines of a machine.
        from_: Start time (s). Default: 0.0.
        to: End time (s); default: the end of the run.
    """

    about: Literal["roll", "pitch", "yaw"] = DEFAULT
    """Axis about which it acts at the first point, on a body with three, where a torque must have one."""
    torque: float = DEFAULT
    """Torque (N m). Default: 0.0."""
    sines: Sequence[Sine] = DEFAULT
    """Sine terms added to the torque, on a `[spacecraft]`: amplitude sin(frequency t + phase), t from the
    start of the run.
    """
    force: Vector = DEFAULT
    """Force in the body's axes (N) in place of a torque, on a body with three axes: a leak, a stuck jet, a
    push.
    """
    point: str = DEFAULT
    """Name of the point at which the force, the density or the lines act; default: the first."""
    noise: float = DEFAULT
    """Spectral density of white noise added to the torque ((N m)² s); each draw is held for `period`.
    Default: 0.0.
    """
    pulse: Pulses = DEFAULT
    """Pulses in place of a steady torque or force, each at the start of a period."""
    period: float = DEFAULT
    """Time for which a draw of the noise is held (s)."""
    table: Rows | str = DEFAULT
    """Torques (s, N m) or forces in the body's axes (s, N, N, N) over time, or the path of a .csv file, in
    place of constant ones; times are from the start of the run. Each is held until the next, the last
    until `to`.
    """
    density: LoadDensity = DEFAULT
    """Broadband force and torque at the point in place of a steady force, by their spectral densities."""
    lines: LoadLines = DEFAULT
    """Sinusoidal force and torque at the point in place of a steady force: the lines of a machine."""
    from_: float = DEFAULT
    """Start time (s). Default: 0.0."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""


class Drag(Part):
    """Drag of the atmosphere.

    Args:
        plates: The plates: the force is -rho/2 C A (n.v) v where the outward normal n faces the flow; a
            plate with two sides is two entries.
        model: Model of the density; default: exponential.
        density: Density of the exponential model (kg/m³), at `altitude`.
        scale_height: Scale height, in which the density falls to 1/e (m); default: the density is uniform.
        altitude: Height above the planet's radius at which `density` holds (m), required with a `tle` or an
            `ephemeris`; default: that of the semi-major axis.
        table: Heights above the ellipsoid of WGS 84 and densities (m, kg/m³) of the model `table`,
            exponential between rows, or the path of a .csv file; they must cover the orbit.
        bulge_exponent: Exponent n of the bulge in the model of Harris and Priester: 2 for orbits near the
            equator, 6 for polar ones; default: 4.
        scale: Factor of the density, of every model, from 0.001 to 1000, for campaigns and worst cases;
            default: 1.
        coefficient: Drag coefficient. Default: 2.2.
        rotation: Rotation rate of the atmosphere with the planet (rad/s); default: the Earth's. Default:
            7.292115e-05.
    """

    plates: Sequence[DragPlate]
    """The plates: the force is -rho/2 C A (n.v) v where the outward normal n faces the flow; a plate with
    two sides is two entries.
    """
    model: Literal["exponential", "harris_priester", "table"] = DEFAULT
    """Model of the density; default: exponential."""
    density: float = DEFAULT
    """Density of the exponential model (kg/m³), at `altitude`."""
    scale_height: float = DEFAULT
    """Scale height, in which the density falls to 1/e (m); default: the density is uniform."""
    altitude: float = DEFAULT
    """Height above the planet's radius at which `density` holds (m), required with a `tle` or an
    `ephemeris`; default: that of the semi-major axis.
    """
    table: Rows | str = DEFAULT
    """Heights above the ellipsoid of WGS 84 and densities (m, kg/m³) of the model `table`, exponential
    between rows, or the path of a .csv file; they must cover the orbit.
    """
    bulge_exponent: float = DEFAULT
    """Exponent n of the bulge in the model of Harris and Priester: 2 for orbits near the equator, 6 for
    polar ones; default: 4.
    """
    scale: float = DEFAULT
    """Factor of the density, of every model, from 0.001 to 1000, for campaigns and worst cases; default: 1.
    """
    coefficient: float = DEFAULT
    """Drag coefficient. Default: 2.2."""
    rotation: float = DEFAULT
    """Rotation rate of the atmosphere with the planet (rad/s); default: the Earth's. Default: 7.292115e-05.
    """


class DragPlate(Part):
    """A plate; drag acts on one side of it.

    Args:
        area: Area (m²).
        normal: Outward normal in the body's axes, of any length.
        at: Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a
            spatial body.
        appendage: Name of the appendage on which the plate is, with which it turns; `normal` and `at` are
            then in its axes, from its root; default: the hub.
    """

    area: float
    """Area (m²)."""
    normal: Vector
    """Outward normal in the body's axes, of any length."""
    at: Vector
    """Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a spatial
    body.
    """
    appendage: str = DEFAULT
    """Name of the appendage on which the plate is, with which it turns; `normal` and `at` are then in its
    axes, from its root; default: the hub.
    """


class DrivePoint(Part):
    """An angle at a time.

    Args:
        time: Time since the start (s).
        angle: Angle (rad).
    """

    time: float
    """Time since the start (s)."""
    angle: float
    """Angle (rad)."""


class Each(Part, kw_only=False):
    """Each frequency has its own ratio, in the order of the modes."""

    _tag: ClassVar[str | None] = "each"

    value: Sequence[ProfileKind]


class EarthSensor(Part):
    """The direction to the planet's centre.

    Args:
        period: Period of its samples (s).
        boresight: Centre of its field of view, a direction in the body's axes, of any length; default: z.
        field_of_view: Half angle of the field of view (rad); default: all directions are visible. Default:
            3.141592653589793.
        point: Point of the structure at which it is mounted; default: the first of the body's points.
        noise: Standard deviation of the white noise along each axis (rad). Default: 0.0.
        bias: Constant error along each axis (rad). Default: 0.0.
        resolution: Quantum of the output along each axis (rad); 0 for none. Default: 0.0.
        scale: Relative error of the scale along each axis. Default: 0.0.
        misalignment: Misalignment (rad): row i gives what axis i measures of the direction along the other
            axes; the diagonal is 0.
        latency: Time from a sample to its output (s). Default: 0.0.
        faults: Intervals in which the Earth sensor fails.
    """

    _tag: ClassVar[str | None] = "earth_sensor"

    period: float
    """Period of its samples (s)."""
    boresight: Vector = DEFAULT
    """Centre of its field of view, a direction in the body's axes, of any length; default: z."""
    field_of_view: float = DEFAULT
    """Half angle of the field of view (rad); default: all directions are visible. Default:
    3.141592653589793.
    """
    point: str = DEFAULT
    """Point of the structure at which it is mounted; default: the first of the body's points."""
    noise: float | Vector = DEFAULT
    """Standard deviation of the white noise along each axis (rad). Default: 0.0."""
    bias: float | Vector = DEFAULT
    """Constant error along each axis (rad). Default: 0.0."""
    resolution: float | Vector = DEFAULT
    """Quantum of the output along each axis (rad); 0 for none. Default: 0.0."""
    scale: float | Vector = DEFAULT
    """Relative error of the scale along each axis. Default: 0.0."""
    misalignment: Rows = DEFAULT
    """Misalignment (rad): row i gives what axis i measures of the direction along the other axes; the
    diagonal is 0.
    """
    latency: float = DEFAULT
    """Time from a sample to its output (s). Default: 0.0."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the Earth sensor fails."""


class Ei(Part):
    """Extra insensitive: three impulses that allow a little vibration at the mode's frequency, and stay
    near it over a wider band.

    Args:
        modes: Indices of the modes.
        vibration: Residual vibration at the mode's frequency, relative to that of a single impulse.
            Default: 0.05.
    """

    _tag: ClassVar[str | None] = "ei"

    modes: Sequence[int] = DEFAULT
    """Indices of the modes."""
    vibration: float = DEFAULT
    """Residual vibration at the mode's frequency, relative to that of a single impulse. Default: 0.05."""


class ElasticStates(Part):
    """Elastic modes as states of the filter.

    Args:
        modes: Indices of the free modes, as `flexsc modes` lists them.
        noise: Random walk of the rate of each mode due to random forces (m sqrt(kg)/s^1.5).
        frequencies: Natural frequencies in the filter's model (rad/s); default: the body's own.
        factor: Factor on the frequencies: the error of the filter's model. Default: 1.0.
        frequency_deviation: Relative standard deviation of the frequencies at the start, which the filter
            then identifies; default: it takes them as known.
        frequency_walk: Random walk of the logarithm of each identified frequency (1/sqrt(s)); default:
            none.
        displacement: Standard deviation of each displacement at the start (m sqrt(kg)), about a mode at
            rest. Default: 0.001.
        rate: Standard deviation of each rate at the start (m sqrt(kg)/s); default: that of the displacement
            times the frequency.
        feeds: Estimates that the law reads: the rigid angle and rate, or those of the hub; default: rigid.
    """

    modes: Sequence[int]
    """Indices of the free modes, as `flexsc modes` lists them."""
    noise: float
    """Random walk of the rate of each mode due to random forces (m sqrt(kg)/s^1.5)."""
    frequencies: Vector = DEFAULT
    """Natural frequencies in the filter's model (rad/s); default: the body's own."""
    factor: float = DEFAULT
    """Factor on the frequencies: the error of the filter's model. Default: 1.0."""
    frequency_deviation: float = DEFAULT
    """Relative standard deviation of the frequencies at the start, which the filter then identifies;
    default: it takes them as known.
    """
    frequency_walk: float = DEFAULT
    """Random walk of the logarithm of each identified frequency (1/sqrt(s)); default: none."""
    displacement: float = DEFAULT
    """Standard deviation of each displacement at the start (m sqrt(kg)), about a mode at rest. Default:
    0.001.
    """
    rate: float = DEFAULT
    """Standard deviation of each rate at the start (m sqrt(kg)/s); default: that of the displacement times
    the frequency.
    """
    feeds: Literal["modes", "hub", "rigid"] = DEFAULT
    """Estimates that the law reads: the rigid angle and rate, or those of the hub; default: rigid."""


class ElementMessage(Part):
    """Mean elements of SGP4 with the keys and units of a message.

    Args:
        EPOCH: Date (UTC), as 2026-07-21T04:06:53.604864.
        MEAN_MOTION: Mean motion (revolutions a day).
        ECCENTRICITY: Eccentricity.
        INCLINATION: Inclination (deg).
        RA_OF_ASC_NODE: Right ascension of the ascending node (deg).
        ARG_OF_PERICENTER: Argument of perigee (deg).
        MEAN_ANOMALY: Mean anomaly (deg).
        BSTAR: Drag coefficient B* (1/radii of the Earth).
    """

    EPOCH: str
    """Date (UTC), as 2026-07-21T04:06:53.604864."""
    MEAN_MOTION: float
    """Mean motion (revolutions a day)."""
    ECCENTRICITY: float
    """Eccentricity."""
    INCLINATION: float
    """Inclination (deg)."""
    RA_OF_ASC_NODE: float
    """Right ascension of the ascending node (deg)."""
    ARG_OF_PERICENTER: float
    """Argument of perigee (deg)."""
    MEAN_ANOMALY: float
    """Mean anomaly (deg)."""
    BSTAR: float
    """Drag coefficient B* (1/radii of the Earth)."""


class Envelope(Part):
    """The envelope of the elastic modes and its window means.

    Args:
        window: Length of the windows over which the envelope is averaged (s).
        form: How the phasors are computed. Default: "dynamic".
        modes: Modes of the monitor's model; default: the body's own.
    """

    _tag: ClassVar[str | None] = "envelope"

    window: float
    """Length of the windows over which the envelope is averaged (s)."""
    form: Literal["dynamic", "trigonometric", "truth"] = DEFAULT
    """How the phasors are computed. Default: "dynamic"."""
    modes: Sequence[Mode] = DEFAULT
    """Modes of the monitor's model; default: the body's own."""


class Environment(Part):
    """The environment of a body with three axes. Its torques add up.

    Args:
        orbit: Orbit of the body; default: none, or the one given with a torque below.
        magnetic_field: The magnetic field of the orbit's planet.
        sun: Direction to the Sun in inertial axes, of any length, constant and at 1 au, or `"epoch"`: that
            from the Earth at the date, in equatorial axes with x to the equinox, within 0.01 degrees. The
            orbit's planet casts a shadow.
        shadow: Shape of the shadow that the orbit's planet casts, whose edges are events; it needs `orbit`
            and `sun`. Default: a cone.
        gravity_gradient: Gravity gradient of a circular orbit.
        solar_pressure: Pressure of sunlight.
        dipole: A magnetic moment of the body in the field of its planet.
        drag: Drag of the atmosphere on plates: a torque, by which the orbit does not decay.
        torque: A torque that is constant in inertial axes (N m).
    """

    orbit: Kepler | AltitudeOrbit | TwoLineOrbit | EphemerisOrbit = DEFAULT
    """Orbit of the body; default: none, or the one given with a torque below."""
    magnetic_field: MagneticField = DEFAULT
    """The magnetic field of the orbit's planet."""
    sun: Vector | Literal["epoch"] = DEFAULT
    """Direction to the Sun in inertial axes, of any length, constant and at 1 au, or `"epoch"`: that from
    the Earth at the date, in equatorial axes with x to the equinox, within 0.01 degrees. The orbit's
    planet casts a shadow.
    """
    shadow: Literal["cone", "cylinder"] = DEFAULT
    """Shape of the shadow that the orbit's planet casts, whose edges are events; it needs `orbit` and
    `sun`. Default: a cone.
    """
    gravity_gradient: GravityGradient = DEFAULT
    """Gravity gradient of a circular orbit."""
    solar_pressure: SolarPressure = DEFAULT
    """Pressure of sunlight."""
    dipole: Dipole = DEFAULT
    """A magnetic moment of the body in the field of its planet."""
    drag: Drag = DEFAULT
    """Drag of the atmosphere on plates: a torque, by which the orbit does not decay."""
    torque: Vector = DEFAULT
    """A torque that is constant in inertial axes (N m)."""


class EphemerisOrbit(Part):
    """Orbit by positions at instants.

    Args:
        ephemeris: Positions, rows [t, x, y, z] (s, m) in inertial axes from the planet's centre, or the
            path of their file.
        frame: Axes of the rows: `EME2000`, `GCRF` and `ICRF` are rotated by the precession to the start,
            which needs a date, the others are taken as inertial axes; default: those that the file names,
            else the run's inertial axes.
        gravity: Gravitational parameter of the planet (m³/s²); default: the Earth's. Default:
            398600441800000.0.
        planet_radius: Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
            Default: 6378137.0.
    """

    ephemeris: Rows | str
    """Positions, rows [t, x, y, z] (s, m) in inertial axes from the planet's centre, or the path of their
    file.
    """
    frame: Literal["EME2000", "GCRF", "ICRF", "MOD", "TEME", "TOD"] = DEFAULT
    """Axes of the rows: `EME2000`, `GCRF` and `ICRF` are rotated by the precession to the start, which
    needs a date, the others are taken as inertial axes; default: those that the file names, else the
    run's inertial axes.
    """
    gravity: float = DEFAULT
    """Gravitational parameter of the planet (m³/s²); default: the Earth's. Default: 398600441800000.0."""
    planet_radius: float = DEFAULT
    """Radius of the planet (m), for its shadow; default: the Earth's equatorial radius. Default: 6378137.0.
    """


class Exclusion(Part):
    """Angles between the boresight and bright bodies below which a star tracker gives no measurement.

    Args:
        sun: Least angle to the Sun's centre (rad); default: the Sun does not blind it.
        moon: Least angle to the Moon's centre (rad), at the scenario's `epoch`; default: the Moon does not
            blind it.
        limb: Least angle to the limb of the orbit's planet (rad); default: the planet does not blind it.
    """

    sun: float = DEFAULT
    """Least angle to the Sun's centre (rad); default: the Sun does not blind it."""
    moon: float = DEFAULT
    """Least angle to the Moon's centre (rad), at the scenario's `epoch`; default: the Moon does not blind
    it.
    """
    limb: float = DEFAULT
    """Least angle to the limb of the orbit's planet (rad); default: the planet does not blind it."""


class ExtendedKalman(Part):
    """An extended Kalman filter of the motion and the natural frequencies.

    Args:
        modes: Modes of the filter's model; default: the body's own at the start of each run.
        moment_noise: Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default:
            1e-13.
        angle_noise: Standard deviation of the measured angle (rad), required where the sensor has none,
            such as a gyro; default: that of the sensor, with the square of its `resolution` over 12 added
            to the variance.
        initial: Standard deviations of the estimate at the start.
        prior: Initial state estimate of the filter. Default: "drawn".
        dominant: Criterion for the dominant mode. Default: "excitability".
        assess: Interval over which the metrics assess the filter (s); default: the whole run.
        feeds: Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as
            measured; `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid
            angle and rate. By default, `modes` for a law that reads the dominant mode, else `hub`.
        watch_only: Whether the filter runs for assessment only: the law does not read it.
        ratios: Which frequencies drift together. Default: "common".
        ratio: Initial estimate of the frequency ratio: unless `prior` is `true`, the estimate is drawn
            around it. Default: 1.0.
        ratio_sd: Standard deviation of the initial ratio. Default: 0.03.
        ratio_rate_sd: Standard deviation of the ratio's initial rate, which is estimated as 0 (1/s).
            Default: 0.003.
        ratio_noise: Spectral density of the white noise in a ratio (1/s). Default: 1e-08.
        ratio_rate_noise: Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08.
        bounds: Bounds `[low, high]` of a ratio; a filter that reaches them has lost lock.
        substeps: Number of prediction steps per period, 1 to 100; with a gyro of 1e-6 rad/s use 8. Default:
            2.
        gate: Amplitude of the dominant mode, in standard deviations of the angle, below which the ratios
            are not updated. Default: 3.0.
    """

    _tag: ClassVar[str | None] = "extended_kalman"

    modes: Sequence[Mode] = DEFAULT
    """Modes of the filter's model; default: the body's own at the start of each run."""
    moment_noise: float = DEFAULT
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float = DEFAULT
    """Standard deviation of the measured angle (rad), required where the sensor has none, such as a gyro;
    default: that of the sensor, with the square of its `resolution` over 12 added to the variance.
    """
    initial: Initial = DEFAULT
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] = DEFAULT
    """Initial state estimate of the filter. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] = DEFAULT
    """Criterion for the dominant mode. Default: "excitability"."""
    assess: Vector = DEFAULT
    """Interval over which the metrics assess the filter (s); default: the whole run."""
    feeds: Literal["modes", "hub", "rigid"] = DEFAULT
    """Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid angle and rate. By
    default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool = DEFAULT
    """Whether the filter runs for assessment only: the law does not read it."""
    ratios: Literal["common", "each"] = DEFAULT
    """Which frequencies drift together. Default: "common"."""
    ratio: float = DEFAULT
    """Initial estimate of the frequency ratio: unless `prior` is `true`, the estimate is drawn around it.
    Default: 1.0.
    """
    ratio_sd: float = DEFAULT
    """Standard deviation of the initial ratio. Default: 0.03."""
    ratio_rate_sd: float = DEFAULT
    """Standard deviation of the ratio's initial rate, which is estimated as 0 (1/s). Default: 0.003."""
    ratio_noise: float = DEFAULT
    """Spectral density of the white noise in a ratio (1/s). Default: 1e-08."""
    ratio_rate_noise: float = DEFAULT
    """Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08."""
    bounds: Vector = DEFAULT
    """Bounds `[low, high]` of a ratio; a filter that reaches them has lost lock."""
    substeps: int = DEFAULT
    """Number of prediction steps per period, 1 to 100; with a gyro of 1e-6 rad/s use 8. Default: 2."""
    gate: float = DEFAULT
    """Amplitude of the dominant mode, in standard deviations of the angle, below which the ratios are not
    updated. Default: 3.0.
    """


class FineMirror(Part):
    """Fine mirror behind a line of sight. About each of two axes across the line, its command changes at
    the end of each period by `gain` times the mean of the error that is left, over an exposure of a
    guidance sensor. All angles are rotations of the line of sight. The reaction torque on the body is
    left out.

    Args:
        frequency: Natural frequency of the mirror on its drive (rad/s).
        damping: Damping ratio of the mirror on its drive: 1 critical.
        period: Period of its loop (s), over the whole of which the guidance sensor exposes.
        gain: Part of the mean error of an exposure by which the command changes.
        computing_periods: Whole periods from the end of an exposure to the change of the command that it
            causes. Default: 1.
        noise: Standard deviation of the noise of a mean over an exposure, about each axis (rad). Default:
            0.0.
        stroke: Largest command of either sign about each axis (rad); default: no limit.
        rate: Largest change of the command about each axis in a period, over the period (rad/s); default:
            no limit.
    """

    frequency: float
    """Natural frequency of the mirror on its drive (rad/s)."""
    damping: float
    """Damping ratio of the mirror on its drive: 1 critical."""
    period: float
    """Period of its loop (s), over the whole of which the guidance sensor exposes."""
    gain: float
    """Part of the mean error of an exposure by which the command changes."""
    computing_periods: int = DEFAULT
    """Whole periods from the end of an exposure to the change of the command that it causes. Default: 1."""
    noise: float = DEFAULT
    """Standard deviation of the noise of a mean over an exposure, about each axis (rad). Default: 0.0."""
    stroke: float = DEFAULT
    """Largest command of either sign about each axis (rad); default: no limit."""
    rate: float = DEFAULT
    """Largest change of the command about each axis in a period, over the period (rad/s); default: no
    limit.
    """


class Friction(Part):
    """Bearing friction: c Omega + t sgn Omega for a turning wheel, and up to the breakaway torque for a
    wheel at rest.

    Args:
        coulomb: Coulomb friction t (N m), at most 10 times `torque` and 500 rad/s² times `inertia`: one
            number for all wheels, or one for each. Default: 0.0.
        viscous: Viscous friction c (N m s/rad): one number for all wheels, or one for each. Default: 0.0.
        breakaway: Torque up to which the bearing holds a wheel at rest (N m): one number for all wheels, or
            one for each; default: the Coulomb friction.
    """

    coulomb: float | Vector = DEFAULT
    """Coulomb friction t (N m), at most 10 times `torque` and 500 rad/s² times `inertia`: one number for
    all wheels, or one for each. Default: 0.0.
    """
    viscous: float | Vector = DEFAULT
    """Viscous friction c (N m s/rad): one number for all wheels, or one for each. Default: 0.0."""
    breakaway: float | Vector = DEFAULT
    """Torque up to which the bearing holds a wheel at rest (N m): one number for all wheels, or one for
    each; default: the Coulomb friction.
    """


class Gain(Part, kw_only=False):
    """A constant gain."""

    _tag: ClassVar[str | None] = "gain"

    value: float


class Gate(Part):
    """Limits within which an attitude filter accepts readings. It always refuses those that are not finite,
    and quaternions and directions whose length differs from 1 by more than 0.001.

    Args:
        deviations: Largest innovation in standard deviations, the root of its normalised square over the
            number of components. A measurement above it is refused; with `elastic` none is. Default: 10.0.
        refusals: Number of refusals in a row after which the next measurement is accepted: the covariance
            grows by the innovation before the correction. Default: 5.
        gap: Time without a correction (s) after which a measurement above the limit is accepted at once, in
            the same way. Default: 300.0.
        rate: Largest rate about an axis (rad/s) that it takes from the gyro; default: the gyro's `range`,
            or 10 rad/s without one.
    """

    deviations: float = DEFAULT
    """Largest innovation in standard deviations, the root of its normalised square over the number of
    components. A measurement above it is refused; with `elastic` none is. Default: 10.0.
    """
    refusals: int = DEFAULT
    """Number of refusals in a row after which the next measurement is accepted: the covariance grows by the
    innovation before the correction. Default: 5.
    """
    gap: float = DEFAULT
    """Time without a correction (s) after which a measurement above the limit is accepted at once, in the
    same way. Default: 300.0.
    """
    rate: float = DEFAULT
    """Largest rate about an axis (rad/s) that it takes from the gyro; default: the gyro's `range`, or 10
    rad/s without one.
    """


class Given(Part):
    """Modes to track about each axis. The influence has one element per group of jets (roll, pitch, yaw),
    or a single one for the axis' own group if `cross_axis` is false.

    Args:
        roll: About x.
        pitch: About y.
        yaw: About z.
    """

    roll: Sequence[Tracker] = DEFAULT
    """About x."""
    pitch: Sequence[Tracker] = DEFAULT
    """About y."""
    yaw: Sequence[Tracker] = DEFAULT
    """About z."""


class Gradient(Part):
    """Recursive gradient with exact pulses.

    Args:
        damping: Damping ratio of the modes, which is not identified. Default: 0.005.
        rigid_gain: Gain of the rigid rate: the fraction of an innovation by which it is corrected. Default:
            0.03.
        elastic_gain: Gain of each elastic rate; default: 0.15 for one mode and 0.1 for several.
        rate: Rate of the identification; 0 for none. It converges if this is below 0.05 divided by the
            number of modes. Default: 0.02.
        gate: Amplitude of a mode's elastic rate (rad/s) below which its frequency is not updated. Default:
            5e-06.
        influence_bounds: Bounds of an influence, as multiples of its initial value.
        reach: Default bounds of a frequency: its initial value divided by this factor, and multiplied by
            it. Default: 2.0.
    """

    _tag: ClassVar[str | None] = "gradient"

    damping: float = DEFAULT
    """Damping ratio of the modes, which is not identified. Default: 0.005."""
    rigid_gain: float = DEFAULT
    """Gain of the rigid rate: the fraction of an innovation by which it is corrected. Default: 0.03."""
    elastic_gain: float = DEFAULT
    """Gain of each elastic rate; default: 0.15 for one mode and 0.1 for several."""
    rate: float = DEFAULT
    """Rate of the identification; 0 for none. It converges if this is below 0.05 divided by the number of
    modes. Default: 0.02.
    """
    gate: float = DEFAULT
    """Amplitude of a mode's elastic rate (rad/s) below which its frequency is not updated. Default: 5e-06.
    """
    influence_bounds: Vector = DEFAULT
    """Bounds of an influence, as multiples of its initial value."""
    reach: float = DEFAULT
    """Default bounds of a frequency: its initial value divided by this factor, and multiplied by it.
    Default: 2.0.
    """


class GravityGradient(Part):
    """Gravity gradient.

    Args:
        orbit_rate: Rate of a circular orbit (rad/s); default: the environment's orbit.
        local: Orientation of that orbit's local axes at the start, a unit quaternion [w, x, y, z] that
            turns vectors of the local axes (x along the velocity, y against the orbit's normal, z nadir)
            into inertial ones; default: the inertial axes.
    """

    orbit_rate: float = DEFAULT
    """Rate of a circular orbit (rad/s); default: the environment's orbit."""
    local: Vector = DEFAULT
    """Orientation of that orbit's local axes at the start, a unit quaternion [w, x, y, z] that turns
    vectors of the local axes (x along the velocity, y against the orbit's normal, z nadir) into inertial
    ones; default: the inertial axes.
    """


class Groups(Part):
    """The groups: for each axis, names of the thrusters that turn the body about it one way and the other.

    Args:
        roll: About x; needed if the jets act about it.
        pitch: About y; needed if the jets act about it.
        yaw: About z; needed if the jets act about it.
    """

    roll: Pair = DEFAULT
    """About x; needed if the jets act about it."""
    pitch: Pair = DEFAULT
    """About y; needed if the jets act about it."""
    yaw: Pair = DEFAULT
    """About z; needed if the jets act about it."""


class Gyro(Part):
    """A rate gyro, read in each cycle of the law; the angle, or the attitude, is known exactly.

    Args:
        point: Point of the structure at which it is mounted, on a body with three axes; default: the first
            of the body's points.
        period: Period of its samples (s); default: that of the law, if it has one.
        noise: Standard deviation of the white noise about each axis (rad/s). Default: 0.0.
        bias: Constant error about each axis (rad/s). Default: 0.0.
        resolution: Quantum of the output about each axis (rad/s); 0 for none. Default: 0.0.
        angle_random_walk: Angle random walk of an integrating gyro about each axis (rad/sqrt(s)).
        rate_random_walk: Rate random walk of the bias of an integrating gyro about each axis (rad/s^1.5).
        quantum: Quantum of the angle of an integrating gyro about each axis (rad); the remainder carries
            over to the next sample; 0 for none.
        bias_instability: Standard deviation of the part of the bias about each axis that wanders,
            exponentially correlated (rad/s); 0 for none. It is 0 at the start.
        correlation_time: Correlation time of that part (s), required with it.
        latency: How late it reports a rate (s), a whole number of periods; until the first report it gives
            the rate of the start. Default: 0.
        scale: Relative error of the scale about each axis.
        misalignment: Misalignment (rad), on a body with three axes: row i gives what axis i measures of the
            rates about the other axes; the diagonal is 0.
        range: Largest rate that it outputs about each axis (rad/s), at which it clips; default: no limit.
        faults: Intervals in which the gyro fails; star trackers still give the attitude.
    """

    _tag: ClassVar[str | None] = "gyro"

    point: str = DEFAULT
    """Point of the structure at which it is mounted, on a body with three axes; default: the first of the
    body's points.
    """
    period: float = DEFAULT
    """Period of its samples (s); default: that of the law, if it has one."""
    noise: float | Vector = DEFAULT
    """Standard deviation of the white noise about each axis (rad/s). Default: 0.0."""
    bias: float | Vector = DEFAULT
    """Constant error about each axis (rad/s). Default: 0.0."""
    resolution: float | Vector = DEFAULT
    """Quantum of the output about each axis (rad/s); 0 for none. Default: 0.0."""
    angle_random_walk: float | Vector = DEFAULT
    """Angle random walk of an integrating gyro about each axis (rad/sqrt(s))."""
    rate_random_walk: float | Vector = DEFAULT
    """Rate random walk of the bias of an integrating gyro about each axis (rad/s^1.5)."""
    quantum: float | Vector = DEFAULT
    """Quantum of the angle of an integrating gyro about each axis (rad); the remainder carries over to the
    next sample; 0 for none.
    """
    bias_instability: float | Vector = DEFAULT
    """Standard deviation of the part of the bias about each axis that wanders, exponentially correlated
    (rad/s); 0 for none. It is 0 at the start.
    """
    correlation_time: float = DEFAULT
    """Correlation time of that part (s), required with it."""
    latency: float = DEFAULT
    """How late it reports a rate (s), a whole number of periods; until the first report it gives the rate
    of the start. Default: 0.
    """
    scale: float | Vector = DEFAULT
    """Relative error of the scale about each axis."""
    misalignment: Rows = DEFAULT
    """Misalignment (rad), on a body with three axes: row i gives what axis i measures of the rates about
    the other axes; the diagonal is 0.
    """
    range: float | Vector = DEFAULT
    """Largest rate that it outputs about each axis (rad/s), at which it clips; default: no limit."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the gyro fails; star trackers still give the attitude."""


class Harmonic(Part):
    """A harmonic of the imbalance.

    Args:
        order: Order k: periods per turn of the wheel; it may be fractional.
        force: Force perpendicular to the axis over the square of the speed (kg m). Default: 0.0.
        torque: Torque perpendicular to the axis over the square of the speed (kg m²). Default: 0.0.
        axial: Force along the axis per (rad/s)² (kg m), proportional to cos(k th + phase). Default: 0.0.
        phase: Phase of the harmonic (rad). Default: 0.0.
    """

    order: float
    """Order k: periods per turn of the wheel; it may be fractional."""
    force: float = DEFAULT
    """Force perpendicular to the axis over the square of the speed (kg m). Default: 0.0."""
    torque: float = DEFAULT
    """Torque perpendicular to the axis over the square of the speed (kg m²). Default: 0.0."""
    axial: float = DEFAULT
    """Force along the axis per (rad/s)² (kg m), proportional to cos(k th + phase). Default: 0.0."""
    phase: float = DEFAULT
    """Phase of the harmonic (rad). Default: 0.0."""


class Hinge(Part):
    """A hinge: a spring and a damper about one axis at the root.

    Args:
        about: Axis through the root, in the axes of the appendage, of any nonzero length.
        stiffness: Stiffness of its spring, above 0 (N m/rad); the spring is relaxed at angle 0.
        damping: Viscous damping (N m s/rad). Default: 0.0.
        angle: Angle at the start (rad), -3.2 to 3.2; the hub starts with the attitude of the spacecraft
            whatever the angle. Default: 0.0.
        rate: Rate at the start (rad/s); the hub starts with the rate of the spacecraft. Default: 0.0.
    """

    about: Vector
    """Axis through the root, in the axes of the appendage, of any nonzero length."""
    stiffness: float
    """Stiffness of its spring, above 0 (N m/rad); the spring is relaxed at angle 0."""
    damping: float = DEFAULT
    """Viscous damping (N m s/rad). Default: 0.0."""
    angle: float = DEFAULT
    """Angle at the start (rad), -3.2 to 3.2; the hub starts with the attitude of the spacecraft whatever
    the angle. Default: 0.0.
    """
    rate: float = DEFAULT
    """Rate at the start (rad/s); the hub starts with the rate of the spacecraft. Default: 0.0."""


class HoldActuator(Part):
    """A zero-order hold: the mean of the manoeuvre's command over each period, and the feedback at its
    start.

    Args:
        period: Period of the hold (s): it gives the mean of the planned torque over the period plus the
            law's torque at its start.
        phase: Time of the first period (s), before which it gives nothing; default: 0.
        faults: Intervals in which the actuator fails.
    """

    _tag: ClassVar[str | None] = "hold"

    period: float
    """Period of the hold (s): it gives the mean of the planned torque over the period plus the law's torque
    at its start.
    """
    phase: float = DEFAULT
    """Time of the first period (s), before which it gives nothing; default: 0."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the actuator fails."""


class Ideal(Part):
    """The command itself, at every instant.

    Args:
        faults: Intervals in which the actuator fails.
    """

    _tag: ClassVar[str | None] = "ideal"

    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the actuator fails."""


class Imbalance(Part):
    """Imbalance of wheels: forces and torques on the body at wheel speed Omega and angle th. Each force and
    torque is its coefficient times Omega², along e1 cos(k th + phase) + e2 sin(k th + phase), where e1
    is z x a of the wheel's axis a, or x of one along z, and e2 is a x e1. The angle th begins at
    `angle`.

    Args:
        static: Static imbalance (kg m): the force across the axis once per turn is this times the square of
            the speed; one number for all wheels, or one for each. Default: 0.0.
        dynamic: Dynamic imbalance (kg m²): the torque across the axis once per turn is this times the
            square of the speed; one number for all wheels, or one for each. Default: 0.0.
        phase: Phase lead of the torque over the force (rad); one number for all wheels, or one for each.
            Default: 0.0.
        angle: Angle of the rotor at the start (rad); one number for all wheels, or one for each: with equal
            angles, wheels that turn against each other cancel in part.
        harmonics: Further harmonics of the speed, the same for all wheels.
        point: Point of the structure at which the wheels shake; default: `points` of the wheels, else the
            first of the body's points.
        positions: Position of each wheel relative to that point (m); default: at the point.
    """

    static: float | Vector = DEFAULT
    """Static imbalance (kg m): the force across the axis once per turn is this times the square of the
    speed; one number for all wheels, or one for each. Default: 0.0.
    """
    dynamic: float | Vector = DEFAULT
    """Dynamic imbalance (kg m²): the torque across the axis once per turn is this times the square of the
    speed; one number for all wheels, or one for each. Default: 0.0.
    """
    phase: float | Vector = DEFAULT
    """Phase lead of the torque over the force (rad); one number for all wheels, or one for each. Default:
    0.0.
    """
    angle: float | Vector = DEFAULT
    """Angle of the rotor at the start (rad); one number for all wheels, or one for each: with equal angles,
    wheels that turn against each other cancel in part.
    """
    harmonics: Sequence[Harmonic] = DEFAULT
    """Further harmonics of the speed, the same for all wheels."""
    point: str = DEFAULT
    """Point of the structure at which the wheels shake; default: `points` of the wheels, else the first of
    the body's points.
    """
    positions: Rows = DEFAULT
    """Position of each wheel relative to that point (m); default: at the point."""


class Inertial(Part, kw_only=False):
    """Direction of any length, constant in inertial axes."""

    _tag: ClassVar[str | None] = "inertial"

    value: Vector


class Initial(Part):
    """Standard deviations of a filter's estimate at the start.

    Args:
        angle: Standard deviation of the rigid angle (rad). Default: 0.0001.
        rate: Standard deviation of the rigid rate (rad/s). Default: 0.0001.
        displacement: Standard deviation of the displacement of the mode with the largest k/w² (rad); a
            tenth of it for the other modes. Default: 0.002.
        mode_rate: Standard deviation of the rate of that mode (rad/s); a tenth of it for the other modes.
            Default: 0.0006.
    """

    angle: float = DEFAULT
    """Standard deviation of the rigid angle (rad). Default: 0.0001."""
    rate: float = DEFAULT
    """Standard deviation of the rigid rate (rad/s). Default: 0.0001."""
    displacement: float = DEFAULT
    """Standard deviation of the displacement of the mode with the largest k/w² (rad); a tenth of it for the
    other modes. Default: 0.002.
    """
    mode_rate: float = DEFAULT
    """Standard deviation of the rate of that mode (rad/s); a tenth of it for the other modes. Default:
    0.0006.
    """


class Integral(Part):
    """The integral of the error.

    Args:
        time: Time constant t of the integral (s).
        limit: Largest integral (rad s). The integral also stops while the torque or the rate is at its
            limit and the error would increase it.
    """

    time: float
    """Time constant t of the integral (s)."""
    limit: float
    """Largest integral (rad s). The integral also stops while the torque or the rate is at its limit and
    the error would increase it.
    """


class Invalid(Part):
    """Readings that are NaN, and marked as valid.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
    """

    _tag: ClassVar[str | None] = "invalid"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""


class Jets(Part):
    """Thrusters at points of a spatial body.

    Args:
        specific_impulse: Specific impulse (s): thrust per unit of propellant weight flow.
        thrusters: The thrusters.
        minimum_on: Shortest pulse (s); a shorter one is not given, and does not carry over to the next.
            Default: 0.0.
        quantum: Quantum of a pulse's length (s); 0 for none. Default: 0.0.
        period: Period of the pulses (s); default: that of the law, which must then be one for all axes.
        phase: Time of the first cycle of pulses, for jets with a `period` (s); default: 0.
        delay: Delay from a command to its pulses in whole cycles: 0, or 1 if computing it takes a cycle.
            Default: 0.
        allocation: How the demand is converted into pulses; default: `groups`.
        force_free: For `least_propellant`: whether the forces of the pulses must cancel.
        burns: For `least_propellant`: burns, in which a force is commanded beside the torques.
        groups: For `groups`: the thrusters that act together about each axis about which the jets act.
        faults: Intervals in which the jets fail, all or the one named `thruster`: `stuck` at 1 fires all
            the time, and `added` is a leak (N).
    """

    _tag: ClassVar[str | None] = "jets"

    specific_impulse: float
    """Specific impulse (s): thrust per unit of propellant weight flow."""
    thrusters: Sequence[Thruster]
    """The thrusters."""
    minimum_on: float = DEFAULT
    """Shortest pulse (s); a shorter one is not given, and does not carry over to the next. Default: 0.0."""
    quantum: float = DEFAULT
    """Quantum of a pulse's length (s); 0 for none. Default: 0.0."""
    period: float = DEFAULT
    """Period of the pulses (s); default: that of the law, which must then be one for all axes."""
    phase: float = DEFAULT
    """Time of the first cycle of pulses, for jets with a `period` (s); default: 0."""
    delay: int = DEFAULT
    """Delay from a command to its pulses in whole cycles: 0, or 1 if computing it takes a cycle. Default:
    0.
    """
    allocation: Literal["groups", "least_propellant"] = DEFAULT
    """How the demand is converted into pulses; default: `groups`."""
    force_free: bool = DEFAULT
    """For `least_propellant`: whether the forces of the pulses must cancel."""
    burns: Sequence[Burn] = DEFAULT
    """For `least_propellant`: burns, in which a force is commanded beside the torques."""
    groups: Groups = DEFAULT
    """For `groups`: the thrusters that act together about each axis about which the jets act."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the jets fail, all or the one named `thruster`: `stuck` at 1 fires all the time,
    and `added` is a leak (N).
    """


class Kalman(Part):
    """A Kalman filter of the motion, with constant natural frequencies.

    Args:
        modes: Modes of the filter's model; default: the body's own at the start of each run.
        moment_noise: Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default:
            1e-13.
        angle_noise: Standard deviation of the measured angle (rad), required where the sensor has none,
            such as a gyro; default: that of the sensor, with the square of its `resolution` over 12 added
            to the variance.
        initial: Standard deviations of the estimate at the start.
        prior: Initial state estimate of the filter. Default: "drawn".
        dominant: Criterion for the dominant mode. Default: "excitability".
        assess: Interval over which the metrics assess the filter (s); default: the whole run.
        feeds: Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as
            measured; `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid
            angle and rate. By default, `modes` for a law that reads the dominant mode, else `hub`.
        watch_only: Whether the filter runs for assessment only: the law does not read it.
    """

    _tag: ClassVar[str | None] = "kalman"

    modes: Sequence[Mode] = DEFAULT
    """Modes of the filter's model; default: the body's own at the start of each run."""
    moment_noise: float = DEFAULT
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float = DEFAULT
    """Standard deviation of the measured angle (rad), required where the sensor has none, such as a gyro;
    default: that of the sensor, with the square of its `resolution` over 12 added to the variance.
    """
    initial: Initial = DEFAULT
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] = DEFAULT
    """Initial state estimate of the filter. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] = DEFAULT
    """Criterion for the dominant mode. Default: "excitability"."""
    assess: Vector = DEFAULT
    """Interval over which the metrics assess the filter (s); default: the whole run."""
    feeds: Literal["modes", "hub", "rigid"] = DEFAULT
    """Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid angle and rate. By
    default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool = DEFAULT
    """Whether the filter runs for assessment only: the law does not read it."""


class Kepler(Part):
    """A Kepler orbit. Inertial axes are those of the planet's equator: z along its axis of rotation.

    Args:
        semi_major_axis: Semi-major axis (m); for a circular orbit, its radius. Inertial axes are then those
            of the planet's equator, z along its axis.
        eccentricity: Eccentricity. Default: 0.0.
        inclination: Inclination to the equator (rad). Default: 0.0.
        node: Angle from the inertial x to the ascending node (rad). Default: 0.0.
        perigee: Angle from the node to the perigee (rad). Default: 0.0.
        anomaly: Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee. Default:
            0.0.
        gravity: Gravitational parameter of the planet (m³/s²); default: the Earth's. Default:
            398600441800000.0.
        planet_radius: Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
            Default: 6378137.0.
        j2: Coefficient J2 of the planet's oblateness, by which node, perigee and anomaly drift at their
            mean rates, without the short-period terms of some kilometres: `true` for that of the Earth, or
            a number; default: a sphere.
    """

    semi_major_axis: float
    """Semi-major axis (m); for a circular orbit, its radius. Inertial axes are then those of the planet's
    equator, z along its axis.
    """
    eccentricity: float = DEFAULT
    """Eccentricity. Default: 0.0."""
    inclination: float = DEFAULT
    """Inclination to the equator (rad). Default: 0.0."""
    node: float = DEFAULT
    """Angle from the inertial x to the ascending node (rad). Default: 0.0."""
    perigee: float = DEFAULT
    """Angle from the node to the perigee (rad). Default: 0.0."""
    anomaly: float = DEFAULT
    """Mean anomaly at the start (rad); for a circular orbit, the angle from the perigee. Default: 0.0."""
    gravity: float = DEFAULT
    """Gravitational parameter of the planet (m³/s²); default: the Earth's. Default: 398600441800000.0."""
    planet_radius: float = DEFAULT
    """Radius of the planet (m), for its shadow; default: the Earth's equatorial radius. Default: 6378137.0.
    """
    j2: bool | float = DEFAULT
    """Coefficient J2 of the planet's oblateness, by which node, perigee and anomaly drift at their mean
    rates, without the short-period terms of some kilometres: `true` for that of the Earth, or a number;
    default: a sphere.
    """


class Lead(Part):
    """(1 + s/zero)/(1 + s/pole): a lead with the zero below the pole, else a lag, exact at sqrt(zero pole),
    where its phase is largest.

    Args:
        zero: The zero (rad/s).
        pole: The pole (rad/s).
    """

    _tag: ClassVar[str | None] = "lead"

    zero: float
    """The zero (rad/s)."""
    pole: float
    """The pole (rad/s)."""


class LineOfSight(Part):
    """Line of sight of an instrument at a named point of a three-axis body, which is recorded and assessed.
    Nothing in the control loop reads it.

    Args:
        point: Point of the structure at which the instrument is mounted.
        period: Period of its samples (s).
        axis: Direction of the line of sight, of any length, in the body's axes with the structure
            undeformed.
        optics: Mirrors, lenses and detectors whose motions add up to that of the line of sight, along an
            axis of the body; default: it turns with `point`.
        measured: Measured responses of the line of sight to forces and torques at points, in place of the
            model: for linear tools.
        mirror: Mirror that turns the image back, in a loop of its own; errors of the line of sight are then
            those behind it.
        window: Start and end (s) of the interval in which it is assessed; default: the whole run.
        jitter_window: Length (s) of the windows within which jitter is assessed, such as an exposure time:
            the deviation from the mean over each window. Default: no jitter is assessed.
    """

    point: str
    """Point of the structure at which the instrument is mounted."""
    period: float
    """Period of its samples (s)."""
    axis: Vector = DEFAULT
    """Direction of the line of sight, of any length, in the body's axes with the structure undeformed."""
    optics: Sequence[OpticalElement] = DEFAULT
    """Mirrors, lenses and detectors whose motions add up to that of the line of sight, along an axis of the
    body; default: it turns with `point`.
    """
    measured: Sequence[MeasuredPath] = DEFAULT
    """Measured responses of the line of sight to forces and torques at points, in place of the model: for
    linear tools.
    """
    mirror: FineMirror = DEFAULT
    """Mirror that turns the image back, in a loop of its own; errors of the line of sight are then those
    behind it.
    """
    window: Vector = DEFAULT
    """Start and end (s) of the interval in which it is assessed; default: the whole run."""
    jitter_window: float = DEFAULT
    """Length (s) of the windows within which jitter is assessed, such as an exposure time: the deviation
    from the mean over each window. Default: no jitter is assessed.
    """


class LitPlate(Part):
    """A plate; sunlight presses on one side of it.

    Args:
        area: Area (m²).
        normal: Outward normal in the body's axes, of any length.
        at: Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a
            spatial body.
        appendage: Name of the appendage on which the plate is, with which it turns; `normal` and `at` are
            then in its axes, from its root; default: the hub.
        specular: The part of the light that it reflects like a mirror. Default: 0.0.
        diffuse: The part that it reflects diffusely. Default: 0.0.
    """

    area: float
    """Area (m²)."""
    normal: Vector
    """Outward normal in the body's axes, of any length."""
    at: Vector
    """Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a spatial
    body.
    """
    appendage: str = DEFAULT
    """Name of the appendage on which the plate is, with which it turns; `normal` and `at` are then in its
    axes, from its root; default: the hub.
    """
    specular: float = DEFAULT
    """The part of the light that it reflects like a mirror. Default: 0.0."""
    diffuse: float = DEFAULT
    """The part that it reflects diffusely. Default: 0.0."""


class LoadDensity(Part):
    """Stationary Gaussian force and torque at a point, whose components are independent but for
    `correlation`: one-sided densities that are constant between two corners, or a table over frequency.
    Below `lower` a density falls with the fourth power of the frequency, above `upper` with its inverse:
    filters of the second order with a damping ratio of 0.7. A table is linear between its rows on
    logarithmic scales, and zero outside.

    Args:
        force: One-sided density of the force along x, y and z between the corners (N²/Hz).
        torque: One-sided density of the torque about x, y and z between the corners ((N m)²/Hz).
        correlation: Correlation of the components: three rows for the force along x, y and z, or six with
            the torque about x, y and z; symmetric, with 1 on the diagonal. Default: none.
        lower: Lower corner (rad/s).
        upper: Upper corner (rad/s).
        table: Densities over frequency in place of the corners, or the path of a .csv file: frequency (Hz)
            and density of the force (N²/Hz), the same along all axes or along x, y and z, which those of
            the torque about x, y and z ((N m)²/Hz) may follow.
    """

    force: Vector = DEFAULT
    """One-sided density of the force along x, y and z between the corners (N²/Hz)."""
    torque: Vector = DEFAULT
    """One-sided density of the torque about x, y and z between the corners ((N m)²/Hz)."""
    correlation: Rows = DEFAULT
    """Correlation of the components: three rows for the force along x, y and z, or six with the torque
    about x, y and z; symmetric, with 1 on the diagonal. Default: none.
    """
    lower: float = DEFAULT
    """Lower corner (rad/s)."""
    upper: float = DEFAULT
    """Upper corner (rad/s)."""
    table: Rows | str = DEFAULT
    """Densities over frequency in place of the corners, or the path of a .csv file: frequency (Hz) and
    density of the force (N²/Hz), the same along all axes or along x, y and z, which those of the torque
    about x, y and z ((N m)²/Hz) may follow.
    """


class LoadHarmonic(Part):
    """Harmonic of a machine: a force and a torque times cos(order steps frequency t + phase).

    Args:
        order: Order: periods per period of the machine, or per step of a motor; it need not be whole. Two
            of one order with different phases make a load that turns.
        force: Amplitude of the force along x, y and z (N).
        torque: Amplitude of the torque about x, y and z (N m).
        phase: Phase (rad). Default: 0.0.
    """

    order: float
    """Order: periods per period of the machine, or per step of a motor; it need not be whole. Two of one
    order with different phases make a load that turns.
    """
    force: Vector = DEFAULT
    """Amplitude of the force along x, y and z (N)."""
    torque: Vector = DEFAULT
    """Amplitude of the torque about x, y and z (N m)."""
    phase: float = DEFAULT
    """Phase (rad). Default: 0.0."""


class LoadLines(Part):
    """Sinusoidal forces and torques at a point, at multiples of one frequency: a cooler, the step motor of
    a drive, a bearing.

    Args:
        frequency: Frequency of the order 1 (rad/s): of the strokes of a cooler, or the speed of a drive or
            a bearing.
        harmonics: Harmonics, whose phases are fixed among them.
        tolerance: Part of the frequency by which it may differ: linear tools take the worst frequency in
            this range, each run draws one. Default: 0.0.
        steps: Steps, or microsteps, of a motor in a turn, of which the orders are multiples. Default: 1.0.
    """

    frequency: float
    """Frequency of the order 1 (rad/s): of the strokes of a cooler, or the speed of a drive or a bearing."""
    harmonics: Sequence[LoadHarmonic]
    """Harmonics, whose phases are fixed among them."""
    tolerance: float = DEFAULT
    """Part of the frequency by which it may differ: linear tools take the worst frequency in this range,
    each run draws one. Default: 0.0.
    """
    steps: float = DEFAULT
    """Steps, or microsteps, of a motor in a turn, of which the orders are multiples. Default: 1.0."""


class LogContents(Part):
    """Contents of a full log.

    Args:
        period: Sampling period of the motion in a full log (s); default: the first of 0.1, 0.2, 0.5, 1, 2,
            5 and so on that gives at most 10 000 samples.
        scene: How the scene of a log is drawn.
    """

    period: float = DEFAULT
    """Sampling period of the motion in a full log (s); default: the first of 0.1, 0.2, 0.5, 1, 2, 5 and so
    on that gives at most 10 000 samples.
    """
    scene: SceneSpec = DEFAULT
    """How the scene of a log is drawn."""


class LogUniform(Part, kw_only=False):
    """Log-uniform between two positive values."""

    _tag: ClassVar[str | None] = "log_uniform"

    value: Vector


class LowPass(Part):
    """w²/(s² + 2 zeta w s + w²).

    Args:
        frequency: The frequency w (rad/s).
        damping: The damping ratio zeta. Default: 0.7071067811865476.
    """

    _tag: ClassVar[str | None] = "low_pass"

    frequency: float
    """The frequency w (rad/s)."""
    damping: float = DEFAULT
    """The damping ratio zeta. Default: 0.7071067811865476."""


class MagneticField(Part):
    """Magnetic field of the orbit's planet: a model of the Earth's, or a tilted dipole, B = (a/R)³ (3 (g.r)
    r - g) with r the direction from the planet's centre and g, which points south.

    Args:
        model: Model of the field, which stays that of the `epoch` during the run and is refused outside its
            years; default: that of the `table`, else the dipole, and IGRF-14 in a scenario with an `epoch`
            unless `coefficients` or `radius` differ from their defaults.
        table: Gauss coefficients, or the path of their file: .shc, or .COF as of the World Magnetic Model.
        degree: Degree up to which a model's spherical harmonics are taken, from 1 on; default: the model's
            highest, 13 of IGRF-14, 12 of WMM2025, and up to 13 of a table.
        coefficients: Coefficients g11, h11 and g10 of a dipole (T), a vector in axes that rotate with the
            planet: z along its axis, x through its prime meridian; default: the Earth's from IGRF-13 for
            2020.
        radius: Reference radius a of the coefficients of a dipole or a table (m); default: the Earth's mean
            radius. Default: 6371200.0.
        rotation: Rotation rate of the planet (rad/s); default: the Earth's. Default: 7.292115e-05.
        meridian: Angle from the inertial x to the prime meridian at the start (rad); default: that of
            Greenwich at the scenario's `epoch`, so that field and Sun belong to one hour, 0 without one.
    """

    model: Literal["dipole", "IGRF-14", "WMM2025", "table"] = DEFAULT
    """Model of the field, which stays that of the `epoch` during the run and is refused outside its years;
    default: that of the `table`, else the dipole, and IGRF-14 in a scenario with an `epoch` unless
    `coefficients` or `radius` differ from their defaults.
    """
    table: Mapping[str, object] | str = DEFAULT
    """Gauss coefficients, or the path of their file: .shc, or .COF as of the World Magnetic Model."""
    degree: int = DEFAULT
    """Degree up to which a model's spherical harmonics are taken, from 1 on; default: the model's highest,
    13 of IGRF-14, 12 of WMM2025, and up to 13 of a table.
    """
    coefficients: Vector = DEFAULT
    """Coefficients g11, h11 and g10 of a dipole (T), a vector in axes that rotate with the planet: z along
    its axis, x through its prime meridian; default: the Earth's from IGRF-13 for 2020.
    """
    radius: float = DEFAULT
    """Reference radius a of the coefficients of a dipole or a table (m); default: the Earth's mean radius.
    Default: 6371200.0.
    """
    rotation: float = DEFAULT
    """Rotation rate of the planet (rad/s); default: the Earth's. Default: 7.292115e-05."""
    meridian: float = DEFAULT
    """Angle from the inertial x to the prime meridian at the start (rad); default: that of Greenwich at the
    scenario's `epoch`, so that field and Sun belong to one hour, 0 without one.
    """


class Magnetometer(Part):
    """The magnetic field.

    Args:
        period: Period of its samples (s).
        point: Point of the structure at which it is mounted; default: the first of the body's points.
        noise: Standard deviation of the white noise along each axis (T). Default: 0.0.
        bias: Constant error along each axis (T). Default: 0.0.
        resolution: Quantum of the output along each axis (T); 0 for none. Default: 0.0.
        scale: Relative error of the scale along each axis. Default: 0.0.
        misalignment: Misalignment (rad): row i gives what axis i measures of the field along the other
            axes; the diagonal is 0.
        latency: Time from a sample to its output (s). Default: 0.0.
        range: Largest field that it outputs along each axis (T), at which it clips; default: no limit.
        faults: Intervals in which the magnetometer fails.
    """

    _tag: ClassVar[str | None] = "magnetometer"

    period: float
    """Period of its samples (s)."""
    point: str = DEFAULT
    """Point of the structure at which it is mounted; default: the first of the body's points."""
    noise: float | Vector = DEFAULT
    """Standard deviation of the white noise along each axis (T). Default: 0.0."""
    bias: float | Vector = DEFAULT
    """Constant error along each axis (T). Default: 0.0."""
    resolution: float | Vector = DEFAULT
    """Quantum of the output along each axis (T); 0 for none. Default: 0.0."""
    scale: float | Vector = DEFAULT
    """Relative error of the scale along each axis. Default: 0.0."""
    misalignment: Rows = DEFAULT
    """Misalignment (rad): row i gives what axis i measures of the field along the other axes; the diagonal
    is 0.
    """
    latency: float = DEFAULT
    """Time from a sample to its output (s). Default: 0.0."""
    range: float | Vector = DEFAULT
    """Largest field that it outputs along each axis (T), at which it clips; default: no limit."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the magnetometer fails."""


class Magnetorquers(Part):
    """Magnetorquers of a spatial body in the field of its planet.

    Args:
        moment: Largest magnetic moment along each axis (A m²): one number for all axes, or a list of three.
        faults: Intervals in which the magnetorquers fail.
    """

    _tag: ClassVar[str | None] = "magnetorquers"

    moment: float | Vector
    """Largest magnetic moment along each axis (A m²): one number for all axes, or a list of three."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the magnetorquers fail."""


class Manoeuvre(Part):
    """A manoeuvre. The modes of the body are at rest at its start.

    Args:
        angle: Angle by which the rigid body turns (rad).
        command: Command that turns the body.
        time: Duration of the manoeuvre (s); default: the shortest that the peak torque allows.
        peak_torque: Largest torque (N m); together with `time`, a limit that the plan must respect.
        start_rate: Rate before the manoeuvre (rad/s), equal to the body's rate at the start. Default: 0.0.
        end_rate: Rate after the manoeuvre (rad/s). Default: 0.0.
        shaper: Shaper with which the command is convolved; it uses part of the duration.
        load: Distribution of the torque over the body, in any unit, as only the ratios matter: `{ hub,
            sections }` of panels, `{ rigid, modes }` of a planar body, coordinates of matrices by name or
            in order; default: a torque on the hub. The actuator acts there during the whole run.
        model: Body for which the manoeuvre is planned; default: the body itself. A campaign that draws keys
            of the body plans for the body as written in the scenario: the plan does not depend on the drawn
            values.
    """

    _bare: ClassVar[tuple[str, ...]] = ("model", )

    angle: float
    """Angle by which the rigid body turns (rad)."""
    command: CommandKind
    """Command that turns the body."""
    time: float = DEFAULT
    """Duration of the manoeuvre (s); default: the shortest that the peak torque allows."""
    peak_torque: float = DEFAULT
    """Largest torque (N m); together with `time`, a limit that the plan must respect."""
    start_rate: float = DEFAULT
    """Rate before the manoeuvre (rad/s), equal to the body's rate at the start. Default: 0.0."""
    end_rate: float = DEFAULT
    """Rate after the manoeuvre (rad/s). Default: 0.0."""
    shaper: ShaperKind = DEFAULT
    """Shaper with which the command is convolved; it uses part of the duration."""
    load: Vector | Mapping[str, float | Vector] = DEFAULT
    """Distribution of the torque over the body, in any unit, as only the ratios matter: `{ hub, sections }`
    of panels, `{ rigid, modes }` of a planar body, coordinates of matrices by name or in order; default:
    a torque on the hub. The actuator acts there during the whole run.
    """
    model: Planar = DEFAULT
    """Body for which the manoeuvre is planned; default: the body itself. A campaign that draws keys of the
    body plans for the body as written in the scenario: the plan does not depend on the drawn values.
    """


class Matrices(Part):
    """The matrices of a structure.

    Args:
        mass: Mass matrix, symmetric and positive definite, up to order 2000 (kg m² for angles, kg for
            displacements): rows, or a file.
        stiffness: Stiffness matrix, symmetric; only the rigid rotation is free of strain (N m/rad for
            angles, N/m for displacements): rows, or a file.
        coordinates: Names of the coordinates; default: `q0`, `q1` and so on.
        hub: Index of the coordinate that is the hub's angle, counted from 0. Default: 0.
        rotation: Displacement of each coordinate under a unit rigid rotation; default: 1 for the hub's
            angle and 0 for all other coordinates, which are relative to it.
        drive: Quantity that the actuator commands. Default: "torque".
        damping: Damping ratio of all modes, or a list with one for each mode that is kept. Default: 0.0.
        damping_matrix: Damping matrix, symmetric, without resistance to the rigid rotation (N m s/rad for
            angles, N s/m for displacements). It adds to the damping ratios and may couple the modes.
        keep: Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s.
        angle: Rigid angle at the start (rad). Default: 0.0.
        rate: Rigid rate at the start (rad/s). Default: 0.0.
        outputs: Sums of coordinates that are observed in addition to the hub's angle.
    """

    _tag: ClassVar[str | None] = "matrices"

    mass: Rows | str
    """Mass matrix, symmetric and positive definite, up to order 2000 (kg m² for angles, kg for
    displacements): rows, or a file.
    """
    stiffness: Rows | str
    """Stiffness matrix, symmetric; only the rigid rotation is free of strain (N m/rad for angles, N/m for
    displacements): rows, or a file.
    """
    coordinates: Sequence[str] = DEFAULT
    """Names of the coordinates; default: `q0`, `q1` and so on."""
    hub: int = DEFAULT
    """Index of the coordinate that is the hub's angle, counted from 0. Default: 0."""
    rotation: Vector = DEFAULT
    """Displacement of each coordinate under a unit rigid rotation; default: 1 for the hub's angle and 0 for
    all other coordinates, which are relative to it.
    """
    drive: Literal["torque", "motion"] = DEFAULT
    """Quantity that the actuator commands. Default: "torque"."""
    damping: float | Vector = DEFAULT
    """Damping ratio of all modes, or a list with one for each mode that is kept. Default: 0.0."""
    damping_matrix: Rows | str = DEFAULT
    """Damping matrix, symmetric, without resistance to the rigid rotation (N m s/rad for angles, N s/m for
    displacements). It adds to the damping ratios and may couple the modes.
    """
    keep: int = DEFAULT
    """Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s."""
    angle: float = DEFAULT
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float = DEFAULT
    """Rigid rate at the start (rad/s). Default: 0.0."""
    outputs: Sequence[Sum] = DEFAULT
    """Sums of coordinates that are observed in addition to the hub's angle."""


class MeasuredPath(Part):
    """Response of a line of sight to a force along, or a torque about, an axis at a point, measured over
    frequency: by a shaker, or by the frequency response of a structural solver. Before a fine mirror.

    Args:
        point: Point at which the load acts.
        about: Axis of the body about which the line of sight turns.
        table: Response over frequency, or the path of a .csv file: frequency (Hz), and its real and
            imaginary part.
        force: Axis of the body along which the force acts.
        torque: Axis of the body about which the torque acts, in place of a force.
        phase: Unit of the phase, `rad` or `deg`, of a table with magnitude and phase in place of real and
            imaginary part.
        unit: Unit of the response, such as `arcsec/N`; default: rad per N of a force, rad per N m of a
            torque.
    """

    point: str
    """Point at which the load acts."""
    about: Literal["x", "y", "z"]
    """Axis of the body about which the line of sight turns."""
    table: Rows | str
    """Response over frequency, or the path of a .csv file: frequency (Hz), and its real and imaginary part.
    """
    force: Literal["x", "y", "z"] = DEFAULT
    """Axis of the body along which the force acts."""
    torque: Literal["x", "y", "z"] = DEFAULT
    """Axis of the body about which the torque acts, in place of a force."""
    phase: str = DEFAULT
    """Unit of the phase, `rad` or `deg`, of a table with magnitude and phase in place of real and imaginary
    part.
    """
    unit: str = DEFAULT
    """Unit of the response, such as `arcsec/N`; default: rad per N of a force, rad per N m of a torque."""


class MinimumEnergy(Part):
    """The command with the smallest integral of its square.

    Args:
        suppress: Number of modes left at rest, lowest frequencies first. Default: 0.
        zeros: Further zeros.
    """

    _tag: ClassVar[str | None] = "minimum_energy"

    suppress: int = DEFAULT
    """Number of modes left at rest, lowest frequencies first. Default: 0."""
    zeros: Sequence[ShapedZero] = DEFAULT
    """Further zeros."""


class MinimumPeak(Part):
    """The command with the smallest peak.

    Args:
        suppress: Number of modes left at rest, lowest frequencies first. Default: 0.
    """

    _tag: ClassVar[str | None] = "minimum_peak"

    suppress: int = DEFAULT
    """Number of modes left at rest, lowest frequencies first. Default: 0."""


class Mode(Part):
    """An elastic mode ([Silaev], equation (1), with damping added).

    Args:
        frequency: Natural frequency w (rad/s).
        gain: Modal gain k: modal acceleration per unit of rigid acceleration.
        hub_gain: Modal gain of a torque on the hub, if the commanded torque acts elsewhere: it determines
            the energy of the mode; default: `gain`.
        damping: Damping ratio zeta: 0 undamped, 1 critical; more than 1 is allowed except with an
            `[estimator.envelope]`. Default: 0.0.
        displacement: Displacement at the start (rad). Default: 0.0.
        rate: Rate at the start (rad/s). Default: 0.0.
    """

    frequency: float
    """Natural frequency w (rad/s)."""
    gain: float
    """Modal gain k: modal acceleration per unit of rigid acceleration."""
    hub_gain: float = DEFAULT
    """Modal gain of a torque on the hub, if the commanded torque acts elsewhere: it determines the energy
    of the mode; default: `gain`.
    """
    damping: float = DEFAULT
    """Damping ratio zeta: 0 undamped, 1 critical; more than 1 is allowed except with an
    `[estimator.envelope]`. Default: 0.0.
    """
    displacement: float = DEFAULT
    """Displacement at the start (rad). Default: 0.0."""
    rate: float = DEFAULT
    """Rate at the start (rad/s). Default: 0.0."""


class ModeExit(Part):
    """An end of a mode.

    Args:
        to: Name of the mode that follows.
        when: Condition, such as `"rate < 2e-3 and time > 60"`.
        numbers: Numbers of the condition by name, such as `{ slow = 2e-3 }` for `"rate < slow"`, in SI
            units: keys for campaigns and searches.
        for_: Time for which the condition has to hold without a break (s).
    """

    to: str
    """Name of the mode that follows."""
    when: str
    """Condition, such as `"rate < 2e-3 and time > 60"`."""
    numbers: Mapping[str, float] = DEFAULT
    """Numbers of the condition by name, such as `{ slow = 2e-3 }` for `"rate < slow"`, in SI units: keys
    for campaigns and searches.
    """
    for_: float = DEFAULT
    """Time for which the condition has to hold without a break (s)."""


class ModeTarget(Part):
    """The target attitude of a mode: yaw, then pitch about the rotated y axis, then roll about the twice
    rotated x axis.

    Args:
        frame: Frame relative to which the attitude is given; default: inertial.
        primary: Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw
            are relative to the attitude that these two give.
        secondary: Axis of the body that is as near to a direction as `primary` lets it.
        roll: Roll (rad). Default: 0.0.
        pitch: Pitch (rad). Default: 0.0.
        yaw: Yaw (rad). Default: 0.0.
        acceleration: Largest acceleration of the slew about one axis to it (rad/s²); default: the reference
            jumps.
        rate_limit: Largest rate of the slew (rad/s); no limit by default.
        profile: How the rate of the slew rises and falls; default: trapezoid.
        slew_from: Start of the slew; default: the estimated attitude after a law that does not control the
            attitude, else the reference.
    """

    frame: Literal["inertial", "nadir", "sun"] = DEFAULT
    """Frame relative to which the attitude is given; default: inertial."""
    primary: PointedAxis = DEFAULT
    """Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw are
    relative to the attitude that these two give.
    """
    secondary: PointedAxis = DEFAULT
    """Axis of the body that is as near to a direction as `primary` lets it."""
    roll: float = DEFAULT
    """Roll (rad). Default: 0.0."""
    pitch: float = DEFAULT
    """Pitch (rad). Default: 0.0."""
    yaw: float = DEFAULT
    """Yaw (rad). Default: 0.0."""
    acceleration: float = DEFAULT
    """Largest acceleration of the slew about one axis to it (rad/s²); default: the reference jumps."""
    rate_limit: float = DEFAULT
    """Largest rate of the slew (rad/s); no limit by default."""
    profile: Literal["trapezoid", "versine"] = DEFAULT
    """How the rate of the slew rises and falls; default: trapezoid."""
    slew_from: Literal["reference", "estimate"] = DEFAULT
    """Start of the slew; default: the estimated attitude after a law that does not control the attitude,
    else the reference.
    """


class Mount(Part):
    """A mount that carries the appendage as a rigid body, which moves against it by small displacements and
    rotations.

    Args:
        translation: Natural frequency of its displacement on a fixed base (rad/s), in any direction.
        rocking: Natural frequency of its rotation about its centre of mass on a fixed base (rad/s), about
            any axis.
        stiffness: Stiffness at the root, in place of both: force (N) and torque (N m) along its own axes
            per displacement (m) and rotation (rad), row by row; positive definite.
        damping: Damping ratio of each mode on a fixed base. Default: 0.0.
        axis: Axis in its own axes about which the mount does not give, of any length, such as that of a
            wheel: there the rotor turns. Default: it rocks about all axes.
    """

    translation: float = DEFAULT
    """Natural frequency of its displacement on a fixed base (rad/s), in any direction."""
    rocking: float = DEFAULT
    """Natural frequency of its rotation about its centre of mass on a fixed base (rad/s), about any axis."""
    stiffness: Rows = DEFAULT
    """Stiffness at the root, in place of both: force (N) and torque (N m) along its own axes per
    displacement (m) and rotation (rad), row by row; positive definite.
    """
    damping: float = DEFAULT
    """Damping ratio of each mode on a fixed base. Default: 0.0."""
    axis: Vector = DEFAULT
    """Axis in its own axes about which the mount does not give, of any length, such as that of a wheel:
    there the rotor turns. Default: it rocks about all axes.
    """


class NamedPoint(Part):
    """A point of the structure.

    Args:
        name: Name.
        position: Position (m): from the centre of mass; on a spacecraft's hub from its point O, on an
            appendage from its root.
    """

    name: str
    """Name."""
    position: Vector = DEFAULT
    """Position (m): from the centre of mass; on a spacecraft's hub from its point O, on an appendage from
    its root.
    """


class Normal(Part):
    """Normal with this mean and standard deviation.

    Args:
        mean: Mean.
        sd: Standard deviation.
    """

    _tag: ClassVar[str | None] = "normal"

    mean: float
    """Mean."""
    sd: float
    """Standard deviation."""


class Notch(Part):
    """(s² + 2 depth zeta w s + w²)/(s² + 2 zeta w s + w²).

    Args:
        frequency: The frequency w (rad/s).
        depth: Gain at that frequency, below 1.
        damping: Damping ratio zeta of the denominator; a larger one makes the notch wider. Default: 0.6.
    """

    _tag: ClassVar[str | None] = "notch"

    frequency: float
    """The frequency w (rad/s)."""
    depth: float
    """Gain at that frequency, below 1."""
    damping: float = DEFAULT
    """Damping ratio zeta of the denominator; a larger one makes the notch wider. Default: 0.6."""


class NullMotion(Part):
    """Null motion: gimbal rates whose torques cancel each other, towards preferred gimbal angles.

    Args:
        angles: Preferred angle of each gimbal, of four or more (rad).
        gain: Gain with which the gimbals turn towards them, as far as no torque results (1/s).
    """

    angles: Vector
    """Preferred angle of each gimbal, of four or more (rad)."""
    gain: float
    """Gain with which the gimbals turn towards them, as far as no torque results (1/s)."""


class Open(Part):
    """No law: the default of a scenario with a manoeuvre."""

    _tag: ClassVar[str | None] = "open"


class OperatingMode(Part):
    """A mode of operation: the law that acts in it, with what it uses, and when it ends. A run begins in
    the first mode.

    Args:
        name: Name: letters, digits, `_` and `-`.
        law: The law: any but `stages`.
        target: Target attitude of a body with three axes, from the start of the mode on; default: the
            target stays, and `[[target]]` holds if no mode has one.
        sensors: Kinds of the sensors in use, such as `["gyro", "star_tracker"]`, or `star_tracker[1]` for
            the second of a kind; default: all. The others give no readings.
        actuators: Kinds of the `[[actuator]]` entries that execute the commands of the law, such as
            `["wheels"]`; default: all.
        leave: Ends of the mode: the first whose condition is met ends it.
    """

    name: str
    """Name: letters, digits, `_` and `-`."""
    law: LawKind
    """The law: any but `stages`."""
    target: ModeTarget = DEFAULT
    """Target attitude of a body with three axes, from the start of the mode on; default: the target stays,
    and `[[target]]` holds if no mode has one.
    """
    sensors: Sequence[str] = DEFAULT
    """Kinds of the sensors in use, such as `["gyro", "star_tracker"]`, or `star_tracker[1]` for the second
    of a kind; default: all. The others give no readings.
    """
    actuators: Sequence[Literal[
        "ideal",
        "hold",
        "thrusters",
        "wheel",
        "wheels",
        "control_moment_gyros",
        "jets",
        "magnetorquers",
        "own",
    ]] = DEFAULT
    """Kinds of the `[[actuator]]` entries that execute the commands of the law, such as `["wheels"]`;
    default: all.
    """
    leave: Sequence[ModeExit] = DEFAULT
    """Ends of the mode: the first whose condition is met ends it."""


class OpticalElement(Part):
    """Mirror, lens or detector at a point of the structure. The two rows of each matrix are the rotations
    of the line of sight about the body axes across it, in cyclic order: about x and y for a line along
    z.

    Args:
        point: Point of the structure at which it is mounted.
        rotation: Rotation of the line of sight per rotation of the point, about x, y and z (rad/rad).
        translation: Rotation of the line of sight per displacement of the point, along x, y and z (rad/m);
            the sum over all optics is zero.
    """

    point: str
    """Point of the structure at which it is mounted."""
    rotation: Rows = DEFAULT
    """Rotation of the line of sight per rotation of the point, about x, y and z (rad/rad)."""
    translation: Rows = DEFAULT
    """Rotation of the line of sight per displacement of the point, along x, y and z (rad/m); the sum over
    all optics is zero.
    """


class Orbit(Part, kw_only=False):
    """Direction of any length, constant in the local axes of the orbit: x ahead, y against the normal, z to
    the planet's centre.
    """

    _tag: ClassVar[str | None] = "orbit"

    value: Vector


class Outlier(Part):
    """Readings that are off.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
        angle: Error of the angle (rad): a measured attitude or vector is rotated about the direction (1, 1,
            1) of the body. Default: 0.0.
        rate: Error of the measured rate about each axis (rad/s). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "outlier"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""
    angle: float = DEFAULT
    """Error of the angle (rad): a measured attitude or vector is rotated about the direction (1, 1, 1) of
    the body. Default: 0.0.
    """
    rate: float = DEFAULT
    """Error of the measured rate about each axis (rad/s). Default: 0.0."""


class Output(Part):
    """A coordinate that is observed in addition to the hub's angle: y = rigid x_r + sum modes[i] x_i.

    Args:
        name: Name, such as `tip`.
        modes: Weight of each mode's displacement, in the order of the modes.
        unit: Unit. Default: "rad".
        rigid: Weight of the rigid angle. Default: 0.0.
    """

    name: str
    """Name, such as `tip`."""
    modes: Vector
    """Weight of each mode's displacement, in the order of the modes."""
    unit: str = DEFAULT
    """Unit. Default: "rad"."""
    rigid: float = DEFAULT
    """Weight of the rigid angle. Default: 0.0."""


class Pair(Part):
    """The two groups of an axis.

    Args:
        plus: Thrusters whose torque is positive.
        minus: Thrusters whose torque is negative.
    """

    plus: Sequence[str]
    """Thrusters whose torque is positive."""
    minus: Sequence[str]
    """Thrusters whose torque is negative."""


class Panels(Part):
    """A hub with panels of hinged sections.

    Args:
        hub_inertia: Moment of inertia of the hub alone (kg m²).
        root: Distance of the first hinge from the axis (m).
        sections: Sections of each panel, from the hub outwards.
        count: Number of equal panels. Default: 2.
        kinematics: Kinematics of the sections. Default: "linear".
        tolerance: Error tolerance of each integration step of the exact kinematics (rad). Default: 1e-12.
        drive: Quantity that the actuator commands. Default: "torque".
        damping: Damping ratio of all modes, or a list with one for each mode that is kept. Default: 0.0.
        keep: Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s.
        angle: Rigid angle at the start (rad). Default: 0.0.
        rate: Rigid rate at the start (rad/s). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "panels"

    hub_inertia: float
    """Moment of inertia of the hub alone (kg m²)."""
    root: float
    """Distance of the first hinge from the axis (m)."""
    sections: Sequence[Section]
    """Sections of each panel, from the hub outwards."""
    count: int = DEFAULT
    """Number of equal panels. Default: 2."""
    kinematics: Literal["linear", "exact"] = DEFAULT
    """Kinematics of the sections. Default: "linear"."""
    tolerance: float = DEFAULT
    """Error tolerance of each integration step of the exact kinematics (rad). Default: 1e-12."""
    drive: Literal["torque", "motion"] = DEFAULT
    """Quantity that the actuator commands. Default: "torque"."""
    damping: float | Vector = DEFAULT
    """Damping ratio of all modes, or a list with one for each mode that is kept. Default: 0.0."""
    keep: int = DEFAULT
    """Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s."""
    angle: float = DEFAULT
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float = DEFAULT
    """Rigid rate at the start (rad/s). Default: 0.0."""


class PartWithFailure(Part):
    """Failures of a part, besides its own.

    Args:
        part: Part by its kind, or by its kind and its place among those of the kind, such as
            `star_tracker[1]`.
        faults: Failures.
    """

    part: str
    """Part by its kind, or by its kind and its place among those of the kind, such as `star_tracker[1]`."""
    faults: Sequence[FailureKind]
    """Failures."""


class PartWithFault(Part):
    """Failures of a part, besides its own.

    Args:
        part: Part by its kind, or by its kind and its place among those of the kind, such as
            `star_tracker[1]`.
        faults: Failures.
    """

    part: str
    """Part by its kind, or by its kind and its place among those of the kind, such as `star_tracker[1]`."""
    faults: Sequence[FaultKind]
    """Failures."""


class Pd(Part):
    """Sampled proportional-derivative feedback of the angle.

    Args:
        k_p: Proportional gain (N m/rad; for a wheel, units of its command per rad).
        k_d: Derivative gain (N m s/rad; without the second where the difference is raw).
        period: Period of its samples (s).
        differentiation: How the derivative is taken. Default: "exact".
        error: How a rotation is converted into an error, on a body with three axes; default: `quaternion`.
        extra: Extra loop on the dominant mode.
        limit: Largest torque (N m; for a wheel, in units of its command); no limit by default.
        track: Whether the law tracks a manoeuvre while it lasts; otherwise it waits and takes over at the
            end of the manoeuvre.
    """

    _tag: ClassVar[str | None] = "pd"

    k_p: float
    """Proportional gain (N m/rad; for a wheel, units of its command per rad)."""
    k_d: float
    """Derivative gain (N m s/rad; without the second where the difference is raw)."""
    period: float
    """Period of its samples (s)."""
    differentiation: Literal["exact", "difference", "raw"] = DEFAULT
    """How the derivative is taken. Default: "exact"."""
    error: Literal["quaternion", "rodrigues"] = DEFAULT
    """How a rotation is converted into an error, on a body with three axes; default: `quaternion`."""
    extra: ExtraKind = DEFAULT
    """Extra loop on the dominant mode."""
    limit: float = DEFAULT
    """Largest torque (N m; for a wheel, in units of its command); no limit by default."""
    track: bool = DEFAULT
    """Whether the law tracks a manoeuvre while it lasts; otherwise it waits and takes over at the end of
    the manoeuvre.
    """


class PerAxis(Part):
    """A separate law about each of three axes.

    Args:
        roll: About x.
        pitch: About y.
        yaw: About z.
    """

    _tag: ClassVar[str | None] = "per_axis"

    roll: LawKind
    """About x."""
    pitch: LawKind
    """About y."""
    yaw: LawKind
    """About z."""


class Periodic(Part):
    """A torque in the body's axes: constant + amplitude sin(2 pi t/period + phase) about each.

    Args:
        constant: Constant part (N m).
        amplitude: Amplitude of the periodic part (N m), about each axis: amplitude sin(2 pi t/period +
            phase).
        period: Period (s); about 5560 s for a station in a low orbit. Default: 5560.0.
        phase: Phase at the start (rad).
    """

    constant: Vector = DEFAULT
    """Constant part (N m)."""
    amplitude: Vector = DEFAULT
    """Amplitude of the periodic part (N m), about each axis: amplitude sin(2 pi t/period + phase)."""
    period: float = DEFAULT
    """Period (s); about 5560 s for a station in a low orbit. Default: 5560.0."""
    phase: Vector = DEFAULT
    """Phase at the start (rad)."""


class PhasePlane(Part):
    """A relay in the phase plane, with pulses of computed length.

    Args:
        period: Cycle of law and jets, and of gyro and estimator if they have no period of their own (s).
        dead_zone: Half width of the dead zone (rad).
        rate_limit: Largest rate at which the law turns the body (rad/s).
        switch_on: Rate error above which the jets begin to fire (rad/s); near and beyond the edges of the
            dead zone they begin at a smaller one.
        switch_off: Rate error below which the jets stop (rad/s); it is also the smallest return rate.
        slope: Largest return rate per unit of the angle beyond the dead zone (1/s). Default: 0.05.
        braking: Fraction of the jets' acceleration used for slowing down. Default: 0.5.
        targets: Target attitudes, in the order of their times; before the first one, the target is the
            inertial axes.
        damping: Active damping of elastic motion while the rigid motion needs no jets; none by default.
    """

    _tag: ClassVar[str | None] = "phase_plane"

    period: float
    """Cycle of law and jets, and of gyro and estimator if they have no period of their own (s)."""
    dead_zone: float
    """Half width of the dead zone (rad)."""
    rate_limit: float
    """Largest rate at which the law turns the body (rad/s)."""
    switch_on: float
    """Rate error above which the jets begin to fire (rad/s); near and beyond the edges of the dead zone
    they begin at a smaller one.
    """
    switch_off: float
    """Rate error below which the jets stop (rad/s); it is also the smallest return rate."""
    slope: float = DEFAULT
    """Largest return rate per unit of the angle beyond the dead zone (1/s). Default: 0.05."""
    braking: float = DEFAULT
    """Fraction of the jets' acceleration used for slowing down. Default: 0.5."""
    targets: Sequence[Target] = DEFAULT
    """Target attitudes, in the order of their times; before the first one, the target is the inertial axes.
    """
    damping: ActiveDamping = DEFAULT
    """Active damping of elastic motion while the rigid motion needs no jets; none by default."""


class Planar(Part):
    """One angle and any number of elastic modes.

    Args:
        inertia: Moment of inertia (kg m²); default: 1, and every torque is a reduced moment (rad/s²).
            Default: 1.0.
        angle: Rigid angle at the start (rad). Default: 0.0.
        rate: Rigid rate at the start (rad/s). Default: 0.0.
        drive: Quantity that the actuator commands. Default: "torque".
        damping_matrix: Damping that couples the modes (1/s): it adds -sum_j `damping_matrix`[i][j] x_j' to
            x_i'', beside the damping ratios.
        modes: Elastic modes.
        outputs: Coordinates that are observed in addition to the hub's angle: y = rigid x_r + sum of
            `modes`[i] x_i.
    """

    _tag: ClassVar[str | None] = "planar"

    inertia: float = DEFAULT
    """Moment of inertia (kg m²); default: 1, and every torque is a reduced moment (rad/s²). Default: 1.0."""
    angle: float = DEFAULT
    """Rigid angle at the start (rad). Default: 0.0."""
    rate: float = DEFAULT
    """Rigid rate at the start (rad/s). Default: 0.0."""
    drive: Literal["torque", "motion"] = DEFAULT
    """Quantity that the actuator commands. Default: "torque"."""
    damping_matrix: Rows = DEFAULT
    """Damping that couples the modes (1/s): it adds -sum_j `damping_matrix`[i][j] x_j' to x_i'', beside the
    damping ratios.
    """
    modes: Sequence[Mode] = DEFAULT
    """Elastic modes."""
    outputs: Sequence[Output] = DEFAULT
    """Coordinates that are observed in addition to the hub's angle: y = rigid x_r + sum of `modes`[i] x_i.
    """


class Point(Part):
    """A point of a profile.

    Args:
        time: Time (s).
        ratio: Ratio at that time.
    """

    time: float
    """Time (s)."""
    ratio: float
    """Ratio at that time."""


class PointedAxis(Part):
    """Axis of the body along a direction.

    Args:
        body: Axis in the body's axes, of any length.
        along: Direction.
    """

    body: Vector
    """Axis in the body's axes, of any length."""
    along: SkyDirectionKind | Literal["nadir", "sun", "velocity", "orbit_normal", "field"]
    """Direction."""


class Pointing(Part):
    """Pointing requirement over a part of the run.

    Args:
        window: Start and end (s) of the interval in which the pointing error is assessed, for the metric
            `pointing_rms_rad`.
        rms: Largest allowed root mean square of the pointing error (rad), for the metric `requirement`;
            default: no requirement.
    """

    window: Vector
    """Start and end (s) of the interval in which the pointing error is assessed, for the metric
    `pointing_rms_rad`.
    """
    rms: float = DEFAULT
    """Largest allowed root mean square of the pointing error (rad), for the metric `requirement`; default:
    no requirement.
    """


class Polynomial(Part):
    """A polynomial for the angle.

    Args:
        degree: Degree of the polynomial: 3, 5, 7, 9, 11 or 13.
    """

    _tag: ClassVar[str | None] = "polynomial"

    degree: int
    """Degree of the polynomial: 3, 5, 7, 9, 11 or 13."""


class Pulses(Part):
    """A train of pulses: on from the start of each period.

    Args:
        period: Time from the start of one pulse to the start of the next (s).
        on: Duration of each pulse (s).
    """

    period: float
    """Time from the start of one pulse to the start of the next (s)."""
    on: float
    """Duration of each pulse (s)."""


class Ramp(Part):
    """A linear change from 1 to another ratio, which then stays constant.

    Args:
        time: Duration (s).
        to: The ratio afterwards.
        from_: Start time (s). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "ramp"

    time: float
    """Duration (s)."""
    to: float
    """The ratio afterwards."""
    from_: float = DEFAULT
    """Start time (s). Default: 0.0."""


class RandomSearch(Part):
    """Random search with learning, based on an objective over consecutive windows.

    Args:
        step: Largest move of the gain in one window, delta `k_t`.
        bounds: Smallest and largest gain, which include its value at the start; for `k_t` between 0 and 1.
        tunes: Tuned parameter of the law, by its key within the law's table: `k_t` of a relay (the
            default), `k_p` of a PD law, `bandwidth` of an attitude law, `yaw.pd.k_d` of a law `per_axis`.
        objective: Quantity that is measured over each window and made smaller; default: `envelope_mean`.
        window: Length of the windows (s); for `envelope_mean`, they are those of the
            `[estimator.envelope]`.
        tolerance: A relative change of the objective below this counts as settled, `delta_0`. Default:
            0.05.
        settled: Consecutive settled windows after which the gain is frozen (the paper's six). Default: 6.
        memory: Consecutive falls of the objective after which one rise is ignored (the paper's four); 0 for
            never. Default: 4.
        earliest_freeze: The gain is not frozen before this time, `T_min` (s). Default: 10000.0.
        freeze: Whether the gain is ever frozen. Default: true.
    """

    _tag: ClassVar[str | None] = "random_search"

    step: float
    """Largest move of the gain in one window, delta `k_t`."""
    bounds: Vector
    """Smallest and largest gain, which include its value at the start; for `k_t` between 0 and 1."""
    tunes: str = DEFAULT
    """Tuned parameter of the law, by its key within the law's table: `k_t` of a relay (the default), `k_p`
    of a PD law, `bandwidth` of an attitude law, `yaw.pd.k_d` of a law `per_axis`.
    """
    objective: Literal[
        "envelope_mean",
        "pointing_error_mean",
        "pointing_error_rms",
        "pointing_error_peak",
        "rate_error_rms",
        "elastic_rms",
        "torque_mean",
        "switchings",
        "firings",
        "wheel_power_mean",
    ] = DEFAULT
    """Quantity that is measured over each window and made smaller; default: `envelope_mean`."""
    window: float = DEFAULT
    """Length of the windows (s); for `envelope_mean`, they are those of the `[estimator.envelope]`."""
    tolerance: float = DEFAULT
    """A relative change of the objective below this counts as settled, `delta_0`. Default: 0.05."""
    settled: int = DEFAULT
    """Consecutive settled windows after which the gain is frozen (the paper's six). Default: 6."""
    memory: int = DEFAULT
    """Consecutive falls of the objective after which one rise is ignored (the paper's four); 0 for never.
    Default: 4.
    """
    earliest_freeze: float = DEFAULT
    """The gain is not frozen before this time, `T_min` (s). Default: 10000.0."""
    freeze: bool = DEFAULT
    """Whether the gain is ever frozen. Default: true."""


class Recurrence(Part):
    """The recurrence of [Timakov14], for one mode about each axis.

    Args:
        damping: Damping ratio of the mode, which is not identified. Default: 0.005.
        coast: Weights W1 to W3, for cycles in which no thruster fires.
        active: Weights W5 to W7, for cycles in which a thruster fires.
        frequency_gain: Frequency gain kappa: W4 times the amplitude of the elastic rate. With the default
            weights it converges below 0.043. Default: 0.006.
        influence_gain: Influence gain: W8 times the absolute value of the excitation from which the
            influence is identified. Default: 0.25.
        gate: Amplitude of the elastic rate (rad/s) below which the frequency is not updated. Default:
            5e-06.
        influence_bounds: Bounds of the influence, as multiples of its initial value.
        reach: Default bounds of a frequency: its initial value divided by this factor, and multiplied by
            it. Default: 3.0.
    """

    _tag: ClassVar[str | None] = "recurrence"

    damping: float = DEFAULT
    """Damping ratio of the mode, which is not identified. Default: 0.005."""
    coast: RecurrenceWeights = DEFAULT
    """Weights W1 to W3, for cycles in which no thruster fires."""
    active: RecurrenceWeights = DEFAULT
    """Weights W5 to W7, for cycles in which a thruster fires."""
    frequency_gain: float = DEFAULT
    """Frequency gain kappa: W4 times the amplitude of the elastic rate. With the default weights it
    converges below 0.043. Default: 0.006.
    """
    influence_gain: float = DEFAULT
    """Influence gain: W8 times the absolute value of the excitation from which the influence is identified.
    Default: 0.25.
    """
    gate: float = DEFAULT
    """Amplitude of the elastic rate (rad/s) below which the frequency is not updated. Default: 5e-06."""
    influence_bounds: Vector = DEFAULT
    """Bounds of the influence, as multiples of its initial value."""
    reach: float = DEFAULT
    """Default bounds of a frequency: its initial value divided by this factor, and multiplied by it.
    Default: 3.0.
    """


class RecurrenceWeights(Part):
    """Fractions of an innovation by which the estimates are corrected.

    Args:
        rigid: The rigid rate: W1 or W5.
        elastic: The elastic rate: W2 or W6.
        next: The elastic rate of the next sample, subtracted: W3 or W7.
    """

    rigid: float
    """The rigid rate: W1 or W5."""
    elastic: float
    """The elastic rate: W2 or W6."""
    next: float
    """The elastic rate of the next sample, subtracted: W3 or W7."""


class Reference(Part):
    """Reference values for the metrics.

    Args:
        envelope: Mean envelope without adaptation (rad), for the metric `envelope_reduction`; default: the
            mean over the run's own first window.
        band: Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s`
            and `settling_time_s`. Default: after a manoeuvre, a thousandth of its angle; for a PD law, 5 %
            of the distance at the start of the goal; for a relay, the sum of its dead zone and hysteresis.
        pointing: Pointing requirement of a body with three axes over a part of the run.
    """

    envelope: float = DEFAULT
    """Mean envelope without adaptation (rad), for the metric `envelope_reduction`; default: the mean over
    the run's own first window.
    """
    band: float = DEFAULT
    """Distance from the goal that counts as settled (rad), for the metrics `goal`, `time_outside_s` and
    `settling_time_s`. Default: after a manoeuvre, a thousandth of its angle; for a PD law, 5 % of the
    distance at the start of the goal; for a relay, the sum of its dead zone and hysteresis.
    """
    pointing: Pointing = DEFAULT
    """Pointing requirement of a body with three axes over a part of the run."""


class RelativeNormal(Part, kw_only=False):
    """The scenario's own value times a normal factor with mean 1 and this standard deviation."""

    _tag: ClassVar[str | None] = "relative_normal"

    value: float


class RelativeUniform(Part, kw_only=False):
    """The scenario's own value times a factor that is uniform between 1 - x and 1 + x, where x is this
    number.
    """

    _tag: ClassVar[str | None] = "relative_uniform"

    value: float


class Relay(Part):
    """Relay with dead zone, hysteresis and a timed brake.

    Args:
        dead_zone: Half width of the dead zone, eps (rad).
        hysteresis: Hysteresis, gamma (rad): how far back inside a boundary the brake begins.
        strong: Strong torque `m_u` (N m; rad/s² on a body without inertia).
        weak: Weak torque `m_eps` in the dead zone (N m; rad/s² on a body without inertia).
        k_t: Braking gain, between 0 and 1: duration of the brake per second of the push.
        sides: Which boundaries of the dead zone push back. Default: "two".
    """

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
    """Braking gain, between 0 and 1: duration of the brake per second of the push."""
    sides: Literal["two", "one"] = DEFAULT
    """Which boundaries of the dead zone push back. Default: "two"."""


class Requirement(Part):
    """Requirement: the largest accepted value of a quantity, or what holds over time.

    Args:
        name: Name of the requirement.
        holds: Expression that holds over time, such as `"always[60 s, 300 s] pointing_error < 0.1 deg"`, in
            place of `quantity` and `limit`; without an operator over time, always.
        after: Event from which on `holds` counts, each time: `"mode enters fine"`, or a condition that
            becomes true.
        within: Longest time (s) after the event, or after the start, at which `holds` begins to hold.
        for_: Time (s) for which `holds` then holds.
        mode: Mode of operation in which the requirement counts; default: all.
        during: Condition during which the requirement counts, such as `"truth.sunlight < 0.5"` or
            `"blinded(star_tracker)"`.
        quantity: Required quantity: `pointing_error`, `rate_error`, `line_of_sight`, the contrast `mtf` of
            an image, or a metric, such as `fuel_kg` or `fuel_axes_kg[2]`; of a list without an index, its
            largest element.
        point: Point of the line of sight, which is a `[[line_of_sight]]` of the scenario.
        axis: Component of the error about an axis of the body; default: the norm of all components, for
            `mtf` the worst.
        index: Pointing index of an error (ECSS-E-ST-60-10C); default: APE. A metric has none.
        window: Length of the index' window (s), a whole number of sampling periods; all indices but APE
            have one.
        convention: Position of the instant in its window, for RPE.
        shift: Time from the start of one window to that of the other (s), at least the window, for PDE and
            PRE.
        period: Sampling period of the error (s). Default: the period of the law, else of the sensor, else 1
            s. A line of sight is sampled with its own period.
        from_: Start of the part of the run that counts (s); default: 0.
        to: End of the part of the run that counts (s); default: the end of the run.
        limit: Largest accepted value, in SI units or as a text with a unit that fits the quantity, such as
            "2 arcsec".
        spatial_frequency: Spatial frequency (cycles/rad) across the image at which `mtf` is required, such
            as "0.5 cycles/arcsec".
        exposure: Length of the exposures (s) of the image for `mtf`; default: a long exposure, over all
            time.
        least: Least accepted `mtf`, in place of a `limit`.
        level: Probability at which the value is at most the limit; default: 1, always and in every run.
        interpretation: Statistical interpretation of the level; an error with a level below 1 needs one.
        confidence: Confidence at which a campaign shows the level, for the ensemble interpretation;
            default: none is asked for.
    """

    name: str
    """Name of the requirement."""
    holds: str = DEFAULT
    """Expression that holds over time, such as `"always[60 s, 300 s] pointing_error < 0.1 deg"`, in place
    of `quantity` and `limit`; without an operator over time, always.
    """
    after: str = DEFAULT
    """Event from which on `holds` counts, each time: `"mode enters fine"`, or a condition that becomes
    true.
    """
    within: float = DEFAULT
    """Longest time (s) after the event, or after the start, at which `holds` begins to hold."""
    for_: float = DEFAULT
    """Time (s) for which `holds` then holds."""
    mode: str = DEFAULT
    """Mode of operation in which the requirement counts; default: all."""
    during: str = DEFAULT
    """Condition during which the requirement counts, such as `"truth.sunlight < 0.5"` or
    `"blinded(star_tracker)"`.
    """
    quantity: str = DEFAULT
    """Required quantity: `pointing_error`, `rate_error`, `line_of_sight`, the contrast `mtf` of an image,
    or a metric, such as `fuel_kg` or `fuel_axes_kg[2]`; of a list without an index, its largest element.
    """
    point: str = DEFAULT
    """Point of the line of sight, which is a `[[line_of_sight]]` of the scenario."""
    axis: Literal["x", "y", "z"] = DEFAULT
    """Component of the error about an axis of the body; default: the norm of all components, for `mtf` the
    worst.
    """
    index: Literal["APE", "MPE", "RPE", "PDE", "PRE"] = DEFAULT
    """Pointing index of an error (ECSS-E-ST-60-10C); default: APE. A metric has none."""
    window: float = DEFAULT
    """Length of the index' window (s), a whole number of sampling periods; all indices but APE have one."""
    convention: Literal["uniform", "end", "middle"] = DEFAULT
    """Position of the instant in its window, for RPE."""
    shift: float = DEFAULT
    """Time from the start of one window to that of the other (s), at least the window, for PDE and PRE."""
    period: float = DEFAULT
    """Sampling period of the error (s). Default: the period of the law, else of the sensor, else 1 s. A
    line of sight is sampled with its own period.
    """
    from_: float = DEFAULT
    """Start of the part of the run that counts (s); default: 0."""
    to: float = DEFAULT
    """End of the part of the run that counts (s); default: the end of the run."""
    limit: float | str = DEFAULT
    """Largest accepted value, in SI units or as a text with a unit that fits the quantity, such as "2
    arcsec".
    """
    spatial_frequency: float = DEFAULT
    """Spatial frequency (cycles/rad) across the image at which `mtf` is required, such as "0.5
    cycles/arcsec".
    """
    exposure: float = DEFAULT
    """Length of the exposures (s) of the image for `mtf`; default: a long exposure, over all time."""
    least: float = DEFAULT
    """Least accepted `mtf`, in place of a `limit`."""
    level: float = DEFAULT
    """Probability at which the value is at most the limit; default: 1, always and in every run."""
    interpretation: Literal["temporal", "ensemble", "mixed"] = DEFAULT
    """Statistical interpretation of the level; an error with a level below 1 needs one."""
    confidence: float = DEFAULT
    """Confidence at which a campaign shows the level, for the ensemble interpretation; default: none is
    asked for.
    """


class RigidRate(Part):
    """The rigid rates of a spatial body.

    Args:
        correction: Fraction l of the innovation, between 0 and 1, by which each sample corrects the rate.
        rate: Estimated rates before the first sample (rad/s). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "rigid_rate"

    correction: float
    """Fraction l of the innovation, between 0 and 1, by which each sample corrects the rate."""
    rate: float | Vector = DEFAULT
    """Estimated rates before the first sample (rad/s). Default: 0.0."""


class Robustness(Part):
    """The weight P = w (1 + E) of `singularity_robust` steering, with w = weight exp(-decay m²) and the
    singularity measure m.

    Args:
        weight: The weight at singular angles; default: 0.01. Default: 0.01.
        decay: Decay of the weight with the square of the singularity measure; default: 10. Default: 10.0.
        dither: Amplitude of the elements of E beside its diagonal, below 0.5; default: 0.1. Default: 0.1.
        frequency: Angular frequency of these elements (rad/s), whose phases are 0, 90 and 180 degrees;
            default: pi/2. Default: 1.5707963267948966.
    """

    weight: float = DEFAULT
    """The weight at singular angles; default: 0.01. Default: 0.01."""
    decay: float = DEFAULT
    """Decay of the weight with the square of the singularity measure; default: 10. Default: 10.0."""
    dither: float = DEFAULT
    """Amplitude of the elements of E beside its diagonal, below 0.5; default: 0.1. Default: 0.1."""
    frequency: float = DEFAULT
    """Angular frequency of these elements (rad/s), whose phases are 0, 90 and 180 degrees; default: pi/2.
    Default: 1.5707963267948966.
    """


class Rotor(Part):
    """A wheel that stores momentum.

    Args:
        inertia: Moment of inertia (kg m²).
        speed: Speed at the start (rad/s). Default: 0.0.
        speed_limit: Largest speed (rad/s), beyond which the motor cannot accelerate it, and with which a
            `[law.relay]` needs a sampled sensor; no limit by default.
    """

    inertia: float
    """Moment of inertia (kg m²)."""
    speed: float = DEFAULT
    """Speed at the start (rad/s). Default: 0.0."""
    speed_limit: float = DEFAULT
    """Largest speed (rad/s), beyond which the motor cannot accelerate it, and with which a `[law.relay]`
    needs a sampled sensor; no limit by default.
    """


class RunFault(Part):
    """Failures that occur together, in the runs of which this is the `active_fault`.

    Args:
        name: Name.
        sensor: Failures of a sensor, or a list of several sensors.
        actuator: Failures of an actuator, or a list of several actuators.
    """

    name: str
    """Name."""
    sensor: PartWithFault | Sequence[PartWithFault] = DEFAULT
    """Failures of a sensor, or a list of several sensors."""
    actuator: PartWithFailure | Sequence[PartWithFailure] = DEFAULT
    """Failures of an actuator, or a list of several actuators."""


class Sampled(Part):
    """A sample at each period, held until the next: guards are tested at samples.

    Args:
        period: Period of the samples (s), at which guards of the law are tested.
        noise: Standard deviation of the white noise (rad), on three axes about each of them. Default: 0.0.
        bias: Constant error (rad). Default: 0.0.
        resolution: Quantum of the output (rad); 0 for none. Default: 0.0.
        rate_noise: Standard deviation of the white noise of a rate gyro (rad/s); default: there is no gyro,
            and the rate is the difference of the last two angles divided by the period.
        point: Point of the structure at which it is mounted, on a body with three axes; default: the first
            of the body's points.
        faults: Intervals in which the sensor fails.
    """

    _tag: ClassVar[str | None] = "sampled"

    period: float
    """Period of the samples (s), at which guards of the law are tested."""
    noise: float = DEFAULT
    """Standard deviation of the white noise (rad), on three axes about each of them. Default: 0.0."""
    bias: float = DEFAULT
    """Constant error (rad). Default: 0.0."""
    resolution: float = DEFAULT
    """Quantum of the output (rad); 0 for none. Default: 0.0."""
    rate_noise: float = DEFAULT
    """Standard deviation of the white noise of a rate gyro (rad/s); default: there is no gyro, and the rate
    is the difference of the last two angles divided by the period.
    """
    point: str = DEFAULT
    """Point of the structure at which it is mounted, on a body with three axes; default: the first of the
    body's points.
    """
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the sensor fails."""


class Scaled(Part):
    """A fraction of the commanded output.

    Args:
        from_: Start time (s).
        factor: The fraction; a negative one reverses the output.
        to: End time (s); default: the end of the run.
        about: Axis that fails, on a body with three; default: all.
        wheel: Wheel that fails, counted from 1; default: all.
        gimbal: Gimbal of `control_moment_gyros` that fails, counted from 1; default: all.
        thruster: Thruster of `jets` that fails; default: all.
    """

    _tag: ClassVar[str | None] = "scaled"

    from_: float
    """Start time (s)."""
    factor: float
    """The fraction; a negative one reverses the output."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""
    about: Literal["roll", "pitch", "yaw"] = DEFAULT
    """Axis that fails, on a body with three; default: all."""
    wheel: int = DEFAULT
    """Wheel that fails, counted from 1; default: all."""
    gimbal: int = DEFAULT
    """Gimbal of `control_moment_gyros` that fails, counted from 1; default: all."""
    thruster: str = DEFAULT
    """Thruster of `jets` that fails; default: all."""


class SceneSpec(Part):
    """How the scene of a run is drawn.

    Args:
        period: Period of the frames (s); default: that of the log, and at least 0.04 s.
        bending: Magnification of the elastic motion; default: chosen so that the motion excited by the
            actuator or the initial state is visible.
        turning: Magnification of the body's rotation; default: chosen so that it is visible.
    """

    period: float = DEFAULT
    """Period of the frames (s); default: that of the log, and at least 0.04 s."""
    bending: float = DEFAULT
    """Magnification of the elastic motion; default: chosen so that the motion excited by the actuator or
    the initial state is visible.
    """
    turning: float = DEFAULT
    """Magnification of the body's rotation; default: chosen so that it is visible."""


class Schedule(Part, kw_only=False):
    """A gain scheduled by the estimated frequency: linear interpolation between points, constant before the
    first and after the last.
    """

    _tag: ClassVar[str | None] = "schedule"

    value: Sequence[ScheduledGain]


class ScheduledGain(Part):
    """A point of a schedule.

    Args:
        frequency: Frequency of the dominant mode (rad/s).
        gain: Gain at that frequency.
    """

    frequency: float
    """Frequency of the dominant mode (rad/s)."""
    gain: float
    """Gain at that frequency."""


class Section(Part):
    """A section of a panel.

    Args:
        length: Length l (m).
        mass_per_length: Mass per unit length m (kg/m).
        hinge_stiffness: Stiffness c of the hinge at the inner end (N m/rad).
        tip_mass: Mass mu lumped at the outer end (kg). Default: 0.0.
    """

    length: float
    """Length l (m)."""
    mass_per_length: float
    """Mass per unit length m (kg/m)."""
    hinge_stiffness: float
    """Stiffness c of the hinge at the inner end (N m/rad)."""
    tip_mass: float = DEFAULT
    """Mass mu lumped at the outer end (kg). Default: 0.0."""


class Shape(Part):
    """The shape of a mode at a point.

    Args:
        translation: Displacement of the point per unit of the modal displacement (1/sqrt(kg)).
        rotation: Rotation at the point per unit of the modal displacement (rad/(m sqrt(kg))).
    """

    translation: Vector = DEFAULT
    """Displacement of the point per unit of the modal displacement (1/sqrt(kg))."""
    rotation: Vector = DEFAULT
    """Rotation at the point per unit of the modal displacement (rad/(m sqrt(kg)))."""


class ShapedZero(Part):
    """A zero of the command's spectrum, at a mode or near it.

    Args:
        mode: Index of the mode.
        shift: Shift of the zero from the mode's frequency, relative to that frequency. Default: 0.0.
        times: Multiplicity of the zero: each additional one makes one more derivative of the spectrum
            vanish there. Default: 1.
    """

    mode: int
    """Index of the mode."""
    shift: float = DEFAULT
    """Shift of the zero from the mode's frequency, relative to that frequency. Default: 0.0."""
    times: int = DEFAULT
    """Multiplicity of the zero: each additional one makes one more derivative of the spectrum vanish there.
    Default: 1.
    """


class Silent(Part):
    """It gives no measurement; the last one remains valid.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
    """

    _tag: ClassVar[str | None] = "silent"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""


class Sine(Part):
    """amplitude sin(frequency t + phase), t from the start of the run.

    Args:
        amplitude: Amplitude (N m).
        frequency: Frequency (rad/s).
        phase: Phase at the start of the run (rad); pi/2 makes a cosine. Default: 0.0.
    """

    amplitude: float
    """Amplitude (N m)."""
    frequency: float
    """Frequency (rad/s)."""
    phase: float = DEFAULT
    """Phase at the start of the run (rad); pi/2 makes a cosine. Default: 0.0."""


class SineCommand(Part):
    """A series of sines ([Rotation], equations (19) to (24)).

    Args:
        suppress: Number of modes left at rest, lowest frequencies first. Default: 0.
        zeros: Further zeros.
    """

    _tag: ClassVar[str | None] = "sine"

    suppress: int = DEFAULT
    """Number of modes left at rest, lowest frequencies first. Default: 0."""
    zeros: Sequence[ShapedZero] = DEFAULT
    """Further zeros."""


class Sinusoid(Part):
    """1 + amplitude (cos(2 pi (t + phase)/period) - cos(2 pi phase/period)): panels that follow the Sun on
    an orbit.

    Args:
        amplitude: Half the difference between the largest and the smallest ratio.
        period: Period (s).
        phase: Time shift of the cosine at the start of the run (s). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "sinusoid"

    amplitude: float
    """Half the difference between the largest and the smallest ratio."""
    period: float
    """Period (s)."""
    phase: float = DEFAULT
    """Time shift of the cosine at the start of the run (s). Default: 0.0."""


class Site(Part):
    """Direction to a site on the Earth, which turns with it.

    Args:
        latitude: Geodetic latitude (rad).
        longitude: Longitude east of Greenwich (rad), whose angle at the start is that of the `epoch`, or 0
            without one.
        height: Height above the ellipsoid of WGS 84 (m). Default: 0.0.
    """

    _tag: ClassVar[str | None] = "site"

    latitude: float
    """Geodetic latitude (rad)."""
    longitude: float
    """Longitude east of Greenwich (rad), whose angle at the start is that of the `epoch`, or 0 without one.
    """
    height: float = DEFAULT
    """Height above the ellipsoid of WGS 84 (m). Default: 0.0."""


class SmallAngles(Part):
    """Linear rotation about a fixed target, in closed form, within bounds. The rotation of the mean axes
    about each body axis must stay within both bounds: a run that leaves them ends with an error.

    Args:
        angle: Largest rotation from the target about each axis (rad). Default: 0.1.
        rate: Largest rate about each axis (rad/s). Default: 0.01.
    """

    angle: float = DEFAULT
    """Largest rotation from the target about each axis (rad). Default: 0.1."""
    rate: float = DEFAULT
    """Largest rate about each axis (rad/s). Default: 0.01."""


class SolarPressure(Part):
    """Pressure of sunlight: one `force` at a point, or `plates`.

    Args:
        force: The force (N), constant in inertial axes whatever the Sun's distance; required without
            `plates`.
        at: Centre of pressure (m): from the point O of a spacecraft, or from the centre of mass of a
            spatial body.
        plates: Plates in place of one force: where the normal n faces the Sun s with the cosine c, the
            force is -P A c ((1 - specular) s + 2 (specular c + diffuse/3) n). A plate with two sides is two
            entries; plates do not shade each other, and the force bends nothing.
        pressure: Pressure of sunlight on the plates at 1 au (N/m²); default: that of 1361 W/m². With `sun =
            "epoch"` it falls with the square of the Sun's distance at the date.
        shadow: Intervals [from, to] without sunlight (s), in addition to the shadow of the orbit's planet.
    """

    force: Vector = DEFAULT
    """The force (N), constant in inertial axes whatever the Sun's distance; required without `plates`."""
    at: Vector = DEFAULT
    """Centre of pressure (m): from the point O of a spacecraft, or from the centre of mass of a spatial
    body.
    """
    plates: Sequence[LitPlate] = DEFAULT
    """Plates in place of one force: where the normal n faces the Sun s with the cosine c, the force is -P A
    c ((1 - specular) s + 2 (specular c + diffuse/3) n). A plate with two sides is two entries; plates do
    not shade each other, and the force bends nothing.
    """
    pressure: float = DEFAULT
    """Pressure of sunlight on the plates at 1 au (N/m²); default: that of 1361 W/m². With `sun = "epoch"`
    it falls with the square of the Sun's distance at the date.
    """
    shadow: Rows = DEFAULT
    """Intervals [from, to] without sunlight (s), in addition to the shadow of the orbit's planet."""


class Spacecraft(Part):
    """A spacecraft: the rigid hub, to which appendages are clamped. Positions are measured from a point O
    of the user's choice, in the axes of the hub, which are the body's axes.

    Args:
        mass: Mass of the hub alone (kg).
        inertia: Inertia tensor of the hub alone about its centre of mass, with wheels locked in it (kg m²),
            row by row.
        centre: Centre of mass of the hub alone (m).
        attitude: Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into
            inertial ones, or `"target"` for that of the target.
        attitude_error: Rotation vector (rad) from `attitude` to the attitude at the start, in the body's
            axes, each component from -2π to 2π; default: none.
        rate: Rates of the whole spacecraft at the start (rad/s), in the body's axes, or `"target"` for
            those of the target; without vibration they are the rates of the hub.
        rate_error: Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000;
            default: none.
        small_angles: Small rotations about a fixed target, in closed form, in place of any rotation; `{}`
            takes both defaults.
        whole_damping: Whether runs keep the full damping matrix of the free modes, as linear tools always
            do; default: if its off-diagonal terms are not negligible.
        frequency_factor: Factor on the natural frequencies of all appendages; default: 1.
        points: Named points of the hub, at which jets and sensors are mounted; default: one at O, named
            `hub`.
    """

    mass: float
    """Mass of the hub alone (kg)."""
    inertia: Rows
    """Inertia tensor of the hub alone about its centre of mass, with wheels locked in it (kg m²), row by
    row.
    """
    centre: Vector = DEFAULT
    """Centre of mass of the hub alone (m)."""
    attitude: Vector | Literal["target"] = DEFAULT
    """Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into inertial
    ones, or `"target"` for that of the target.
    """
    attitude_error: Vector = DEFAULT
    """Rotation vector (rad) from `attitude` to the attitude at the start, in the body's axes, each
    component from -2π to 2π; default: none.
    """
    rate: Vector | Literal["target"] = DEFAULT
    """Rates of the whole spacecraft at the start (rad/s), in the body's axes, or `"target"` for those of
    the target; without vibration they are the rates of the hub.
    """
    rate_error: Vector = DEFAULT
    """Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000; default:
    none.
    """
    small_angles: SmallAngles = DEFAULT
    """Small rotations about a fixed target, in closed form, in place of any rotation; `{}` takes both
    defaults.
    """
    whole_damping: bool = DEFAULT
    """Whether runs keep the full damping matrix of the free modes, as linear tools always do; default: if
    its off-diagonal terms are not negligible.
    """
    frequency_factor: float = DEFAULT
    """Factor on the natural frequencies of all appendages; default: 1."""
    points: Sequence[NamedPoint] = DEFAULT
    """Named points of the hub, at which jets and sensors are mounted; default: one at O, named `hub`."""


class Spatial(Part):
    """Three axes, and elastic modes with shapes at points of the structure.

    Args:
        inertia: Inertia tensor about the centre of mass (kg m²), row by row: symmetric, positive definite.
        attitude: Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into
            inertial ones, or `"target"` for that of the target.
        attitude_error: Rotation vector (rad) from `attitude` to the attitude at the start, in the body's
            axes, each component from -2π to 2π; default: none.
        rate: Rates at the start (rad/s), in the body's axes, or `"target"` for those of the target.
        rate_error: Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000;
            default: none.
        small_angles: Small rotations about a fixed target, in closed form, in place of any rotation.
        points: Named points of the structure, at which jets and sensors are mounted.
        modes: Elastic modes: a table, or the path of a CSV file. Each mode has a shape at every point.
        disturbance: Torque of the environment; none by default.
    """

    _tag: ClassVar[str | None] = "spatial"

    inertia: Rows
    """Inertia tensor about the centre of mass (kg m²), row by row: symmetric, positive definite."""
    attitude: Vector | Literal["target"] = DEFAULT
    """Attitude at the start, a unit quaternion [w, x, y, z] that turns vectors of the body into inertial
    ones, or `"target"` for that of the target.
    """
    attitude_error: Vector = DEFAULT
    """Rotation vector (rad) from `attitude` to the attitude at the start, in the body's axes, each
    component from -2π to 2π; default: none.
    """
    rate: Vector | Literal["target"] = DEFAULT
    """Rates at the start (rad/s), in the body's axes, or `"target"` for those of the target."""
    rate_error: Vector = DEFAULT
    """Rates at the start in addition to `rate` (rad/s), in the body's axes, each at most 1000; default:
    none.
    """
    small_angles: SmallAngles = DEFAULT
    """Small rotations about a fixed target, in closed form, in place of any rotation."""
    points: Sequence[NamedPoint] = DEFAULT
    """Named points of the structure, at which jets and sensors are mounted."""
    modes: Sequence[SpatialMode] | str = DEFAULT
    """Elastic modes: a table, or the path of a CSV file. Each mode has a shape at every point."""
    disturbance: Periodic = DEFAULT
    """Torque of the environment; none by default."""


class SpatialMode(Part):
    """A mass-normalised elastic mode.

    Args:
        frequency: Natural frequency w (rad/s).
        damping: Damping ratio zeta: 0 undamped, 1 critical. Default: 0.0.
        displacement: Modal displacement at the start (m sqrt(kg)). Default: 0.0.
        rate: Modal rate at the start (m sqrt(kg)/s). Default: 0.0.
        shapes: Shape of the mode at each point, by the name of the point.
    """

    frequency: float
    """Natural frequency w (rad/s)."""
    damping: float = DEFAULT
    """Damping ratio zeta: 0 undamped, 1 critical. Default: 0.0."""
    displacement: float = DEFAULT
    """Modal displacement at the start (m sqrt(kg)). Default: 0.0."""
    rate: float = DEFAULT
    """Modal rate at the start (m sqrt(kg)/s). Default: 0.0."""
    shapes: Mapping[str, Shape] = DEFAULT
    """Shape of the mode at each point, by the name of the point."""


class SpeedBias(Part):
    """A bias speed of four wheels, two in one direction and two in the other, in addition to what the
    torque requires.

    Args:
        speed: Bias speed (rad/s): that of the wheel with the largest part in the null vector of the axes,
            and of all four in a pyramid, two in each direction.
        gain: Gain with which the wheels are brought to the bias speed (1/s).
    """

    speed: float
    """Bias speed (rad/s): that of the wheel with the largest part in the null vector of the axes, and of
    all four in a pyramid, two in each direction.
    """
    gain: float
    """Gain with which the wheels are brought to the bias speed (1/s)."""


class Stage(Part):
    """A law that acts from a given time on.

    Args:
        law: The law.
        from_: Start time (s), later than that of the stage before; 0 for the first stage. Default: 0.0.
        actuators: Kinds of the `[[actuator]]` entries that execute the commands of the law, such as
            `["wheels"]`; default: all.
    """

    law: LawKind
    """The law."""
    from_: float = DEFAULT
    """Start time (s), later than that of the stage before; 0 for the first stage. Default: 0.0."""
    actuators: Sequence[Literal[
        "ideal",
        "hold",
        "thrusters",
        "wheel",
        "wheels",
        "control_moment_gyros",
        "jets",
        "magnetorquers",
        "own",
    ]] = DEFAULT
    """Kinds of the `[[actuator]]` entries that execute the commands of the law, such as `["wheels"]`;
    default: all.
    """


class Stages(Part, kw_only=False):
    """Laws that act one after another."""

    _tag: ClassVar[str | None] = "stages"

    value: Sequence[Stage]


class StarTracker(Part):
    """The attitude at the exposures, available after a latency.

    Args:
        period: Period of the exposures (s).
        point: Point of the structure at which the star tracker is mounted; default: the first of the body's
            points.
        noise: Standard deviation of the white noise about the star tracker's axes (rad): x and y across the
            boresight, z about it.
        axes: Orientation of the star tracker's axes in the body: a unit quaternion [w, x, y, z] that
            transforms vectors from its axes to the body's; default: the identity.
        boresight: Direction of the boresight, its z axis, in the body, of any length, in place of `axes`: x
            and y are those of the body, turned by the smallest angle that takes z to the boresight.
        latency: Time from the middle of an exposure to its output (s). Default: 0.0.
        exposure: Exposure time (s), at most `period` and twice `latency`: a reading is the mean attitude
            over the exposure; default: 0, the attitude at an instant.
        blackout_rate: Rate at the star tracker from which on it gives no measurement (rad/s); default: no
            limit.
        exclusion: Angles between the boresight, its z axis, and bright bodies below which it gives no
            measurement; default: none.
        faults: Intervals in which the star tracker fails.
    """

    _tag: ClassVar[str | None] = "star_tracker"

    period: float
    """Period of the exposures (s)."""
    point: str = DEFAULT
    """Point of the structure at which the star tracker is mounted; default: the first of the body's points.
    """
    noise: Vector = DEFAULT
    """Standard deviation of the white noise about the star tracker's axes (rad): x and y across the
    boresight, z about it.
    """
    axes: Vector = DEFAULT
    """Orientation of the star tracker's axes in the body: a unit quaternion [w, x, y, z] that transforms
    vectors from its axes to the body's; default: the identity.
    """
    boresight: Vector = DEFAULT
    """Direction of the boresight, its z axis, in the body, of any length, in place of `axes`: x and y are
    those of the body, turned by the smallest angle that takes z to the boresight.
    """
    latency: float = DEFAULT
    """Time from the middle of an exposure to its output (s). Default: 0.0."""
    exposure: float = DEFAULT
    """Exposure time (s), at most `period` and twice `latency`: a reading is the mean attitude over the
    exposure; default: 0, the attitude at an instant.
    """
    blackout_rate: float = DEFAULT
    """Rate at the star tracker from which on it gives no measurement (rad/s); default: no limit."""
    exclusion: Exclusion = DEFAULT
    """Angles between the boresight, its z axis, and bright bodies below which it gives no measurement;
    default: none.
    """
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the star tracker fails."""


class StateSpaceLaw(Part):
    """A sampled compensator, given by its matrices.

    Args:
        period: Period of its samples (s).
        a: Matrix A, row by row, for at most 64 states; default: there are no states.
        b: Matrix B: one row per state; one column for each input, or for the angle error (rad) and
            optionally a second for the rate error (rad/s).
        c: Matrix C: one row, or one for each output.
        d: Matrix D: one row, or one for each output; default: it is zero.
        inputs: Names of the inputs of one law about three axes together; default: a law about each axis.
        outputs: Axes of the outputs of one law about three axes together; default: roll, pitch and yaw.
        of: Whether the matrices are in discrete or continuous time. Default: "samples".
        command: Quantity that it commands. Default: "torque".
        gain: Factor on the output, which an adaptation may tune; default: 1.
        limit: Largest command, in its unit; no limit by default.
        track: Whether the law tracks a manoeuvre while it lasts, as with accelerations it always does;
            otherwise it takes over at the end of the manoeuvre.
    """

    _tag: ClassVar[str | None] = "state_space"

    period: float
    """Period of its samples (s)."""
    a: Rows = DEFAULT
    """Matrix A, row by row, for at most 64 states; default: there are no states."""
    b: Rows = DEFAULT
    """Matrix B: one row per state; one column for each input, or for the angle error (rad) and optionally a
    second for the rate error (rad/s).
    """
    c: Rows = DEFAULT
    """Matrix C: one row, or one for each output."""
    d: Rows = DEFAULT
    """Matrix D: one row, or one for each output; default: it is zero."""
    inputs: Sequence[str] = DEFAULT
    """Names of the inputs of one law about three axes together; default: a law about each axis."""
    outputs: Sequence[str] = DEFAULT
    """Axes of the outputs of one law about three axes together; default: roll, pitch and yaw."""
    of: Literal["samples", "held", "tustin"] = DEFAULT
    """Whether the matrices are in discrete or continuous time. Default: "samples"."""
    command: Literal["torque", "acceleration"] = DEFAULT
    """Quantity that it commands. Default: "torque"."""
    gain: float = DEFAULT
    """Factor on the output, which an adaptation may tune; default: 1."""
    limit: float = DEFAULT
    """Largest command, in its unit; no limit by default."""
    track: bool = DEFAULT
    """Whether the law tracks a manoeuvre while it lasts, as with accelerations it always does; otherwise it
    takes over at the end of the manoeuvre.
    """


class StuckFailure(Part):
    """A constant output, whatever the command.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
        about: Axis that fails, on a body with three; default: all.
        wheel: Wheel that fails, counted from 1; default: all.
        gimbal: Gimbal of `control_moment_gyros` that fails, counted from 1; default: all.
        thruster: Thruster of `jets` that fails; default: all.
        at: The output: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate (rad/s), for
            jets a fraction of their thrust; default: the output when the failure begins.
    """

    _tag: ClassVar[str | None] = "stuck"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""
    about: Literal["roll", "pitch", "yaw"] = DEFAULT
    """Axis that fails, on a body with three; default: all."""
    wheel: int = DEFAULT
    """Wheel that fails, counted from 1; default: all."""
    gimbal: int = DEFAULT
    """Gimbal of `control_moment_gyros` that fails, counted from 1; default: all."""
    thruster: str = DEFAULT
    """Thruster of `jets` that fails; default: all."""
    at: float = DEFAULT
    """The output: a torque (N m); for magnetorquers a moment (A m²), for gimbals a rate (rad/s), for jets a
    fraction of their thrust; default: the output when the failure begins.
    """


class StuckFault(Part):
    """It repeats the last measurement before the failure.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
    """

    _tag: ClassVar[str | None] = "stuck"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""


class Sum(Part):
    """A sum of coordinates that is observed.

    Args:
        name: Name, such as `tip`.
        weights: Weight of each coordinate, or a table of weights by the names of coordinates.
        unit: Unit. Default: "rad".
    """

    name: str
    """Name, such as `tip`."""
    weights: Vector | Mapping[str, float]
    """Weight of each coordinate, or a table of weights by the names of coordinates."""
    unit: str = DEFAULT
    """Unit. Default: "rad"."""


class SunCell(Part):
    """A Sun cell.

    Args:
        normal: Outward normal in the body's axes, of any length.
        scale: Relative error of its signal. Default: 0.0.
        bias: Constant error of its signal. Default: 0.0.
    """

    normal: Vector
    """Outward normal in the body's axes, of any length."""
    scale: float = DEFAULT
    """Relative error of its signal. Default: 0.0."""
    bias: float = DEFAULT
    """Constant error of its signal. Default: 0.0."""


class SunCells(Part):
    """The direction to the Sun, from the currents of cells.

    Args:
        cells: The cells, three to 64, whose normals are not all in a plane.
        period: Period of their samples (s).
        field_of_view: Half angle within which light reaches a cell (rad), at most pi/2; default: pi/2.
            Default: 1.5707963267948966.
        threshold: Signal below which a cell counts as dark; a cell that faces the Sun has the signal 1.
            Default: 0.1.
        point: Point of the structure at which they are mounted; default: the first of the body's points.
        noise: Standard deviation of the white noise of each signal. Default: 0.0.
        latency: Time from a sample to its output (s). Default: 0.0.
        faults: Intervals in which all cells fail.
    """

    _tag: ClassVar[str | None] = "sun_cells"

    cells: Sequence[SunCell]
    """The cells, three to 64, whose normals are not all in a plane."""
    period: float
    """Period of their samples (s)."""
    field_of_view: float = DEFAULT
    """Half angle within which light reaches a cell (rad), at most pi/2; default: pi/2. Default:
    1.5707963267948966.
    """
    threshold: float = DEFAULT
    """Signal below which a cell counts as dark; a cell that faces the Sun has the signal 1. Default: 0.1."""
    point: str = DEFAULT
    """Point of the structure at which they are mounted; default: the first of the body's points."""
    noise: float = DEFAULT
    """Standard deviation of the white noise of each signal. Default: 0.0."""
    latency: float = DEFAULT
    """Time from a sample to its output (s). Default: 0.0."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which all cells fail."""


class SunSensor(Part):
    """The direction to the Sun.

    Args:
        period: Period of its samples (s).
        boresight: Centre of its field of view, a direction in the body's axes, of any length; default: z.
        field_of_view: Half angle of the field of view (rad); default: all directions are visible. Default:
            3.141592653589793.
        point: Point of the structure at which it is mounted; default: the first of the body's points.
        noise: Standard deviation of the white noise along each axis (rad). Default: 0.0.
        bias: Constant error along each axis (rad). Default: 0.0.
        resolution: Quantum of the output along each axis (rad); 0 for none. Default: 0.0.
        scale: Relative error of the scale along each axis. Default: 0.0.
        misalignment: Misalignment (rad): row i gives what axis i measures of the direction along the other
            axes; the diagonal is 0.
        latency: Time from a sample to its output (s). Default: 0.0.
        faults: Intervals in which the Sun sensor fails.
    """

    _tag: ClassVar[str | None] = "sun_sensor"

    period: float
    """Period of its samples (s)."""
    boresight: Vector = DEFAULT
    """Centre of its field of view, a direction in the body's axes, of any length; default: z."""
    field_of_view: float = DEFAULT
    """Half angle of the field of view (rad); default: all directions are visible. Default:
    3.141592653589793.
    """
    point: str = DEFAULT
    """Point of the structure at which it is mounted; default: the first of the body's points."""
    noise: float | Vector = DEFAULT
    """Standard deviation of the white noise along each axis (rad). Default: 0.0."""
    bias: float | Vector = DEFAULT
    """Constant error along each axis (rad). Default: 0.0."""
    resolution: float | Vector = DEFAULT
    """Quantum of the output along each axis (rad); 0 for none. Default: 0.0."""
    scale: float | Vector = DEFAULT
    """Relative error of the scale along each axis. Default: 0.0."""
    misalignment: Rows = DEFAULT
    """Misalignment (rad): row i gives what axis i measures of the direction along the other axes; the
    diagonal is 0.
    """
    latency: float = DEFAULT
    """Time from a sample to its output (s). Default: 0.0."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the Sun sensor fails."""


class TableProfile(Part, kw_only=False):
    """Linear interpolation between points, constant before the first and after the last."""

    _tag: ClassVar[str | None] = "table"

    value: Sequence[Point]


class Tachometer(Part):
    """The speeds of the wheels, for their drives; it measures nothing of the body's motion.

    Args:
        period: Period of the readings (s).
        pulses: Pulses per turn: a reading is the count over a period divided by the period, and the
            remainder carries over to the next one. By default, the speed at the instant is read.
        noise: Standard deviation of the white noise of each reading (rad/s). Default: 0.0.
        faults: Intervals in which the tachometers fail; the drives then keep the last reading.
    """

    _tag: ClassVar[str | None] = "tachometer"

    period: float
    """Period of the readings (s)."""
    pulses: int = DEFAULT
    """Pulses per turn: a reading is the count over a period divided by the period, and the remainder
    carries over to the next one. By default, the speed at the instant is read.
    """
    noise: float = DEFAULT
    """Standard deviation of the white noise of each reading (rad/s). Default: 0.0."""
    faults: Sequence[FaultKind] = DEFAULT
    """Intervals in which the tachometers fail; the drives then keep the last reading."""


class Target(Part):
    """A target attitude: yaw, then pitch about the rotated y axis, then roll about the twice rotated x
    axis.

    Args:
        from_: Start time (s), later than that of the target before.
        frame: Frame relative to which the attitude is given; default: inertial.
        primary: Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw
            are relative to the attitude that these two give.
        secondary: Axis of the body that is as near to a direction as `primary` lets it.
        roll: Roll (rad), like pitch and yaw from -2π to 2π: yaw comes first, then pitch about the turned
            axis, then roll. Default: 0.0.
        pitch: Pitch (rad). Default: 0.0.
        yaw: Yaw (rad). Default: 0.0.
        acceleration: Largest acceleration of the slew about one axis to it (rad/s²); default: the reference
            jumps.
        rate_limit: Largest rate of the slew (rad/s); no limit by default.
        profile: How the rate of the slew rises and falls; default: trapezoid.
        command: Command planned for the slew, in place of `acceleration`; it may leave modes at rest.
        duration: Duration of the slew by that command (s), without what a shaper adds and without the decay
            of a rate before it.
        shaper: Shaper that suppresses modes: the acceleration of the slew is convolved with impulses.
        table: Table of attitudes over time in place of a single one: splines of roll, pitch and yaw, at
            rest at both ends.
    """

    from_: float
    """Start time (s), later than that of the target before."""
    frame: Literal["inertial", "nadir", "sun"] = DEFAULT
    """Frame relative to which the attitude is given; default: inertial."""
    primary: PointedAxis = DEFAULT
    """Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw are
    relative to the attitude that these two give.
    """
    secondary: PointedAxis = DEFAULT
    """Axis of the body that is as near to a direction as `primary` lets it."""
    roll: float = DEFAULT
    """Roll (rad), like pitch and yaw from -2π to 2π: yaw comes first, then pitch about the turned axis,
    then roll. Default: 0.0.
    """
    pitch: float = DEFAULT
    """Pitch (rad). Default: 0.0."""
    yaw: float = DEFAULT
    """Yaw (rad). Default: 0.0."""
    acceleration: float = DEFAULT
    """Largest acceleration of the slew about one axis to it (rad/s²); default: the reference jumps."""
    rate_limit: float = DEFAULT
    """Largest rate of the slew (rad/s); no limit by default."""
    profile: Literal["trapezoid", "versine"] = DEFAULT
    """How the rate of the slew rises and falls; default: trapezoid."""
    command: CommandKind = DEFAULT
    """Command planned for the slew, in place of `acceleration`; it may leave modes at rest."""
    duration: float = DEFAULT
    """Duration of the slew by that command (s), without what a shaper adds and without the decay of a rate
    before it.
    """
    shaper: ShaperKind = DEFAULT
    """Shaper that suppresses modes: the acceleration of the slew is convolved with impulses."""
    table: Sequence[AttitudeAt] = DEFAULT
    """Table of attitudes over time in place of a single one: splines of roll, pitch and yaw, at rest at
    both ends.
    """


class Thermal(Part):
    """Thermal bending.

    Args:
        deflection: Steady displacement of each mode in sunlight relative to shadow (m sqrt(kg)).
        time_constant: Time constant of that displacement (s).
    """

    deflection: Vector
    """Steady displacement of each mode in sunlight relative to shadow (m sqrt(kg))."""
    time_constant: float
    """Time constant of that displacement (s)."""


class Thruster(Part):
    """One thruster.

    Args:
        name: Name.
        point: Point of the structure on which it is mounted.
        direction: Direction of the force on the body, of length 1.
        thrust: Thrust (N).
        offset: Position of its nozzle relative to that point (m).
    """

    name: str
    """Name."""
    point: str
    """Point of the structure on which it is mounted."""
    direction: Vector
    """Direction of the force on the body, of length 1."""
    thrust: float
    """Thrust (N)."""
    offset: Vector = DEFAULT
    """Position of its nozzle relative to that point (m)."""


class Thrusters(Part):
    """One pulse of full torque per period, centred in it, with the same impulse as a zero-order hold.

    Args:
        torque: Torque of a pulse (N m): one number for all axes, or a list of three. Each period has one
            pulse, centred in it, with the impulse of a hold; what it cannot give carries over, up to one
            whole period.
        period: Period of the pulses (s).
        phase: Time of the first period (s); default: 0.
        minimum_on: Shortest pulse (s). Default: 0.0.
        quantum: Quantum of a pulse's length (s); 0 for none. Default: 0.0.
        faults: Intervals in which the thrusters fail.
    """

    _tag: ClassVar[str | None] = "thrusters"

    torque: float | Vector
    """Torque of a pulse (N m): one number for all axes, or a list of three. Each period has one pulse,
    centred in it, with the impulse of a hold; what it cannot give carries over, up to one whole period.
    """
    period: float
    """Period of the pulses (s)."""
    phase: float = DEFAULT
    """Time of the first period (s); default: 0."""
    minimum_on: float = DEFAULT
    """Shortest pulse (s). Default: 0.0."""
    quantum: float = DEFAULT
    """Quantum of a pulse's length (s); 0 for none. Default: 0.0."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the thrusters fail."""


class TitleBlock(Part):
    """Title block of the page that `flexsc report` writes. Every key is a plain text; one that is absent
    leaves no empty field.

    Args:
        title: Title of the page; default: `about`, or the name of the scenario.
        project: Project.
        author: Author.
        issue: Issue or revision.
        date: Date of the issue.
    """

    title: str = DEFAULT
    """Title of the page; default: `about`, or the name of the scenario."""
    project: str = DEFAULT
    """Project."""
    author: str = DEFAULT
    """Author."""
    issue: str = DEFAULT
    """Issue or revision."""
    date: str = DEFAULT
    """Date of the issue."""


class Tracker(Part):
    """Initial values of one mode in the observer of a channel.

    Args:
        frequency: Natural frequency (rad/s).
        influence: Influence of each input: the jump of the elastic rate in this channel for a unit jump of
            the rigid rate that the input makes about its own axis ([Timakov14], page 41; dimensionless).
        bounds: Bounds `[low, high]` of the frequency (rad/s); default: the midpoints between it and its
            neighbours.
    """

    frequency: float
    """Natural frequency (rad/s)."""
    influence: Vector
    """Influence of each input: the jump of the elastic rate in this channel for a unit jump of the rigid
    rate that the input makes about its own axis ([Timakov14], page 41; dimensionless).
    """
    bounds: Vector = DEFAULT
    """Bounds `[low, high]` of the frequency (rad/s); default: the midpoints between it and its neighbours.
    """


class TruthEstimator(Part):
    """The true dominant mode, as an ideal observer gives it.

    Args:
        feeds: Angle and rate that the law reads in addition to the dominant mode: `modes` for the measured
            ones, `hub`, or `rigid`; default: `modes` for a law that reads the dominant mode, else `hub`.
    """

    _tag: ClassVar[str | None] = "truth"

    feeds: Literal["modes", "hub", "rigid"] = DEFAULT
    """Angle and rate that the law reads in addition to the dominant mode: `modes` for the measured ones,
    `hub`, or `rigid`; default: `modes` for a law that reads the dominant mode, else `hub`.
    """


class Turn(Part):
    """A turn about a fixed axis.

    Args:
        about: Axis, of any nonzero length; of several turns, each is about axes turned by those before.
        by: The angle (rad).
    """

    about: Vector
    """Axis, of any nonzero length; of several turns, each is about axes turned by those before."""
    by: float
    """The angle (rad)."""


class TwoLineOrbit(Part):
    """Orbit by two-line elements, in the axes of the true equator and the mean equinox, which differ from
    the mean equator and equinox by the nutation.

    Args:
        tle: Mean elements about the Earth, from 0.05 to 18 revolutions a day: both lines of a two-line
            element set, three with a name, one text of them, or the path of a file of them or of an OMM
            (keywords, XML, JSON). SGP4 gives the position, from a period of 225 min on SDP4 with Sun, Moon
            and resonances. The run starts at the `epoch`, else at that of the elements (`check` remarks
            more than 14 days between them), in axes of the true equator and mean equinox, without nutation,
            up to 18 arc seconds. Jumps of SDP4 of more than 2 km are refused.
        gravity: Gravitational parameter of the planet (m³/s²); default: the Earth's. Default:
            398600441800000.0.
        planet_radius: Radius of the planet (m), for its shadow; default: the Earth's equatorial radius.
            Default: 6378137.0.
    """

    tle: Sequence[str] | str | ElementMessage
    """Mean elements about the Earth, from 0.05 to 18 revolutions a day: both lines of a two-line element
    set, three with a name, one text of them, or the path of a file of them or of an OMM (keywords, XML,
    JSON). SGP4 gives the position, from a period of 225 min on SDP4 with Sun, Moon and resonances. The
    run starts at the `epoch`, else at that of the elements (`check` remarks more than 14 days between
    them), in axes of the true equator and mean equinox, without nutation, up to 18 arc seconds. Jumps of
    SDP4 of more than 2 km are refused.
    """
    gravity: float = DEFAULT
    """Gravitational parameter of the planet (m³/s²); default: the Earth's. Default: 398600441800000.0."""
    planet_radius: float = DEFAULT
    """Radius of the planet (m), for its shadow; default: the Earth's equatorial radius. Default: 6378137.0.
    """


class Uniform(Part, kw_only=False):
    """Uniform between two values."""

    _tag: ClassVar[str | None] = "uniform"

    value: Vector


class UniformPlate(Part):
    """A uniform rectangular panel of the mass of its appendage, clamped at the middle of one edge, in the
    first bending mode of a cantilever.

    Args:
        length: Length from the root to the tip (m).
        width: Width (m).
        frequency: First natural frequency with the root held (rad/s).
        along: Axis along which it extends from the root; it bends out of the plane of x and y. Default:
            "y".
        damping: Damping ratio zeta with the root held: 0 undamped, 1 critical. Default: 0.0.
    """

    length: float
    """Length from the root to the tip (m)."""
    width: float
    """Width (m)."""
    frequency: float
    """First natural frequency with the root held (rad/s)."""
    along: Literal["x", "y"] = DEFAULT
    """Axis along which it extends from the root; it bends out of the plane of x and y. Default: "y"."""
    damping: float = DEFAULT
    """Damping ratio zeta with the root held: 0 undamped, 1 critical. Default: 0.0."""


class UnitPair(Part):
    """Both units, as a scenario has them.

    Args:
        length: Unit of length.
        mass: Unit of mass.
    """

    length: Literal["m", "cm", "mm", "in", "ft"]
    """Unit of length."""
    mass: Literal["kg", "g", "t", "lb", "slug", "slinch"]
    """Unit of mass."""


class Unloading(Part):
    """Unloading of the wheels by jets or by magnetorquers, within the wheels.

    Args:
        above: Total momentum of the wheels above which unloading begins (N m s).
        below: Total momentum below which unloading ends (N m s).
        torque: Largest mean torque of the jets about each axis over a cycle (N m), which the wheels
            counteract.
        jets: Jets for unloading, with their own period and without a delay.
        magnetorquers: Magnetorquers for unloading.
        gain: For magnetorquers: the fraction of the momentum perpendicular to the field that they remove
            per second (1/s).
        period: For magnetorquers: the period of their commands (s).
    """

    _bare: ClassVar[tuple[str, ...]] = ("jets", "magnetorquers", )

    above: float
    """Total momentum of the wheels above which unloading begins (N m s)."""
    below: float
    """Total momentum below which unloading ends (N m s)."""
    torque: float = DEFAULT
    """Largest mean torque of the jets about each axis over a cycle (N m), which the wheels counteract."""
    jets: Jets = DEFAULT
    """Jets for unloading, with their own period and without a delay."""
    magnetorquers: Magnetorquers = DEFAULT
    """Magnetorquers for unloading."""
    gain: float = DEFAULT
    """For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per
    second (1/s).
    """
    period: float = DEFAULT
    """For magnetorquers: the period of their commands (s)."""


class Unloads(Part):
    """How an actuator of a list unloads the wheels of the list.

    Args:
        above: Total momentum of the wheels above which unloading begins (N m s).
        below: Total momentum below which unloading ends (N m s).
        torque: For jets: the largest mean torque about each axis over a cycle (N m), which the wheels
            counteract.
        gain: For magnetorquers: the fraction of the momentum perpendicular to the field that they remove
            per second (1/s).
        period: For magnetorquers: the period of their commands (s).
        phase: For magnetorquers: time of their first command (s); default: 0.
    """

    above: float
    """Total momentum of the wheels above which unloading begins (N m s)."""
    below: float
    """Total momentum below which unloading ends (N m s)."""
    torque: float = DEFAULT
    """For jets: the largest mean torque about each axis over a cycle (N m), which the wheels counteract."""
    gain: float = DEFAULT
    """For magnetorquers: the fraction of the momentum perpendicular to the field that they remove per
    second (1/s).
    """
    period: float = DEFAULT
    """For magnetorquers: the period of their commands (s)."""
    phase: float = DEFAULT
    """For magnetorquers: time of their first command (s); default: 0."""


class UnscentedKalman(Part):
    """An unscented Kalman filter of the motion and the natural frequencies.

    Args:
        modes: Modes of the filter's model; default: the body's own at the start of each run.
        moment_noise: Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default:
            1e-13.
        angle_noise: Standard deviation of the measured angle (rad), required where the sensor has none,
            such as a gyro; default: that of the sensor, with the square of its `resolution` over 12 added
            to the variance.
        initial: Standard deviations of the estimate at the start.
        prior: Initial state estimate of the filter. Default: "drawn".
        dominant: Criterion for the dominant mode. Default: "excitability".
        assess: Interval over which the metrics assess the filter (s); default: the whole run.
        feeds: Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as
            measured; `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid
            angle and rate. By default, `modes` for a law that reads the dominant mode, else `hub`.
        watch_only: Whether the filter runs for assessment only: the law does not read it.
        ratios: Which frequencies drift together. Default: "common".
        ratio: Initial estimate of the frequency ratio: unless `prior` is `true`, the estimate is drawn
            around it. Default: 1.0.
        ratio_sd: Standard deviation of the initial ratio. Default: 0.03.
        ratio_rate_sd: Standard deviation of the ratio's initial rate, which is estimated as 0 (1/s).
            Default: 0.003.
        ratio_noise: Spectral density of the white noise in a ratio (1/s). Default: 1e-08.
        ratio_rate_noise: Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08.
        bounds: Bounds `[low, high]` of a ratio; a filter that reaches them has lost lock.
        substeps: Number of prediction steps per period, 1 to 100; with a gyro of 1e-6 rad/s use 8. Default:
            2.
        gate: Amplitude of the dominant mode, in standard deviations of the angle, below which the ratios
            are not updated. Default: 3.0.
    """

    _tag: ClassVar[str | None] = "unscented_kalman"

    modes: Sequence[Mode] = DEFAULT
    """Modes of the filter's model; default: the body's own at the start of each run."""
    moment_noise: float = DEFAULT
    """Spectral density of the white noise in the reduced moment ((rad/s²)² s). Default: 1e-13."""
    angle_noise: float = DEFAULT
    """Standard deviation of the measured angle (rad), required where the sensor has none, such as a gyro;
    default: that of the sensor, with the square of its `resolution` over 12 added to the variance.
    """
    initial: Initial = DEFAULT
    """Standard deviations of the estimate at the start."""
    prior: Literal["drawn", "true"] = DEFAULT
    """Initial state estimate of the filter. Default: "drawn"."""
    dominant: Literal["excitability", "amplitude"] = DEFAULT
    """Criterion for the dominant mode. Default: "excitability"."""
    assess: Vector = DEFAULT
    """Interval over which the metrics assess the filter (s); default: the whole run."""
    feeds: Literal["modes", "hub", "rigid"] = DEFAULT
    """Estimates that the law reads: `modes` for the dominant mode only, with angle and rate as measured;
    `hub` for angle and rate of the hub, elastic part included; `rigid` for the rigid angle and rate. By
    default, `modes` for a law that reads the dominant mode, else `hub`.
    """
    watch_only: bool = DEFAULT
    """Whether the filter runs for assessment only: the law does not read it."""
    ratios: Literal["common", "each"] = DEFAULT
    """Which frequencies drift together. Default: "common"."""
    ratio: float = DEFAULT
    """Initial estimate of the frequency ratio: unless `prior` is `true`, the estimate is drawn around it.
    Default: 1.0.
    """
    ratio_sd: float = DEFAULT
    """Standard deviation of the initial ratio. Default: 0.03."""
    ratio_rate_sd: float = DEFAULT
    """Standard deviation of the ratio's initial rate, which is estimated as 0 (1/s). Default: 0.003."""
    ratio_noise: float = DEFAULT
    """Spectral density of the white noise in a ratio (1/s). Default: 1e-08."""
    ratio_rate_noise: float = DEFAULT
    """Spectral density of the white noise in the rate of a ratio (1/s³). Default: 1e-08."""
    bounds: Vector = DEFAULT
    """Bounds `[low, high]` of a ratio; a filter that reaches them has lost lock."""
    substeps: int = DEFAULT
    """Number of prediction steps per period, 1 to 100; with a gyro of 1e-6 rad/s use 8. Default: 2."""
    gate: float = DEFAULT
    """Amplitude of the dominant mode, in standard deviations of the angle, below which the ratios are not
    updated. Default: 3.0.
    """


class Wheel(Part):
    """A flywheel on a motor with back-EMF.

    Args:
        gain: Torque per unit of the law's command (N m; k'_u of [Wheel11, Sukhanov] times the body's
            inertia).
        back_emf: Back-EMF torque per unit of the rate (N m s; k'_omega times the body's inertia). Default:
            0.0.
        opposes: The rate that the back-EMF opposes. Default: "body_rate".
        rotor: The wheel, whose speed and momentum `/wheel` then logs; it must be the only actuator.
        dead_zone: Commands smaller than this are not executed. Default: 0.0.
        quantum: Quantum of the command; 0 for none. Default: 0.0.
        limit: Largest command, in units of the command; no limit by default.
        delay: Time from a sample to the execution of the command computed from it (s). Default: 0.0.
        faults: Intervals in which the motor fails to execute commands; its back-EMF still acts.
    """

    _tag: ClassVar[str | None] = "wheel"

    gain: float
    """Torque per unit of the law's command (N m; k'_u of [Wheel11, Sukhanov] times the body's inertia)."""
    back_emf: float = DEFAULT
    """Back-EMF torque per unit of the rate (N m s; k'_omega times the body's inertia). Default: 0.0."""
    opposes: Literal["body_rate", "rigid_rate"] = DEFAULT
    """The rate that the back-EMF opposes. Default: "body_rate"."""
    rotor: Rotor = DEFAULT
    """The wheel, whose speed and momentum `/wheel` then logs; it must be the only actuator."""
    dead_zone: float = DEFAULT
    """Commands smaller than this are not executed. Default: 0.0."""
    quantum: float = DEFAULT
    """Quantum of the command; 0 for none. Default: 0.0."""
    limit: float = DEFAULT
    """Largest command, in units of the command; no limit by default."""
    delay: float = DEFAULT
    """Time from a sample to the execution of the command computed from it (s). Default: 0.0."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the motor fails to execute commands; its back-EMF still acts."""


class Wheels(Part):
    """Reaction wheels about axes of their own.

    Args:
        inertia: Moment of inertia of each wheel about its axis (kg m²). The inertia tensor of a
            `[body.spatial]` excludes it; that of a `[spacecraft]` includes the locked wheels.
        arrangement: Arrangement of the wheels; default: given by `axes`.
        cant: For a pyramid: angle of each axis above the xy plane (rad); default: 0.6155 rad, which gives
            equal torques about all three axes.
        axes: Axis of each wheel in the body's axes, of any length.
        points: Point of the structure that carries each wheel, such as one of an appendage with a `mount`:
            one name for all wheels, or one for each. The rotor acts there, with the whole rate of the
            point. Default: all are on the hub.
        torque: Largest torque of each motor (N m); no limit by default. If a demanded torque exceeds it,
            the whole torque is scaled down and keeps its axis.
        momentum: Largest momentum of each wheel about its axis (N m s), beyond which its motor cannot
            accelerate it; no limit by default.
        speed_limit: Largest speed of each wheel (rad/s), beyond which its motor cannot accelerate it; no
            limit by default.
        delay: Time from a command of the law to the torques of the motors (s), as computation and data bus
            take it.
        speeds: Speed of each wheel at the start, relative to the body (rad/s); default: 0.
        friction: Friction of the bearings; none by default.
        compensation: Friction that the drives assume and compensate within `torque`, from the true or
            measured wheel speeds; none by default.
        imbalance: Imbalance of the wheels; none by default.
        allocation: How the demanded torque is distributed over the wheels. Default: "pseudo_inverse".
        speed_bias: For four wheels: a bias speed, maintained by torques that cancel each other; none by
            default.
        unloading: Unloading by jets or magnetorquers; none by default.
        faults: Intervals in which the motors fail: all, or the `wheel` of a number from 1.
    """

    _tag: ClassVar[str | None] = "wheels"

    inertia: float
    """Moment of inertia of each wheel about its axis (kg m²). The inertia tensor of a `[body.spatial]`
    excludes it; that of a `[spacecraft]` includes the locked wheels.
    """
    arrangement: Literal["orthogonal", "pyramid"] = DEFAULT
    """Arrangement of the wheels; default: given by `axes`."""
    cant: float = DEFAULT
    """For a pyramid: angle of each axis above the xy plane (rad); default: 0.6155 rad, which gives equal
    torques about all three axes.
    """
    axes: Rows = DEFAULT
    """Axis of each wheel in the body's axes, of any length."""
    points: str | Sequence[str] = DEFAULT
    """Point of the structure that carries each wheel, such as one of an appendage with a `mount`: one name
    for all wheels, or one for each. The rotor acts there, with the whole rate of the point. Default: all
    are on the hub.
    """
    torque: float = DEFAULT
    """Largest torque of each motor (N m); no limit by default. If a demanded torque exceeds it, the whole
    torque is scaled down and keeps its axis.
    """
    momentum: float = DEFAULT
    """Largest momentum of each wheel about its axis (N m s), beyond which its motor cannot accelerate it;
    no limit by default.
    """
    speed_limit: float = DEFAULT
    """Largest speed of each wheel (rad/s), beyond which its motor cannot accelerate it; no limit by
    default.
    """
    delay: float = DEFAULT
    """Time from a command of the law to the torques of the motors (s), as computation and data bus take it.
    """
    speeds: Vector = DEFAULT
    """Speed of each wheel at the start, relative to the body (rad/s); default: 0."""
    friction: Friction = DEFAULT
    """Friction of the bearings; none by default."""
    compensation: Compensation = DEFAULT
    """Friction that the drives assume and compensate within `torque`, from the true or measured wheel
    speeds; none by default.
    """
    imbalance: Imbalance = DEFAULT
    """Imbalance of the wheels; none by default."""
    allocation: Literal["pseudo_inverse", "least_largest"] = DEFAULT
    """How the demanded torque is distributed over the wheels. Default: "pseudo_inverse"."""
    speed_bias: SpeedBias = DEFAULT
    """For four wheels: a bias speed, maintained by torques that cancel each other; none by default."""
    unloading: Unloading = DEFAULT
    """Unloading by jets or magnetorquers; none by default."""
    faults: Sequence[FailureKind] = DEFAULT
    """Intervals in which the motors fail: all, or the `wheel` of a number from 1."""


class Zero(Part):
    """Readings of zeros, which are marked as valid.

    Args:
        from_: Start time (s).
        to: End time (s); default: the end of the run.
    """

    _tag: ClassVar[str | None] = "zero"

    from_: float
    """Start time (s)."""
    to: float = DEFAULT
    """End time (s); default: the end of the run."""


class Zv(Part):
    """Zero vibration: two impulses for each mode, half a damped period apart.

    Args:
        modes: Indices of the modes.
    """

    _tag: ClassVar[str | None] = "zv"

    modes: Sequence[int] = DEFAULT
    """Indices of the modes."""


class Zvd(Part):
    """Zero vibration and derivative: three impulses.

    Args:
        modes: Indices of the modes.
    """

    _tag: ClassVar[str | None] = "zvd"

    modes: Sequence[int] = DEFAULT
    """Indices of the modes."""


class Zvdd(Part):
    """Zero vibration and two derivatives: four impulses.

    Args:
        modes: Indices of the modes.
    """

    _tag: ClassVar[str | None] = "zvdd"

    modes: Sequence[int] = DEFAULT
    """Indices of the modes."""


ActuatorKind: TypeAlias = (
    Ideal
    | HoldActuator
    | Thrusters
    | Wheel
    | Wheels
    | ControlMomentGyros
    | Jets
    | Magnetorquers
)
"""The kinds of actuator. On a body with three axes, an actuator for one angle acts about each of them."""
AdaptationKind: TypeAlias = RandomSearch
"""The kinds of adaptation."""
BodyKind: TypeAlias = Planar | Matrices | Panels | Spatial
"""The kinds of body."""
CommandKind: TypeAlias = SineCommand | Cosine | BangBang | MinimumEnergy | MinimumPeak | Polynomial
"""The kinds of command."""
DistributionKind: TypeAlias = Uniform | LogUniform | Normal | RelativeUniform | RelativeNormal | Choice
"""The distribution of one key of the scenario."""
DriftKind: TypeAlias = Common | Each
"""How the frequencies of a body drift."""
EstimatorKind: TypeAlias = (
    Envelope
    | TruthEstimator
    | Kalman
    | ExtendedKalman
    | UnscentedKalman
    | AttitudeEstimator
    | RigidRate
    | Adaptive
)
"""The kinds of estimator."""
ExtraKind: TypeAlias = Gain | Schedule
"""The extra loop on the dominant mode; its gain is k_d of the papers."""
FailureKind: TypeAlias = Dead | Scaled | StuckFailure | Added
"""A failure of an actuator."""
FaultKind: TypeAlias = StuckFault | Silent | Outlier | Zero | Invalid
"""A failure of the sensor, gyro included."""
FilterFormKind: TypeAlias = Complementary
"""How the gains are computed."""
FilterKind: TypeAlias = Notch | LowPass | Lead | Biquad
"""The kinds of filter."""
LawKind: TypeAlias = Relay | Pd | AttitudeLaw | StateSpaceLaw | Open | PhasePlane | PerAxis | BDot | Stages
"""The kinds of law."""
ObserverFormKind: TypeAlias = Gradient | Recurrence
"""The forms of an observer."""
ProfileKind: TypeAlias = Ramp | Sinusoid | TableProfile
"""A profile of the ratio over time."""
SensorKind: TypeAlias = (
    Sampled
    | Gyro
    | StarTracker
    | Magnetometer
    | SunSensor
    | SunCells
    | EarthSensor
    | Tachometer
    | Accelerometer
)
"""The kinds of sensor."""
ShaperKind: TypeAlias = Zv | Zvd | Zvdd | Ei
"""The kinds of shaper."""
SkyDirectionKind: TypeAlias = Orbit | Inertial | Site
"""Direction in the sky."""


class Keys(TypedDict, total=False):
    """The keys of a scenario, as `flexsc.Scenario` takes them."""

    about: str
    """Description of the study."""

    seed: int
    """Seed of all random numbers."""

    duration: float
    """Simulated time (s)."""

    epoch: datetime
    """Date and time of the start, such as `2026-03-20T14:46:00Z`, from which a log counts its time; a
    second 60 is a leap second, at the end of June or December. Default: none.
    """

    document: TitleBlock
    """Title block of the page that `flexsc report` writes."""

    body: BodyKind
    """The controlled body, unless it is a `spacecraft`."""

    spacecraft: Spacecraft
    """The hub of a controlled spacecraft, which is built from its parts."""

    appendage: Sequence[Appendage]
    """Appendages clamped to the hub of the spacecraft."""

    drift: DriftKind
    """Drift of the natural frequencies; default: none."""

    sensor: SensorKind | Literal["continuous"] | Sequence[SensorKind | Literal["continuous"]]
    """The sensor, or an array of several."""

    estimator: EstimatorKind
    """The estimator."""

    adaptation: AdaptationKind
    """The adaptation."""

    manoeuvre: Manoeuvre
    """The planned manoeuvre."""

    law: LawKind
    """The control law. Only a scenario with a manoeuvre or with modes can omit it."""

    mode: Sequence[OperatingMode]
    """Modes of operation, each with a law of its own; a run begins in the first."""

    flight_precision: Literal["double", "single"]
    """Precision of the flight computer: its estimator, its laws and the distribution of their commands."""

    actuator: (
        ActuatorKind | Assigned | Literal["ideal"] | Sequence[ActuatorKind | Assigned | Literal["ideal"]]
    )
    """The actuator, which executes the commanded torque, or an array of several."""

    disturbance: Sequence[Disturbance]
    """Disturbance torques and forces."""

    environment: Environment
    """Environment of a body with three axes; default: none."""

    log: LogContents
    """Contents of a full log."""

    target: Sequence[Target]
    """Target attitudes of a body with three axes, in the order of their times; before the first one, the
    target is the inertial axes. A law `phase_plane` may have targets of its own.
    """

    line_of_sight: Sequence[LineOfSight]
    """Lines of sight of instruments on a body with three axes, which are recorded and assessed."""

    bound: Sequence[Bound]
    """Claims about outputs of the linear body, for `flexsc bound`."""

    reference: Reference
    """Reference values for the metrics."""

    requirement: Sequence[Requirement]
    """Requirements, each a limit on a pointing index or on a metric."""

    fault: Sequence[RunFault]
    """Faults, of which a run has the `active_fault`."""

    active_fault: str
    """Name of the fault that occurs, or `none`, the default."""

    uncertain: Mapping[str, DistributionKind]
    """Distributions of keys from which a campaign draws a value for each run."""

    correlated: Sequence[Correlated]
    """Correlated keys of `uncertain`."""


if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        from flexsc import _deprecated

        return _deprecated.of_module(__name__, name)
