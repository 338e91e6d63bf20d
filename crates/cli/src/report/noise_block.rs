//! Block of the noise: a row for each mode of operation with a linear law, or for each output without modes.

use flexsc_core::analysis::noise::{NoiseReport, OutputNoise, RequiredContrast};
use flexsc_core::formats::reader_units::{ReaderUnits, four_digits, number, percent, time_span};
use flexsc_core::requirement_verdict::Decision;

use super::html::{HtmlCell, HtmlRow, HtmlTable, cell, command, head, number_head, picture};
use super::mode_analysis::{Analysed, Refused, reasons, replaced};
use super::study::Study;
use crate::results::Results;
use crate::spectrum::SpectrumResults;

/// Returns the block, and a sentence on the largest source of noise.
pub fn html(
    study: &Study,
    (found, refused): (&[Analysed<SpectrumResults>], &[Refused]),
) -> (String, Option<String>) {
    let mut sentence = None;
    let has_modes = !study.scenario.mode.is_empty();
    let units = ReaderUnits::default();
    let Some(first) = found.first() else {
        return (reasons(refused, "the loop") + &command(&study.command("spectrum", "")), None);
    };
    let source_cells = |output: &OutputNoise, sources: &[String]| -> [HtmlCell; 2] {
        let all = largest_sources(output, sources);
        [0, 1].map(|place| {
            all.get(place).map_or_else(HtmlCell::default, |(name, part)| cell(&share(*part)).small(name))
        })
    };
    let mut heads = vec![head(if has_modes { "Mode" } else { "Output" })];
    let mut rows = Vec::new();
    if has_modes {
        // Each output is a column, in which all modes have one unit.
        heads.extend(
            first.results.report().outputs.iter().map(|output| number_head(format!("{} rms", output.output))),
        );
        for own in found {
            let report = own.results.report();
            let mut cells = vec![cell(&own.mode)];
            cells.extend(report.outputs.iter().map(|output| cell(&units.quantity(output.rms, &output.unit))));
            if let Some(output) = report.outputs.iter().max_by(|a, b| a.rms.total_cmp(&b.rms)) {
                cells.extend(source_cells(output, &report.sources));
            }
            rows.push(HtmlRow { cells, is_missed: false });
        }
    } else {
        heads.push(number_head("Rms"));
        let report = first.results.report();
        for output in &report.outputs {
            let mut cells = vec![cell(&output.output), cell(&units.quantity(output.rms, &output.unit))];
            cells.extend(source_cells(output, &report.sources));
            rows.push(HtmlRow { cells, is_missed: false });
        }
    }
    heads.extend([number_head("Largest source, of the variance"), number_head("Second")]);
    let mut html = HtmlTable { heads, rows, is_cards: false }.html();
    // The mode with the least noise is that of precise pointing.
    let angle = |own: &&Analysed<SpectrumResults>| {
        own.results.report().outputs.iter().map(|output| output.rms).fold(0.0, f64::max)
    };
    if let Some(own) = found.iter().min_by(|a, b| angle(a).total_cmp(&angle(b))) {
        let report = own.results.report();
        let largest = report
            .outputs
            .iter()
            .filter(|output| output.unit == "rad")
            .max_by(|a, b| a.rms.total_cmp(&b.rms));
        if let Some((output, (source, part))) = largest
            .and_then(|output| Some((output, largest_sources(output, &report.sources).into_iter().next()?)))
        {
            let mode = if has_modes { format!(" in mode {}", own.mode) } else { String::new() };
            sentence = Some(format!(
                "Noise alone, without disturbances, leaves {}{mode} {} rms, {} of its variance from {source}.",
                output.output,
                units.quantity(output.rms, &output.unit),
                share(part)
            ));
        }
        if let Some(svg) = own.results.figures().first().and_then(|(_, drawn)| drawn.svg().ok()) {
            let mode = if has_modes { format!(", mode {}", own.mode) } else { String::new() };
            html +=
                &picture(&svg, &format!("Noise by frequency{mode}: density, and rms up to each frequency."));
        }
        html += &contrast_table(report);
        html += &replaced(study, found);
        html += &reasons(refused, "the loop");
        html += &command(&study.command("spectrum", &own.options("")));
    }
    (html, sentence)
}

/// Returns the table of the contrasts of images that requirements ask for; empty without one.
fn contrast_table(report: &NoiseReport) -> String {
    if report.contrasts.is_empty() {
        return String::new();
    }
    let row = |own: &RequiredContrast| {
        let exposure = own.exposure_s.map_or_else(|| "a long exposure".to_owned(), time_span);
        let at = format!("{} cycles/rad, {exposure}, {}", four_digits(own.spatial_frequency), own.output);
        let costly = own.costs.first().map_or_else(HtmlCell::default, |cost| {
            cell(&cost.source).small(&format!("without it {:.4}", cost.without))
        });
        let cells = vec![
            cell(&own.name).small(&at),
            cell(&format!("{:.4}", own.mtf)),
            cell(&format!("at least {:.4}", own.least)),
            cell(&format!("{:.4}", own.margin())),
            HtmlCell::verdict(if own.met { Decision::Met } else { Decision::Missed }),
            costly,
        ];
        HtmlRow { cells, is_missed: !own.met }
    };
    let heads = vec![
        head("Contrast (MTF) of an image"),
        number_head("Value"),
        number_head("Limit"),
        number_head("Margin"),
        head("Verdict"),
        head("Costs most"),
    ];
    HtmlTable { heads, rows: report.contrasts.iter().map(row).collect(), is_cards: true }.html()
}

/// Returns the sources of an output's noise with their shares of the variance, the largest first.
fn largest_sources<'a>(output: &OutputNoise, sources: &'a [String]) -> Vec<(&'a str, f64)> {
    let variance = output.rms * output.rms;
    let parts = sources.iter().zip(&output.rms_by_source);
    let mut parts: Vec<(&str, f64)> =
        parts.map(|(name, rms)| (name.as_str(), rms * rms / variance)).collect();
    parts.retain(|(_, part)| part.is_finite() && *part >= 5e-4);
    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
    parts
}

/// Returns a share of a variance in whole per cent.
fn share(part: f64) -> String {
    if part > 0.1 { percent(part) } else { format!("{} %", number(100.0 * part)) }
}
