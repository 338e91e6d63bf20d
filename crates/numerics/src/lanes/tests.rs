//! Tests that every operation in every lane of every width equals that of f64, to the bit.

use super::register::Lanes;
use super::{LaneFloat, Mask, Processor, SimdTask};

/// Special values that are critical for arithmetic.
const ODD: [f64; 28] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    2.5,
    -2.5,
    -3.5,
    0.499_999_999_999_999_94,
    -0.499_999_999_999_999_94,
    1e15,
    -1_125_899_906_842_623.5,
    5e-324,
    -5e-324,
    2.2e-308,
    -1.1e-308,
    f64::MIN_POSITIVE,
    f64::MAX,
    f64::MIN,
    f64::EPSILON,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    0.1,
    1e200,
    -3.3e-200,
];

/// Returns the results of all operations on two numbers.
fn results<R: LaneFloat>(a: R, b: R) -> Vec<R> {
    let yes = |mask: R::Mask| R::select(mask, a.splat(1.0), a.splat(0.0));
    // Beyond 2^51 `quadrant` is not defined.
    let small = R::select(a.abs().lt(a.splat(2_251_799_813_685_248.0)), a, a.splat(7.0));
    let (whole, odd, second) = small.quadrant();
    vec![
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a + 0.1,
        a - 0.1,
        a * 0.1,
        a.sqrt(),
        a.abs(),
        a.min(b),
        a.max(b),
        yes(a.lt(b)),
        yes(a.le(b)),
        yes(a.gt(b)),
        yes(a.ge(b)),
        yes(!a.lt(b) & (a.le(b) | b.lt(a))),
        R::select(a.lt(b), a, b),
        whole,
        yes(odd),
        yes(second),
        // Must not be fused into one operation.
        a * b + a,
        a * a - b * b,
    ]
}

struct Pairs;

impl SimdTask for Pairs {
    type Output = usize;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> usize {
        let lanes = R::LANES;
        for from in 0..ODD.len() {
            for with in 0..ODD.len() {
                // A different pair in each lane.
                let a: Vec<f64> = (0..lanes).map(|lane| ODD[(from + lane) % ODD.len()]).collect();
                let b: Vec<f64> = (0..lanes).map(|lane| ODD[(with + 3 * lane) % ODD.len()]).collect();
                for (index, all) in results(kind.load(&a), kind.load(&b)).into_iter().enumerate() {
                    for lane in 0..lanes {
                        let (got, single) = (all.lane(lane), results(a[lane], b[lane])[index]);
                        let same = got.to_bits() == single.to_bits() || got.is_nan() && single.is_nan();
                        assert!(same, "operation {index} of {} and {}: {got} for {single}", a[lane], b[lane]);
                    }
                }
            }
        }
        lanes
    }
}

#[test]
fn a_lane_is_a_number_to_the_bit() {
    for processor in Processor::all() {
        assert_eq!(processor.run::<1, _>(Pairs), processor.lanes(1), "{}", processor.name());
        assert_eq!(processor.run::<2, _>(Pairs), processor.lanes(2), "{}", processor.name());
    }
    assert_eq!(Pairs.run(f64::NAN), 1);
}

#[test]
fn integers_and_quarters_are_as_arithmetic_has_them() {
    for (x, whole, odd, second) in [
        (0.5, 0.0, false, false),
        (1.5, 2.0, false, true),
        (2.5, 2.0, false, true),
        (-0.5, 0.0, false, false),
        (-1.2, -1.0, true, true),
        (-2.0, -2.0, false, true),
        (3.0, 3.0, true, true),
        (1e15 + 1.0, 1e15 + 1.0, true, false),
        (-1e15 - 1.0, -1e15 - 1.0, true, true),
    ] {
        assert_eq!(LaneFloat::quadrant(x), (whole, odd, second), "{x}");
    }
    assert_eq!((LaneFloat::min(1.0, f64::NAN)).to_bits(), f64::NAN.to_bits());
    assert_eq!(LaneFloat::min(f64::NAN, 1.0), 1.0);
    assert_eq!(LaneFloat::max(0.0, -0.0).to_bits(), (-0.0_f64).to_bits());
}

struct Chosen;

impl SimdTask for Chosen {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let (none, rising) = (kind.splat(0.0), kind.load(&ODD).with_lane(R::LANES - 1, 7.0));
        assert_eq!(rising.lane(R::LANES - 1), 7.0);
        assert!(!rising.lt(none.splat(f64::NEG_INFINITY)).any());
        // A single true lane is `any`, and `all` only if there is one lane.
        let one = rising.gt(none.splat(6.0)) & rising.lt(none.splat(8.0));
        assert!(one.any());
        assert_eq!(one.all(), R::LANES == 1);
        assert!((one | !one).all());
        for lane in 0..R::LANES {
            let one = none.with_lane(lane, 7.0).gt(none.splat(6.0));
            assert!(one.any() && one.all() == (R::LANES == 1), "{lane} of {}", R::LANES);
        }
        let apart = kind.run_outlined(Lane(R::LANES - 1));
        assert_eq!(apart, 7.0);
    }
}

/// Task that returns the number in a lane, run as a separate function.
struct Lane(usize);

impl SimdTask for Lane {
    type Output = f64;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> f64 {
        kind.splat(1.0).with_lane(self.0, 7.0).lane(self.0)
    }
}

#[test]
fn masks_select_lanes() {
    Chosen.run(f64::NAN);
    for processor in Processor::all() {
        processor.run::<1, _>(Chosen);
        processor.run::<2, _>(Chosen);
    }
    assert!(format!("{:?}", Lanes::<pulp::Scalar, 2>::new(pulp::Scalar)).contains("NaN"));
}
