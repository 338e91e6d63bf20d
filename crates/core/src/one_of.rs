//! A closed set of kinds: an enum that dereferences to the trait which all of them implement.

/// Declares `pub enum $name { Kind(Kind), ... }`, written in a scenario as `[name.kind]`.
///
/// A new kind is one file and one line here: it is then reachable from TOML, the command and Python.
macro_rules! one_of {
    ($(#[$doc:meta])* $name:ident: $contract:path { $($(#[$kind_doc:meta])* $kind:ident($of:ty)),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum $name {
            $($(#[$kind_doc])* $kind($of)),+
        }

        impl std::ops::Deref for $name {
            type Target = dyn $contract;
            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$kind(kind) => kind),+
                }
            }
        }

        impl std::ops::DerefMut for $name {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(Self::$kind(kind) => kind),+
                }
            }
        }
    };
}

pub(crate) use one_of;
