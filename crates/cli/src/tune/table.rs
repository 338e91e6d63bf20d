//! Printed tables of tuned gains.

use std::io::Write;

use flexsc_core::analysis::sampled_loop::{GainRegion, Gains, RobustGain};

use crate::number::fixed;
use crate::say;

/// Prints the region of admissible gains.
pub fn print(name: &str, limit: f64, gains: Gains, found: &[GainRegion]) {
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
            fixed(r.gain.map(|gain| gain.0), 3),
            fixed(r.gain.map(|gain| gain.1), 3),
            fixed(r.midpoint, 3),
            fixed(r.settling_s, 1),
            fixed(r.spectral_radius, 7),
            fixed(r.settling_without_s, 1),
        );
    }
}

/// Prints the robust gains.
pub fn print_robust(name: &str, off: f64, found: &[RobustGain]) {
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
            fixed(r.gain, 3),
            fixed(r.settling_s, 1),
            fixed(r.settling_quantile_s, 1),
            fixed(r.spectral_radius, 7),
            fixed(r.settling_without_s, 1),
        );
    }
}
