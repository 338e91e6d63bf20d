//! The loop of a three-axis body: gyro, estimator, phase-plane law and jets, and the command's output.
//!
//! Golden numbers: tests/golden/station_oracle.py, a loop of its own by Runge-Kutta steps.

use flexsc_core::dynamics::flow::ElasticModes;
use flexsc_core::metrics::MetricsCollector;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Column, Columns, Detail, Trace};
use flexsc_core::{Scenario, Simulation};

use crate::spatial::{body, free};
use crate::study::{close, metrics, scenario};
use crate::traces::{column, traced, within};
use crate::util::{Dir, SCENARIOS, table};

/// Returns a column of the rows about one axis.
fn about(columns: &Columns, axis: usize, name: &str) -> Vec<f64> {
    let Some(Column::Rows(_, rows)) = columns.get("axes") else { panic!("axes") };
    rows.numbers(name).expect("a column").iter().skip(axis).step_by(3).copied().collect()
}

/// Returns the last value of a column.
fn last(trace: &Trace, topic: &str, name: &str) -> f64 {
    *column(trace, topic, name).last().expect("a row")
}

/// The slow modes, which hardly turn the gyro, keep their energy; the visible energy is that of the other modes.
#[test]
fn the_energy_at_the_gyro_is_reported_apart() {
    let study = scenario("iss-manoeuvre", &[("duration", "120"), ("log.period", "10")]);
    let full = traced(&study);
    let shapes =
        study.model.three_axis().map(|body| body.shapes(&study.study.sensor_points[0])).expect("three axes");
    let energies = within(&full, "/vibrations", "modes", "energy_j");
    // Modes 1 to 3, of 0.0978, 0.1063 and 0.2368 Hz, turn it by less than a tenth of what mode 5 does.
    let most = shapes.iter().map(|(_, rotation)| rotation.norm()).fold(0.0, f64::max);
    assert!(shapes.iter().zip(1..).all(|((_, shape), mode)| (shape.norm() < 0.1 * most) == (mode < 4)));
    let (all, seen) = (column(&full, "/energy", "elastic_j"), column(&full, "/energy", "visible_j"));
    for (row, modes) in energies.chunks(12).enumerate() {
        assert!((seen[row] - modes[3..].iter().sum::<f64>()).abs() <= 1e-12 * all[row]);
    }
    let metrics = metrics(study);
    assert_eq!(metrics.number("visible_energy_end_j"), seen.last().copied());
    assert!(metrics.number("visible_energy_peak_j") < metrics.number("elastic_energy_peak_j"));
}

/// The whole loop against one that was written apart: jets of 0.05 to 0.2 s, a cycle late, without noise.
#[test]
fn the_manoeuvre_is_that_of_another_program() {
    let quiet =
        [("sensor.gyro.noise", "[0, 0, 0]"), ("sensor.gyro.resolution", "[0, 0, 0]"), ("log.period", "700")];
    let study = scenario("iss-manoeuvre-off", &quiet);
    let metrics = metrics(study.clone());
    assert_eq!(metrics.number("firings"), Some(409.0));
    close(metrics.number("fuel_kg").expect("fuel"), 5.610_856_276_476_058, 1e-13);
    close(metrics.number("elastic_energy_peak_j").expect("energy"), 0.696_646_184_768_756_2, 1e-9);
    close(metrics.number("elastic_energy_end_j").expect("energy"), 1.898_426_293_957_833_7e-3, 1e-9);
    let trace = traced(&study);
    let q = [
        0.999_517_261_919_449,
        0.006_366_740_164_194_914,
        0.011_224_163_961_570_485,
        0.028_261_738_943_192_397,
    ];
    for (name, exact) in ["q_w", "q_x", "q_y", "q_z"].into_iter().zip(q) {
        let found = last(&trace, "/pointing", name);
        assert!((found - exact).abs() < 1e-13, "{name}: {found} {exact}");
    }
    let rates = trace.topic("/rates").expect("rates");
    for (axis, exact) in [-2.632_035_311_342_014_4e-7, 2.359_694_684_447_450_7e-7, -6.719_823_720_972_929e-7]
        .into_iter()
        .enumerate()
    {
        assert!((about(rates, axis, "rigid_rad_s")[1] - exact).abs() < 1e-16);
    }
    // The first pulses come a cycle after the law has seen the new target.
    let jets = |name: &str| column(&trace, "/jets", name)[0];
    assert_eq!([jets("roll_on_s"), jets("pitch_on_s"), jets("yaw_on_s")], [0.2, 0.2, 0.2]);
    let mut pulses = Trace::new(Detail::Events);
    Simulation::new(&study, 0).run(&mut pulses).expect("a run");
    let times = pulses.into_columns().find(|(topic, _)| *topic == "jets").expect("jets").1;
    let times = times.numbers("time_s").expect("times").to_vec();
    assert_eq!((times[0], times[1], *times.last().expect("a pulse")), (10.2, 10.4, 389.2));
}

/// Two modes, 5.956 and 0.518 J, decay as exp(-2 zeta w t) each, and swing a little about that.
#[test]
fn the_station_rings_down_by_its_structure_alone() {
    let metrics = metrics(scenario("iss-ringdown-off", &[]));
    let number = |name: &str| metrics.number(name).expect("a number");
    close(number("elastic_energy_peak_j"), 6.474, 1e-3);
    close(number("energy_below_10pct_at_s"), 143.0, 0.01);
    close(number("energy_below_1pct_at_s"), 291.0, 0.01);
    assert_eq!(number("fuel_kg"), 0.0);
}

#[test]
fn the_manoeuvre_uses_the_propellant_that_it_should() {
    let metrics = metrics(scenario("iss-manoeuvre-off", &[]));
    let number = |name: &str| metrics.number(name).expect("a number");
    // Two digits are known.
    close(number("fuel_kg"), 5.6, 0.009);
    // It hangs on when the burns of yaw begin and end: 0.88 to 0.97 J with an observer of the modes.
    assert!((0.5..1.2).contains(&number("elastic_energy_peak_j")));
    assert!((5e-6..9e-6).contains(&number("elastic_rate_rms_rad_s")));
}

/// Recording a run does not change it, not even between the ends of its pulses.
#[test]
fn dense_records_change_nothing() {
    let study = scenario("iss-manoeuvre-off", &[("log.period", "0.073"), ("duration", "60")]);
    let mut dense = (Trace::new(Detail::Full), MetricsCollector::new(&study));
    Simulation::new(&study, 0).run(&mut dense).expect("a run");
    assert_eq!(dense.1.finish(&study).to_json(), metrics(study.clone()).to_json());
    // Stops on the way do not change it either.
    let mut stopped = MetricsCollector::new(&study);
    let mut run = Simulation::new(&study, 0);
    for k in 1..=700 {
        let until = Instant::START + Span::from_seconds(0.0917 * f64::from(k));
        run.run_until(until, &mut stopped).expect("a run");
    }
    assert_eq!(stopped.finish(&study).to_json(), metrics(study).to_json());
}

#[test]
fn the_gyro_has_noise_bias_and_a_resolution() {
    let keys = [
        ("body.spatial.rate", "[1e-3, 0.0, 0.0]"),
        ("body.spatial.inertia", "[[5, 0, 0], [0, 3, 0], [0, 0, 2]]"),
        ("sensor.gyro.noise", "[2e-6, 3e-6, 0.0]"),
        ("sensor.gyro.bias", "[0.0, 1e-5, 0.0]"),
        ("sensor.gyro.resolution", "[0.0, 0.0, 7e-6]"),
        ("body.spatial.modes[0].rate", "1e-4"),
        ("body.spatial.modes[0].shapes.hub.rotation", "[0.0, 0.0, 0.5]"),
        ("duration", "2000"),
        ("log.period", "0.2"),
    ];
    let trace = traced(&free(&keys));
    let rates = trace.topic("/rates").expect("rates");
    let errors = |axis: usize| -> Vec<f64> {
        let (measured, rate) = (about(rates, axis, "measured_rad_s"), about(rates, axis, "rate_rad_s"));
        measured.iter().zip(&rate).map(|(measured, rate)| measured - rate).collect()
    };
    for (axis, mean, sd) in [(0, 0.0, 2e-6), (1, 1e-5, 3e-6)] {
        let errors = errors(axis);
        let n = errors.len() as f64;
        let found = errors.iter().sum::<f64>() / n;
        let spread = (errors.iter().map(|e| (e - found) * (e - found)).sum::<f64>() / n).sqrt();
        // Four standard errors of 10 001 samples, sd/sqrt(n) and sd/sqrt(2n).
        assert!((found - mean).abs() < 4.0 * sd / 100.0, "{found:e}");
        assert!((spread / sd - 1.0).abs() < 4.0 / (2.0 * n).sqrt(), "{spread:e}");
    }
    // Half of a quantum at most, and the elastic part is in it.
    assert!(errors(2).iter().all(|error| error.abs() <= 3.5e-6 * (1.0 + 1e-9)));
    assert!(about(rates, 2, "measured_rad_s").contains(&4.9e-5));
    let sum = about(rates, 2, "rigid_rad_s")[1] + about(rates, 2, "elastic_rad_s")[1];
    assert_eq!(about(rates, 2, "rate_rad_s")[1], sum);
    assert_eq!(about(rates, 2, "elastic_rad_s")[0], 0.5e-4);
}

/// About the axes of a diagonal tensor a small torque acts as on three bodies of one angle.
#[test]
fn the_surroundings_push() {
    let keys = [
        ("body.spatial.rate", "[0.0, 0.0, 0.0]"),
        ("body.spatial.inertia", "[[5, 0, 0], [0, 3, 0], [0, 0, 2]]"),
        (
            "body.spatial.disturbance",
            "{ constant = [1e-9, 0, 0], amplitude = [0, 2e-9, 0], period = 50.0, phase = [0, 0.4, 0] }",
        ),
        ("log.period", "80"),
        ("duration", "80"),
    ];
    let trace = traced(&free(&keys));
    let rates = trace.topic("/rates").expect("rates");
    let turn = std::f64::consts::TAU / 50.0;
    close(about(rates, 0, "rigid_rad_s")[1], 1e-9 * 80.0 / 5.0, 1e-12);
    close(
        about(rates, 1, "rigid_rad_s")[1],
        2e-9 / 3.0 / turn * (0.4_f64.cos() - (0.4 + turn * 80.0).cos()),
        1e-12,
    );
    assert!(about(rates, 2, "rigid_rad_s")[1].abs() < 1e-13);
    close(last(&trace, "/pointing", "roll_error_rad"), 0.5 * 1e-9 / 5.0 * 6400.0, 1e-9);
}

/// Executed in the cycle of its command or in the next: there the rigid rates are what the pulses make of them.
#[test]
fn pulses_act_where_and_as_long_as_commanded() {
    let keys = |delay: &'static str| {
        [
            ("body.spatial.inertia", "[[5, 0, 0], [0, 3, 0], [0, 0, 2]]"),
            ("body.spatial.rate", "[0.0, 0.05, 0.0]"),
            ("law.phase_plane.switch_on", "0.01"),
            ("law.phase_plane.switch_off", "0.001"),
            ("actuator.jets.delay", delay),
            ("body.spatial.modes[0].shapes.hub.rotation", "[0.0, 0.0, 0.0]"),
            ("log.period", "0.05"),
            ("duration", "1"),
        ]
    };
    // 0.05 rad/s by 1/3 rad/s²: 0.15 s of fire about -y, from 0 or from 0.2 s on.
    for (delay, begins) in [("0", 0), ("1", 4)] {
        let trace = traced(&free(&keys(delay)));
        let (jets, rates) = (trace.topic("/jets").expect("jets"), trace.topic("/rates").expect("rates"));
        assert_eq!(jets.len(), 1);
        close(column(&trace, "/jets", "pitch_on_s")[0], -0.15, 1e-12);
        close(column(&trace, "/jets", "fuel_kg")[0], 0.15 / (200.0 * 9.806_65), 1e-12);
        let rate = about(rates, 1, "rigid_rad_s");
        for (k, rate) in rate.iter().enumerate() {
            let fired = (0.05 * (k as f64 - f64::from(begins))).clamp(0.0, 0.15);
            assert!((rate - (0.05 - fired / 3.0)).abs() < 1e-15, "{k}: {rate}");
        }
        // The mode, pushed along x by -1 N where its displacement is 1/sqrt(kg), follows the exact pulse.
        let mut elastic = ElasticModes::new(body(&free(&[])), 0.2);
        let mut phases = ElasticModes::start(body(&free(&[])));
        elastic.advance(&mut phases, &[-1.0], 0.15);
        elastic.advance(&mut phases, &[], 0.85 - 0.05 * f64::from(begins));
        close(last(&trace, "/energy", "elastic_j"), elastic.energies(&phases).sum(), 1e-12);
    }
}

/// Too short a pulse gives zero, a longer one whole quanta, and none more than the cycle.
#[test]
fn pulses_have_a_least_length_and_a_quantum() {
    let study = scenario("iss-manoeuvre-off", &[]);
    let width = study.study.authorities[0].width;
    for (asked, given) in [(0.044, 0.0), (0.046, 0.05), (0.123, 0.12), (0.127, 0.13), (0.3, 0.2)] {
        assert!((width.on_time(asked, 0.2) - given).abs() < 1e-15, "{asked}");
    }
}

#[test]
fn campaigns_are_the_same_on_any_number_of_threads() {
    let dir = Dir::with(&["iss-manoeuvre-off"]);
    let text = dir.text("iss-manoeuvre-off.toml");
    dir.write(
        "study.toml",
        format!("{text}\n[uncertain]\n\"body.spatial.modes[3].frequency\" = {{ relative_uniform = 0.2 }}\n"),
    );
    for jobs in ["1", "3"] {
        dir.run(&format!(
            "simulate study.toml --runs 6 --set duration=120 --jobs {jobs} --table csv -o {jobs}"
        ))
        .exits(0);
    }
    assert_eq!(dir.text("1/runs.csv"), dir.text("3/runs.csv"));
    let rows = table(&dir, "1/runs.csv");
    assert_eq!(rows.len(), 6);
    assert_ne!(rows[0]["elastic_energy_peak_j"], rows[1]["elastic_energy_peak_j"]);
}

#[test]
fn the_command_knows_spatial_bodies() {
    let dir = Dir::with(&["iss-manoeuvre-off"]);
    let ran = dir.run("simulate iss-manoeuvre-off.toml --set duration=60 --log full").exits(0);
    ran.says(&["iss-manoeuvre-off   no requirement", "propellant   3.41 kg", "log "]);
    let rows = dir.run("export iss-manoeuvre-off.mcap --topic /jets").exits(0);
    rows.prints(&["time_s,roll_on_s,pitch_on_s,yaw_on_s,fuel_kg"]);
    let modes = dir.run("modes iss-manoeuvre-off.toml --json").exits(0).json();
    close(modes["influences"][2][3].as_f64().expect("a number"), 2.89, 0.01);
    close(modes["accelerations_rad_s2"][0][0].as_f64().expect("a number"), 8.40e-6, 0.001);
    dir.run("modes iss-manoeuvre-off.toml").exits(0).says(&["12 modes", "influence"]);
    dir.run("plot iss-manoeuvre-off.mcap --format svg -o figures").exits(0);
    let figures = ["deflection", "energy", "jets", "pointing", "rates"];
    let figures = figures.map(|what| format!("iss-manoeuvre-off-{what}.svg"));
    assert_eq!(dir.names("figures"), figures);
    dir.run("plot iss-manoeuvre-off.mcap --what angle")
        .exits(2)
        .says(&["no figure `angle`", "has pointing, rates"]);
    // The log repeats alone.
    let scenario = dir.run("log scenario iss-manoeuvre-off.mcap").printed();
    dir.write("again.toml", scenario);
    dir.run("simulate again.toml -o again --log full").exits(0);
    assert!(dir.read("again/iss-manoeuvre-off.mcap") == dir.read("iss-manoeuvre-off.mcap"));
    for verb in [
        "cycle iss-manoeuvre-off.toml",
        "plan iss-manoeuvre-off.toml",
        "tune iss-manoeuvre-off.toml --frequency 0.1:0.3:3",
        "map iss-manoeuvre-off.toml --frequency 0.1:0.3:3 --period 0.1:0.3:3",
    ] {
        dir.run(verb).exits(2).says(&["body.spatial: turns about three axes", "one angle"]);
    }
}

/// Weak and strong jets, at once and a cycle late, narrow and wide zones, with and without a steady torque of up to a
/// tenth of the weakest jets': the attitude reaches each target and stays within the tolerance of the law.
#[test]
fn every_target_is_reached_and_held() {
    let mut draw = 1_u64;
    let mut uniform = |low: f64, high: f64| {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (draw >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..160 {
        // Thrust sets the accelerations, 2.6e-7 to 4.8e-3 rad/s²; the weakest axis has 8.4e-6 rad/s² at 130 N. The
        // smallest pulse changes up to 2.4e-4 rad/s, more than many a `switch_on`.
        let scale = 10_f64.powf(uniform(-1.5, 2.0));
        let zone = 10_f64.powf(uniform(-3.0, -2.0));
        let limit = 10_f64.powf(uniform(-3.5, -2.5));
        let on = limit * uniform(0.08, 0.25);
        let off = on * uniform(0.2, 0.5);
        let [roll, pitch, yaw] = [0; 3].map(|_| uniform(-0.05, 0.05));
        let torque = if case % 2 == 0 { 0.0 } else { uniform(-0.1, 0.1) * 1092.0 * scale };
        let delay = case / 2 % 2;
        let mut document =
            flexsc_core::Document::load(&std::path::Path::new(SCENARIOS).join("iss-manoeuvre-off.toml"))
                .expect("a scenario");
        let time = 700.0 + 0.5 / limit + 60.0 * (zone.max(1e-3) / (8.4e-6 * scale)).sqrt() + 0.2 / off;
        for (key, value) in [
            ("duration", format!("{:.0}", time.min(20_000.0))),
            ("law.phase_plane.dead_zone", zone.to_string()),
            ("law.phase_plane.rate_limit", limit.to_string()),
            ("law.phase_plane.switch_on", on.to_string()),
            ("law.phase_plane.switch_off", off.to_string()),
            (
                "law.phase_plane.targets",
                format!("[{{ from = 1.0, roll = {roll}, pitch = {pitch}, yaw = {yaw} }}]"),
            ),
            ("actuator.jets.delay", delay.to_string()),
            ("body.spatial.modes", "[]".to_owned()),
            ("body.spatial.disturbance", format!("{{ constant = [{torque}, {torque}, {torque}] }}")),
            ("sensor.gyro.noise", "[0, 0, 0]".to_owned()),
            ("sensor.gyro.resolution", "[0, 0, 0]".to_owned()),
        ] {
            document.set_text(key, &value).expect(key);
        }
        for thruster in 0..12 {
            let key = format!("actuator.jets.thrusters[{thruster}].thrust");
            document.set_text(&key, &(130.0 * scale).to_string()).expect("a thruster");
        }
        let reported = metrics(Scenario::from_document(&document).expect("valid"));
        let goal = reported.get("goal");
        assert_eq!(
            goal,
            Some(&flexsc_core::metrics::MetricValue::Word("met")),
            "case {case}: scale {scale}, zone {zone}, limit {limit}, on {on}, off {off}, delay {delay}, torque {torque}: {:?} s \
             outside",
            reported.number("time_outside_s")
        );
    }
}
