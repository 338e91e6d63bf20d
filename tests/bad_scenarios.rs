//! Bad scenario files: each is refused with one error that names place, key, what was found and what is accepted.

use crate::util::Dir;

/// A small good scenario that has every table.
pub const GOOD: &str = r#"duration = 100.0

[body.planar]
angle = 4.5e-4

[[body.planar.modes]]
frequency = 0.44
gain = 0.0213
displacement = 2.75e-6

[law.relay]
dead_zone = 5e-4
hysteresis = 1e-4
strong = 4e-5
weak = 1e-6
k_t = 0.31

[estimator.envelope]
window = 50.0

[adaptation.random_search]
step = 0.002
bounds = [0.28, 0.40]

[sensor.sampled]
period = 0.1

[log]
period = 0.1

[reference]
envelope = 2e-5

[uncertain]
"law.relay.k_t" = { uniform = [0.3, 0.32] }
"#;

/// Change of the good scenario.
enum Edit {
    /// One line is replaced.
    Line(usize, &'static str),
    /// Lines are replaced.
    Lines(&'static [(usize, &'static str)]),
    /// Lines are removed, from the first to the second inclusive.
    Cut(usize, usize, &'static str),
    /// Text is appended.
    More(&'static str),
    /// All of the text is replaced.
    All(&'static str),
}
use Edit::{All, Cut, Line, Lines, More};

impl Edit {
    fn text(&self) -> String {
        let mut lines: Vec<&str> = GOOD.lines().collect();
        match self {
            Line(number, line) => lines[number - 1] = line,
            Lines(edits) => edits.iter().for_each(|(number, line)| lines[number - 1] = line),
            Cut(first, last, start) => {
                lines[first - 1..*last].fill("");
                lines[0] = start;
            }
            More(text) => lines.push(text),
            All(text) => return (*text).to_owned(),
        }
        lines.join("\n") + "\n"
    }
}

/// Fault of a case: its name, the change of the text, the line and the text that the carets mark, and words of the
/// error.
type Case = (&'static str, Edit, usize, &'static str, &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const TYPES: &[Case] = &[
    ("string for a number", Line(1, r#"duration = "long""#), 1, r#""long""#, &["`duration`", r#"found string "long""#, "expected a number"]),
    ("bool for a number", Line(1, "duration = true"), 1, "true", &["`duration`", "found boolean `true`", "expected a number"]),
    ("date for a number", Line(1, "duration = 2026-01-01"), 1, "2026-01-01", &["`duration`", "found a date", "expected a number"]),
    ("array for a number", Line(1, "duration = [1.0]"), 1, "[1.0]", &["`duration`", "found an array", "expected a number"]),
    ("table for a number", Line(1, "duration = {}"), 1, "{}", &["`duration`", "found a table", "expected a number"]),
    ("number for a string", Line(1, "duration = 1\nname = 5"), 2, "5", &["`name`", "found integer `5`", "expected a string"]),
    ("number for a kind", Cut(11, 16, "law = 5"), 1, "5", &["`law`", "found a number", "expected the name of a kind or a table"]),
    ("number for a table", Cut(11, 16, "law.relay = 5\nduration = 1"), 1, "5", &["`law.relay`", "found integer `5`", "expected a table"]),
    ("number for the log", Cut(28, 29, "log = 5\nduration = 1"), 1, "5", &["`log`", "found integer `5`", "expected a table"]),
    ("number for uncertain", Cut(34, 35, "uncertain = 5\nduration = 1"), 1, "5", &["`uncertain`", "found integer `5`", "expected a table"]),
    ("array for a table", Cut(11, 16, "duration = 1\nlaw.relay = [5e-4, 1e-4, 4e-5, 1e-6, 0.31]"), 2, "[5e-4, 1e-4, 4e-5, 1e-6, 0.31]", &["`law.relay`", "found an array", "expected a table"]),
    ("array for a mode", Lines(&[(4, "modes = [[0.44, 0.02, 0.0, 0.0, 0.0]]"), (6, ""), (7, ""), (8, ""), (9, "")]), 4, "[0.44, 0.02, 0.0, 0.0, 0.0]", &["`body.planar.modes[0]`", "found an array", "expected a table"]),
    ("number for a mode", Lines(&[(4, "modes = [5]"), (6, ""), (7, ""), (8, ""), (9, "")]), 4, "5", &["`body.planar.modes[0]`", "found integer `5`", "expected a table"]),
    ("number for the modes", Lines(&[(4, "modes = 5"), (6, ""), (7, ""), (8, ""), (9, "")]), 4, "5", &["`body.planar.modes`", "found integer `5`", "expected an array"]),
    ("single brackets", Line(6, "[body.planar.modes]"), 6, "[body.planar.modes]", &["there can be several", "expected `[[body.planar.modes]]`"]),
    ("double brackets around distributions", Line(34, "[[uncertain]]"), 34, "[[uncertain]]", &["there is only one", "expected `[uncertain]`"]),
    ("double brackets", Line(3, "[[body.planar]]"), 3, "[[body.planar]]", &["there is only one", "expected `[body.planar]`"]),
    ("number for a bool", Line(22, "step = 0.002\nfreeze = 1"), 23, "1", &["`adaptation.random_search.freeze`", "found integer `1`", "expected true or false"]),
    ("number for a pair", Line(23, "bounds = 0.28"), 23, "0.28", &["`adaptation.random_search.bounds`", "found number `0.28`", "expected an array of length 2"]),
    ("a short pair", Line(23, "bounds = [0.28]"), 23, "[0.28]", &["`adaptation.random_search.bounds`", "found an array of length 1", "expected an array of length 2"]),
    ("a long pair", Line(23, "bounds = [0.28, 0.3, 0.4]"), 23, "[0.28, 0.3, 0.4]", &["`adaptation.random_search.bounds`", "has 3 values", "expected 2"]),
    ("string in a pair", Line(23, r#"bounds = ["a", 0.4]"#), 23, r#""a""#, &["`adaptation.random_search.bounds[0]`", r#"found string "a""#, "expected a number"]),
    ("string for a date", Line(1, "duration = 1\nepoch = \"2026-01-01\""), 2, "\"2026-01-01\"", &["`epoch`", r#"found string "2026-01-01""#, "expected a date and time without quotes, such as 2026-"]),
    ("number for a date", Line(1, "duration = 1\nepoch = 5"), 2, "5", &["`epoch`", "found integer `5`", "expected a date and time"]),
];

#[rustfmt::skip] // One case a line.
const KEYS: &[Case] = &[
    ("unknown key at the top", Line(1, "duration = 1\ndurration = 2"), 2, "durration", &["unknown key `durration`", "expected one of", "`duration`"]),
    ("unknown table at the top", Line(11, "[lew.relay]"), 11, "lew", &["unknown key `lew`", "expected one of", "`law`"]),
    ("unknown key of the body", Line(4, "angel = 1"), 4, "angel", &["unknown key `angel`", "`inertia`, `angle`, `rate`, `drive`, `damping_matrix`, `modes`, `outputs`"]),
    ("unknown key of a mode", Line(7, "frequncy = 1"), 7, "frequncy", &["unknown key `frequncy`", "`frequency`"]),
    ("unknown key of the law", Line(16, "k_T = 0.3"), 16, "k_T", &["unknown key `k_T`", "`k_t`"]),
    ("unknown key of the sensor", Line(26, "period = 0.1\nrate = 1"), 27, "rate", &["unknown key `rate`", "`period`, `noise`, `bias`, `resolution`"]),
    ("unknown key of the estimator", Line(19, "windw = 50.0"), 19, "windw", &["unknown key `windw`", "`window`"]),
    ("unknown key of the adaptation", Line(22, "step = 0.002\nfreze = true"), 23, "freze", &["unknown key `freze`", "`freeze`"]),
    ("unknown key of the log", Line(29, "periods = 1"), 29, "periods", &["unknown key `periods`", "expected `period`"]),
    ("unknown key of the reference", Line(32, "envlope = 1"), 32, "envlope", &["unknown key `envlope`", "expected one of `envelope`"]),
    ("unknown key of a distribution", Line(35, r#""law.relay.k_t" = { normal = { mean = 0.3, sd = 0.1, x = 1 } }"#), 35, "x", &["unknown key `x`", "expected `mean` or `sd`"]),
    ("unknown distribution", Line(35, r#""law.relay.k_t" = { unifrm = [0.3, 0.32] }"#), 35, "unifrm", &[r#"`uncertain."law.relay.k_t"`"#, "`unifrm` is not known here", "`uniform`"]),
    ("unknown kind of law", Line(11, "[law.rely]"), 11, "rely", &["`rely` is not known here", "expected one of `relay`, `pd`, `attitude`, `state_space`, `open`"]),
    ("unknown kind of body", Lines(&[(3, "[body.planer]"), (6, "[[body.planer.modes]]")]), 3, "planer", &["`planer` is not known here", "expected one of `planar`"]),
    ("unknown kind of sensor", Line(25, "[sensor.sampld]"), 25, "sampld", &["`sampld` is not known here", "`continuous`, `sampled`, `gyro`"]),
    ("unknown kind of sensor, as a word", Cut(25, 26, "sensor = \"continous\"\nduration = 1"), 1, "\"continous\"", &["`sensor`", "`continous` is not known here", "`continuous`, `sampled`, `gyro`"]),
    ("unknown kind of estimator", Line(18, "[estimator.envelop]"), 18, "envelop", &["`envelop` is not known here", "expected one of `envelope`, `truth`"]),
    ("unknown kind of adaptation", Line(21, "[adaptation.random]"), 21, "random", &["`random` is not known here", "expected `random_search`"]),
    ("unknown form", Line(19, "window = 50.0\nform = \"dynamc\""), 20, "\"dynamc\"", &["`estimator.envelope.form`", "`dynamc` is not known here", "`dynamic`, `trigonometric`, `truth`"]),
    ("unknown sides", Line(12, "dead_zone = 5e-4\nsides = \"three\""), 13, "\"three\"", &["`law.relay.sides`", "`three` is not known here", "expected `two` or `one`"]),
    ("keys of a kind outside it", Line(11, "[law]"), 11, "[law]", &["`law`: exactly one kind", "more than one", "`dead_zone`, `hysteresis`"]),
    ("two laws", Line(16, "k_t = 0.31\n[law.other]\na = 1"), 11, "law", &["`law`: exactly one kind", "more than one", "`relay`, `other`"]),
    ("two sensors", Line(26, "period = 0.1\n[sensor.gyro]\nperiod = 0.1"), 25, "sensor", &["`sensor`: exactly one kind", "more than one", "`sampled`, `gyro`"]),
    ("two actuators", Line(28, "[actuator.hold]\nperiod = 0.1\n[actuator.wheel]\ngain = 1.0\n[log]"), 28, "actuator", &["`actuator`: exactly one kind", "more than one", "`hold`, `wheel`"]),
    ("two bodies", Line(9, "displacement = 2.75e-6\n[body.other]\na = 1"), 3, "body", &["`body`: exactly one kind", "more than one", "`planar`, `other`"]),
    ("a misspelt body beside its modes", Line(3, "[body.planer]"), 3, "planer", &["`body`: `planer` is not known here", "did you mean `planar`?"]),
    ("no kind of law", Lines(&[(11, "[law]"), (12, ""), (13, ""), (14, ""), (15, ""), (16, "")]), 11, "[law]", &["`law`: exactly one kind is needed", "none is given"]),
    ("only the name of a kind", Cut(11, 16, "law = \"relay\""), 1, "\"relay\"", &["`law`", "only the name of a kind", "a table"]),
    ("a sampled sensor without a period", Cut(25, 26, "sensor = \"sampled\"\nduration = 1"), 1, "\"sampled\"", &["`sensor`", "only the name of a kind", "a table"]),
    ("no duration", Line(1, ""), 1, "", &["missing key `duration`"]),
    ("no body", Cut(3, 9, "duration = 1"), 1, "", &["missing key `body`"]),
    ("no law", Cut(11, 16, "duration = 1"), 1, "", &["missing key `law`"]),
    ("no dead zone", Line(12, ""), 11, "[law.relay]", &["`law.relay`: missing key `dead_zone`"]),
    ("no hysteresis", Line(13, ""), 11, "[law.relay]", &["`law.relay`: missing key `hysteresis`"]),
    ("no strong torque", Line(14, ""), 11, "[law.relay]", &["`law.relay`: missing key `strong`"]),
    ("no weak torque", Line(15, ""), 11, "[law.relay]", &["`law.relay`: missing key `weak`"]),
    ("no k_t", Line(16, ""), 11, "[law.relay]", &["`law.relay`: missing key `k_t`"]),
    ("no frequency", Line(7, ""), 6, "[[body.planar.modes]]", &["`body.planar.modes[0]`: missing key `frequency`"]),
    ("no gain", Line(8, ""), 6, "[[body.planar.modes]]", &["`body.planar.modes[0]`: missing key `gain`"]),
    ("no gain of the second mode", Line(9, "displacement = 1e-6\n[[body.planar.modes]]\nfrequency = 1.0"), 10, "[[body.planar.modes]]", &["`body.planar.modes[1]`: missing key `gain`"]),
    ("no window", Line(19, ""), 18, "[estimator.envelope]", &["`estimator.envelope`: missing key `window`"]),
    ("no step", Line(22, ""), 21, "[adaptation.random_search]", &["`adaptation.random_search`: missing key `step`"]),
    ("no bounds", Line(23, ""), 21, "[adaptation.random_search]", &["`adaptation.random_search`: missing key `bounds`"]),
    ("no sample period", Line(26, ""), 25, "[sensor.sampled]", &["`sensor.sampled`: missing key `period`"]),
    ("no standard deviation", Line(35, r#""law.relay.k_t" = { normal = { mean = 0.3 } }"#), 35, "{ mean = 0.3 }", &["missing key `sd`"]),
];

const SPAN: &str = "must be a time of 1e-15 s to 1e13 s";
const POSITIVE: &str = "must be a positive number";
const FROM_0: &str = "must be a number of 0 or more";
const FINITE: &str = "must be a finite number";
const TO_1: &str = "must be a number between 0 and 1";
const FREQUENCY: &str = "must be a natural frequency of 1e-4 to 1e4 rad/s";

#[rustfmt::skip] // One case a line.
const NUMBERS: &[Case] = &[
    ("negative duration", Line(1, "duration = -5"), 1, "-5", &["`duration`", SPAN, "got -5"]),
    ("no duration at all", Line(1, "duration = 0"), 1, "0", &["`duration`", SPAN, "got 0"]),
    ("duration NaN", Line(1, "duration = nan"), 1, "nan", &["`duration`", SPAN, "got NaN"]),
    ("duration infinite", Line(1, "duration = inf"), 1, "inf", &["`duration`", SPAN, "got inf"]),
    ("duration too long to log", Line(1, "duration = 1e11"), 1, "1e11", &["`duration`", "must be below 1.8447e10 s", "got 1e11"]),
    ("duration too long after the epoch", Line(1, "epoch = 2026-01-01T00:00:00Z\nduration = 1.7e10"), 2, "1.7e10", &["`duration`", "must be below 1.6680e10 s", "got 1.7e10"]),
    ("duration that rounds to nothing", Line(1, "duration = 1e-20"), 1, "1e-20", &["`duration`", SPAN]),
    ("an integer of 67 bits", Line(1, "duration = 100000000000000000000"), 1, "100000000000000000000", &["`duration`", "100000000000000000000", "too large", "with a decimal point"]),
    ("a float too large", Line(1, "duration = 1e400"), 1, "1e400", &["`duration`", "too large for a double"]),
    ("negative seed", Line(1, "duration = 1\nseed = -1"), 2, "-1", &["`seed`", "found integer `-1`", "a whole number from 0 to 9223372036854775807"]),
    ("seed too large", Line(1, "duration = 1\nseed = 9223372036854775808"), 2, "9223372036854775808", &["`seed`", "a number that is too large", "from 0 to 9223372036854775807"]),
    ("seed far too large", Line(1, "duration = 1\nseed = 99999999999999999999"), 2, "99999999999999999999", &["`seed`", "99999999999999999999", "too large"]),
    ("half a seed", Line(1, "duration = 1\nseed = 1.5"), 2, "1.5", &["`seed`", "found number `1.5`", "a whole number"]),
    ("inertia zero", Line(4, "inertia = 0"), 4, "0", &["`body.planar.inertia`", POSITIVE, "got 0"]),
    ("inertia negative", Line(4, "inertia = -1"), 4, "-1", &["`body.planar.inertia`", POSITIVE, "got -1"]),
    ("inertia infinite", Line(4, "inertia = inf"), 4, "inf", &["`body.planar.inertia`", POSITIVE, "got inf"]),
    ("angle NaN", Line(4, "angle = nan"), 4, "nan", &["`body.planar.angle`", FINITE, "got NaN"]),
    ("rate infinite", Line(4, "rate = -inf"), 4, "-inf", &["`body.planar.rate`", FINITE, "got -inf"]),
    ("frequency zero with a displacement", Line(7, "frequency = 0"), 7, "0", &["`body.planar.modes[0].frequency`", FREQUENCY, "got 0"]),
    ("frequency negative", Line(7, "frequency = -0.44"), 7, "-0.44", &["`body.planar.modes[0].frequency`", FREQUENCY, "got -0.44"]),
    ("frequency too high", Line(7, "frequency = 10001"), 7, "10001", &["`body.planar.modes[0].frequency`", FREQUENCY, "got 10001"]),
    ("frequency too low", Line(7, "frequency = 9e-5"), 7, "9e-5", &["`body.planar.modes[0].frequency`", FREQUENCY, "got 0.00009"]),
    ("frequency NaN", Line(7, "frequency = nan"), 7, "nan", &["`body.planar.modes[0].frequency`", FREQUENCY, "got NaN"]),
    ("modal gain infinite", Line(8, "gain = +inf"), 8, "+inf", &["`body.planar.modes[0].gain`", FINITE, "got inf"]),
    ("damping negative", Line(9, "damping = -0.1"), 9, "-0.1", &["`body.planar.modes[0].damping`", FROM_0, "got -0.1"]),
    ("damping NaN", Line(9, "damping = nan"), 9, "nan", &["`body.planar.modes[0].damping`", FROM_0, "got NaN"]),
    ("displacement infinite", Line(9, "displacement = inf"), 9, "inf", &["`body.planar.modes[0].displacement`", FINITE, "got inf"]),
    ("rate of a mode NaN", Line(9, "rate = nan"), 9, "nan", &["`body.planar.modes[0].rate`", FINITE, "got NaN"]),
    ("dead zone zero", Line(12, "dead_zone = 0"), 12, "0", &["`law.relay.dead_zone`", POSITIVE, "got 0"]),
    ("dead zone negative", Line(12, "dead_zone = -5e-4"), 12, "-5e-4", &["`law.relay.dead_zone`", POSITIVE, "got -0.0005"]),
    ("hysteresis zero", Line(13, "hysteresis = 0.0"), 13, "0.0", &["`law.relay.hysteresis`", POSITIVE, "got 0"]),
    ("strong torque zero", Line(14, "strong = 0"), 14, "0", &["`law.relay.strong`", POSITIVE, "got 0"]),
    ("strong torque NaN", Line(14, "strong = nan"), 14, "nan", &["`law.relay.strong`", POSITIVE, "got NaN"]),
    ("weak torque negative", Line(15, "weak = -1e-6"), 15, "-1e-6", &["`law.relay.weak`", FROM_0, "got -0.000001"]),
    ("k_t zero", Line(16, "k_t = 0"), 16, "0", &["`law.relay.k_t`", TO_1, "got 0"]),
    ("k_t one", Line(16, "k_t = 1"), 16, "1", &["`law.relay.k_t`", TO_1, "got 1"]),
    ("k_t above one", Line(16, "k_t = 1.5"), 16, "1.5", &["`law.relay.k_t`", TO_1, "got 1.5"]),
    ("k_t NaN", Line(16, "k_t = nan"), 16, "nan", &["`law.relay.k_t`", TO_1, "got NaN"]),
    ("window zero", Line(19, "window = 0"), 19, "0", &["`estimator.envelope.window`", SPAN, "got 0"]),
    ("step zero", Line(22, "step = 0"), 22, "0", &["`adaptation.random_search.step`", POSITIVE, "got 0"]),
    ("bound NaN", Line(23, "bounds = [0.28, nan]"), 23, "nan", &["`adaptation.random_search.bounds[1]`", FINITE, "got NaN"]),
    ("tolerance zero", Line(22, "step = 0.002\ntolerance = 0"), 23, "0", &["`adaptation.random_search.tolerance`", POSITIVE, "got 0"]),
    ("settled negative", Line(22, "step = 0.002\nsettled = -1"), 23, "-1", &["`adaptation.random_search.settled`", "found integer `-1`", "a whole number from 0 to 4294967295"]),
    ("settled too large", Line(22, "step = 0.002\nsettled = 5000000000"), 23, "5000000000", &["`adaptation.random_search.settled`", "found integer `5000000000`", "a whole number from 0 to 4294967295"]),
    ("memory a fraction", Line(22, "step = 0.002\nmemory = 1.5"), 23, "1.5", &["`adaptation.random_search.memory`", "found number `1.5`", "a whole number"]),
    ("freeze at zero", Line(22, "step = 0.002\nearliest_freeze = 0"), 23, "0", &["`adaptation.random_search.earliest_freeze`", SPAN, "got 0"]),
    ("sample period zero", Line(26, "period = 0"), 26, "0", &["`sensor.sampled.period`", SPAN, "got 0"]),
    ("noise negative", Line(26, "period = 0.1\nnoise = -1e-6"), 27, "-1e-6", &["`sensor.sampled.noise`", FROM_0, "got -0.000001"]),
    ("bias infinite", Line(26, "period = 0.1\nbias = inf"), 27, "inf", &["`sensor.sampled.bias`", FINITE, "got inf"]),
    ("resolution NaN", Line(26, "period = 0.1\nresolution = nan"), 27, "nan", &["`sensor.sampled.resolution`", FROM_0, "got NaN"]),
    ("log period zero", Line(29, "period = 0"), 29, "0", &["`log.period`", SPAN, "got 0"]),
    ("log period negative", Line(29, "period = -0.1"), 29, "-0.1", &["`log.period`", SPAN, "got -0.1"]),
    ("reference zero", Line(32, "envelope = 0"), 32, "0", &["`reference.envelope`", POSITIVE, "got 0"]),
    ("bound of a distribution infinite", Line(35, r#""law.relay.k_t" = { uniform = [0.3, inf] }"#), 35, "inf", &[r#"`uncertain."law.relay.k_t".uniform[1]`"#, FINITE, "got inf"]),
    ("standard deviation zero", Line(35, r#""law.relay.k_t" = { normal = { mean = 0.3, sd = 0 } }"#), 35, "0", &[r#"`uncertain."law.relay.k_t".normal.sd`"#, POSITIVE, "got 0"]),
    ("relative deviation negative", Line(35, r#""law.relay.k_t" = { relative_normal = -1 }"#), 35, "-1", &[r#"`uncertain."law.relay.k_t".relative_normal`"#, POSITIVE, "got -1"]),
    ("logarithm of zero", Line(35, r#""law.relay.k_t" = { log_uniform = [0, 0.3] }"#), 35, "0", &[r#"`uncertain."law.relay.k_t".log_uniform[0]`"#, POSITIVE, "got 0"]),
];

const EPOCH: &str = "must be a date and time from 1970 to 2500, such as 2026-";
const FILE_NAME: &str = "is used for file names: at most 200 bytes, no slash, no control character";
const ORDER: &str = "needs [low, high] in this order";

#[rustfmt::skip] // One case a line.
const RELATIONS: &[Case] = &[
    ("epoch a date only", Line(1, "duration = 1\nepoch = 2026-01-01"), 2, "2026-01-01", &["`epoch`", EPOCH]),
    ("epoch a time only", Line(1, "duration = 1\nepoch = 12:00:00"), 2, "12:00:00", &["`epoch`", EPOCH]),
    ("epoch before 1970", Line(1, "duration = 1\nepoch = 1969-12-31T23:59:59Z"), 2, "1969-12-31T23:59:59Z", &["`epoch`", EPOCH]),
    ("epoch after 2500", Line(1, "duration = 1\nepoch = 2600-01-01T00:00:00Z"), 2, "2600-01-01T00:00:00Z", &["`epoch`", EPOCH]),
    ("epoch in month 13", Line(1, "duration = 1\nepoch = 2026-13-01T00:00:00Z"), 2, "2026-13-01T00:00:00Z", &["invalid date", "month between 01 and 12"]),
    ("name with a slash", Line(1, "duration = 1\nname = \"a/b\""), 2, "\"a/b\"", &["`name`", FILE_NAME]),
    ("name with a backslash", Line(1, "duration = 1\nname = 'a\\b'"), 2, "'a\\b'", &["`name`", FILE_NAME]),
    ("name of two lines", Line(1, "duration = 1\nname = \"a\\nb\""), 2, "\"a\\nb\"", &["`name`", FILE_NAME]),
    ("name with a hyphen first", Line(1, "duration = 1\nname = \"-o\""), 2, "\"-o\"", &["`name`", "is used for file names", "neither a dot nor a hyphen"]),
    ("name of the parent directory", Line(1, "duration = 1\nname = \"..\""), 2, "\"..\"", &["`name`", "is used for file names", "neither a dot nor a hyphen"]),
    ("name of a device", Line(1, "duration = 1\nname = \"con\""), 2, "\"con\"", &["`name`", "a device on Windows"]),
    ("name that runs backwards", Line(1, "duration = 1\nname = \"a\\u202eb\""), 2, "\"a\\u202eb\"", &["`name`", "reverse the direction"]),
    ("hysteresis as wide as the dead zone", Line(13, "hysteresis = 1e-3"), 13, "1e-3", &["`law.relay.hysteresis`", "must be less than the dead zone's width of 0.001", "got 0.001"]),
    ("critical damping under an envelope", Line(9, "damping = 1"), 9, "1", &["`body.planar.modes[0].damping`", "must be below 1 for a mode to have an envelope", "got 1"]),
    ("critical damping of an estimator's mode", Line(19, "window = 50.0\nmodes = [{ frequency = 1.0, gain = 1.0, damping = 2.0 }]"), 20, "2.0", &["`estimator.envelope.modes[0].damping`", "must be below 1", "got 2"]),
    ("modes of an estimator that reads the truth", Line(19, "window = 50.0\nform = \"truth\"\nmodes = [{ frequency = 1.0, gain = 1.0 }]"), 21, "[{ frequency = 1.0, gain = 1.0 }]", &["`estimator.envelope.modes`", "must be left out for the form `truth`"]),
    ("adaptation without an estimator", Cut(18, 19, "duration = 1"), 21, "[adaptation.random_search]", &["`adaptation.random_search`", "needs the window means of an `[estimator.envelope]`", "there is none"]),
    ("k_t out of bounds", Line(16, "k_t = 0.5"), 16, "0.5", &["`law.relay.k_t`", "within the adaptation's bounds [0.28, 0.4]", "got 0.5"]),
    ("bounds in the wrong order", Line(23, "bounds = [0.40, 0.28]"), 23, "[0.40, 0.28]", &["`adaptation.random_search.bounds`", "[low, high] in this order", "got [0.4, 0.28]"]),
    ("bounds beyond k_t's", Line(23, "bounds = [0.28, 1.0]"), 23, "[0.28, 1.0]", &["`adaptation.random_search.bounds`", "between 0 and 1", "got [0.28, 1]"]),
    ("an uncertain key that is none", Line(35, r#""law.relay.k_tt" = { uniform = [0.3, 0.32] }"#), 35, "{ uniform = [0.3, 0.32] }", &[r#"`uncertain."law.relay.k_tt"`"#, "names no key"]),
    ("a distribution of a distribution", Line(35, "\"seed\" = { uniform = [1, 9] }\n\"uncertain.seed.uniform[0]\" = { uniform = [0.3, 0.32] }"), 36, "{ uniform = [0.3, 0.32] }", &[r#"`uncertain."uncertain.seed.uniform[0]"`"#, "names no key"]),
    ("an uncertain key that is no path", Line(35, r#""law..k_t" = { uniform = [0.3, 0.32] }"#), 35, "{ uniform = [0.3, 0.32] }", &[r#"`uncertain."law..k_t"`"#, "names no key"]),
    ("an uncertain key without quotes", Line(35, "law.relay.k_t = { uniform = [0.3, 0.32] }"), 35, "relay", &["`uncertain.law`", "`relay` is not known here", "must be in quotes"]),
    ("an uncertain string", Line(35, r#""name" = { uniform = [0.3, 0.32] }"#), 35, "{ uniform = [0.3, 0.32] }", &[r#"`uncertain."name"`"#, "varies a number", "holds a string"]),
    ("an uncertain table", Line(35, r#""law.relay" = { uniform = [0.3, 0.32] }"#), 35, "{ uniform = [0.3, 0.32] }", &[r#"`uncertain."law.relay"`"#, "varies a number", "holds a table"]),
    ("an uncertain string for a distribution", Line(35, r#""law.relay.k_t" = "uniform""#), 35, "\"uniform\"", &[r#"`uncertain."law.relay.k_t"`"#, "only the name of a kind"]),
    ("a number for a distribution", Line(35, r#""law.relay.k_t" = 0.3"#), 35, "0.3", &[r#"`uncertain."law.relay.k_t"`"#, "found a number", "or a table"]),
    ("no distribution", Line(35, r#""law.relay.k_t" = {}"#), 35, "{}", &[r#"`uncertain."law.relay.k_t"`"#, "exactly one kind is needed"]),
    ("two distributions", Line(35, r#""law.relay.k_t" = { uniform = [0.3, 0.32], choice = [0.3] }"#), 35, "{ uniform = [0.3, 0.32], choice = [0.3] }", &["exactly one kind", "`uniform`, `choice`"]),
    ("a distribution from high to low", Line(35, r#""law.relay.k_t" = { uniform = [0.32, 0.3] }"#), 35, "{ uniform = [0.32, 0.3] }", &[r#"`uncertain."law.relay.k_t"`"#, ORDER, "got [0.32, 0.3]"]),
    ("a distribution of no width", Line(35, r#""law.relay.k_t" = { log_uniform = [0.3, 0.3] }"#), 35, "{ log_uniform = [0.3, 0.3] }", &[ORDER, "got [0.3, 0.3]"]),
    ("three bounds", Line(35, r#""law.relay.k_t" = { uniform = [0.3, 0.32, 0.4] }"#), 35, "[0.3, 0.32, 0.4]", &[r#"`uncertain."law.relay.k_t".uniform`"#, "has 3 values", "expected 2"]),
    ("an empty choice", Line(35, r#""law.relay.k_t" = { choice = [] }"#), 35, "{ choice = [] }", &["at least one value to choose from"]),
    ("a choice of words", Line(35, r#""law.relay.k_t" = { choice = ["a"] }"#), 35, r#"{ choice = ["a"] }"#, &[r#"`uncertain."law.relay.k_t"` has a text among its values"#, "holds a float"]),
    ("a part of zero", Line(35, r#""body.planar.rate" = { relative_normal = 0.1 }"#), 35, "{ relative_normal = 0.1 }", &[r#"`uncertain."body.planar.rate"`"#, "by a factor", "that is 0"]),
];

#[rustfmt::skip] // One case a line.
const SYNTAX: &[Case] = &[
    ("an empty file", All(""), 1, "", &["missing key `duration`"]),
    ("comments only", All("# nothing\n"), 1, "", &["missing key `duration`"]),
    ("unclosed string", Line(1, "duration = \"100"), 1, "", &["invalid basic string", "expected `\"`"]),
    ("unclosed array", Line(23, "bounds = [0.28, 0.40"), 25, "", &["missing comma", "expected"]),
    ("unclosed header", Line(3, "[body.planar"), 3, "", &["unclosed table", "expected `]`"]),
    ("no value", Line(1, "duration = "), 1, "", &["found no TOML value"]),
    ("two values", Line(1, "duration = 1 2"), 1, "1 2", &["found no TOML value"]),
    ("no equals sign", Line(1, "duration 100"), 1, "", &["expected `=`"]),
    ("two points", Line(1, "duration = 1.2.3"), 1, ".3", &["found no valid TOML number"]),
    ("duplicate key", Line(1, "duration = 1\nduration = 2"), 2, "duration", &["duplicate key"]),
    ("duplicate table", More("[log]\nperiod = 2"), 36, "log", &["duplicate key"]),
    ("a key that is a value and a table", Line(1, "duration = 1\nbody = 5"), 4, "body", &["cannot extend value of type integer"]),
    ("a zero byte", Line(1, "duration = 1\0"), 1, "1\0", &["found no TOML value"]),
    ("letters beyond ASCII before the place", Line(1, "name = \"\u{e4}\u{20ac}\u{1d11e}\"\nduration = { \"\u{20ac}\" = 1 }"), 2, "{ \"\u{20ac}\" = 1 }", &["`duration`", "found a table"]),
    ("DOS line ends", All("duration = 1\r\nname = 5\r\n"), 2, "5", &["`name`", "found integer `5`"]),
];

/// Words of the parser's trade that mean nothing to an engineer.
const JARGON: &[&str] = &[
    "u32",
    "u64",
    "f64",
    "i64",
    "i128",
    "struct",
    "variant",
    "newtype",
    "invalid type",
    "invalid value",
    "sequence",
    "found map",
    "field",
    "literal",
];

/// Runs the cases, and reports all faults of their errors together.
fn check(cases: &[Case]) {
    let dir = Dir::new();
    let mut wrong = Vec::new();
    for (name, edit, line, marked, words) in cases {
        let text = edit.text();
        dir.write("bad.toml", &text);
        if let Err(why) = judge(&dir, &text, *line, marked, words) {
            wrong.push(format!("\n--- {name}: {why}"));
            // The output of one case must not count for the next.
            let _ = std::fs::remove_dir_all(dir.path("out"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

fn judge(dir: &Dir, text: &str, line: usize, marked: &str, words: &[&str]) -> Result<(), String> {
    let ran = dir.run("simulate bad.toml -o out");
    let no = |why: &str| Err(format!("{why}\n{}", ran.err));
    if ran.code != Some(2) || !ran.out.is_empty() || !dir.names("out").is_empty() {
        return no(&format!("exit code {:?}, stdout `{}`, files {:?}", ran.code, ran.out, dir.names("out")));
    }
    if ran.err.lines().filter(|line| line.starts_with("error:")).count() != 1 {
        return no("not one error");
    }
    let shown: Vec<&str> = ran.err.lines().collect();
    let source = text.lines().nth(line - 1).unwrap_or_default();
    let place = format!("error: bad.toml:{line}:");
    let Some((column, message)) = shown[0].strip_prefix(&place).and_then(|rest| rest.split_once(": ")) else {
        return no(&format!("not at line {line}"));
    };
    let column: usize = column.parse().map_err(|_| "no column".to_owned())?;
    let rest: String = source.chars().skip(column - 1).collect();
    if !rest.starts_with(marked) {
        return no(&format!("at `{rest}`, not at `{marked}`"));
    }
    let indent = " ".repeat(column - 1);
    let carets = "^".repeat(marked.chars().count().max(1));
    let gutter = " ".repeat(line.to_string().len());
    let picture = [
        format!("{gutter} |"),
        format!("{line} | {}", source.replace('\0', " ")),
        format!("{gutter} | {indent}{carets}"),
    ];
    if shown[1..] != picture {
        return no(&format!("the picture is not\n{}", picture.join("\n")));
    }
    if let Some(word) = words.iter().find(|word| !message.contains(**word)) {
        return no(&format!("no `{word}`"));
    }
    match JARGON.iter().find(|word| message.contains(**word)) {
        Some(word) => no(&format!("`{word}` is jargon")),
        None => Ok(()),
    }
}

#[test]
fn the_good_scenario_is_good() {
    let dir = Dir::holding("good.toml", GOOD);
    dir.run("simulate good.toml -o out").exits(0);
    assert_eq!(dir.names("out"), ["good.mcap"]);
}

#[test]
fn wrong_types_are_refused() {
    check(TYPES);
}

#[test]
fn unknown_and_missing_keys_are_refused() {
    check(KEYS);
}

#[test]
fn numbers_out_of_range_are_refused() {
    check(NUMBERS);
}

#[test]
fn values_that_do_not_fit_each_other_are_refused() {
    check(RELATIONS);
}

#[test]
fn wrong_toml_is_refused() {
    check(SYNTAX);
}
