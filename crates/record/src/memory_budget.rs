//! Limit on the memory for tables of a log.

/// Remaining memory for tables of a log (bytes).
pub struct MemoryBudget(usize);

/// Memory allowed for the tables of any log (bytes).
const LEAST: usize = 256 << 20;
/// Memory allowed in addition, as a multiple of the log's size. Tables of a run take up to about ten times.
const TIMES: usize = 64;

impl MemoryBudget {
    /// Creates the budget of a log of `bytes` bytes.
    pub fn for_file(bytes: usize) -> Self {
        Self(bytes.saturating_mul(TIMES).saturating_add(LEAST))
    }

    /// Subtracts `bytes` from the budget, or fails if it is exceeded.
    pub fn reserve(&mut self, bytes: usize) -> Result<(), String> {
        self.0 = self.0.checked_sub(bytes).ok_or_else(|| {
            format!("its rows take more than {TIMES} times the size of the file and {} MiB", LEAST >> 20)
        })?;
        Ok(())
    }
}
