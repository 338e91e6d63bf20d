//! Data shared by all runs of a scenario: the constants of the body, its step levels, and the modes' responses over
//! the step lengths that any run has used. The values do not depend on which run computes them first, and thousands
//! of parallel runs find them in the processor's cache.

use std::sync::{Arc, Mutex, OnceLock};

use super::model::{Flexible, Model};
use super::pace::Pace;
use super::response::NodeResponse;

/// Number of step lengths whose responses are kept.
const KEPT: usize = 64;

/// Handle to the shared data, initialised by the first run.
#[derive(Clone, Debug, Default)]
pub struct CommonSteps(Arc<OnceLock<(Flexible, Arc<KnownBody>)>>);

/// Constants, step levels and cached responses of a body.
#[derive(Debug)]
pub(super) struct KnownBody {
    pub model: Arc<Model>,
    pub pace: Arc<Pace>,
    /// Cache of the last responses, and the index that is replaced next.
    responses: Mutex<(Vec<Regular>, usize)>,
}

/// Step length (s) and the modes' responses over it.
#[derive(Clone, Debug)]
pub(super) struct Regular {
    pub h: f64,
    pub responses: Arc<[NodeResponse]>,
}

/// All handles are equal, because the cache does not belong to a scenario's definition.
impl PartialEq for CommonSteps {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl CommonSteps {
    /// Returns the shared data for a body; unshared data if the first run had another body.
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

    /// Returns the responses over a step of `h` (s), from the cache if present.
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
    /// Computes the responses of a body's modes over a step of `h` (s).
    pub fn new(model: &Model, h: f64) -> Self {
        let modes = model.modes.iter();
        Self { h, responses: modes.map(|of| NodeResponse::new(of.frequency, of.damping, h)).collect() }
    }
}
