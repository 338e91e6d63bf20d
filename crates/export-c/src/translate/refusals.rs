//! Names of constructs that are refused.

use syn::Expr;

/// Returns the name of an expression's kind.
pub(super) fn describe(written: &Expr) -> &'static str {
    match written {
        Expr::Array(_) | Expr::Repeat(_) => "an array",
        Expr::Assign(_) => "an assignment",
        Expr::Async(_) | Expr::Await(_) => "asynchronous code",
        Expr::Block(_) => "a block",
        Expr::Break(_) => "`break`",
        Expr::Call(_) => "a call",
        Expr::Closure(_) => "a closure",
        Expr::Continue(_) => "`continue`",
        Expr::ForLoop(_) | Expr::While(_) | Expr::Loop(_) => "a loop",
        Expr::If(_) => "`if`",
        Expr::Let(_) => "`let` in a condition",
        Expr::Lit(_) => "this literal",
        Expr::Macro(_) => "a macro",
        Expr::Match(_) => "`match`",
        Expr::MethodCall(_) => "a call of a method",
        Expr::Range(_) => "a range",
        Expr::RawAddr(_) => "a raw pointer",
        Expr::Reference(_) => "a reference",
        Expr::Return(_) => "`return`",
        Expr::Struct(_) => "a struct",
        Expr::Try(_) | Expr::TryBlock(_) => "`?`",
        Expr::Tuple(_) => "a tuple",
        Expr::Unsafe(_) => "unsafe code",
        _ => "this expression",
    }
}
