//! Designs: the points of a campaign, which set values of keys, and the number of runs of each point.

use std::fmt::Write as _;

use flexsc_numerics::random::fnv1a;
use serde::{Deserialize, Serialize};
use toml::Value;

use super::Grid;
use super::sampling::{Dimension, MOST_DIMENSIONS, Sampling};

/// Largest number of points of a design.
pub const MOST_POINTS: u64 = 100_000_000;
/// Words of a description behind the number of replicas, and before the number of the run whose noise the points have.
const REPLICAS: &str = " runs of each point";
const NOISE: &str = "# each point with the noise from run ";

/// Largest number of values in a list or a table, which are held in memory.
pub const MOST_NUMBERS: usize = 10_000_000;

/// The points of a campaign. With blocks, the points are all combinations of the points of each, counted as numbers are: those
/// of the last block from point to point. Without, a point is the scenario itself, as often as it is wanted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Sampling of the `[uncertain]` keys.
    #[serde(default)]
    pub draws: Sampling,
    /// How many points a Latin hypercube of the `[uncertain]` keys has; 0 for others.
    #[serde(default)]
    pub hypercube: u64,
    /// Number of runs of each point, which differ only in their noise.
    pub replicas: u64,
    /// Number of the run whose noise the first run of every point has, and its replicas that of the numbers that follow; if
    /// not given, each run has the noise of its own number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_run: Option<u64>,
    /// Blocks whose points are combined.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blocks: Vec<DesignBlock>,
}

impl Default for Design {
    fn default() -> Self {
        Self { draws: Sampling::Random, hypercube: 0, replicas: 1, noise_run: None, blocks: Vec::new() }
    }
}

/// Points of some keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum DesignBlock {
    /// Values of one key, evenly apart.
    Even {
        /// The key.
        key: String,
        /// The first value.
        first: f64,
        /// The last one.
        last: f64,
        /// How many there are.
        count: u32,
    },
    /// Values of one key.
    List {
        /// The key.
        key: String,
        /// Values of the key.
        values: Vec<f64>,
    },
    /// Points, each with a value of every key.
    Table {
        /// The keys.
        keys: Vec<String>,
        /// The values of each point.
        points: Vec<Vec<f64>>,
    },
    /// Points, each with a value of any type of every key.
    Values {
        /// The keys.
        keys: Vec<String>,
        /// The values of each point.
        points: Vec<Vec<Value>>,
    },
    /// Points that are spread over ranges of keys.
    Sample {
        /// Method that spreads the points over the ranges.
        sampling: Sampling,
        /// Number of points.
        count: u64,
        /// The ranges.
        ranges: Vec<KeyRange>,
    },
}

/// The range of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyRange {
    /// The key.
    pub key: String,
    /// From here ...
    pub from: f64,
    /// ... to there.
    pub to: f64,
}

impl From<Grid> for DesignBlock {
    fn from(Grid { key, values }: Grid) -> Self {
        Self::List { key, values }
    }
}

/// Returns value `index` of `count` equidistant values from the first to the last.
pub(super) fn linspace(first: f64, last: f64, count: u32, index: u32) -> f64 {
    let part = if count > 1 { f64::from(index) / f64::from(count - 1) } else { 0.0 };
    first * (1.0 - part) + last * part
}

impl DesignBlock {
    /// Creates the points of a key that holds a text.
    pub fn texts(key: &str, texts: impl IntoIterator<Item = String>) -> Self {
        let points = texts.into_iter().map(|text| vec![Value::String(text)]).collect();
        Self::Values { keys: vec![key.to_owned()], points }
    }

    /// Returns the number of points.
    pub fn count(&self) -> u64 {
        match self {
            Self::Even { count, .. } => u64::from(*count),
            Self::List { values, .. } => values.len() as u64,
            Self::Table { points, .. } => points.len() as u64,
            Self::Values { points, .. } => points.len() as u64,
            Self::Sample { count, .. } => *count,
        }
    }

    /// Returns the scenario keys that the design varies.
    pub fn keys(&self) -> Vec<&str> {
        match self {
            Self::Even { key, .. } | Self::List { key, .. } => vec![key],
            Self::Table { keys, .. } | Self::Values { keys, .. } => keys.iter().map(String::as_str).collect(),
            Self::Sample { ranges, .. } => ranges.iter().map(|range| range.key.as_str()).collect(),
        }
    }

    /// Returns the values of a point, in the order of the keys; NaN if there is no such point.
    fn values(&self, point: u64, seed: u64) -> Vec<Value> {
        if point >= self.count() {
            return vec![Value::Float(f64::NAN); self.keys().len()];
        }
        let index = point as usize;
        match self {
            Self::Even { first, last, count, .. } => {
                vec![Value::Float(linspace(*first, *last, *count, point as u32))]
            }
            Self::List { values, .. } => vec![Value::Float(values[index])],
            Self::Table { points, .. } => points[index].iter().copied().map(Value::Float).collect(),
            Self::Values { points, .. } => points[index].clone(),
            Self::Sample { sampling, count, ranges } => {
                let value = |(place, KeyRange { key, from, to }): (usize, &KeyRange)| {
                    let name = format!("design {key}");
                    let part = sampling.number(Dimension { seed, name: &name, place }, point, *count);
                    Value::Float(from * (1.0 - part) + to * part)
                };
                ranges.iter().enumerate().map(value).collect()
            }
        }
    }

    /// Returns the first and the last values: of each key alone, and of a table's keys together.
    fn ends(&self) -> Vec<Vec<(&str, Value)>> {
        fn single(key: &str, value: f64) -> Vec<(&str, Value)> {
            vec![(key, Value::Float(value))]
        }
        match self {
            Self::Even { key, first, last, .. } => vec![single(key, *first), single(key, *last)],
            Self::List { key, values } => {
                values.first().into_iter().chain(values.last()).map(|value| single(key, *value)).collect()
            }
            Self::Table { .. } | Self::Values { .. } => {
                let point = |point| self.keys().into_iter().zip(self.values(point, 0)).collect();
                [0, self.count().saturating_sub(1)].into_iter().map(point).collect()
            }
            Self::Sample { ranges, .. } => ranges
                .iter()
                .flat_map(|range| [single(&range.key, range.from), single(&range.key, range.to)])
                .collect(),
        }
    }

    fn validate(&self) -> Option<String> {
        let (count, keys) = (self.count(), self.keys());
        if count == 0 || keys.is_empty() {
            return Some("a design needs a point".to_owned());
        }
        let finite = match self {
            Self::Even { first, last, .. } => first.is_finite() && last.is_finite(),
            // Each value of a list that is not accepted fails by itself.
            Self::List { .. } => true,
            Self::Table { points, .. } => {
                points.iter().all(|p| p.len() == keys.len() && p.iter().all(|v| v.is_finite()))
            }
            Self::Values { points, .. } => points.iter().all(|point| point.len() == keys.len()),
            Self::Sample { ranges, .. } => ranges
                .iter()
                .all(|range| range.from < range.to && range.from.is_finite() && range.to.is_finite()),
        };
        if !finite {
            return Some(match self {
                Self::Sample { .. } => "a range needs two numbers, the lower one first".to_owned(),
                Self::Values { .. } => "each point needs a value of every key".to_owned(),
                _ => "the values of keys must be finite numbers".to_owned(),
            });
        }
        let held = match self {
            Self::List { values, .. } => values.len(),
            Self::Table { .. } | Self::Values { .. } => count as usize * keys.len(),
            Self::Even { .. } | Self::Sample { .. } => 0,
        };
        if held > MOST_NUMBERS {
            return Some(format!("a list or a table has at most {MOST_NUMBERS} numbers, got {held}"));
        }
        match self {
            Self::Sample { sampling: Sampling::Sobol, ranges, .. } if ranges.len() > MOST_DIMENSIONS => {
                Some(format!("a Sobol sequence has at most {MOST_DIMENSIONS} keys, got {}", ranges.len()))
            }
            _ => None,
        }
    }

    /// Appends a readable description that differs from that of any other design.
    fn describe(&self, text: &mut String) {
        let _ = match self {
            Self::Even { key, first, last, count } => {
                writeln!(text, "# {key} = {first} to {last}, {count} values")
            }
            Self::List { key, values } if values.len() <= 8 => writeln!(text, "# {key} = {values:?}"),
            Self::List { key, values } => {
                let (count, hash) = (values.len(), fnv1a(&format!("{values:?}")));
                writeln!(text, "# {key} = a list of {count} values, hash {hash:016x}")
            }
            Self::Table { .. } | Self::Values { .. } => {
                let points = match self {
                    Self::Table { points, .. } => format!("{points:?}"),
                    other => format!("{other:?}"),
                };
                let (keys, count, hash) = (self.keys().join(", "), self.count(), fnv1a(&points));
                writeln!(text, "# {keys} = a table of {count} points, hash {hash:016x}")
            }
            Self::Sample { sampling, count, ranges } => {
                let range = |key_range: &KeyRange| {
                    format!("{} = {} to {}", key_range.key, key_range.from, key_range.to)
                };
                let ranges: Vec<String> = ranges.iter().map(range).collect();
                writeln!(text, "# {}: {count} points, {}", ranges.join(", "), sampling.name())
            }
        };
    }
}

impl Sampling {
    /// Returns the name of the sampling.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, sampling)| *sampling == self).map_or("", |(name, _)| name)
    }
}

impl Design {
    /// Returns the design of some blocks.
    pub fn from_blocks(blocks: impl IntoIterator<Item = DesignBlock>) -> Self {
        Self { blocks: blocks.into_iter().collect(), ..Self::default() }
    }

    /// Returns the keys that the design sets.
    pub fn keys(&self) -> Vec<&str> {
        self.blocks.iter().flat_map(DesignBlock::keys).collect()
    }

    /// Returns the number of runs of the design; `None` if it has as many as are wanted.
    pub fn runs(&self) -> Option<u64> {
        if self.blocks.is_empty() {
            return (self.hypercube > 0).then(|| self.hypercube.saturating_mul(self.replicas));
        }
        let points = self.blocks.iter().fold(1_u64, |points, block| points.saturating_mul(block.count()));
        Some(points.saturating_mul(self.replicas))
    }

    /// Returns the point of a run.
    pub fn point(&self, run: u64) -> u64 {
        run / self.replicas.max(1)
    }

    /// Returns the number of the run whose noise a run has.
    pub fn noise_run(&self, run: u64) -> u64 {
        self.noise_run.map_or(run, |first| first.saturating_add(run % self.replicas.max(1)))
    }

    /// Returns the number of the run whose noise a run has, of a design with this description.
    pub fn described_noise_run(description: &str, run: u64) -> u64 {
        let number = |before: &str, after: &str| {
            let lines = description.lines().take_while(|line| line.starts_with('#'));
            let mut numbers =
                lines.filter_map(|line| line.strip_prefix(before)?.strip_suffix(after)?.parse().ok());
            numbers.next()
        };
        let replicas = number("# ", REPLICAS).unwrap_or(1);
        Self { replicas, noise_run: number(NOISE, ""), ..Self::default() }.noise_run(run)
    }

    /// Returns the values of the keys of a point.
    pub(super) fn values(&self, point: u64, seed: u64) -> Vec<Value> {
        let mut rest = point;
        let mut values = Vec::new();
        for (place, block) in self.blocks.iter().enumerate().rev() {
            // A point beyond the first block has no values: its runs fail, as with any value that is not accepted.
            let count = if place == 0 { u64::MAX } else { block.count().max(1) };
            let mut own = block.values(rest % count, seed);
            own.append(&mut values);
            values = own;
            rest /= count;
        }
        values
    }

    /// Returns the first and the last values of each block: those that are set together.
    pub(super) fn ends(&self) -> impl Iterator<Item = Vec<(&str, Value)>> {
        self.blocks.iter().flat_map(DesignBlock::ends)
    }

    /// Returns true if every value is a number.
    pub(super) fn is_numeric(&self) -> bool {
        !self.blocks.iter().any(|block| matches!(block, DesignBlock::Values { .. }))
    }

    /// Returns the values of a key of any type; `None` if the values of the key are numbers of another block.
    pub(super) fn values_of(&self, key: &str) -> Option<impl Iterator<Item = &Value>> {
        self.blocks.iter().find_map(|block| match block {
            DesignBlock::Values { keys, points } => {
                let place = keys.iter().position(|other| other == key)?;
                Some(points.iter().filter_map(move |point| point.get(place)))
            }
            _ => None,
        })
    }

    /// Returns the first inconsistency of the design; `uncertain` is the number of keys that are drawn.
    pub fn validate(&self, uncertain: usize) -> Option<String> {
        if let Some(problem) = self.blocks.iter().find_map(DesignBlock::validate) {
            return Some(problem);
        }
        let keys = self.keys();
        let twice = keys.iter().enumerate().find(|(place, key)| keys[..*place].contains(key));
        if let Some((_, key)) = twice {
            return Some(format!("{key}: a key can be varied once"));
        }
        if self.replicas == 0 {
            return Some("replicas must be at least 1".to_owned());
        }
        if self.runs().is_some_and(|runs| runs > MOST_POINTS) {
            return Some(format!("a design has at most {MOST_POINTS} runs"));
        }
        if self.draws == Sampling::Sobol && uncertain > MOST_DIMENSIONS {
            let most = MOST_DIMENSIONS;
            return Some(format!("a Sobol sequence has at most {most} keys, got {uncertain} uncertain ones"));
        }
        (self.draws != Sampling::Random && uncertain == 0)
            .then(|| format!("no key is uncertain: there is nothing to draw by {}", self.draws.name()))
    }

    /// Returns a readable description as lines of comments; empty for a campaign that only draws.
    pub fn describe(&self) -> String {
        let mut text = String::new();
        self.blocks.iter().for_each(|block| block.describe(&mut text));
        if self.draws != Sampling::Random {
            let design_of =
                if self.hypercube > 0 { format!(" of {} points", self.hypercube) } else { String::new() };
            let _ = writeln!(text, "# drawn by {}{design_of}", self.draws.name());
        }
        if self.replicas > 1 {
            let _ = writeln!(text, "# {}{REPLICAS}", self.replicas);
        }
        if let Some(run) = self.noise_run {
            let _ = writeln!(text, "{NOISE}{run}");
        }
        text
    }
}
