//! Constants of a body that the integrator derives once: inverse and residual inertia, and mode constants in SIMD order.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::lanes::{LaneFloat, SimdWidth4};
use nalgebra::{DMatrix, Matrix3};

use super::body::{FlexibleBody, FreeMode};
use super::vectors::Vectors;

/// Constants of a body used by the integrator.
#[derive(Clone, Debug)]
pub(super) struct BodyConstants {
    /// Inertia J (kg m²).
    pub inertia: Matrix3<f64>,
    /// Inverse inertia J^-1.
    pub inverse: Matrix3<f64>,
    /// Residual inertia J_left of the hub, the inverse of J^-1 + sum phi phi'.
    pub residual_inertia: Matrix3<f64>,
    /// Sum of phi phi' over the modes.
    pub bending: Matrix3<f64>,
    /// Largest rigid rate per unit of angular momentum (1/(kg m²)).
    pub mobility: f64,
    pub modes: Vec<ModeConstants>,
    /// Mode constants in groups of four, and padded so that a vector of a mode fills a register.
    pub groups_of_four: Vec<ModeGroup4>,
    pub padded: Vec<PaddedMode>,
    /// Off-diagonal part of the damping matrix (1/s).
    pub coupled_damping: Option<DMatrix<f64>>,
    /// True if any mode changes the inertia.
    pub changes_inertia: bool,
    /// Sum of |phi|, |sum phi phi'|, and the largest |J1| of a mode.
    pub rotation_sum: f64,
    pub bending_bound: f64,
    pub inertia_change_bound: f64,
    /// Frequencies of the modes that rotate the hub or change the inertia (rad/s).
    pub coupled_frequencies: Vec<f64>,
    /// SIMD instruction set used for the stages of a step.
    pub lanes: SimdWidth4,
}

/// Constants of four modes in SIMD lanes; unused lanes have a mode without coupling.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(super) struct ModeGroup4 {
    pub frequency: [f64; 4],
    pub rotation: [[f64; 4]; 3],
    pub moments: [[f64; 4]; 6],
}

impl ModeGroup4 {
    fn new(modes: &[ModeConstants]) -> Self {
        let of =
            |lane: usize, part: &dyn Fn(&ModeConstants) -> f64, none: f64| modes.get(lane).map_or(none, part);
        let each =
            |part: &dyn Fn(&ModeConstants) -> f64, none: f64| [0, 1, 2, 3].map(|lane| of(lane, part, none));
        Self {
            frequency: each(&|mode| mode.frequency, 1.0),
            rotation: [0, 1, 2].map(|axis| each(&|mode| mode.rotation[axis], 0.0)),
            moments: [0, 1, 2, 3, 4, 5].map(|entry| each(&|mode| mode.moments[entry], 0.0)),
        }
    }

    /// Returns the scalar products of the modes' rotations with a vector.
    #[inline(always)]
    pub fn dot_rotation<R: LaneFloat>(&self, kind: R, v: &Vector) -> R {
        let [x, y, z] = &self.rotation;
        Vectors { x: kind.load(x), y: kind.load(y), z: kind.load(z) }.dot_shared(v)
    }

    /// Returns the modal forces by centrifugal terms (as [`centrifugal_terms`] returns them).
    #[inline(always)]
    pub fn centrifugal_force<R: LaneFloat>(&self, kind: R, [a, b, c, d, e, f]: &[f64; 6]) -> R {
        let [xx, yy, zz, yz, zx, xy] = &self.moments;
        (kind.load(xx) * *a + kind.load(yy) * *b + kind.load(zz) * *c)
            + (kind.load(yz) * *d + kind.load(zx) * *e + kind.load(xy) * *f)
    }
}

/// Constants of one mode, padded with zeros to registers of four.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(super) struct PaddedMode {
    pub frequency: f64,
    pub rotation: [f64; 4],
    pub moments: [[f64; 4]; 2],
}

impl PaddedMode {
    fn new(mode: &ModeConstants) -> Self {
        let ([x, y, z], [xx, yy, zz, yz, zx, xy]) = (mode.rotation.into(), mode.moments);
        Self {
            frequency: mode.frequency,
            rotation: [x, y, z, 0.0],
            moments: [[xx, yy, zz, yz], [zx, xy, 0.0, 0.0]],
        }
    }
}

/// Constants of a mode.
#[derive(Clone, Debug)]
pub(super) struct ModeConstants {
    pub frequency: f64,
    pub damping: f64,
    pub rotation: Vector,
    /// Change of the inertia tensor per unit of the mode: xx, yy, zz, yz, zx and xy.
    pub moments: [f64; 6],
}

impl ModeConstants {
    /// Returns the centrifugal force on the mode for the terms of [`centrifugal_terms`] (N/sqrt(kg)).
    pub fn centrifugal_force(&self, terms: &[f64; 6]) -> f64 {
        let [xx, yy, zz, yz, zx, xy] = self.moments;
        let [a, b, c, d, e, f] = terms;
        (xx * a + yy * b + zz * c) + (yz * d + zx * e + xy * f)
    }

    /// Returns the tidal force on the mode (N/sqrt(kg)).
    pub fn tidal_force(&self, tide: &Matrix3<f64>) -> f64 {
        let [xx, yy, zz, yz, zx, xy] = self.moments;
        let across = yz * tide.m23 + zx * tide.m31 + xy * tide.m12;
        xx * tide.m11 + yy * tide.m22 + zz * tide.m33 + 2.0 * across
    }
}

/// Returns the factors of xx, yy, zz, yz, zx and xy of a mode's change of inertia in the centrifugal force 1/2 w' J1
/// w (rad²/s²).
pub(super) fn centrifugal_terms(rate: &Vector) -> [f64; 6] {
    let [x, y, z] = [rate.x, rate.y, rate.z];
    [0.5 * x * x, 0.5 * y * y, 0.5 * z * z, y * z, z * x, x * y]
}

/// Fraction of a mode's possible rotation and moments below which they are rounding errors.
const ROUNDING: f64 = 1e-9;

impl BodyConstants {
    /// Computes the constants of a body.
    pub fn new(body: &FlexibleBody) -> Self {
        // A validated body has an invertible inertia.
        let inverted = |m: Matrix3<f64>| symmetric(inverse_3x3(m).unwrap_or_else(Matrix3::identity));
        let inverse = inverted(body.inertia);
        let bending = body.modes.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, mode| {
            sum + mode.rotation * mode.rotation.transpose()
        });
        let constants = |(index, mode): (usize, &FreeMode)| {
            let m = symmetric(mode.moments);
            let damping = body.damping.as_ref().map(|d| d[(index, index)] / (2.0 * mode.frequency));
            ModeConstants {
                frequency: mode.frequency,
                damping: damping.unwrap_or(mode.damping),
                rotation: mode.rotation,
                moments: [m.m11, m.m22, m.m33, m.m23, m.m13, m.m12],
            }
        };
        let modes: Vec<ModeConstants> = body.modes.iter().enumerate().map(constants).collect();
        let size = f64::sqrt(body.inertia.norm());
        let coupled = body
            .modes
            .iter()
            .filter(|mode| mode.rotation.norm() * size > ROUNDING || mode.moments.norm() > ROUNDING * size);
        Self {
            residual_inertia: inverted(inverse + bending),
            inertia: body.inertia,
            mobility: inverse.norm(),
            inverse,
            bending,
            groups_of_four: modes.chunks(4).map(ModeGroup4::new).collect(),
            padded: modes.iter().map(PaddedMode::new).collect(),
            modes,
            coupled_damping: body.damping.as_ref().map(|damping| {
                let mut coupling = damping.clone();
                coupling.fill_diagonal(0.0);
                coupling
            }),
            changes_inertia: body.modes.iter().any(|mode| mode.moments.norm() > 0.0),
            coupled_frequencies: coupled.map(|mode| mode.frequency).collect(),
            lanes: SimdWidth4::best(),
            rotation_sum: body.modes.iter().map(|mode| mode.rotation.norm()).sum(),
            bending_bound: bending.norm(),
            inertia_change_bound: body.modes.iter().map(|mode| mode.moments.norm()).fold(0.0, f64::max),
        }
    }

    /// Returns the rigid momentum Gt (N m s) and the rate w of the hub (rad/s) for the momentum G without rotors (N m s), the
    /// elastic rate sum phi P (rad/s) and a change J1 of the inertia (kg m²): (J_left + J1) w = G + J_left sum phi P and
    /// Gt = G - J1 w.
    pub fn momentum_and_rate(
        &self,
        momentum: &Vector,
        canonical_elastic_rate: &Vector,
        inertia_change: &Matrix3<f64>,
    ) -> (Vector, Vector) {
        let rate = solved(
            &(self.residual_inertia + inertia_change),
            &(momentum + self.residual_inertia * canonical_elastic_rate),
        );
        (momentum - inertia_change * rate, rate)
    }
}

impl BodyConstants {
    /// Returns Gt and the hub's rate as [`BodyConstants::momentum_and_rate`] does, in lanes, for changes xx, yy, zz, yz, zx and xy of the
    /// inertia.
    #[inline(always)]
    pub fn momentum_and_rate_lanes<R: LaneFloat>(
        &self,
        kind: R,
        momentum: Vectors<R>,
        canonical_elastic_rate: Vectors<R>,
        inertia_change: &[R; 6],
    ) -> (Vectors<R>, Vectors<R>) {
        let m = &self.residual_inertia;
        let xx = kind.splat(m.m11) + inertia_change[0];
        let yy = kind.splat(m.m22) + inertia_change[1];
        let zz = kind.splat(m.m33) + inertia_change[2];
        let yz = kind.splat(m.m32) + inertia_change[3];
        let zx = kind.splat(m.m31) + inertia_change[4];
        let xy = kind.splat(m.m21) + inertia_change[5];
        let v = momentum + canonical_elastic_rate.transform(m);
        // Solution by Cramer's rule.
        let first = Vectors { x: yy * zz - yz * yz, y: yz * zx - xy * zz, z: xy * yz - yy * zx };
        let (second, third, across) = (zz * xx - zx * zx, xx * yy - xy * xy, xy * zx - xx * yz);
        let one = kind.splat(1.0) / (xx * first.x + xy * first.y + zx * first.z);
        let rate = Vectors {
            x: first.dot(v) * one,
            y: (first.y * v.x + second * v.y + across * v.z) * one,
            z: (first.z * v.x + across * v.y + third * v.z) * one,
        };
        (momentum - rate.transform_symmetric(inertia_change), rate)
    }
}

/// Symmetrises a matrix to the last bit, so that energies are quadratic forms.
fn symmetric(matrix: Matrix3<f64>) -> Matrix3<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// Solves M x = v for a symmetric matrix by Cramer's rule; not finite if M is singular.
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

/// Returns the symmetric tensor of xx, yy, zz, yz, zx and xy.
pub(super) fn tensor([xx, yy, zz, yz, zx, xy]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}
