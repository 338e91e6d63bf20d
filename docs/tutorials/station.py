# %% [markdown]
# # A station damped by its jets
#
# **The question.** A space station of 400 t has solar wings that ring for minutes after every disturbance. It has no actuator for
# damping, but it has jets that turn it. Can the same jets damp the wings, with pulses of 0.2 s, measured by a gyro in the hub,
# and with a computer that is a cycle late?

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
# ## What decides whether a mode can be damped
#
# A jet pushes against the elastic rate that the gyro measured. Some time passes until it pushes, and it pushes for a whole pulse.
# The phase factor E says what is left of the push: 1 is perfect, 0 useless, and below 0 the jet feeds the mode
# ([active damping](../active-damping.md)).

# %%
frequencies = np.linspace(0.2, 12.0, 60)
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for delay in (0.0, 0.2):
    rows = flexsc.relay_damping(frequencies, 5.9e-5, delay=delay)
    axes.plot(frequencies / (2 * np.pi), rows["phase_factor"], label=f"delay {delay} s")
axes.axhline(0.0, color="grey", linewidth=0.7)
axes.set(xlabel="frequency of the mode [Hz]", ylabel="phase factor E")
_ = axes.legend()

# %% [markdown]
# With a delay of one cycle the factor is negative above 0.83 Hz: there a jet feeds the mode. A predictor of the mode takes the
# delay away, if the frequency is known.
#
# ## Frequencies that are not known
#
# `iss-ringdown` knows its frequencies at the start and follows them by an adaptive observer. `iss-mismatch` is a turn of the same
# station, damped with frequencies that are 20 % too high, nothing identified and the guards of the damping switched off:

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
# Jets that push at the wrong time feed the modes, for 140 kg of propellant. The guards notice that and keep the damping off.
#
# ## The price
#
# Damping costs propellant. Below a threshold of the elastic rate no jet fires.

# %%
thresholds = np.array([1e-5, 2e-5, 5e-5, 1e-4, 2e-4])
key = "law.phase_plane.damping.threshold"
prices = [on_scenario.with_(key, [value] * 3).simulate(log="none").metrics for value in thresholds]
print("threshold [rad/s]   propellant [kg]   time to 1 % [s]")
for value, told in zip(thresholds, prices, strict=True):
    print(f"{value:17.0e}   {told['fuel_kg']:15.2f}   {told['energy_below_1pct_at_s']:15.1f}")
assert prices[-1]["fuel_kg"] < 0.5 * prices[0]["fuel_kg"]

# %% [markdown]
# ## What to take along
#
# - Jets that turn a body can damp it up to a frequency that is set by pulse length and delay, not by their torque.
# - The observer must know the frequency. Identify it in flight, and keep the guards on.
# - The threshold buys time with propellant.
#
# Next: [active damping](../active-damping.md) with its formulas, the theory of [thrusters](../theory/thrusters.md).
