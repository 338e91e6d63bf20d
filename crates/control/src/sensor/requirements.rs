//! Requirements and offers of the sensors of a scenario.

use flexsc_numerics::time::Span;

use super::SensorKind;
use crate::offers::{Offers, SensorOffers};
use crate::one_or_many::OneOrMany;
use crate::requirement::{OFF_HUB, Requirements};

impl SensorKind {
    /// Adds the requirements of the sensor on the other parts of a scenario; `ordinal` counts earlier sensors of its kind.
    fn add_requirements(&self, ordinal: usize, offers: &Offers, needs: &mut Requirements) {
        if let Some(point) = self.point() {
            offers.require_three_axes(needs, "point", "");
            needs.require(offers.body.has_motion_at(point), "point", OFF_HUB);
        }
        needs.require(
            self.is_continuous() || !self.measures_motion() || self.period(offers.law_period).is_some(),
            "",
            "must have a `period` with a law that has none of its own",
        );
        needs.report(self.validate());
        self.requires(ordinal, offers, needs);
    }
}

impl OneOrMany<SensorKind> {
    /// Returns the key of a sensor, including its kind.
    pub fn sensor_key(&self, index: usize) -> String {
        format!("{}.{}", self.key("sensor", index), self[index].kind())
    }

    /// Returns the offers of all sensors together, under a law with period `law`.
    pub fn offers(&self, law: Option<Span>) -> SensorOffers {
        SensorOffers {
            motion_sensors: self.motion_sensors(),
            vector_sensors: self.iter().filter(|sensor| sensor.measures_vector()).count(),
            is_continuous: self.iter().any(|sensor| sensor.is_continuous()),
            magnetic_field: self.iter().any(|sensor| sensor.measures_field()),
            period: self.period(law),
            angle_noise: self.angle_noise(),
        }
    }

    /// Adds the requirements of all sensors.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        for (index, sensor) in self.iter().enumerate() {
            needs.set_part(self.sensor_key(index));
            sensor.add_requirements(self.index_in_kind(index), offers, needs);
        }
    }
}

/// Adds the requirement of three axes for a sensor of the attitude or of a vector.
pub(super) fn require_attitude(offers: &Offers, needs: &mut Requirements) {
    needs.require_axes(
        offers.body.axes == 3,
        "",
        "measures three axes: use a `sampled` sensor for a body with one angle",
    );
}
