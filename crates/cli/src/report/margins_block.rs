//! Block of the margins: a row for each mode of operation with a linear law, or for each loop without modes.

use std::f64::consts::PI;

use flexsc_core::analysis::margins::SignalMargins;
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::settling_time::SettlingTime;
use flexsc_core::formats::reader_units::{ReaderUnits, number};
use flexsc_core::requirement_verdict::Decision;
use flexsc_core::worst_case::{MarginKind, MarginSearch};

use super::html::{HtmlCell, HtmlRow, HtmlTable, cell, command, head, number_head, paragraph, picture};
use super::mode_analysis::{Analysed, Refused, reasons, replaced};
use super::study::Study;
use crate::error::CliError;
use crate::margins::{LoopMargins, NicholsMask};
use crate::results::Results;
use crate::{Verb, progress, stop};

/// Mask of the verdict, as `flexsc margins` takes it.
pub const MASK: &str = "6 dB, 30 deg";
/// Number of loops of the search for the least margin.
const SEARCHED: usize = 40;

/// Least margins of a loop or of several.
struct LeastMargins {
    crossover_rad_s: f64,
    gain_db: f64,
    phase_deg: f64,
    delay_s: f64,
    modulus: f64,
    settling_s: f64,
    /// Whether no loop is within the mask.
    is_clear: bool,
}

/// Returns the name of a loop without the point at which it is cut open.
fn name_of_loop(own: &SignalMargins) -> String {
    own.signal.trim_start_matches("command_").to_owned()
}

fn least(all: &[SignalMargins], settling: &[SettlingTime], is_clear: bool) -> LeastMargins {
    let decibel = |factor: f64| 20.0 * factor.log10().abs();
    let fold = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let gains = all.iter().flat_map(|own| {
        let below = (own.gain_below > 0.0).then(|| decibel(own.gain_below));
        below.into_iter().chain(own.gain_above.map(decibel))
    });
    let crossings = all.iter().flat_map(|own| &own.crossings.gain);
    // The crossover is where the phase margin is that of the row.
    let crossover = crossings.min_by(|a, b| a.phase_rad.abs().total_cmp(&b.phase_rad.abs()));
    let signals: Vec<&str> = all.iter().map(|own| own.signal.as_str()).collect();
    let settling = settling.iter().filter(|own| all.len() > 1 || signals[0].contains(own.step));
    LeastMargins {
        crossover_rad_s: crossover.map_or(0.0, |at| at.frequency_rad_s),
        gain_db: fold(&mut gains.into_iter()),
        phase_deg: fold(&mut all.iter().map(|own| own.phase_rad.abs()).filter(|own| *own < PI)).to_degrees(),
        delay_s: fold(&mut all.iter().filter_map(|own| own.delay_s)),
        modulus: fold(&mut all.iter().map(|own| own.modulus.margin)),
        settling_s: settling.map(|own| own.time_s).fold(0.0, f64::max),
        is_clear,
    }
}

impl LeastMargins {
    fn row(&self, name: &str, mask: NicholsMask, shows_delay: bool) -> HtmlRow {
        let text =
            |value: f64| cell(&if value.is_finite() && value > 0.0 { number(value) } else { "-".to_owned() });
        let hertz = ReaderUnits::default().frequency().value(self.crossover_rad_s);
        let mut cells = vec![
            cell(name),
            text(hertz),
            text(self.gain_db).hot(self.gain_db < mask.gain_db),
            text(self.phase_deg).hot(self.phase_deg < mask.phase_deg),
        ];
        cells.extend(shows_delay.then(|| text(self.delay_s)));
        let verdict = if self.is_clear { Decision::Met } else { Decision::Missed };
        cells.extend([text(self.modulus), text(self.settling_s), HtmlCell::verdict(verdict)]);
        HtmlRow { cells, is_missed: !self.is_clear }
    }
}

/// Returns the block, and a sentence on the least margins; `searches` for the least over the uncertain keys too.
pub fn html(
    (study, searches): (&Study, bool),
    (found, refused): (&[Analysed<LoopMargins>], &[Refused]),
) -> Result<(String, Option<String>), CliError> {
    let has_modes = !study.scenario.mode.is_empty();
    let mask: NicholsMask = MASK.parse().map_err(CliError::Arguments)?;
    let mut rows: Vec<(String, LeastMargins, usize)> = Vec::new();
    for (place, own) in found.iter().enumerate() {
        let all = own.results.margins();
        let (loops, violations) = (&all.stability.loops, own.results.mask_violations());
        if has_modes {
            let is_clear = violations.iter().all(Option::is_none);
            rows.push((own.mode.clone(), least(loops, &all.settling, is_clear), place));
        } else {
            for (one, violation) in loops.iter().zip(violations) {
                let own = least(std::slice::from_ref(one), &all.settling, violation.is_none());
                rows.push((name_of_loop(one), own, place));
            }
        }
    }
    let mut html = String::new();
    let Some((name, worst, place)) = rows
        .iter()
        .min_by(|a, b| a.1.gain_db.total_cmp(&b.1.gain_db).then(a.1.phase_deg.total_cmp(&b.1.phase_deg)))
    else {
        return Ok((reasons(refused, "the loop") + &command(&study.command("margins", "")), None));
    };
    let shows_delay = rows.iter().any(|(_, own, _)| own.delay_s.is_finite());
    let mut heads = vec![
        head(if has_modes { "Mode" } else { "Loop" }),
        number_head("Crossover, Hz"),
        number_head("Gain, dB"),
        number_head("Phase, deg"),
    ];
    heads.extend(shows_delay.then(|| number_head("Added delay, s")));
    heads.extend([number_head("Modulus"), number_head("Settling, s"), head(&format!("Mask {MASK}"))]);
    let table = rows.iter().map(|(name, own, _)| own.row(name, mask, shows_delay)).collect();
    html += &HtmlTable { heads, rows: table, is_cards: false }.html();
    let phase = rows.iter().map(|(_, own, _)| own.phase_deg).fold(f64::INFINITY, f64::min);
    let gain = if worst.gain_db.is_finite() {
        format!("{} dB", number(worst.gain_db))
    } else {
        "any gain".to_owned()
    };
    let phase = if phase.is_finite() { format!("{} deg", number(phase)) } else { "any phase".to_owned() };
    let of = if has_modes { format!(" (least gain in mode {name})") } else { String::new() };
    let sentence = Some(format!("All loops have at least {gain} and {phase}{of}."));
    let own = &found[*place];
    let drawn = own.results.figures();
    let nichols = drawn.iter().find(|(file, _)| file.contains("nichols"));
    if let Some(svg) = nichols.and_then(|(_, drawn)| drawn.svg().ok()) {
        let of = if has_modes { format!(", mode {}", own.mode) } else { String::new() };
        html += &picture(
            &svg,
            &format!("Nichols diagram of the loops{of}, cut open at the command, with the others closed."),
        );
    }
    html += &replaced(study, found);
    html += &reasons(refused, "the loop");
    html += &command(&study.command("margins", &own.options(&format!("--mask '{MASK}'"))));
    if searches {
        html += &worst_paragraph(study, own)?;
    }
    Ok((html, sentence))
}

/// Returns the least modulus margin over the uncertain keys in the mode of the least margins, with the command.
fn worst_paragraph(study: &Study, own: &Analysed<LoopMargins>) -> Result<String, CliError> {
    if study.scenario.uncertain.is_empty() {
        return Ok(String::new());
    }
    let mut words = vec!["margins"];
    if !own.mode.is_empty() {
        words.extend(["--mode", &own.mode]);
    }
    let (Verb::Margins(args), scenario) = study.analysis(&words, &own.at_rest)? else {
        return Ok(String::new());
    };
    progress::begin_stage("the least margin over the uncertain keys");
    let search = MarginSearch { kind: MarginKind::Modulus, opened: LoopBreak::Command, most_loops: SEARCHED };
    let found = search.run(&args.scenario.in_mode(scenario)?, stop::stop_requested);
    if stop::stop_requested() {
        return Err(CliError::Interrupted(String::new()));
    }
    let Ok(case) = found else { return Ok(String::new()) };
    let mode = if own.mode.is_empty() { String::new() } else { format!(" in mode {}", own.mode) };
    let found = if case.is_unstable {
        "an unstable loop".to_owned()
    } else {
        format!("a modulus margin of {}, nominal {}", number(case.value()), number(case.nominal()))
    };
    let text =
        format!("The worst that a search of {SEARCHED} loops over the uncertain keys finds{mode}: {found}.");
    let options = own.options(&format!("--margin modulus --points {SEARCHED}"));
    Ok(paragraph(&text) + &command(&study.command("worst", &options)))
}
