//! Detection of the processor's SIMD instruction sets, once per chunk of runs.

use pulp::Simd;
#[cfg(target_arch = "aarch64")]
use pulp::aarch64::Neon;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;
#[cfg(all(target_arch = "x86_64", feature = "wide"))]
use pulp::x86::V4;

use super::float::SimdTask;
use super::register::{ScalarTask, VectorTask};

/// SIMD instruction set of this processor.
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
    /// Returns all SIMD instruction sets that the processor has and the build supports, the widest first.
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

    /// Returns the widest instruction set; `None` if runs are computed one by one here.
    pub fn best() -> Option<Self> {
        Self::all().into_iter().next()
    }

    /// Returns the name of the instruction set.
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

    /// Returns the number of lanes of the given number of registers.
    pub fn lanes(self, registers: usize) -> usize {
        // Without an arm, on other processors, the match has no type of its own.
        let lanes: usize = match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(_) => V4::F64_LANES,
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(_) => V3::F64_LANES,
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(_) => Neon::F64_LANES,
        };
        registers * lanes
    }

    /// Runs a task on single numbers, compiled for the instruction set; AVX-512 is of no use for single numbers.
    pub fn run_scalar<W: SimdTask>(self, work: W) -> W::Output {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(simd) => Simd::vectorize(*simd, ScalarTask(work)),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(simd) => Simd::vectorize(simd, ScalarTask(work)),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(simd) => Simd::vectorize(simd, ScalarTask(work)),
        }
    }

    /// Runs a task on lanes of N registers.
    pub fn run<const N: usize, W: SimdTask>(self, work: W) -> W::Output {
        match self.0 {
            #[cfg(all(target_arch = "x86_64", feature = "wide"))]
            Instructions::Avx512(simd) => Simd::vectorize(simd, VectorTask::<W, N>(work)),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(simd) => Simd::vectorize(simd, VectorTask::<W, N>(work)),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(simd) => Simd::vectorize(simd, VectorTask::<W, N>(work)),
        }
    }
}
