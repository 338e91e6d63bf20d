//! Guests: the control system as an app of cFS and as a component of F Prime, around the exported functions.
//!
//! A guest has a message or a port for the inputs of each function, and one for its outputs. The last function is the law: its
//! inputs wait until the guest is woken up. The others are called when their inputs arrive.

mod cfs;
mod cfs_replay;
mod fprime;
mod fprime_ports;
mod fprime_stubs;
mod payload;

use super::{PackageFile, Plan};

/// Framework of flight software in which the control system runs.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Guest {
    /// App of NASA's core Flight System.
    Cfs,
    /// Component of F Prime.
    FPrime,
}

impl Guest {
    /// Returns the directory of the guest within the exported files.
    pub fn directory(self) -> &'static str {
        match self {
            Self::Cfs => "cfs",
            Self::FPrime => "fprime",
        }
    }

    /// Returns the form of the control system in the guest.
    pub fn about(self) -> &'static str {
        match self {
            Self::Cfs => "app of cFS",
            Self::FPrime => "component of F Prime",
        }
    }

    /// Returns the files of the guest; `header` and `source` are those of the control system.
    pub(super) fn files(self, plan: &Plan<'_>, header: &str, source: &str) -> Vec<PackageFile> {
        match self {
            Self::Cfs => cfs::files(plan, header, source),
            Self::FPrime => fprime::files(plan, header, source),
        }
    }
}

/// Returns a template with the names of the control system in place of `UPPER`, `LOWER`, `ORIGIN` and `VERSION`.
fn named(template: &str, plan: &Plan<'_>) -> String {
    template
        .replace("ORIGIN", plan.origin.file)
        .replace("VERSION", env!("CARGO_PKG_VERSION"))
        .replace("LOWER", plan.prefix)
        .replace("UPPER", &plan.prefix.to_uppercase())
}
