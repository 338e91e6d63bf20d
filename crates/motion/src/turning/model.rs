//! What a turning flexible body is: its inertia, free modes and rotors, and the constants that follow.

use super::heated::Heated;
use nalgebra::{DMatrix, Matrix3, Quaternion};

use super::vectors::Vectors;
use crate::attitude::Vector;
use crate::lanes::{Four, Real};

/// A free mode: of the whole body, in axes that follow its total momentum, mass-normalised.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMode {
    /// Natural frequency W (rad/s).
    pub frequency: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Rotation of the hub for a unit of the mode (rad/(m sqrt(kg))).
    pub rotation: Vector,
    /// Change of the inertia tensor for a unit of the mode (sqrt(kg) m).
    pub moments: Matrix3<f64>,
}

/// A flexible body that turns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flexible {
    /// Inertia tensor about the centre of mass (kg m²), without what rotors have about their axes.
    pub inertia: Matrix3<f64>,
    /// The free modes.
    pub modes: Vec<FreeMode>,
    /// The damping matrix of all modes (1/s) where what is beside its diagonal counts; the diagonal then replaces the modes'
    /// damping ratios.
    pub damping: Option<DMatrix<f64>>,
}

/// A rotor under way: h' = u.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Rotor {
    /// Its axis, a unit vector of the body.
    pub axis: Vector,
    /// Angular momentum about the axis, with what the body's rate gives it (N m s).
    pub momentum: f64,
    /// Torque on the rotor about its axis, of motor and bearing together (N m), until the next departure.
    pub torque: f64,
}

/// What the surroundings do to a body.
pub trait Surroundings {
    /// The torque in the body's axes (N m) at a time since the start (s), where the hub faces this way and the body has this
    /// inertia (kg m²).
    fn torque(&self, t: f64, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector;

    /// The tensor (1/s²) whose product with what a unit of a mode adds to the inertia, element by element, is the force on the
    /// mode; none if there is no such force.
    fn tide(&self, t: f64, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>>;

    /// Forces on the modes that are warmed.
    fn heated(&self) -> &[Heated] {
        &[]
    }

    /// No torque is larger (N m).
    fn bound(&self) -> f64;

    /// How fast it changes by itself (rad/s).
    fn frequency(&self) -> f64;
}

/// The constants of the motion.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// J.
    pub inertia: Matrix3<f64>,
    /// J^-1.
    pub inverse: Matrix3<f64>,
    /// The inertia that is left to the hub, the inverse of J^-1 + sum phi phi'.
    pub left: Matrix3<f64>,
    /// sum phi phi'.
    pub bending: Matrix3<f64>,
    /// No rigid rate is larger for a unit of angular momentum (1/(kg m²)).
    pub mobility: f64,
    pub modes: Vec<Constants>,
    /// The same, four modes side by side, and so that a vector of a mode fills a register.
    pub abreast: Vec<Abreast>,
    pub filled: Vec<Filled>,
    /// The damping matrix without its diagonal (1/s).
    pub beside: Option<DMatrix<f64>>,
    /// Whether any mode changes the inertia.
    pub stretches: bool,
    /// Sum of |phi|, |sum phi phi'| and the largest |J1| of a mode.
    pub reach: f64,
    pub bendable: f64,
    pub stretchable: f64,
    /// The frequencies of modes that turn the hub or change the inertia (rad/s).
    pub felt: Vec<f64>,
    /// By which instructions the stages of a step are found.
    pub lanes: Four,
}

/// The constants of four modes side by side; places without one have a mode that nothing moves.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(super) struct Abreast {
    pub frequency: [f64; 4],
    pub rotation: [[f64; 4]; 3],
    pub moments: [[f64; 4]; 6],
}

impl Abreast {
    fn new(modes: &[Constants]) -> Self {
        let of =
            |lane: usize, part: &dyn Fn(&Constants) -> f64, none: f64| modes.get(lane).map_or(none, part);
        let each =
            |part: &dyn Fn(&Constants) -> f64, none: f64| [0, 1, 2, 3].map(|lane| of(lane, part, none));
        Self {
            frequency: each(&|mode| mode.frequency, 1.0),
            rotation: [0, 1, 2].map(|axis| each(&|mode| mode.rotation[axis], 0.0)),
            moments: [0, 1, 2, 3, 4, 5].map(|entry| each(&|mode| mode.moments[entry], 0.0)),
        }
    }

    /// The products of the modes' rotations with a vector.
    #[inline(always)]
    pub fn along<R: Real>(&self, kind: R, v: &Vector) -> R {
        let [x, y, z] = &self.rotation;
        Vectors { x: kind.load(x), y: kind.load(y), z: kind.load(z) }.along(v)
    }

    /// What the rotation does to the modes by each number of their moments.
    #[inline(always)]
    pub fn moved<R: Real>(&self, kind: R, [a, b, c, d, e, f]: &[f64; 6]) -> R {
        let [xx, yy, zz, yz, zx, xy] = &self.moments;
        (kind.load(xx) * *a + kind.load(yy) * *b + kind.load(zz) * *c)
            + (kind.load(yz) * *d + kind.load(zx) * *e + kind.load(xy) * *f)
    }
}

/// The constants of a mode in registers of four: nothing fills what is left.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(super) struct Filled {
    pub frequency: f64,
    pub rotation: [f64; 4],
    pub moments: [[f64; 4]; 2],
}

impl Filled {
    fn new(mode: &Constants) -> Self {
        let ([x, y, z], [xx, yy, zz, yz, zx, xy]) = (mode.rotation.into(), mode.moments);
        Self {
            frequency: mode.frequency,
            rotation: [x, y, z, 0.0],
            moments: [[xx, yy, zz, yz], [zx, xy, 0.0, 0.0]],
        }
    }
}

/// The constants of a mode.
#[derive(Clone, Debug)]
pub(super) struct Constants {
    pub frequency: f64,
    pub damping: f64,
    pub rotation: Vector,
    /// xx, yy, zz, yz, zx and xy of the change of the inertia tensor.
    pub moments: [f64; 6],
}

impl Constants {
    /// The force of accelerations that grow outward, as [`outward`] gives them (N/sqrt(kg)).
    pub fn moved(&self, outward: &[f64; 6]) -> f64 {
        let [xx, yy, zz, yz, zx, xy] = self.moments;
        let [a, b, c, d, e, f] = outward;
        (xx * a + yy * b + zz * c) + (yz * d + zx * e + xy * f)
    }

    /// The force of a tide (N/sqrt(kg)).
    pub fn pulled(&self, tide: &Matrix3<f64>) -> f64 {
        let [xx, yy, zz, yz, zx, xy] = self.moments;
        let across = yz * tide.m23 + zx * tide.m31 + xy * tide.m12;
        xx * tide.m11 + yy * tide.m22 + zz * tide.m33 + 2.0 * across
    }
}

/// What a rate's centrifugal acceleration does by each number of a mode's moments: 1/2 w' J1 w is their product (rad²/s²).
pub(super) fn outward(rate: &Vector) -> [f64; 6] {
    let [x, y, z] = [rate.x, rate.y, rate.z];
    [0.5 * x * x, 0.5 * y * y, 0.5 * z * z, y * z, z * x, x * y]
}

/// Rotations and moments below this part of what a mode can have are rounding.
const ROUNDING: f64 = 1e-9;

impl Model {
    /// The constants of a body.
    pub fn new(body: &Flexible) -> Self {
        // A body that was checked has an inverse.
        let inverted = |m: Matrix3<f64>| symmetric(m.try_inverse().unwrap_or_else(Matrix3::identity));
        let inverse = inverted(body.inertia);
        let bending = body.modes.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, mode| {
            sum + mode.rotation * mode.rotation.transpose()
        });
        let constants = |(index, mode): (usize, &FreeMode)| {
            let m = symmetric(mode.moments);
            let damping = body.damping.as_ref().map(|d| d[(index, index)] / (2.0 * mode.frequency));
            Constants {
                frequency: mode.frequency,
                damping: damping.unwrap_or(mode.damping),
                rotation: mode.rotation,
                moments: [m.m11, m.m22, m.m33, m.m23, m.m13, m.m12],
            }
        };
        let modes: Vec<Constants> = body.modes.iter().enumerate().map(constants).collect();
        let size = f64::sqrt(body.inertia.norm());
        let felt = body
            .modes
            .iter()
            .filter(|mode| mode.rotation.norm() * size > ROUNDING || mode.moments.norm() > ROUNDING * size);
        Self {
            left: inverted(inverse + bending),
            inertia: body.inertia,
            mobility: inverse.norm(),
            inverse,
            bending,
            abreast: modes.chunks(4).map(Abreast::new).collect(),
            filled: modes.iter().map(Filled::new).collect(),
            modes,
            beside: body.damping.as_ref().map(|damping| {
                let mut beside = damping.clone();
                beside.fill_diagonal(0.0);
                beside
            }),
            stretches: body.modes.iter().any(|mode| mode.moments.norm() > 0.0),
            felt: felt.map(|mode| mode.frequency).collect(),
            lanes: Four::best(),
            reach: body.modes.iter().map(|mode| mode.rotation.norm()).sum(),
            bendable: bending.norm(),
            stretchable: body.modes.iter().map(|mode| mode.moments.norm()).fold(0.0, f64::max),
        }
    }

    /// The momentum Gt that turns the body as if it were rigid, and the rate of the hub, under a change of the inertia:
    /// (J_left + J1) w = G + J_left phi P and Gt = G - J1 w.
    pub fn rates(&self, momentum: &Vector, elastic: &Vector, changed: &Matrix3<f64>) -> (Vector, Vector) {
        let rate = solved(&(self.left + changed), &(momentum + self.left * elastic));
        (momentum - changed * rate, rate)
    }
}

impl Model {
    /// As [`Model::rates`], in lanes, by changes xx, yy, zz, yz, zx and xy of the inertia.
    #[inline(always)]
    pub fn rates_of<R: Real>(
        &self,
        kind: R,
        momentum: Vectors<R>,
        elastic: Vectors<R>,
        changed: &[R; 6],
    ) -> (Vectors<R>, Vectors<R>) {
        let m = &self.left;
        let xx = kind.of(m.m11) + changed[0];
        let yy = kind.of(m.m22) + changed[1];
        let zz = kind.of(m.m33) + changed[2];
        let yz = kind.of(m.m32) + changed[3];
        let zx = kind.of(m.m31) + changed[4];
        let xy = kind.of(m.m21) + changed[5];
        let v = momentum + elastic.through(m);
        // Cramer's rule.
        let first = Vectors { x: yy * zz - yz * yz, y: yz * zx - xy * zz, z: xy * yz - yy * zx };
        let (second, third, across) = (zz * xx - zx * zx, xx * yy - xy * xy, xy * zx - xx * yz);
        let one = kind.of(1.0) / (xx * first.x + xy * first.y + zx * first.z);
        let rate = Vectors {
            x: first.dot(v) * one,
            y: (first.y * v.x + second * v.y + across * v.z) * one,
            z: (first.z * v.x + across * v.y + third * v.z) * one,
        };
        (momentum - rate.stretched(changed), rate)
    }
}

/// Symmetric to the last bit, so that energies are quadratic forms.
fn symmetric(matrix: Matrix3<f64>) -> Matrix3<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// The solution of M x = v of a symmetric matrix by Cramer's rule; not finite if there is none.
#[inline]
fn solved(m: &Matrix3<f64>, v: &Vector) -> Vector {
    let (xx, yy, zz, yz, zx, xy) = (m.m11, m.m22, m.m33, m.m32, m.m31, m.m21);
    let first = Vector::new(yy * zz - yz * yz, yz * zx - xy * zz, xy * yz - yy * zx);
    let (second, third) = (zz * xx - zx * zx, xx * yy - xy * xy);
    let across = xy * zx - xx * yz;
    let one = 1.0 / (xx * first.x + xy * first.y + zx * first.z);
    Vector::new(
        first.dot(v) * one,
        (first.y * v.x + second * v.y + across * v.z) * one,
        (first.z * v.x + across * v.y + third * v.z) * one,
    )
}

/// The tensor of xx, yy, zz, yz, zx and xy.
pub(super) fn tensor([xx, yy, zz, yz, zx, xy]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}
