//! Viewers of runs: layouts of their panels, three-dimensional scenes, and drawings of spacecraft.
//!
//! The engine does not depend on this crate. A [`scene::Scene`] is a record that supplies the engine with the scene of a
//! run; [`with_layout`] attaches the layout of a run's log to its provenance.

pub mod drawing;
pub mod layout;
pub mod scene;

use flexsc_core::Scenario;
use flexsc_core::record::{Attachment, Detail, Provenance};

use layout::Layout;

/// Returns the provenance of a scenario's log in this detail with its layout as the first attachment.
#[must_use]
pub fn with_layout(mut provenance: Provenance, scenario: &Scenario, detail: Detail) -> Provenance {
    let layout = Layout::for_scenario(scenario).for_detail(detail).to_json();
    let attachment =
        Attachment { name: "layout.json", media_type: "application/json", data: layout.into_bytes() };
    provenance.attachments.insert(0, attachment);
    provenance
}
