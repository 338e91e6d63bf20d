//! Custom sensor: an encoder that measures angles in whole steps, and no rates; it logs its last count.

use std::sync::Arc;

use flexsc_core::control::custom::Custom;
use flexsc_core::control::part::{Occasion, Part, ReportContext};
use flexsc_core::control::sensor::{Reading, Sensor, SensorKind, SensorSpec, Truth};
use flexsc_core::numerics::random::Seed;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{CustomField, CustomTopic, Report};

/// Encoder with its step (rad) and its period (s).
#[derive(Clone, Debug)]
pub struct Encoder {
    pub step: f64,
    pub period: f64,
    /// Topic of the counts.
    topic: Arc<CustomTopic>,
}

/// Run-time state of the encoder, with its last counts about the axes.
#[derive(Clone, Debug)]
struct Counting(Encoder, [f64; 3]);

impl Encoder {
    /// Creates the sensor.
    pub fn kind(step: f64, period: f64) -> SensorKind {
        let field = |axis: &str| CustomField::new(axis, "", "Last count about the axis.");
        let topic = CustomTopic::new("/encoder", "Counts of an encoder.", ["x", "y", "z"].map(field).into());
        let topic = topic.expect("a topic");
        let topics = vec![Arc::clone(&topic)];
        SensorKind::Own(Custom::with_topics(Arc::new(Self { step, period, topic }), topics))
    }
}

impl SensorSpec for Encoder {
    fn start(&self, _: usize, _: Seed, _: usize) -> Box<dyn Sensor> {
        Box::new(Counting(self.clone(), [0.0; 3]))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(Span::from_seconds(self.period))
    }

    fn angle_noise(&self) -> f64 {
        self.step / 12.0_f64.sqrt()
    }
}

impl Part for Counting {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Period {
            report.add(self.0.topic.row(self.1).expect("three values"));
        }
    }
}

impl Sensor for Counting {
    fn read(&mut self, _: Instant, truth: &Truth, _: Option<&Reading>) -> Option<Reading> {
        let Self(Encoder { step, .. }, counts) = self;
        *counts = truth.sensor_angles().map(|angle| (angle / *step).round());
        let steps = counts.map(|count| count * *step);
        Some(Reading { at: truth.orientation.rotated_by(steps), rate: None, sight: None })
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}
