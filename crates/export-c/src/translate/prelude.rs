//! Fixed start of the C: headers, and guards that stop the build under compilers that change bits.

/// Headers that the declarations need; a compiler without an operating system has them too, or a `memcpy` of its own.
pub(super) const INCLUDES: &str = "\
#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
";

/// Guards; `PREFIX` stands for the prefix of names.
const GUARDS: &str = r#"/* The results have the same bits everywhere if doubles follow IEEE 754, each operation is rounded once and to a
 * double, and none is moved, joined or left out. */
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "PREFIX: -ffast-math, -Ofast and -ffinite-math-only change results: build without them"
#endif
#if defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error "PREFIX: -fassociative-math, -freciprocal-math and -fno-signed-zeros change results: build without them"
#endif
#if !defined(FLT_EVAL_METHOD) || (FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1)
#error "PREFIX: doubles are not evaluated in their own precision (x87): build with -msse2 -mfpmath=sse"
#endif
#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024 || DBL_MIN_EXP != -1021
#error "PREFIX: double is not the 64-bit number of IEEE 754"
#endif
/* No multiplication is joined with an addition, and no operation is moved. The flag -ffp-contract=off says so too; of the other
 * flags clang defines no macro. GCC joins some by its vectoriser whatever the flag says. */
#if defined(__clang__)
#if defined(__x86_64__)
#pragma float_control(precise, on)
#endif
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-tree-slp-vectorize")
#endif
typedef char PREFIX_double_has_8_bytes[sizeof(double) == 8 ? 1 : -1];
/* Not so with -fsingle-precision-constant. */
typedef char PREFIX_constant_has_8_bytes[sizeof(1.0) == 8 ? 1 : -1];
typedef char PREFIX_int_has_4_bytes[sizeof(int) >= 4 ? 1 : -1];
"#;

/// Parts of the guards about doubles, with those about floats.
const OF_FLOATS: [(&str, &str); 8] = [
    ("doubles are not evaluated", "floats are not evaluated"),
    ("if doubles follow", "if floats follow"),
    (" * double, and none", " * float, and none"),
    ("DBL_MANT_DIG != 53", "FLT_MANT_DIG != 24"),
    ("DBL_MAX_EXP != 1024 || DBL_MIN_EXP != -1021", "FLT_MAX_EXP != 128 || FLT_MIN_EXP != -125"),
    ("double is not the 64-bit number", "float is not the 32-bit number"),
    ("(FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1)", "FLT_EVAL_METHOD != 0"),
    ("double_has_8_bytes[sizeof(double) == 8", "float_has_4_bytes[sizeof(float) == 4"),
];

/// Returns the guards; `PREFIX` stands for the prefix of names. In single precision constants may be floats.
pub(super) fn guards(is_single: bool) -> String {
    if !is_single {
        return GUARDS.to_owned();
    }
    let kept: Vec<&str> = GUARDS.lines().filter(|line| !line.contains("constant")).collect();
    OF_FLOATS.iter().fold(kept.join("\n") + "\n", |text, (double, single)| text.replace(double, single))
}
