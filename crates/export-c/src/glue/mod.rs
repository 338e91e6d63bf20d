//! Functions that call the flight code of a control system, as a Rust module `control_system` in the translated subset: `flexsc
//! export-c` translates it with the flight code, or writes both as a crate.
//!
//! Each unit of the control system adds its members of the state, its constants and its functions.

mod actuation;
mod attitude;
mod b_dot;
mod channels;
mod compensators;
mod kalman;
mod law_scope;
mod laws;
mod member;
mod modes;
mod momentum;
mod parameters;
mod rate;
mod relays;
mod run_start;
mod sampled;
mod supervisor;
mod text;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use flexsc_flight_precision::Precision;

use crate::control_system::{CallLayout, ControlSystem};
use crate::flight_sources::sources_in;
use member::Member;

pub use parameters::{FlightParameter, parameters};
pub use run_start::{find as find_run_start, start_inputs};
pub use text::camel;

/// Module of a control system.
#[derive(Clone, Debug)]
pub struct ControlModule {
    /// Text in Rust.
    pub text: String,
    /// Value in Rust of the state before it is set, which the translated text does not need.
    pub state: String,
}

/// Control system whose module is written.
#[derive(Clone, Copy)]
pub struct ModulePlan<'a> {
    pub system: &'a ControlSystem,
    pub calls: &'a [CallLayout],
    /// Numbers that are tuned in flight.
    pub parameters: &'a [FlightParameter],
    /// Inputs with which estimators start in run 0; `None` without an estimator, or without vectors.
    pub run_start: Option<&'a [u64]>,
    pub precision: Precision,
}

impl ModulePlan<'_> {
    /// Returns true if the functions read the time.
    pub fn has_time(&self) -> bool {
        match self.system {
            ControlSystem::Relays(_) | ControlSystem::BDot(_) | ControlSystem::Modes(_) => true,
            ControlSystem::Sampled(laws) => laws.estimator.is_some(),
        }
    }

    /// Returns true if the function that sets the state reads the time: modes begin at a time.
    pub fn inits_at_time(&self) -> bool {
        matches!(self.system, ControlSystem::Modes(_))
    }

    /// Returns the module.
    pub fn module(&self) -> ControlModule {
        let mut glue = Glue {
            plan: *self,
            members: Vec::new(),
            constants: String::new(),
            types: String::new(),
            init: String::new(),
            functions: String::new(),
        };
        run_start::add(&mut glue);
        match self.system {
            ControlSystem::Relays(relays) => relays::add(&mut glue, relays),
            ControlSystem::Sampled(laws) => sampled::add(&mut glue, laws),
            ControlSystem::BDot(system) => b_dot::add_system(&mut glue, system),
            ControlSystem::Modes(modes) => modes::add(&mut glue, modes),
        }
        parameters::add(&mut glue);
        glue.finish()
    }
}

/// Module that is being written.
struct Glue<'a> {
    plan: ModulePlan<'a>,
    /// Members of the state.
    members: Vec<Member>,
    constants: String,
    /// Structs beside the state, the inputs and the outputs.
    types: String,
    /// Statements of `init` after the members are set.
    init: String,
    functions: String,
}

impl<'a> Glue<'a> {
    /// Adds a constant.
    fn constant(&mut self, about: &str, name: &str, kind: &str, value: &str) {
        let _ = writeln!(self.constants, "/// {about}\nconst {name}: {kind} = {value};\n");
    }

    /// Adds a list of values; none without values.
    fn list(&mut self, about: &str, name: &str, kind: &str, values: &[impl std::fmt::Debug]) {
        if !values.is_empty() {
            let rows: Vec<String> = values.iter().map(text::literal).collect();
            let rows = format!("[\n    {},\n]", rows.join(",\n    "));
            self.constant(about, name, &format!("[{kind}; {}]", values.len()), &rows);
        }
    }

    /// Adds a function; a parameter that the body does not name begins with an underscore.
    fn function(&mut self, about: &str, head: &str, parameters: &[&str], body: &str) {
        let named = text::words(body);
        let parameters = parameters.iter().map(|parameter| {
            let name = parameter.split(':').next().unwrap_or_default();
            if named.contains(name) { (*parameter).to_owned() } else { format!("_{parameter}") }
        });
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        let lines = about.lines().fold(String::new(), |all, line| all + "/// " + line + "\n");
        let head = head.replacen("()", &format!("({parameters})"), 1);
        let _ = writeln!(self.functions, "{lines}{head} {{\n{body}}}\n");
    }

    /// Adds a function of the library with this name.
    fn call(&mut self, name: &str, body: &str) {
        let Some(call) = self.layout(name) else { return };
        let kind = camel(name);
        let (input, output) = (format!("input: &{kind}Input"), format!("output: &mut {kind}Output"));
        let now = self.plan.has_time().then_some("now: Ticks");
        let parameters: Vec<&str> =
            ["state: &mut State"].into_iter().chain(now).chain([&*input, &*output]).collect();
        self.function(call.about, &format!("pub fn {name}()"), &parameters, body);
    }

    /// Returns the layout of a function.
    fn layout(&self, name: &str) -> Option<&'a CallLayout> {
        self.plan.calls.iter().find(|call| call.name == name)
    }

    /// Returns an array of the inputs of a function as a slice; one with one element is a number.
    fn input_list(&self, call: &str, name: &str) -> String {
        let inputs = self.layout(call).into_iter().flat_map(|call| &call.inputs);
        let is_one = inputs.into_iter().any(|channel| channel.name == name && channel.count == 1);
        if is_one { format!("&[input.{name}]") } else { format!("&input.{name}") }
    }

    /// Writes the module.
    fn finish(mut self) -> ControlModule {
        let now = self.plan.inits_at_time().then_some("now: Ticks");
        let parameters: Vec<&str> = ["state: &mut State"].into_iter().chain(now).collect();
        let kept = if now.is_some() {
            " Times of the run and entries of modes count from here: a computer that starts again in flight writes the members `supervisor.started` and `modes` of the state that it has kept, after `enter`."
        } else {
            ""
        };
        let about = format!("Sets the state before the first call.{kept}");
        let mut body = member::set_all(&self.members, "state");
        body.push_str(&self.init);
        let others = std::mem::take(&mut self.functions);
        self.function(&about, "pub fn init()", &parameters, &body);
        self.functions.push_str(&others);
        let about = "State of the control system, which its functions change.";
        let mut types = self.types;
        types.push_str(&member::definition(&self.members, about, "State"));
        for call in self.plan.calls {
            types.push_str(&channels::definitions(call));
        }
        let code = self.constants + &types + self.functions.trim_end() + "\n";
        let state = member::value(&self.members, "Self");
        let uses = uses(&format!("{code}{state}"), self.plan.precision);
        let code: String = code.lines().map(text::laid_out).collect();
        let text = format!("//! Control system: the functions that call its units.\n\n{uses}\n{code}");
        if self.plan.precision.is_double() {
            ControlModule { text, state }
        } else {
            ControlModule { text: text.replace("f64", "f32"), state: state.replace("f64", "f32") }
        }
    }
}

/// Returns the imports of the types and modules that a text names.
fn uses(code: &str, precision: Precision) -> String {
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let code: String = code.lines().filter(is_code).flat_map(|line| [line, "\n"]).collect();
    // A variant of an enum may have the name of a type.
    let whole = code.replace("::", ":: _");
    let named = text::words(&whole);
    let mut lines = String::new();
    for source in sources_in(precision) {
        let module = source.module;
        if named.contains(module) && code.contains(&format!("{module}::")) {
            let _ = writeln!(lines, "use crate::{module};");
        }
        let kinds = ["\npub struct ", "\npub enum "];
        let names = kinds.into_iter().flat_map(|kind| source.text.split(kind).skip(1));
        let names = names.filter_map(|rest| rest.split(' ').next());
        let own: BTreeSet<&str> = names.filter(|name| named.contains(name)).collect();
        let list = own.into_iter().collect::<Vec<_>>().join(", ");
        let _ = match list.contains(',') {
            _ if list.is_empty() => Ok(()),
            true => writeln!(lines, "use crate::{module}::{{{list}}};"),
            false => writeln!(lines, "use crate::{module}::{list};"),
        };
    }
    lines
}
