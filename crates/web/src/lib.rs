//! flexsc for browsers: a request as JSON goes in, a result as bytes comes out. The executable of this crate takes both
//! through the memory of WebAssembly; [`Workbench`] answers on any processor.

mod workbench;

pub use workbench::{ProgressReceiver, Workbench};
