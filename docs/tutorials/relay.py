# %% [markdown]
# # A relay and its limit cycle
#
# **The question.** The attitude of a spacecraft is held by on-off jets. Such a relay law never comes to rest: the
# spacecraft oscillates across the dead zone indefinitely, and each pulse excites the solar panels. In which limit cycle
# does the spacecraft settle, when does that cycle excite the panels most, and which parameter can be tuned to keep them
# quiet?
#
# You need flexsc and Matplotlib. Everything below takes some seconds.

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np

scenario = flexsc.Scenario.example("relay-fixed")
print(scenario.to_toml())

# %% [markdown]
# The scenario has one axis, two elastic modes and a relay law. Outside the dead zone the law pushes back with the
# strong torque; on the way in it brakes for `k_t` seconds for each second of the push. The study follows
# [Silaev](../references.md), whose torques are divided by the inertia, so they are in rad/s².
#
# ## The limit cycle of the rigid body
#
# Without the modes the cycle has a closed form. `rigid_cycles` also gives the values of `k_t` at which an odd harmonic
# of the cycle coincides with a mode. Avoid these gains.

# %%
theory = flexsc.papers.rigid_cycles(scenario)
for cycle in theory["cycles"]:
    print(
        f"period {cycle['period_s']:.2f} s, thrusters on {cycle['duty']:.0%} of the time, stable: {cycle['stable']}"
    )
for resonance in theory["resonances"]:
    print(resonance)

# %% [markdown]
# ## The limit cycle of the flexible body
#
# A run of 20 000 s takes a few milliseconds, because the motion between two switchings has a closed form and only the
# switchings are computed. `log="full"` also records the motion; `log.period` is how often between the switchings.

# %%
run = scenario.with_("log.period", 0.2).simulate(log="full")
print("switchings:", run.metrics["switchings"])
print("cycle:", run.metrics["cycle_kind"], run.metrics["cycle_period_s"], "s")

# %%
late = run["attitude"]["time_s"] > 19_800
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.plot(1e3 * run["attitude"]["angle_rad"][late], 1e6 * run["rate"]["rate_rad_s"][late], linewidth=0.7)
axes.set(xlabel="angle [mrad]", ylabel="rate [µrad/s]", title="The last 200 s in the phase plane")
axes.axvspan(-0.5, 0.5, alpha=0.1, label="dead zone")
_ = axes.legend()

# %% [markdown]
# The body coasts through the dead zone, is pushed back at its edge, and brakes. A rigid body would coast on a nearly
# straight line; the panels cause the bows in the upper and lower branches.
#
# ## The quietest gain
#
# The envelope is the amplitude of the elastic angle. Sweep `k_t` and look at the mean envelope over the second half of
# each run. A sweep uses all cores, and each row is a separate run.

# %%
table = flexsc.sweep(scenario, "law.relay.k_t", np.linspace(0.28, 0.40, 241))
gains, envelope = table["law.relay.k_t"], table["envelope_late_mean_rad"]
for name, index in (("quietest", np.argmin(envelope)), ("loudest", np.argmax(envelope))):
    print(f"{name}: k_t = {gains[index]:.4f} with {1e6 * envelope[index]:.1f} µrad")

# %%
periodic = np.array(table["cycle_kind"]) == "two-sided"
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.semilogy(gains[periodic], 1e6 * envelope[periodic], ".", markersize=4, label="periodic")
axes.semilogy(gains[~periodic], 1e6 * envelope[~periodic], "x", markersize=3, label="not periodic")
for resonance in theory["resonances"]:
    if 0.28 < resonance["k_t"] < 0.40:
        axes.axvline(resonance["k_t"], color="grey", linewidth=0.7, linestyle=":")
axes.set(xlabel="braking gain k_t", ylabel="mean envelope [µrad]")
_ = axes.legend()
assert envelope[gains < 0.298].min() > 5 * envelope[(gains > 0.33) & (gains < 0.34)].min()
assert periodic[(gains > 0.31) & (gains < 0.34)].mean() > 0.95

# %% [markdown]
# The dotted lines are the two resonances of the rigid cycle in this range: the third harmonic with one mode and the
# fifth with the other. Near them the amplitude of the panels is so large that the cycle is no longer periodic. Further
# away, from 0.31 to 0.34, the cycle is periodic and the envelope falls steadily. Beyond 0.34 the cycle becomes
# irregular again, with a few narrow quiet windows.
#
# ## Tuning in flight
#
# In flight a sweep is not possible, and the modes are not known well enough to compute the gain. The scenario
# `relay-adaptive` changes `k_t` after each window of 500 s by a random search, which keeps a change if it made the
# envelope smaller and stops when nothing improves.

# %%
adaptive = flexsc.Scenario.example("relay-adaptive").simulate()
steps = adaptive["adaptation"]
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(6, 4.5), layout="constrained")
above.step(steps["time_s"] / 1e3, steps["gain"], where="post")
above.set(ylabel="k_t", title="One search")
means = adaptive.metrics["envelope_window_means_rad"]
below.plot(0.5 * np.arange(1, len(means) + 1), 1e6 * means, ".-")
below.set(xlabel="time [1000 s]", ylabel="envelope [µrad]")
print("from", adaptive.metrics["gain_initial"], "to", round(adaptive.metrics["gain_final"], 4))
assert adaptive.metrics["envelope_reduction"] > 2.5

# %% [markdown]
# ## Repeatability
#
# The result of a random search depends on chance. A campaign repeats it with other random numbers and shows how often
# it works.

# %%
campaign = flexsc.campaign(flexsc.Scenario.example("relay-adaptive"), runs=200)
reduction = campaign["envelope_reduction"]
print(
    f"the envelope falls in {np.mean(reduction > 1):.0%} of the runs, by a factor of {np.median(reduction):.1f} in the median"
)
assert np.mean(reduction > 1) > 0.9

# %% [markdown]
# ## Conclusions
#
# - A relay law has a limit cycle, whose odd harmonics must not coincide with a mode. `rigid_cycles` gives the gains to
#   avoid before any simulation.
# - The braking gain sets the period of the cycle, so it is the parameter to tune. A sweep shows its whole range in a
#   second.
# - One run proves nothing about a random search: use a campaign.
#
# Next: change `body.planar.modes[0].frequency` with `scenario.with_(...)` and see the peaks move. The equations are in
# the [theory of the relay](../theory/relay.md), the figures of the paper in [papers](../papers.md).
