//! Laws of the modes of operation: each acts while its mode lasts, and starts without a past.

use super::axes_laws::AxesLaws;
use super::{Authority, Stage};

/// Laws of all modes as they start.
#[derive(Clone, Debug)]
pub(super) struct ModeLaws {
    unused: Vec<AxesLaws>,
    /// Key prefix of the law of each mode among the modes: `[0].law.pd.` and the like.
    places: Vec<String>,
    /// Index of the active mode.
    active: usize,
    /// Index of a mode that begins at the next decision.
    selected: Option<usize>,
    /// Index of the mode whose law was tuned last.
    tuned: Option<usize>,
}

impl ModeLaws {
    /// Creates the laws of all modes, about axes with these actuator authorities; `by_mode` has those of each mode about
    /// each axis, or is empty if all modes have the same.
    pub fn new(modes: &[Stage], authorities: &[Authority], by_mode: &[Vec<Authority>]) -> Self {
        let laws = |(index, mode): (usize, &Stage)| {
            let own: Option<Vec<Authority>> = by_mode.iter().map(|about| about.get(index).copied()).collect();
            let own = own.filter(|own| own.len() == authorities.len());
            AxesLaws::new(&mode.law, own.as_deref().unwrap_or(authorities), &[])
        };
        Self {
            unused: modes.iter().enumerate().map(laws).collect(),
            places: modes.iter().enumerate().map(|(index, mode)| mode.key_prefix(index)).collect(),
            active: 0,
            selected: None,
            tuned: None,
        }
    }

    /// Returns the laws of the first mode.
    pub fn first(&self) -> AxesLaws {
        self.unused.first().cloned().unwrap_or_default()
    }

    /// Selects the mode that begins at the next decision.
    pub fn select(&mut self, mode: usize) {
        self.selected = Some(mode);
    }

    /// Returns the laws of the mode that begins with this decision, if one does.
    pub fn enter_selected(&mut self) -> Option<AxesLaws> {
        let mode = self.selected.take()?;
        self.active = mode;
        self.unused.get(mode).cloned()
    }

    /// Sets the parameter of the law of one mode that the key selects; `acting` are the laws that act.
    pub fn tune(&mut self, key: &str, value: f64, acting: &mut AxesLaws) {
        let of_mode = |(mode, place): (usize, &String)| Some((mode, key.strip_prefix(place.as_str())?));
        let Some((mode, key)) = self.places.iter().enumerate().find_map(of_mode) else { return };
        self.unused[mode].tune(key, value);
        if mode == self.active {
            acting.tune(key, value);
        }
        self.tuned = Some(mode);
    }

    /// Returns the value of the parameter that was tuned last; NaN if none was.
    pub fn tuned(&self, axis: usize) -> f64 {
        self.tuned.map_or(f64::NAN, |mode| self.unused[mode].tuned(axis))
    }
}
