//! Progress of a run, told to the page.

use flexsc_core::dynamics::MotionPiece;
use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{Record, RecordError, Sample};

/// Record that tells the page which part of a run is done.
pub struct PageProgress {
    duration: f64,
    samples: u32,
}

impl PageProgress {
    /// Number of samples from one message to the next.
    const EACH: u32 = 4096;

    /// Returns the progress of a run of this duration (s).
    pub fn new(duration: f64) -> Self {
        Self { duration, samples: 0 }
    }

    fn update(&mut self, now: f64) {
        self.samples = self.samples.wrapping_add(1);
        if self.samples.is_multiple_of(Self::EACH) {
            tell(now / self.duration);
        }
    }
}

impl Record for PageProgress {
    fn record(&mut self, now: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.update(now.seconds());
        Ok(())
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.update(piece.from);
        Ok(())
    }
}

/// Tells the page the part of a run that is done, from 0 to 1.
#[cfg(target_family = "wasm")]
fn tell(part: f64) {
    mod page {
        #[expect(unsafe_code, reason = "a function of the page")]
        #[link(wasm_import_module = "flexsc")]
        unsafe extern "C" {
            pub safe fn progress(part: f64);
        }
    }
    page::progress(part);
}

/// Elsewhere there is no page.
#[cfg(not(target_family = "wasm"))]
fn tell(_: f64) {}
