//! Helper functions in C for operations of Rust that C has not, or leaves undefined.

/// Helper function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum CHelper {
    ToBits,
    FromBits,
    Abs,
    Copysign,
    IsNan,
    IsFinite,
    ToI32,
    ToU32,
    ToI64,
    ToU64,
    ToUsize,
    I32WrappingAdd,
    I32WrappingSub,
    I32WrappingMul,
    I64WrappingAdd,
    I64WrappingSub,
    I64WrappingMul,
    I32DivEuclid,
    I32RemEuclid,
    I64DivEuclid,
    I64RemEuclid,
    U32LeadingZeros,
    U64LeadingZeros,
    UsizeLeadingZeros,
}

impl CHelper {
    /// Returns the name in C.
    pub(super) fn name(self, is_single: bool) -> String {
        in_precision(self.definition().0, is_single)
    }

    /// Returns the helpers that it calls.
    pub(super) fn needs(self) -> &'static [Self] {
        match self {
            Self::Abs | Self::Copysign => &[Self::ToBits, Self::FromBits],
            Self::IsFinite => &[Self::ToBits],
            _ => &[],
        }
    }

    /// Returns the text of the definition.
    pub(super) fn text(self, is_single: bool) -> String {
        in_precision(self.definition().1, is_single)
    }

    fn definition(self) -> (&'static str, &'static str) {
        match self {
            Self::ToBits => ("f64_to_bits", TO_BITS),
            Self::FromBits => ("f64_from_bits", FROM_BITS),
            Self::Abs => ("f64_abs", ABS),
            Self::Copysign => ("f64_copysign", COPYSIGN),
            Self::IsNan => ("f64_is_nan", IS_NAN),
            Self::IsFinite => ("f64_is_finite", IS_FINITE),
            Self::ToI32 => ("f64_to_i32", TO_I32),
            Self::ToU32 => ("f64_to_u32", TO_U32),
            Self::ToI64 => ("f64_to_i64", TO_I64),
            Self::ToU64 => ("f64_to_u64", TO_U64),
            Self::ToUsize => ("f64_to_usize", TO_USIZE),
            Self::I32WrappingAdd => ("i32_wrapping_add", I32_ADD),
            Self::I32WrappingSub => ("i32_wrapping_sub", I32_SUB),
            Self::I32WrappingMul => ("i32_wrapping_mul", I32_MUL),
            Self::I64WrappingAdd => ("i64_wrapping_add", I64_ADD),
            Self::I64WrappingSub => ("i64_wrapping_sub", I64_SUB),
            Self::I64WrappingMul => ("i64_wrapping_mul", I64_MUL),
            Self::I32DivEuclid => ("i32_div_euclid", I32_DIV),
            Self::I32RemEuclid => ("i32_rem_euclid", I32_REM),
            Self::I64DivEuclid => ("i64_div_euclid", I64_DIV),
            Self::I64RemEuclid => ("i64_rem_euclid", I64_REM),
            Self::U32LeadingZeros => ("u32_leading_zeros", U32_ZEROS),
            Self::U64LeadingZeros => ("u64_leading_zeros", U64_ZEROS),
            Self::UsizeLeadingZeros => ("usize_leading_zeros", USIZE_ZEROS),
        }
    }
}

/// Returns the text of a helper in a precision.
fn in_precision(text: &str, is_single: bool) -> String {
    // Only functions of doubles have their bits and literals.
    if !is_single || !text.contains("f64_") {
        return text.to_owned();
    }
    OF_FLOATS.iter().fold(text.to_owned(), |text, (double, single)| text.replace(double, single))
}

/// Types, masks and literals of doubles, with those of floats.
const OF_FLOATS: [(&str, &str); 14] = [
    ("f64_", "f32_"),
    ("double", "float"),
    ("uint64_t bits", "uint32_t bits"),
    ("uint64_t mask", "uint32_t mask"),
    ("static uint64_t f32_to_bits", "static uint32_t f32_to_bits"),
    ("UINT64_C(0x7fffffffffffffff)", "UINT32_C(0x7fffffff)"),
    ("UINT64_C(0x8000000000000000)", "UINT32_C(0x80000000)"),
    ("UINT64_C(0x7ff0000000000000)", "UINT32_C(0x7f800000)"),
    ("2147483648.0", "2147483648.0f"),
    ("2147483649.0", "2147483648.0f"),
    ("4294967296.0", "4294967296.0f"),
    (" 0.0", " 0.0f"),
    ("0x1p+63", "0x1p+63f"),
    ("0x1p+64", "0x1p+64f"),
];

const TO_BITS: &str = "\
/* Returns the bits of a number. */
static uint64_t f64_to_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
";
const FROM_BITS: &str = "\
/* Returns the number with these bits. */
static double f64_from_bits(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
";
const ABS: &str = "\
/* Returns x without its sign bit. */
static double f64_abs(double x) {
    return f64_from_bits(f64_to_bits(x) & UINT64_C(0x7fffffffffffffff));
}
";
const COPYSIGN: &str = "\
/* Returns x with the sign bit of sign. */
static double f64_copysign(double x, double sign) {
    uint64_t mask = UINT64_C(0x8000000000000000);
    return f64_from_bits((f64_to_bits(x) & ~mask) | (f64_to_bits(sign) & mask));
}
";
const IS_NAN: &str = "\
/* True if x is no number. */
static bool f64_is_nan(double x) {
    return x != x;
}
";
const IS_FINITE: &str = "\
/* True if x is neither infinite nor NaN. */
static bool f64_is_finite(double x) {
    return (f64_to_bits(x) & UINT64_C(0x7ff0000000000000)) != UINT64_C(0x7ff0000000000000);
}
";
const TO_I32: &str = "\
/* Returns the integer part of x, limited to the type; 0 for NaN. */
static int32_t f64_to_i32(double x) {
    if (x >= 2147483648.0) {
        return INT32_MAX;
    }
    if (x > -2147483649.0) {
        return (int32_t)x;
    }
    return x < 0.0 ? INT32_MIN : 0;
}
";
const TO_U32: &str = "\
/* Returns the integer part of x, limited to the type; 0 for NaN. */
static uint32_t f64_to_u32(double x) {
    if (x >= 4294967296.0) {
        return UINT32_MAX;
    }
    return x > 0.0 ? (uint32_t)x : 0U;
}
";
const TO_I64: &str = "\
/* Returns the integer part of x, limited to the type; 0 for NaN. */
static int64_t f64_to_i64(double x) {
    if (x >= 0x1p+63) {
        return INT64_MAX;
    }
    if (x > -0x1p+63) {
        return (int64_t)x;
    }
    return x < 0.0 ? INT64_MIN : 0;
}
";
const TO_U64: &str = "\
/* Returns the integer part of x, limited to the type; 0 for NaN. */
static uint64_t f64_to_u64(double x) {
    if (x >= 0x1p+64) {
        return UINT64_MAX;
    }
    return x > 0.0 ? (uint64_t)x : UINT64_C(0);
}
";
const TO_USIZE: &str = "\
/* Returns the integer part of x, limited to the type; 0 for NaN. */
static size_t f64_to_usize(double x) {
    if (x >= (double)SIZE_MAX) {
        return SIZE_MAX;
    }
    return x > 0.0 ? (size_t)x : 0U;
}
";
const I32_ADD: &str = "\
/* Returns a + b modulo 2^32. */
static int32_t i32_wrapping_add(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a + (uint32_t)b);
}
";
const I32_SUB: &str = "\
/* Returns a - b modulo 2^32. */
static int32_t i32_wrapping_sub(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a - (uint32_t)b);
}
";
const I32_MUL: &str = "\
/* Returns a * b modulo 2^32. */
static int32_t i32_wrapping_mul(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a * (uint32_t)b);
}
";
const I64_ADD: &str = "\
/* Returns a + b modulo 2^64. */
static int64_t i64_wrapping_add(int64_t a, int64_t b) {
    return (int64_t)((uint64_t)a + (uint64_t)b);
}
";
const I64_SUB: &str = "\
/* Returns a - b modulo 2^64. */
static int64_t i64_wrapping_sub(int64_t a, int64_t b) {
    return (int64_t)((uint64_t)a - (uint64_t)b);
}
";
const I64_MUL: &str = "\
/* Returns a * b modulo 2^64. */
static int64_t i64_wrapping_mul(int64_t a, int64_t b) {
    return (int64_t)((uint64_t)a * (uint64_t)b);
}
";
const I32_DIV: &str = "\
/* Returns the quotient whose remainder is not negative. */
static int32_t i32_div_euclid(int32_t a, int32_t b) {
    int32_t quotient = a / b;
    if (a % b < 0) {
        return b > 0 ? quotient - 1 : quotient + 1;
    }
    return quotient;
}
";
const I32_REM: &str = "\
/* Returns the remainder from 0 to |b| - 1. */
static int32_t i32_rem_euclid(int32_t a, int32_t b) {
    int32_t rest = a % b;
    if (rest < 0) {
        return b < 0 ? rest - b : rest + b;
    }
    return rest;
}
";
const I64_DIV: &str = "\
/* Returns the quotient whose remainder is not negative. */
static int64_t i64_div_euclid(int64_t a, int64_t b) {
    int64_t quotient = a / b;
    if (a % b < 0) {
        return b > 0 ? quotient - 1 : quotient + 1;
    }
    return quotient;
}
";
const I64_REM: &str = "\
/* Returns the remainder from 0 to |b| - 1. */
static int64_t i64_rem_euclid(int64_t a, int64_t b) {
    int64_t rest = a % b;
    if (rest < 0) {
        return b < 0 ? rest - b : rest + b;
    }
    return rest;
}
";
const U32_ZEROS: &str = "\
/* Returns the number of zero bits above the highest one. */
static uint32_t u32_leading_zeros(uint32_t x) {
    uint32_t zeros = 32U;
    while (x != 0U) {
        x >>= 1;
        zeros -= 1U;
    }
    return zeros;
}
";
const U64_ZEROS: &str = "\
/* Returns the number of zero bits above the highest one. */
static uint32_t u64_leading_zeros(uint64_t x) {
    uint32_t zeros = 64U;
    while (x != UINT64_C(0)) {
        x >>= 1;
        zeros -= 1U;
    }
    return zeros;
}
";
const USIZE_ZEROS: &str = "\
/* Returns the number of zero bits above the highest one. */
static uint32_t usize_leading_zeros(size_t x) {
    uint32_t zeros = (uint32_t)(8U * sizeof x);
    while (x != 0U) {
        x >>= 1;
        zeros -= 1U;
    }
    return zeros;
}
";
