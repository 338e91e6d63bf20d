//! Commands that the figures of a plan overlay: a series with an increasing number of suppressed modes, or a command
//! and the rigid bang-bang.

use std::borrow::Cow;

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::numerics::time::Span;
use flexsc_core::spacecraft::manoeuvre::{BangBang, Manoeuvre, ManoeuvreCommand, Plan, Suppression};
use flexsc_figure::{RGBColor, colour};

/// Largest number of commands.
const MOST: usize = 5;
/// Colours of p = 0, 1, ...
const COLOURS: [RGBColor; MOST] =
    [colour::ORANGE, colour::SKY, colour::GREEN, colour::VERMILLION, colour::BLUE];

/// Content of the figures of a plan.
pub struct CommandFamily<'a> {
    /// Name of the scenario.
    pub name: &'a str,
    /// Body of the scenario.
    pub body: &'a AxisModel,
    /// Planned command.
    pub plan: &'a Plan,
    /// Index of the coordinate that is shown: the hub's angle or an output.
    pub shown: usize,
    /// Commands in their drawing order.
    pub members: Vec<FamilyMember<'a>>,
}

/// Command of the family.
pub struct FamilyMember<'a> {
    /// Name of the command in the legend.
    pub name: String,
    /// Colour of the command's lines.
    pub colour: RGBColor,
    /// Plan of the command.
    pub plan: Cow<'a, Plan>,
}

impl<'a> CommandFamily<'a> {
    /// Returns the family of a plan: its series with up to as many zeros, or the rigid bang-bang, all in the same time.
    /// Commands without a feasible plan are left out.
    pub fn new(
        name: &'a str,
        body: &'a AxisModel,
        plan: &'a Plan,
        manoeuvre: &Manoeuvre,
        planned_for: &AxisModel,
        shown: usize,
    ) -> Self {
        let time = Some(Span::from_seconds(plan.time));
        let in_time = |command: ManoeuvreCommand, shaped: bool| {
            let shaper = if shaped { manoeuvre.shaper.clone() } else { None };
            let other = Manoeuvre { time, peak_torque: None, command, shaper, ..manoeuvre.clone() };
            other.plan(planned_for).ok().map(Cow::Owned)
        };
        let own =
            |name: &str, colour| FamilyMember { name: name.to_owned(), colour, plan: Cow::Borrowed(plan) };
        let series = match &manoeuvre.command {
            ManoeuvreCommand::Sine(own) => {
                Some((ManoeuvreCommand::Sine as fn(Suppression) -> ManoeuvreCommand, own))
            }
            ManoeuvreCommand::Cosine(own) => {
                Some((ManoeuvreCommand::Cosine as fn(Suppression) -> ManoeuvreCommand, own))
            }
            _ => None,
        };
        let members = if let Some((kind, suppression)) = series {
            let extra_zeros: usize = suppression.zeros.iter().map(|target| target.times as usize).sum();
            let plain = extra_zeros == 0;
            let most = (suppression.suppress + extra_zeros).min(planned_for.modes.len());
            let count = if plain { MOST } else { MOST - 1 };
            let member = |p: usize| {
                let (name, colour) = (format!("p = {p}"), COLOURS[p % MOST]);
                if plain && p == most {
                    return Some(own(&name, colour));
                }
                let lowest = Suppression { suppress: p, zeros: Vec::new() };
                Some(FamilyMember { name, colour, plan: in_time(kind(lowest), true)? })
            };
            let first = (most + 1).saturating_sub(count);
            let lower = (first..=most).filter_map(member);
            lower.chain((!plain).then(|| own("as planned", colour::BLACK))).collect()
        } else {
            let words = manoeuvre.command.kind().replace('_', " ");
            let shaped = if manoeuvre.shaper.is_some() { ", shaped" } else { "" };
            let own = own(&format!("{words}{shaped}"), colour::BLUE);
            let bang_bang = ManoeuvreCommand::BangBang(BangBang {});
            let same = manoeuvre.command == bang_bang && manoeuvre.shaper.is_none();
            let rigid = if same { None } else { in_time(bang_bang, false) };
            let rigid = rigid.map(|plan| FamilyMember {
                name: "bang-bang, rigid".to_owned(),
                colour: colour::ORANGE,
                plan,
            });
            rigid.into_iter().chain([own]).collect()
        };
        Self { name, body, plan, shown, members }
    }
}
