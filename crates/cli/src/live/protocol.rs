//! Messages of the Foxglove WebSocket protocol, version 1: those of the server, and the requests of clients.

use data_encoding::BASE64;
use flexsc_core::record::LogTopic;
use serde_json::{Value as Json, json};
use tungstenite::Message;

use super::clock::Clock;

/// Names of the subprotocol: the current one of the SDK, and the former one.
pub const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// Names of the services, whose numbers are their indices.
const SERVICES: [&str; 3] = ["/pause", "/resume", "/step"];
/// Names of the parameters.
pub const PARAMETERS: [&str; 2] = ["/paused", "/speed"];

/// Largest number of items in a request.
const MOST_NAMED: usize = 256;
/// Largest number of characters that are quoted from a message that is not understood.
const MAX_QUOTED: usize = 200;

/// Request of a client.
#[derive(Debug, PartialEq)]
pub enum Request {
    /// Subscription to channels: pairs of subscription number and channel number.
    Subscribe(Vec<(u32, u32)>),
    /// End of these subscriptions.
    Unsubscribe(Vec<u32>),
    /// Query of parameters, all if none is named.
    GetParameters(Vec<String>, Option<Json>),
    /// Change of parameters.
    SetParameters(Vec<(String, Json)>, Option<Json>),
    /// Subscription to changes of these parameters.
    Follow(Vec<String>),
    /// End of the subscription to changes of these parameters.
    Unfollow(Vec<String>),
    /// Call of a service: number of the service and number of the call.
    Call(u32, u32),
    /// Request that this server does not support.
    Other,
}

/// Severity of a status message.
#[derive(Copy, Clone)]
pub enum StatusLevel {
    Warning = 1,
    Error = 2,
}

impl Request {
    /// Parses a message of a client.
    pub fn read(message: &Message) -> Result<Self, String> {
        match message {
            Message::Text(text) => {
                let json: Json = serde_json::from_str(text).map_err(|error| format!("not JSON: {error}"))?;
                let lists = json.as_object().into_iter().flatten().filter_map(|(_, value)| value.as_array());
                if lists.into_iter().any(|list| list.len() > MOST_NAMED) {
                    return Err(format!("a request may name at most {MOST_NAMED} things"));
                }
                let start = || text.chars().take(MAX_QUOTED).collect::<String>();
                Self::from_json(&json).ok_or_else(|| format!("not understood: {}", start()))
            }
            Message::Binary(bytes) => match bytes.split_first() {
                Some((2, rest)) if rest.len() >= 8 => Ok(Self::Call(number(rest), number(&rest[4..]))),
                _ => Ok(Self::Other),
            },
            _ => Ok(Self::Other),
        }
    }

    fn from_json(json: &Json) -> Option<Self> {
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

/// Returns the first four bytes as a little-endian number.
fn number(bytes: &[u8]) -> u32 {
    bytes.iter().take(4).rev().fold(0, |number, byte| number << 8 | u32::from(*byte))
}

/// Returns the message about the server and its capabilities.
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

/// Returns the channel number of a topic.
pub fn channel_of(topic: usize) -> u32 {
    topic as u32 + 1
}

/// Returns the topic of a channel.
pub fn topic_of(channel: u32) -> Option<usize> {
    (channel as usize).checked_sub(1)
}

/// Returns the message that advertises channels to clients.
pub fn advertise<'a>(topics: impl Iterator<Item = (usize, LogTopic<'a>)>) -> Message {
    let channel = |(index, topic): (usize, LogTopic<'_>)| {
        json!({
            "id": channel_of(index),
            "topic": topic.name(),
            "encoding": "protobuf",
            "schemaName": topic.message(),
            "schemaEncoding": "protobuf",
            "schema": BASE64.encode(&topic.schema()),
        })
    };
    text(&json!({"op": "advertise", "channels": topics.map(channel).collect::<Vec<_>>()}))
}

/// Returns the message that advertises the services.
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

/// Returns the name of a service.
pub fn service(number: u32) -> Option<&'static str> {
    SERVICES.get(number as usize).copied()
}

/// Returns the response of a service: the state of the clock.
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

/// Returns the message about a failed service call.
pub fn service_failure(service: u32, call: u32, why: &str) -> Message {
    text(&json!({"op": "serviceCallFailure", "serviceId": service, "callId": call, "message": why}))
}

/// Returns the message with data of a subscription.
pub fn data(subscription: u32, time_ns: u64, data: &[u8]) -> Message {
    let mut bytes = Vec::with_capacity(13 + data.len());
    bytes.push(1);
    bytes.extend(subscription.to_le_bytes());
    bytes.extend(time_ns.to_le_bytes());
    bytes.extend(data);
    Message::binary(bytes)
}

/// Returns the message with the time of the following messages.
pub fn time(time_ns: u64) -> Message {
    let mut bytes = vec![2];
    bytes.extend(time_ns.to_le_bytes());
    Message::binary(bytes)
}

/// Returns the message with the values of parameters.
pub fn parameter_values(names: &[&str], id: Option<Json>, clock: &Clock) -> Message {
    let value = |name: &&str| match parameter(name, clock) {
        // Viewers would read an integral value without a type as an integer.
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

/// Returns a status message that viewers show.
pub fn status(level: StatusLevel, message: &str) -> Message {
    text(&json!({"op": "status", "level": level as u8, "message": message}))
}

fn text(json: &Json) -> Message {
    Message::text(json.to_string())
}
