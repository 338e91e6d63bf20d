//! Constructs outside the subset: each is refused with its file, its line and a reason.

use flexsc_export_c::{SourceFile, TranslationError, translate};

/// Items around the text of a case, on lines of their own.
const START: &str = "\
enum Mode { A, B, C }
struct Law { gain: f64, state: [f64; 3] }
impl Law { fn step(&mut self, x: f64) -> f64 { self.gain += x; self.gain } fn gain(&self) -> f64 { self.gain } }
fn slice(values: &[f64]) -> f64 { values[0] }
";

/// Line on which the text of a case begins.
const LINE: usize = 5;

fn refusal(text: &str) -> Result<(), TranslationError> {
    let text = format!("{START}{text}\n");
    let file = SourceFile { path: "flight/law.rs", module: "law", text: &text };
    translate(&[file], &[], "sat").map(|_| ())
}

/// Text of a case, its line after the first, and words of the refusal.
const CASES: &[(&str, usize, &str)] = &[
    ("fn f(x: f64) -> f64 {\n let g = |y: f64| y;\n x }", 1, "a closure"),
    ("trait T { }", 0, "a trait"),
    ("impl Clone for Mode { }", 0, "an implementation of a trait"),
    ("fn f<T>(x: f64) -> f64 { x }", 0, "generics"),
    ("fn f<'a>(x: f64) -> f64 { x }", 0, "generics or lifetimes"),
    ("fn f() -> Option<f64> { g() }", 0, "the type `Option<..>`"),
    ("fn f(x: (f64, f64)) {}", 0, "a tuple"),
    ("fn f() {\n let (a, b) = (1.0, 2.0); }", 1, "a pattern in a `let`"),
    ("fn f(n: u32) -> f64 { match n {\n [a, ..] => 1.0, _ => 2.0 } }", 1, "a slice as a pattern"),
    ("fn f(x: [f64; 3]) -> f64 { x[0] }", 0, "an array by value"),
    ("fn f() -> [f64; 2] { [1.0, 2.0] }", 0, "an array as a result"),
    ("fn f(a: &mut Law, b: &Law) {\n a.state = b.state; }", 1, "an assignment of a whole array"),
    ("fn f(a: &Law) {\n let b = a.state; }", 1, "an array by value"),
    (
        "fn f(a: &mut Law) -> f64 {\n 1.0 + a.step(2.0) }",
        1,
        "which changes its arguments, within an expression",
    ),
    (
        "fn f(a: &mut Law) -> f64 {\n if a.step(2.0) > 1.0 { 1.0 } else { 2.0 } }",
        1,
        "which changes its arguments",
    ),
    ("fn f(a: &mut Law, i: usize) {\n a.state[i] = a.step(2.0); }", 1, "changes its arguments to an element"),
    ("fn f(a: f64, b: f64) -> f64 {\n a.min(b) }", 1, "the method `min` of f64; accepted: abs, copysign"),
    ("fn f(a: f64) -> f64 { a.sqrt() }", 0, "the method `sqrt` of f64"),
    ("fn f(a: f64, b: f64) -> f64 { a % b }", 0, "this operator with f64; accepted: `%` of integers"),
    ("fn f() -> f64 {\n let n = 3;\n 1.0 }", 1, "`n`, whose type is not clear"),
    (
        "fn f(m: Mode) -> f64 {\n match m { Mode::A => 1.0, Mode::B => 2.0 } }",
        1,
        "`match` without an arm of `C`",
    ),
    ("fn f(n: u32) -> f64 {\n match n { 0 => 1.0, 1 => 2.0 } }", 1, "`match` of an integer without `_`"),
    ("fn f(n: u32) -> f64 { match n {\n k if k > 3 => 1.0, _ => 2.0 } }", 1, "a guard of a pattern"),
    ("fn f(n: u32) -> f64 { match n {\n k => 1.0 } }", 1, "a binding in a pattern"),
    ("fn f(n: u32) -> f64 { match n { 0..=3 => 1.0, _ => 2.0 } }", 0, "a range as a pattern"),
    ("fn f(a: &Law) -> f64 { a.unknown() }", 0, "the method `unknown` of Law"),
    ("fn f(n: u32) -> u32 { if n > 0 { return f(n - 1); } n }", 0, "`f`, which needs itself"),
    ("fn f(x: f64) { g(x); }\nfn g(x: f64) { f(x); }", 0, "which needs itself"),
    ("static mut COUNT: u32 = 0;", 0, "a static variable"),
    ("fn f() {\n unsafe { g() } }", 1, "unsafe code"),
    ("unsafe fn f() {}", 0, "an unsafe function"),
    ("macro_rules! m { () => {} }", 0, "a macro"),
    ("fn f() {\n println!(\"x\"); }", 1, "a macro"),
    ("fn f() {\n let x = \"text\"; }", 1, "a literal of another type"),
    ("fn f() {\n 'a: loop { break 'a; } }", 1, "a loop with a label"),
    ("fn f() -> f64 {\n let x = loop { break 1.0; };\n x }", 1, "a loop"),
    ("fn f(x: f64) -> f64 { x as f32 as f64 }", 0, "the type `f32`"),
    ("fn f(x: u8) {}", 0, "the type `u8`"),
    ("fn f(x: i32) -> i32 { x << 2 }", 0, "this operator with i32; accepted: shifts of unsigned integers"),
    ("fn f(x: i32) -> i32 { !x }", 0, "`!` of this type"),
    ("fn f(x: f64) -> bool { 0.0 < x && x == 1 }", 0, "whose type is not clear"),
    ("fn f() { for x in [1.0, 2.0] {} }", 0, "a loop over something else than `a..b`"),
    ("fn f() { for i in 0..=3 {} }", 0, "a loop over something else than `a..b`"),
    ("fn f(x: f64) -> f64 { 1.0 + if x > 0.0 { x } else { -x } }", 0, "`if` within an expression"),
    ("fn f(x: f64) -> f64 { if let y = x { y } else { x } }", 0, "`let` in a condition"),
    ("fn f(a: &Law) -> f64 {\n let b = &a.gain;\n *b }", 1, "a local that is a reference"),
    ("fn f(a: &f64) -> f64 { a + 1.0 }", 0, "an operation with &f64; accepted: `*` before the reference"),
    ("fn f(a: &f64) -> f64 { a }", 0, "a value of the type &f64; accepted: the type f64, by `*`"),
    ("fn f() -> f64 { slice(&[true]) }", 0, "a value of the type bool; accepted: the type f64"),
    ("fn f(a: &[f64]) -> f64 { slice(&a[1..]) }", 0, "a range"),
    ("use core::f64::consts::PI;", 0, "an import from `core`"),
    ("use crate::other::*;", 0, "a glob"),
    ("struct Pair(f64, f64);", 0, "a struct without named fields"),
    ("enum E { A = 3 }", 0, "the variant `A` with data or a value"),
    ("#[repr(C)]\nstruct S { x: f64 }", 0, "the attribute `repr`"),
    ("#[cfg(unix)]\nfn f() {}", 0, "the condition `unix`"),
    ("const X: f64 = 1.0 / 0.0;\nfn f() -> f64 { 1.0 }", 0, "`X` with an infinity or NaN"),
    ("const X: u32 = 3 - 4;", 0, "the value -1"),
    ("const X: f64 = f();\nfn f() -> f64 { 1.0 }", 0, "a call in a constant"),
    ("fn f(a: Law) -> Law { Law { gain: 1.0, ..a } }", 0, "a struct with `..`"),
    ("fn f() { fn g() {} }", 0, "an item within a function"),
    ("fn f(x: f64) { x + 1.0; }", 0, "an expression whose value is lost"),
    ("fn f() -> f64 { g()? }", 0, "`?`"),
    ("fn f(x: f64) -> f64 { std::hint::black_box(x) }", 0, "the function `std::hint::black_box`"),
    ("fn f(x: f64) -> f64 { UNKNOWN + x }", 0, "the name `UNKNOWN`"),
    (
        "fn mode_a() {}\nimpl Mode { fn a() {} }\nimpl Law { fn b() {} }\nfn b() {}",
        2,
        "which both are `law_b` in C",
    ),
    (
        "enum Limit { Max }\nconst LIMIT: usize = 2;\nimpl Limit { const MAX: usize = 3; }",
        2,
        "which both are `SAT_LIMIT_MAX` in C",
    ),
    ("fn f(x: f64 { }", 0, ""),
];

#[test]
fn constructs_outside_the_subset_are_refused() {
    let mut wrong = Vec::new();
    for (text, line, words) in CASES {
        let start = format!("flight/law.rs:{}:", LINE + line);
        match refusal(text) {
            Ok(()) => wrong.push(format!("accepted: {text}")),
            Err(error) => {
                let message = error.to_string();
                if !message.contains(words) || !message.starts_with(&start) {
                    wrong.push(format!("{text}\n    {message}\n    expected {start} {words}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unknown_roots_are_refused() {
    let file = SourceFile { path: "law.rs", module: "law", text: "fn f() {}" };
    let message = translate(&[file], &["law::g"], "sat").map(|_| ()).expect_err("no root").to_string();
    assert!(message.contains("the root `law::g`"), "{message}");
}
