//! Keyboard control of a live run: each line is a command.

use std::io::{self, BufRead, IsTerminal, Write};
use std::sync::Arc;
use std::thread;
use std::time::Instant as WallInstant;

use super::clock::{Clock, Speed};
use super::hub::Hub;
use crate::{say, stop};

/// Description of the commands.
const HELP: &str = "Enter pauses and resumes, `.` steps, `+` and `-` or a factor set the speed, `q` stops";

/// Command of the user.
#[derive(Debug, PartialEq)]
enum Key {
    Toggle,
    Step,
    Faster,
    Slower,
    Speed(Speed),
    Stop,
    Unknown,
}

impl Key {
    fn parse(line: &str) -> Self {
        match line.trim() {
            "" => Self::Toggle,
            "." => Self::Step,
            "+" => Self::Faster,
            "-" => Self::Slower,
            "q" => Self::Stop,
            text => text.parse().map_or(Self::Unknown, Self::Speed),
        }
    }

    fn press(self, clock: &mut Clock) {
        let (wall, speed) = (WallInstant::now(), clock.speed());
        match self {
            Self::Toggle if clock.paused() => clock.resume(wall),
            Self::Toggle => clock.pause(),
            Self::Step => clock.step(),
            Self::Faster => clock.set_speed(speed.times(2.0), wall),
            Self::Slower => clock.set_speed(speed.times(0.5), wall),
            Self::Speed(speed) => clock.set_speed(speed, wall),
            Self::Stop | Self::Unknown => {}
        }
    }
}

/// Reads commands from the terminal, if there is one.
pub fn listen(hub: Arc<Hub>) {
    if !io::stdin().is_terminal() {
        return;
    }
    say!("  keys           {HELP}");
    // The thread waits for a line that may never be typed, and ends with the program.
    thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            match Key::parse(&line) {
                Key::Stop => return stop::request_stop(),
                Key::Unknown => say!("  {HELP}"),
                _ if hub.ended() => say!("  the run has ended"),
                key => {
                    let clock = hub.change(|clock| key.press(clock));
                    let state = if clock.paused() { "paused, " } else { "" };
                    say!("  at {:.3} s     {state}{}", clock.at().seconds(), clock.speed());
                }
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_commands() {
        let speed = |text: &str| Key::Speed(text.parse().expect("a speed"));
        let lines = ["\n", ".", "+", "-", "q", " 2.5 ", "max", "-3", "faster"];
        let keys = [
            Key::Toggle,
            Key::Step,
            Key::Faster,
            Key::Slower,
            Key::Stop,
            speed("2.5"),
            speed("max"),
            Key::Unknown,
            Key::Unknown,
        ];
        assert_eq!(lines.map(Key::parse), keys);
    }
}
