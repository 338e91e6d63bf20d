//! Rows of a three-axis motion: attitude, energy, position, drives, hinges, modes and orbit, and the torques that they
//! show.

use flexsc_dynamics::ModeState;
use flexsc_numerics::attitude::Vector;
use flexsc_record::{
    DriveMotion, DrivenMode, DrivesMotion, Energy, HingeMotion, Hinges, Orbit, OrbitAxis, Pointing, Position,
    Report, Vibration, Vibrations,
};
use flexsc_spacecraft::environment::{SurroundingsState, to_body};

use super::three_axis_body::ThreeAxisQuantities;

impl dyn ThreeAxisQuantities + '_ {
    /// Returns the torque on the magnetic moment that magnetorquers hold at the current instant, in body axes (N m).
    pub fn magnetic_torque(&self) -> Vector {
        let t = self.body().evaluated_at.seconds();
        let held = |around: &SurroundingsState| around.magnetic_torque(t, self.attitude());
        self.surroundings().map_or_else(Vector::zeros, held)
    }

    /// Returns the torque of the environment and of the body's own disturbance at the current instant, in body axes (N
    /// m), without that of magnetorquers; `None` if there is neither.
    pub fn environment_torque(&self) -> Option<Vector> {
        self.external_torque().map(|all| all - self.magnetic_torque())
    }

    /// Returns the heat of the wheels' friction since the start (J); NaN without bearings.
    pub fn friction_heat(&self) -> f64 {
        self.two_way().and_then(|segment| segment.motion.friction_heat()).unwrap_or(f64::NAN)
    }

    /// Adds the rows of the plant that depend on nothing else to a report.
    pub fn add_rows(&self, report: &mut Report) {
        report.add(self.vibrations());
        report.add(self.energy());
        self.position().into_iter().for_each(|row| report.add(row));
        self.orbit().into_iter().for_each(|row| report.add(row));
        self.drives().into_iter().for_each(|row| report.add(row));
        self.hinges().into_iter().for_each(|row| report.add(row));
    }

    /// Returns the row of the energies.
    pub fn energy(&self) -> Energy {
        let (rotational_j, momentum_nm_s) = self.rotational_energy();
        let (elastic_j, visible_j) = self.elastic_energies();
        Energy { rotational_j, elastic_j, visible_j, momentum_nm_s }
    }

    /// Returns the row of the first point's position; `None` for a body without forces or with unknown mass.
    pub fn position(&self) -> Option<Position> {
        let [at, speed] = self.two_way()?.motion.position()?;
        Some(Position { x_m: at.x, y_m: at.y, z_m: at.z, x_m_s: speed.x, y_m_s: speed.y, z_m_s: speed.z })
    }

    /// Returns the row of the attitude, with its errors (rad) against the target.
    pub fn pointing(&self, error: [f64; 3]) -> Pointing {
        let q = self.attitude();
        let [roll_rad, pitch_rad, yaw_rad] = flexsc_numerics::attitude::angles(q);
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

    /// Returns the row of the appendages' drives and of the modal frequencies, which change with them; `None` without
    /// drives.
    pub fn drives(&self) -> Option<DrivesMotion> {
        let motion = self.two_way()?.motion;
        let (frequencies, _) = motion.modes().filter(|_| motion.has_drives())?;
        let drive = |[angle_rad, rate_rad_s]: [f64; 2]| DriveMotion { angle_rad, rate_rad_s };
        let mode = |frequency_rad_s: &f64| DrivenMode { frequency_rad_s: *frequency_rad_s };
        Some(DrivesMotion {
            drives: motion.drives(self.body().evaluated_at.seconds()).into_iter().map(drive).collect(),
            modes: frequencies.iter().map(mode).collect(),
        })
    }

    /// Returns the row of the appendages' hinges; `None` without hinges.
    pub fn hinges(&self) -> Option<Hinges> {
        let hinge = |[angle_rad, rate_rad_s]: &[f64; 2]| HingeMotion {
            angle_rad: *angle_rad,
            rate_rad_s: *rate_rad_s,
        };
        let hinges = self.two_way()?.motion.hinges();
        (!hinges.is_empty()).then(|| Hinges { hinges: hinges.iter().map(hinge).collect() })
    }

    /// Returns the row of the orbit; `None` without one.
    pub fn orbit(&self) -> Option<Orbit> {
        let (sky, t) = (self.surroundings()?.sky(), self.body().evaluated_at.seconds());
        let place = sky.position(t)?;
        let here = |v: Vector| to_body(self.attitude(), &v);
        let nowhere = Vector::repeat(f64::NAN);
        let (nadir, field) = (here(place.local[2]), sky.field_at(t).map_or(nowhere, here));
        let sun = sky.sun().map_or(nowhere, |sun| here(sun.direction(t)));
        let axis = |axis: usize| OrbitAxis {
            position_m: place.position[axis],
            velocity_m_s: place.velocity[axis],
            nadir: nadir[axis],
            field_t: field[axis],
            sun: sun[axis],
        };
        Some(Orbit {
            axes: [0, 1, 2].map(axis).into(),
            light: sky.is_lit(t).into(),
            sunlight: sky.part_in_view(t),
        })
    }

    /// Returns the row of the modes.
    pub fn vibrations(&self) -> Vibrations {
        let modes = &self.body().state.modes;
        let rates = self.body().elastic.rates(modes).zip(self.modal_energies());
        let of = |(phase, (rate, energy_j)): (&ModeState, (f64, f64))| Vibration {
            displacement: phase.displacement,
            rate,
            energy_j,
        };
        Vibrations { modes: modes.iter().zip(rates).map(of).collect() }
    }
}
