//! Messages of Vizard, the viewer of Basilisk, in protobuf: the part of its `VizMessage` that a run of flexsc has.

/// Message of one instant.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizMessage {
    /// Time of the message.
    #[prost(message, optional, tag = "1")]
    pub current_time: Option<VizTime>,
    /// Planet and Sun.
    #[prost(message, repeated, tag = "2")]
    pub celestial_bodies: Vec<VizCelestialBody>,
    /// Spacecraft, and its parts that move.
    #[prost(message, repeated, tag = "3")]
    pub spacecraft: Vec<VizSpacecraft>,
    /// Settings; in the first message only.
    #[prost(message, optional, tag = "7")]
    pub settings: Option<VizSettings>,
    /// Date of the start; in the first message only.
    #[prost(message, optional, tag = "8")]
    pub epoch: Option<VizEpoch>,
}

/// Date and time of day.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizEpoch {
    /// Year.
    #[prost(int32, tag = "1")]
    pub year: i32,
    /// Month, from 1.
    #[prost(int32, tag = "2")]
    pub month: i32,
    /// Day, from 1.
    #[prost(int32, tag = "3")]
    pub day: i32,
    /// Hour.
    #[prost(int32, tag = "4")]
    pub hours: i32,
    /// Minute.
    #[prost(int32, tag = "5")]
    pub minutes: i32,
    /// Second.
    #[prost(double, tag = "6")]
    pub seconds: f64,
}

/// Time of a message.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizTime {
    /// Index of the message, from 0.
    #[prost(int64, tag = "1")]
    pub frame_number: i64,
    /// Time since the start (ns).
    #[prost(double, tag = "2")]
    pub elapsed_ns: f64,
}

/// Planet or Sun.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizCelestialBody {
    /// Name.
    #[prost(string, tag = "1")]
    pub body_name: String,
    /// Position in inertial axes (m).
    #[prost(double, repeated, tag = "2")]
    pub position: Vec<f64>,
    /// Velocity in inertial axes (m/s).
    #[prost(double, repeated, tag = "3")]
    pub velocity: Vec<f64>,
    /// Rows of the matrix from inertial axes to those of the body.
    #[prost(double, repeated, tag = "4")]
    pub rotation: Vec<f64>,
    /// Gravitational parameter (km³/s²).
    #[prost(double, tag = "5")]
    pub mu: f64,
    /// Equatorial radius (km).
    #[prost(double, tag = "6")]
    pub radius_km: f64,
}

/// Spacecraft, or a part of one.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizSpacecraft {
    /// Name.
    #[prost(string, tag = "1")]
    pub spacecraft_name: String,
    /// Position in inertial axes (m).
    #[prost(double, repeated, tag = "2")]
    pub position: Vec<f64>,
    /// Velocity in inertial axes (m/s).
    #[prost(double, repeated, tag = "3")]
    pub velocity: Vec<f64>,
    /// Attitude: modified Rodrigues parameters from inertial axes to those of the body.
    #[prost(double, repeated, tag = "4")]
    pub rotation: Vec<f64>,
    /// Wheels.
    #[prost(message, repeated, tag = "5")]
    pub reaction_wheels: Vec<VizWheel>,
    /// Thrusters.
    #[prost(message, repeated, tag = "6")]
    pub thrusters: Vec<VizThruster>,
    /// Sensors with a field of view.
    #[prost(message, repeated, tag = "8")]
    pub generic_sensors: Vec<VizSensor>,
    /// Name of the spacecraft of which this is a part.
    #[prost(string, tag = "19")]
    pub parent_spacecraft_name: String,
}

/// Reaction wheel.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizWheel {
    /// Position in the body's axes (m).
    #[prost(double, repeated, tag = "2")]
    pub position: Vec<f64>,
    /// Axis in the body's axes.
    #[prost(double, repeated, tag = "4")]
    pub spin_axis: Vec<f64>,
    /// Speed (rad/s).
    #[prost(double, tag = "5")]
    pub wheel_speed: f64,
    /// Torque of the motor (N m).
    #[prost(double, tag = "6")]
    pub wheel_torque: f64,
    /// Largest speed (rad/s); 0 without a limit.
    #[prost(double, tag = "7")]
    pub max_speed: f64,
    /// Largest torque (N m); 0 without a limit.
    #[prost(double, tag = "8")]
    pub max_torque: f64,
}

/// Thruster.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizThruster {
    /// Position in the body's axes (m).
    #[prost(double, repeated, tag = "2")]
    pub position: Vec<f64>,
    /// Direction of the force on the body, in its axes.
    #[prost(double, repeated, tag = "4")]
    pub thrust_vector: Vec<f64>,
    /// Thrust (N).
    #[prost(double, tag = "5")]
    pub current_thrust: f64,
    /// Largest thrust (N).
    #[prost(double, tag = "6")]
    pub max_thrust: f64,
    /// Name.
    #[prost(string, tag = "8")]
    pub thruster_tag: String,
}

/// Sensor with a field of view.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizSensor {
    /// Position in the body's axes (m).
    #[prost(double, repeated, tag = "2")]
    pub position: Vec<f64>,
    /// Field of view from edge to edge (deg).
    #[prost(double, repeated, tag = "3")]
    pub field_of_view: Vec<f64>,
    /// Boresight in the body's axes.
    #[prost(double, repeated, tag = "4")]
    pub normal_vector: Vec<f64>,
    /// Label.
    #[prost(string, tag = "9")]
    pub label: String,
}

/// Settings of the viewer.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizSettings {
    /// 1 shows the axes of spacecraft, -1 hides them.
    #[prost(int32, tag = "3")]
    pub spacecraft_axes: i32,
    /// Models of spacecraft and parts.
    #[prost(message, repeated, tag = "12")]
    pub custom_models: Vec<VizModel>,
    /// 1 shows labels of spacecraft, -1 hides them.
    #[prost(int32, tag = "17")]
    pub spacecraft_labels: i32,
    /// Name of the spacecraft that the camera follows.
    #[prost(string, tag = "34")]
    pub main_camera_target: String,
    /// 1 starts with the view of the spacecraft.
    #[prost(int32, tag = "50")]
    pub start_at_spacecraft: i32,
}

/// Model of spacecraft or parts.
#[derive(Clone, PartialEq, prost::Message)]
pub struct VizModel {
    /// Shape: `CUBE`.
    #[prost(string, tag = "1")]
    pub model_path: String,
    /// Names of spacecraft and parts.
    #[prost(string, repeated, tag = "2")]
    pub bodies: Vec<String>,
    /// Offset (m).
    #[prost(double, repeated, tag = "3")]
    pub offset: Vec<f64>,
    /// Rotation (deg).
    #[prost(double, repeated, tag = "4")]
    pub rotation: Vec<f64>,
    /// Edges (m).
    #[prost(double, repeated, tag = "5")]
    pub scale: Vec<f64>,
    /// Red, green, blue and opacity from 0 to 255.
    #[prost(int32, repeated, tag = "9")]
    pub color: Vec<i32>,
}
