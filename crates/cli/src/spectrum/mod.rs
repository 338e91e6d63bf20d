//! `flexsc spectrum`: noise of the outputs of a loop, exact from its linear model, and lines of its wheels.

pub(crate) mod contrasts;
mod figures;
mod mirrors;
mod named_mode;
mod peaks;
mod required_index;
mod waterfall;
mod welch;
mod wheels;

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::analysis::noise::{
    EnergyCircle, MachineLines, NoiseError, NoiseReport, NoiseRequest, NoisyLoop, OutputNoise, Window,
    WindowRms,
};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::time_span;
use flexsc_core::{Scenario, ScenarioError};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::at_rest::hinted;
use crate::error::CliError;
use crate::grid::{PositiveGrid, grid_in};
use crate::human::{Units, digits};
use crate::number_table::NumberTable;
use crate::quantity::in_unit;
use crate::result_files::ResultOutput;
use crate::results::{Results, show, with_scenario_name};
use crate::row_table::{Column, column, print_rows, print_table};
use crate::{say, scenario};
use contrasts::SpatialUnits;
use named_mode::ShownModes;
use required_index::RequiredIndex;
use waterfall::OutputWaterfall;
use welch::{LogPart, WelchEstimate, estimates};

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct SpectrumArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Outputs of the loop, or `all` [default: measured angles, with --log pointing errors, and lines of sight]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    signal: Vec<String>,
    /// Length of the windows of pointing indices of noise and of the lines of wheels (s), such as an exposure time
    #[arg(long, value_name = "TIME", value_parser = in_unit("s"))]
    window: Option<f64>,
    /// Time from the start of a window to that of the next (s), for differences of their means
    #[arg(long, value_name = "TIME", requires = "window", value_parser = in_unit("s"))]
    separation: Option<f64>,
    /// Angle of a pixel (rad): prints the contrast (MTF) that the motion leaves an image at its Nyquist frequency, over exposures of
    /// --window, or without one over a long exposure
    #[arg(long, value_name = "ANGLE", value_parser = in_unit("rad"))]
    pixel: Option<f64>,
    /// Steady rate of the image during the exposure --window (rad/s): prints the factor of its smear
    #[arg(long, value_name = "RATE", requires = "pixel", requires = "window", value_parser = in_unit("rad/s"))]
    smear: Option<f64>,
    /// Wavelength over the diameter of a circular aperture (rad): prints the factor of its diffraction
    #[arg(long, value_name = "ANGLE", requires = "pixel", value_parser = in_unit("rad"))]
    diffraction: Option<f64>,
    /// Speeds of the wheels (rad/s) for the lines of their imbalance [default: 48 up to their largest, and the peaks between]
    #[arg(long, value_name = "LO:HI:COUNT", value_parser = grid_in("rad/s"))]
    speeds: Option<PositiveGrid>,
    /// Full log of a run of the scenario, whose densities by Welch's method are compared
    #[arg(long, value_name = "LOG")]
    log: Option<PathBuf>,
    /// Start of the part of the log that is used (s), after the transient
    #[arg(long, value_name = "TIME", requires = "log", default_value_t = 0.0, value_parser = in_unit("s"))]
    from: f64,
    /// Samples of a segment of the log [default: an eighth of the log]
    #[arg(long, value_name = "COUNT", requires = "log")]
    segment: Option<usize>,
    #[command(flatten)]
    pub drawing: ResultOutput,
}

/// Noise of the outputs of a scenario's loop.
pub struct SpectrumResults {
    /// Name of the scenario.
    name: String,
    report: NoiseReport,
    welch: Vec<WelchEstimate>,
    units: Units,
    /// Whether speeds of the wheels are asked for, over which a table then is.
    over_speed: bool,
    /// Requirement on each output.
    required: Vec<Option<RequiredIndex>>,
    /// Window of the indices (s), if one is given.
    window_s: Option<f64>,
    /// Angle of a pixel (rad), if one is given.
    pixel: Option<f64>,
    modes: ShownModes,
    /// Units of the spatial frequencies of requirements.
    spatial: SpatialUnits,
}

/// Returns the error of a scenario, by its name, without noise.
pub fn refused(name: &str, fault: NoiseError) -> CliError {
    match fault {
        NoiseError::Key(fault) => {
            ScenarioError::Key { origin: name.to_owned(), key: fault.key, why: fault.why }.into()
        }
        NoiseError::Request(why) => CliError::Arguments(format!("--{why}")),
        fault => CliError::Arguments(format!("{name}: {fault}")),
    }
}

/// Computes the noise of a scenario's loop.
pub fn results(scenario: &Scenario, args: &SpectrumArgs) -> Result<SpectrumResults, CliError> {
    let name = scenario.name.clone();
    let refused = |fault: NoiseError| refused(&name, fault);
    let mut request = NoiseRequest {
        signals: args.signal.clone(),
        window: args.window.map(|length| Window { length, separation: args.separation }),
        pixel: args.pixel,
        smear: args.smear,
        diffraction: args.diffraction,
        speeds: args.speeds.clone().map(|PositiveGrid(speeds)| speeds),
    };
    let compared = match &args.log {
        None => None,
        Some(path) => Some((path, NoisyLoop::from_scenario(scenario).map_err(refused)?)),
    };
    if let Some((_, noisy)) = compared.as_ref().filter(|_| args.signal.is_empty()) {
        let name = |output: usize| noisy.outputs[output].name.clone();
        request.signals = noisy.compared_outputs().into_iter().map(name).collect();
    }
    let report = NoiseReport::from_scenario(scenario, &request).map_err(refused)?;
    let welch = match compared {
        None => Vec::new(),
        Some((path, noisy)) => {
            let outputs: Vec<usize> =
                report.outputs.iter().filter_map(|output| noisy.output(&output.output)).collect();
            let part = LogPart { path, from: args.from, segment: args.segment };
            estimates(&part, &noisy, &outputs)?
        }
    };
    let speeds = report.wheels.iter().flat_map(|wheels| &wheels.speed_rad_s);
    let fastest = speeds.copied().fold(0.0, f64::max);
    let required = report.outputs.iter().map(|output| RequiredIndex::on_output(scenario, &output.output));
    Ok(SpectrumResults {
        required: required.collect(),
        modes: ShownModes::new(scenario, fastest),
        spatial: SpatialUnits::new(scenario),
        window_s: args.window,
        pixel: args.pixel,
        over_speed: args.speeds.is_some(),
        units: args.drawing.choice.units(),
        name,
        report,
        welch,
    })
}

pub fn run(args: &SpectrumArgs) -> Result<(), CliError> {
    let target = args.drawing.target(&[args.scenario.scenario.as_path()])?;
    let found = args.scenario.load().and_then(|scenario| results(&scenario, args));
    let results = found.map_err(|failure| hinted(failure, "spectrum", &args.scenario))?;
    if let Some(target) = target {
        target.save(&results)?;
    }
    show(&results, None, args.scenario.json)?;
    contrasts::require_met(&results.name, &results.report.contrasts)
}

/// Columns of the indices of outputs over windows.
const INDICES: [Column<'_>; 8] = [
    column("output", "output"),
    column("mpe", "MPE").unit_of_row(),
    column("rpe_uniform", "RPE\nuniform").unit_of_row(),
    column("rpe_end", "RPE\nend").unit_of_row(),
    column("rpe_middle", "RPE\nmiddle").unit_of_row(),
    column("smear", "smear").unit_of_row(),
    column("beyond_smear", "jitter\nwithout smear").unit_of_row(),
    column("pde", "PDE").unit_of_row(),
];

impl SpectrumResults {
    /// Returns the noise as `--json` prints it.
    pub fn report(&self) -> &NoiseReport {
        &self.report
    }

    /// Returns the text of values in the unit that fits the largest of some.
    fn in_one_unit(&self, values: &[f64], unit: &str) -> impl Fn(f64) -> String + use<> {
        let (factor, unit) = self.units.common(values, unit);
        move |value: f64| format!("{} {unit}", digits(value * factor)).trim_end().to_owned()
    }

    /// Returns the rows of an output: its rms over time and at the samples, and that from each source.
    fn output_rows(&self, output: &OutputNoise) -> Vec<Vec<String>> {
        let quantity = self.in_one_unit(&[output.rms, output.sample_rms], &output.unit);
        let row = |name: &str, rms: f64, part: String, source: &str| {
            vec![name.to_owned(), quantity(rms), part, source.to_owned()]
        };
        let mut rows = vec![
            row(&output.output, output.rms, String::new(), "all, over time"),
            row("", output.sample_rms, String::new(), "all, at the samples of the law"),
        ];
        for (source, rms) in self.report.sources.iter().zip(&output.rms_by_source) {
            let part = if output.rms > 0.0 { 100.0 * (rms / output.rms) * (rms / output.rms) } else { 0.0 };
            rows.push(row("", *rms, format!("{part:.1} %"), source));
        }
        rows
    }

    /// Prints the indices over windows of all outputs.
    fn print_windows(&self) {
        let windows: Vec<(&OutputNoise, WindowRms)> =
            self.report.outputs.iter().filter_map(|output| Some((output, output.window?))).collect();
        let Some((_, first)) = windows.first() else { return };
        let apart = first
            .separation_s
            .map_or_else(String::new, |separation| format!(", {} apart", time_span(separation)));
        say!("  indices over windows of {}{apart}, rms", time_span(first.window_s));
        let rows: Vec<Json> = windows.iter().map(|(output, window)| index_row(window, output)).collect();
        print_rows(&rows, &INDICES, self.units);
    }
}

/// Columns of the lines of machines.
const MACHINES: [Column<'_>; 5] = [
    column("output", "output"),
    column("source", "source"),
    column("frequency_rad_s", "at"),
    column("rms", "rms").unit_of_row(),
    column("peak", "peak").unit_of_row(),
];

/// Columns of the circles of the energy of an image.
const CIRCLES: [Column<'_>; 6] = [
    column("output", "output"),
    column("radius_50_rad", "radius\nof 50 %"),
    column("radius_80_rad", "80 %"),
    column("radius_95_rad", "95 %"),
    column("major_rms_rad", "rms along the\nlonger axis"),
    column("minor_rms_rad", "shorter"),
];

/// Columns of the contrast of an image that moves with an output.
const CONTRAST: [Column<'_>; 4] = [
    column("output", "output"),
    column("noise", "MTF\nof noise").decimals(4),
    column("least", "least with\nlines of wheels").decimals(4),
    column("speed_rad_s", "at"),
];

/// Returns the indices of an output with its name and unit.
fn index_row(window: &WindowRms, output: &OutputNoise) -> Json {
    let mut row = json!(window);
    (row["output"], row["unit"]) = (json!(output.output), json!(output.unit));
    row
}

impl SpectrumResults {
    /// Prints the contrast that the motion of each output leaves an image, if a pixel is given.
    fn print_contrast(&self) {
        let Some(pixel) = self.pixel else { return };
        let wheels = self.report.wheels.as_ref();
        let row = |(index, output): (usize, &OutputNoise)| {
            let over_speed =
                wheels.and_then(|wheels| Some(wheels.speed_rad_s.iter().zip(wheels.mtf.get(index)?)));
            let least = over_speed.and_then(|all| all.min_by(|a, b| a.1.total_cmp(b.1)));
            Some(json!({
                "output": output.output,
                "noise": output.mtf?,
                "least": least.map(|(_, value)| value),
                "speed_rad_s": least.map(|(speed, _)| speed),
            }))
        };
        let rows: Vec<Json> = self.report.outputs.iter().enumerate().filter_map(row).collect();
        let exposure = match self.window_s {
            Some(window) => format!("exposures of {}", time_span(window)),
            None => "a long exposure".to_owned(),
        };
        say!(
            "  contrast (MTF) that the motion leaves an image over {exposure}, at the Nyquist frequency of pixels of {}",
            self.units.quantity(pixel, "rad")
        );
        let columns =
            if rows.iter().any(|row| row["least"].is_number()) { &CONTRAST[..] } else { &CONTRAST[..2] };
        print_rows(&rows, columns, self.units);
        if let Some(image) = &self.report.image {
            let factors = [
                ("detector", Some(image.detector)),
                ("diffraction", image.diffraction),
                ("smear", image.smear),
            ];
            let factor = |(name, value): (&str, Option<f64>)| Some(format!("{name} {:.4}", value?));
            let factors: Vec<String> = factors.into_iter().filter_map(factor).collect();
            say!("  times {}: together {:.4}", factors.join(", "), image.product);
        }
        self.print_circles();
    }

    /// Prints the circles that contain the energy of an image.
    fn print_circles(&self) {
        let circle = |own: &EnergyCircle| {
            let mut row = json!(own);
            row["output"] = json!(format!("line_of_sight{}", own.line));
            row
        };
        let circles: Vec<Json> = self.report.circles.iter().map(circle).collect();
        if !circles.is_empty() {
            say!("  energy of the image within circles, by noise and broadband loads; lines are not in it");
            print_rows(&circles, &CIRCLES, self.units);
        }
    }

    /// Prints the lines of machines at their worst frequencies.
    fn print_machines(&self) {
        let of_output = |output: &OutputNoise| {
            let mut name = output.output.as_str();
            let row = |machine: &MachineLines| {
                let mut row = json!(machine);
                (row["output"], row["unit"]) = (json!(std::mem::take(&mut name)), json!(output.unit));
                row
            };
            output.machines.iter().flatten().map(row).collect::<Vec<_>>()
        };
        let rows: Vec<Json> = self.report.outputs.iter().flat_map(of_output).collect();
        if !rows.is_empty() {
            say!("  lines of machines, each at its worst frequency for the output");
            print_rows(&rows, &MACHINES, self.units);
        }
    }

    /// Prints the estimates of a log beside the exact rms, with a warning where its bins are too wide for a peak.
    fn print_welch(&self) {
        let Some(first) = self.welch.first() else { return };
        say!(
            "  the log by Welch's method: {} of {} samples",
            counted(first.segments, "segment"),
            first.segment
        );
        let titles = ["output", "rms of the log", "exact", "bins within the 90 % interval", "column"];
        let mut rows = vec![titles.map(str::to_owned).to_vec()];
        for estimate in &self.welch {
            let Some(output) = self.report.outputs.iter().find(|output| output.output == estimate.output)
            else {
                continue;
            };
            let quantity = self.in_one_unit(&[estimate.rms, output.sample_rms], &output.unit);
            rows.push(vec![
                estimate.output.clone(),
                quantity(estimate.rms),
                quantity(output.sample_rms),
                format!("{:.0} %", 100.0 * estimate.part_within()),
                estimate.column.clone(),
            ]);
        }
        print_table(&rows, 1);
        let (factor, unit) = self.units.frequency();
        if let Some((segment, frequency)) =
            first.narrowest.filter(|(segment, _)| *segment > first.segment as f64)
        {
            say!(
                "  warning: a bin is too wide for the narrowest peak of the loop, at {} {unit}, where the estimate is low: \
                 it takes segments of {} samples (--segment)",
                digits(frequency * std::f64::consts::TAU * factor),
                digits(segment.ceil())
            );
        }
    }
}

impl Results for SpectrumResults {
    fn json(&self) -> Vec<Json> {
        let mut object = with_scenario_name(&self.name, json!(self.report));
        if !self.welch.is_empty() {
            object["welch"] = json!(self.welch);
        }
        vec![object]
    }

    fn figures(&self) -> Vec<Named> {
        let mut all = figures::densities(&self.name, &self.report, &self.welch);
        let windows = (&self.required[..], self.window_s);
        all.extend(waterfall::figures(&self.name, &self.report, windows, &self.modes));
        all.extend(mirrors::figures(&self.name, &self.report.mirrors));
        all.extend(contrasts::figures(&self.name, &self.report.contrasts, &self.spatial));
        all
    }

    fn table(&self) -> Option<NumberTable> {
        if let Some(wheels) = self.report.wheels.as_ref().filter(|_| self.over_speed) {
            return Some(wheels::table(&self.report, wheels));
        }
        let mut columns = vec!["frequency_hz".to_owned()];
        let mut lists: Vec<&Vec<f64>> = vec![&self.report.frequency_hz];
        for output in &self.report.outputs {
            let name = &output.output;
            columns.extend([format!("{name}_density"), format!("{name}_cumulative_rms")]);
            lists.extend([&output.density, &output.cumulative_rms]);
            for (source, density) in self.report.sources.iter().zip(&output.density_by_source) {
                columns.push(format!("{name}_density {source}"));
                lists.push(density);
            }
        }
        let row = |place: usize| lists.iter().map(|list| Some(list[place])).collect();
        Some(NumberTable { columns, rows: (0..self.report.frequency_hz.len()).map(row).collect() })
    }

    fn print(&self) -> Result<(), CliError> {
        let NoiseReport { spectral_radius, period_s, samples, nyquist_hz, sources, outputs, .. } =
            &self.report;
        let samples = match *samples {
            1 => String::new(),
            count => format!(", {}", counted(count, "sample") + " of the law"),
        };
        say!(
            "{}   {} of noise in a stable loop: spectral radius {spectral_radius:.6} in {period_s} s{samples}, \
             densities to {} Hz",
            self.name,
            counted(sources.len(), "source"),
            digits(*nyquist_hz)
        );
        if !sources.is_empty() {
            let mut rows = vec![["output", "rms", "of variance", "source"].map(str::to_owned).to_vec()];
            rows.extend(outputs.iter().flat_map(|output| self.output_rows(output)));
            print_table(&rows, 1);
            self.print_windows();
        }
        mirrors::print(&self.report.mirrors, self.units);
        self.print_machines();
        self.print_contrast();
        contrasts::print(&self.report.contrasts, &self.spatial, self.units);
        self.print_welch();
        if let Some(wheels) = &self.report.wheels {
            wheels::print(&self.report, wheels, self.units);
            let all = OutputWaterfall::all(&self.report, &self.required, self.window_s);
            peaks::print(&all, self.units);
        }
        Ok(())
    }
}
