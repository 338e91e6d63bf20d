//! Figure `torque` of a rotation: the planned torque, the actuator's torque, the law's part and disturbances.

use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

use super::motion::MotionData;
use super::run_events::RunEvents;
use super::{arrival, time, title};

pub fn figure(story: &RunEvents, motion: &MotionData) -> Figure {
    let [planned, feedback, applied, disturbance] = &motion.torques;
    let over_time =
        |values: &[f64]| -> Vec<Point> { motion.time.iter().copied().zip(values.iter().copied()).collect() };
    let acts = |values: &[f64]| values.iter().any(|value| *value != 0.0);
    let (name, unit) = story.scenario.model.commanded_quantity();
    let x = time(0.0..story.end);
    let executed = applied.iter().zip(planned.iter().zip(feedback)).any(|(a, (p, f))| *a != p + f);
    let panel = |x: FigureAxis,
                 name: &str,
                 unit: &'static str,
                 series: &[(&str, flexsc_figure::RGBColor, &[f64])]| {
        let all = series.iter().flat_map(|(.., values)| values.iter().copied());
        let y = FigureAxis::around(name, unit, all);
        let lines = series.iter().map(|(name, colour, values)| {
            Layer::new(name, *colour, LayerShape::Line(1.2), over_time(values))
        });
        let layers = arrival(story, &y).into_iter().chain(lines).collect();
        Panel::new(x, y, layers)
    };
    let mut main: Vec<(&str, _, &[f64])> = Vec::new();
    if executed {
        main.push(("executed", colour::SKY, applied));
    }
    main.push(("planned", colour::BLACK, planned));
    let mut rest: Vec<(&str, _, &[f64])> = Vec::new();
    if acts(disturbance) {
        // The disturbance is lighter than the feedback, also in print without colours.
        rest.push(("disturbance", colour::ORANGE, disturbance));
    }
    if acts(feedback) {
        rest.push(("feedback", colour::BLUE, feedback));
    }
    let wheel = story.scenario.actuator.only_actuator().is_some_and(|kind| kind.command_gain().is_some());
    let panels = match (rest.is_empty(), executed || acts(planned)) {
        _ if wheel => {
            // A wheel has no planned manoeuvre, and the law's demand may be far above the wheel's torque.
            let mut on_body: Vec<(&str, _, &[f64])> = vec![("given by the wheel", colour::BLACK, applied)];
            on_body.extend(rest.iter().filter(|(name, ..)| *name == "disturbance").copied());
            let demanded = [("demanded by the law", colour::BLUE, feedback.as_slice())];
            vec![panel(x.unnamed(), name, unit, &on_body), panel(x, name, unit, &demanded)]
        }
        (true, _) => vec![panel(x, name, unit, &main)],
        (false, false) => vec![panel(x, name, unit, &rest)],
        (false, true) => vec![panel(x.unnamed(), name, unit, &main), panel(x, name, unit, &rest)],
    };
    let height = if panels.len() == 1 { 300 } else { 200 };
    Figure { title: title(story, name), panels, panel_height: height }
}
