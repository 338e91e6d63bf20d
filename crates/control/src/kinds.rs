//! Kinds of the parts of a role: one list, from which the role's enum follows, and the settings behind each kind.

/// Declares the kinds of a role, whose settings implement the trait of the role: for each kind its doc line, its key in a
/// scenario, its variant and its settings, which of a kind without keys are a value. `also` passes the list on to another
/// macro.
macro_rules! kinds {
    (
        $(#[$attr:meta])*
        pub enum $role:ident: dyn $spec:ident { $($list:tt)* }
        own $own:literal
        also $also:ident
    ) => {
        kinds! { $(#[$attr])* pub enum $role: dyn $spec { $($list)* } own $own }
        $also! { $($list)* }
    };
    (
        $(#[$attr:meta])*
        pub enum $role:ident: dyn $spec:ident {
            $($(#[$doc:meta])* $key:literal $kind:ident $(($settings:ident $(<$inner:ty>)?))? $(= $value:expr)?,)*
        }
        own $own:literal
    ) => {
        $(#[$attr])*
        pub enum $role {
            $($(#[$doc])* #[serde(rename = $key)] $kind $(($settings $(<$inner>)?))?,)*
            #[doc = $own]
            #[serde(rename = "own")]
            Own($crate::custom::Custom<dyn $spec>),
        }

        impl std::ops::Deref for $role {
            type Target = dyn $spec;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$kind $((kinds!(@settings own $settings)))? => {
                        $(kinds!(@settings own as $settings $(<$inner>)?))? $(&$value)?
                    })*
                    Self::Own(own) => &**own,
                }
            }
        }

        impl $role {
            /// Returns the name of the kind, as in a scenario.
            pub fn kind(&self) -> &'static str {
                match self {
                    $(Self::$kind { .. } => $key,)*
                    Self::Own(_) => "own",
                }
            }

            /// Returns the settings that another crate provides, if the kind is such a one.
            pub fn custom(&self) -> Option<&$crate::custom::Custom<dyn $spec>> {
                if let Self::Own(own) = self { Some(own) } else { None }
            }
        }

        impl From<$crate::custom::Custom<dyn $spec>> for $role {
            fn from(own: $crate::custom::Custom<dyn $spec>) -> Self {
                Self::Own(own)
            }
        }
    };
    (@settings $own:ident as $settings:ident <$inner:ty>) => {{
        let own: &$inner = $own;
        own
    }};
    (@settings $own:ident as $settings:ident) => { $own };
    (@settings $own:ident $settings:ident) => { $own };
}

pub(crate) use kinds;
