//! The spatial body on its way, from one change of the jets to the next.

use crate::body::spatial::{Elastic, Rigid, SpatialState, Vector};
use crate::record::{Energy, Pointing, Record, RecordError, Vibration, Vibrations};
use crate::scenario::SpatialLoop;
use crate::time::Instant;

use super::jets::Push;

/// A mode is seen by a gyro that it turns by at least such a part of what the mode does that turns it most.
const VISIBLE: f64 = 0.1;

/// The body, and what pushes it.
#[derive(Clone, Debug)]
pub struct Plant {
    rigid: Rigid,
    elastic: Elastic,
    /// Rotations of the modes at the gyro.
    gyro: Vec<Vector>,
    /// Whether the gyro sees each mode.
    seen_by_gyro: Vec<bool>,
    /// The state when the jets changed last.
    departed: Instant,
    origin: SpatialState,
    push: Push,
    /// The state at the instant seen last.
    seen: Instant,
    state: SpatialState,
}

impl Plant {
    /// The body of a loop at the start, which nothing pushes.
    pub fn new(spatial: &SpatialLoop) -> Self {
        let rigid = Rigid::new(&spatial.body);
        let origin = SpatialState::start(&spatial.body, &rigid);
        let shapes = spatial.body.shapes(&spatial.gyro.point);
        let gyro: Vec<Vector> = shapes.into_iter().map(|(_, rotation)| rotation).collect();
        let most = gyro.iter().map(Vector::norm).fold(0.0, f64::max);
        Self {
            rigid,
            elastic: Elastic::new(&spatial.body, spatial.law.period.seconds()),
            seen_by_gyro: gyro.iter().map(|rotation| rotation.norm() >= VISIBLE * most).collect(),
            gyro,
            departed: Instant::START,
            push: Push::default(),
            seen: Instant::START,
            state: origin.clone(),
            origin,
        }
    }

    /// Brings the body to an instant, as long as the record lets it. What is seen on the way does not change the motion.
    pub fn view(&mut self, now: Instant, record: &mut impl Record) -> Result<(), RecordError> {
        record.poll()?;
        if self.seen != now {
            let h = now.since(self.departed).seconds();
            self.state.clone_from(&self.origin);
            let began = self.departed.seconds();
            self.rigid.advance(&mut self.state.turn, &self.push.torque, (began, h), || record.poll())?;
            self.elastic.advance(&mut self.state.modes, &self.push.forces, h);
            self.seen = now;
        }
        Ok(())
    }

    /// Begins a new motion at the instant seen last, under what pushes from now on.
    pub fn depart(&mut self, push: Push) {
        self.origin.clone_from(&self.state);
        (self.departed, self.push) = (self.seen, push);
    }

    /// The state at the instant seen last.
    pub fn state(&self) -> &SpatialState {
        &self.state
    }

    /// Rigid rates, and their elastic part at the gyro (rad/s), at the instant seen last.
    pub fn rates(&self) -> (Vector, Vector) {
        (self.rigid.rate(&self.state.turn), self.elastic.rate_at(&self.gyro, &self.state.modes))
    }

    /// Rates of the modes (m sqrt(kg)/s) at the instant seen last.
    pub fn modal_rates(&self) -> Vec<f64> {
        self.elastic.rates(&self.state.modes).collect()
    }

    /// Energy of the elastic modes at the instant seen last (J).
    pub fn elastic_energy(&self) -> f64 {
        self.elastic.energies(&self.state.modes).sum()
    }

    /// Energy of the modes that the gyro sees at the instant seen last (J): the slow ones that it hardly sees keep theirs
    /// whatever the law does.
    pub fn visible_energy(&self) -> f64 {
        let energies = self.elastic.energies(&self.state.modes);
        energies.zip(&self.seen_by_gyro).filter(|(_, seen)| **seen).map(|(energy, _)| energy).sum()
    }

    /// The energies, as logged.
    pub fn energy(&self) -> Energy {
        Energy {
            rotational_j: self.rigid.energy(&self.state.turn),
            elastic_j: self.elastic_energy(),
            visible_j: self.visible_energy(),
            momentum_nm_s: Rigid::momentum(&self.state.turn).norm(),
        }
    }

    /// The modes, as logged.
    pub fn vibrations(&self) -> Vibrations {
        let modes = &self.state.modes;
        let rates = self.elastic.rates(modes).zip(self.elastic.energies(modes));
        let of = |(phase, (rate, energy_j)): (&crate::body::Phase, (f64, f64))| Vibration {
            displacement: phase.displacement,
            rate,
            energy_j,
        };
        Vibrations { modes: modes.iter().zip(rates).map(of).collect() }
    }

    /// The attitude, as logged, with the angles by which it is beyond its target (rad).
    pub fn pointing(&self, error: [f64; 3]) -> Pointing {
        let q = &self.state.turn.attitude;
        let [roll_rad, pitch_rad, yaw_rad] = crate::body::spatial::angles(q);
        let [roll_error_rad, pitch_error_rad, yaw_error_rad] = error;
        Pointing {
            q_w: q.w,
            q_x: q.i,
            q_y: q.j,
            q_z: q.k,
            roll_rad,
            pitch_rad,
            yaw_rad,
            roll_error_rad,
            pitch_error_rad,
            yaw_error_rad,
        }
    }
}
