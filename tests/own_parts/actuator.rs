//! Custom actuator: a servo that gives torques in whole steps up to a limit, about each axis; it logs its steps.

use std::sync::Arc;

use flexsc_core::control::actuator::{
    Actuator, ActuatorKind, ActuatorPlacement, ActuatorSpec, AxisActuatorContext, AxisEffort, Demand,
};
use flexsc_core::control::custom::Custom;
use flexsc_core::control::part::{Occasion, Part, ReportContext};
use flexsc_core::dynamics::wrench::Wrench;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{CustomField, CustomTopic, Report};

/// Servo with its largest torque and its step (N m).
#[derive(Clone, Debug)]
pub struct Servo {
    pub most: f64,
    pub step: f64,
    /// Topic of the torques and the travel.
    topic: Arc<CustomTopic>,
}

/// Run-time state of the servo: demanded and executed torque about each axis (N m), the inertias (kg m²), and the sum of
/// all changes of the executed torques (N m).
#[derive(Clone, Debug)]
struct Turning(Servo, [[f64; 2]; 3], Vec<f64>, f64);

impl Servo {
    /// Creates the settings of the servo.
    pub fn new(most: f64, step: f64) -> Arc<Self> {
        let fields = vec![
            CustomField::new("torque", "N m", "Torque about the first axis."),
            CustomField::new("travel", "N m", "Sum of all changes of the torques."),
        ];
        let topic = CustomTopic::new("/servo", "Servo that acts in steps.", fields).expect("a topic");
        Arc::new(Self { most, step, topic })
    }

    /// Creates the actuator.
    pub fn kind(most: f64, step: f64) -> ActuatorKind {
        let servo = Self::new(most, step);
        let topics = vec![Arc::clone(&servo.topic)];
        ActuatorKind::Own(Custom::with_topics(servo, topics))
    }
}

impl ActuatorSpec for Servo {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        let inertias = settings.iter().map(|setting| setting.inertia).collect();
        Box::new(Turning(self.clone(), [[0.0; 2]; 3], inertias, 0.0))
    }

    fn limit(&self, _: usize) -> Option<f64> {
        Some(self.most)
    }
}

impl Part for Turning {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Period {
            report.add(self.0.topic.row([self.1[0][1], self.3]).expect("two values"));
        }
    }
}

impl Actuator for Turning {
    fn command(&mut self, _: Instant, demands: &[Demand], _: [f64; 3]) {
        let Self(servo, torques, _, travel) = self;
        for (torque, demand) in torques.iter_mut().zip(demands) {
            if let Demand::Torque(asked) = *demand {
                let given = ((asked / servo.step).round() * servo.step).clamp(-servo.most, servo.most);
                *travel += (given - torque[1]).abs();
                *torque = [asked, given];
            }
        }
    }

    fn apply(&self, _: Instant, onto: &mut Wrench) {
        onto.hub.iter_mut().zip(&self.1).for_each(|(hub, [_, given])| *hub += given);
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        let [demanded, held] = self.1[axis];
        AxisEffort { demanded, held, firing: 0.0, reduced_moment: held / self.2[axis] }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}
