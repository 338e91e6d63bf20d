//! Rows of a cycle of three axes: errors, rates, jets, wheels, and adaptive observers.

use flexsc_control::actuator::Saturation;
use flexsc_record::{Jets, Record, RecordError, Sample, ThreeAxisCycle};

use super::journal_events::JournalEvents;
use crate::scenario::Scenario;
use crate::sim::plant::{Plant, ThreeAxisPlant};
use crate::sim::run_view::RunView;

/// Memory of the rows of the cycles.
#[derive(Clone, Debug)]
pub struct CycleRows {
    /// Number of jet pulses that are already recorded.
    recorded_pulses: u64,
    /// How wheels and magnetorquers reach their limits.
    saturation: Saturation,
}

impl CycleRows {
    /// Creates the memory of a scenario's rows, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let saturation = Saturation::new(&scenario.actuator, scenario.duration.seconds());
        Self { recorded_pulses: 0, saturation }
    }

    /// Returns the warning of the run's end that wheels or magnetorquers have reached their limits.
    pub fn saturation_warning(&self) -> Option<String> {
        self.saturation.warning()
    }

    /// Records the rows of the cycle that begins now.
    pub fn record(
        &mut self,
        run: &RunView<'_>,
        journal: &mut JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let Plant::ThreeAxis(plant) = run.plant else { return Ok(()) };
        let (now, truth) = (run.now, run.plant.truth());
        let cycle = self.cycle(run, plant);
        self.saturation.see(now.seconds(), &cycle);
        record.record(now, Sample::Cycle(&cycle))?;
        if let Some(written) = run.guidance.target_as_written(now) {
            let error = || truth.orientation.error_from(&run.guidance.target(now));
            journal.target(now, written, error, record)?;
        }
        if run.estimation.has_estimator {
            let damped = || run.laws.damping_status();
            let rates = || plant.mode_rates().collect();
            let Some(tracking) = run.estimation.estimator.observer_row(&rates, &damped) else {
                return Ok(());
            };
            record.record(now, Sample::Tracking(&tracking))?;
            let trusted = |axis: usize| run.estimation.estimates[axis].elastic_is_trusted;
            journal.damping_changed(now, &damped(), [0, 1, 2].map(trusted), record)?;
        }
        Ok(())
    }

    /// Returns the row of the cycle that begins now.
    fn cycle(&mut self, run: &RunView<'_>, plant: &ThreeAxisPlant) -> ThreeAxisCycle {
        let (now, actuator) = (run.now, &run.loads.actuator);
        let (rigid, elastic) = plant.rates();
        let jets = actuator.jet_cycle();
        let [roll_on_s, pitch_on_s, yaw_on_s] = jets.as_ref().map_or([0.0; 3], |cycle| cycle.on);
        let fuel_kg = jets.as_ref().map_or(f64::NAN, |cycle| cycle.fuel);
        let fuels_kg = jets.as_ref().map_or_else(Vec::new, |cycle| cycle.fuels.clone());
        let pulses = jets.as_ref().map_or(0, |cycle| cycle.pulses);
        let thrusters = jets.map_or_else(Vec::new, |cycle| cycle.each);
        // Jets may have cycles of their own, which are longer.
        let pulses = pulses - std::mem::replace(&mut self.recorded_pulses, pulses);
        let (elastic_energy_j, visible_energy_j) = plant.elastic_energies();
        let torquers = actuator.magnetorquer_row();
        let moments = torquers.into_iter().flat_map(|torquers| torquers.axes);
        ThreeAxisCycle {
            fuels_kg,
            slewing: run.guidance.slews(now),
            wheels: actuator.wheels(now, (rigid + elastic).into()),
            moments_am2: moments.map(|axis| axis.moment_am2).collect(),
            jets: Jets { roll_on_s, pitch_on_s, yaw_on_s, fuel_kg },
            thrusters,
            pulses,
            elastic_energy_j,
            visible_energy_j,
            rigid_rate_rad_s: rigid.into(),
            elastic_rate_rad_s: elastic.into(),
            error_rad: run.plant.truth().orientation.error_from(run.estimation.origin()),
            stored_nm_s: actuator.stored_momentum(now),
            steered: actuator.steering_record(),
            friction_heat_j: plant.friction_heat(),
        }
    }
}
