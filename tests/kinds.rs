//! Kinds of parts, and bodies, of which `tests/combinations.rs` makes every combination.

/// Kind of a part: its name, its name in the tables of combinations, and its text.
pub type Kind = (&'static str, &'static str, &'static str);

pub const LAWS: [Kind; 11] = [
    (
        "relay",
        "`relay`",
        "relay = { dead_zone = 5e-4, hysteresis = 1e-4, strong = 4e-3, weak = 1e-4, k_t = 0.3 }",
    ),
    ("pd", "`pd`", "pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }"),
    (
        "pd with an extra loop",
        "`pd` with an extra loop",
        "pd = { k_p = 0.4, k_d = 6.0, period = 0.2, extra = { gain = 0.1 } }",
    ),
    ("attitude", "`attitude`", "attitude = { period = 0.2, bandwidth = 0.06 }"),
    (
        "state_space",
        "`state_space`",
        "state_space = { period = 0.2, a = [[0.5]], b = [[-3.0, 0.0]], c = [[1.0]], d = [[0.4, 6.0]] }",
    ),
    (
        "state_space about three axes",
        "`state_space` about three axes",
        "state_space = { period = 0.2, inputs = [\"roll\", \"pitch\", \"yaw\", \"roll_rate\", \"pitch_rate\", \"yaw_rate\"], a = [[0.5]], b = [[-3.0, 0.1, 0.0, 0.0, 0.2, 0.0]], c = [[1.0], [0.1], [0.0]], d = [[0.4, 0.01, 0.0, 6.0, 0.1, 0.0], [0.0, 0.4, 0.02, 0.0, 6.0, 0.2], [0.01, 0.0, 0.4, 0.1, 0.0, 6.0]] }",
    ),
    ("open", "`open`", "open = {}"),
    (
        "phase_plane",
        "`phase_plane`",
        "phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5 }",
    ),
    (
        "phase_plane with damping",
        "`phase_plane` with damping",
        "phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5, damping = {} }",
    ),
    ("b_dot", "`b_dot`", "b_dot = { period = 1.0, gain = 1e5 }"),
    (
        "stages",
        "`stages`",
        "stages = [{ law = { open = {} } }, { from = 3.0, law = { attitude = { period = 0.2, bandwidth = 0.06 } } }]",
    ),
];

pub const SENSORS: [Kind; 7] = [
    ("continuous", "continuous", "sensor = \"continuous\""),
    ("sampled", "sampled", "sensor = { sampled = { period = 0.2, noise = 1e-6 } }"),
    ("gyro", "gyro", "sensor = { gyro = { period = 0.2, noise = 1e-6 } }"),
    (
        "star_tracker",
        "star tracker",
        "sensor = { star_tracker = { period = 0.2, noise = [1e-6, 1e-6, 1e-6] } }",
    ),
    (
        "gyro and star_tracker",
        "gyro with star tracker",
        "sensor = [{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }, { star_tracker = { period = 1.0, noise = [1e-6, 1e-6, 1e-6], latency = 0.3, exposure = 0.1 } }]",
    ),
    (
        "gyro, magnetometer and sun_sensor",
        "gyro with magnetometer and Sun sensor",
        "sensor = [{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }, { magnetometer = { period = 1.0, noise = 1e-8 } }, { sun_sensor = { period = 1.0, noise = 1e-3 } }]",
    ),
    (
        "gyro, earth_sensor and sun_cells",
        "gyro with Earth sensor and Sun cells",
        "sensor = [{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }, { earth_sensor = { period = 1.0, noise = 1e-3 } }, { sun_cells = { period = 1.0, noise = 1e-2, cells = [{ normal = [1, 0, 0] }, { normal = [-1, 0, 0] }, { normal = [0, 1, 0] }, { normal = [0, -1, 0] }, { normal = [0, 0, 1] }, { normal = [0, 0, -1] }] } }]",
    ),
];

pub const ESTIMATORS: [Kind; 10] = [
    ("none", "no estimator", ""),
    ("envelope", "`envelope`", "envelope = { window = 3.0 }"),
    ("truth", "`truth`", "truth = {}"),
    ("kalman", "`kalman`", "kalman = { angle_noise = 1e-6 }"),
    ("extended_kalman", "`extended_kalman`", "extended_kalman = { angle_noise = 1e-6 }"),
    ("unscented_kalman", "`unscented_kalman`", "unscented_kalman = { angle_noise = 1e-6 }"),
    ("attitude", "`attitude`", "attitude = {}"),
    (
        "attitude with modes",
        "`attitude` with modes",
        "attitude = { elastic = { modes = [0], noise = 1e-6 } }",
    ),
    ("rigid_rate", "`rigid_rate`", "rigid_rate = { correction = 0.05 }"),
    ("adaptive", "`adaptive`", "adaptive = {}"),
];

pub const ACTUATORS: [Kind; 14] = [
    ("ideal", "ideal", "\"ideal\""),
    ("hold", "hold", "{ hold = { period = 0.2 } }"),
    ("thrusters", "thrusters", "{ thrusters = { torque = 0.05, period = 0.2 } }"),
    ("wheel", "wheel", "{ wheel = { gain = 1.0, limit = 0.05 } }"),
    ("wheels", "wheels", "{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05 } }"),
    (
        "control_moment_gyros",
        "control moment gyros",
        "{ control_moment_gyros = { arrangement = \"pyramid\", momentum = 1.0, rate_limit = 1.0, period = 0.2 } }",
    ),
    ("magnetorquers", "magnetorquers", "{ magnetorquers = { moment = 10.0 } }"),
    (
        "jets",
        "jets",
        "{ jets = { period = 0.2, specific_impulse = 270.0, thrusters = [
    { name = \"a\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, 1.0], thrust = 0.05 },
    { name = \"b\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, -1.0], thrust = 0.05 },
    { name = \"c\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"d\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [-1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.05 },
    { name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.05 },
], groups = { roll = { plus = [\"a\"], minus = [\"b\"] }, pitch = { plus = [\"c\"], minus = [\"d\"] }, yaw = { plus = [\"e\"], minus = [\"f\"] } } } }",
    ),
    (
        "jets by least_propellant",
        "jets by least propellant",
        "{ jets = { period = 0.2, specific_impulse = 270.0, allocation = \"least_propellant\", thrusters = [
    { name = \"a\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, 1.0], thrust = 0.05 },
    { name = \"b\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, -1.0], thrust = 0.05 },
    { name = \"c\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"d\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [-1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.05 },
    { name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.05 },
] } }",
    ),
    (
        "ideal and wheel, by shares",
        "ideal and wheel by shares",
        "[{ ideal = {}, share = 0.4 }, { wheel = { gain = 1.0, limit = 0.05 }, share = 0.6 }]",
    ),
    (
        "wheel and thrusters, by shares",
        "wheel and thrusters by shares",
        "[{ wheel = { gain = 1.0, limit = 0.05 }, share = 0.7 }, { thrusters = { torque = 0.05, period = 0.2 }, share = 0.3 }]",
    ),
    (
        "wheels and jets, by axes",
        "wheels and jets by axes",
        "[{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05 }, axes = [\"roll\", \"pitch\"] },
{ jets = { period = 0.2, specific_impulse = 270.0, thrusters = [
    { name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.05 },
    { name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.05 },
], groups = { yaw = { plus = [\"e\"], minus = [\"f\"] } } }, axes = [\"yaw\"] }]",
    ),
    (
        "wheels, jets unload",
        "wheels unloaded by jets",
        "[{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05, speeds = [9.0, 5.0, 5.0, 5.0] } },
{ jets = { period = 1.0, specific_impulse = 270.0, allocation = \"least_propellant\", thrusters = [
    { name = \"a\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, 1.0], thrust = 0.05 },
    { name = \"b\", point = \"hub\", offset = [0.0, 1.0, 0.0], direction = [0.0, 0.0, -1.0], thrust = 0.05 },
    { name = \"c\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"d\", point = \"hub\", offset = [0.0, 0.0, 1.0], direction = [-1.0, 0.0, 0.0], thrust = 0.05 },
    { name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.05 },
    { name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.05 },
] }, unloads = { above = 0.1, below = 0.01, torque = 0.02 } }]",
    ),
    (
        "wheels, magnetorquers unload",
        "wheels unloaded by magnetorquers",
        "[{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05, speeds = [9.0, 5.0, 5.0, 5.0] } },
{ magnetorquers = { moment = 10.0 }, unloads = { above = 0.1, below = 0.01, gain = 1e-3, period = 1.0 } }]",
    ),
];

pub const ONE_ANGLE: &str = "[body.planar]
inertia = 100.0
angle = 1e-3
modes = [
    { frequency = 1.0, gain = 0.3, damping = 0.01, displacement = 1e-5 },
    { frequency = 2.5, gain = 0.1, damping = 0.01 },
]
";

pub const THREE_AXES: &str = "[body.spatial]
inertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]
rate = [1e-5, -2e-5, 1e-5]
points = [{ name = \"hub\" }]
modes = [
    { frequency = 1.0, damping = 0.01, displacement = 1e-4, shapes.hub = { rotation = [0.05, 0.02, 0.01] } },
    { frequency = 2.5, damping = 0.01, shapes.hub = { rotation = [0.01, 0.04, -0.03] } },
]
";

/// Environment of a three-axis body without disturbing torques.
pub const AROUND: &str = "[environment]
orbit = { semi_major_axis = 7e6, inclination = 1.0 }
magnetic_field = {}
sun = [1, 2, 3]
";

pub const SPACECRAFT: &str = "[spacecraft]
mass = 200.0
inertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]
rate = [1e-5, -2e-5, 1e-5]
points = [{ name = \"hub\" }]
[[appendage]]
name = \"panel\"
mass = 10.0
centre = [0.0, 1.5, 0.0]
inertia = [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 10.0]]
at = [0.0, 0.5, 0.0]
plate = \"y\"
modes = [
    { frequency = 1.0, damping = 0.01, translation = [0.0, 0.0, 2.0], rotation = [4.0, 0.0, 0.0], displacement = 1e-4 },
    { frequency = 2.5, damping = 0.01, rotation = [0.0, 0.8, 0.0] },
]
";

pub const HINGED: &str = "[[appendage]]
name = \"boom\"
mass = 5.0
centre = [1.0, 0.0, 0.0]
inertia = [[0.1, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]
at = [0.5, 0.0, 0.0]
hinge = { about = [0, 1, 0], stiffness = 15.0, damping = 0.3, angle = 2e-3 }
";

/// Offset and direction of each of the jets.
pub const JETS: [([f64; 3], [f64; 3]); 6] = [
    ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
    ([0.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
    ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
    ([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]),
    ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ([1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
];
/// Thrust of each (N).
pub const THRUST: f64 = 0.05;
