//! Quantities that laws and conditions of modes read or command: telemetry, FMUs and flight code take name, unit and meaning
//! from here.

/// Declares the quantities: channel of flight code, group and name in telemetry and FMUs, unit, and meaning as a noun phrase.
macro_rules! flight_quantities {
    ($($(#[$doc:meta])+ $variant:ident $channel:literal, $group:literal $name:literal, $unit:literal, $meaning:literal;)*) => {
        /// Quantity that laws or conditions of modes read or command.
        #[derive(Copy, Clone, Debug, PartialEq, Eq)]
        pub enum FlightQuantity { $($(#[$doc])+ $variant),* }

        impl FlightQuantity {
            /// Returns the declaration.
            pub const fn declaration(self) -> FlightDeclaration {
                match self {
                    $(Self::$variant => FlightDeclaration { channel: $channel, group: $group, name: $name, unit: $unit, meaning: $meaning }),*
                }
            }
        }
    };
}

/// Names, unit and meaning of a quantity that laws read or command.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct FlightDeclaration {
    /// Name of its channel in flight code.
    pub channel: &'static str,
    /// Group in telemetry and FMUs; empty without one.
    pub group: &'static str,
    /// Name within the group.
    pub name: &'static str,
    /// Unit; empty for a dimensionless quantity.
    pub unit: &'static str,
    /// Meaning, as a noun phrase.
    pub meaning: &'static str,
}

flight_quantities! {
    /// Estimated angles from the target (rad).
    Angle "angle", "estimate" "angle", "rad", "estimated angle from the target about each axis";
    /// Estimated rates (rad/s).
    Rate "rate", "estimate" "rate", "rad/s", "estimated rate about each axis";
    /// Displacements of the dominant mode (rad).
    Displacement "displacement", "estimate" "mode_displacement", "rad", "displacement of the dominant mode";
    /// Time derivatives of these displacements (rad/s).
    DisplacementRate "displacement_rate", "estimate" "mode_rate", "rad/s", "rate of the displacement";
    /// Frequencies of the dominant mode (rad/s).
    Frequency "frequency", "estimate" "mode_frequency", "rad/s", "frequency of the dominant mode";
    /// Commanded changes of the rates that are not executed yet (rad/s).
    QueuedRate "queued_rate", "" "queued_rate", "rad/s", "commanded change of the rate that is not yet executed";
    /// Rates of the elastic modes (rad/s).
    ElasticRate "mode_rate", "" "mode_rate", "rad/s", "elastic rate of each mode about each axis";
    /// Frequencies of the elastic modes (rad/s).
    ElasticFrequency "mode_frequency", "" "mode_frequency", "rad/s", "frequency of each mode";
    /// Influences of the elastic modes.
    ElasticInfluence "mode_influence", "" "mode_influence", "", "jump of the elastic rate per unit jump of the rigid rate; 0 for no mode";
    /// Whether laws may act on the elastic modes.
    ElasticTrust "modes_are_trusted", "" "modes_are_trusted", "", "true if the law may act on the modes";
    /// Attitude from which angles count.
    TargetAttitude "target_attitude", "reference" "attitude", "", "target attitude: quaternion w, x, y, z";
    /// Angles of the reference (rad).
    ReferenceAngle "reference_angle", "reference" "angle", "rad", "reference: angle from the target";
    /// Rates of the reference (rad/s).
    ReferenceRate "reference_rate", "reference" "rate", "rad/s", "reference: rate";
    /// Accelerations of the reference (rad/s²).
    ReferenceAcceleration "reference_acceleration", "reference" "acceleration", "rad/s²", "reference: acceleration";
    /// Momentum stored in the rotors (N m s).
    StoredMomentum "stored_momentum", "" "stored_momentum", "N m s", "absolute momentum stored in the rotors, body axes";
    /// Speeds of the wheels (rad/s).
    WheelSpeed "wheel_speed", "wheels" "speed", "rad/s", "speed of each wheel relative to the body, by its tachometer";
    /// Last measured magnetic field (T).
    Field "field", "" "field", "T", "measured magnetic field, body axes";
    /// Rate of change of the measured magnetic field (T/s).
    FieldRate "field_rate", "estimate" "field_rate", "T/s", "rate of change of the field";
    /// Commanded torques (N m).
    Torque "torque", "" "command", "N m", "torque about each axis";
}

impl FlightQuantity {
    /// Returns the name of the channel in flight code.
    pub const fn channel(self) -> &'static str {
        self.declaration().channel
    }

    /// Returns the name in telemetry and FMUs, such as `estimate.rate`.
    pub fn path(self) -> String {
        let FlightDeclaration { group, name, .. } = self.declaration();
        if group.is_empty() { name.to_owned() } else { format!("{group}.{name}") }
    }
}
