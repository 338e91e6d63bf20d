//! Goals: verdicts of runs without requirements, on bands that a scenario or a law gives.

use crate::util::Dir;

/// A goal that no key gives is no verdict beside a requirement, and none where the run starts at its target but for rounding.
#[test]
fn a_goal_of_the_program_is_no_verdict() {
    let hold = "duration = 40.0\nsensor = { gyro = { period = 0.5, angle_random_walk = 1e-6 } }\n\
        law = { attitude = { period = 0.5, bandwidth = 0.1 } }\n[spacecraft]\nmass = 20.0\n\
        inertia = [[4, 0, 0], [0, 5, 0], [0, 0, 3]]\nattitude = \"target\"\nrate = \"target\"\n\
        [environment]\norbit = { semi_major_axis = 6.9e6, inclination = 1.7 }\n[[target]]\nfrom = 0\nframe = \"nadir\"\n";
    let required = "[[requirement]]\nname = \"hold\"\nquantity = \"pointing_error\"\nlimit = 1.0\nlevel = 0.9\n\
        interpretation = \"temporal\"\n";
    for (more, is_unasked) in [("", true), (required, false), ("[reference]\nband = 1.0\n", false)] {
        let dir = Dir::holding("a.toml", format!("{hold}{more}"));
        let said = dir.run("simulate a.toml --log full").exits(0).err;
        let is_judged = more.contains("band");
        assert_eq!(said.contains("goal met: each axis within 57.3 deg all the time"), is_judged, "{said}");
        assert_eq!(said.contains("a   no requirement"), is_unasked, "{said}");
        let metrics = dir.run("simulate a.toml --log none --json").exits(0).json()["metrics"].clone();
        assert_eq!((metrics["goal"] == "met", metrics["goal_band_rad"].is_null()), (is_judged, !is_judged));
        dir.run("plot a.mcap --what pointing --axes -o p.svg --force").exits(0);
        assert_eq!(dir.text("p.svg").contains("goal band"), is_judged);
    }
}
