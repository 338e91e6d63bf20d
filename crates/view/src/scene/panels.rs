//! Panels of a one-axis body: places of their sections, and their bending.

use flexsc_core::Scenario;
use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::record::OneAxisPose;
use flexsc_core::spacecraft::body::Body;

use super::magnification::expected_displacements;

/// Sections, total length (m) and root distance (m) of the panels of a body that defines none.
const SECTIONS: usize = 8;
const LENGTH: f64 = 10.0;
const ROOT: f64 = 1.2;
/// Largest angle at which a section is drawn relative to the hub (rad).
const LARGEST: f64 = 1.5;
/// Largest number of panels that are drawn.
const MOST_PANELS: u32 = 12;

/// Source of the sections' bending angles.
#[derive(Clone, Debug)]
enum SectionBending {
    /// Angles of the body's own sections.
    Own,
    /// Slopes of the modes along the panel: the angle of each section for a unit of each mode.
    Modes(Vec<Vec<f64>>),
}

/// Panels of a body.
#[derive(Clone, Debug)]
pub struct ScenePanels {
    /// Distance of the first section from the axis (m).
    pub root: f64,
    /// Lengths of the sections (m), from the hub outwards.
    pub lengths: Vec<f64>,
    /// Number of equal panels.
    pub count: u32,
    /// Estimated bending (rad).
    pub bent: f64,
    bends: SectionBending,
}

impl ScenePanels {
    /// Returns the panels of a scenario's body.
    pub fn from_scenario(scenario: &Scenario, body: &AxisModel) -> Self {
        let reached = expected_displacements(scenario, body);
        if let Some(Body::Panels(panels)) = &scenario.body {
            let bent = body.outputs.iter().map(|output| {
                output.modes.iter().zip(&reached).map(|(weight, x)| (weight.get() * x).abs()).sum()
            });
            return Self {
                root: panels.root.get(),
                lengths: panels.sections.iter().map(|section| section.length.get()).collect(),
                bends: SectionBending::Own,
                count: panels.count.min(MOST_PANELS),
                bent: bent.fold(0.0, f64::max),
            };
        }
        Self {
            root: ROOT,
            lengths: vec![LENGTH / SECTIONS as f64; SECTIONS],
            bends: SectionBending::Modes((0..body.modes.len()).map(|mode| slopes(mode, SECTIONS)).collect()),
            count: 2,
            bent: reached.iter().sum(),
        }
    }

    /// Returns the length of a panel (m).
    pub fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Returns the angle about z at which a panel begins (rad).
    pub fn azimuth(&self, panel: u32) -> f64 {
        f64::from(panel) * (std::f64::consts::TAU / f64::from(self.count))
    }

    /// Returns the angle of each section relative to the hub (rad), multiplied by `bending`.
    pub fn angles(&self, bending: f64, view: OneAxisPose<'_>) -> Vec<f64> {
        let drawn = |angle: f64| (bending * angle).clamp(-LARGEST, LARGEST);
        match &self.bends {
            SectionBending::Own => view.sections.iter().copied().map(drawn).collect(),
            // The panels bend against the elastic rotation of the hub.
            SectionBending::Modes(slopes) => (0..self.lengths.len())
                .map(|section| {
                    let modes = slopes.iter().zip(view.modes);
                    drawn(-modes.map(|(slopes, mode)| slopes[section] * mode.displacement).sum::<f64>())
                })
                .collect(),
        }
    }
}

/// Returns the slopes of a mode along a panel clamped at the hub, at the middles of equal sections, 1 at the tip.
fn slopes(mode: usize, sections: usize) -> Vec<f64> {
    // Waves finer than the sections would be drawn as another shape.
    let waves = 2.0 * mode.min(sections / 2 - 1) as f64 + 1.0;
    let slope = |section: usize| {
        let along = (section as f64 + 0.5) / sections as f64;
        libm::sin(waves * std::f64::consts::FRAC_PI_2 * along)
    };
    (0..sections).map(slope).collect()
}
