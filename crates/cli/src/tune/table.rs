//! Tuned gains for people.

use std::io::Write;

use flexsc_core::analysis::sampled_loop::{Gains, Region, Robust};

use crate::say;

fn cell(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "none".to_owned(), |value| format!("{value:.digits$}"))
}

/// Tells the region.
pub fn tell(name: &str, limit: f64, gains: Gains, found: &[Region]) {
    let Gains { low, high, step } = gains;
    say!(
        "{name}   gains of the extra loop that are stable and settle in {limit} s, of {low} to {high} by {step}"
    );
    say!(
        "  {:>10}{:>10}{:>10}{:>10}{:>12}{:>12}{:>14}",
        "frequency",
        "lowest",
        "highest",
        "middle",
        "settling",
        "radius",
        "without"
    );
    say!("  {:>10}{:>10}{:>10}{:>10}{:>12}{:>12}{:>14}", "rad/s", "", "", "", "s", "", "s");
    for r in found {
        say!(
            "  {:>10.4}{:>10}{:>10}{:>10}{:>12}{:>12}{:>14}",
            r.frequency_rad_s,
            cell(r.gain.map(|gain| gain.0), 3),
            cell(r.gain.map(|gain| gain.1), 3),
            cell(r.midpoint, 3),
            cell(r.settling_s, 1),
            cell(r.spectral_radius, 7),
            cell(r.settling_without_s, 1),
        );
    }
}

/// Tells the robust gains.
pub fn tell_robust(name: &str, off: f64, found: &[Robust]) {
    say!("{name}   gains of the extra loop that settle soonest with the model off by {} %", off * 100.0);
    say!(
        "  {:>10}{:>10}{:>12}{:>14}{:>12}{:>14}",
        "frequency",
        "gain",
        "settling",
        "perturbed",
        "radius",
        "without"
    );
    say!("  {:>10}{:>10}{:>12}{:>14}{:>12}{:>14}", "rad/s", "", "s", "s", "", "s");
    for r in found {
        say!(
            "  {:>10.4}{:>10}{:>12}{:>14}{:>12}{:>14}",
            r.frequency_rad_s,
            cell(r.gain, 3),
            cell(r.settling_s, 1),
            cell(r.settling_quantile_s, 1),
            cell(r.spectral_radius, 7),
            cell(r.settling_without_s, 1),
        );
    }
}
