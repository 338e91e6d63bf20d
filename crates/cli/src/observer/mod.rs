//! `flexsc observer`: weights with which the recurrence observer of an elastic mode converges.

mod figures;

use std::io::Write;

use flexsc_core::analysis::damping::{Convergence, GainMargin};
use flexsc_figure::Named;
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::human::Units;
use crate::quantity::in_unit;
use crate::results::{Results, show};
use crate::say;

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct ObserverArgs {
    /// Natural frequency of the mode (rad/s)
    #[arg(long, value_name = "FREQUENCY", value_parser = in_unit("rad/s"))]
    frequency: f64,
    /// Damping ratio of the mode
    #[arg(long, value_name = "RATIO", default_value_t = 0.005, value_parser = in_unit(""))]
    damping: f64,
    /// Time from one sample to the next (s)
    #[arg(long, value_name = "TIME", default_value_t = 0.2, value_parser = in_unit("s"))]
    period: f64,
    /// Weights of an innovation: on the rigid rate, on the elastic rate, and on the next elastic rate (W1, W2, W3)
    #[arg(
        long,
        value_name = "W1,W2,W3",
        value_delimiter = ',',
        num_args = 1,
        default_value = "0.05,0.2,0.15",
        value_parser = in_unit("")
    )]
    weights: Vec<f64>,
    /// Gains of the identification times the elastic rate, W4 |g|, for the regions in which the frozen observer converges
    #[arg(long, value_name = "KAPPA,...", value_delimiter = ',', default_value = "0,1.5,4", value_parser = in_unit(""))]
    kappa: Vec<f64>,
    #[command(flatten)]
    drawing: FigureOutput,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Convergence region of the observer with a frozen regressor at one gain.
#[derive(Serialize)]
struct ConvergenceRegion {
    kappa: f64,
    /// Area of the region in the plane of W2 and W3.
    area: f64,
    /// True if the region contains the observer's weights.
    converges: bool,
}

/// Convergence of a recurrence observer.
pub struct ObserverResults {
    convergence: Convergence,
    regions: Vec<ConvergenceRegion>,
    margin: Option<GainMargin>,
    units: Units,
}

impl ObserverArgs {
    /// Computes the convergence of the observer.
    pub fn results(&self) -> Result<ObserverResults, CliError> {
        let Ok(weights) = <[f64; 3]>::try_from(self.weights.as_slice()) else {
            let count = self.weights.len();
            return Err(CliError::Arguments(format!(
                "--weights must be three numbers, W1,W2,W3, got {count}"
            )));
        };
        let convergence =
            Convergence { frequency: self.frequency, damping: self.damping, period: self.period, weights };
        if let Some((name, why)) = convergence.inconsistency() {
            return Err(CliError::Arguments(format!("--{name} {why}")));
        }
        if let Some(refused) = self.kappa.iter().find(|kappa| !(0.0..1e3).contains(*kappa)) {
            return Err(CliError::Arguments(format!(
                "--kappa must be numbers of 0 or more below 1000, got {refused}"
            )));
        }
        let region = |&kappa: &f64| ConvergenceRegion {
            kappa,
            area: convergence.area(kappa),
            converges: convergence.converges(kappa),
        };
        Ok(ObserverResults {
            convergence,
            regions: self.kappa.iter().map(region).collect(),
            margin: convergence.margin(),
            units: self.drawing.choice.units(),
        })
    }
}

pub fn run(args: &ObserverArgs) -> Result<(), CliError> {
    show(&args.results()?, Some(&args.drawing), args.json)
}

impl Results for ObserverResults {
    fn json(&self) -> Vec<Json> {
        let (a, b) = self.convergence.recurrence();
        vec![json!({"a": a, "b": b, "frozen": self.regions, "turning": self.margin})]
    }

    fn figures(&self) -> Vec<Named> {
        let kappas: Vec<f64> = self.regions.iter().map(|region| region.kappa).collect();
        vec![("observer".to_owned(), figures::figure(&self.convergence, &kappas, self.margin))]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { convergence, regions, margin, units } = self;
        let (factor, unit) = units.frequency();
        let ((a, b), [w1, w2, w3]) = (convergence.recurrence(), convergence.weights);
        say!(
            "observer   a mode of {:.4} {unit}, sampled each {} s: A = {a:.10}, B = {b:.10}; W1 = {w1}, W2 = {w2}, W3 = {w3}",
            convergence.frequency * factor,
            convergence.period
        );
        for ConvergenceRegion { kappa, area, converges } in regions {
            let does = if *converges { "converges" } else { "does not converge" };
            say!("  frozen   W4 |g| = {kappa}: {does}; the region of W2 and W3 has an area of {area:.3}");
        }
        match margin {
            Some(GainMargin { gain_max, gain_best, spectral_radius }) => say!(
                "  turning  converges up to W4 V = {gain_max:.4}, soonest at {gain_best:.4}: a sample leaves {spectral_radius:.4} of \
                 an error"
            ),
            None => say!("  turning  converges with no W4"),
        }
        Ok(())
    }
}
