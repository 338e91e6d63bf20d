//! Linear body as pairs of a position and its rate, each a damped mode or a rigid motion, with their parts of an output.

use flexsc_formats::document::ConfigError;

use crate::linear_model::LinearModel;

/// Body in modal form, seen at one output.
#[derive(Clone, Debug)]
pub struct ModalForm {
    /// Pairs of states.
    pub pairs: Vec<StatePair>,
}

/// Position and rate: x' = v, v' = -w² x - 2 zeta w v + the inputs, and their part of the output.
#[derive(Clone, Debug)]
pub struct StatePair {
    /// Indices of the position and of the rate in the state.
    pub states: [usize; 2],
    /// Natural frequency (rad/s); 0 of a rigid motion.
    pub frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Weights of the position and of the rate in the output.
    pub weights: [f64; 2],
    /// Acceleration per unit of each input.
    pub inputs: Vec<f64>,
}

impl StatePair {
    /// Returns true if the pair is a mode, and not a rigid motion.
    pub fn is_elastic(&self) -> bool {
        self.frequency > 0.0
    }
}

impl ModalForm {
    /// Returns the modal form of a linear model, with the output of index `output`, without the rigid motion if it is
    /// `elastic`.
    ///
    /// # Errors
    /// States that are coupled otherwise than a position to its rate, and modes that do not oscillate; the key is that
    /// of the claim.
    pub fn new(model: &LinearModel, output: usize, elastic: bool) -> Result<Self, ConfigError> {
        let order = model.states.len();
        let mut pairs = Vec::with_capacity(order / 2);
        let mut is_paired = vec![false; order];
        for position in 0..order {
            let mut entries = model.a[position].iter().enumerate().filter(|(_, value)| **value != 0.0);
            let (Some((rate, value)), None) = (entries.next(), entries.next()) else { continue };
            let is_driven = model.b[position].iter().any(|value| *value != 0.0);
            if *value != 1.0 || is_driven || is_paired[position] || is_paired[rate] || rate == position {
                continue;
            }
            (is_paired[position], is_paired[rate]) = (true, true);
            let others = model.a[rate].iter().enumerate();
            let coupled = others
                .filter(|(state, _)| ![position, rate].contains(state))
                .find(|(_, value)| **value != 0.0);
            if let Some((other, _)) = coupled {
                return Err(coupling(&model.states[rate].name, &model.states[other].name));
            }
            let [stiffness, damping] = [position, rate].map(|state| -model.a[rate][state]);
            let frequency = stiffness.max(0.0).sqrt();
            let ratio = if frequency > 0.0 { damping / (2.0 * frequency) } else { 0.0 };
            if stiffness < 0.0 || frequency == 0.0 && damping != 0.0 || !(0.0..1.0).contains(&ratio) {
                let name = &model.states[position].name;
                let why = format!("needs damping ratios from 0 to below 1, got {ratio} of `{name}`");
                return Err(ConfigError::new("output", why));
            }
            let weights = [position, rate].map(|state| model.c[output][state]);
            pairs.push(StatePair {
                states: [position, rate],
                frequency,
                damping: ratio,
                weights: if elastic && frequency == 0.0 { [0.0; 2] } else { weights },
                inputs: model.b[rate].clone(),
            });
        }
        match is_paired.iter().position(|paired| !paired) {
            Some(state) => Err(coupling(&model.states[state].name, "other states")),
            None => Ok(Self { pairs }),
        }
    }

    /// Returns the number of inputs.
    pub fn input_count(&self) -> usize {
        self.pairs.first().map_or(0, |pair| pair.inputs.len())
    }

    /// Returns the body with frequencies and damping ratios multiplied by factors.
    #[must_use]
    pub fn scaled(&self, frequency: f64, damping: f64) -> Self {
        let scaled = |pair: &StatePair| StatePair {
            frequency: pair.frequency * frequency,
            damping: pair.damping * damping,
            ..pair.clone()
        };
        Self { pairs: self.pairs.iter().map(scaled).collect() }
    }
}

fn coupling(state: &str, other: &str) -> ConfigError {
    let why = format!(
        "is bounded for modes that do not act on each other, and `{state}` depends on {other}: leave out what couples \
         them, such as a damping matrix, a back-EMF or the momentum of wheels"
    );
    ConfigError::new("output", why)
}
