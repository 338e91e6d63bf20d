//! Attitude filter with measured vectors and directions against exact laws.

use flexsc_flight::attitude_filter::AttitudeBiasFilter;
use flexsc_flight::attitude_observation::{AttitudeObservation, ObservationKind};
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::vector3::Vector3;

/// Checks that a vector measured with small noise corrects like an attitude whose noise about the vector is infinite.
#[test]
fn a_vector_corrects_across_itself_alone() {
    let truth = Quaternion::rotation(&Vector3::new(0.3, -0.7, 1.1));
    let off = Vector3::new(2e-6, -3e-6, 1e-6);
    let begins = AttitudeBiasFilter::new(truth.times(&Quaternion::rotation(&off)), Vector3::ZERO, 1e-3, 1e-5);
    let inertial = Vector3::new(2.0, -1.0, 0.5).scaled(1e-5);
    let body = truth.to_body(&inertial);
    let (deviation, along) = (1e-8, body.normalized());
    for kind in [ObservationKind::Vector, ObservationKind::Direction] {
        let is_direction = kind == ObservationKind::Direction;
        let scale = if is_direction { body.norm() } else { 1.0 };
        let noise = deviation * deviation / (scale * scale);
        let observation = AttitudeObservation {
            kind,
            vector: body.divided(scale),
            inertial: inertial.divided(scale),
            noise: Matrix3 { rows: [[noise, 0.0, 0.0], [0.0, noise, 0.0], [0.0, 0.0, noise]] },
            ..AttitudeObservation::NONE
        };
        let mut filter = begins;
        let correction = filter.observe(&observation, f64::INFINITY);
        assert!(
            correction.status.has_corrected() && correction.components == if is_direction { 2 } else { 3 }
        );
        // Remaining attitude error perpendicular to the vector, and its variance; along the vector there is no
        // information.
        let remaining = filter.attitude.rotation_to(&truth);
        let variance = deviation * deviation / body.norm_squared();
        let part = variance / (variance + 1e-6);
        let (known, across_part) = (along.scaled(along.dot(&off)), off.minus(&along.scaled(along.dot(&off))));
        let exact = known.plus(&across_part.scaled(part)).scaled(-1.0);
        assert!(remaining.minus(&exact).norm() < 1e-10, "{remaining:?} {exact:?}");
        let across = along.cross(&Vector3::new(1.0, 0.0, 0.0)).normalized();
        let variance_along = |axis: &Vector3| {
            let mut block = Matrix3::ZERO;
            for row in 0..3 {
                block.rows[row].copy_from_slice(&filter.covariance.rows[row][..3]);
            }
            axis.dot(&block.times(axis))
        };
        assert!(
            (variance_along(&along) / 1e-6 - 1.0).abs() < 1e-9
                && (variance_along(&across) / (1e-6 * part) - 1.0).abs() < 1e-9
        );
        assert!(correction.innovation.plus(&across_part).norm() < 1e-10);
        let nis = across_part.norm_squared() / (variance + 1e-6);
        assert!((correction.nis / (if is_direction { 1.5 * nis } else { nis }) - 1.0).abs() < 1e-4);
    }
}
