//! Drift of natural frequencies: each is its initial value times a ratio that follows a profile.

/// Number of terms of a Taylor series.
pub const SERIES: usize = 21;

/// Profile of the ratio over time.
#[derive(Clone, Debug, PartialEq)]
pub enum RatioProfile {
    /// Linear change from 1 to another ratio, which then stays constant.
    Ramp {
        /// Start time (s).
        from: f64,
        /// Duration (s).
        time: f64,
        /// Ratio afterwards.
        to: f64,
    },
    /// 1 + amplitude (cos(2 pi (t + phase)/period) - cos(2 pi phase/period)).
    Sinusoid {
        /// Half the difference between the largest and the smallest ratio.
        amplitude: f64,
        /// Period (s).
        period: f64,
        /// Time shift of the cosine at the start of the run (s).
        phase: f64,
    },
    /// Linear interpolation between points of time (s) and ratio, constant before the first and after the last.
    Table(Vec<[f64; 2]>),
}

impl RatioProfile {
    /// Returns the ratio at a time (s).
    pub fn ratio(&self, t: f64) -> f64 {
        match self {
            Self::Ramp { from, time, to } => {
                let part = ((t - from) / time).clamp(0.0, 1.0);
                1.0 + (to - 1.0) * part
            }
            Self::Sinusoid { amplitude, period, phase } => {
                let cosine_at = |t: f64| libm::cos(std::f64::consts::TAU * (t + phase) / period);
                1.0 + amplitude * (cosine_at(t) - cosine_at(0.0))
            }
            Self::Table(points) => {
                let after = points.iter().position(|[time, _]| *time > t);
                match (after, points.as_slice()) {
                    (_, []) => 1.0,
                    (Some(0), [[_, first], ..]) => *first,
                    (None, [.., [_, last]]) => *last,
                    (Some(after), _) => {
                        let ([begin, a], [end, b]) = (points[after - 1], points[after]);
                        let part = (t - begin) / (end - begin);
                        a + part * (b - a)
                    }
                }
            }
        }
    }

    /// Returns the derivative of the ratio with time (1/s); at a kink, the right-hand derivative.
    pub fn slope(&self, t: f64) -> f64 {
        match self {
            Self::Ramp { from, time, to } => {
                let during = (*from..from + time).contains(&t);
                if during { (to - 1.0) / time } else { 0.0 }
            }
            Self::Sinusoid { amplitude, period, phase } => {
                let rate = std::f64::consts::TAU / period;
                -amplitude * rate * libm::sin(rate * (t + phase))
            }
            Self::Table(points) => {
                let pair = points.windows(2).find(|pair| pair[0][0] <= t && t < pair[1][0]);
                pair.map_or(0.0, |pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]))
            }
        }
    }

    /// Writes the Taylor series of the ratio at a time (s), at a kink from the right, and returns the number of leading
    /// terms that can differ from 0.
    pub fn series(&self, t: f64, terms: &mut [f64; SERIES]) -> usize {
        // By rounding, a kink may be a last bit later than `t`.
        let after = t * (1.0 + 4.0 * f64::EPSILON) + 1e-14;
        (terms[0], terms[1]) = (self.ratio(t), self.slope(after));
        let Self::Sinusoid { amplitude, period, phase } = self else {
            return if terms[1] == 0.0 { 1 } else { 2 };
        };
        let rate = std::f64::consts::TAU / period;
        let (sin, cos) = libm::sincos(rate * (t + phase));
        // The derivatives of the cosine repeat after four.
        let round = [cos, -sin, -cos, sin];
        let mut scale = *amplitude;
        for (n, term) in terms.iter_mut().enumerate().skip(1) {
            scale *= rate / n as f64;
            *term = scale * round[n % 4];
        }
        SERIES
    }

    /// Returns the times (s) at which the slope jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Ramp { from, time, .. } => vec![*from, from + time],
            Self::Sinusoid { .. } => Vec::new(),
            Self::Table(points) => points.iter().map(|[time, _]| *time).collect(),
        }
    }
}

/// Drift of all frequencies of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum FrequencyDrift {
    /// All frequencies have one ratio.
    Common(RatioProfile),
    /// Each frequency has its own ratio, in the order of the modes.
    Each(Vec<RatioProfile>),
}

impl FrequencyDrift {
    /// Returns the ratio of a mode at a time (s).
    pub fn ratio(&self, mode: usize, t: f64) -> f64 {
        match self {
            Self::Common(profile) => profile.ratio(t),
            Self::Each(profiles) => profiles.get(mode).map_or(1.0, |profile| profile.ratio(t)),
        }
    }

    /// Returns the derivative of a mode's ratio with time (1/s); at a kink, the right-hand derivative.
    pub fn slope(&self, mode: usize, t: f64) -> f64 {
        match self {
            Self::Common(profile) => profile.slope(t),
            Self::Each(profiles) => profiles.get(mode).map_or(0.0, |profile| profile.slope(t)),
        }
    }

    /// Writes the Taylor series of a mode's ratio at a time (s), and returns the number of leading terms that can
    /// differ from 0.
    pub fn series(&self, mode: usize, t: f64, terms: &mut [f64; SERIES]) -> usize {
        match self {
            Self::Common(profile) => profile.series(t, terms),
            Self::Each(profiles) => profiles.get(mode).map_or(1, |profile| profile.series(t, terms)),
        }
    }

    /// Returns the number of profiles: one common to all modes, or one for each mode.
    pub fn count(&self) -> usize {
        match self {
            Self::Common(_) => 1,
            Self::Each(profiles) => profiles.len(),
        }
    }

    /// Returns the times (s) at which a slope jumps.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Common(profile) => profile.kinks(),
            Self::Each(profiles) => profiles.iter().flat_map(RatioProfile::kinks).collect(),
        }
    }
}
