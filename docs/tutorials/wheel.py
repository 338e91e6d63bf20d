# %% [markdown]
# # A wheel loop with falling frequencies
#
# **The question.** A flywheel controls a spacecraft whose panels track the Sun. As the panels turn, all elastic
# frequencies fall to a third within 200 s. A gain that suits the initial frequency is wrong for the final one. How can
# the gain follow the frequency if it is not measured?
#
# The loop is sampled at 4.5 s, the wheel has back-EMF, and an extra loop feeds back the dominant mode ([sampled
# loops](../sampled-loops.md)).

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

fixed = flexsc.Scenario.example("wheel-fixed-gain")
run = fixed.simulate(log="full")
print("settled after", round(run.metrics["settling_time_s"], 1), "s")


def draw_angle(axes: Axes, result: flexsc.Result, label: str) -> None:
    """Draw the pointing error of a run."""
    axes.plot(result["attitude"]["time_s"], 1e3 * result["attitude"]["angle_rad"], linewidth=0.9, label=label)


figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
draw_angle(axes, run, "constant gain")
axes.set(xlabel="time [s]", ylabel="angle [mrad]")
_ = axes.legend()

# %% [markdown]
# ## The region of suitable gains
#
# For each frequency of the dominant mode, `gain_region` closes the sampled loop with every gain and keeps the gains
# that are stable and settle in time. The loop is linear between its samples, so each cell is one propagation with exact
# matrices.

# %%
frequencies = np.linspace(0.10, 0.36, 27)
region = flexsc.papers.gain_region(fixed, frequencies)
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.fill_between(
    frequencies, region["gain_min"], region["gain_max"], alpha=0.3, label="stable, settles within 200 s"
)
axes.plot(frequencies, region["midpoint"], label="midpoint")
axes.axhline(1.2, color="grey", linestyle=":", label="the constant gain")
axes.set(xlabel="frequency of the dominant mode [rad/s]", ylabel="gain of the extra loop")
_ = axes.legend()
suits = frequencies[(region["gain_min"] < 1.2) & (region["gain_max"] > 1.2)]
print(f"1.2 settles in time from {suits.min():.2f} to {suits.max():.2f} rad/s")
assert suits.min() > 0.1

# %% [markdown]
# The constant gain leaves the region as the frequency falls. The midpoint of the region can serve as a schedule.
#
# ## Schedule the gain

# %%
inside = np.isfinite(region["midpoint"])
schedule = [
    {"frequency": float(frequency), "gain": float(gain)}
    for frequency, gain in zip(frequencies[inside], region["midpoint"][inside], strict=True)
]
scheduled = fixed.with_("law.pd.extra", {"schedule": schedule})
follows = scheduled.simulate(log="full")
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
draw_angle(axes, run, "constant gain")
draw_angle(axes, follows, "schedule")
axes.set(xlabel="time [s]", ylabel="angle [mrad]")
axes.legend()
print("settled after", round(follows.metrics["settling_time_s"], 1), "s")
assert follows.metrics["settling_time_s"] < 0.7 * run.metrics["settling_time_s"]

# %% [markdown]
# ## Estimate the frequency
#
# So far the law used the true frequency. The scenario `wheel-ekf` measures only a noisy angle. An extended Kalman
# filter estimates the modes and one ratio that scales all their frequencies, and the schedule uses the estimate. Put
# the schedule above into this scenario.

# %%
filtered = flexsc.Scenario.example("wheel-ekf").with_("law.pd.extra", {"schedule": schedule})
estimated = filtered.simulate(log="full")
filter_rows = estimated["estimator"]
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.plot(
    filter_rows["time_s"], filter_rows["true_frequency_rad_s"], color="black", linewidth=0.9, label="true"
)
axes.plot(
    filter_rows["time_s"], filter_rows["frequency_rad_s"], linewidth=0.9, linestyle="--", label="estimated"
)
axes.set(xlabel="time [s]", ylabel="dominant mode [rad/s]")
axes.legend()
print("settled after", round(estimated.metrics["settling_time_s"], 1), "s")
print("error of the frequency:", round(estimated.metrics["frequency_error_rms_rad_s"], 4), "rad/s rms")
print("mean NIS:", round(estimated.metrics["nis_mean"], 3), "(1 is consistent)")
assert 0.9 < estimated.metrics["nis_mean"] < 1.2

# %% [markdown]
# ## How certain is the result?
#
# Each run of a campaign draws other noise and another initial error of the filter.

# %%
table = flexsc.campaign(filtered, runs=200)
settled = table["settling_time_s"]
print(
    f"settled: {np.nanmin(settled):.0f} to {np.nanmax(settled):.0f} s, not at all: {np.isnan(settled).sum()} of 200"
)
print("filters that lost lock:", int(np.sum(table["lock_lost"] > 0)))

# %% [markdown]
# A filter that loses lock reports it: its innovations are then much larger than its covariance predicts. A prior with
# frequencies that are wrong by a half always causes loss of lock:

# %%
wrong = filtered.with_("estimator.extended_kalman.ratio", 1.5).simulate()
print("lock lost:", wrong.metrics["lock_lost"], " mean NIS:", round(wrong.metrics["nis_mean"]))
assert wrong.metrics["lock_lost"] == 1 and wrong.metrics["nis_mean"] > 100

# %% [markdown]
# The PD law still settles the angle here, so the pointing error alone would not have shown that the filter had lost
# lock.
#
# ## Conclusions
#
# - A sampled loop that works for one frequency can be unstable or slow for another: compute the region first.
# - The midpoint of the region is a schedule with margin on both sides; `robust_gains` finds a schedule for uncertain
#   bodies.
# - A filter in the loop must be consistent. Check the NIS, not only the pointing error.
#
# Next: [sampled loops](../sampled-loops.md), the theory of [filters](../theory/filters.md).
