# %% [markdown]
# # A law of your own
#
# **The question.** Is your control law better than the one that flexsc has? Both fly the same plant with the same noise, first
# about one axis, then about three.
#
# ## One axis
#
# `wheel-ekf` turns a body with falling natural frequencies through a wheel that acts every 4.5 s, on the estimates of a Kalman filter. Its law
# is proportional-derivative feedback with an extra loop, whose gain follows the estimated frequency of the dominant mode. Your law is the feedback
# alone. It is called at its samples; between them the motion is exact.

# %%
import time

import flexsc
import matplotlib.pyplot as plt
import numpy as np


class Pd(flexsc.Law):
    """Proportional and derivative feedback of the angle."""

    period = 4.5  # s
    error = 0.0

    def __init__(self, k_p: float, k_d: float) -> None:
        self.k_p, self.k_d = k_p, k_d
        self.signals = {"error": "rad"}  # a column of the log

    def decide(self, event: flexsc.parts.Event) -> flexsc.Hold:
        self.error = event.angle - event.goal_angle
        return flexsc.Hold(-self.k_p * self.error - self.k_d * (event.rate - event.goal_rate))


theirs = flexsc.Scenario.example("wheel-ekf")
gains = theirs.get("law.pd")
yours = theirs.with_parts(law=Pd(gains["k_p"], gains["k_d"]))
both = {"flexsc's law": theirs, "your law": yours}
runs = {}
for name, scenario in both.items():
    began = time.perf_counter()
    runs[name] = scenario.simulate(log="full")
    print(f"{name}: {runs[name].answer.verdict_text}, in {time.perf_counter() - began:.2f} s")

# %% [markdown]
# ## Side by side
#
# Columns are NumPy arrays.

# %%
figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
for name, run in runs.items():
    rows = run["attitude"]
    axes.plot(rows["time_s"], np.degrees(rows["angle_rad"]), linewidth=0.9, label=name)
axes.set(xlabel="time [s]", ylabel="angle [deg]")
_ = axes.legend()
plt.show()

# %% [markdown]
# ## How often
#
# `campaign` flies both laws with the same noise: that of run 7 of one is that of run 7 of the other.

# %%
for name, scenario in both.items():
    settled = np.asarray(flexsc.campaign(scenario, runs=30)["settling_time_s"], float)
    print(
        f"{name}: settles in {np.nanmedian(settled):.0f} s in the median, {np.nanmax(settled):.0f} s in the worst of 30 runs"
    )

# %% [markdown]
# ## Three axes
#
# A `ThreeAxisLaw` gets quaternion, rates and the reference of a slew, as an attitude filter knows them from gyro and star tracker, and returns
# angular accelerations. The wheels of `earth-observer` give them. The law below slides along a plane of errors.


# %%
class Sliding(flexsc.ThreeAxisLaw):
    """Sliding mode with a boundary layer."""

    period = 0.25

    def decide(self, event: flexsc.parts.ThreeAxisEvent) -> flexsc.ThreeAxisHold:
        w, *axis = event.quaternion
        surface = np.subtract(event.rates, event.goal_rates) + 0.2 * np.sign(w) * np.array(axis)
        feedback = -3e-4 * np.clip(surface / 1e-3, -1.0, 1.0)
        return flexsc.ThreeAxisHold(accelerations=feedback + event.goal_accelerations)


observer = flexsc.Scenario.example("earth-observer")
three = {
    "flexsc's law": observer.simulate(log="full"),
    "your law": observer.with_parts(law=Sliding()).simulate(log="full"),
}
figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
for name, run in three.items():
    rows = run["pointing"]
    error = np.sqrt(sum(np.square(rows[f"{axis}_error_rad"]) for axis in ("roll", "pitch", "yaw")))
    axes.semilogy(rows["time_s"], np.degrees(error) * 3600, linewidth=0.9, label=name)
    print(f"{name}: {run.answer.verdict_text}")
axes.set(xlabel="time [s]", ylabel="pointing error [arcsec]")
_ = axes.legend()
plt.show()

# %% [markdown]
# ## Conclusions
#
# - A law is a class with a period and `decide`. Campaigns, figures and exports of runs take it like a law of the engine.
# - The same holds for [sensors, estimators, actuators and adaptations](../own-parts.md), and for one mode of operation alone:
#   `with_parts(law={"point": Sliding()})`.
# - What is fast in Python may be written in Rust later: [extending](../extending.md).
