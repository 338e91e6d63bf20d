//! Four SIMD lanes on every processor, for data within one run.

use pulp::Simd;
#[cfg(target_arch = "aarch64")]
use pulp::aarch64::Neon;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V3;

use super::float::SimdTask;
use super::register::VectorTask;

/// Instruction set by which this processor operates on four numbers.
#[derive(Copy, Clone, Debug)]
pub struct SimdWidth4(Instructions);

#[derive(Copy, Clone, Debug)]
enum Instructions {
    #[cfg(target_arch = "x86_64")]
    Avx2(V3),
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
    Any,
}

impl SimdWidth4 {
    /// Number of lanes.
    pub const LANES: usize = 4;

    /// Returns the best available instruction set.
    pub fn best() -> Self {
        Self::vector_only().unwrap_or_else(Self::portable)
    }

    /// Returns the vector instruction set, if the processor has one.
    pub fn vector_only() -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        let wide = V3::try_new().map(Instructions::Avx2);
        #[cfg(target_arch = "aarch64")]
        let wide = Neon::try_new().map(Instructions::Neon);
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let wide = None;
        wide.map(Self)
    }

    /// Returns the portable scalar implementation.
    pub fn portable() -> Self {
        Self(Instructions::Any)
    }

    /// Runs a task on four lanes.
    pub fn run<W: SimdTask>(self, work: W) -> W::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2(simd) => Simd::vectorize(simd, VectorTask::<W, 1>(work)),
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon(simd) => Simd::vectorize(simd, VectorTask::<W, 2>(work)),
            Instructions::Any => Simd::vectorize(pulp::Scalar256b, VectorTask::<W, 1>(work)),
        }
    }
}
