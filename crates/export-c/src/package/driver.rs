//! Driver of an exported control system: it replays the vectors of a run and repeats the self-test.

use std::fmt::Write as _;

use super::Plan;
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::self_test::{BLOCK, EXTREME_BLOCK, SEED, cycle_milliseconds, extremes};

/// Returns the driver, which is compiled under the guards of the source too: it computes inputs.
pub fn driver(plan: &Plan<'_>, guards: &str) -> String {
    let prefix = plan.prefix;
    let mut text = format!(
        "/* Driver of {prefix}.c.\n *\n *   driver vectors.bin    replays the calls of a run and compares their outputs by bits\n *   driver --hash N       \
         prints the hash over the outputs of N cycles with random and extreme inputs\n *\n * On a board without arguments, DRIVER_CYCLES \
         is the number of cycles.\n */\n\n#include \"{prefix}.h\"\n\n{COUNTING}#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n\n"
    );
    text.push_str(guards.trim());
    text.push_str("\n\n");
    text.push_str(WORDS);
    let most = |words: fn(&CallLayout) -> usize| plan.calls.iter().map(words).max().unwrap_or(0).max(1);
    let _ = writeln!(
        text,
        "enum {{ CALLS = {}, MOST_INPUTS = {}, MOST_OUTPUTS = {} }};\n\n/* True of a function that is called once in a block of cycles, before the others. */\nstatic const bool is_start[CALLS] = {{ {} }};\n",
        plan.calls.len(),
        most(CallLayout::input_words),
        most(CallLayout::output_words),
        plan.calls.iter().map(|call| call.is_start.to_string()).collect::<Vec<_>>().join(", ")
    );
    table(plan, "input", |call| &call.inputs, &mut text);
    table(plan, "output", |call| &call.outputs, &mut text);
    call(plan, &mut text);
    let extremes: Vec<String> =
        extremes(plan.precision).iter().map(|word| format!("UINT64_C(0x{word:016x})")).collect();
    let _ = writeln!(
        text,
        "enum {{ BLOCK = {BLOCK}, EXTREME_BLOCK = {EXTREME_BLOCK}, MILLISECONDS = {} }};\n\nstatic const uint64_t extremes[{}] = {{\n    {}\n}};\n\n\
         static uint64_t generator;\n",
        cycle_milliseconds(plan.system),
        extremes.len(),
        extremes.join(",\n    ")
    );
    init(plan, &mut text);
    text.push_str(&SELF_TEST.replace("PREFIX", prefix).replace("SEED", &format!("UINT64_C(0x{SEED:016x})")));
    text.push_str(&REPLAY.replace("PREFIX", prefix));
    let names: Vec<String> = plan.calls.iter().map(|call| format!("\"{}\"", call.name)).collect();
    text.push_str(&MAIN.replace("NAMES", &names.join(", ")));
    text
}

/// Writes the table of the words of inputs or outputs of each function: their kind, and for inputs the limit or the scale.
fn table(plan: &Plan<'_>, name: &str, of_call: fn(&CallLayout) -> &Vec<Channel>, text: &mut String) {
    for call in plan.calls {
        let words = of_call(call).iter().flat_map(|channel| std::iter::repeat_n(channel, channel.count));
        let mut rows: Vec<String> = words
            .map(|channel| {
                let (kind, below) = match channel.kind {
                    NumberKind::Real => ('R', unit_count(channel)),
                    NumberKind::Flag => ('F', 2),
                    NumberKind::Integer(below) => ('I', below),
                };
                let scale = crate::translate::float_literal(channel.scale);
                format!("    {{ \"{}\", '{kind}', {below}, {scale} }}", channel.name)
            })
            .collect();
        // An array in C has an element.
        if rows.is_empty() {
            rows.push("    { \"unused\", 'F', 2, 0.0 }".to_owned());
        }
        let _ = writeln!(
            text,
            "static const word_kind {}_{name}s[{}] = {{\n{}\n}};\n",
            call.name,
            rows.len(),
            rows.join(",\n")
        );
    }
    let list =
        |each: &dyn Fn(&CallLayout) -> String| plan.calls.iter().map(each).collect::<Vec<_>>().join(", ");
    let _ = writeln!(
        text,
        "static const word_kind *const {name}s[CALLS] = {{ {} }};\nstatic const size_t {name}_counts[CALLS] = {{ {} }};\n",
        list(&|call| format!("{}_{name}s", call.name)),
        list(&|call| of_call(call).iter().map(|channel| channel.count).sum::<usize>().to_string()),
    );
}

/// Writes the macro that sets the state at a time.
fn init(plan: &Plan<'_>, text: &mut String) {
    let prefix = plan.prefix;
    let _ = if plan.inits_at_time() {
        let ticks = format!("({prefix}_ticks){{ .whole = (int64_t)(time)[0], .part = (int64_t)(time)[1] }}");
        writeln!(text, "#define INIT(state, time) {prefix}_init(state, {ticks})\n")
    } else {
        writeln!(text, "#define INIT(state, time) ((void)(time), {prefix}_init(state))\n")
    };
}

/// Writes the function that calls a function of the control system with words.
fn call(plan: &Plan<'_>, text: &mut String) {
    let prefix = plan.prefix;
    let now = if plan.has_time() { "now, " } else { "" };
    let _ = writeln!(
        text,
        "/* Calls the function with this index with the words of its inputs, and writes the words of its outputs. */\n\
         static void call(size_t index, {prefix}_state *state, const uint64_t *time, const uint64_t *in, uint64_t *out)\n{{"
    );
    if plan.has_time() {
        let _ = writeln!(
            text,
            "    const {prefix}_ticks now = {{ .whole = (int64_t)time[0], .part = (int64_t)time[1] }};\n"
        );
    } else {
        text.push_str("    (void)time;\n");
    }
    for (index, layout) in plan.calls.iter().enumerate() {
        let name = layout.name;
        let _ = writeln!(
            text,
            "    if (index == {index}) {{\n        {prefix}_{name}_input input;\n        {prefix}_{name}_output output;"
        );
        if layout.inputs.is_empty() {
            text.push_str("        input.unused = false;\n");
        }
        let mut word = 0;
        for channel in &layout.inputs {
            for element in 0..channel.count {
                let member = member(channel, element);
                let value = match channel.kind {
                    NumberKind::Real if plan.precision.is_double() => format!("real(in[{word}])"),
                    NumberKind::Real => format!("(float)real(in[{word}])"),
                    NumberKind::Flag => format!("in[{word}] != 0"),
                    NumberKind::Integer(_) => format!("(int64_t)in[{word}]"),
                };
                let _ = writeln!(text, "        input.{member} = {value};");
                word += 1;
            }
        }
        let _ = writeln!(
            text,
            "        count_begin();\n        {prefix}_{name}(state, {now}&input, &output);\n        count_end({index});"
        );
        let mut word = 0;
        for channel in &layout.outputs {
            for element in 0..channel.count {
                let member = member(channel, element);
                let value = match channel.kind {
                    NumberKind::Real => format!("bits(output.{member})"),
                    NumberKind::Flag => format!("output.{member} ? 1 : 0"),
                    NumberKind::Integer(_) => format!("(uint64_t)output.{member}"),
                };
                let _ = writeln!(text, "        out[{word}] = {value};");
                word += 1;
            }
        }
        text.push_str("    }\n");
    }
    text.push_str("}\n\n");
}

/// Returns the number of components of a unit vector; 0 of other numbers.
fn unit_count(channel: &Channel) -> u64 {
    if channel.is_unit { channel.count as u64 } else { 0 }
}

fn member(channel: &Channel, element: usize) -> String {
    if channel.count == 1 { channel.name.clone() } else { format!("{}[{element}]", channel.name) }
}

const COUNTING: &str = "#ifdef DRIVER_COUNT
#include \"boards/instructions.h\"
#else
#define count_begin() ((void)0)
#define count_end(function) ((void)0)
#define count_inputs(from) ((void)0)
#endif

";

const WORDS: &str = "/* Kind of a word: R double, or one of the given number of components of a unit vector; F truth value, I integer below a limit. */
typedef struct {
    const char *name;
    char kind;
    uint64_t below;
    double scale;
} word_kind;

static double real(uint64_t word)
{
    double value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static uint64_t bits(double value)
{
    uint64_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

/* Returns a word with one pattern for all NaN. */
static uint64_t canonical(uint64_t word, char kind)
{
    const bool is_nan = (word & UINT64_C(0x7fffffffffffffff)) > UINT64_C(0x7ff0000000000000);
    return kind == 'R' && is_nan ? UINT64_C(0x7ff8000000000000) : word;
}

";

const SELF_TEST: &str = "static uint64_t draw(void)
{
    generator ^= generator << 13;
    generator ^= generator >> 7;
    generator ^= generator << 17;
    return generator;
}

static uint64_t random_word(const word_kind *kind, bool is_extreme)
{
    const uint64_t word = draw();
    if (kind->kind == 'F') {
        return word & 1;
    }
    if (kind->kind == 'I') {
        return word % (kind->below > 0 ? kind->below : 1);
    }
    if (is_extreme && (word & 7) == 0) {
        return extremes[(word >> 3) & 7];
    }
    const uint64_t choice = word & 3;
    const double size = choice == 0 ? 1024.0 : choice == 1 ? 1.0 / 1024.0 : 1.0;
    const double unit = 2.0 * ((double)(word >> 11) / 9007199254740992.0) - 1.0;
    return bits(unit * kind->scale * size);
}

/* Replaces the numbers of unit vectors, of which the last one is free: the inverse stereographic projection. */
static void make_units(size_t index, uint64_t *in)
{
    size_t word = 0;
    while (word < input_counts[index]) {
        const size_t count = inputs[index][word].kind == 'R' ? (size_t)inputs[index][word].below : 0;
        double square = 0.0;
        for (size_t place = word; place + 1 < word + count; ++place) {
            square += real(in[place]) * real(in[place]);
        }
        for (size_t place = word; place + 1 < word + count; ++place) {
            in[place] = bits(2.0 * real(in[place]) / (1.0 + square));
        }
        if (count > 0) {
            in[word + count - 1] = bits((1.0 - square) / (1.0 + square));
        }
        word += count > 0 ? count : 1;
    }
}

static uint64_t self_test(uint64_t cycles)
{
    static PREFIX_state state;
    uint64_t in[MOST_INPUTS];
    uint64_t out[MOST_OUTPUTS];
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    generator = SEED;
    for (uint64_t cycle = 0; cycle < cycles; ++cycle) {
        const bool is_extreme = cycle / BLOCK % EXTREME_BLOCK == EXTREME_BLOCK - 1;
        const uint64_t time = cycle * MILLISECONDS;
        count_inputs(is_extreme ? COUNT_EXTREME : COUNT_RANDOM);
        const uint64_t now[2] = { time / 1000, time % 1000 * UINT64_C(1000000000000) };
        if (cycle % BLOCK == 0) {
            INIT(&state, now);
        }
        for (size_t index = 0; index < CALLS; ++index) {
            if (is_start[index] && cycle % BLOCK != 0) {
                continue;
            }
            for (size_t word = 0; word < input_counts[index]; ++word) {
                in[word] = random_word(&inputs[index][word], is_extreme);
            }
            if (!is_extreme) {
                make_units(index, in);
            }
            call(index, &state, now, in, out);
            for (size_t word = 0; word < output_counts[index]; ++word) {
                const uint64_t found = canonical(out[word], outputs[index][word].kind);
                for (unsigned shift = 0; shift < 64; shift += 8) {
                    hash = (hash ^ (found >> shift & 255)) * UINT64_C(0x100000001b3);
                }
            }
        }
    }
    return hash;
}

";

const REPLAY: &str = "/* Not every library prints integers of 64 bits. */
static unsigned long upper(uint64_t word)
{
    return (unsigned long)(word >> 32);
}

static unsigned long lower(uint64_t word)
{
    return (unsigned long)(word & UINT64_C(0xffffffff));
}

static void print_hash(uint64_t cycles)
{
    const uint64_t hash = self_test(cycles);
    printf(\"%08lx%08lx\\n\", upper(hash), lower(hash));
}

static bool read_word(FILE *file, uint64_t *word)
{
    unsigned char bytes[8];
    if (fread(bytes, 1, 8, file) != 8) {
        return false;
    }
    *word = 0;
    for (size_t index = 8; index > 0; --index) {
        *word = *word << 8 | bytes[index - 1];
    }
    return true;
}

static bool read_words(FILE *file, uint64_t *words, size_t count)
{
    for (size_t index = 0; index < count; ++index) {
        if (!read_word(file, &words[index])) {
            return false;
        }
    }
    return true;
}

static int replay(const char *path)
{
    static PREFIX_state state;
    uint64_t head[3];
    uint64_t in[MOST_INPUTS];
    uint64_t expected[MOST_OUTPUTS];
    uint64_t found[MOST_OUTPUTS];
    FILE *file = fopen(path, \"rb\");
    if (file == NULL || !read_words(file, head, 2) || head[0] != UINT64_C(0x3156637378656c66)) {
        fprintf(stderr, \"error: %s: no file of vectors\\n\", path);
        return 2;
    }
    const uint64_t count = head[1];
    const uint64_t start[2] = { 0, 0 };
    INIT(&state, start);
    count_inputs(COUNT_RUN);
    for (uint64_t number = 0; number < count; ++number) {
        if (!read_words(file, head, 3) || head[0] >= CALLS || !read_words(file, in, input_counts[head[0]])
            || !read_words(file, expected, output_counts[head[0]])) {
            fprintf(stderr, \"error: %s: ends within call %lu\\n\", path, (unsigned long)number);
            return 2;
        }
        const size_t index = (size_t)head[0];
        call(index, &state, &head[1], in, found);
        for (size_t word = 0; word < output_counts[index]; ++word) {
            const word_kind *kind = &outputs[index][word];
            if (canonical(found[word], kind->kind) != canonical(expected[word], kind->kind)) {
                fprintf(stderr, \"call %lu: %s is %08lx%08lx, not %08lx%08lx\\n\", (unsigned long)number, kind->name,
                    upper(found[word]), lower(found[word]), upper(expected[word]), lower(expected[word]));
                return 1;
            }
        }
    }
    fclose(file);
    printf(\"%lu calls equal\\n\", (unsigned long)count);
    return 0;
}

";

const MAIN: &str = "int main(int argc, char **argv)
{
#ifdef DRIVER_CYCLES
    (void)argc;
    (void)argv;
#ifdef DRIVER_COUNT
    static const char *const names[CALLS] = { NAMES };
    count_start();
#endif
    print_hash(DRIVER_CYCLES);
#ifdef DRIVER_VECTORS
    const int status = replay(DRIVER_VECTORS);
#else
    (void)replay;
    const int status = 0;
#endif
#ifdef DRIVER_COUNT
    count_print(names, CALLS);
#endif
    return status;
#else
    if (argc == 3 && strcmp(argv[1], \"--hash\") == 0) {
        print_hash(strtoull(argv[2], NULL, 10));
        return 0;
    }
    if (argc == 2) {
        return replay(argv[1]);
    }
    fprintf(stderr, \"usage: driver vectors.bin | driver --hash N\\n\");
    return 2;
#endif
}
";
