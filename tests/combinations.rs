//! Combinations of parts: every combination of law, sensor, estimator and actuator is tried, on one axis and on three.
//!
//! What is accepted runs for 50 s, and what is refused names a key and a reason. The tables in docs/combinations.md are made here.

use std::fmt::Write as _;

use flexsc_core::record::{Detail, Trace};
use flexsc_core::{Scenario, ScenarioError, Simulation};

/// Kind of a part: its name, its letter in the table, and its text.
type Kind = (&'static str, &'static str, &'static str);

const LAWS: [Kind; 10] = [
    ("relay", "", "relay = { dead_zone = 5e-4, hysteresis = 1e-4, strong = 4e-3, weak = 1e-4, k_t = 0.3 }"),
    ("pd", "", "pd = { k_p = 0.4, k_d = 6.0, period = 0.2 }"),
    ("pd with an extra loop", "", "pd = { k_p = 0.4, k_d = 6.0, period = 0.2, extra = { gain = 0.1 } }"),
    ("attitude", "", "attitude = { period = 0.2, bandwidth = 0.06 }"),
    (
        "state_space",
        "",
        "state_space = { period = 0.2, a = [[0.5]], b = [[-3.0, 0.0]], c = [[1.0]], d = [[0.4, 6.0]] }",
    ),
    ("open", "", "open = {}"),
    (
        "phase_plane",
        "",
        "phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5 }",
    ),
    (
        "phase_plane with damping",
        "",
        "phase_plane = { period = 0.2, dead_zone = 5e-4, rate_limit = 1e-3, switch_on = 1e-4, switch_off = 3e-5, damping = {} }",
    ),
    ("b_dot", "", "b_dot = { period = 1.0, gain = 1e5 }"),
    (
        "stages",
        "",
        "stages = [{ law = { open = {} } }, { from = 10.0, law = { attitude = { period = 0.2, bandwidth = 0.06 } } }]",
    ),
];

const SENSORS: [Kind; 6] = [
    ("continuous", "c", "sensor = \"continuous\""),
    ("sampled", "s", "sensor = { sampled = { period = 0.2, noise = 1e-6 } }"),
    ("gyro", "g", "sensor = { gyro = { period = 0.2, noise = 1e-6 } }"),
    ("star_tracker", "t", "sensor = { star_tracker = { period = 0.2, noise = [1e-6, 1e-6, 1e-6] } }"),
    (
        "gyro and star_tracker",
        "b",
        "sensor = [{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }, { star_tracker = { period = 1.0, noise = [1e-6, 1e-6, 1e-6], latency = 0.3, exposure = 0.1 } }]",
    ),
    (
        "gyro, magnetometer and sun_sensor",
        "m",
        "sensor = [{ gyro = { period = 0.2, angle_random_walk = 1e-6 } }, { magnetometer = { period = 1.0, noise = 1e-8 } }, { sun_sensor = { period = 1.0, noise = 1e-3 } }]",
    ),
];

const ESTIMATORS: [Kind; 10] = [
    ("none", "", ""),
    ("envelope", "", "envelope = { window = 10.0 }"),
    ("truth", "", "truth = {}"),
    ("kalman", "", "kalman = { angle_noise = 1e-6 }"),
    ("extended_kalman", "", "extended_kalman = { angle_noise = 1e-6 }"),
    ("unscented_kalman", "", "unscented_kalman = { angle_noise = 1e-6 }"),
    ("attitude", "", "attitude = {}"),
    ("attitude with modes", "", "attitude = { elastic = { modes = [0], noise = 1e-6 } }"),
    ("rigid_rate", "", "rigid_rate = { correction = 0.05 }"),
    ("adaptive", "", "adaptive = {}"),
];

const ACTUATORS: [Kind; 14] = [
    ("ideal", "", "\"ideal\""),
    ("hold", "", "{ hold = { period = 0.2 } }"),
    ("thrusters", "", "{ thrusters = { torque = 0.05, period = 0.2 } }"),
    ("wheel", "", "{ wheel = { gain = 1.0, limit = 0.05 } }"),
    ("wheels", "", "{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05 } }"),
    (
        "control_moment_gyros",
        "",
        "{ control_moment_gyros = { arrangement = \"pyramid\", momentum = 1.0, rate_limit = 1.0, period = 0.2 } }",
    ),
    ("magnetorquers", "", "{ magnetorquers = { moment = 10.0 } }"),
    (
        "jets",
        "",
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
        "",
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
        "",
        "[{ ideal = {}, share = 0.4 }, { wheel = { gain = 1.0, limit = 0.05 }, share = 0.6 }]",
    ),
    (
        "wheel and thrusters, by shares",
        "",
        "[{ wheel = { gain = 1.0, limit = 0.05 }, share = 0.7 }, { thrusters = { torque = 0.05, period = 0.2 }, share = 0.3 }]",
    ),
    (
        "wheels and jets, by axes",
        "",
        "[{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05 }, axes = [\"roll\", \"pitch\"] },
{ jets = { period = 0.2, specific_impulse = 270.0, thrusters = [
    { name = \"e\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], thrust = 0.05 },
    { name = \"f\", point = \"hub\", offset = [1.0, 0.0, 0.0], direction = [0.0, -1.0, 0.0], thrust = 0.05 },
], groups = { yaw = { plus = [\"e\"], minus = [\"f\"] } } }, axes = [\"yaw\"] }]",
    ),
    (
        "wheels, jets unload",
        "",
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
        "",
        "[{ wheels = { arrangement = \"pyramid\", inertia = 0.01, torque = 0.05, speeds = [9.0, 5.0, 5.0, 5.0] } },
{ magnetorquers = { moment = 10.0 }, unloads = { above = 0.1, below = 0.01, gain = 1e-3, period = 1.0 } }]",
    ),
];

const ONE_ANGLE: &str = "[body.planar]
inertia = 100.0
angle = 1e-3
modes = [
    { frequency = 1.0, gain = 0.3, damping = 0.01, displacement = 1e-5 },
    { frequency = 2.5, gain = 0.1, damping = 0.01 },
]
";

const THREE_AXES: &str = "[body.spatial]
inertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]
rate = [1e-5, -2e-5, 1e-5]
points = [{ name = \"hub\" }]
modes = [
    { frequency = 1.0, damping = 0.01, displacement = 1e-4, shapes.hub = { rotation = [0.05, 0.02, 0.01] } },
    { frequency = 2.5, damping = 0.01, shapes.hub = { rotation = [0.01, 0.04, -0.03] } },
]
";

/// Environment of a three-axis body without disturbing torques.
const AROUND: &str = "[environment]
orbit = { semi_major_axis = 7e6, inclination = 1.0 }
magnetic_field = {}
sun = [1, 2, 3]
";

const SPACECRAFT: &str = "[spacecraft]
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

const HINGED: &str = "[[appendage]]
name = \"boom\"
mass = 5.0
centre = [1.0, 0.0, 0.0]
inertia = [[0.1, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]
at = [0.5, 0.0, 0.0]
hinge = { about = [0, 1, 0], stiffness = 15.0, damping = 0.3, angle = 2e-3 }
";

/// Returns a combination as a scenario.
fn combined(
    body: &str,
    law: Kind,
    sensor: Kind,
    estimator: Kind,
    actuator: Kind,
) -> Result<Scenario, ScenarioError> {
    let estimator = match (estimator.0, law.0) {
        ("none", _) => String::new(),
        // A filter that an open loop does not read is there to be assessed.
        ("attitude", "open") => "estimator = { attitude = { watch_only = true } }\n".to_owned(),
        ("attitude with modes", "open") => {
            format!("estimator = {{ {} }}\n", estimator.2.replacen("{ ", "{ watch_only = true, ", 1))
        }
        (kind, "open") if kind.contains("kalman") => {
            format!("estimator = {{ {} }}\n", estimator.2.replace(" }", ", watch_only = true }"))
        }
        _ => format!("estimator = {{ {} }}\n", estimator.2),
    };
    let around = if body == ONE_ANGLE { "" } else { AROUND };
    let text = format!(
        "duration = 50.0\nseed = 3\nlaw = {{ {} }}\n{}\nactuator = {}\n{estimator}{body}{around}",
        law.2, sensor.2, actuator.2
    );
    Scenario::parse("combination.toml", &text)
}

/// The tables of what is accepted on a body, one of each law, and how many combinations that are; each is run.
fn tables(body: &str) -> (String, usize) {
    let mut accepted = 0;
    let mut tables = String::new();
    for law in LAWS {
        let mut rows = String::new();
        for actuator in ACTUATORS {
            let mut row = format!("| {} |", actuator.0);
            let before = accepted;
            for estimator in ESTIMATORS {
                row.push(' ');
                for sensor in SENSORS {
                    match combined(body, law, sensor, estimator, actuator) {
                        Ok(scenario) => {
                            let name = [law.0, sensor.0, estimator.0, actuator.0].join(", ");
                            run(&scenario, &name);
                            accepted += 1;
                            row += sensor.1;
                        }
                        Err(error) => {
                            let text = error.to_string();
                            assert!(text.contains('`') && text.len() > 40, "no reason: {text}");
                        }
                    }
                }
                row += if row.ends_with(' ') { "|" } else { " |" };
            }
            // An actuator that goes with nothing has no row.
            if accepted > before {
                rows += &row;
                rows.push('\n');
            }
        }
        if rows.is_empty() {
            writeln!(tables, "### {}\n\nNot on this body.\n", law.0).expect("a text");
            continue;
        }
        let head = ESTIMATORS.map(|kind| format!(" {} |", kind.0)).concat();
        let rule = "---|".repeat(ESTIMATORS.len());
        writeln!(tables, "### {}\n\n| actuator |{head}\n|---|{rule}\n{rows}", law.0).expect("a text");
    }
    tables.truncate(tables.trim_end().len());
    tables.push('\n');
    (tables, accepted)
}

/// Runs a combination to its end, with all that a full log holds.
fn run(scenario: &Scenario, name: &str) {
    let mut trace = Trace::new(Detail::Full);
    let mut simulation = Simulation::new(scenario, 0);
    simulation.run(&mut trace).unwrap_or_else(|error| panic!("{name}: {error}"));
}

#[test]
fn parts_combine_as_the_documents_say() {
    let all = LAWS.len() * SENSORS.len() * ESTIMATORS.len() * ACTUATORS.len();
    let turning =
        SPACECRAFT.replace("plate =", "drive = { about = [0, 1, 0], rate = 0.02 }\nplate =") + HINGED;
    let bodies = [
        ("One angle", ONE_ANGLE, 912),
        ("Three axes", THREE_AXES, 3518),
        ("A spacecraft from parts", SPACECRAFT, 3747),
        ("A spacecraft with panels that turn, on a drive and on a hinge", &turning, 3416),
    ];
    let all_tables: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = bodies.iter().map(|(_, body, _)| scope.spawn(|| tables(body))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a table")).collect()
    });
    let mut made = Vec::new();
    for ((name, _, least), (tables, accepted)) in bodies.iter().zip(all_tables) {
        assert!(accepted >= *least, "{name}: {accepted}");
        made.push(format!("## {name}\n\n{accepted} of {all} combinations.\n\n{tables}"));
    }
    let made = made.join("\n");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/combinations.md");
    let kept = std::fs::read_to_string(path).expect("the document");
    let made_file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("combinations.md");
    std::fs::write(&made_file, &made).expect("a file");
    assert!(kept.ends_with(&made), "docs/combinations.md is not what {} holds", made_file.display());
}
