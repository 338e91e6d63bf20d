//! Analyses of the loops for the blocks of margins and noise.

use super::mode_analysis::each_mode;
use super::study::Study;
use super::{margins_block, noise_block};
use crate::error::CliError;
use crate::{Verb, margins, progress, spectrum};

/// Sentences of the conclusions on the loops.
#[derive(Default)]
pub struct LoopSummary {
    /// Least margins of all modes.
    pub margins: Option<String>,
    /// Largest source of noise.
    pub accuracy: Option<String>,
}

/// Blocks of margins and noise, as HTML.
#[derive(Default)]
pub struct LoopBlocks {
    pub margins: String,
    pub noise: String,
    pub summary: LoopSummary,
    /// Analyses without numbers.
    pub refused: Vec<&'static str>,
}

/// Computes both blocks; `searches` for the least margins over the uncertain keys too.
pub fn blocks(study: &Study, searches: bool) -> Result<LoopBlocks, CliError> {
    let mut made = LoopBlocks::default();
    let (margins, noise) = (margins(study, searches)?, noise(study)?);
    made.refused.extend(margins.is_refused.then_some("Margins"));
    made.refused.extend(noise.is_refused.then_some("Noise"));
    (made.margins, made.summary.margins) = (margins.html, margins.sentence);
    (made.noise, made.summary.accuracy) = (noise.html, noise.sentence);
    Ok(made)
}

/// Block of one analysis of the loops.
pub struct LoopBlock {
    pub html: String,
    /// Sentence of the conclusions.
    sentence: Option<String>,
    /// True if no mode of operation has a linear loop.
    is_refused: bool,
}

/// Computes the block of the margins; `searches` for the least over the uncertain keys too.
pub fn margins(study: &Study, searches: bool) -> Result<LoopBlock, CliError> {
    progress::begin_stage("the margins");
    let words = ["margins", "--mask", margins_block::MASK];
    let (found, refused) = each_mode(study, &words, |verb, scenario| match verb {
        Verb::Margins(args) => margins::results(&args.scenario.in_mode(scenario)?, &args),
        _ => Err(CliError::Arguments(String::new())),
    })?;
    let (html, sentence) = margins_block::html((study, searches), (&found, &refused))?;
    Ok(LoopBlock { html, sentence, is_refused: found.is_empty() })
}

/// Computes the block of the noise.
pub fn noise(study: &Study) -> Result<LoopBlock, CliError> {
    progress::begin_stage("the noise");
    let (found, refused) = each_mode(study, &["spectrum"], |verb, scenario| match verb {
        Verb::Spectrum(args) => spectrum::results(&args.scenario.in_mode(scenario)?, &args),
        _ => Err(CliError::Arguments(String::new())),
    })?;
    let (html, sentence) = noise_block::html(study, (&found, &refused));
    Ok(LoopBlock { html, sentence, is_refused: found.is_empty() })
}
