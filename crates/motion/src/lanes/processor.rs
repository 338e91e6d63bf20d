//! Which registers the processor has: asked once for a chunk of runs.

use pulp::Simd;
#[cfg(target_arch = "aarch64")]
use pulp::aarch64::Neon;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;
#[cfg(all(target_arch = "x86_64", feature = "wide"))]
use pulp::x86::V4;

use super::real::LaneWork;
use super::register::{Alone, Vectorized};

/// Instructions for lanes that this processor has.
#[derive(Copy, Clone, Debug)]
pub struct Processor(Instructions);

#[derive(Copy, Clone, Debug)]
enum Instructions {
    #[cfg(all(target_arch = "x86_64", feature = "wide"))]
    Avx512(V4),
    #[cfg(target_arch = "x86_64")]
    Avx2(V3),
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
}

impl Processor {
    /// All instructions for lanes that this processor has and the build knows, the widest first.
    pub fn all() -> Vec<Self> {
        #[cfg(all(target_arch = "x86_64", feature = "wide"))]
        let all = [V4::try_new().map(Instructions::Avx512), V3::try_new().map(Instructions::Avx2)];
        #[cfg(all(target_arch = "x86_64", not(feature = "wide")))]
        let all = [V3::try_new().map(Instructions::Avx2)];
        #[cfg(target_arch = "aarch64")]
        let all = [Neon::try_new().map(Instructions::Neon)];
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let all: [Option<Instructions>; 0] = [];
        all.into_iter().flatten().map(Self).collect()
    }

    /// The widest; none if runs go one by one here.
    pub fn best() -> Option<Self> {
        Self::all().into_iter().next()
    }

    /// What the instructions are called.
    pub fn name(self) -> &'static str {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(_) => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(_) => "AVX2",
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(_) => "NEON",
        }
    }

    /// How many lanes so many registers have.
    pub fn lanes(self, registers: usize) -> usize {
        registers
            * match self.0 {
                #[cfg(all(target_arch = "x86_64", feature = "wide"))]
                Instructions::Avx512(_) => V4::F64_LANES,
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2(_) => V3::F64_LANES,
                #[cfg(target_arch = "aarch64")]
                Instructions::Neon(_) => Neon::F64_LANES,
            }
    }

    /// Does some work over numbers, one at a time, with such instructions; those of AVX-512 add nothing to one number.
    pub fn run_alone<W: LaneWork>(self, work: W) -> W::Output {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(simd) => Simd::vectorize(*simd, Alone(work)),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(simd) => Simd::vectorize(simd, Alone(work)),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(simd) => Simd::vectorize(simd, Alone(work)),
        }
    }

    /// Does some work over lanes of N registers.
    pub fn run<const N: usize, W: LaneWork>(self, work: W) -> W::Output {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(simd) => Simd::vectorize(simd, Vectorized::<W, N>(work)),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(simd) => Simd::vectorize(simd, Vectorized::<W, N>(work)),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(simd) => Simd::vectorize(simd, Vectorized::<W, N>(work)),
        }
    }
}
