//! Broadband forces and torques on a loop: the motion of its outputs as many lines, each with the power of a small band.
//!
//! A source of the one-sided density S drives each output with S |H_n|² at the frequency of the load and at the aliases that sampling
//! makes of it. Over frequency this is integrated by Kronrod's rule, between the knots of the densities and around the resonances of
//! body and loop, halving intervals until nothing changes. The nodes are the lines: every index is a sum over them.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::number;
use flexsc_numerics::quadrature::kronrod;
use flexsc_spacecraft::load_density::LoadDensity;
use rayon::prelude::*;

use super::lines::LineLoop;
use super::measured_loads::VibrationLoad;
use super::source_motion::SourceMotion;
use super::spectral_line::SpectralLine;
use super::transfer::{LoadResponse, LoopResonance, LoopTransfer};

/// Lowest frequency, relative to the lowest corner and resonance, and highest, relative to the highest.
const LOWEST: f64 = 1e-3;
const HIGHEST: f64 = 30.0;
/// Lowest frequency, relative to the lowest corner: below it a free body has no larger part of the motion than this.
const LOWEST_PART: f64 = 1e-5;
/// Ratio of the distances of breaks from a resonance, in half widths, and ratio of frequencies of breaks elsewhere.
const GRADE: f64 = 5.0;
const APART: f64 = 3.0;
/// Ratio of frequencies within which breaks follow a resonance.
const NEAR: f64 = 2.0;
/// Difference of the two rules, relative to the whole, below which an interval counts: the finer one is then far closer.
const DIFFERENCE: f64 = 1e-6;
/// Part of what the measurements see by all aliases of resonances, below which one has no breaks of its own.
const SMALL: f64 = 1e-10;
/// Mean square relative to the largest of all outputs, below which an output is moved by rounding alone.
const STILL: f64 = 1e-24;
/// Largest number of halvings of an interval, and of intervals.
const HALVINGS: usize = 12;
const MOST_INTERVALS: usize = 4000;
/// Largest number of lines over all nodes, outputs and loads.
const MOST_LINES: usize = 30_000_000;
/// Sum of the differences of the two rules, relative to the whole, up to which an integral is an answer: the finer one is far closer.
const TOLERATED: f64 = 0.05;

/// Broadband load at a point of the body.
pub(super) struct BroadbandSource<'a> {
    /// Key of the source.
    pub key: String,
    pub density: &'a LoadDensity,
    /// Numbers of its loads.
    pub loads: Vec<usize>,
}

/// Response at one node of the integral over frequency.
struct Node {
    frequency: f64,
    weight: f64,
    responses: Vec<LoadResponse>,
}

/// Interval of the integral over frequency (rad/s), and its nodes.
struct Interval {
    ends: [f64; 2],
    nodes: Vec<Node>,
    /// Of each output and source, the mean square, and its difference by the coarser rule.
    powers: Vec<[f64; 2]>,
}

/// Returns the frequencies of the loads (Hz), and the motion of each output under each source; `others` are further frequencies (Hz) at
/// which the densities are asked for.
pub(super) fn broadband(
    lines: &LineLoop<'_>,
    outputs: &[usize],
    loads: &[VibrationLoad],
    sources: Vec<BroadbandSource<'_>>,
    others: &[f64],
) -> Result<(Vec<f64>, Vec<Vec<SourceMotion>>), ConfigError> {
    let integral =
        Integral { transfer: LoopTransfer::new(lines, outputs, loads)?, sources, outputs: outputs.len() };
    let mut nodes: Vec<Node> =
        integral.intervals()?.into_iter().flat_map(|interval| interval.nodes).collect();
    let [least, most] = integral.ends();
    let beside = |hertz: &f64| {
        // Beyond the ends of the integral the motion is next to 0.
        let is_within = (least..=most).contains(&(TAU * hertz));
        let none = Node { frequency: TAU * hertz, weight: 0.0, responses: Vec::new() };
        if is_within { integral.node(TAU * hertz, 0.0) } else { Ok(none) }
    };
    nodes.extend(others.par_iter().map(beside).collect::<Result<Vec<_>, _>>()?);
    nodes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    let motion = |output: usize, source: &BroadbandSource<'_>| {
        let mut found = SourceMotion::default();
        let mut densities = Vec::with_capacity(nodes.len());
        for node in &nodes {
            if node.responses.is_empty() {
                densities.push(0.0);
                continue;
            }
            let own = integral.source_power(source, output, node.frequency, &node.responses);
            densities.push(own.density);
            found.sample_variance += node.weight * own.sampled;
            for (frequency_rad_s, power) in own.lines {
                let amplitude = f64::sqrt(2.0 * node.weight * power);
                if amplitude > 0.0 {
                    found.lines.push(SpectralLine { frequency_rad_s, amplitude });
                }
            }
        }
        SourceMotion { density: Some(densities), ..found }
    };
    let of_output = |output: usize| integral.sources.iter().map(|source| motion(output, source)).collect();
    let motions = (0..outputs.len()).map(of_output).collect();
    Ok((nodes.iter().map(|node| node.frequency / TAU).collect(), motions))
}

/// Motion of an output under one source at one frequency, per Hz.
struct SourcePower {
    /// Frequencies (rad/s) and powers.
    lines: Vec<(f64, f64)>,
    /// Power at the frequency of the load.
    density: f64,
    /// Power at the samples of the law.
    sampled: f64,
}

/// Integral over the frequency of the loads.
struct Integral<'a> {
    transfer: LoopTransfer<'a>,
    sources: Vec<BroadbandSource<'a>>,
    outputs: usize,
}

impl Integral<'_> {
    /// Returns the motion of an output under a source from the responses at a frequency.
    fn source_power(
        &self,
        source: &BroadbandSource<'_>,
        output: usize,
        frequency: f64,
        responses: &[LoadResponse],
    ) -> SourcePower {
        let densities = source.density.load_densities(frequency);
        let mut sum = SourcePower { lines: Vec::new(), density: 0.0, sampled: 0.0 };
        let before = source.loads.iter().map(|load| responses[*load].lines[output].clone()).collect();
        let behind = self.transfer.loaded.behind_mirror(output, before);
        for ((load, size), lines) in source.loads.iter().zip(densities).zip(behind) {
            let own = &responses[*load];
            sum.sampled += size
                * if self.transfer.has_mirror(output) {
                    lines.iter().map(|(_, amplitude)| amplitude.norm_sqr()).sum()
                } else {
                    own.sampled[output]
                };
            sum.density += lines.last().map_or(0.0, |(_, direct)| size * direct.norm_sqr());
            for (line, (at, amplitude)) in lines.into_iter().enumerate() {
                let (at, power) = (at.abs(), size * amplitude.norm_sqr());
                match sum.lines.get_mut(line) {
                    Some(known) if known.0 == at => known.1 += power,
                    _ => sum.lines.push((at, power)),
                }
            }
        }
        sum
    }

    /// Returns intervals over which the integral has converged.
    fn intervals(&self) -> Result<Vec<Interval>, ConfigError> {
        let breaks = self.breaks();
        let most = self.most_intervals(breaks.len())?;
        let mut waiting: Vec<[f64; 2]> = breaks.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let mut done: Vec<Interval> = Vec::new();
        for halving in 0..=HALVINGS {
            let found = waiting.par_iter().map(|ends| self.interval(*ends)).collect::<Result<Vec<_>, _>>()?;
            let mut totals = vec![0.0; self.outputs * self.sources.len()];
            for interval in done.iter().chain(&found) {
                interval.powers.iter().zip(&mut totals).for_each(|([power, _], total)| *total += power);
            }
            let still = STILL * totals.iter().copied().fold(0.0, f64::max);
            let is_coarse = |interval: &Interval| {
                let mut each = interval.powers.iter().zip(&totals);
                each.any(|([_, difference], total)| *difference > DIFFERENCE * total.max(still))
            };
            let may_halve = halving < HALVINGS && done.len() + 2 * found.len() < most;
            let (coarse, fine): (Vec<_>, Vec<_>) =
                found.into_iter().partition(|interval| may_halve && is_coarse(interval));
            done.extend(fine);
            waiting = coarse.iter().flat_map(|interval| halves(interval.ends)).collect();
            if waiting.is_empty() {
                break;
            }
        }
        self.check(&done)?;
        Ok(done)
    }

    /// Returns the largest number of intervals whose lines are not too many; `least` are needed.
    fn most_intervals(&self, least: usize) -> Result<usize, ConfigError> {
        let columns: usize = self.sources.iter().map(|source| source.loads.len()).sum();
        let each = kronrod().count() * columns * self.transfer.line_count();
        let most = (MOST_LINES / each.max(1)).min(MOST_INTERVALS);
        if least <= most {
            return Ok(most);
        }
        let why = format!(
            "makes {} lines of outputs with the aliases of law and mirror, at most {MOST_LINES} are possible: ask for fewer outputs, \
             or give the law and the mirror periods with a shorter common multiple",
            least * each
        );
        Err(ConfigError::new(&self.sources[0].key, why))
    }

    /// Checks that the integral has converged.
    fn check(&self, intervals: &[Interval]) -> Result<(), ConfigError> {
        let sum = |index: usize, part: usize| {
            intervals.iter().map(|interval| interval.powers[index][part]).sum::<f64>()
        };
        let all = 0..self.outputs * self.sources.len();
        let still = STILL * all.clone().map(|index| sum(index, 0)).fold(0.0, f64::max);
        for index in all {
            let [power, difference] = [sum(index, 0), sum(index, 1)];
            if difference > TOLERATED * power.max(still) {
                let why = format!(
                    "the mean square of an output is an integral over frequency that has not converged: two rules differ by {} % \
                     with {} intervals; has the body a motion that is hardly damped?",
                    number(100.0 * difference / power),
                    intervals.len()
                );
                return Err(ConfigError::new(&self.sources[index % self.sources.len()].key, why));
            }
        }
        Ok(())
    }

    /// Returns the responses at a frequency (rad/s).
    fn node(&self, frequency: f64, weight: f64) -> Result<Node, ConfigError> {
        Ok(Node { frequency, weight, responses: self.transfer.at(frequency)? })
    }

    /// Returns an interval with its nodes and powers.
    fn interval(&self, ends: [f64; 2]) -> Result<Interval, ConfigError> {
        let half = 0.5 * (ends[1] - ends[0]);
        let mut powers = vec![[0.0; 2]; self.outputs * self.sources.len()];
        let mut nodes = Vec::new();
        for [place, fine, coarse] in kronrod() {
            let frequency = ends[0] + half * (1.0 + place);
            let [weight, less] = [fine, coarse].map(|weight| weight * half / TAU);
            let node = self.node(frequency, weight)?;
            for (index, power) in powers.iter_mut().enumerate() {
                let (output, source) = (index / self.sources.len(), index % self.sources.len());
                let own = self.source_power(&self.sources[source], output, frequency, &node.responses);
                let all: f64 = own.lines.iter().map(|(_, power)| power).sum();
                power[0] += weight * all;
                power[1] += (weight - less) * all;
            }
            nodes.push(node);
        }
        for power in &mut powers {
            power[1] = power[1].abs();
        }
        Ok(Interval { ends, nodes, powers })
    }

    /// Returns those aliases by which the measurements see a part of all that is not small.
    fn measured(&self, aliases: Vec<(LoopResonance, f64)>) -> Vec<(LoopResonance, f64)> {
        let power = |([frequency, width], _): &(LoopResonance, f64)| -> Vec<f64> {
            let Some(squares) = self.transfer.sensed_squares(*frequency) else { return Vec::new() };
            let mut sums = vec![0.0; squares.nrows()];
            for source in &self.sources {
                for (load, density) in source.loads.iter().zip(source.density.load_densities(*frequency)) {
                    let own = squares.column(*load);
                    sums.iter_mut().zip(&own).for_each(|(sum, square)| *sum += width * density * square);
                }
            }
            sums
        };
        let powers: Vec<Vec<f64>> = aliases.iter().map(power).collect();
        let mut totals: Vec<f64> = Vec::new();
        for own in &powers {
            totals.resize(totals.len().max(own.len()), 0.0);
            totals.iter_mut().zip(own).for_each(|(total, power)| *total += power);
        }
        let counts = |own: &Vec<f64>| {
            own.is_empty() || own.iter().zip(&totals).any(|(power, total)| *power > SMALL * total)
        };
        aliases.into_iter().zip(powers).filter(|(_, own)| counts(own)).map(|(alias, _)| alias).collect()
    }

    /// Returns the knots of the densities (rad/s).
    fn knots(&self) -> Vec<f64> {
        self.sources.iter().flat_map(|source| source.density.knots()).collect()
    }

    /// Returns the ends of the integral (rad/s).
    fn ends(&self) -> [f64; 2] {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, 0.0], |[least, most], value| [value.min(least), value.max(most)])
        };
        let knots = self.knots();
        let [least, most] = ends(&mut knots.iter().copied());
        if self.sources.iter().all(|source| source.density.corners().is_none()) {
            return [least, most];
        }
        let resonances = self.transfer.resonances.iter().map(|[frequency, _]| *frequency);
        let [lowest, highest] = ends(&mut knots.iter().copied().chain(resonances));
        [(LOWEST * lowest).max(LOWEST_PART * least), HIGHEST * highest]
    }

    /// Returns the breaks of the integral (rad/s): knots of the densities, and around each resonance those that its width needs.
    fn breaks(&self) -> Vec<f64> {
        let knots = self.knots();
        let [least, most] = self.ends();
        let mut breaks: BTreeMap<u64, f64> = BTreeMap::new();
        let mut add = |frequency: f64| {
            if (least..=most).contains(&frequency) {
                breaks.insert(frequency.to_bits(), frequency);
            }
        };
        knots.iter().copied().chain([least, most]).for_each(&mut add);
        let mut frequency = least;
        while frequency < most {
            add(frequency);
            frequency *= APART;
        }
        let mut around = |frequency: f64, width: f64, reach: f64| {
            add(frequency);
            let mut distance = width.max(1e-9 * frequency);
            while distance < reach {
                add(frequency - distance);
                add(frequency + distance);
                distance *= GRADE;
            }
        };
        let (direct, aliases) = self.transfer.resonances_below(most);
        for [frequency, width] in direct {
            around(frequency, width, frequency * (1.0 - 1.0 / NEAR));
        }
        for ([frequency, width], fold) in self.measured(aliases) {
            let own = (frequency - fold).abs();
            around(frequency, width, own);
            around(fold, GRADE * own, self.transfer.turn);
        }
        let mut found: Vec<f64> = breaks.into_values().collect();
        found.dedup_by(|later, kept| *later - *kept < 1e-9 * *later);
        found
    }
}

fn halves([from, to]: [f64; 2]) -> [[f64; 2]; 2] {
    let middle = 0.5 * (from + to);
    [[from, middle], [middle, to]]
}
