//! What was computed for a page: each command once, and how long it took.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use flexsc_figure::Figure;
use minijinja::value::Value;
use minijinja::{Error, ErrorKind};
use serde_json::json;

use crate::Laboratory;

/// What was computed for a page.
pub struct Computed {
    laboratory: Box<dyn Laboratory>,
    /// What is told of each command that begins.
    begin: Box<dyn Fn(&str) + Send + Sync>,
    told: Mutex<BTreeMap<String, Value>>,
    drawn: Mutex<BTreeMap<String, (String, String)>>,
    /// Each command, and how long it took (s).
    times: Mutex<Vec<(String, f64)>>,
}

impl Computed {
    /// Nothing yet; `begin` is told of each command that begins.
    pub fn new(laboratory: impl Laboratory + 'static, begin: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self {
            laboratory: Box::new(laboratory),
            begin: Box::new(begin),
            told: Mutex::default(),
            drawn: Mutex::default(),
            times: Mutex::default(),
        }
    }

    /// What a command tells.
    ///
    /// # Errors
    /// A command that is not known, or fails.
    pub fn tell(&self, command: &str) -> Result<Value, Error> {
        self.once(&self.told, command, || value(self.laboratory.tell(command)?))
    }

    /// The times (s) and the values of a column of a run's full log.
    ///
    /// # Errors
    /// As of [`Computed::tell`].
    pub fn column(&self, command: &str, topic: &str, name: &str) -> Result<Value, Error> {
        self.once(&self.told, &format!("{command} {topic} {name}"), || {
            value(json!(self.laboratory.column(command, topic, name)?))
        })
    }

    /// The drawing `what` of a command, to be called `name`, and the command as a user gives it.
    ///
    /// # Errors
    /// As of [`Computed::tell`], and a figure that there is not.
    pub fn draw(&self, command: &str, what: &str, name: &str) -> Result<(String, String), Error> {
        self.once(&self.drawn, &format!("{command}: figure {what}"), || {
            let (figure, shown) = self.laboratory.draw(command, what)?;
            Ok((svg(name, &figure)?, shown))
        })
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

/// What machines are told, as templates read it.
fn value(told: serde_json::Value) -> Result<Value, String> {
    serde_json::from_value(told).map_err(|error| error.to_string())
}

/// What a lock holds: a thread that failed has left it whole.
pub fn locked<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A figure as it stands in a page.
pub fn svg(name: &str, figure: &Figure) -> Result<String, String> {
    figure.svg().map_err(|why| format!("cannot draw {name}: {why}"))
}
