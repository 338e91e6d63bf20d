# %% [markdown]
# # A slew that leaves the panels at rest
#
# **The question.** A spacecraft with two long solar panels has to roll by 90° in 12 s. A bang-bang torque is the fastest, and
# leaves the panels swinging for minutes. Which torque turns the hub as far and leaves the panels at rest? And what remains of
# that if the stiffness of the hinges is known to 20 % only?

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np

scenario = flexsc.Scenario.example("rotation-sine")
modes = scenario.modes
print("natural frequencies [rad/s]:", np.round(modes["frequency"], 3))

# %% [markdown]
# The body is a hub with two panels, each of four hinged sections ([manoeuvres](../manoeuvres.md)). In 12 s the lowest mode
# swings a few times.
#
# ## Plan the torque
#
# The command `sine` is a series of sines whose coefficients follow from linear equations: the hub arrives, and as many modes as
# you ask for are at rest, exactly. Each mode that is suppressed costs one harmonic.

# %%
plans = {count: scenario.with_("manoeuvre.command.sine.suppress", count).plan() for count in (0, 1, 2)}
times = np.linspace(0.0, 12.0, 601)
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for count, plan in plans.items():
    axes.plot(
        times, plan.torque(times), label=f"{count} modes suppressed: peak {plan['peak_torque_nm']:.0f} N m"
    )
axes.set(xlabel="time [s]", ylabel="torque [N m]")
_ = axes.legend()

# %% [markdown]
# ## Fly it
#
# What is left after the manoeuvre is the elastic energy. The simulation has no step size, so what it finds is what the plan
# leaves, not an error of integration.

# %%
left = {}
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for count in plans:
    run = scenario.with_("manoeuvre.command.sine.suppress", count).simulate(log="full")
    left[count] = run.metrics["residual_energy_j"]
    outermost = run["outputs"]["outputs.value"][:, -1]
    axes.plot(
        run["outputs"]["time_s"],
        outermost,
        linewidth=0.9,
        label=f"{count} suppressed: {left[count]:.1e} J left",
    )
axes.axvline(12.0, color="grey", linewidth=0.7)
axes.set(xlabel="time [s]", ylabel="angle of the outermost section [rad]")
_ = axes.legend()
assert left[2] < 1e-8 and left[0] > 0.1

# %% [markdown]
# After the grey line the body should be still. With two modes suppressed what remains is in the modes above them.
#
# ## Beside other commands
#
# `compare` plans the same turn with the other commands, each in the same time, and tells what they leave.

# %%
print("command               time   peak torque   outermost section left   at worst with 10 % error")
for row in plans[2].compare():
    swing, worst = (row[key]["section_4"] for key in ("residual_rad", "residual_worst_rad"))
    print(
        f"{row['command']:<20} {row['time_s']:4.1f} s  {row['peak_torque_nm']:7.0f} N m  {swing:14.1e} rad  {worst:18.1e} rad"
    )

# %% [markdown]
# The row `sine p=2` is the plan above. Fewer newton metres mean more swinging or less robustness; the last column is the one to
# read if the frequencies are uncertain.
#
# ## Frequencies that are wrong
#
# No hinge is as stiff as its data sheet says. A zero of the command's spectrum that is doubled stays low in a wider band around
# its mode. Let all hinges be softer or stiffer than the plan assumes, by the same factor, and fly three plans. The key
# `manoeuvre.model` is the body that the plan is made for; `body` is the one that flies.

# %%
commands = {
    "both modes once": {"suppress": 2},
    "first mode twice": {"zeros": [{"mode": 0, "times": 2}]},
    "first twice, second once": {"zeros": [{"mode": 0, "times": 2}, {"mode": 1}]},
}
errors = np.linspace(-0.3, 0.3, 31)
stiffness = {
    f"body.panels.sections[{index}].hinge_stiffness": k for index, k in enumerate((3e3, 2e3, 2e3, 2e3))
}
uncertain = {key: {"relative_uniform": 0.2} for key in stiffness}
# A run of a campaign carries the body that the plan was made for.
model = scenario.with_("uncertain", uncertain).draw(0).to_dict()["manoeuvre"]["model"]
believed = scenario.with_("manoeuvre.model", model)
residuals, peaks = {}, {}
for name, command in commands.items():
    plan = believed.with_("manoeuvre.command", {"sine": command})
    peaks[name] = plan.plan()["peak_torque_nm"]
    flown = (plan.with_({key: k * (1 + error) for key, k in stiffness.items()}) for error in errors)
    residuals[name] = np.array([one.simulate(log="none").metrics["residual_energy_j"] for one in flown])

# %%
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for name, energy in residuals.items():
    axes.semilogy(100 * errors, energy, label=f"{name}: {peaks[name]:.0f} N m")
axes.set(xlabel="error of the stiffness [%]", ylabel="elastic energy left [J]")
_ = axes.legend()
softer = errors < -0.15
assert (residuals["first twice, second once"][softer] < 0.2 * residuals["both modes once"][softer]).all()

# %% [markdown]
# Hinges that are softer than believed are the worse case. The third plan has a harmonic more than the others, and its peak
# torque is the price of its wide valley. Independent errors of the four hinges are a campaign:

# %%
for name, command in commands.items():
    study = scenario.with_({"manoeuvre.command": {"sine": command}, "uncertain": uncertain})
    energy = flexsc.campaign(study, runs=200)["residual_energy_j"]
    print(
        f"{name:>25}: median {np.median(energy):.1e} J, 95 % of the runs below {np.quantile(energy, 0.95):.1e} J"
    )

# %% [markdown]
# ## Feedback for the rest
#
# `rotation-robust` adds a sampled PD law that takes over when the manoeuvre ends, damping of the panels, and a disturbance at
# 17 s.

# %%
robust = flexsc.Scenario.example("rotation-robust").simulate(log="full")
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.plot(robust["attitude"]["time_s"], 1e3 * (robust["attitude"]["angle_rad"] - np.pi / 2), linewidth=0.9)
axes.set(xlabel="time [s]", ylabel="angle from the target [mrad]", xlim=(11, 50), ylim=(-20, 20))
print(
    "settled", round(robust.metrics["settling_time_s"], 1), "s after the start; goal", robust.metrics["goal"]
)
assert robust.metrics["goal"] == "met"

# %% [markdown]
# ## What to take along
#
# - The plan leaves exactly the modes at rest that it knows. The price is peak torque: look at `compare`.
# - Robustness costs harmonics too. A zero that is doubled helps against a wrong frequency of that mode only: decide by a campaign
#   over what you do not know.
# - Feedback after the turn removes what the plan leaves, within its bandwidth.
#
# Next: [planned rotations](../manoeuvres.md) has all commands, and their [theory](../theory/manoeuvres.md). Input shapers on three
# axes are in the scenario `shaped-slew`.
