//! Printed tables of tuned gains.

use std::io::Write;

use flexsc_core::analysis::sampled_loop::{GainRegion, Gains, RobustGain};

use crate::human::{Units, digits};
use crate::number::fixed;
use crate::say;

/// Prints the region of admissible gains.
pub fn print(name: &str, limit: f64, gains: Gains, found: &[GainRegion], units: Units) {
    let (factor, unit) = units.frequency();
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
    say!("  {:>10}{:>10}{:>10}{:>10}{:>12}{:>12}{:>14}", unit, "", "", "", "s", "", "s");
    for r in found {
        say!(
            "  {:>10}{:>10}{:>10}{:>10}{:>12}{:>12}{:>14}",
            digits(r.frequency_rad_s * factor),
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
pub fn print_robust(name: &str, off: f64, found: &[RobustGain], units: Units) {
    let (factor, unit) = units.frequency();
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
    say!("  {:>10}{:>10}{:>12}{:>14}{:>12}{:>14}", unit, "", "s", "s", "", "s");
    for r in found {
        say!(
            "  {:>10}{:>10}{:>12}{:>14}{:>12}{:>14}",
            digits(r.frequency_rad_s * factor),
            fixed(r.gain, 3),
            fixed(r.settling_s, 1),
            fixed(r.settling_quantile_s, 1),
            fixed(r.spectral_radius, 7),
            fixed(r.settling_without_s, 1),
        );
    }
}
