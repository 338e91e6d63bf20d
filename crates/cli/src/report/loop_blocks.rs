//! Blocks of margins and noise: a row for each mode of operation with a linear law, or for each loop without modes.

use std::f64::consts::PI;

use flexsc_core::analysis::margins::SignalMargins;
use flexsc_core::analysis::noise::OutputNoise;
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::settling_time::SettlingTime;
use flexsc_core::formats::reader_units::{ReaderUnits, number, percent};
use flexsc_core::worst_case::{MarginKind, MarginSearch};

use super::html::{
    HtmlCell, HtmlRow, HtmlTable, cell, command, escaped, head, number_head, paragraph, picture,
};
use super::study::Study;
use crate::error::CliError;
use crate::results::Results;
use crate::{Verb, margins, spectrum, stop};

/// Least gain margin (dB) and phase margin (deg) of the verdict.
const MASK: [f64; 2] = [6.0, 30.0];
/// Number of loops of the search for the least margin.
const SEARCHED: usize = 100;

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

/// Analysis of a mode of operation that succeeded.
struct Analysed<T> {
    /// Name of the mode; empty without modes.
    mode: String,
    /// Options of the command, and whether it is at rest with the sensors that have a linear model.
    options: String,
    is_at_rest: bool,
    results: T,
}

/// Mode of operation without a linear loop, and the reason.
struct Refused {
    mode: String,
    why: String,
}

/// Least margins of a loop or of several.
struct LeastMargins {
    crossover_rad_s: f64,
    gain_db: f64,
    phase_deg: f64,
    delay_s: f64,
    modulus: f64,
    settling_s: f64,
}

/// Computes both blocks; `searches` for the least margins over the uncertain keys too.
pub fn blocks(study: &Study, searches: bool) -> Result<LoopBlocks, CliError> {
    let mut made = LoopBlocks::default();
    let (found, refused) = each_mode(study, "margins", |verb| match verb {
        Verb::Margins(args) => margins::results(&args.scenario.load()?, &args),
        _ => Err(CliError::Arguments(String::new())),
    })?;
    made.margins = margins_html((study, searches), (&found, &refused), &mut made.summary)?;
    if found.is_empty() {
        made.refused.push("Margins");
    }
    let (found, refused) = each_mode(study, "spectrum", |verb| match verb {
        Verb::Spectrum(args) => spectrum::results(&args.scenario.load()?, &args),
        _ => Err(CliError::Arguments(String::new())),
    })?;
    made.noise = noise_html(study, &found, &refused, &mut made.summary);
    if found.is_empty() {
        made.refused.push("Noise");
    }
    Ok(made)
}

/// Analyses each mode of operation, or the scenario without modes: as it is, or else at rest with the sensors that have a linear model.
fn each_mode<T>(
    study: &Study,
    verb: &str,
    analyse: impl Fn(Verb) -> Result<T, CliError>,
) -> Result<(Vec<Analysed<T>>, Vec<Refused>), CliError> {
    let scenario = &study.scenario;
    let modes: Vec<Option<String>> = if scenario.mode.is_empty() {
        vec![None]
    } else {
        scenario.mode.iter().map(|mode| Some(mode.name.clone())).collect()
    };
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for (index, mode) in modes.into_iter().enumerate() {
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        let name = mode.clone().unwrap_or_default();
        let words: Vec<&str> = match &mode {
            Some(name) => vec![verb, "--mode", name],
            None => vec![verb],
        };
        let attempt = |set: &[String]| study.verb(&words, set).and_then(&analyse);
        let options = |set: &[String]| {
            let mode = mode.iter().map(|name| format!("--mode {name}"));
            mode.chain(set.iter().map(|pair| format!("--set '{pair}'"))).collect::<Vec<_>>().join(" ")
        };
        let at_rest = at_rest(study, index);
        let done = attempt(&[]).map(|results| (Vec::new(), results)).or_else(|first| {
            if at_rest.is_empty() {
                return Err(first);
            }
            attempt(&at_rest).map(|results| (at_rest, results)).map_err(|_| first)
        });
        match done {
            Ok((set, results)) => found.push(Analysed {
                mode: name,
                options: options(&set),
                is_at_rest: !set.is_empty(),
                results,
            }),
            Err(CliError::Interrupted(text)) => return Err(CliError::Interrupted(text)),
            Err(failure) => refused.push(Refused { mode: name, why: short_reason(&failure.to_string()) }),
        }
    }
    Ok((found, refused))
}

/// Returns the kinds of the sensors of attitude and rates, which have a linear model, each once.
fn linear_sensors(study: &Study) -> Vec<&'static str> {
    let mut kinds = Vec::new();
    for own in study.scenario.sensor.iter().filter(|own| own.measures_motion() && !own.measures_vector()) {
        if !kinds.contains(&own.kind()) {
            kinds.push(own.kind());
        }
    }
    kinds
}

/// Returns the keys that put the scenario at rest with the sensors that have a linear model; none without a spacecraft or
/// such sensors.
fn at_rest(study: &Study, mode: usize) -> Vec<String> {
    let kinds = linear_sensors(study);
    if study.scenario.spacecraft.is_none() || kinds.is_empty() {
        return Vec::new();
    }
    let mut set = vec!["spacecraft.rate=[0, 0, 0]".to_owned()];
    if !study.scenario.mode.is_empty() {
        let kinds: Vec<String> = kinds.iter().map(|kind| format!("\"{kind}\"")).collect();
        set.insert(0, format!("mode[{mode}].sensors=[{}]", kinds.join(", ")));
    }
    set
}

/// Returns the reason of an error in one line, without the file and the hint.
fn short_reason(text: &str) -> String {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    first.split_once(": ").map_or(first, |(_, rest)| rest).trim().to_owned()
}

/// Returns the reasons for which modes have no numbers, as paragraphs.
fn reasons(refused: &[Refused], what: &str) -> String {
    let one = |own: &Refused| {
        let name = if own.mode.is_empty() { what.to_owned() } else { format!("mode {}", own.mode) };
        format!(
            "<p class=\"refused\">No numbers for {}: {}.</p>\n",
            escaped(&name),
            escaped(own.why.trim_end_matches('.'))
        )
    };
    refused.iter().map(one).collect()
}

/// Returns the sentence on sensors that were replaced, if any were.
fn replaced<T>(study: &Study, found: &[Analysed<T>]) -> String {
    let names: Vec<&str> = found.iter().filter(|own| own.is_at_rest).map(|own| own.mode.as_str()).collect();
    match &names[..] {
        [] => String::new(),
        [""] => paragraph("At rest: the motion at the start has no linear model."),
        names => paragraph(&format!(
            "At rest, with {} alone: another sensor of {} has no linear model.",
            linear_sensors(study).join(" and ").replace('_', " "),
            names.join(", ")
        )),
    }
}

/// Returns the name of a loop without the point at which it is cut open.
fn name_of_loop(own: &SignalMargins) -> String {
    own.signal.trim_start_matches("command_").to_owned()
}

fn least(all: &[SignalMargins], settling: &[SettlingTime]) -> LeastMargins {
    let decibel = |factor: f64| 20.0 * factor.log10().abs();
    let fold = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let gains = all.iter().flat_map(|own| {
        let below = (own.gain_below > 0.0).then(|| decibel(own.gain_below));
        below.into_iter().chain(own.gain_above.map(decibel))
    });
    let crossings = all.iter().flat_map(|own| own.crossings.gain.iter().map(|at| at.frequency_rad_s));
    let signals: Vec<&str> = all.iter().map(|own| own.signal.as_str()).collect();
    let settling = settling.iter().filter(|own| all.len() > 1 || signals[0].contains(own.step));
    LeastMargins {
        crossover_rad_s: crossings.fold(0.0, f64::max),
        gain_db: fold(&mut gains.into_iter()),
        phase_deg: fold(&mut all.iter().map(|own| own.phase_rad.abs()).filter(|own| *own < PI)).to_degrees(),
        delay_s: fold(&mut all.iter().filter_map(|own| own.delay_s)),
        modulus: fold(&mut all.iter().map(|own| own.modulus.margin)),
        settling_s: settling.map(|own| own.time_s).fold(0.0, f64::max),
    }
}

impl LeastMargins {
    fn is_met(&self) -> bool {
        self.gain_db >= MASK[0] && self.phase_deg >= MASK[1]
    }

    fn row(&self, name: &str, shows_delay: bool) -> HtmlRow {
        let text =
            |value: f64| cell(&if value.is_finite() && value > 0.0 { number(value) } else { "-".to_owned() });
        let hertz = ReaderUnits::default().frequency().value(self.crossover_rad_s);
        let mut cells = vec![
            cell(name),
            text(hertz),
            text(self.gain_db).hot(self.gain_db < MASK[0]),
            text(self.phase_deg).hot(self.phase_deg < MASK[1]),
        ];
        cells.extend(shows_delay.then(|| text(self.delay_s)));
        cells.extend([text(self.modulus), text(self.settling_s), HtmlCell::verdict(self.is_met())]);
        HtmlRow { cells, is_missed: !self.is_met() }
    }
}

fn margins_html(
    (study, searches): (&Study, bool),
    (found, refused): (&[Analysed<margins::LoopMargins>], &[Refused]),
    summary: &mut LoopSummary,
) -> Result<String, CliError> {
    let has_modes = !study.scenario.mode.is_empty();
    let mut rows: Vec<(String, LeastMargins, usize)> = Vec::new();
    for (place, own) in found.iter().enumerate() {
        let all = own.results.margins();
        let loops = &all.stability.loops;
        if has_modes {
            rows.push((own.mode.clone(), least(loops, &all.settling), place));
        } else {
            let each = loops
                .iter()
                .map(|one| (name_of_loop(one), least(std::slice::from_ref(one), &all.settling), place));
            rows.extend(each);
        }
    }
    let mut html = String::new();
    let Some((name, worst, place)) = rows
        .iter()
        .min_by(|a, b| a.1.gain_db.total_cmp(&b.1.gain_db).then(a.1.phase_deg.total_cmp(&b.1.phase_deg)))
    else {
        return Ok(reasons(refused, "the loop") + &command(&study.command("margins", "")));
    };
    let shows_delay = rows.iter().any(|(_, own, _)| own.delay_s.is_finite());
    let mut heads = vec![
        head(if has_modes { "Mode" } else { "Loop" }),
        number_head("Crossover, Hz"),
        number_head("Gain, dB"),
        number_head("Phase, deg"),
    ];
    heads.extend(shows_delay.then(|| number_head("Added delay, s")));
    heads.extend([
        number_head("Modulus"),
        number_head("Settling, s"),
        head(&format!("{} dB and {} deg", MASK[0], MASK[1])),
    ]);
    let table = rows.iter().map(|(name, own, _)| own.row(name, shows_delay)).collect();
    html += &HtmlTable { heads, rows: table, is_cards: false }.html();
    let phase = rows.iter().map(|(_, own, _)| own.phase_deg).fold(f64::INFINITY, f64::min);
    let gain = if worst.gain_db.is_finite() {
        format!("{} dB", number(worst.gain_db))
    } else {
        "any gain".to_owned()
    };
    let phase = if phase.is_finite() { format!("{} deg", number(phase)) } else { "any phase".to_owned() };
    let of = if has_modes { format!(" (least gain in mode {name})") } else { String::new() };
    summary.margins = Some(format!("All loops have at least {gain} and {phase}{of}."));
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
    html += &command(&study.command("margins", &own.options));
    if searches {
        html += &worst_paragraph(study, own)?;
    }
    Ok(html)
}

/// Returns the least modulus margin over the uncertain keys in the mode of the least margins, with the command.
fn worst_paragraph(study: &Study, own: &Analysed<margins::LoopMargins>) -> Result<String, CliError> {
    if study.scenario.uncertain.is_empty() {
        return Ok(String::new());
    }
    let mut words = vec!["margins"];
    if !own.mode.is_empty() {
        words.extend(["--mode", &own.mode]);
    }
    let set = if own.is_at_rest {
        let place = study.scenario.mode.iter().position(|mode| mode.name == own.mode).unwrap_or(0);
        at_rest(study, place)
    } else {
        Vec::new()
    };
    let Verb::Margins(args) = study.verb(&words, &set)? else { return Ok(String::new()) };
    let search = MarginSearch { kind: MarginKind::Modulus, opened: LoopBreak::Command, most_loops: SEARCHED };
    let found = search.run(&args.scenario.load()?, stop::stop_requested);
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
    let options = format!("--margin modulus --points {SEARCHED} {}", own.options);
    Ok(paragraph(&text) + &command(&study.command("worst", options.trim())))
}

fn noise_html(
    study: &Study,
    found: &[Analysed<spectrum::SpectrumResults>],
    refused: &[Refused],
    summary: &mut LoopSummary,
) -> String {
    let has_modes = !study.scenario.mode.is_empty();
    let units = ReaderUnits::default();
    let Some(first) = found.first() else {
        return reasons(refused, "the loop") + &command(&study.command("spectrum", ""));
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
    let angle = |own: &&Analysed<spectrum::SpectrumResults>| {
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
            summary.accuracy = Some(format!(
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
        html += &replaced(study, found);
        html += &reasons(refused, "the loop");
        html += &command(&study.command("spectrum", &own.options));
    }
    html
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_one_line_without_its_file() {
        let text = "cubesat-day: `law`: is not linear\n\nhint: take another";
        assert_eq!(short_reason(text), "`law`: is not linear");
    }
}
