//! Figures of tuned gains over the frequency of the dominant mode: their region (\[Wheel11, Sukhanov\], figure 5), and
//! the settling time of the loop.

use flexsc_core::analysis::sampled_loop::{GainRegion, RobustGain};
use flexsc_core::control::law::Extra;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, band, colour};

use super::tuning::TuneSetup;
use crate::plot::readable;

/// Largest settling time that is shown, as a multiple of the limit.
const BEYOND: f64 = 3.0;

/// Data of the figures.
struct TunedFigure<'a> {
    tuning: &'a TuneSetup,
    /// Region at each frequency.
    regions: &'a [GainRegion],
    /// Robust gains and the model's relative error; `None` if they were not requested.
    robust: Option<(&'a [RobustGain], f64)>,
}

/// Returns all figures.
pub fn all(tuning: &TuneSetup, regions: &[GainRegion], robust: Option<(&[RobustGain], f64)>) -> Vec<Named> {
    let (drawn, name) = (TunedFigure { tuning, regions, robust }, &tuning.name);
    vec![(format!("{name}-tune-region"), drawn.region()), (format!("{name}-tune-settling"), drawn.settling())]
}

impl TunedFigure<'_> {
    fn region(&self) -> Figure {
        let line =
            |value: &dyn Fn(&GainRegion) -> Option<f64>| over(self.regions, |r| r.frequency_rad_s, value);
        let lower = line(&|r| r.gain.map(|gain| gain.0));
        let upper = line(&|r| r.gain.map(|gain| gain.1));
        let middle = line(&|r| r.midpoint);
        let own: Vec<Point> = self.tuning.own.iter().flat_map(|own| self.points(own)).collect();
        let robust: Vec<Point> =
            self.robust.map_or_else(Vec::new, |(gains, _)| over(gains, |r| r.frequency_rad_s, |r| r.gain));
        let shown = [&lower, &upper, &own, &robust].into_iter().flatten().map(|point| point.1);
        let y = FigureAxis::around("gain k_d of the extra loop", "", shown.chain([0.0]));
        let x = self.frequency();
        let zero = vec![(x.range.start, 0.0), (x.range.end, 0.0)];
        let within = format!("stable, settles within {} s", self.tuning.limit);
        let mut layers = vec![
            Layer::new(&within, colour::SKY, LayerShape::Area(0.35), band(&lower, &upper)),
            Layer::new("", colour::GREY, LayerShape::Line(0.8), zero),
            Layer::new("", colour::SKY, LayerShape::Line(1.0), lower),
            Layer::new("", colour::SKY, LayerShape::Line(1.0), upper),
        ];
        let highest = self.tuning.gains.values().last().copied().unwrap_or(self.tuning.gains.high);
        // If the region ends only at the highest tested gain, its middle is meaningless.
        if self.regions.iter().any(|region| region.gain.is_some_and(|gain| gain.1 >= highest)) {
            let level = vec![(x.range.start, highest), (x.range.end, highest)];
            layers.push(Layer::new("highest gain tried", colour::GREY, LayerShape::Dashes, level));
        }
        layers.push(Layer::new("middle", colour::BLUE, LayerShape::Line(1.6), middle));
        if !own.is_empty() {
            layers.push(Layer::new("of the scenario", colour::BLACK, LayerShape::Dashes, own));
        }
        layers.push(Layer::new(&self.robust_name(), colour::VERMILLION, LayerShape::Line(1.6), robust));
        let title = format!("{}: gains of the extra loop", readable(&self.tuning.name));
        Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 340 }
    }

    fn settling(&self) -> Figure {
        let result_of =
            |value: &dyn Fn(&GainRegion) -> Option<f64>| over(self.regions, |r| r.frequency_rad_s, value);
        let (middle, without) = (result_of(&|r| r.settling_s), result_of(&|r| r.settling_without_s));
        let robust = |value: &dyn Fn(&RobustGain) -> Option<f64>| {
            self.robust.map_or_else(Vec::new, |(rows, _)| over(rows, |r| r.frequency_rad_s, value))
        };
        let (nominal, worst) = (robust(&|r| r.settling_s), robust(&|r| r.settling_quantile_s));
        let x = self.frequency();
        let shown = [&middle, &without, &nominal, &worst].into_iter().flatten().map(|point| point.1);
        let finite = shown.filter(|time| time.is_finite()).chain([self.tuning.limit]);
        let times = finite.map(|time| time.min(BEYOND * self.tuning.limit));
        let y = FigureAxis::from_zero("settling time (s)", "", times);
        let level = vec![(x.range.start, self.tuning.limit), (x.range.end, self.tuning.limit)];
        let layers = vec![
            Layer::new(
                &format!("at most {} s", self.tuning.limit),
                colour::RED,
                LayerShape::Line(1.4),
                level,
            ),
            Layer::new("without the extra loop", colour::BLACK, LayerShape::Line(1.4), without),
            Layer::new("middle of the region", colour::BLUE, LayerShape::Line(1.6), middle),
            Layer::new(&self.robust_name(), colour::VERMILLION, LayerShape::Line(1.6), nominal),
            Layer::new("the same, perturbed", colour::VERMILLION, LayerShape::Dashes, worst),
        ];
        let title = format!("{}: settling time", readable(&self.tuning.name));
        Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 340 }
    }

    fn robust_name(&self) -> String {
        self.robust.map_or_else(String::new, |(_, off)| format!("robust against {} %", 100.0 * off))
    }

    fn frequency(&self) -> FigureAxis {
        let all = || self.regions.iter().map(|region| region.frequency_rad_s);
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
        FigureAxis::exact("frequency of the dominant mode", "rad/s", low..high).in_hertz()
    }

    /// Returns the gain of the scenario's own extra loop at the frequencies.
    fn points(&self, own: &Extra) -> Vec<Point> {
        self.regions.iter().map(|region| (region.frequency_rad_s, own.gain(region.frequency_rad_s))).collect()
    }
}

/// Returns a value over the frequency, with gaps where there is none.
fn over<T>(rows: &[T], frequency: impl Fn(&T) -> f64, value: impl Fn(&T) -> Option<f64>) -> Vec<Point> {
    rows.iter().map(|row| (frequency(row), value(row).unwrap_or(f64::NAN))).collect()
}
