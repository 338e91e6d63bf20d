//! Arguments that cannot be used together or have values that are none: refused with the option, and without a trace of a result.

use crate::util::Dir;

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn arguments_that_cannot_be_used_are_refused() {
    let dir = Dir::with(&["earth-observer", "relay-fixed", "rotation-sine", "half-turn"]);
    dir.run("simulate relay-fixed.toml --set duration=100 --log full -o a.mcap").exits(0);
    dir.run("sweep relay-fixed.toml --vary seed=1:3:3 --set duration=50 -o c").exits(0);
    let before = dir.names("");
    for (arguments, words) in [
        ("serve earth-observer.toml --period 1e10", &["--period", "1e-9 to 1e9 s, got 10000000000"][..]),
        ("serve earth-observer.toml --timeout 1e7", &["--timeout", "0 to 1000000 s, got 10000000"]),
        ("top c --every 0", &["--every must be from 0.05 to 86400 s, got 0"]),
        ("top c --once --metric nothing", &["there is no metric `nothing` that is a number"]),
        ("plan rotation-sine.toml --band 2", &["--band must be between 0 and 1, got 2"]),
        ("plan rotation-sine.toml --peak-torque=-1", &["--peak-torque must be a positive number, got -1"]),
        ("report relay-fixed.toml -o a.txt", &["-o a.txt: must end in .html"]),
        ("worst relay-fixed.toml", &["has no [[requirement]] and no [[bound]]", "--metric"]),
        ("plot c --from 1", &["--from: only for logs, and c is a directory"]),
        ("plot c --what /attitude", &["--what: /attitude is for logs"]),
        ("plot c --what region", &["there is no figure `region` for it", "hint: it has "]),
        ("plot a.mcap --from 20 --to 10", &["the run is from 0 to 100 s, got --from 20 --to 10"]),
        ("plot a.mcap --from 300", &["the run is from 0 to 100 s, got --from 300 --to -"]),
        (
            "simulate half-turn.toml --runs 3 --scheduler tcp://a:1 --json -o d",
            &["--scheduler tcp://a:1", "leave out --json"],
        ),
        ("simulate half-turn.toml --runs 3 --scheduler tcp://a:1 --log full -o d", &["leave out --log"]),
        (
            "sweep relay-fixed.toml --vary seed=1:3:3 --scheduler tcp://a:1 --fail-fast -o d",
            &["leave out --fail-fast"],
        ),
        ("sweep relay-fixed.toml --vary law.relay.k_t=", &["is not KEY=LO:HI:COUNT"]),
    ] {
        dir.run(arguments).exits(2).says(&["error: "]).says(words);
        assert_eq!(dir.names(""), before, "{arguments}");
    }
}
