# %% [markdown]
# # A slew that leaves the panels at rest
#
# **The question.** A spacecraft with two long solar panels has to roll by 90° in 12 s. A bang-bang torque is the
# fastest, but leaves the panels oscillating for minutes. Which torque turns the hub by the same angle and leaves the
# panels at rest? How much of this remains if the stiffness of the hinges is known only to 20 %?

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np

scenario = flexsc.Scenario.example("rotation-sine")
modes = scenario.modes
print("natural frequencies [rad/s]:", np.round(modes["frequency"], 3))

# %% [markdown]
# The body is a hub with two panels, each of four hinged sections ([manoeuvres](../manoeuvres.md)). In 12 s the lowest
# mode oscillates six times.
#
# ## Plan the torque
#
# The command `sine` is a series of sines. Its coefficients follow from linear equations: the hub arrives at the target,
# and as many modes as you ask for are exactly at rest. Each suppressed mode costs one harmonic.

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
# ## Simulate the slew
#
# The elastic energy shows what remains after the manoeuvre. The simulation has no step size, so this residual comes
# from the plan and not from an error of integration.

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
# After the grey line the body should be at rest. With two modes suppressed, the residual is in the higher modes.
#
# ## Comparison with other commands
#
# `compare` plans the same slew with the other commands, each in the same time, and gives their residuals.

# %%
print("command                     time   peak torque   outermost section left   at worst with 10 % error")
for row in plans[2].compare():
    swing, worst = (row[key]["section_4"] for key in ("residual_rad", "residual_worst_rad"))
    print(
        f"{row['command']:<26} {row['time_s']:4.1f} s  {row['peak_torque_nm']:7.0f} N m  {swing:14.1e} rad  {worst:18.1e} rad"
    )

# %% [markdown]
# The row `sine p=2` is the plan above: `p` is the number of suppressed modes. `w1²` stands for the first mode with a
# doubled zero of the spectrum (below), and ZV, ZVD and EI are input shapers ([theory](../theory/manoeuvres.md)). The
# last column is the worst residual if all frequencies are off by up to 10 %; if the frequencies are uncertain, it is the
# relevant one. A lower peak torque means more oscillation or less robustness.
#
# ## Wrong frequencies
#
# No hinge has exactly the stiffness of its data sheet. If a zero of the command's spectrum is doubled, the spectrum
# stays low in a wider band around the mode. Make all hinges softer or stiffer than the plan assumes, by the same
# factor, and simulate three plans. The key `manoeuvre.model` is the body assumed by the plan; `body` is the one that is
# simulated.

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
# Each run of a campaign keeps the nominal body as the model of its plan.
model = scenario.with_("uncertain", uncertain).draw(0).to_dict()["manoeuvre"]["model"]
believed = scenario.with_("manoeuvre.model", model)
residuals, peaks = {}, {}
for name, command in commands.items():
    planned = believed.with_("manoeuvre.command", {"sine": command})
    peaks[name] = planned.plan()["peak_torque_nm"]
    flown = (planned.with_({key: k * (1 + error) for key, k in stiffness.items()}) for error in errors)
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
# Hinges softer than assumed are the worse case. The third plan has one harmonic more than the others; its wide valley
# costs a higher peak torque. To vary the four hinges independently, run a campaign:

# %%
for name, command in commands.items():
    study = scenario.with_({"manoeuvre.command": {"sine": command}, "uncertain": uncertain})
    energy = flexsc.campaign(study, runs=200)["residual_energy_j"]
    print(
        f"{name:>25}: median {np.median(energy):.1e} J, 95 % of the runs below {np.quantile(energy, 0.95):.1e} J"
    )

# %% [markdown]
# ## Feedback for the residual
#
# `rotation-robust` adds a sampled PD law that takes over at the end of the manoeuvre, damping of the panels, and a
# disturbance at 17 s.

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
# ## Conclusions
#
# - The plan leaves exactly those modes at rest that it suppresses. The price is peak torque: see `compare`.
# - Robustness also costs harmonics. A doubled zero helps only against a wrong frequency of that mode; decide with a
#   campaign over the uncertain parameters.
# - Feedback after the slew removes the residual of the plan, within its bandwidth.
#
# Next: [planned rotations](../manoeuvres.md) describes all commands, and their [theory](../theory/manoeuvres.md)
# derives them. The scenario `shaped-slew` has input shapers on three axes.
