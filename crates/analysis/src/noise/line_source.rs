//! Lines of machines and unbalanced wheels: loads at multiples of a speed, which are constant or grow with its square.

use flexsc_control::actuator::{TurningLoad, Wheels};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_spacecraft::load_lines::{LoadHarmonic, LoadLines};
use nalgebra::Complex;

use super::lines::LineLoop;
use super::loaded_loop::LoadedLoop;
use super::measured_loads::{MeasuredPart, VibrationLoad};
use super::spectral_line::ComplexLine;
use super::speed_grid::{ResonantSpeed, resonant_speeds, whirl_speeds};
use crate::margins::frequency_response::unit_circle;
use flexsc_scenario::Scenario;

/// Number of equal steps over the speeds.
const STEPS: u32 = 48;
/// Lowest speed of wheels, relative to the largest.
const LOWEST: f64 = 0.05;
/// Difference of orders, relative, below which harmonics of a machine are one line.
const EQUAL: f64 = 1e-12;

/// Source of lines.
pub struct LineSource {
    /// Key of the scenario.
    pub key: String,
    /// Largest speed (rad/s), and the least relative to it; `None` for wheels whose scenario gives none.
    speeds: Option<(f64, f64)>,
    /// True for wheels, whose loads grow with the square of the speed and may whirl on mounts; false for a machine.
    is_wheels: bool,
    harmonics: Vec<HarmonicLoads>,
}

/// Loads of one order: multiple of the speed.
struct HarmonicLoads {
    order: f64,
    /// Number of the wheel of each load, from 1.
    wheels: Vec<usize>,
    loads: Vec<VibrationLoad>,
}

/// Lines of the outputs under one load.
pub struct HarmonicLines {
    /// Order of the load: multiple of the speed.
    pub order: f64,
    /// Number of the wheel, from 1; 0 for a machine.
    pub wheel: usize,
    /// Factor of the loads at the speed.
    pub strength: f64,
    /// Lines of each output under a load of the strength 1, the last that of the load.
    pub outputs: Vec<Vec<ComplexLine>>,
}

impl LineSource {
    /// Returns the source of a machine at a point of a body.
    pub fn of_machine(key: String, lines: &LoadLines, (body, point): (&ThreeAxisModel, &str)) -> Self {
        let mut order: Vec<&LoadHarmonic> = lines.harmonics.iter().collect();
        order.sort_by(|a, b| a.order.get().total_cmp(&b.order.get()));
        let is_one =
            |a: &&LoadHarmonic, b: &&LoadHarmonic| b.order.get() - a.order.get() <= EQUAL * b.order.get();
        // The phases of harmonics of one order are fixed among them.
        let together = |same: &[&LoadHarmonic]| {
            let amplitude = |part: usize| {
                same.iter().map(|own| unit_circle(own.phase.get()) * own.amplitudes()[part]).sum()
            };
            HarmonicLoads {
                order: lines.multiple(same[0]),
                wheels: vec![0],
                loads: vec![VibrationLoad::new(body, point, std::array::from_fn(amplitude))],
            }
        };
        let [least, largest] = lines.range();
        let harmonics = order.chunk_by(is_one).map(together).collect();
        Self { key, speeds: Some((largest, least / largest)), is_wheels: false, harmonics }
    }

    /// Returns the source of a scenario's wheels; `None` for wheels without an imbalance.
    ///
    /// # Errors
    /// An inconsistent key of the wheels, and the reason.
    pub fn of_wheels(scenario: &Scenario) -> Result<Option<Self>, ConfigError> {
        let Some(body) = scenario.model.three_axis() else { return Ok(None) };
        let members = scenario.actuator.members();
        let unbalanced = members.iter().find_map(|own| Some((&own.key, own.kind.unbalanced_wheels()?)));
        let Some((key, wheels)) = unbalanced else { return Ok(None) };
        let loads = wheels.turning_loads(body).map_err(|fault| fault.within(key))?;
        let mut all: Vec<(f64, usize, VibrationLoad)> = Vec::new();
        for (wheel, (point, loads)) in loads.iter().enumerate() {
            let mut carried = scenario.study.carried_rotors.iter();
            let is_backward = carried.any(|own| own.wheel == wheel && own.speed < 0.0);
            for TurningLoad { order, force, moment } in loads {
                let amplitude = |part: usize| {
                    let [cosine, sine] = [0, 1].map(|of: usize| [force[of], moment[of]][part / 3][part % 3]);
                    Complex::new(cosine, if is_backward { sine } else { -sine })
                };
                let load = VibrationLoad::new(body, point, std::array::from_fn(amplitude));
                all.push((*order, wheel + 1, load));
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let together = |same: &[(f64, usize, VibrationLoad)]| HarmonicLoads {
            order: same[0].0,
            wheels: same.iter().map(|own| own.1).collect(),
            loads: same.iter().map(|own| own.2.clone()).collect(),
        };
        Ok(Some(Self {
            key: format!("{key}.imbalance"),
            speeds: largest_speed(wheels).map(|largest| (largest, LOWEST)),
            is_wheels: true,
            harmonics: all.chunk_by(|a, b| a.0 == b.0).map(together).collect(),
        }))
    }

    /// Returns equal steps over the speeds (rad/s), if there are any.
    pub fn steps(&self) -> Option<Vec<f64>> {
        let (largest, least) = self.speeds?;
        let part = |k: u32| least + (1.0 - least) * f64::from(k) / f64::from(STEPS - 1);
        let mut steps: Vec<f64> = (0..STEPS).map(|k| largest * part(k)).collect();
        steps.dedup();
        Some(steps)
    }

    /// Returns the speeds between two (rad/s) at which the loads meet resonances that are narrower than `step`: of the loop, directly or as
    /// aliases, of the modes at each speed if wheels whirl, and the peaks of measured paths of outputs.
    ///
    /// # Errors
    /// See [`OpenLoop::from_scenario`](crate::open_loop::OpenLoop::from_scenario).
    pub fn resonant_speeds(
        &self,
        lines: &LineLoop<'_>,
        outputs: &[usize],
        (range, step): ([f64; 2], f64),
    ) -> Result<Vec<ResonantSpeed>, ConfigError> {
        let mut found = resonant_speeds(&lines.parts, &self.orders(), range, step)?;
        if self.has_whirl(lines) {
            found.extend(whirl_speeds(lines.parts.scenario, &self.orders(), range, step)?);
        }
        found.extend(self.measured_peaks(lines, outputs, range)?);
        Ok(found)
    }

    /// Returns the speeds between two (rad/s) at which the loads meet peaks of measured paths of outputs.
    fn measured_peaks(
        &self,
        lines: &LineLoop<'_>,
        outputs: &[usize],
        range: [f64; 2],
    ) -> Result<Vec<ResonantSpeed>, ConfigError> {
        let mut found = Vec::new();
        for HarmonicLoads { order, loads, .. } in &self.harmonics {
            let loaded = LoadedLoop::new(lines, outputs, loads)?;
            let peaks = loaded.measured().iter().flat_map(MeasuredPart::resonances);
            let peaks = peaks.map(|[at, width]| ResonantSpeed { speed: at / order, width: width / order });
            found.extend(peaks.filter(|peak| (range[0]..range[1]).contains(&peak.speed)));
        }
        Ok(found)
    }

    /// Returns the speeds that are examined for the worst one of some outputs (rad/s), in increasing order: equal steps, and where the loads
    /// meet resonances; for wheels those of modes, without aliases.
    ///
    /// # Errors
    /// See [`Self::resonant_speeds`].
    pub fn examined_speeds(&self, lines: &LineLoop<'_>, outputs: &[usize]) -> Result<Vec<f64>, ConfigError> {
        let mut speeds = self.steps().unwrap_or_default();
        if let [first, second, .., last] = speeds[..] {
            let (range, step) = ([first, last], second - first);
            let met = if self.is_wheels {
                let mut met = whirl_speeds(lines.parts.scenario, &self.orders(), range, step)?;
                met.extend(self.measured_peaks(lines, outputs, range)?);
                met
            } else {
                self.resonant_speeds(lines, outputs, (range, step))?
            };
            speeds.extend(met.into_iter().map(|peak| peak.speed));
            speeds.sort_by(f64::total_cmp);
            speeds.dedup();
        }
        Ok(speeds)
    }

    /// Returns true if the loop changes with the speed of wheels.
    pub fn has_whirl(&self, lines: &LineLoop<'_>) -> bool {
        self.is_wheels && !lines.parts.scenario.study.carried_rotors.is_empty()
    }

    /// Returns the orders of the loads.
    fn orders(&self) -> Vec<f64> {
        self.harmonics.iter().map(|own| own.order).collect()
    }

    /// Computes the lines of some outputs at a speed (rad/s): under each load alone.
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit, and a loop that is unstable with the wheels at the speed.
    pub fn at(
        &self,
        lines: &LineLoop<'_>,
        speed: f64,
        outputs: &[usize],
    ) -> Result<Vec<HarmonicLines>, ConfigError> {
        let own = if self.is_wheels { lines.at_wheel_speed(speed)? } else { None };
        let strength = if self.is_wheels { speed * speed } else { 1.0 };
        let mut found = Vec::new();
        for HarmonicLoads { order, wheels, loads } in &self.harmonics {
            let loaded = LoadedLoop::new(own.as_ref().unwrap_or(lines), outputs, loads)?;
            let all = wheels.iter().zip(loaded.lines(order * speed)?);
            found.extend(all.map(|(wheel, outputs)| HarmonicLines {
                order: *order,
                wheel: *wheel,
                strength,
                outputs,
            }));
        }
        Ok(found)
    }
}

/// Returns the largest speed of the wheels (rad/s) that their keys give: their limit, or the largest of their speeds.
fn largest_speed(wheels: &Wheels) -> Option<f64> {
    let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
    let limit = wheels.speed_limit.map(Positive::get).or(by_momentum);
    limit.or(Some(wheels.largest_initial_speed())).filter(|speed| *speed > 0.0)
}
