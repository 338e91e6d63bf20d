//! Surfaces on which input arrives, and the makers of their inputs.

mod arguments;
mod coefficients;
mod commands;
mod conditions;
mod element_sets;
mod environment;
mod ephemerides;
mod fmus;
mod live;
mod lockstep;
mod logs;
mod parts;
mod points;
mod records;
mod results;
mod scenarios;
mod structures;
mod wire;

use std::path::Path;

use clap::ValueEnum;

use crate::case::Case;
use crate::chance::Chance;
use crate::node::Node;

pub use live::Server;

/// A surface.
#[derive(Copy, Clone, Debug, PartialEq, ValueEnum)]
pub enum Surface {
    /// Scenario files, to every command that takes one
    Scenarios,
    /// Structures: CSV, MatrixMarket and NumPy files, matrices, panels, and results of finite-element programs
    Structures,
    /// MCAP logs and campaigns' tables, to everything that reads them
    Logs,
    /// Arguments of every command
    Arguments,
    /// Messages of viewers to a live run
    Live,
    /// Parquet parts of campaigns, to everything that reads them
    Parts,
    /// Element sets, ephemerides, coefficients of the field and densities, to checks and short runs
    Environment,
    /// Conditions of modes of operation
    Conditions,
    /// Tables of the points of a sweep
    Points,
    /// Commands within logs, by which runs are repeated
    Commands,
    /// Packets to a run in lockstep
    Lockstep,
    /// Calls of the functions of FMUs, and serialised states
    Fmus,
}

/// Maker of the inputs of a surface.
pub struct Maker {
    surface: Surface,
    seed: u64,
    seeds: Seeds,
    logs: Vec<Vec<u8>>,
    campaign: Vec<(String, Vec<u8>)>,
    fmus: Vec<fmus::Fmu>,
}

/// Material of the inputs.
pub struct Seeds {
    /// Shipped scenarios, by their names: text and tree.
    pub scenarios: Vec<(String, String, Node)>,
    /// Trees of the shipped scenarios.
    pub trees: Vec<Node>,
    /// Sparse and dense matrices as NumPy writes them.
    pub archives: Vec<(String, Vec<u8>)>,
    /// Results of finite-element programs, and their decks.
    pub results: Vec<(String, Vec<u8>)>,
}

impl Seeds {
    fn load() -> std::io::Result<Self> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let (mut scenarios, mut archives, mut results) = (Vec::new(), Vec::new(), Vec::new());
        let mut files = Vec::new();
        crate::case::gather(&root.join("scenarios"), "", &mut files)?;
        crate::case::gather(&root.join("tests/golden"), "", &mut files)?;
        for (name, bytes) in files {
            if let Some(stem) = name.strip_suffix(".toml") {
                let text = String::from_utf8_lossy(&bytes).into_owned();
                let table: toml::Table = toml::from_str(&text).map_err(std::io::Error::other)?;
                scenarios.push((stem.to_owned(), text, Node::from(&toml::Value::Table(table))));
            } else if Path::new(&name).extension().is_some_and(|e| e == "npz") {
                archives.push((name, bytes));
            } else if results::is_one(&name) {
                results.push((name, bytes));
            }
        }
        let trees = scenarios.iter().map(|(_, _, tree)| tree.clone()).collect();
        Ok(Self { scenarios, trees, archives, results })
    }
}

impl Maker {
    pub fn new(surface: Surface, seed: u64) -> std::io::Result<Self> {
        let seeds = Seeds::load()?;
        let logs = match surface {
            Surface::Logs | Surface::Arguments => logs::seeds(&seeds)?,
            Surface::Commands => commands::seeds(&seeds)?,
            _ => Vec::new(),
        };
        let campaign = if surface == Surface::Parts { parts::seeds()? } else { Vec::new() };
        let fmus = if surface == Surface::Fmus { fmus::seeds(&seeds)? } else { Vec::new() };
        Ok(Self { surface, seed, seeds, logs, campaign, fmus })
    }

    /// Returns the input of a number.
    pub fn make(&self, number: u64) -> Case {
        let chance = &mut Chance::new(self.seed, self.surface as usize, number);
        match self.surface {
            Surface::Scenarios => scenarios::make(&self.seeds, chance),
            Surface::Structures => structures::make(&self.seeds, chance),
            Surface::Logs => logs::make(&self.logs, &self.seeds, chance),
            Surface::Parts => parts::make(&self.campaign, chance),
            Surface::Arguments => arguments::make(&self.logs, &self.seeds, chance),
            Surface::Live => live::make(chance),
            Surface::Environment => environment::make(chance),
            Surface::Conditions => conditions::make(&self.seeds, chance),
            Surface::Points => points::make(chance),
            Surface::Commands => commands::make(&self.logs, chance),
            Surface::Lockstep => lockstep::make(chance),
            Surface::Fmus => fmus::make(&self.fmus, chance),
        }
    }
}
