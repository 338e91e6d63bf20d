//! flexsc for browsers: a request as JSON goes in, a result as bytes comes out. The executable of this crate takes both
//! through the memory of WebAssembly; [`Workbench`] answers on any processor.

mod page_progress;
mod workbench;

pub use page_progress::ProgressReceiver;
pub use workbench::Workbench;
