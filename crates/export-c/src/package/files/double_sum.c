/* Sum and difference of doubles on processors without double-precision hardware, correctly rounded.
 *
 * The routines of libgcc 12 for ARM are not always: 0x1.3c0038310c00ap-38 - 0x1p-5 is one bit off. The linker puts these in their
 * place: -Wl,--wrap=__aeabi_dadd,--wrap=__aeabi_dsub,--wrap=__aeabi_drsub.
 */

#include <stdint.h>
#include <string.h>

#define FRACTION UINT64_C(0x000fffffffffffff)
#define HIDDEN UINT64_C(0x0010000000000000)
#define SIGN UINT64_C(0x8000000000000000)
#define INFINITE UINT64_C(0x7ff0000000000000)

double __wrap___aeabi_dadd(double a, double b) __attribute__((pcs("aapcs")));
double __wrap___aeabi_dsub(double a, double b) __attribute__((pcs("aapcs")));
double __wrap___aeabi_drsub(double a, double b) __attribute__((pcs("aapcs")));

static uint64_t bits(double value)
{
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

static double real(uint64_t word)
{
    double value;
    memcpy(&value, &word, sizeof value);
    return value;
}

/* Shifts right; a one that is lost stays in the last bit. */
static uint64_t shifted(uint64_t word, unsigned by)
{
    if (by == 0) {
        return word;
    }
    if (by > 63) {
        return word != 0;
    }
    return word >> by | ((word << (64 - by)) != 0);
}

static uint64_t sum(uint64_t a, uint64_t b)
{
    if ((a & ~SIGN) < (b & ~SIGN)) {
        const uint64_t larger = b;
        b = a;
        a = larger;
    }
    if ((a & ~SIGN) >= INFINITE) {
        const int is_opposite = (b & ~SIGN) == INFINITE && ((a ^ b) & SIGN) != 0;
        return (a & ~SIGN) > INFINITE || is_opposite ? UINT64_C(0x7ff8000000000000) : a;
    }
    unsigned exponent_a = (unsigned)(a >> 52 & 2047);
    unsigned exponent_b = (unsigned)(b >> 52 & 2047);
    /* Three bits below the last one: two of the result's rounding, and one for all that is less. */
    uint64_t larger = ((a & FRACTION) | (exponent_a > 0 ? HIDDEN : 0)) << 3;
    uint64_t smaller = ((b & FRACTION) | (exponent_b > 0 ? HIDDEN : 0)) << 3;
    exponent_a = exponent_a > 0 ? exponent_a : 1;
    exponent_b = exponent_b > 0 ? exponent_b : 1;
    smaller = shifted(smaller, exponent_a - exponent_b);
    uint64_t sign = a & SIGN;
    uint64_t total;
    if (((a ^ b) & SIGN) == 0) {
        total = larger + smaller;
        if (total >= HIDDEN << 4) {
            total = shifted(total, 1);
            ++exponent_a;
        }
    } else {
        total = larger - smaller;
        if (total == 0) {
            return 0;
        }
        while (total < HIDDEN << 3 && exponent_a > 1) {
            total <<= 1;
            --exponent_a;
        }
    }
    const uint64_t rest = total & 7;
    total >>= 3;
    if (rest > 4 || (rest == 4 && (total & 1) != 0)) {
        ++total;
    }
    /* A carry out of the fraction raises the exponent by itself; without the hidden bit the number is subnormal. */
    if (total >= HIDDEN) {
        total += (uint64_t)(exponent_a - 1) << 52;
    }
    return total >= INFINITE ? sign | INFINITE : sign | total;
}

double __wrap___aeabi_dadd(double a, double b)
{
    /* The sum of two zeros has their common sign. */
    if (((bits(a) | bits(b)) & ~SIGN) == 0) {
        return real(bits(a) & bits(b));
    }
    return real(sum(bits(a), bits(b)));
}

double __wrap___aeabi_dsub(double a, double b)
{
    return __wrap___aeabi_dadd(a, real(bits(b) ^ SIGN));
}

double __wrap___aeabi_drsub(double a, double b)
{
    return __wrap___aeabi_dadd(b, real(bits(a) ^ SIGN));
}
