//! Classes whose attributes are read from a value of the engine.

/// Declares the attributes of a class for Python: name, type, and what is read; its other methods follow.
macro_rules! attributes {
    ($class:ident {
        $($(#[$doc:meta])* $name:ident: $type:ty = |$this:ident| $value:expr;)*
    } $($methods:tt)*) => {
        #[pymethods]
        impl $class {
            $(
                $(#[$doc])*
                #[getter]
                fn $name(&self) -> $type {
                    let $this = self;
                    $value
                }
            )*
            $($methods)*
        }
    };
}
