//! Data shared by all runs of a scenario: the constants of the body, its step levels, and the modes' responses over
//! the step lengths that any run has used. The values do not depend on which run computes them first, and thousands
//! of parallel runs find them in the processor's cache.

use std::sync::{Arc, Mutex, OnceLock};

use super::body::FlexibleBody;
use super::constants::BodyConstants;
use super::step::ModeResponse;
use super::step_levels::StepLevels;

/// Number of step lengths whose responses are kept.
const KEPT: usize = 64;

/// Handle to the shared data, initialised by the first run.
#[derive(Clone, Debug, Default)]
pub struct SharedSteps(Arc<OnceLock<(FlexibleBody, Arc<SharedBody>)>>);

/// Constants, step levels and cached responses of a body.
#[derive(Debug)]
pub(super) struct SharedBody {
    pub model: Arc<BodyConstants>,
    pub levels: Arc<StepLevels>,
    /// Cache of the last responses, and the index that is replaced next.
    responses: Mutex<(Vec<StepResponses>, usize)>,
}

/// Step length (s) and the modes' responses over it.
#[derive(Clone, Debug)]
pub(super) struct StepResponses {
    pub h: f64,
    pub responses: Arc<[ModeResponse]>,
}

/// All handles are equal, because the cache does not belong to a scenario's definition.
impl PartialEq for SharedSteps {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl SharedSteps {
    /// Returns the shared data for a body; unshared data if the first run had another body.
    pub(super) fn for_body(&self, body: &FlexibleBody) -> Arc<SharedBody> {
        let (first, known) = self.0.get_or_init(|| (body.clone(), Arc::new(SharedBody::new(body))));
        if first == body { known.clone() } else { Arc::new(SharedBody::new(body)) }
    }
}

impl SharedBody {
    fn new(body: &FlexibleBody) -> Self {
        let model = BodyConstants::new(body);
        Self {
            levels: Arc::new(StepLevels::new(&model)),
            model: Arc::new(model),
            responses: Mutex::new((Vec::new(), 0)),
        }
    }

    /// Returns the responses over a step of `h` (s), from the cache if present.
    pub fn responses(&self, h: f64) -> StepResponses {
        let Ok(mut cached) = self.responses.lock() else { return StepResponses::new(&self.model, h) };
        let (all, next) = &mut *cached;
        if let Some(found) = all.iter().find(|of| of.h.to_bits() == h.to_bits()) {
            return found.clone();
        }
        let made = StepResponses::new(&self.model, h);
        if all.len() < KEPT {
            all.push(made.clone());
        } else {
            all[*next] = made.clone();
            *next = (*next + 1) % KEPT;
        }
        made
    }
}

impl StepResponses {
    /// Computes the responses of a body's modes over a step of `h` (s).
    pub fn new(model: &BodyConstants, h: f64) -> Self {
        let modes = model.modes.iter();
        Self { h, responses: modes.map(|of| ModeResponse::new(of.frequency, of.damping, h)).collect() }
    }
}
