//! What all runs of a scenario have in common: the constants of the body, its pace, and the responses of its modes over steps that
//! any of them has taken. They are the same whoever computes them first, and thousands of runs side by side find them in the
//! processor's cache.

use std::sync::{Arc, Mutex, OnceLock};

use super::model::{Flexible, Model};
use super::pace::Pace;
use super::response::NodeResponse;

/// So many lengths of steps are kept for all.
const KEPT: usize = 64;

/// What runs have in common, from the first on.
#[derive(Clone, Debug, Default)]
pub struct CommonSteps(Arc<OnceLock<(Flexible, Arc<KnownBody>)>>);

/// What is known of a body.
#[derive(Debug)]
pub(super) struct KnownBody {
    pub model: Arc<Model>,
    pub pace: Arc<Pace>,
    /// Those that were needed last, and the place of the next.
    responses: Mutex<(Vec<Regular>, usize)>,
}

/// A step: its length (s) and the responses over it.
#[derive(Clone, Debug)]
pub(super) struct Regular {
    pub h: f64,
    pub responses: Arc<[NodeResponse]>,
}

/// It is no part of what a scenario is.
impl PartialEq for CommonSteps {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl CommonSteps {
    /// What is known of a body; of its own, if it is not the one that was first.
    pub(super) fn of(&self, body: &Flexible) -> Arc<KnownBody> {
        let (first, known) = self.0.get_or_init(|| (body.clone(), Arc::new(KnownBody::new(body))));
        if first == body { known.clone() } else { Arc::new(KnownBody::new(body)) }
    }
}

impl KnownBody {
    fn new(body: &Flexible) -> Self {
        let model = Model::new(body);
        Self {
            pace: Arc::new(Pace::new(&model)),
            model: Arc::new(model),
            responses: Mutex::new((Vec::new(), 0)),
        }
    }

    /// The responses over a step of `h` seconds.
    pub fn over(&self, h: f64) -> Regular {
        let Ok(mut kept) = self.responses.lock() else { return Regular::new(&self.model, h) };
        let (all, next) = &mut *kept;
        if let Some(found) = all.iter().find(|of| of.h.to_bits() == h.to_bits()) {
            return found.clone();
        }
        let made = Regular::new(&self.model, h);
        if all.len() < KEPT {
            all.push(made.clone());
        } else {
            all[*next] = made.clone();
            *next = (*next + 1) % KEPT;
        }
        made
    }
}

impl Regular {
    /// The responses of a body's modes over a step of `h` seconds.
    pub fn new(model: &Model, h: f64) -> Self {
        let modes = model.modes.iter();
        Self { h, responses: modes.map(|of| NodeResponse::new(of.frequency, of.damping, h)).collect() }
    }
}
