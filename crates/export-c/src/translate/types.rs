//! Types of values, and their declarations in C.

use syn::spanned::Spanned;
use syn::{Expr, ReturnType, Type};

use super::error::{Outcome, refuse};
use super::items::{ItemContent, Program};
use super::names::Names;

/// Integer type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum IntegerKind {
    I32,
    U32,
    I64,
    U64,
    Usize,
}

impl IntegerKind {
    /// Returns the type of a Rust name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "i32" => Self::I32,
            "u32" => Self::U32,
            "i64" => Self::I64,
            "u64" => Self::U64,
            "usize" => Self::Usize,
            _ => return None,
        })
    }

    /// Returns the name in Rust.
    pub(super) fn rust_name(self) -> &'static str {
        match self {
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::Usize => "usize",
        }
    }

    /// Returns the name in C.
    pub(super) fn c_name(self) -> &'static str {
        match self {
            Self::I32 => "int32_t",
            Self::U32 => "uint32_t",
            Self::I64 => "int64_t",
            Self::U64 => "uint64_t",
            Self::Usize => "size_t",
        }
    }

    /// True for types with a sign.
    pub(super) fn is_signed(self) -> bool {
        matches!(self, Self::I32 | Self::I64)
    }

    /// Returns the least and the greatest value; `usize` has 64 bits.
    pub(super) fn range(self) -> (i128, i128) {
        match self {
            Self::I32 => (i32::MIN.into(), i32::MAX.into()),
            Self::U32 => (0, u32::MAX.into()),
            Self::I64 => (i64::MIN.into(), i64::MAX.into()),
            Self::U64 | Self::Usize => (0, u64::MAX.into()),
        }
    }
}

/// Length of an array.
#[derive(Debug, Clone)]
pub(super) struct ArrayLength {
    pub count: u64,
    /// Index of the constant that names it.
    pub constant: Option<usize>,
}

impl PartialEq for ArrayLength {
    fn eq(&self, other: &Self) -> bool {
        self.count == other.count
    }
}

/// Type of a value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ValueKind {
    F64,
    Bool,
    Integer(IntegerKind),
    Struct(usize),
    Enum(usize),
    Array(Box<ValueKind>, ArrayLength),
    Reference { is_mutable: bool, target: Box<ValueKind> },
    Slice { is_mutable: bool, element: Box<ValueKind> },
    Unit,
}

impl ValueKind {
    /// Type `usize`.
    pub(super) const USIZE: Self = Self::Integer(IntegerKind::Usize);

    /// Returns the type behind a reference, or the type itself.
    pub(super) fn target(&self) -> &Self {
        match self {
            Self::Reference { target, .. } => target,
            other => other,
        }
    }

    /// True for types that C passes and assigns by value.
    pub(super) fn is_plain(&self) -> bool {
        matches!(self, Self::F64 | Self::Bool | Self::Integer(_) | Self::Struct(_) | Self::Enum(_))
    }

    /// True for a reference or slice through which a call may write.
    pub(super) fn is_mutable_reference(&self) -> bool {
        matches!(self, Self::Reference { is_mutable: true, .. } | Self::Slice { is_mutable: true, .. })
    }
}

/// Signature of a function.
pub(super) struct FunctionKind {
    /// Names and types of the parameters, `self` included.
    pub parameters: Vec<(String, ValueKind)>,
    /// True if the first parameter is `self`.
    pub has_receiver: bool,
    pub result: ValueKind,
}

const ACCEPTED_TYPES: &str =
    "f64, bool, i32, u32, i64, u64, usize, structs and enums of the crate, and arrays `[T; N]`";

impl Program<'_> {
    /// Returns the type that a file writes; `owner` is `Self`.
    pub(super) fn kind(&self, file: usize, owner: Option<usize>, written: &Type) -> Outcome<ValueKind> {
        match written {
            Type::Paren(inner) => self.kind(file, owner, &inner.elem),
            Type::Path(path) if path.qself.is_none() => {
                let name =
                    path.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
                if path.path.segments.iter().any(|segment| !segment.arguments.is_none()) {
                    return refuse(written.span(), format!("the type `{name}<..>`"), ACCEPTED_TYPES);
                }
                if path.path.segments.len() == 1 {
                    match name.as_str() {
                        own if own == self.real() => return Ok(ValueKind::F64),
                        "bool" => return Ok(ValueKind::Bool),
                        _ => {}
                    }
                    if let Some(integer) = IntegerKind::from_name(&name) {
                        return Ok(ValueKind::Integer(integer));
                    }
                }
                let index = self.find(file, owner, &path.path);
                match index.map(|index| (index, &self.items[index].content)) {
                    Some((index, ItemContent::Struct { .. })) => Ok(ValueKind::Struct(index)),
                    Some((index, ItemContent::Enum { .. })) => Ok(ValueKind::Enum(index)),
                    _ => refuse(written.span(), format!("the type `{name}`"), ACCEPTED_TYPES),
                }
            }
            Type::Array(array) => {
                let element = self.kind(file, owner, &array.elem)?;
                if !element.is_plain() && !matches!(element, ValueKind::Array(..)) {
                    return refuse(array.elem.span(), "an array of references", "arrays of values");
                }
                Ok(ValueKind::Array(Box::new(element), self.length(file, owner, &array.len)?))
            }
            Type::Tuple(tuple) if tuple.elems.is_empty() => Ok(ValueKind::Unit),
            Type::Tuple(_) => refuse(written.span(), "a tuple", ACCEPTED_TYPES),
            Type::Reference(_) | Type::Slice(_) => {
                refuse(written.span(), "a reference outside the parameters", ACCEPTED_TYPES)
            }
            _ => refuse(written.span(), "this type", ACCEPTED_TYPES),
        }
    }

    /// Returns the type of a parameter, which may be a reference.
    fn parameter_kind(&self, file: usize, owner: Option<usize>, written: &Type) -> Outcome<ValueKind> {
        let Type::Reference(reference) = written else {
            let kind = self.kind(file, owner, written)?;
            if !kind.is_plain() {
                return refuse(
                    written.span(),
                    "an array by value",
                    "a reference to it, or a struct that holds it",
                );
            }
            return Ok(kind);
        };
        if reference.lifetime.is_some() {
            return refuse(reference.span(), "a lifetime", "references without one");
        }
        let is_mutable = reference.mutability.is_some();
        if let Type::Slice(slice) = &*reference.elem {
            let element = self.kind(file, owner, &slice.elem)?;
            return Ok(ValueKind::Slice { is_mutable, element: Box::new(element) });
        }
        let target = self.kind(file, owner, &reference.elem)?;
        Ok(ValueKind::Reference { is_mutable, target: Box::new(target) })
    }

    /// Returns the length that an expression gives.
    pub(super) fn length(&self, file: usize, owner: Option<usize>, written: &Expr) -> Outcome<ArrayLength> {
        let value = self.evaluate(file, owner, written, Some(&ValueKind::USIZE))?;
        let count = value.integer().and_then(|count| u64::try_from(count).ok()).filter(|count| *count > 0);
        let Some(count) = count else {
            return refuse(written.span(), "a length of zero", "a length of one at least");
        };
        let constant = match written {
            Expr::Path(path) => self.find(file, owner, &path.path),
            _ => None,
        };
        Ok(ArrayLength { count, constant })
    }

    /// Returns the type of a field of a struct.
    pub(super) fn field_kind(&self, index: usize, name: &str) -> Outcome<Option<ValueKind>> {
        let item = &self.items[index];
        let ItemContent::Struct { fields } = &item.content else { return Ok(None) };
        match fields.iter().find(|field| field.name == name) {
            Some(field) => self
                .kind(item.file, Some(index), &field.kind)
                .map(Some)
                .map_err(|e| self.placed(e, item.file)),
            None => Ok(None),
        }
    }

    /// Returns the type of a constant.
    pub(super) fn constant_kind(&self, index: usize) -> Outcome<Option<ValueKind>> {
        let item = &self.items[index];
        let ItemContent::Constant { kind, .. } = &item.content else { return Ok(None) };
        self.kind(item.file, item.owner, kind).map(Some).map_err(|e| self.placed(e, item.file))
    }

    /// Returns the signature of a function.
    pub(super) fn function_kind(&self, index: usize) -> Outcome<Option<FunctionKind>> {
        let item = &self.items[index];
        let ItemContent::Function { signature, .. } = &item.content else { return Ok(None) };
        self.signature(item.file, item.owner, signature).map(Some).map_err(|e| self.placed(e, item.file))
    }

    fn signature(
        &self,
        file: usize,
        owner: Option<usize>,
        written: &syn::Signature,
    ) -> Outcome<FunctionKind> {
        let mut parameters = Vec::new();
        let mut has_receiver = false;
        for input in &written.inputs {
            match input {
                syn::FnArg::Receiver(receiver) => {
                    let Some(this) = owner.and_then(|owner| self.type_kind(owner)) else {
                        return refuse(receiver.span(), "`self` outside an `impl`", "functions of a type");
                    };
                    let kind = match &receiver.kind {
                        syn::ReceiverKind::Value => this,
                        syn::ReceiverKind::Reference(_, None, mutability) => {
                            ValueKind::Reference { is_mutable: mutability.is_some(), target: Box::new(this) }
                        }
                        _ => {
                            return refuse(
                                receiver.span(),
                                "this receiver",
                                "`self`, `&self` and `&mut self`",
                            );
                        }
                    };
                    has_receiver = true;
                    parameters.push(("self".to_owned(), kind));
                }
                syn::FnArg::Typed(typed) => {
                    let name = match &*typed.pat {
                        syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => {
                            name.ident.to_string()
                        }
                        syn::Pat::Wild(_) => "unused".to_owned(),
                        _ => return refuse(typed.pat.span(), "a pattern as a parameter", "`name: TYPE`"),
                    };
                    parameters.push((name, self.parameter_kind(file, owner, &typed.ty)?));
                }
            }
        }
        let result = match &written.output {
            ReturnType::Default => ValueKind::Unit,
            ReturnType::Type(_, written) => {
                let kind = self.kind(file, owner, written)?;
                if matches!(kind, ValueKind::Array(..)) {
                    return refuse(written.span(), "an array as a result", "a struct that holds it");
                }
                kind
            }
        };
        Ok(FunctionKind { parameters, has_receiver, result })
    }

    /// Returns the type that an item declares.
    pub(super) fn type_kind(&self, index: usize) -> Option<ValueKind> {
        match self.items[index].content {
            ItemContent::Struct { .. } => Some(ValueKind::Struct(index)),
            ItemContent::Enum { .. } => Some(ValueKind::Enum(index)),
            _ => None,
        }
    }

    /// Returns a type as Rust writes it.
    pub(super) fn show(&self, kind: &ValueKind) -> String {
        match kind {
            ValueKind::F64 => "f64".to_owned(),
            ValueKind::Bool => "bool".to_owned(),
            ValueKind::Integer(integer) => integer.rust_name().to_owned(),
            ValueKind::Struct(index) | ValueKind::Enum(index) => self.items[*index].name.clone(),
            ValueKind::Array(element, length) => format!("[{}; {}]", self.show(element), length.count),
            ValueKind::Reference { is_mutable: true, target } => format!("&mut {}", self.show(target)),
            ValueKind::Reference { is_mutable: false, target } => format!("&{}", self.show(target)),
            ValueKind::Slice { is_mutable: true, element } => format!("&mut [{}]", self.show(element)),
            ValueKind::Slice { is_mutable: false, element } => format!("&[{}]", self.show(element)),
            ValueKind::Unit => "()".to_owned(),
        }
    }
}

impl Names {
    /// Returns the C name of a type without arrays and references.
    pub(super) fn plain_type(&self, kind: &ValueKind) -> String {
        match kind {
            ValueKind::F64 => if self.is_single { "float" } else { "double" }.to_owned(),
            ValueKind::Bool => "bool".to_owned(),
            ValueKind::Integer(integer) => integer.c_name().to_owned(),
            ValueKind::Struct(index) | ValueKind::Enum(index) => self.item(*index).to_owned(),
            ValueKind::Array(inner, _)
            | ValueKind::Reference { target: inner, .. }
            | ValueKind::Slice { element: inner, .. } => self.plain_type(inner),
            ValueKind::Unit => "void".to_owned(),
        }
    }

    /// Returns the brackets of an array type.
    pub(super) fn brackets(&self, kind: &ValueKind) -> String {
        match kind {
            ValueKind::Array(element, length) => {
                format!("[{}]{}", self.length(length), self.brackets(element))
            }
            _ => String::new(),
        }
    }

    /// Returns the length of an array: a constant's name or a number.
    pub(super) fn length(&self, length: &ArrayLength) -> String {
        match length.constant {
            Some(index) => self.item(index).to_owned(),
            None => length.count.to_string(),
        }
    }

    /// Returns the declaration of a name, which is a parameter if its type is a reference.
    ///
    /// C converts no pointer to arrays to a pointer to constant arrays: those parameters are not `const`.
    pub(super) fn declaration(&self, kind: &ValueKind, name: &str) -> String {
        let plain = self.plain_type(kind);
        match kind {
            ValueKind::Reference { is_mutable, target } => {
                let is_nested = matches!(&**target, ValueKind::Array(element, _) if matches!(**element, ValueKind::Array(..)));
                let constant = if *is_mutable || is_nested { "" } else { "const " };
                match &**target {
                    ValueKind::Array(..) => format!("{constant}{plain} {name}{}", self.brackets(target)),
                    _ => format!("{constant}{plain} *{name}"),
                }
            }
            ValueKind::Slice { is_mutable, element } => match &**element {
                ValueKind::Array(..) => format!("{plain} (*{name}){}", self.brackets(element)),
                _ if *is_mutable => format!("{plain} *{name}"),
                _ => format!("const {plain} *{name}"),
            },
            _ => format!("{plain} {name}{}", self.brackets(kind)),
        }
    }
}
