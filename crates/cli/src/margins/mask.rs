//! Mask around the critical point of a Nichols chart: gains and phases by which a loop may be off at once.

use std::str::FromStr;

use flexsc_core::formats::document::number_in;
use flexsc_core::formats::reader_units::number;
use flexsc_figure::{Layer, LayerShape, Point, colour};

/// Parts of the step between two points of a loop that are compared with the mask.
const PARTS: u32 = 8;
/// Turn between two critical points (deg), and the phase of one of them.
const TURN: f64 = 360.0;
const CRITICAL: f64 = -180.0;

/// Mask: a rectangle around -1, of gains up to one factor and its inverse and phases up to one angle.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NicholsMask {
    /// Gain (dB).
    pub gain_db: f64,
    /// Phase (deg).
    pub phase_deg: f64,
}

impl FromStr for NicholsMask {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || format!("must be a gain in dB and a phase, such as `6 dB, 30 deg`, got `{text}`");
        let (gain, phase) = text.split_once(',').ok_or_else(form)?;
        let gain_db = gain.trim().strip_suffix("dB").and_then(|gain| gain.trim().parse().ok());
        let phase_deg = number_in(phase.trim(), "deg").map_err(|_| form())?;
        // A phase without a unit may be meant in rad.
        let has_unit = text.trim_end().ends_with(char::is_alphabetic);
        let mask = Self { gain_db: gain_db.ok_or_else(form)?, phase_deg };
        let is_positive = mask.gain_db > 0.0 && mask.gain_db.is_finite() && mask.phase_deg > 0.0;
        if has_unit && is_positive && mask.phase_deg < 180.0 { Ok(mask) } else { Err(form()) }
    }
}

impl NicholsMask {
    /// Returns the mask as text.
    pub fn text(&self) -> String {
        format!("{} dB, {} deg", number(self.gain_db), number(self.phase_deg))
    }

    /// Returns the frequency at which a loop is first within the mask: `points` are its frequencies (Hz), magnitudes (dB) and phases
    /// (deg, without jumps).
    pub fn first_violation(&self, points: &[[f64; 3]]) -> Option<f64> {
        let steps = points.windows(2).flat_map(|pair| {
            let at = |part: u32| {
                [0, 1, 2].map(|k| pair[0][k] + f64::from(part) / f64::from(PARTS) * (pair[1][k] - pair[0][k]))
            };
            (0..=PARTS).map(at)
        });
        let mut within = steps.filter(|[_, magnitude, phase]| self.has(*magnitude, *phase));
        within.next().map(|[frequency, ..]| frequency)
    }

    /// Returns true if a magnitude (dB) and a phase (deg) lie within the mask.
    fn has(&self, magnitude: f64, phase: f64) -> bool {
        let off = (phase - CRITICAL) / TURN;
        magnitude.abs() < self.gain_db && TURN * (off - off.round()).abs() < self.phase_deg
    }

    /// Returns the mask around each critical point, as layers of a Nichols chart.
    pub fn layers(&self, critical: &[Point]) -> Vec<Layer> {
        let Self { gain_db, phase_deg } = *self;
        let corners = critical.iter().flat_map(|(phase, gain)| {
            let (left, right, low, high) =
                (phase - phase_deg, phase + phase_deg, gain - gain_db, gain + gain_db);
            [(left, low), (right, low), (right, high), (left, high), (left, low), (f64::NAN, f64::NAN)]
        });
        let corners: Vec<Point> = corners.collect();
        vec![
            Layer::new("", colour::RED, LayerShape::Area(0.1), corners.clone()),
            Layer::new(&format!("mask {}", self.text()), colour::RED, LayerShape::Line(1.4), corners),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_is_a_gain_and_a_phase_with_units() {
        let mask: NicholsMask = "6 dB, 30 deg".parse().expect("a mask");
        assert!((mask.gain_db, mask.phase_deg) == (6.0, 30.0));
        assert_eq!(mask.text(), "6 dB, 30 deg");
        for text in ["6, 30", "6 dB", "6 dB, 30", "-6 dB, 30 deg", "6 dB, 200 deg", "30 deg, 6 dB", ""] {
            assert!(text.parse::<NicholsMask>().is_err_and(|why| why.contains("`6 dB, 30 deg`")), "{text}");
        }
    }

    #[test]
    fn a_loop_is_within_the_mask_of_any_turn() {
        let mask = NicholsMask { gain_db: 6.0, phase_deg: 30.0 };
        let locus = |end: [f64; 3]| [[0.1, 20.0, end[2]], end, [1.0, -20.0, end[2]]];
        // Phases of 149 and 151 deg off -180, the latter a turn away.
        assert_eq!(mask.first_violation(&locus([0.5, 0.0, -149.0])), None);
        assert!(mask.first_violation(&locus([0.5, 0.0, -151.0 - 720.0])).is_some());
        // A step over the mask: 20 to -20 dB at a phase within it.
        assert!(mask.first_violation(&[[0.1, 20.0, -170.0], [0.2, -20.0, -170.0]]).is_some());
        assert_eq!(mask.first_violation(&[[0.1, 20.0, -170.0], [0.2, 7.0, -170.0]]), None);
    }
}
