//! Parallel projection of a spacecraft onto a picture.

use flexsc_core::numerics::attitude::Vector;

/// Azimuth and elevation of the viewer (rad).
const VIEW: [f64; 2] = [-0.907_571, 0.418_879];

/// Parallel projection with a scale.
#[derive(Copy, Clone, Debug)]
pub struct Projection {
    right: Vector,
    up: Vector,
    /// Direction to the viewer.
    pub eye: Vector,
    /// Length of a pixel (m), and the point of the projected plane in the middle of the picture (m).
    pub pixel: f64,
    middle: [f64; 2],
    /// Middle of the picture.
    centre: [f64; 2],
}

impl Projection {
    /// Creates the projection that shows these points within a picture of a size, without its margins.
    pub fn fitting(points: &[Vector], [width, height]: [f64; 2], [left, top]: [f64; 2]) -> Self {
        let [(sin_az, cos_az), (sin_el, cos_el)] = VIEW.map(libm::sincos);
        let mut made = Self {
            right: Vector::new(-sin_az, cos_az, 0.0),
            up: Vector::new(-cos_az * sin_el, -sin_az * sin_el, cos_el),
            eye: Vector::new(cos_az * cos_el, sin_az * cos_el, sin_el),
            pixel: 1.0,
            middle: [0.0; 2],
            centre: [width / 2.0, height / 2.0],
        };
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for point in points {
            for (axis, value) in [point.dot(&made.right), point.dot(&made.up)].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
        let room = [width - 2.0 * left, height - 2.0 * top];
        let pixel = [0, 1].map(|axis| (high[axis] - low[axis]) / room[axis]);
        made.pixel = pixel[0].max(pixel[1]).max(f64::MIN_POSITIVE);
        made.middle = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]));
        made
    }

    /// Returns the place of a point in the picture.
    pub fn place(&self, point: &Vector) -> [f64; 2] {
        [
            self.centre[0] + (point.dot(&self.right) - self.middle[0]) / self.pixel,
            self.centre[1] - (point.dot(&self.up) - self.middle[1]) / self.pixel,
        ]
    }

    /// Returns the direction of a vector in the picture, for a vector of length 1 in the plane of length 1.
    pub fn direction(&self, vector: &Vector) -> [f64; 2] {
        [vector.dot(&self.right), -vector.dot(&self.up)]
    }

    /// Returns the distance of a point towards the viewer (m).
    pub fn depth(&self, point: &Vector) -> f64 {
        point.dot(&self.eye)
    }

    /// Returns a point as the text of a path.
    pub fn text(&self, point: &Vector) -> String {
        let [x, y] = self.place(point);
        format!("{x:.1},{y:.1}")
    }

    /// Returns points as the text of a path.
    pub fn path(&self, points: &[Vector]) -> String {
        points.iter().map(|point| self.text(point)).collect::<Vec<_>>().join(" L")
    }
}
