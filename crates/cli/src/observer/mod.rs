//! `flexsc observer`: with which weights the recurrence observer of an elastic mode converges.

mod figures;

use std::f64::consts::TAU;
use std::io::Write;

use flexsc_core::analysis::damping::{Convergence, Margin};
use serde_json::json;

use crate::failure::Failure;
use crate::figure::Drawing;
use crate::{print, say};

pub use figures::figure;

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct Args {
    /// Natural frequency of the mode (rad/s)
    #[arg(long, value_name = "FREQUENCY")]
    frequency: f64,
    /// Damping ratio of the mode
    #[arg(long, value_name = "RATIO", default_value_t = 0.005)]
    damping: f64,
    /// Time from one sample to the next (s)
    #[arg(long, value_name = "TIME", default_value_t = 0.2)]
    period: f64,
    /// What of an innovation the rigid rate takes, what the elastic rate, and what is taken off the next one
    #[arg(
        long,
        value_name = "W1,W2,W3",
        value_delimiter = ',',
        num_args = 1,
        default_value = "0.05,0.2,0.15"
    )]
    weights: Vec<f64>,
    /// Gains of the identification times the elastic rate, W4 |g|, for the regions in which the frozen observer converges
    #[arg(long, value_name = "KAPPA,...", value_delimiter = ',', default_value = "0,1.5,4")]
    kappa: Vec<f64>,
    #[command(flatten)]
    drawing: Drawing,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// The region of the frozen observer at one gain.
struct Region {
    kappa: f64,
    /// Its area in the plane of W2 and W3.
    area: f64,
    /// Whether it holds the weights.
    converges: bool,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let Ok(weights) = <[f64; 3]>::try_from(args.weights.as_slice()) else {
        let count = args.weights.len();
        return Err(Failure::Arguments(format!("--weights must be three numbers, W1,W2,W3, got {count}")));
    };
    let of = Convergence { frequency: args.frequency, damping: args.damping, period: args.period, weights };
    if let Some((name, why)) = of.inconsistency() {
        return Err(Failure::Arguments(format!("--{name} {why}")));
    }
    if let Some(wrong) = args.kappa.iter().find(|kappa| !(0.0..1e3).contains(*kappa)) {
        return Err(Failure::Arguments(format!(
            "--kappa must be numbers of 0 or more below 1000, got {wrong}"
        )));
    }
    let region = |&kappa: &f64| Region { kappa, area: of.area(kappa), converges: of.converges(kappa) };
    let regions: Vec<Region> = args.kappa.iter().map(region).collect();
    let margin = of.margin();
    if let Some(directory) = &args.drawing.figures {
        figures::save(&of, &args.kappa, margin, directory, args.drawing.format)?;
    }
    if args.json {
        let (a, b) = of.recurrence();
        let frozen = regions
            .iter()
            .map(|region| json!({"kappa": region.kappa, "area": region.area, "converges": region.converges}));
        let told = json!({"a": a, "b": b, "frozen": frozen.collect::<Vec<_>>(), "turning": margin});
        return print(format!("{told}\n").as_bytes());
    }
    tell(&of, &regions, margin);
    Ok(())
}

fn tell(of: &Convergence, regions: &[Region], margin: Option<Margin>) {
    let ((a, b), [w1, w2, w3]) = (of.recurrence(), of.weights);
    say!(
        "observer   a mode of {:.4} Hz, sampled each {} s: A = {a:.10}, B = {b:.10}; W1 = {w1}, W2 = {w2}, W3 = {w3}",
        of.frequency / TAU,
        of.period
    );
    for Region { kappa, area, converges } in regions {
        let does = if *converges { "converges" } else { "does not converge" };
        say!("  frozen   W4 |g| = {kappa}: {does}; the region of W2 and W3 has an area of {area:.3}");
    }
    match margin {
        Some(Margin { gain_max, gain_best, spectral_radius }) => say!(
            "  turning  converges up to W4 V = {gain_max:.4}, soonest at {gain_best:.4}: a sample leaves {spectral_radius:.4} of \
             an error"
        ),
        None => say!("  turning  converges with no W4"),
    }
}
