//! Exact motion of one mode under pulses, and its derivative with respect to the mode's natural frequency.
//!
//! q'' + 2 zeta w q' + w² q = u in the state [p, s] = [q', w q], so that x' = K x + [u, 0] with
//! K = [[-2 zeta w, -w], [w, 0]] (\[Timakov14\], equation (2); the closed forms are ours).

/// State vector: the modal rate p, and s = w q, which lags p by a quarter of a period, in the same unit.
pub type ModeVector = [f64; 2];

/// Oscillator that models one mode.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct OscillatorModel {
    /// Natural frequency w (rad/s).
    pub frequency: f64,
    /// Damping ratio zeta, below 1.
    pub damping: f64,
}

impl OscillatorModel {
    /// Returns the transition exp(K t) over `time` (s), row by row.
    pub fn transition(&self, time: f64) -> [ModeVector; 2] {
        let zeta = self.damping;
        let root = f64::sqrt((1.0 - zeta) * (1.0 + zeta));
        let turn = self.frequency * time;
        let (sin, cos) = libm::sincos(root * turn);
        let (shrink, sin) = (libm::exp(-zeta * turn), sin / root);
        [[shrink * (cos - zeta * sin), -shrink * sin], [shrink * sin, shrink * (cos + zeta * sin)]]
    }

    /// Returns the state after a transition over `time` (s), and its derivative with respect to ln w.
    pub fn propagate(
        &self,
        transition: &[ModeVector; 2],
        time: f64,
        phase: ModeVector,
    ) -> (ModeVector, ModeVector) {
        let initial = times(transition, phase);
        let turn = self.frequency * time;
        (initial, [turn * (-2.0 * self.damping * initial[0] - initial[1]), turn * initial[0]])
    }

    /// Returns the state after a pulse of unit acceleration that began and ended this long ago (s), and its derivative
    /// with respect to ln w. A negative time lies in the future: only the past part of the pulse counts.
    pub fn pulse_response(&self, began: f64, ended: f64) -> (ModeVector, ModeVector) {
        let (whole, rest) = (self.step(began.max(0.0)), self.step(ended.max(0.0)));
        (minus(whole.0, rest.0), minus(whole.1, rest.1))
    }

    /// Returns the state after a unit acceleration over `time` (s), and its derivative with respect to ln w.
    fn step(&self, time: f64) -> (ModeVector, ModeVector) {
        if time == 0.0 {
            return ([0.0; 2], [0.0; 2]);
        }
        let [[stays, _], [turns, _]] = self.transition(time);
        let step_response =
            [turns / self.frequency, (1.0 - stays - 2.0 * self.damping * turns) / self.frequency];
        (step_response, minus([time * stays, time * turns], step_response))
    }
}

/// Returns the product of a matrix (rows) and a vector.
fn times(matrix: &[ModeVector; 2], v: ModeVector) -> ModeVector {
    [matrix[0][0] * v[0] + matrix[0][1] * v[1], matrix[1][0] * v[0] + matrix[1][1] * v[1]]
}

fn minus(a: ModeVector, b: ModeVector) -> ModeVector {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODE: OscillatorModel = OscillatorModel { frequency: 0.4 * std::f64::consts::PI, damping: 0.005 };

    #[track_caller]
    fn close(value: f64, exact: f64, within: f64) {
        assert!((value - exact).abs() <= within, "{value} is off {exact}");
    }

    #[test]
    fn a_mode_turns_and_is_pushed() {
        let [[a, b], [c, d]] = MODE.transition(0.2);
        for (value, exact) in [(a, 0.966_125_66), (b, -0.248_377_64), (c, 0.248_377_64), (d, 0.968_609_44)] {
            close(value, exact, 1e-8);
        }
        let ((whole, slope), (short, _)) = (MODE.pulse_response(0.2, 0.0), MODE.pulse_response(0.2, 0.15));
        for (value, exact) in [
            (whole[0], 0.197_652_64),
            (whole[1], 0.024_979_82),
            (short[0], 0.048_679_78),
            (short[1], 0.010_893_31),
        ] {
            close(value, exact, 1e-8);
        }
        close(slope[0] / MODE.frequency, -0.003_523_30, 1e-8);
        close(slope[1] / MODE.frequency, 0.019_652_22, 1e-8);
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        let h = 1e-5;
        let off = |factor: f64| OscillatorModel { frequency: MODE.frequency * libm::exp(factor * h), ..MODE };
        let phase = [0.3, -0.7];
        let free_phase = |model: OscillatorModel| model.propagate(&model.transition(0.2), 0.2, phase).0;
        let (_, slope) = MODE.propagate(&MODE.transition(0.2), 0.2, phase);
        let pulse = MODE.pulse_response(0.17, 0.04).1;
        for axis in 0..2 {
            let turn = (free_phase(off(1.0))[axis] - free_phase(off(-1.0))[axis]) / (2.0 * h);
            close(slope[axis], turn, 1e-9);
            let pushed = |model: OscillatorModel| model.pulse_response(0.17, 0.04).0[axis];
            let push = (pushed(off(1.0)) - pushed(off(-1.0))) / (2.0 * h);
            close(pulse[axis], push, 1e-9);
        }
    }

    #[test]
    fn a_pulse_to_come_does_nothing() {
        assert_eq!(MODE.pulse_response(-0.1, -0.3).0, [0.0, 0.0]);
        // Of a pulse in progress, only the past part counts.
        assert_eq!(MODE.pulse_response(0.1, -0.1), MODE.pulse_response(0.1, 0.0));
    }
}
