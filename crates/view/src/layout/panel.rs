//! Panels of a layout: content of each kind, and its configuration for viewers.

use serde_json::{Map, Value, json};

use crate::scene::Extent;

/// Colours that colour-blind readers can distinguish.
const COLORS: [&str; 7] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#8C8C8C"];
/// Largest number of lines of one kind in a plot.
pub const MOST_LINES: usize = 6;

/// Panel of a layout.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutPanel {
    name: String,
    title: String,
    shows: PanelContent,
    /// Limits of the vertical axis of a plot; without them, the viewer chooses.
    pub limits: Option<[f64; 2]>,
}

/// Content of a panel.
#[derive(Clone, Debug, PartialEq)]
enum PanelContent {
    /// Values over time.
    Plot(Vec<PlotLine>),
    /// Values over another value.
    Plane(Vec<PlotLine>, String),
    /// States over time.
    States(Vec<PlotLine>),
    /// Last message of a topic.
    Message(String),
    /// Rows of the last message of a topic: viewers show ten.
    Table(String),
    /// Lines of the log.
    Log,
    /// Three-dimensional scene, from these topics.
    Scene(Extent, Vec<&'static str>),
}

/// Line of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLine {
    path: String,
    label: String,
    /// True for points that are not joined.
    dots: bool,
    thick: bool,
    /// Number of the line's colour, if it is not the line's own.
    color: Option<usize>,
}

/// Creates a line of a value, with its label.
pub fn line(path: impl Into<String>, label: impl Into<String>) -> PlotLine {
    PlotLine { path: path.into(), label: label.into(), dots: false, thick: false, color: None }
}

impl PlotLine {
    /// Returns the line as separate points.
    pub fn dots(self) -> Self {
        Self { dots: true, ..self }
    }

    /// Returns the line with a thick stroke.
    pub fn thick(self) -> Self {
        Self { thick: true, ..self }
    }

    /// Returns the line with the colour of another line's number, such as the line that it is compared with.
    pub fn color(self, number: usize) -> Self {
        Self { color: Some(number), ..self }
    }

    /// Returns the topic of the line; `None` for a number, which is a horizontal line.
    fn topic(&self) -> Option<&str> {
        self.path.starts_with('/').then(|| topic(&self.path))
    }
}

/// Returns the topic of a path.
pub fn topic(path: &str) -> &str {
    path.split_once('.').map_or(path, |(topic, _)| topic)
}

impl LayoutPanel {
    fn new(name: impl Into<String>, title: impl Into<String>, shows: PanelContent) -> Self {
        Self { name: name.into(), title: title.into(), shows, limits: None }
    }

    /// Creates a plot of values over time.
    pub fn plot(name: impl Into<String>, title: impl Into<String>, lines: Vec<PlotLine>) -> Self {
        Self::new(name, title, PanelContent::Plot(lines))
    }

    /// Creates a plot of values over another value. Its topic must not be that of the values, or viewers show nothing.
    pub fn plane(name: &'static str, title: impl Into<String>, x: &str, lines: Vec<PlotLine>) -> Self {
        Self::new(name, title, PanelContent::Plane(lines, x.to_owned()))
    }

    /// Creates a panel of states over time.
    pub fn states(name: impl Into<String>, title: impl Into<String>, lines: Vec<PlotLine>) -> Self {
        Self::new(name, title, PanelContent::States(lines))
    }

    /// Creates a panel with the last message of a topic.
    pub fn message(name: &'static str, title: impl Into<String>, topic: &str) -> Self {
        Self::new(name, title, PanelContent::Message(topic.to_owned()))
    }

    /// Creates page `page` of the `of` pages of the metrics.
    pub fn metrics(page: usize, of: usize) -> Self {
        let path = format!("/summary.pages[{page}].metrics");
        let title = format!("Metrics at the end, {} of {of}", page + 1);
        Self::new(format!("metrics_{}", page + 1), title, PanelContent::Table(path))
    }

    /// Creates a panel with the lines of the log.
    pub fn log() -> Self {
        Self::new("log", "What happened", PanelContent::Log)
    }

    /// Creates a panel with the three-dimensional scene.
    pub fn scene(extent: Extent) -> Self {
        Self::new("scene", "Scene", PanelContent::Scene(extent, vec!["/scene", "/plumes"]))
    }

    /// Draws the lines over time of these topics as points.
    pub fn mark(&mut self, marked: &impl Fn(&str) -> bool) {
        let PanelContent::Plot(lines) = &mut self.shows else { return };
        for line in lines {
            line.dots |= line.topic().is_some_and(marked);
        }
    }

    /// Returns the paths on the vertical axis.
    pub fn vertical_paths(&self) -> Vec<&str> {
        match &self.shows {
            PanelContent::Plot(lines) | PanelContent::Plane(lines, _) => {
                lines.iter().map(|line| line.path.as_str()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Returns the name of the panel in a layout.
    pub fn id(&self) -> String {
        let kind = match &self.shows {
            PanelContent::Plot(_) | PanelContent::Plane(..) => "Plot",
            PanelContent::States(_) => "StateTransitions",
            PanelContent::Message(_) => "RawMessages",
            PanelContent::Table(_) => "Table",
            PanelContent::Log => "RosOut",
            PanelContent::Scene(..) => "3D",
        };
        format!("{kind}!{}", self.name)
    }

    /// Returns the height of the panel, relative to others.
    pub fn weight(&self) -> u32 {
        match &self.shows {
            PanelContent::Scene(..) | PanelContent::Plane(..) => 8,
            // The legend needs more height for more lines.
            PanelContent::Plot(lines) => 4.max(lines.len() as u32),
            PanelContent::Log | PanelContent::Message(_) | PanelContent::Table(_) => 4,
            // A row of states has a fixed height.
            PanelContent::States(lines) => (3 * (lines.len() as u32 + 1)).div_ceil(2),
        }
    }

    /// Returns the panel with those lines and rows whose topics a log has; `None` if nothing remains.
    pub fn with_topics(&self, has: &impl Fn(&str) -> bool) -> Option<Self> {
        let kept = |lines: &[PlotLine]| -> Option<Vec<PlotLine>> {
            // Horizontal lines alone show nothing.
            lines.iter().any(|line| line.topic().is_some_and(has)).then_some(())?;
            Some(lines.iter().filter(|line| line.topic().is_none_or(has)).cloned().collect())
        };
        let shows = match &self.shows {
            PanelContent::Plot(lines) => PanelContent::Plot(kept(lines)?),
            PanelContent::Plane(lines, x) => {
                PanelContent::Plane(kept(lines).filter(|_| has(topic(x)))?, x.clone())
            }
            PanelContent::States(lines) => PanelContent::States(kept(lines)?),
            PanelContent::Message(path) | PanelContent::Table(path) => {
                has(topic(path)).then(|| self.shows.clone())?
            }
            PanelContent::Log => has("/log").then_some(PanelContent::Log)?,
            PanelContent::Scene(extent, topics) => {
                let topics: Vec<_> = topics.iter().copied().filter(|topic| has(topic)).collect();
                (!topics.is_empty()).then(|| PanelContent::Scene(extent.clone(), topics))?
            }
        };
        Some(Self { shows, ..self.clone() })
    }

    /// Returns the configuration of the panel.
    pub fn config(&self) -> Value {
        let mut config = match &self.shows {
            PanelContent::Plot(lines) => plot(lines, json!("timestamp"), true),
            PanelContent::Plane(lines, x) => {
                // A synchronised panel would take the time range of the other panels for its horizontal axis.
                let mut config = plot(lines, json!("custom"), false);
                let path = json!({ "value": x, "enabled": true, "timestampMethod": "receiveTime" });
                config.insert("xAxisPath".to_owned(), path);
                config
            }
            PanelContent::States(lines) => states(lines),
            PanelContent::Message(topic) => {
                object(json!({ "topicPath": topic, "diffEnabled": false, "expansion": "all" }))
            }
            PanelContent::Table(path) => object(json!({ "topicPath": path })),
            // From level 2 on, which leaves out debug messages.
            PanelContent::Log => {
                object(json!({ "searchTerms": [], "minLogLevel": 2, "topicToRender": "/log" }))
            }
            PanelContent::Scene(extent, topics) => scene(extent, topics),
        };
        if let Some([least, greatest]) = self.limits {
            config.insert("minYValue".to_owned(), json!(least));
            config.insert("maxYValue".to_owned(), json!(greatest));
        }
        for key in ["foxglovePanelTitle", "lichtblickPanelTitle"] {
            config.insert(key.to_owned(), json!(self.title));
        }
        Value::Object(config)
    }
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(object) => object,
        _ => Map::new(),
    }
}

fn plot(lines: &[PlotLine], x_axis: Value, synced: bool) -> Map<String, Value> {
    let path = |(index, line): (usize, &PlotLine)| {
        let limit = line.topic().is_none();
        json!({
            "value": line.path,
            "enabled": true,
            "timestampMethod": "receiveTime",
            "label": line.label,
            "color": if limit { COLORS[6] } else { COLORS[line.color.unwrap_or(index) % 6] },
            "showLine": !line.dots,
            "lineSize": if line.thick { 2.5 } else if limit { 1.0 } else { 1.5 },
        })
    };
    let longest = lines.iter().map(|line| line.label.chars().count()).max().unwrap_or(0);
    let mut config = object(json!({
        "paths": lines.iter().enumerate().map(path).collect::<Vec<_>>(),
        "showXAxisLabels": true,
        "showYAxisLabels": true,
        "showLegend": true,
        // A floating legend would hide the start of the lines.
        "legendDisplay": "left",
        "showPlotValuesInLegend": false,
        "isSynced": synced,
        "sidebarDimension": 78 + 7 * longest,
    }));
    config.insert("xAxisVal".to_owned(), x_axis);
    config
}

fn states(lines: &[PlotLine]) -> Map<String, Value> {
    let path = |line: &PlotLine| json!({ "value": line.path, "label": line.label, "enabled": true, "timestampMethod": "receiveTime" });
    let paths: Vec<Value> = lines.iter().map(path).collect();
    object(json!({ "isSynced": true, "showPoints": true, "paths": paths }))
}

fn scene(extent: &Extent, topics: &[&str]) -> Map<String, Value> {
    let shown = |topic: &&str| ((*topic).to_owned(), json!({ "visible": true }));
    let hidden = |frame: &String| (format!("frame:{frame}"), json!({ "visible": false }));
    let reach = extent.reach;
    object(json!({
        "cameraState": {
            "perspective": true,
            "distance": 2.6 * reach,
            "phi": 50,
            "thetaOffset": 35,
            "targetOffset": [0, 0, 0],
            "target": [0, 0, 0],
            "targetOrientation": [0, 0, 0, 1],
            "fovy": 45,
            "near": 0.01 * reach,
            "far": 100.0 * reach,
        },
        "followMode": "follow-pose",
        "followTf": "inertial",
        // Without preloading Lichtblick raises an alert. Each message of the frames is complete: of a longer run only
        // the first are preloaded.
        "scene": { "transforms": { "showLabel": false, "enablePreloading": true, "maxPreloadMessages": 20_000 } },
        "transforms": extent.frames.iter().map(hidden).collect::<Map<_, _>>(),
        "topics": topics.iter().map(shown).collect::<Map<_, _>>(),
        "layers": { "grid": {
            "visible": true,
            "drawBehind": false,
            "frameLocked": true,
            "label": "Grid",
            "instanceId": "grid",
            "layerId": "foxglove.Grid",
            "frameId": "inertial",
            "size": 4.0 * reach,
            "divisions": 20,
            "lineWidth": 1,
            "color": "#248eff30",
            "position": [0, 0, -0.4 * reach],
            "rotation": [0, 0, 0],
            "order": 1,
        } },
        "publish": {},
        "imageMode": {},
    }))
}
