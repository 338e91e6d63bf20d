//! The memory that tables of a log may take.

/// The memory that tables of a log may take.
pub struct Budget(usize);

/// Tables may take this much (bytes), however small the log is ...
const LEAST: usize = 256 << 20;
/// ... and so many times its size. Those of a run take up to about ten times.
const TIMES: usize = 64;

impl Budget {
    /// The budget of a log of so many bytes.
    pub fn of_file(bytes: usize) -> Self {
        Self(bytes.saturating_mul(TIMES).saturating_add(LEAST))
    }

    /// Takes some of it.
    pub fn spend(&mut self, bytes: usize) -> Result<(), String> {
        self.0 = self.0.checked_sub(bytes).ok_or_else(|| {
            format!("its rows take more than {TIMES} times the size of the file and {} MiB", LEAST >> 20)
        })?;
        Ok(())
    }
}
