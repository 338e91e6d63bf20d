//! Linear model of a body, with its poles, and the gain margin of the sampled loop that a PD law and a wheel close on it.

#![allow(clippy::print_stdout, reason = "it prints poles and margins")]

use std::error::Error;

use flexsc_core::Scenario;
use flexsc_core::analysis::linear_model::LinearModel;
use flexsc_core::analysis::sampled_loop::{DiscretePlant, SampledLoop, Scaling};
use nalgebra::DMatrix;

/// Scenario as TOML: four undamped modes, a PD law with an extra loop on the dominant mode, and a wheel.
const SCENARIO: &str = include_str!("../../../scenarios/wheel-fixed-gain.toml");

/// Gain of the extra loop, `law.pd.extra.gain` in the scenario.
const EXTRA_GAIN: f64 = 1.2;
/// Largest factor of the gains for which the margin is searched.
const LARGEST_FACTOR: f64 = 1e4;

/// Returns the spectral radius of the loop with `k_p` and `k_d` multiplied by a factor; the loop is stable below 1.
fn spectral_radius(nominal: &SampledLoop, factor: f64) -> f64 {
    let mut scaled = nominal.clone();
    scaled.k_p *= factor;
    scaled.k_d *= factor;
    let ratios = scaled.ratios(scaled.frequency(), Scaling::All);
    DiscretePlant::new(&scaled, &ratios).closed(EXTRA_GAIN).spectral_radius()
}

/// Returns the smallest factor of the gains, to rounding, at which a stable loop becomes unstable.
fn gain_margin(nominal: &SampledLoop) -> f64 {
    let (mut stable, mut unstable) = (1.0, 1.05);
    while unstable < LARGEST_FACTOR && spectral_radius(nominal, unstable) < 1.0 {
        (stable, unstable) = (unstable, 1.05 * unstable);
    }
    for _ in 0..40 {
        let middle = 0.5 * (stable + unstable);
        if spectral_radius(nominal, middle) < 1.0 {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    stable
}

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("wheel-fixed-gain.toml", SCENARIO)?;
    // x' = A x + B u at the start of the run, at 0 s.
    let model = LinearModel::from_scenario(&scenario, 0.0)?;
    let order = model.states.len();
    let a = DMatrix::from_row_iterator(order, order, model.a.iter().flatten().copied());
    for pole in a.complex_eigenvalues().iter().filter(|pole| pole.im >= 0.0) {
        println!("pole at {:10.3e} + {:.4} i rad/s", pole.re, pole.im);
    }

    let (nominal, _) = SampledLoop::from_scenario(&scenario)?;
    let radius = spectral_radius(&nominal, 1.0);
    println!("The loop has a spectral radius of {radius:.6}.");
    println!("It is stable up to {:.2} times its gains.", gain_margin(&nominal));
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
