//! A paper's page: its template, filled with what the commands that it names tell.
//!
//! The template is the paper's section of docs/papers.md. In it
//! - `run("simulate scenarios/relay-fixed.toml")` is what that command tells for machines,
//! - `each("plan ... suppress={}", [0, 1])` is a list of what the commands tell that have each value in the place of `{}`,
//! - `column("simulate ...", "/attitude", "angle_rad")` is a column of the run's full log,
//! - `drawing(name, chart, caption, command)` is a [`Chart`] of the page's own numbers,
//! - `figure(name, command, what, caption)` is the figure `what` that the command draws, or the run's,
//! - `yes("what it is about", condition)` and `no(...)` are verdicts: known to hold, known not to,
//!
//! and filters and tests of [`super::number`]. A name that is not known is an error.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, Error, ErrorKind, UndefinedBehavior};

use flexsc_core::record::Detail;
use serde_json::json;

use super::chart::{self, Chart};
use super::command::Command;
use super::number;
use super::verdict::Verdict;
use crate::failure::Failure;
use crate::figure::Figure;

/// The form that a template is filled for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// Markdown of the documentation, its figures in files beside it.
    Markdown,
    /// Markdown that becomes HTML, its figures to be put in.
    Html,
}

/// A drawn figure.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its name, and that of its file.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The command behind it.
    pub command: String,
    /// The drawing.
    pub svg: String,
}

/// What a page came to.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The figures, in their order.
    pub figures: Vec<Drawn>,
    /// The verdicts, in their order.
    pub verdicts: Vec<Verdict>,
}

/// What was computed for a page: each command once.
#[derive(Default)]
pub struct Results {
    told: Mutex<BTreeMap<String, Value>>,
    drawn: Mutex<BTreeMap<String, (String, String)>>,
    /// Each command, and how long it took (s).
    times: Mutex<Vec<(String, f64)>>,
}

impl Results {
    /// Fills a template.
    pub fn fill(
        self: &Arc<Self>,
        template: &str,
        form: Form,
        begin: impl Fn(&str) + Send + Sync + 'static,
    ) -> Result<(String, Outcome), Failure> {
        let outcome = Arc::new(Mutex::new(Outcome::default()));
        let begin = Arc::new(begin);
        let mut environment = Environment::new();
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        let syntax =
            SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build();
        environment.set_syntax(syntax.map_err(|error| Failure::Page(error.to_string()))?);
        number::add_to(&mut environment);
        chart::add_to(&mut environment);

        let (results, told) = (Arc::clone(self), Arc::clone(&begin));
        let tell = |results: &Self, command: &str, begin: &dyn Fn(&str)| {
            results.once(&results.told, command, begin, || value(Command::parse(command)?.tell()?))
        };
        environment.add_function("run", move |command: &str| tell(&results, command, &*told));
        let (results, told) = (Arc::clone(self), Arc::clone(&begin));
        environment.add_function("each", move |command: &str, values: Vec<Value>| {
            let with = |value: &Value| command.replace("{}", &value.to_string());
            values.iter().map(|value| tell(&results, &with(value), &*told)).collect::<Result<Vec<_>, _>>()
        });
        let (results, told) = (Arc::clone(self), Arc::clone(&begin));
        environment.add_function("column", move |command: &str, topic: &str, name: &str| {
            results.once(&results.told, &format!("{command} {topic} {name}"), &*told, || {
                let columns = Command::parse(command)?.log(Detail::Full)?.columns(topic)?;
                let column = |name: &str| columns.numbers(name).map(<[f64]>::to_vec).unwrap_or_default();
                value(json!([column("time_s"), column(name)]))
            })
        });
        let (results, list, told) = (Arc::clone(self), Arc::clone(&outcome), Arc::clone(&begin));
        let figure = move |name: &str, command: &str, what: &str, caption: &str| -> Result<String, Error> {
            let key = format!("{command}: figure {what}");
            let (svg, command) = results.once(&results.drawn, &key, &*told, || {
                let (figure, shown) = Command::parse(command)?.draw(what)?;
                Ok((svg(name, &figure)?, shown))
            })?;
            Ok(show(&list, form, Drawn { name: name.to_owned(), caption: caption.to_owned(), command, svg }))
        };
        environment.add_function("figure", figure);
        let list = Arc::clone(&outcome);
        let drawing = move |name: &str, chart: Serde<Chart>, caption: &str, command: &str| {
            let svg = svg(name, &chart.figure())
                .map_err(|failure| Error::new(ErrorKind::InvalidOperation, failure.to_string()))?;
            let (name, caption, command) = (name.to_owned(), caption.to_owned(), command.to_owned());
            Ok::<String, Error>(show(&list, form, Drawn { name, caption, command, svg }))
        };
        environment.add_function("drawing", drawing);
        for (word, expected) in [("yes", true), ("no", false)] {
            let list = Arc::clone(&outcome);
            environment.add_function(word, move |name: &str, holds: bool| {
                let verdict = Verdict { name: name.to_owned(), holds, expected };
                let told = match form {
                    Form::Markdown => verdict.word().to_owned(),
                    Form::Html => format!("<b class=\"{}\">{0}</b>", verdict.word()),
                };
                locked(&list).verdicts.push(verdict);
                told
            });
        }
        let text = environment.render_str(template, ()).map_err(|error| Failure::Page(explained(&error)))?;
        drop(environment);
        let outcome = locked(&outcome).clone();
        Ok((text, outcome))
    }

    /// Each command, and how long it took (s).
    pub fn times(&self) -> Vec<(String, f64)> {
        locked(&self.times).clone()
    }

    /// What a key stands for: computed when it is first asked for.
    fn once<T: Clone>(
        &self,
        cache: &Mutex<BTreeMap<String, T>>,
        key: &str,
        begin: &dyn Fn(&str),
        compute: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Error> {
        if let Some(known) = locked(cache).get(key) {
            return Ok(known.clone());
        }
        begin(key);
        let began = Instant::now();
        let computed =
            compute().map_err(|failure| Error::new(ErrorKind::InvalidOperation, failure.to_string()))?;
        locked(&self.times).push((key.to_owned(), began.elapsed().as_secs_f64()));
        locked(cache).insert(key.to_owned(), computed.clone());
        Ok(computed)
    }
}

/// What machines are told, as templates read it.
pub fn value(told: serde_json::Value) -> Result<Value, Failure> {
    serde_json::from_value(told).map_err(|error| Failure::Page(error.to_string()))
}

/// What a lock holds: a thread that failed has left it whole.
fn locked<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

fn svg(name: &str, figure: &Figure) -> Result<String, Failure> {
    figure.svg().map_err(|why| Failure::Draw { path: name.into(), why })
}

fn show(outcome: &Mutex<Outcome>, form: Form, drawn: Drawn) -> String {
    let Drawn { name, caption, command, .. } = &drawn;
    let text = match form {
        Form::Markdown => format!("![{caption}](images/{name}.svg)\n\n{caption}: `flexsc {command}`"),
        Form::Html => format!("<!--figure {name}-->"),
    };
    locked(outcome).figures.push(drawn);
    text
}

/// An error with the line of the template and what is behind it.
fn explained(error: &Error) -> String {
    let line = error.line().map_or(String::new(), |line| format!("line {line}: "));
    format!("{line}{error}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(template: &str) -> Result<(String, Outcome), Failure> {
        Arc::new(Results::default()).fill(template, Form::Markdown, |_| {})
    }

    #[test]
    fn a_wrong_number_turns_a_verdict() {
        let quiet = "{% set run = run('simulate scenarios/relay-quiet.toml --set duration=1000.0') %}";
        let of = |printed: &str| {
            let verdict = format!("{{{{ yes('pushes', run.pushes_right is near({printed}, 0.01)) }}}}");
            filled(&format!("{quiet}{{{{ run.pushes_right }}}} {verdict}")).expect("a page")
        };
        let ((right, known), (wrong, other)) = (of("21"), of("22"));
        assert_eq!([right.as_str(), wrong.as_str()], ["21 yes", "21 no"]);
        assert!(known.verdicts[0].is_as_expected() && !other.verdicts[0].is_as_expected());
        let refuted = filled("{{ no('more', 1 > 2) }}").expect("a page").1;
        assert!(refuted.verdicts[0].is_as_expected());
        // What is not there is near to nothing.
        assert_eq!(filled("{{ yes('none', none is near(0, 1)) }}").expect("a page").0, "no");
    }

    #[test]
    fn what_is_not_known_is_an_error() {
        let wrong = [
            ("{{ nothing }}", "undefined"),
            ("{{ run('simulate scenarios/relay-quiet.toml --set duration=100.0').settling }}", "undefined"),
            ("{{ 1|squared }}", "squared"),
            ("{{ run('simulate scenarios/other.toml') }}", "no scenario of the papers"),
            ("{{ run('simulate scenarios/relay-quiet.toml --sets duration=100.0') }}", "--sets"),
            ("{{ run('simulate scenarios/relay-quiet.toml --set durations=100.0') }}", "durations"),
            ("{{ figure('a', 'plan scenarios/rotation-sine.toml', 'colour', 'A') }}", "colour"),
        ];
        for (template, why) in wrong {
            let error = filled(template).expect_err(template).to_string();
            assert!(error.contains(why), "{template}: {error}");
        }
    }

    #[test]
    fn numbers_are_printed_as_they_are_asked_for() {
        let list = "[4, none, 1, 3, 2]";
        let cases = [
            ("1.97191e-5|sci(2)".to_owned(), "1.97e-5"),
            ("0.774|percent(1)".to_owned(), "77.4 %"),
            (
                "18000.0|grouped ~ ' ' ~ 2526|grouped ~ ' ' ~ 1234567|grouped".to_owned(),
                "18 000 2526 1 234 567",
            ),
            ("(0.0 * -1)|fixed(2)".to_owned(), "0.00"),
            ("7.398419 is rounds_to('7.399')".to_owned(), "False"),
            ("22.348647 is rounds_to('22.349')".to_owned(), "True"),
            (
                format!("{list}|median ~ ' ' ~ {list}|known ~ ' ' ~ {list}|above(2) ~ ' ' ~ {list}|most"),
                "2.5 4 2 4.0",
            ),
            ("[1, none, 3]|sooner([2, 2, none])".to_owned(), "2"),
            ("minima([0, 1, 2, 3], [3, 1, 2, 0])|join(' ')".to_owned(), "1.0"),
            (
                "stretches([0, 1, 2, 3, 4], [1, 1, none, 1, none], 2)|map('join', ' ')|join(', ')".to_owned(),
                "0.0 1.0",
            ),
            ("'a={} b={}'|fill([1, 0.25])".to_owned(), "a=1.0 b=0.25"),
        ];
        for (expression, printed) in cases {
            assert_eq!(
                filled(&format!("{{{{ {expression} }}}}")).expect(&expression).0,
                printed,
                "{expression}"
            );
        }
    }
}
