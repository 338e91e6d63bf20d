# %% [markdown]
# # From data sheets to the report
#
# **The question.** A 6U CubeSat of 10 kg has wheels of 3.6 mN m s, magnetorquers, a MEMS gyro and a star tracker. Does it
# find the Earth after its release, and can it follow a ground station?
#
# Everything here happens on the command line and in one TOML file. The function `terminal` only runs what you would type.

# %%
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import flexsc
import matplotlib.pyplot as plt

folder = Path(tempfile.mkdtemp())


def terminal(line: str) -> None:
    """Runs a command line and prints what it says."""
    words = [sys.executable, "-m", *shlex.split(line)]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    print(f"$ {line}\n{done.stdout}{done.stderr}".rstrip())


terminal("flexsc new mine --cubesat --size 6U --mass 10")

# %% [markdown]
# ## The file
#
# The file has typical values, each with its unit and a comment. [Data sheets](../data-sheets.md) says which entry of a data
# sheet is which key. Here the release is gentle, so that detumbling is short, and the run ends after 9000 s.

# %%
path = folder / "mine.toml"
text = path.read_text("utf-8")
for old, new in [
    ('rate = ["5 deg/s", "-4 deg/s", "3 deg/s"]', 'rate = ["0.6 deg/s", "-0.5 deg/s", "0.4 deg/s"]'),
    ('duration = "28540 s"', 'duration = "9000 s"'),
    ("from = 22832 ", "from = 7500 "),
]:
    assert old in text, old
    text = text.replace(old, new)

# %% [markdown]
# ## A pass
#
# The [modes of operation](../scenario/modes.md) detumble, turn the cells to the Sun and point to the Earth. A fourth one
# follows a ground station on the Azores while it is more than 15 deg above the horizon.

# %%
to_pass = """leave = [{ to = "pass", when = "elevation(pass) > 20 deg" }]
[mode.target]
primary = { body = [0, 0, 1], along = "nadir" }"""
mode_pass = """
[[mode]]
name = "pass"
law.attitude = { period = 0.1, bandwidth = 0.15 }
actuators = ["wheels"]
leave = [{ to = "nadir", when = "elevation(pass) < 15 deg" }]
[mode.target]
primary = { body = [0, 0, 1], along = { site = { latitude = "38.7 deg", longitude = "-27.2 deg" } } }
secondary = { body = [0, 1, 0], along = "orbit_normal" }
acceleration = "0.02 deg/s^2"
rate_limit = "1 deg/s"

[[actuator]]                            # one along each axis"""
text = text.replace('[mode.target]\nprimary = { body = [0, 0, 1], along = "nadir" }', to_pass)
text = text.replace("\n[[actuator]]                            # one along each axis", mode_pass)
path.write_text(text, "utf-8")
terminal("flexsc check mine.toml")

# %% [markdown]
# ## The answer

# %%
terminal("flexsc simulate mine.toml --log full")

# %% [markdown]
# Both requirements are met, and still the study has failed: in the pass a wheel is full, and the antenna looks the wrong way.
# No requirement covers the pass, so only the warning says it. The figure shows when.

# %%
log = flexsc.read_log(folder / "mine.mcap")
flexsc.plot.figure(log, "wheel")
plt.show()

# %% [markdown]
# ## Larger wheels
#
# Following the station takes the momentum of the body at up to 1 deg/s. `--wheel-momentum` writes a file with larger wheels;
# the two edits are the same.

# %%
terminal('flexsc new larger --cubesat --size 6U --mass 10 --wheel-momentum "10 mN m s"')
wheels = (folder / "larger.toml").read_text("utf-8").split("[actuator.wheels]")[1].split("\n\n")[0]
own = text.split("[actuator.wheels]")[1].split("\n\n")[0]
(folder / "larger.toml").write_text(text.replace(own, wheels), "utf-8")
terminal("flexsc simulate larger.toml --log full")

# %% [markdown]
# ## How often
#
# `[uncertain]` has the frequencies of the wings, and the rates at the release. A campaign draws them, and says how many runs
# meet the requirements. A review has more than eight runs.

# %%
text = (
    (folder / "larger.toml")
    .read_text("utf-8")
    .replace('["-5 deg/s", "5 deg/s"]', '["-0.6 deg/s", "0.6 deg/s"]')
)
(folder / "larger.toml").write_text(text, "utf-8")
terminal("flexsc simulate larger.toml --runs 8 -o runs")

# %% [markdown]
# ## The report
#
# One page for the review: conclusions, requirements, a drawing, the time line, margins and noise of each mode, a campaign, and the
# command that repeats each number. It takes some minutes, most of them for the campaign and the least margins over `[uncertain]`:
#
#     flexsc report larger.toml -o review.html --runs 100
#
# And this is the pass, with the error below the noise of the tracker and no wheel at its limit:

# %%
flexsc.plot.figure(flexsc.read_log(folder / "larger.mcap"), "pointing")
plt.show()
