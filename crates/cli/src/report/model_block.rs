//! Animated model of a spacecraft: its boxes, turned by the attitudes of the run.

use flexsc_core::formats::reader_units::time;
use flexsc_core::record::row::TopicRow;
use flexsc_core::record::{Columns, Log, Pointing};
use flexsc_view::drawing::{ModelFace, model_faces};
use serde_json::json;

use super::html::figure;
use super::study::Study;

/// Number of attitudes that are shown.
const MOST: usize = 400;
/// Script that draws and plays the model.
const SCRIPT: &str = include_str!("model.js");

/// Returns the figure of a run; `None` of a body that is not built from its parts, and of a log without attitudes.
pub fn block(study: &Study, log: &Log) -> Option<String> {
    let faces = model_faces(&study.scenario)?;
    let table = log.tables(&[Pointing::TOPIC.name]).ok()?.pop()??;
    let all = Columns::timed_rows::<Pointing>(&table).filter(|all| !all.is_empty())?;
    let rows = shown(&all);
    let face = |own: &ModelFace| {
        json!({
            "corners": own.corners.map(|corner| corner.map(rounded)),
            "normal": own.normal.map(rounded),
            "colour": own.colour,
        })
    };
    let reach = faces.iter().flat_map(|own| own.corners);
    let reach =
        reach.map(|corner| corner.iter().map(|own| own * own).sum::<f64>()).fold(0.0, f64::max).sqrt();
    let data = json!({
        "reach": rounded(reach),
        "faces": faces.iter().map(face).collect::<Vec<_>>(),
        "times": rows.iter().map(|(at, _)| time(*at)).collect::<Vec<_>>(),
        "attitudes": rows.iter().map(|(_, row)| quaternion(row).map(|own| (1e4 * own).round() / 1e4)).collect::<Vec<_>>(),
    });
    let inner = format!(
        "<canvas id=\"model\" width=\"640\" height=\"420\"></canvas>\n\
         <p><button id=\"model-play\" type=\"button\">Play</button> <input id=\"model-at\" type=\"range\" min=\"0\" max=\"{}\" value=\"0\" \
         aria-label=\"time\"> <output id=\"model-time\"></output></p>\n<script>\n{}</script>",
        rows.len() - 1,
        SCRIPT.replacen("DATA", &data.to_string(), 1)
    );
    let caption = "The run as a model: x, y, z are the axes of the body, X, Y, Z the inertial ones. Turns take more of its time than rest.";
    Some(figure("model", &inner, caption))
}

fn quaternion(row: &Pointing) -> [f64; 4] {
    [row.q_w, row.q_x, row.q_y, row.q_z]
}

/// Returns a length (m) to a thousandth of a millimetre, or a component of a direction as exactly.
fn rounded(value: f64) -> f64 {
    (1e6 * value).round() / 1e6
}

/// Returns the rows that are shown, in even steps of the share of the run's time plus that of all its turns.
fn shown(rows: &[(f64, Pointing)]) -> Vec<&(f64, Pointing)> {
    let angle = |one: &Pointing, other: &Pointing| {
        let cosine: f64 = quaternion(one).iter().zip(quaternion(other)).map(|(a, b)| a * b).sum();
        2.0 * cosine.abs().min(1.0).acos()
    };
    let steps = rows.windows(2).map(|pair| [pair[1].0 - pair[0].0, angle(&pair[0].1, &pair[1].1)]);
    let steps: Vec<[f64; 2]> = steps.collect();
    let all = steps.iter().fold([f64::MIN_POSITIVE; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
    let (mut part, mut next) = (0.0, 0.0);
    let mut picked = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        if index > 0 {
            part += 0.5 * (steps[index - 1][0] / all[0] + steps[index - 1][1] / all[1]);
        }
        if part >= next || index + 1 == rows.len() {
            picked.push(row);
            next = part + 1.0 / MOST as f64;
        }
    }
    picked
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(angle: f64) -> Pointing {
        let [w, z] = [(angle / 2.0).cos(), (angle / 2.0).sin()];
        Pointing {
            q_w: w,
            q_x: 0.0,
            q_y: 0.0,
            q_z: z,
            roll_rad: 0.0,
            pitch_rad: 0.0,
            yaw_rad: 0.0,
            roll_error_rad: 0.0,
            pitch_error_rad: 0.0,
            yaw_error_rad: 0.0,
        }
    }

    #[test]
    fn turns_are_shown_in_more_rows_than_rest() {
        // A turn of 1 rad within 100 s of a run of 10 000 s.
        let rows: Vec<(f64, Pointing)> = (0..10_000)
            .map(|second| {
                let angle = (f64::from(second) - 5000.0).clamp(0.0, 100.0) / 100.0;
                (f64::from(second), turned(angle))
            })
            .collect();
        let picked = shown(&rows);
        let during = picked.iter().filter(|row| (5000.0..5100.0).contains(&row.0)).count();
        assert!(picked.len() <= MOST + 1 && (95..=100).contains(&during), "{} {during}", picked.len());
        assert_eq!((picked[0].0, picked[picked.len() - 1].0), (0.0, 9999.0));
    }
}
