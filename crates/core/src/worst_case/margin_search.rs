//! Worst case of a stability margin, by the loops at points of the uncertain keys.

use std::f64::consts::PI;

use schemars::JsonSchema;

use super::box_search::Assessed;
use super::loop_search::LoopSearch;
use super::{WorstCase, WorstCaseFault};
use flexsc_analysis::fine_mirror::mirror_margins;
use flexsc_analysis::margins::{StabilityMargins, UnstableLoop};
use flexsc_analysis::open_loop::LoopBreak;
use flexsc_analysis::structured_tuning::ScenarioLoops;
use flexsc_scenario::Scenario;

/// Badness of an unstable loop: above that of any margin, and larger the further its poles are outside.
const UNSTABLE: f64 = 1e6;

/// Margin of a loop, the least of all its signals.
#[derive(Copy, Clone, Debug, PartialEq, Eq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum MarginKind {
    /// Modulus margin of all signals together.
    Modulus,
    /// Disk margin of all signals together.
    Disk,
    /// Factor, above 1, by which the loop gain may rise or fall.
    Gain,
    /// Phase (rad).
    Phase,
    /// Delay (s).
    Delay,
}

/// Search for the least margin over the uncertain keys.
#[derive(Copy, Clone, Debug)]
pub struct MarginSearch {
    /// Margin.
    pub kind: MarginKind,
    /// Point at which the loops are cut open.
    pub opened: LoopBreak,
    /// Largest number of loops.
    pub most_loops: usize,
}

impl MarginKind {
    /// All margins.
    pub const ALL: [Self; 5] = [Self::Modulus, Self::Disk, Self::Gain, Self::Phase, Self::Delay];

    /// Returns the word of the margin.
    pub fn word(self) -> &'static str {
        match self {
            Self::Modulus => "modulus",
            Self::Disk => "disk",
            Self::Gain => "gain",
            Self::Phase => "phase",
            Self::Delay => "delay",
        }
    }

    /// Returns the unit of the margin.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Modulus | Self::Disk | Self::Gain => "",
            Self::Phase => "rad",
            Self::Delay => "s",
        }
    }

    /// Returns the least margin of the signals of a loop; infinity for one that no change of this kind makes unstable.
    pub fn least_margin(self, margins: &StabilityMargins) -> f64 {
        let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
        let signals = margins.loops.iter();
        match self {
            Self::Modulus => margins.modulus.margin,
            Self::Disk => margins.disk.alpha,
            Self::Gain => least(&mut signals.flat_map(|own| {
                // A loop that no smaller gain makes unstable has the factor 0 below.
                [own.gain_above.unwrap_or(f64::INFINITY), 1.0 / own.gain_below]
            })),
            Self::Phase => {
                least(&mut signals.map(|own| if own.phase_rad < PI { own.phase_rad } else { f64::INFINITY }))
            }
            Self::Delay => least(&mut signals.map(|own| own.delay_s.unwrap_or(f64::INFINITY))),
        }
    }
}

impl MarginSearch {
    /// Searches for the least margin over the uncertain keys of a scenario. `interrupted` returns true to stop.
    ///
    /// # Errors
    /// A scenario without a linear loop or without uncertain keys, no point with a margin, and an interruption.
    pub fn run(
        &self,
        scenario: &Scenario,
        interrupted: impl FnMut() -> bool,
    ) -> Result<WorstCase, WorstCaseFault> {
        let has_mirrors = scenario.line_of_sight.iter().any(|line| line.mirror.is_some());
        let at = |loops: &ScenarioLoops, numbers: &[f64]| -> Result<Assessed, String> {
            let opened = loops.loop_at(numbers, 0)?;
            let mirrors =
                if has_mirrors { mirror_margins(&loops.scenario(numbers, 0)?) } else { Ok(Vec::new()) };
            let all = StabilityMargins::new(&opened).and_then(|own| Ok([vec![own], mirrors?].concat()));
            Ok(match all {
                Ok(all) => {
                    let each = all.iter().map(|margins| self.kind.least_margin(margins));
                    let value = each.fold(f64::INFINITY, f64::min);
                    Assessed { badness: -value.min(UNSTABLE), value }
                }
                Err(UnstableLoop { spectral_radius, .. }) => {
                    Assessed { badness: UNSTABLE + spectral_radius.min(UNSTABLE), value: 0.0 }
                }
            })
        };
        let search = LoopSearch { opened: self.opened, most: self.most_loops, limit: UNSTABLE };
        let found = search.run(scenario, at, interrupted)?;
        Ok(WorstCase {
            quantity: format!("{} margin", self.kind.word()),
            unit: self.kind.unit().to_owned(),
            is_least: true,
            ..found
        })
    }
}
