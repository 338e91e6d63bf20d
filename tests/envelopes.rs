//! The envelope on three axes: against closed forms, the true motion and the log, and the adaptation that learns from
//! it.

use flexsc_core::Scenario;
use flexsc_core::record::Trace;

use crate::study::{close, pairs};
use crate::traces::{column, nested, traced};

const BODY: &str = "[body.spatial]
inertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]
points = [{ name = \"hub\" }]
modes = [
    { frequency = 1.0, damping = 0.01, displacement = 2e-4, rate = -2e-6, shapes.hub = { rotation = [0.03, 0.0, 0.04] } },
    { frequency = 2.5, damping = 0.004, shapes.hub = { rotation = [0.01, 0.04, -0.03] } },
]
";

const CRAFT: &str = "[spacecraft]
mass = 200.0
inertia = [[80.0, 1.0, 0.0], [1.0, 70.0, 0.0], [0.0, 0.0, 60.0]]
rate = [1e-4, -2e-4, 1e-4]
[[appendage]]
name = \"panel\"
mass = 10.0
centre = [0.0, 1.5, 0.0]
inertia = [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 10.0]]
at = [0.0, 0.5, 0.0]
modes = [{ frequency = 1.0, damping = 0.01, translation = [0.0, 0.0, 2.0], rotation = [4.0, 0.0, 0.0], displacement = 1e-3 }]
";

const PD: &str = "pd = { k_p = 0.4, k_d = 6.0, period = 0.3 }";

fn run(body: &str, law: &str, rest: &str) -> Trace {
    let text = format!("duration = 60.0\nlaw = {{ {law} }}\n{rest}\n{body}");
    let scenario = Scenario::parse("envelope.toml", &text).expect("a scenario");
    traced(&scenario)
}

/// Returns the means over windows of 7 s.
fn means(body: &str, law: &str, form: &str) -> Vec<f64> {
    let rest = format!("estimator = {{ envelope = {{ window = 7.0, form = \"{form}\" }} }}");
    column(&run(body, law, &rest), "/envelope_mean", "mean_rad").to_vec()
}

#[test]
fn a_mode_that_rings_down_has_the_envelope_of_its_closed_form() {
    // At q' = -zeta w q the phasor is real: |Z| = q exp(-zeta w t), times the rotation of 0.05 for a unit of the mode.
    for form in ["dynamic", "trigonometric", "truth"] {
        let found = means(BODY, "open = {}", form);
        assert_eq!(found.len(), 8);
        for (window, mean) in found.into_iter().enumerate() {
            let from = 7.0 * window as f64;
            let of = |t: f64| (-0.01 * t).exp();
            close(mean, 2e-4 * 0.05 * (of(from) - of(from + 7.0)) / (0.01 * 7.0), 1e-9);
        }
    }
}

#[test]
fn the_monitor_knows_what_the_commanded_torque_does_to_modes() {
    // Envelopes from the model and from the true motion are equal if the modes do not act back on the rotation.
    let [dynamic, trigonometric, truth] =
        ["dynamic", "trigonometric", "truth"].map(|form| means(BODY, PD, form));
    for ((dynamic, trigonometric), truth) in pairs(pairs(&dynamic, &trigonometric), &truth) {
        close(*dynamic, *truth, 1e-9);
        close(*trigonometric, *truth, 1e-9);
    }
    // On a spacecraft they are nearly equal.
    let wheels = format!("{CRAFT}[actuator.wheels]\narrangement = \"pyramid\"\ninertia = 0.01\n");
    let [dynamic, truth] = ["dynamic", "truth"].map(|form| means(&wheels, PD, form));
    for (dynamic, truth) in pairs(&dynamic, &truth) {
        close(*dynamic, *truth, 1e-3);
    }
}

#[test]
fn the_envelope_is_that_of_the_logged_modes() {
    let rest = "estimator = { envelope = { window = 7.0 } }\nlog.period = 0.01";
    let trace = run(BODY, PD, rest);
    let mut sums = vec![0.0; 6000];
    for (mode, (w, zeta, rotation)) in
        [(1.0, 0.01, 0.05), (2.5, 0.004, (0.01_f64 * 0.01 + 0.04 * 0.04 + 0.03 * 0.03).sqrt())]
            .iter()
            .enumerate()
    {
        let [q, rate] =
            ["displacement", "rate"].map(|name| nested(&trace, "/vibrations", ["modes", name], (mode, 2)));
        let (decay, damped) = (zeta * w, w * f64::sqrt(1.0 - zeta * zeta));
        for (sum, (q, rate)) in sums.iter_mut().zip(q.iter().zip(&rate)) {
            *sum += rotation * q.hypot((rate + decay * q) / damped);
        }
    }
    let logged = column(&trace, "/envelope", "envelope_rad");
    assert!(logged.len() > 5600, "{}", logged.len());
    for (found, exact) in logged.iter().zip(&sums) {
        close(*found, *exact, 1e-8);
    }
    // Means over windows by the midpoints of short pieces.
    let found = column(&trace, "/envelope_mean", "mean_rad");
    assert_eq!(found.len(), 8);
    for (window, mean) in found.iter().enumerate() {
        let part = &logged[700 * window..=700 * (window + 1)];
        let trapezium: f64 = part.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum::<f64>() / 700.0;
        close(*mean, trapezium, 1e-4);
    }
}

#[test]
fn an_adaptation_learns_from_the_envelope_of_three_axes() {
    let rest = "estimator = { envelope = { window = 7.0 } }\n[adaptation.random_search]\ntunes = \"k_d\"\n\
                step = 1.0\nbounds = [3.0, 12.0]";
    let trace = run(BODY, PD, rest);
    let (steps, gains) = (column(&trace, "/adaptation", "gain"), column(&trace, "/envelope_mean", "gain"));
    assert_eq!(steps.len(), 8);
    assert_eq!(gains[0], 6.0);
    assert_eq!(gains[1..], steps[..7]);
    assert!(steps.iter().all(|gain| *gain != 6.0), "{steps:?}");
}

#[test]
fn what_no_envelope_has_is_refused_with_its_reason() {
    let refused = |body: &str, rest: &str| {
        let text = format!("duration = 60.0\nlaw = {{ {PD} }}\n{rest}\n{body}");
        Scenario::parse("refused.toml", &text).expect_err("a fault").to_string()
    };
    let turning = CRAFT.replace("modes =", "drive = { about = [0, 1, 0], rate = 0.02 }\nmodes =");
    let envelope = "estimator = { envelope = { window = 7.0 } }";
    let text = refused(&turning, envelope);
    assert!(text.contains("an appendage that turns changes them"), "{text}");
    let text =
        refused(BODY, "estimator.envelope = { window = 7.0, modes = [{ frequency = 1.0, gain = 0.1 }] }");
    assert!(text.contains("apply only to one angle"), "{text}");
}
