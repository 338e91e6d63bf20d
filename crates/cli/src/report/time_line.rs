//! Time line of a run: modes of operation, and a strip for each kind of event.

use std::fmt::Write;

use flexsc_core::answer::{Answer, EventKind, RunEvent};
use flexsc_core::formats::reader_units::{number, time};

use super::html::escaped;

/// Width of the picture, and places of the strips: left edge, first top, distance and height.
const WIDTH: f64 = 1000.0;
const LEFT: f64 = 130.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;
const STEP: f64 = 30.0;
const HEIGHT: f64 = 20.0;
/// Least width of a bar, and width of a character of a name in a bar.
const NARROW: f64 = 1.5;
const CHARACTER: f64 = 7.5;
/// Colours of the modes of operation.
const MODES: [&str; 8] =
    ["#cfd8e3", "#f3dd8f", "#bfe0cf", "#9cc9ee", "#e6c3dd", "#f0c9a8", "#d5d0ee", "#c9d8b0"];

/// Strip of a kind of event: its label, colour, and the words if there is none.
const STRIPS: [(EventKind, &str, &str, &str); 5] = [
    (EventKind::Blinding, "tracker blinded", "#8c5b9f", "never"),
    (EventKind::Saturation, "at a limit", "#c1272d", "no actuator reaches a limit"),
    (EventKind::TargetLoss, "target lost", "#7a1316", "never"),
    (EventKind::Eclipse, "eclipse", "#45505c", "none in this orbit at this date"),
    (EventKind::Failure, "failure", "#b35c00", "none"),
];

/// Returns the time line as SVG; `asks` says for which kinds a strip without an event applies. `None` if there is nothing to
/// show.
pub fn svg(answer: &Answer, asks: impl Fn(EventKind) -> bool) -> Option<String> {
    let own = |kind: EventKind| -> Vec<&RunEvent> {
        answer.events.iter().filter(|event| event.kind == kind).collect()
    };
    let end = answer.duration_s.max(f64::MIN_POSITIVE);
    let x = |at: f64| LEFT + (WIDTH - LEFT - RIGHT) * at / end;
    let mut body = String::new();
    let mut y = TOP;
    if !answer.by_mode.is_empty() {
        label(&mut body, y, "mode");
        for event in own(EventKind::Mode) {
            let place = answer.by_mode.iter().position(|mode| mode.mode == event.part).unwrap_or(0);
            bar(&mut body, (x(event.from_s), x(event.to_s)), y, MODES[place % MODES.len()], event);
            let (width, needed) =
                (x(event.to_s) - x(event.from_s), CHARACTER * event.part.chars().count() as f64);
            if width > needed {
                let _ = write!(
                    body,
                    "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                    f64::midpoint(x(event.from_s), x(event.to_s)),
                    y + 14.0,
                    escaped(&event.part)
                );
            }
        }
        y += STEP;
    }
    for (kind, name, colour, none) in STRIPS {
        let events = own(kind);
        if events.is_empty() && !asks(kind) {
            continue;
        }
        label(&mut body, y, name);
        if events.is_empty() {
            let _ = write!(
                body,
                "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#6b7785\">{none}</text>",
                LEFT + 4.0,
                y + 14.0
            );
        }
        for event in events {
            bar(&mut body, (x(event.from_s), x(event.to_s)), y, colour, event);
        }
        y += STEP;
    }
    if y == TOP {
        return None;
    }
    let axis = y - STEP + HEIGHT + 8.0;
    let _ = write!(body, "<path d=\"M{LEFT},{axis} H{}\" stroke=\"#6b7785\"/>", WIDTH - RIGHT);
    for tick in ticks(end) {
        let is_last = tick > 0.97 * end;
        let _ = write!(
            body,
            "<path d=\"M{0:.1},{axis} v5\" stroke=\"#6b7785\"/><text x=\"{0:.1}\" y=\"{1:.1}\" text-anchor=\"{2}\">{3}</text>",
            x(tick),
            axis + 18.0,
            if is_last { "end" } else { "middle" },
            if is_last { time(tick) } else { number(tick) }
        );
    }
    Some(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {:.0}\" class=\"timeline\" role=\"img\" \
         aria-label=\"modes and events over time\">{body}</svg>",
        axis + 24.0
    ))
}

fn label(body: &mut String, y: f64, name: &str) {
    let _ = write!(
        body,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{name}</text>",
        LEFT - 10.0,
        y + 14.0
    );
}

fn bar(body: &mut String, (from, to): (f64, f64), y: f64, colour: &str, event: &RunEvent) {
    let cause = if event.cause.is_empty() { String::new() } else { format!(", {}", event.cause) };
    let title = format!("{}{cause}: {} to {}", event.part, number(event.from_s), time(event.to_s));
    let _ = writeln!(
        body,
        "<rect x=\"{from:.1}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{HEIGHT}\" fill=\"{colour}\"><title>{}</title></rect>",
        (to - from).max(NARROW),
        escaped(title.trim_start_matches(": "))
    );
}

/// Returns round times from 0 to the end.
fn ticks(end: f64) -> Vec<f64> {
    let rough = end / 6.0;
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade).into_iter().find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * decade);
    let mut all: Vec<f64> = (0..=(end / step) as u32)
        .map(|index| f64::from(index) * step)
        .take_while(|tick| *tick <= end)
        .collect();
    if all.last().is_some_and(|last| *last < 0.9 * end) {
        all.push(end);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn times_at_the_axis_are_round() {
        assert_eq!(ticks(30_000.0), [0.0, 5e3, 1e4, 1.5e4, 2e4, 2.5e4, 3e4]);
        assert_eq!(ticks(300.0), [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0]);
    }
}
