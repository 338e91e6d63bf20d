//! The panels of a body with one angle: where their sections are, and how they bend.

use super::PlanarView;
use super::magnification::displacements;
use crate::body::{Body, Planar};
use crate::scenario::Scenario;

/// Panels of a body that has none of its own: so many sections, of this length altogether, from this distance on (m).
const SECTIONS: usize = 8;
const LENGTH: f64 = 10.0;
const ROOT: f64 = 1.2;
/// No section is drawn at a larger angle to the hub (rad).
const LARGEST: f64 = 1.5;
/// No more panels are drawn.
const MOST_PANELS: u32 = 12;

/// How the sections bend.
#[derive(Clone, Debug)]
enum Bends {
    /// By their own angles.
    Own,
    /// By these angles for a unit of each mode: the modes' slopes along the panel.
    Modes(Vec<Vec<f64>>),
}

/// The panels of a body.
#[derive(Clone, Debug)]
pub struct ScenePanels {
    /// Distance of the first section from the axis (m).
    pub root: f64,
    /// Lengths of the sections (m), from the hub outwards.
    pub lengths: Vec<f64>,
    /// How many equal panels there are.
    pub count: u32,
    /// By how much they bend, about (rad).
    pub bent: f64,
    bends: Bends,
}

impl ScenePanels {
    /// Those of a scenario's body.
    pub fn of(scenario: &Scenario, body: &Planar) -> Self {
        let reached = displacements(scenario, body);
        if let Some(Body::Panels(panels)) = &scenario.body {
            let bent = body.outputs.iter().map(|output| {
                output.modes.iter().zip(&reached).map(|(weight, x)| (weight.get() * x).abs()).sum()
            });
            return Self {
                root: panels.root.get(),
                lengths: panels.sections.iter().map(|section| section.length.get()).collect(),
                bends: Bends::Own,
                count: panels.count.min(MOST_PANELS),
                bent: bent.fold(0.0, f64::max),
            };
        }
        Self {
            root: ROOT,
            lengths: vec![LENGTH / SECTIONS as f64; SECTIONS],
            bends: Bends::Modes((0..body.modes.len()).map(|mode| slopes(mode, SECTIONS)).collect()),
            count: 2,
            bent: reached.iter().sum(),
        }
    }

    /// Length of a panel (m).
    pub fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// The angle about z at which a panel begins (rad).
    pub fn azimuth(&self, panel: u32) -> f64 {
        f64::from(panel) * (std::f64::consts::TAU / f64::from(self.count))
    }

    /// The angle of each section to the hub (rad), drawn so many times as large as it is.
    pub fn angles(&self, bending: f64, view: PlanarView<'_>) -> Vec<f64> {
        let drawn = |angle: f64| (bending * angle).clamp(-LARGEST, LARGEST);
        match &self.bends {
            Bends::Own => view.sections.iter().copied().map(drawn).collect(),
            // Where the hub swings one way, the panels swing the other.
            Bends::Modes(slopes) => (0..self.lengths.len())
                .map(|section| {
                    let modes = slopes.iter().zip(view.modes);
                    drawn(-modes.map(|(slopes, mode)| slopes[section] * mode.displacement).sum::<f64>())
                })
                .collect(),
        }
    }
}

/// The slopes of a mode along a panel that is clamped at the hub, at the middles of equal sections, 1 at the tip.
fn slopes(mode: usize, sections: usize) -> Vec<f64> {
    // What is finer than the sections would look like something else.
    let waves = 2.0 * mode.min(sections / 2 - 1) as f64 + 1.0;
    let slope = |section: usize| {
        let along = (section as f64 + 0.5) / sections as f64;
        libm::sin(waves * std::f64::consts::FRAC_PI_2 * along)
    };
    (0..sections).map(slope).collect()
}
