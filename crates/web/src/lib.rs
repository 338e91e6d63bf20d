//! flexsc for browsers: a request as JSON goes in, a result as bytes comes out, through the memory of WebAssembly.
//!
//! A page puts a request at the address that [`memory::flexsc_allocate`] returns and calls [`memory::flexsc_answer`].
//! `docs/extending.md` has the requests; [`workbench::Workbench`] answers them, on any processor.

pub mod memory;
pub mod workbench;

mod page_progress;
