# %% [markdown]
# # A station damped by its jets
#
# **The question.** A space station of 400 t has solar wings that oscillate for minutes after every disturbance. It has
# no actuator for damping, but it has jets for attitude control. Can the same jets damp the wings, with pulses of 0.2 s,
# measurements of a gyro in the hub, and a computer with a delay of one cycle?

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np

off = flexsc.Scenario.example("iss-ringdown-off").simulate(log="full")
on_scenario = flexsc.Scenario.example("iss-ringdown")
on = on_scenario.simulate(log="full")
for name, run in (("undamped", off), ("damped", on)):
    print(f"{name:>8}: below 1 % of the energy after {run.metrics['energy_below_1pct_at_s']:.1f} s")

# %%
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for name, run in (("jets off", off), ("jets damp", on)):
    axes.semilogy(run["energy"]["time_s"], run["energy"]["elastic_j"], linewidth=0.9, label=name)
axes.set(xlabel="time [s]", ylabel="elastic energy [J]", xlim=(0, 300), ylim=(1e-3, 10))
_ = axes.legend()
assert on.metrics["energy_below_1pct_at_s"] < 0.2 * off.metrics["energy_below_1pct_at_s"]

# %% [markdown]
# The damped curve ends its steep fall where the elastic rate is below the threshold of the damping. The peak at 189 s
# comes from the attitude control, which fires at the edge of its dead zone and excites the wings again.
#
# ## Which modes can be damped
#
# A jet acts against the elastic rate measured by the gyro. It starts after a delay, and it acts for a whole pulse. The
# phase factor E gives the remaining effect of the pulse: 1 is ideal, 0 has no effect, and below 0 the jet excites the
# mode ([active damping](../active-damping.md)).

# %%
frequencies = np.linspace(0.2, 12.0, 60)
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for delay in (0.0, 0.2):
    rows = flexsc.papers.relay_damping(frequencies, 5.9e-5, delay=delay)
    axes.plot(frequencies / (2 * np.pi), rows["phase_factor"], label=f"delay {delay} s")
axes.axhline(0.0, color="grey", linewidth=0.7)
axes.set(xlabel="frequency of the mode [Hz]", ylabel="phase factor E")
_ = axes.legend()

# %% [markdown]
# With a delay of one cycle the factor is negative above 0.83 Hz: there a jet excites the mode. A predictor of the mode
# compensates the delay if the frequency is known.
#
# ## Unknown frequencies
#
# `iss-ringdown` starts with known frequencies and tracks them with an adaptive observer. `iss-mismatch` is a slew of
# the same station. Its damping uses frequencies that are 20 % too high, without identification and with the guards of
# the damping switched off:

# %%
mismatch = flexsc.Scenario.example("iss-mismatch")
guarded = mismatch.with_("law.phase_plane.damping.guards", {})
turn = flexsc.Scenario.example("iss-manoeuvre")
for name, study in {
    "frequencies 20 % off, no guards": mismatch,
    "frequencies 20 % off, guards": guarded,
    "frequencies identified": turn,
}.items():
    told = study.simulate(log="none").metrics
    print(f"{name:>32}: {told['fuel_kg']:6.1f} kg, {told['elastic_energy_end_j']:8.4f} J at the end")

# %% [markdown]
# Jets that fire at the wrong time excite the modes and use 140 kg of propellant. The guards detect this and keep the
# damping off.
#
# ## The price
#
# Damping uses propellant. Below a threshold of the elastic rate no jet fires.

# %%
thresholds = np.array([1e-5, 2e-5, 5e-5, 1e-4, 2e-4])
key = "law.phase_plane.damping.threshold"
prices = [on_scenario.with_(key, [value] * 3).simulate(log="none").metrics for value in thresholds]
print("threshold [rad/s]   propellant [kg]   time to 1 % [s]")
for value, told in zip(thresholds, prices, strict=True):
    print(f"{value:17.0e}   {told['fuel_kg']:15.2f}   {told['energy_below_1pct_at_s']:15.1f}")
assert prices[-1]["fuel_kg"] < 0.5 * prices[0]["fuel_kg"]

# %% [markdown]
# ## Conclusions
#
# - Attitude-control jets can damp modes up to a frequency that is set by pulse length and delay, not by their torque.
# - The observer needs the correct frequency. Identify it in flight, and keep the guards on.
# - The threshold trades damping time against propellant.
#
# Next: [active damping](../active-damping.md) has the formulas, and the theory of [thrusters](../theory/thrusters.md)
# explains them.
