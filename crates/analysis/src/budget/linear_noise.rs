//! Noise of a pointing index, exact from the linear loop of a scenario about its target at rest.

use flexsc_numerics::attitude::AXES;

use crate::noise::{NoisyLoop, Window, WindowVariances};
use flexsc_scenario::{ErrorAxis, IndexWindow, SampledError, SampledQuantity, WindowConvention};

/// Returns the rms of the index of an error under the noise of the loop, of the norm if the error has several components;
/// `None` if the loop has no such output, or for a window that it does not have.
pub fn linear_noise(noisy: &NoisyLoop, error: &SampledError) -> Option<f64> {
    let outputs: Vec<usize> = output_names(error).iter().filter_map(|name| noisy.output(name)).collect();
    if outputs.is_empty() {
        return None;
    }
    let variances = outputs.into_iter().map(|output| index_variance(noisy, output, error));
    Some(f64::sqrt(variances.sum::<Option<f64>>()?))
}

/// Returns the names that the outputs of an error may have: about each axis, and of a body with one angle.
pub(super) fn output_names(error: &SampledError) -> Vec<String> {
    let each = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z].into_iter().zip(AXES);
    let chosen = each.filter(|(axis, _)| error.axis.is_none_or(|own| own == *axis));
    let (single, about): (&str, Vec<String>) = match &error.quantity {
        SampledQuantity::PointingError => ("angle", chosen.map(|(_, name)| (*name).to_owned()).collect()),
        SampledQuantity::RateError => ("rate", chosen.map(|(_, name)| format!("{name}_rate")).collect()),
        SampledQuantity::LineOfSight(line, _) => {
            let axes = [ErrorAxis::X, ErrorAxis::Y, ErrorAxis::Z].into_iter().zip(["x", "y", "z"]);
            let own = axes.filter(|(axis, _)| error.axis.is_none_or(|own| own == *axis));
            return own.map(|(_, name)| format!("line_of_sight{line}_{name}")).collect();
        }
    };
    about.into_iter().chain([single.to_owned()]).collect()
}

/// Returns the variance of an index of an output; `None` for a window that the loop does not have.
fn index_variance(noisy: &NoisyLoop, output: usize, error: &SampledError) -> Option<f64> {
    let seconds = |samples: u64| samples as f64 * error.period.seconds();
    let (length, separation) = match error.index {
        IndexWindow::Absolute => return Some(noisy.mean_variances(&[output])[0].iter().sum()),
        IndexWindow::Mean { window } | IndexWindow::Relative { window, .. } => (seconds(window), None),
        IndexWindow::Difference { window, shift, .. } => (seconds(window), Some(seconds(shift))),
    };
    let by_source = noisy.window_variances(output, Window { length, separation }).ok()?;
    let variance = |of: &WindowVariances| match error.index {
        IndexWindow::Absolute => of.total,
        IndexWindow::Mean { .. } => of.mpe,
        IndexWindow::Relative { convention: WindowConvention::Uniform, .. } => of.rpe_uniform,
        IndexWindow::Relative { convention: WindowConvention::End, .. } => of.rpe_end,
        IndexWindow::Relative { convention: WindowConvention::Middle, .. } => of.rpe_middle,
        IndexWindow::Difference { .. } => of.pde,
    };
    Some(by_source.iter().map(variance).sum())
}
