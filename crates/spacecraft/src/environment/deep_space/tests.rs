//! SGP4 in deep space against the states that were published for its verification.

use flexsc_numerics::attitude::Vector;

use crate::environment::sgp4::Sgp4;
use crate::environment::two_lines::parse;

/// Two-line elements, and states in deep space: `tests/golden/deep_space.txt`.
const STATES: &str = include_str!("../../../../../tests/golden/deep_space.txt");

/// Returns the elements of the file, each with its states: minutes, position (km) and velocity (km/s).
fn orbits() -> Vec<([String; 2], Vec<[f64; 7]>)> {
    let (mut found, mut first) = (Vec::new(), String::new());
    for line in STATES.lines().filter(|line| !line.starts_with('#')) {
        if line.len() == 69 && line.starts_with("1 ") {
            line.clone_into(&mut first);
        } else if line.len() == 69 && line.starts_with("2 ") {
            found.push(([first.clone(), line.to_owned()], Vec::new()));
        } else {
            let numbers: Vec<f64> =
                line.split_whitespace().map(|field| field.parse().expect("a number")).collect();
            found.last_mut().expect("elements").1.push(numbers.try_into().expect("seven numbers"));
        }
    }
    found
}

#[test]
fn orbits_in_deep_space_have_the_states_of_their_verification() {
    let orbits = orbits();
    assert_eq!(orbits.len(), 20);
    for (lines, states) in orbits {
        let mut orbit = Sgp4::new(&parse(&lines).expect("elements"));
        // From the last to the first as well: the integration of a resonance begins anew where it has to.
        for [minutes, x, y, z, dx, dy, dz] in states.iter().chain(states.iter().rev()) {
            let found = orbit.at(*minutes).expect("a position").map(|vector| vector / 1e3);
            let position = (found[0] - Vector::new(*x, *y, *z)).amax();
            let velocity = (found[1] - Vector::new(*dx, *dy, *dz)).amax();
            // The last digits of the file are 1e-8 km and 1e-9 km/s. Its program rounds the epoch to 5e-10 days, by which Sun and
            // Moon move: in the widest orbits, of 4 and 14 days, by up to 5 mm.
            let digits = match &lines[0][2..7] {
                "20413" => 5e-7,
                "23333" => 6e-6,
                _ => 1.2e-7,
            };
            assert!(position < digits, "{} {minutes}: {position:e} km", lines[0]);
            assert!(velocity < 2e-9, "{} {minutes}: {velocity:e} km/s", lines[0]);
        }
    }
}
