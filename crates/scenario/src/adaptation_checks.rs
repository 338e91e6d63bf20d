//! Checks of an adaptation: the parameter that it tunes, and its objective.

use flexsc_control::law::Tunable;
use flexsc_control::offers::Offers;
use flexsc_formats::document::ConfigError;

use super::ScenarioSpec;

impl ScenarioSpec {
    pub(super) fn validate_adaptation(&self, offers: &Offers, errors: &mut Vec<ConfigError>) {
        let Some(adaptation) = &self.adaptation else { return };
        let tunable = self.law.tunable();
        let place = format!("adaptation.{}", adaptation.kind());
        errors.extend(adaptation.objective_error(offers).map(|error| error.within(&place)));
        let Some(number) = tunable.iter().find(|number| number.key == adaptation.tunes()) else {
            let key = if tunable.is_empty() { "" } else { "tunes" };
            errors.push(ConfigError::new(key, self.untunable(adaptation.tunes(), &tunable)).within(&place));
            return;
        };
        if let Some(error) = adaptation.bounds_error(number) {
            errors.push(error.within(&place));
        } else if let Some(why) = adaptation.start_error(number.value) {
            errors.push(ConfigError::new(adaptation.tunes(), why).within(&self.law.key()));
        }
    }

    /// Returns the reason why the law has no parameter `tunes`.
    fn untunable(&self, tunes: &str, tunable: &[Tunable]) -> String {
        let known: Vec<_> = tunable.iter().map(|number| format!("`{}`", number.key)).collect();
        match (known.is_empty(), tunes) {
            (true, "k_t") => "adapts the gain k_t of a law `relay`, and there is none".to_owned(),
            (true, _) => format!("tunes a number of the law, and the law `{}` has none", self.law.kind()),
            (false, tunes) => {
                let (kind, known) = (self.law.kind(), known.join(" or "));
                format!("must name a number of the law `{kind}`, {known}, got `{tunes}`")
            }
        }
    }
}
