//! Cache of the results for a page: each command is run once, and its duration is recorded.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use flexsc_figure::Figure;
use minijinja::value::Value;
use minijinja::{Error, ErrorKind};
use serde_json::json;

use crate::Laboratory;

/// Cache of the results of commands.
pub struct Computed {
    laboratory: Box<dyn Laboratory>,
    /// Callback that receives each command when it starts.
    begin: Box<dyn Fn(&str) + Send + Sync>,
    values: Mutex<BTreeMap<String, Value>>,
    drawn: Mutex<BTreeMap<String, (String, String)>>,
    /// Commands with their durations (s).
    times: Mutex<Vec<(String, f64)>>,
}

impl Computed {
    /// Creates an empty cache; `begin` is called with each command that starts.
    pub fn new(laboratory: impl Laboratory + 'static, begin: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self {
            laboratory: Box::new(laboratory),
            begin: Box::new(begin),
            values: Mutex::default(),
            drawn: Mutex::default(),
            times: Mutex::default(),
        }
    }

    /// Returns the JSON output of a command.
    ///
    /// # Errors
    /// If the command is unknown or fails.
    pub fn run(&self, command: &str) -> Result<Value, Error> {
        self.once(&self.values, command, || value(self.laboratory.run(command)?))
    }

    /// Returns the times (s) and the values of a column of a run's full log.
    ///
    /// # Errors
    /// If the command is unknown or fails.
    pub fn column(&self, command: &str, topic: &str, name: &str) -> Result<Value, Error> {
        self.once(&self.values, &format!("{command} {topic} {name}"), || {
            value(json!(self.laboratory.column(command, topic, name)?))
        })
    }

    /// Returns the figure `kind` of a command as SVG with the name `name`, and the command as a user would enter it.
    ///
    /// # Errors
    /// If the command is unknown or fails, or has no such figure.
    pub fn draw(&self, command: &str, kind: &str, name: &str) -> Result<(String, String), Error> {
        self.once(&self.drawn, &format!("{command}: figure {kind}"), || {
            let (figure, shown) = self.laboratory.draw(command, kind)?;
            Ok((svg(name, &figure)?, shown))
        })
    }

    /// Returns the commands with their durations (s).
    pub fn times(&self) -> Vec<(String, f64)> {
        locked(&self.times).clone()
    }

    /// Returns the value of a key, which is computed on first use.
    fn once<T: Clone>(
        &self,
        cache: &Mutex<BTreeMap<String, T>>,
        key: &str,
        compute: impl FnOnce() -> Result<T, String>,
    ) -> Result<T, Error> {
        if let Some(known) = locked(cache).get(key) {
            return Ok(known.clone());
        }
        (self.begin)(key);
        let began = Instant::now();
        let computed = compute().map_err(|why| Error::new(ErrorKind::InvalidOperation, why))?;
        locked(&self.times).push((key.to_owned(), began.elapsed().as_secs_f64()));
        locked(cache).insert(key.to_owned(), computed.clone());
        Ok(computed)
    }
}

/// Converts JSON output to a template value.
fn value(json: serde_json::Value) -> Result<Value, String> {
    serde_json::from_value(json).map_err(|error| error.to_string())
}

/// Locks a mutex; a panicked thread leaves its value intact.
pub fn locked<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Draws a figure as SVG for a page.
pub fn svg(name: &str, figure: &Figure) -> Result<String, String> {
    figure.svg().map_err(|why| format!("cannot draw {name}: {why}"))
}
