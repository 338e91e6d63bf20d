//! Custom laws of modes of operation and of stages: given by name or number, and never dropped without an error.

use flexsc_core::control::law::LawKind;
use flexsc_core::record::Detail;
use flexsc_core::scenario::{CustomLaw, CustomParts};
use flexsc_core::{Document, Scenario};

use super::law;
use super::log_figures::logged;

const BODY: &str = "duration = 40.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n[log]\nperiod = 1.0\n[sensor.sampled]\n\
                    period = 0.25\n";
const PD: &str = "law.pd = { k_p = 4.0, k_d = 30.0, period = 0.25 }\n";

/// Returns a scenario with the modes `first`, which ends after 10 s, and `second`.
fn of_modes() -> Scenario {
    let text = format!(
        "{BODY}[[mode]]\nname = \"first\"\n{PD}leave = [{{ to = \"second\", when = \"time > 10\" }}]\n\
         [[mode]]\nname = \"second\"\n{PD}"
    );
    Scenario::parse("modes.toml", &text).expect("a scenario")
}

/// Returns a scenario whose law has a stage from 0 s and one from 10 s.
fn of_stages() -> Scenario {
    let text = format!("{BODY}[[law.stages]]\n{PD}[[law.stages]]\nfrom = 10.0\n{PD}");
    Scenario::parse("stages.toml", &text).expect("a scenario")
}

fn own_law() -> CustomLaw {
    let LawKind::Own(law) = law::Pid::kind([4.0, 0.15, 30.0], 0.25) else { panic!("an own law") };
    law
}

fn for_stage(name: &str) -> CustomParts {
    CustomParts { stage_laws: vec![(name.to_owned(), own_law())], ..CustomParts::default() }
}

/// Returns the times (s) of the rows of the own law.
fn acting(scenario: &Scenario) -> Vec<f64> {
    let rows = logged(scenario, Detail::Full).columns("/pid").unwrap_or_default();
    rows.numbers("time_s").unwrap_or_default().to_vec()
}

#[test]
fn a_law_of_a_mode_or_a_stage_acts_in_it_alone() {
    for (scenario, first, second) in [(of_modes(), "first", "second"), (of_stages(), "0", "1")] {
        let early = acting(&scenario.with_custom_parts(for_stage(first)).expect("it fits"));
        let late = acting(&scenario.with_custom_parts(for_stage(second)).expect("it fits"));
        assert!(early.first() == Some(&0.0) && early.iter().all(|time| *time <= 10.5), "{early:?}");
        assert!(late.last() == Some(&40.0) && late.iter().all(|time| *time >= 10.0), "{late:?}");
        assert!(acting(&scenario).is_empty());
    }
}

#[test]
fn a_law_without_a_place_is_refused() {
    let bare = CustomParts { law: Some(own_law()), ..CustomParts::default() };
    for (scenario, words) in [
        (
            of_modes(),
            ["each mode has a law of its own", "`law={\"second\": ...}`", "the modes are `first`, `second`"],
        ),
        (
            of_stages(),
            ["each with a law of its own", "`law={1: ...}`", "`0`, pd from 0 s; `1`, pd from 10 s"],
        ),
    ] {
        let fault = scenario.with_custom_parts(bare.clone()).expect_err("no place").to_string();
        assert!(fault.contains("law: ") && words.iter().all(|words| fault.contains(words)), "{fault}");
    }
    // A law that a program sets beside the modes is not dropped either.
    let fault = of_modes().with(|scenario| scenario.law = own_law().into()).expect_err("no place");
    assert!(fault.to_string().contains("each mode has a law of its own"), "{fault}");
    let plain = Scenario::parse("plain.toml", &format!("{PD}{BODY}")).expect("a scenario");
    let document = Document::parse("modes.toml", of_modes().to_toml()).expect("a document");
    let fault = Scenario::from_document_with(&document, &bare).expect_err("no place");
    assert!(fault.to_string().contains("each mode has a law of its own"), "{fault}");
    let (modes, stages) = (of_modes(), of_stages());
    for (scenario, name, words) in [
        (&modes, "secnd", "must be one of `first`, `second`, got `secnd`; did you mean `second`?"),
        (&modes, "1", "must be one of `first`, `second`, got `1`"),
        (&stages, "2", "must be the index of a stage of the law, from 0 to 1, got `2`"),
        (&plain, "first", "has no modes of operation, got `first`"),
    ] {
        let fault = scenario.clone().with_custom_parts(for_stage(name)).expect_err("no place").to_string();
        assert!(fault.contains(words), "{fault}");
    }
}

#[test]
fn laws_of_modes_and_stages_stay_where_keys_change() {
    for (scenario, name) in [(of_modes(), "second"), (of_stages(), "1")] {
        let own = scenario.with_custom_parts(for_stage(name)).expect("it fits");
        let parts = own.custom_parts();
        assert_eq!((parts.each(), parts.stage_laws[0].0.as_str()), (vec!["law"], name));
        let mut document = Document::from_table("own.toml", own.table_without_custom_parts());
        document.set_text("duration", "20.0").expect("a key");
        let shorter = Scenario::from_document_reusing(&document, &own).expect("a scenario");
        assert_eq!(shorter.custom_parts(), parts);
        assert_eq!(Scenario::from_document_with(&document, &parts).expect("a scenario"), shorter);
        // Another part keeps them, and the mode alone has the law throughout.
        assert_eq!(
            shorter.with_custom_parts(CustomParts::default()).expect("a scenario").custom_parts(),
            parts
        );
        let alone = shorter.in_mode(name).expect("a scenario").custom_parts();
        assert!(alone.law.is_some() && alone.stage_laws.is_empty());
        let key = if name == "1" { "law.stages[1].law" } else { "mode[1].law" };
        document.set_text(key, "{ pd = { k_p = 4.0, k_d = 30.0, period = 0.25 } }").expect("a key");
        let built_in = Scenario::from_document_reusing(&document, &own).expect("a scenario");
        assert!(!built_in.has_custom_parts());
    }
}
