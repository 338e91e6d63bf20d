//! The relay law and its envelope against numbers that were computed without flexsc.
//!
//! `golden/relay_oracle.py` made the switchings (40 digits). The window means were computed in quadruple arithmetic from
//! the equations of \[Silaev\].

use flexsc_core::Simulation;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Column, Columns, Detail, Trace};

use crate::study::{close, metrics, numbers, pairs, scenario};

/// The exact times of a trace's switchings, in seconds and femtoseconds.
fn switchings(columns: &Columns) -> (Vec<(u64, u64)>, Vec<String>) {
    let counts = |name| match columns.get(name) {
        Some(Column::Counts(counts)) => counts.clone(),
        other => panic!("{name}: {other:?}"),
    };
    let Some(Column::Labels(states, labels)) = columns.get("state") else { panic!("no states") };
    let times = counts("time_whole_s").into_iter().zip(counts("time_fs")).collect();
    (times, states.iter().map(|&state| labels[usize::from(state)].clone()).collect())
}

/// The difference (s) from a decimal time, without rounding either to a double.
fn difference((whole, femtoseconds): (u64, u64), decimal: &str) -> f64 {
    let (seconds, digits) = decimal.split_once('.').expect("decimals");
    let digits = format!("{digits:0<18}")[..18].parse::<i128>().expect("digits");
    let exact = seconds.parse::<i128>().expect("seconds") * 10_i128.pow(18) + digits;
    let ours = i128::from(whole) * 10_i128.pow(18) + i128::from(femtoseconds) * 1000;
    (ours - exact) as f64 / 1e18
}

fn golden(k_t: &str) -> Vec<Vec<String>> {
    let path = format!("{}/../../tests/golden/relay-switchings-{k_t}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a golden file");
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn switchings_are_those_of_40_digit_arithmetic() {
    // At 0.31 rounding grows through a chaotic transient of 3500 s; at 0.3389 it does not grow.
    for (k_t, first, all) in [("0.31", 5e-12, 2e-2), ("0.3389", 5e-12, 1e-9)] {
        let mut trace = Trace::new(Detail::Events);
        let scenario = scenario("relay-fixed", &[("law.relay.k_t", k_t)]);
        Simulation::new(&scenario, 0).run(&mut trace).expect("a run");
        let (times, states) = switchings(trace.topic("/command").expect("a topic"));
        let golden = golden(k_t);
        assert_eq!(times.len(), golden.len());
        for (index, row) in golden.iter().enumerate() {
            let error = difference(times[index], &row[0]).abs();
            let most = if index < 50 { first } else { all };
            assert!(error < most, "k_t = {k_t}, switching {index} at {}: off by {error:e} s", row[0]);
            assert_eq!(states[index], row[1], "k_t = {k_t}, switching {index}");
        }
    }
}

#[test]
fn states_at_switchings_are_those_of_40_digit_arithmetic() {
    for (k_t, most) in [("0.31", 2e-15), ("0.3389", 2e-15)] {
        let scenario = scenario("relay-fixed", &[("law.relay.k_t", k_t), ("log.period", "1e9")]);
        let mut trace = Trace::new(Detail::Full);
        Simulation::new(&scenario, 0)
            .run_until(Instant::START + Span::from_seconds(1200.0), &mut trace)
            .expect("a run");
        let rate = trace.topic("/rate").expect("a topic").numbers("rigid_rad_s").expect("rates");
        let angle = trace.topic("/attitude").expect("a topic").numbers("rigid_rad").expect("angles");
        let Some(Column::Rows(_, modes)) = trace.topic("/modes").expect("a topic").get("modes") else {
            panic!("no modes")
        };
        let displacement = modes.numbers("displacement_rad").expect("displacements");
        let mode_rate = modes.numbers("rate_rad_s").expect("rates");
        for (index, row) in golden(k_t).iter().take(120).enumerate() {
            let exact: Vec<f64> = row[2..].iter().map(|cell| cell.parse().expect("a number")).collect();
            // A period beyond the run leaves the motion at the start and at each switching.
            let i = index + 1;
            let ours = [
                angle[i],
                rate[i],
                displacement[2 * i],
                mode_rate[2 * i] / 0.44,
                displacement[2 * i + 1],
                mode_rate[2 * i + 1] / 0.755,
            ];
            for (ours, exact) in pairs(ours, &exact) {
                assert!((ours - exact).abs() < most, "k_t = {k_t}, switching {index}: {ours:e} {exact:e}");
            }
        }
    }
}

#[test]
fn state_at_1000_s() {
    let scenario = scenario("relay-quiet", &[]);
    let mut simulation = Simulation::new(&scenario, 0);
    simulation.run_until(Instant::START + Span::from_seconds(1000.0), &mut ()).expect("a run");
    let state = simulation.state().expect("one angle");
    let [first, second] = state.modes[..] else { panic!("two modes") };
    let pairs = [
        (state.rigid_angle, 4.993_324_144_762_067e-4),
        (state.rigid_rate, 3.338_517_000_820_886e-5),
        (first.displacement, -5.047_623_244_824_639e-6),
        (first.quadrature, 3.697_112_222_636e-7),
        (second.displacement, -1.699_772_355_647_035e-6),
        (second.quadrature, 1.654_376_259_290e-7),
    ];
    for (ours, exact) in pairs {
        assert!((ours - exact).abs() < 1e-15, "{ours:e} {exact:e}");
    }
}

#[test]
fn window_means_are_those_of_quadruple_arithmetic() {
    let exact = [
        6.994_022_517_911e-6,
        6.551_491_110_218e-6,
        6.565_778_110_026e-6,
        6.558_104_683_943e-6,
        6.559_733_297_215e-6,
        6.559_296_426_215e-6,
    ];
    let quiet = metrics(scenario("relay-quiet", &[]));
    for (ours, exact) in pairs(numbers(&quiet, "envelope_window_means_rad").iter().take(6), exact) {
        close(*ours, exact, 1e-10);
    }
    close(quiet.number("envelope_late_mean_rad").expect("a mean"), 6.562_419_665_4e-6, 1e-9);
    close(quiet.number("envelope_mean_rad").expect("a mean"), 6.572_931_447_3e-6, 1e-9);
    assert_eq!(quiet.number("switchings"), Some(2526.0));

    // The transient of 0.31 multiplies rounding: doubles leave 1e-8 after four windows. Rounding the input 0.44 to a
    // double moves window 5 by 1.4e-7 even in exact arithmetic.
    let exact = [
        (1.812_173_931_742e-5, 1e-10),
        (2.195_324_004_817e-5, 1e-10),
        (2.130_431_627_476e-5, 1e-8),
        (2.158_761_513_050e-5, 1e-8),
        (2.137_484_875_918e-5, 1e-5),
        (2.076_467_377_446e-5, 1e-5),
    ];
    let fixed = metrics(scenario("relay-fixed", &[]));
    for (ours, (exact, most)) in pairs(numbers(&fixed, "envelope_window_means_rad").iter().take(6), exact) {
        close(*ours, exact, most);
    }
    close(fixed.number("envelope_late_mean_rad").expect("a mean"), 1.971_906_24e-5, 1e-5);
    assert_eq!(fixed.number("switchings"), Some(2719.0));
}

#[test]
fn all_forms_of_the_observer_agree() {
    let of = |form: &str| {
        let metrics = metrics(scenario("relay-quiet", &[("estimator.envelope.form", form)]));
        numbers(&metrics, "envelope_window_means_rad")
    };
    let truth = of("truth");
    for form in ["dynamic", "trigonometric"] {
        for (ours, truth) in pairs(&of(form), &truth) {
            close(*ours, *truth, 1e-11);
        }
    }
    // With damping the closed form gives way to quadrature, and the frames shrink.
    let damped = [("body.planar.modes[0].damping", "0.005"), ("body.planar.modes[1].damping", "0.002")];
    let of = |form: &'static str| {
        let set = [damped[0], damped[1], ("estimator.envelope.form", form)];
        numbers(&metrics(scenario("relay-quiet", &set)), "envelope_window_means_rad")
    };
    let truth = of("truth");
    for form in ["dynamic", "trigonometric"] {
        for (ours, truth) in pairs(&of(form), &truth) {
            close(*ours, *truth, 1e-9);
        }
    }
}
