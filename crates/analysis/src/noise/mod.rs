//! Noise of a closed loop: covariance, spectra and pointing indices, exact from the linear loop.
//!
//! [`NoisyLoop`] has the loop of a scenario under its noise: sensors, rounding, random torques. From it come, without a
//! simulation,
//!
//! - the variance of each output at the samples, at any time, and over time, by source: [`NoisyLoop::sample_variances`],
//!   [`NoisyLoop::variance_at`], [`NoisyLoop::mean_variances`];
//! - the power spectral density at the samples: [`NoisyLoop::densities`], and [`cumulative_rms`];
//! - the autocovariance, and the expectation of Welch's estimate of the density: [`NoisyLoop::autocovariance`],
//!   [`NoisyLoop::welch_expectation`];
//! - the variance of a weighted sum of samples, as a pointing index is: [`OutputSamples`];
//! - pointing indices over windows in continuous time: [`NoisyLoop::window_variances`], and [`WindowWeights`] for sines and densities;
//! - the contrast of an image that moves with an output, over an exposure: [`ImageBlur`], and [`RequiredContrast`] for requirements.
//!
//! [`Vibration`] has the motion under machines at points of the body: broadband loads as lines of small bands over frequency, and
//! lines at the worst frequency of a machine.
//!
//! [`LineSource`] has the loads of a machine or of wheels, [`LoadedLoop`] the lines of outputs under loads, [`WheelSpectrum`] those of wheels over their
//! speed.
//! [`NoiseReport`] has all of them for some outputs.

mod broadband;
mod covariance;
mod density;
mod energy_circle;
mod exposed_motion;
mod image_contrast;
mod line_solver;
mod line_source;
mod lines;
mod loaded_loop;
mod measured_loads;
pub(crate) mod mirror_states;
mod motion;
mod noisy_loop;
mod output;
mod output_samples;
mod period_rows;
mod report;
mod required_contrast;
mod sample_times;
mod schedule;
mod source;
mod source_motion;
mod spectral_line;
mod speed_grid;
mod transfer;
mod vibration;
mod welch;
mod wheel_spectrum;
mod window_rms;
mod windows;
mod worst_lines;
mod worst_speed;

pub use density::{OutputDensity, cumulative_rms};
pub use energy_circle::EnergyCircle;
pub use image_contrast::{ImageBlur, ImageFactors};
pub use line_source::LineSource;
pub use lines::{LineLoop, TurningMotion};
pub use loaded_loop::LoadedLoop;
pub use measured_loads::VibrationLoad;
pub use noisy_loop::{NoiseError, NoisyLoop};
pub use output_samples::OutputSamples;
pub use report::{MachineLines, NoiseReport, NoiseRequest, OutputNoise};
pub use required_contrast::{ContrastCost, ContrastPoint, RequiredContrast};
pub use sample_times::{SamplePlace, SampleSets, SampleTimes};
pub use source_motion::{SourceMotion, WorstTone};
pub use spectral_line::{OutputLines, SpectralLine};
pub use vibration::Vibration;
pub use welch::NarrowestPeak;
pub use wheel_spectrum::{WheelLines, WheelSpectrum};
pub use window_rms::WindowRms;
pub use windows::{Window, WindowVariances, WindowWeights};
pub use worst_speed::{WheelOutput, WorstSpeed};
