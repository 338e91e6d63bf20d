//! The words of the Foxglove WebSocket protocol, version 1: what the server sends and what clients ask.

use data_encoding::BASE64;
use flexsc_core::record::row::Topic;
use serde_json::{Value as Json, json};
use tungstenite::Message;

use super::clock::Clock;

/// The names by which clients ask for this protocol: the SDK's, and the one before it.
pub const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// The services; their numbers are their places.
const SERVICES: [&str; 3] = ["/pause", "/resume", "/step"];
/// The parameters.
pub const PARAMETERS: [&str; 2] = ["/paused", "/speed"];

/// A request names at most so many things.
const MOST_NAMED: usize = 256;
/// So many characters of a message that is not understood are repeated.
const MOST_TOLD: usize = 200;

/// What a client asks.
#[derive(Debug, PartialEq)]
pub enum Request {
    /// To subscribe to channels: the number of the subscription and that of the channel.
    Subscribe(Vec<(u32, u32)>),
    /// To end these subscriptions.
    Unsubscribe(Vec<u32>),
    /// The values of parameters, all if none is named.
    GetParameters(Vec<String>, Option<Json>),
    /// To set parameters.
    SetParameters(Vec<(String, Json)>, Option<Json>),
    /// To subscribe to changes of these parameters.
    Follow(Vec<String>),
    /// To end that.
    Unfollow(Vec<String>),
    /// A service: its number and that of the call.
    Call(u32, u32),
    /// What this server does not do.
    Other,
}

/// How a status is shown.
#[derive(Copy, Clone)]
pub enum Level {
    Warning = 1,
    Error = 2,
}

impl Request {
    /// Reads what a client sent.
    pub fn read(message: &Message) -> Result<Self, String> {
        match message {
            Message::Text(text) => {
                let json: Json = serde_json::from_str(text).map_err(|error| format!("not JSON: {error}"))?;
                let lists = json.as_object().into_iter().flatten().filter_map(|(_, value)| value.as_array());
                if lists.into_iter().any(|list| list.len() > MOST_NAMED) {
                    return Err(format!("a request may name at most {MOST_NAMED} things"));
                }
                let start = || text.chars().take(MOST_TOLD).collect::<String>();
                Self::of(&json).ok_or_else(|| format!("not understood: {}", start()))
            }
            Message::Binary(bytes) => match bytes.split_first() {
                Some((2, rest)) if rest.len() >= 8 => Ok(Self::Call(number(rest), number(&rest[4..]))),
                _ => Ok(Self::Other),
            },
            _ => Ok(Self::Other),
        }
    }

    fn of(json: &Json) -> Option<Self> {
        let list = |key: &str| json.get(key)?.as_array();
        let names = || {
            let names = list("parameterNames")?.iter();
            names.map(|name| Some(name.as_str()?.to_owned())).collect::<Option<Vec<_>>>()
        };
        let count = |json: &Json| u32::try_from(json.as_u64()?).ok();
        let id = || json.get("id").cloned();
        Some(match json.get("op")?.as_str()? {
            "subscribe" => {
                let pair = |s: &Json| Some((count(s.get("id")?)?, count(s.get("channelId")?)?));
                Self::Subscribe(list("subscriptions")?.iter().map(pair).collect::<Option<_>>()?)
            }
            "unsubscribe" => {
                Self::Unsubscribe(list("subscriptionIds")?.iter().map(count).collect::<Option<_>>()?)
            }
            "getParameters" => Self::GetParameters(names()?, id()),
            "setParameters" => {
                let value = |p: &Json| {
                    Some((p.get("name")?.as_str()?.to_owned(), p.get("value").cloned().unwrap_or(Json::Null)))
                };
                Self::SetParameters(list("parameters")?.iter().map(value).collect::<Option<_>>()?, id())
            }
            "subscribeParameterUpdates" => Self::Follow(names()?),
            "unsubscribeParameterUpdates" => Self::Unfollow(names()?),
            _ => Self::Other,
        })
    }
}

/// The first four bytes as a number.
fn number(bytes: &[u8]) -> u32 {
    bytes.iter().take(4).rev().fold(0, |number, byte| number << 8 | u32::from(*byte))
}

/// What the server is and can do.
pub fn server_info(name: &str, session: &str) -> Message {
    text(&json!({
        "op": "serverInfo",
        "name": name,
        "capabilities": ["time", "parameters", "parametersSubscribe", "services"],
        "supportedEncodings": ["json"],
        "metadata": {"library": concat!("flexsc/", env!("CARGO_PKG_VERSION"))},
        "sessionId": session,
    }))
}

/// The number of a topic's channel.
pub fn channel_of(topic: usize) -> u32 {
    topic as u32 + 1
}

/// The topic of a channel.
pub fn topic_of(channel: u32) -> Option<usize> {
    (channel as usize).checked_sub(1)
}

/// Channels that clients may subscribe to.
pub fn advertise<'a>(topics: impl Iterator<Item = (usize, &'a Topic)>) -> Message {
    let channel = |(index, topic): (usize, &Topic)| {
        json!({
            "id": channel_of(index),
            "topic": topic.name,
            "encoding": "protobuf",
            "schemaName": topic.message,
            "schemaEncoding": "protobuf",
            "schema": BASE64.encode(&topic.schema()),
        })
    };
    text(&json!({"op": "advertise", "channels": topics.map(channel).collect::<Vec<_>>()}))
}

/// The services.
pub fn advertise_services() -> Message {
    let schema = |name: &str, properties: Json| {
        let schema = json!({"type": "object", "properties": properties});
        json!({
            "encoding": "json",
            "schemaName": name,
            "schemaEncoding": "jsonschema",
            "schema": schema.to_string(),
        })
    };
    let response = json!({
        "paused": {"type": "boolean"},
        "time_s": {"type": "number", "description": "simulated time (s)"},
    });
    let service = |(id, name): (usize, &&str)| {
        json!({
            "id": id,
            "name": name,
            "type": "flexsc.Control",
            "request": schema("flexsc.Nothing", json!({})),
            "response": schema("flexsc.Control", response.clone()),
        })
    };
    let services: Vec<_> = SERVICES.iter().enumerate().map(service).collect();
    text(&json!({"op": "advertiseServices", "services": services}))
}

/// The name of a service.
pub fn service(number: u32) -> Option<&'static str> {
    SERVICES.get(number as usize).copied()
}

/// The answer of a service: what the clock does now.
pub fn service_response(service: u32, call: u32, clock: &Clock) -> Message {
    let state = json!({"paused": clock.paused(), "time_s": clock.at().seconds()});
    let encoding = "json";
    let mut bytes = vec![3];
    for number in [service, call, encoding.len() as u32] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(encoding.as_bytes());
    bytes.extend(state.to_string().as_bytes());
    Message::binary(bytes)
}

/// A service that failed.
pub fn service_failure(service: u32, call: u32, why: &str) -> Message {
    text(&json!({"op": "serviceCallFailure", "serviceId": service, "callId": call, "message": why}))
}

/// A message of a subscription.
pub fn data(subscription: u32, time_ns: u64, data: &[u8]) -> Message {
    let mut bytes = Vec::with_capacity(13 + data.len());
    bytes.push(1);
    bytes.extend(subscription.to_le_bytes());
    bytes.extend(time_ns.to_le_bytes());
    bytes.extend(data);
    Message::binary(bytes)
}

/// The time, which the messages after this one have.
pub fn time(time_ns: u64) -> Message {
    let mut bytes = vec![2];
    bytes.extend(time_ns.to_le_bytes());
    Message::binary(bytes)
}

/// The values of parameters.
pub fn parameter_values(names: &[&str], id: Option<Json>, clock: &Clock) -> Message {
    let value = |name: &&str| match parameter(name, clock) {
        // Without its type a whole number is an integer to a viewer.
        value if value.is_f64() => json!({"name": name, "type": "float64", "value": value}),
        value => json!({"name": name, "value": value}),
    };
    let mut values = json!({
        "op": "parameterValues",
        "parameters": names.iter().map(value).collect::<Vec<_>>(),
    });
    if let Some(id) = id {
        values["id"] = id;
    }
    text(&values)
}

fn parameter(name: &str, clock: &Clock) -> Json {
    match name {
        "/paused" => json!(clock.paused()),
        _ => clock.speed().finite().map_or_else(|| json!("max"), |factor| json!(factor)),
    }
}

/// A text that viewers show.
pub fn status(level: Level, message: &str) -> Message {
    text(&json!({"op": "status", "level": level as u8, "message": message}))
}

fn text(json: &Json) -> Message {
    Message::text(json.to_string())
}
