//! Accelerometers at points of a spacecraft: against an oracle of the whole kinematics, and against the displacement of
//! the point.

use flexsc_core::Scenario;
use flexsc_core::metrics::MetricValue;
use flexsc_core::record::{Column, Detail, Trace};

use crate::traces::{column, flown, traced};
use crate::util::SCENARIOS;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/accelerometer.csv");

const HUB_AND_MASS: &str = "duration = 13.0
sensor = [
    \"continuous\",
    { accelerometer = { watch_only = true, period = 0.5, point = \"bench\" } },
    { accelerometer = { watch_only = true, period = 0.5, point = \"slider\" } },
]
[spacecraft]
mass = 200.0
inertia = [[90.0, 4.0, -2.0], [4.0, 70.0, 1.0], [-2.0, 1.0, 60.0]]
rate = [0.0, 0.0, 0.1]
points = [{ name = \"hub\" }, { name = \"bench\", position = [0.5, 0.3, 0.2] }, { name = \"pushed\", position = [0.5, 0.0, 0.0] }]
[[appendage]]
name = \"mass\"
mass = 5.0
at = [0.0, 2.0, 0.0]
points = [{ name = \"slider\" }]
modes = [{ frequency = 1.3, damping = 0.02, along = [0.0, 0.0, 1.0], shapes.slider.translation = [0.0, 0.0, 0.4472135954999579] }]
[law.open]
[[disturbance]]
force = [0.3, 0.0, 1.0]
point = \"pushed\"
from = 1.0
to = 2.0
[log]
period = 0.5
";

fn run(text: &str) -> Trace {
    traced(&Scenario::parse("accelerometers.toml", text).unwrap_or_else(|error| panic!("{error}")))
}

/// Returns the samples of the accelerometer with this index among the sensors.
fn measured(trace: &Trace, sensor: u64) -> Vec<Vec<f64>> {
    let rows = trace.topic("/accelerations").expect("accelerations");
    let (Some(Column::Counts(sensors)), Some(Column::Rows(counts, axes))) =
        (rows.get("sensor"), rows.get("axes"))
    else {
        panic!("columns")
    };
    let values = axes.numbers("measured_m_s2").expect("numbers");
    let (mut found, mut from) = (Vec::new(), 0);
    for (of, count) in sensors.iter().zip(counts) {
        let to = from + *count as usize;
        if *of == sensor {
            found.push(values[from..to].to_vec());
        }
        from = to;
    }
    found
}

/// A hub that spins, and a mass that slides in it: specific forces of 1e-3 to 2e-2 m/s². The model leaves out what is
/// of second order in the slider's millimetres: 5e-7 m/s² after 12 s.
#[test]
fn a_pushed_hub_with_a_slider_accelerates_as_by_newton() {
    let trace = run(HUB_AND_MASS);
    let (bench, slider) = (measured(&trace, 1), measured(&trace, 2));
    assert_eq!(bench.len(), 27);
    let mut rows = csv::Reader::from_path(GOLDEN).expect("golden");
    for row in rows.deserialize::<Vec<f64>>() {
        let row = row.expect("numbers");
        let sample = (2.0 * row[0]) as usize;
        for axis in 0..3 {
            for (found, exact) in
                [(bench[sample][axis], row[1 + axis]), (slider[sample][axis], row[4 + axis])]
            {
                assert!((found - exact).abs() < 1e-6, "{} s, axis {axis}: {found} {exact}", row[0]);
            }
        }
    }
}

/// The second derivative of the first point's position, by differences: with rotation, Coriolis and all modes.
#[test]
fn readings_are_the_acceleration_of_the_place() {
    let text = HUB_AND_MASS
        .replace("rate = [0.0, 0.0, 0.1]", "rate = [0.02, -0.03, 0.04]")
        .replace(
            "points = [{ name = \"hub\" }, {",
            "points = [{ name = \"hub\", position = [0.4, -0.2, 0.3] }, {",
        )
        .replace("point = \"bench\"", "point = \"hub\"")
        .replace("period = 0.5", "period = 0.03125");
    let trace = run(&text);
    let (felt, h) = (measured(&trace, 1), 0.03125);
    let of = |topic: &str, name: &str| column(&trace, topic, name);
    let place = ["x_m", "y_m", "z_m"].map(|name| of("/position", name));
    let q = ["q_w", "q_x", "q_y", "q_z"].map(|name| of("/pointing", name));
    // The force begins and ends at 1 and 2 s: no difference extends across these instants.
    for row in [10, 26, 40, 58, 80, 200, 400] {
        let second = |x: &[f64]| {
            let [a, b, c] = [1, 2, 3].map(|k| x[row - k] + x[row + k]);
            (1.5 * a - 0.15 * b + c / 90.0 - 49.0 / 18.0 * x[row]) / (h * h)
        };
        let inertial = [0, 1, 2].map(|axis| second(place[axis]));
        let [w, x, y, z] = [0, 1, 2, 3].map(|part| q[part][row]);
        let matrix = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ];
        for axis in 0..3 {
            let exact: f64 = matrix[axis].iter().zip(inertial).map(|(m, v)| m * v).sum();
            assert!((felt[row][axis] - exact).abs() < 2e-9, "{row} {axis}: {} {exact}", felt[row][axis]);
        }
    }
}

/// The accelerometer on the bench measures the imbalance of the run-up, most where it passes the mode.
#[test]
fn a_run_up_is_measured_on_the_bench() {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/wheel-run-up.toml")).expect("a file");
    let text = text.replace("duration = 240.0", "duration = 142.0");
    let scenario = Scenario::parse("wheel-run-up.toml", &text).expect("a scenario");
    let (metrics, trace) = flown(&scenario, 0, Detail::Full);
    let sensed = measured(&trace, 1);
    let size = |row: &Vec<f64>| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    let within = |from: f64, to: f64| {
        let rows = sensed.iter().enumerate().filter(|(row, _)| (from..to).contains(&(*row as f64 * 0.01)));
        rows.map(|(_, row)| size(row)).fold(0.0, f64::max)
    };
    // The imbalance is at 93 rad/s after 135 s, and at 80 rad/s after 89 s.
    assert!(
        within(130.0, 142.0) > 2.0 * within(85.0, 92.0),
        "{} {}",
        within(130.0, 142.0),
        within(85.0, 92.0)
    );
    let squares: f64 = sensed.iter().map(|row| size(row) * size(row)).sum();
    let rms = (squares / sensed.len() as f64).sqrt();
    let Some(MetricValue::Numbers(told)) = metrics.get("acceleration_rms_m_s2") else { panic!("a metric") };
    assert!((told[0] / rms - 1.0).abs() < 1e-12, "{told:?} {rms}");
    // Recording does not change the motion.
    let alone = text.replace(
        &text[text.find("sensor = [").expect("sensors")..text.find("[spacecraft]").expect("a body")],
        "",
    );
    let trace_alone = run(&alone);
    let rates = |trace: &Trace| column(trace, "/pointing", "q_x").to_vec();
    assert_eq!(rates(&trace), rates(&trace_alone));
}

#[test]
fn where_none_can_be_it_is_refused() {
    let refused = |text: &str| Scenario::parse("a.toml", text).expect_err("it does not fit").to_string();
    let planar = "duration = 1.0\nsensor = [\"continuous\", { accelerometer = { watch_only = true, period = 0.1 } }]\n\
                  [body.planar]\n[law.open]\n";
    let found = refused(planar);
    assert!(found.contains("`sensor[1].accelerometer` measures at a point of a `[spacecraft]`"), "{found}");
    let found =
        refused(&HUB_AND_MASS.replace("watch_only = true, period = 0.5, point = \"bench\"", "period = 0.5"));
    assert!(found.contains("accelerometer.watch_only` must be true"), "{found}");
    let found = refused(&HUB_AND_MASS.replace("    \"continuous\",\n", ""));
    assert!(found.contains("is not used by the law: list a sensor of the body beside it"), "{found}");
    let found = refused(&HUB_AND_MASS.replace("point = \"slider\"", "point = \"nowhere\""));
    assert!(found.contains("must be one of the body's points"), "{found}");
}
