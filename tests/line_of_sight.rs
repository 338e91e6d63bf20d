//! Lines of sight: their error, jitter and displacement against closed forms, on each body, and what is refused.

use flexsc_core::Scenario;
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::numerics::time::Span;
use flexsc_core::record::{Column, Detail, Trace};
use nalgebra::{Rotation3, Vector3};

use crate::traces::{column, flown, traced};
use crate::util::{Dir, SCENARIOS, table};

/// Body at rest with an undamped mode, seen by three lines of sight of its point `camera`, which the mode moves.
const VIBRATING: &str = "duration = 20.0
sensor = [\"continuous\"]
[body.spatial]
inertia = [[10, 0, 0], [0, 12, 0], [0, 0, 9]]
attitude_error = [3e-3, -2e-3, 1e-3]
points = [{ name = \"hub\" }, { name = \"camera\", position = [0.0, 0.0, 1.0] }]
[[body.spatial.modes]]
frequency = 1.7
displacement = 0.02
shapes.hub = {}
shapes.camera = { translation = [0.5, 0.0, -0.2], rotation = [0.3, 0.7, 0.0] }
[law.open]
[[line_of_sight]]
point = \"camera\"
period = 0.25
jitter_window = 1.0
[[line_of_sight]]
point = \"camera\"
axis = [2, 0, 0]
period = 0.25
window = [5.0, 10.0]
[[line_of_sight]]
point = \"hub\"
period = 0.3
[log]
period = 0.25
";

/// One sample: time, error angle, and for each axis the error, the rotation and the displacement.
type Sample = (f64, f64, [Vector3<f64>; 3]);

fn parsed(text: &str) -> Scenario {
    Scenario::parse("sight.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the samples of the line of sight with this index and period (s).
fn samples(trace: &Trace, line: u64, period: f64) -> Vec<Sample> {
    let rows = trace.topic("/line_of_sight").expect("lines of sight");
    let (Some(Column::Counts(lines)), Some(Column::Rows(_, axes))) = (rows.get("line"), rows.get("axes"))
    else {
        panic!("columns")
    };
    let field = |name: &str| axes.numbers(name).expect("numbers");
    let fields = ["error_rad", "rotation_rad", "displacement_m"].map(field);
    let angles = rows.numbers("error_rad").expect("angles");
    let at = |(sample, row): (usize, usize)| {
        let vectors = fields.map(|values| Vector3::from_column_slice(&values[3 * row..3 * row + 3]));
        (period * sample as f64, angles[row], vectors)
    };
    (0..lines.len()).filter(|row| lines[*row] == line).enumerate().map(at).collect()
}

fn numbers(metrics: &Metrics, name: &str) -> Vec<f64> {
    let Some(MetricValue::Numbers(values)) = metrics.get(name) else { panic!("no {name}") };
    values.clone()
}

/// Returns the error of a line of sight along `axis` of an instrument that is rotated from the target by one rotation
/// after another, each a rotation vector.
fn error(axis: Vector3<f64>, rotations: [Vector3<f64>; 2]) -> Vector3<f64> {
    let [first, second] = rotations.map(Rotation3::new);
    let seen = first * second * axis;
    let across = axis.cross(&seen);
    across.normalize() * across.norm().atan2(axis.dot(&seen))
}

#[test]
fn a_mode_moves_the_line_of_sight_of_its_point_as_in_closed_form() {
    let (metrics, trace) = flown(&parsed(VIBRATING), 0, Detail::Full);
    let deviation = Vector3::new(3e-3, -2e-3, 1e-3);
    for (line, axis) in [(0, Vector3::z()), (1, Vector3::x())] {
        let found = samples(&trace, line, 0.25);
        assert_eq!(found.len(), 81);
        for (t, angle, [sight, rotation, displacement]) in found {
            let q = 0.02 * (1.7 * t).cos();
            let bent = Vector3::new(0.3, 0.7, 0.0) * q;
            let exact = error(axis, [deviation, bent]);
            assert!((sight - exact).norm() < 1e-14, "{t} s: {sight} {exact}");
            assert!((angle - exact.norm()).abs() < 1e-14);
            assert!(
                (rotation - bent).norm() < 1e-15
                    && (displacement - Vector3::new(0.5, 0.0, -0.2) * q).norm() < 1e-15
            );
        }
    }
    // At instants of its own: no other part acts then.
    let hub = samples(&trace, 2, 0.3);
    assert_eq!(hub.len(), 67);
    for (_, _, [sight, rotation, displacement]) in hub {
        assert!((sight - error(Vector3::z(), [deviation, Vector3::zeros()])).norm() < 1e-14);
        assert_eq!((rotation, displacement), (Vector3::zeros(), Vector3::zeros()));
    }
    // The metrics by their definitions: four samples in each window of the jitter, and a part of the run of the second.
    let at = |k: usize| {
        error(Vector3::z(), [deviation, Vector3::new(0.3, 0.7, 0.0) * 0.02 * (1.7 * 0.25 * k as f64).cos()])
    };
    let mut jitter = 0.0;
    for window in 0..20 {
        let inside: Vec<Vector3<f64>> = (4 * window..4 * window + 4).map(at).collect();
        let mean = inside.iter().sum::<Vector3<f64>>() / 4.0;
        jitter += inside.iter().map(|error| (error - mean).norm_squared()).sum::<f64>();
    }
    let found = numbers(&metrics, "line_of_sight_jitter_rms_rad");
    assert!((found[0] / (jitter / 80.0).sqrt() - 1.0).abs() < 1e-10, "{found:?}");
    assert!(found[1].is_nan() && found[2].is_nan());
    let rms = ((0..81).map(|k| at(k).norm_squared()).sum::<f64>() / 81.0).sqrt();
    assert!((numbers(&metrics, "line_of_sight_rms_rad")[0] / rms - 1.0).abs() < 1e-12);
    let late = (20..=40).map(|k| {
        let bent = Vector3::new(0.3, 0.7, 0.0) * 0.02 * (1.7 * 0.25 * f64::from(k)).cos();
        error(Vector3::x(), [deviation, bent]).norm()
    });
    let peak = late.fold(0.0, f64::max);
    assert!((numbers(&metrics, "line_of_sight_peak_rad")[1] / peak - 1.0).abs() < 1e-12);
    let moved = numbers(&metrics, "point_displacement_peak_m");
    assert!((moved[0] - 0.02 * 0.29_f64.sqrt()).abs() < 1e-15 && moved[2] == 0.0, "{moved:?}");
}

#[test]
fn large_errors_and_opposite_directions_are_angles() {
    // Directions of any length.
    for axis in ["[0, 0, 1e300]", "[0, 0, 1e-200]"] {
        let text =
            VIBRATING.replacen("point = \"camera\"\n", &format!("point = \"camera\"\naxis = {axis}\n"), 1);
        let [long, unit] = [&text, VIBRATING].map(|text| samples(&traced(&parsed(text)), 0, 0.25)[5]);
        assert_eq!(long, unit, "{axis}");
    }
    for (turn, axis, exact) in [
        ("[2.5, 0, 0]", Vector3::<f64>::z(), Vector3::new(2.5, 0.0, 0.0)),
        ("[0, 0, 2.5]", Vector3::z(), Vector3::zeros()),
        ("[0, -1.2, 0]", Vector3::x(), Vector3::new(0.0, -1.2, 0.0)),
    ] {
        let axis = format!("[{}, {}, {}]", axis.x, axis.y, axis.z);
        let text = VIBRATING
            .replace("attitude_error = [3e-3, -2e-3, 1e-3]", &format!("attitude_error = {turn}"))
            .replace("displacement = 0.02", "displacement = 0.0")
            .replacen("point = \"camera\"\nperiod", &format!("point = \"camera\"\naxis = {axis}\nperiod"), 1);
        let (_, _, [found, ..]) = samples(&traced(&parsed(&text)), 0, 0.25)[0];
        assert!((found - exact).norm() < 1e-14, "{turn}: {found}");
    }
}

/// On a spacecraft whose modes act back, about a target that moves: the lines of sight of the hub have the components
/// of its attitude error, but for terms of second order.
#[test]
fn lines_of_sight_of_the_hub_are_its_attitude_error() {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/earth-observer.toml")).expect("a file");
    let point = parsed(&text).model.three_axis().expect("three axes").points[0].name.clone();
    let lines: String = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"]
        .map(|axis| format!("[[line_of_sight]]\npoint = \"{point}\"\naxis = {axis}\nperiod = 0.25\n"))
        .concat();
    let trace = traced(&parsed(&format!("{text}\n{lines}")));
    let pointing =
        ["roll_error_rad", "pitch_error_rad", "yaw_error_rad"].map(|name| column(&trace, "/pointing", name));
    let mut compared = 0;
    for line in 0..3 {
        // Both have rows each 0.25 s.
        let samples = samples(&trace, line, 0.25);
        assert_eq!(samples.len(), pointing[0].len());
        for (row, (t, _, [found, ..])) in samples.into_iter().enumerate() {
            let mut exact = Vector3::from_fn(|axis, _| pointing[axis][row]);
            let size = exact.norm();
            exact[line as usize] = 0.0;
            assert!((found - exact).norm() <= 2.0 * size * size + 1e-12, "{t} s: {found} {exact}");
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn recording_a_line_of_sight_does_not_change_the_motion() {
    let text = std::fs::read_to_string(format!("{SCENARIOS}/wheel-run-up.toml")).expect("a file");
    let begins = text.find("[[line_of_sight]]").expect("a line of sight");
    let ends = begins + text[begins..].find("[law").expect("a law");
    let short = |text: &str| parsed(&text.replace("duration = 240.0", "duration = 5.0"));
    let (metrics, trace) = flown(&short(&text), 0, Detail::Full);
    let alone = traced(&short(&(text[..begins].to_owned() + &text[ends..])));
    assert_eq!(column(&trace, "/pointing", "q_x"), column(&alone, "/pointing", "q_x"));
    assert!(numbers(&metrics, "line_of_sight_jitter_rms_rad")[0] > 0.0);
}

/// Every shipped body with three axes, with its law, sensors, estimator and actuators.
#[test]
fn every_body_with_three_axes_has_lines_of_sight() {
    let mut runs = 0;
    for entry in std::fs::read_dir(SCENARIOS).expect("scenarios") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a file");
        let origin = path.to_str().expect("a name");
        let scenario = Scenario::parse(origin, &text).unwrap_or_else(|error| panic!("{error}"));
        let Some(body) = scenario.model.three_axis() else { continue };
        let point = body.points.first().map_or("", |point| &point.name);
        let line = format!("\n[[line_of_sight]]\npoint = \"{point}\"\nperiod = 0.5\njitter_window = 1.0\n");
        let mut scenario = Scenario::parse(origin, &(text + &line)).unwrap_or_else(|error| panic!("{error}"));
        scenario.written.duration = Span::from_seconds(4.0);
        let (metrics, _) = flown(&scenario, 0, Detail::Events);
        let last = scenario.line_of_sight.len() - 1;
        for name in ["line_of_sight_rms_rad", "line_of_sight_peak_rad", "line_of_sight_jitter_rms_rad"] {
            let value = numbers(&metrics, name)[last];
            assert!(value.is_finite() && value <= std::f64::consts::PI, "{origin}: {name} = {value}");
        }
        runs += 1;
    }
    assert!(runs >= 20, "{runs}");
}

#[test]
fn a_line_of_sight_has_a_figure_a_panel_and_metrics_in_campaigns() {
    let dir = Dir::new();
    dir.write("sight.toml", VIBRATING);
    // The numbers from SciPy's rotations.
    let camera = "camera: 0.01133 rad rms, largest 0.01628 rad; jitter 0.004933 rad rms within";
    dir.run("simulate sight.toml --log full -o sight.mcap --units si").exits(0).says(&[camera, "hub: "]);
    dir.run("plot sight.mcap --what line-of-sight -o figures").exits(0);
    assert!(dir.size("figures/sight-line-of-sight.svg") > 5_000);
    dir.run("layout sight.mcap -o layout.json").exits(0);
    assert!(dir.text("layout.json").contains("/line_of_sight.axes[0].error_rad"));
    dir.run("simulate sight.toml --runs 2 -o runs.csv").exits(0);
    let rows = table(&dir, "runs.csv");
    assert!(
        rows.len() == 2 && rows[0].keys().any(|name| name.starts_with("line_of_sight_rms_rad")),
        "{rows:?}"
    );
}

#[test]
fn where_none_can_be_it_is_refused() {
    let lines = "[[line_of_sight]]\npoint = \"hub\"\nperiod = 0.1\n";
    let planar = format!("duration = 1.0\n[body.planar]\n[law.open]\n{lines}");
    let changed = |from: &str, to: &str| VIBRATING.replacen(from, to, 1);
    let driven = std::fs::read_to_string(format!("{SCENARIOS}/sun-tracking.toml")).expect("a file").replacen(
        "plate = \"y\"\n",
        "plate = \"y\"\npoints = [{ name = \"tip\", position = [0, 5, 0] }]\n",
        1,
    );
    let begins = driven.find("modes = [").expect("modes");
    let ends = begins + driven[begins..].find("\n]").expect("an end") + 2;
    let driven = driven[..begins].to_owned()
        + &driven[ends..]
        + "\n[[line_of_sight]]\npoint = \"tip\"\nperiod = 1.0\n";
    for (text, words) in [
        (planar, &["`line_of_sight` is for a body with three axes"][..]),
        (
            changed("point = \"camera\"", "point = \"nowhere\""),
            &["line_of_sight[0].point", "`hub`, `camera`"],
        ),
        (changed("axis = [2, 0, 0]", "axis = [0, 0, 0]"), &["line_of_sight[1].axis", "zero"]),
        (
            changed("window = [5.0, 10.0]", "window = [5.0, 5.0]"),
            &["line_of_sight[1].window", "in this order"],
        ),
        (
            changed("jitter_window = 1.0", "jitter_window = 0.4"),
            &["line_of_sight[0].jitter_window", "two samples"],
        ),
        (changed("period = 0.25", "period = 0"), &["line_of_sight[0].period"]),
        (driven, &["line_of_sight[0].point", "hub"]),
    ] {
        let error = Scenario::parse("sight.toml", &text).expect_err("refused").to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

/// The elements of its metrics, which are lists, have statistics and figures in a campaign, as numbers have.
#[cfg(feature = "parquet")]
#[test]
fn campaigns_have_statistics_of_each_line() {
    let dir = Dir::new();
    let uncertain = "[uncertain]\n\"body.spatial.attitude_error[0]\" = { uniform = [1e-3, 3e-3] }\n";
    dir.write("v.toml", format!("{VIBRATING}{uncertain}"));
    dir.run("simulate v.toml --runs 5 -o mc").exits(0);
    dir.run("plot mc -o f.svg --metric line_of_sight_peak_rad[2] --what distribution").exits(0);
    let statistics = table(&dir, "mc/statistics.csv");
    let row = statistics.iter().find(|row| row["metric"] == "line_of_sight_peak_rad[2]").expect("a row");
    let peak = |run: u64| {
        let text = dir.run(&format!("simulate --from mc --row {run} --json --log none")).printed();
        let object: serde_json::Value = serde_json::from_str(&text).expect("an object");
        object["metrics"]["line_of_sight_peak_rad"][2].as_f64().expect("a number")
    };
    let peaks: Vec<f64> = (0..5).map(peak).collect();
    let mean: f64 = row["mean"].parse().expect("a mean");
    assert!((mean / (peaks.iter().sum::<f64>() / 5.0) - 1.0).abs() < 1e-12, "{mean} {peaks:?}");
    assert!(peaks.iter().any(|peak| *peak != peaks[0]), "{peaks:?}");
    dir.run("plot mc -o g.svg --metric line_of_sight_peak_rad[x]")
        .exits(2)
        .says(&["no metric `line_of_sight_peak_rad[x]`"]);
}

#[test]
fn an_element_of_a_list_is_drawn_from_a_table() {
    let dir = Dir::new();
    let uncertain = "[uncertain]\n\"body.spatial.attitude_error[0]\" = { uniform = [1e-3, 3e-3] }\n";
    dir.write("v.toml", format!("{VIBRATING}{uncertain}"));
    dir.run("simulate v.toml --runs 5 --table csv -o mc").exits(0);
    dir.run("plot mc -o f.svg --metric line_of_sight_peak_rad[2] --what distribution").exits(0);
    assert!(dir.has("f.svg"));
    dir.run("plot mc -o g.svg --metric line_of_sight_peak_rad[9]")
        .exits(2)
        .says(&["no metric `line_of_sight_peak_rad[9]`"]);
}
