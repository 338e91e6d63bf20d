# %% [markdown]
# # Will my picture be sharp?
#
# **The question.** A telescope takes exposures of 20 ms with pixels of 0.2 arcsec. Its reaction wheels are slightly out of
# balance, and shake it at their speed. At which speeds is the picture blurred, and does a fine mirror help?
#
# ## The telescope
#
# A finite-element program gives the modes of the telescope, clamped at its foot. With CalculiX, the key
# `modes = "telescope.frd"` reads frequencies, participations and the shapes at named points from its results, with the deck
# beside them; [import](../import.md) has other programs. To keep this page complete, three modes stand here as such
# a file gives them.

# %%
import flexsc
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt

Vector = list[float]


def mode(
    hertz: float, translation: Vector, rotation: Vector, shift: Vector, turn: Vector
) -> dict[str, object]:
    """One clamped mode: participations, and the motion of the secondary mirror; the primary sits at the foot."""
    shapes = {"primary": {}, "secondary": {"translation": shift, "rotation": turn}}
    return {
        "frequency": f"{hertz} Hz",
        "damping": 0.004,
        "translation": translation,
        "rotation": rotation,
        "shapes": shapes,
    }


telescope = {
    "name": "telescope",
    "mass": 18.0,
    "centre": [0, 0, 0.30],
    "inertia": [[0.92, 0, 0], [0, 0.92, 0], [0, 0, 0.31]],
    "at": [0, 0, 0.35],
    "points": [{"name": "primary", "position": [0, 0, 0.05]}, {"name": "secondary", "position": [0, 0, 0.6]}],
    "modes": [
        mode(62, [3.1, 0, 0], [0, 1.10, 0], [0.31, 0, 0], [0, 0.74, 0]),
        mode(88, [0, 2.9, 0.2], [-1.02, 0, 0.03], [0, 0.29, 0.01], [-0.68, 0, 0.01]),
        mode(140, [0.2, -0.1, 2.6], [0.04, 0.01, 0.15], [-0.03, 0.02, 0.28], [0.03, -0.1, 0.01]),
    ],
}

# %% [markdown]
# ## The line of sight
#
# Where the telescope looks depends on both mirrors: `rotation` says how far the line of sight turns with each, about x and y,
# and `translation` how far a displacement of 1 m turns it. Two checks find wrong signs. A displacement of the whole telescope must
# not turn the line, so that translations sum to zero, or the scenario is refused. A rotation of the whole body must turn it by as much,
# or `flexsc check` has a remark: 2 - 1 from the mirrors' rotations, and nothing from their distance, if it is folded into the secondary's.

# %%
distance = 0.55  # m, from mirror to mirror
pull = 1.6  # rad/m
primary = {
    "point": "primary",
    "rotation": [[2, 0, 0], [0, 2, 0]],
    "translation": [[0, -pull, 0], [pull, 0, 0]],
}
secondary = {
    "point": "secondary",
    "rotation": [[-1 + pull * distance, 0, 0], [0, -1 + pull * distance, 0]],
    "translation": [[0, pull, 0], [-pull, 0, 0]],
}
wheels = {
    "arrangement": "orthogonal",
    "inertia": 1.6e-3,
    "torque": 0.02,
    "speed_limit": 630.0,
    "imbalance": {
        "static": 3.6e-6,
        "dynamic": 1.2e-7,
        "positions": [[0.12, -0.05, -0.18], [-0.12, -0.05, -0.18], [0, 0.12, -0.18]],
        "harmonics": [{"order": 2.0, "force": 4e-7}],
    },
}
scenario = flexsc.Scenario(
    {
        "name": "telescope",
        "duration": 20.0,
        "spacecraft": {"mass": 62.0, "inertia": [[4.2, 0, 0], [0, 3.9, 0], [0, 0, 4.8]]},
        "appendage": [telescope],
        "line_of_sight": [{"point": "secondary", "period": 0.005, "optics": [primary, secondary]}],
        "sensor": [
            {"gyro": {"period": 0.1, "angle_random_walk": 1e-6, "rate_random_walk": 1e-9}},
            {"star_tracker": {"period": 0.1, "latency": 0.1, "exposure": 0.1, "noise": [1e-5, 1e-5, 1e-5]}},
        ],
        "estimator": {"attitude": {}},
        "law": {"attitude": {"period": 0.1, "bandwidth": 0.5}},
        "actuator": {"wheels": wheels},
    }
)
print(f"hub free: {np.round(scenario.modes['frequency'] / (2 * np.pi), 1)} Hz")

# %% [markdown]
# ## What the wheels do to a picture
#
# `spectrum` computes the lines of all wheels over their speed, without a simulation: at the speed, at each harmonic, and at the aliases that
# the sampled law makes of them. Of a picture, only the motion within its exposure counts (RPE); what is slower displaces it. The contrast
# that is left at the finest detail of the detector is the MTF at the Nyquist frequency of the pixels: 1 is perfect, and where it is
# negative, light and dark have changed places.

# %%
arcsec = float(np.radians(1 / 3600))
pixel = 0.2 * arcsec
hertz = np.linspace(5.0, 100.0, 96)


def spectrum(craft: flexsc.Scenario) -> flexsc.NoiseSpectrum:
    """Noise, and the lines of the wheels over their speed."""
    return craft.spectrum(window=0.02, pixel=pixel, speeds=2 * np.pi * hertz)


def contrast(found: flexsc.NoiseSpectrum) -> npt.NDArray[np.float64]:
    """The lower contrast of both axes, over the speed of the wheels."""
    assert found.wheels is not None and found.wheels.mtf is not None
    x, y = (found.wheels.mtf[f"line_of_sight0_{axis}"] for axis in "xy")
    return np.asarray(np.minimum(x, y))


def print_contrast(found: flexsc.NoiseSpectrum) -> None:
    """Print the least and the usual contrast."""
    all_speeds = contrast(found)
    worst = hertz[all_speeds.argmin()]
    print(f"contrast: {all_speeds.min():.3f} at {worst:.1f} Hz, median {np.median(all_speeds):.3f}")


bare = spectrum(scenario)
print_contrast(bare)

# %% [markdown]
# The blur is not at the largest speed but where the wheel, or its second harmonic, meets a mode with the hub free.
#
# ## A fine mirror
#
# A mirror in the beam follows what a guidance sensor sees: 1 ms after each exposure of 1 ms, the command changes by a quarter of its mean error.

# %%
mirror = {"frequency": "300 Hz", "damping": 0.6, "period": "1 ms", "gain": 0.25, "noise": 2e-8}
stabilised = scenario.with_("line_of_sight[0].mirror", mirror)
behind = spectrum(stabilised)
own = behind.mirrors[0]
print(f"worse above {own.crossing_hz:.1f} Hz, at most {own.peak:.2f} times at {own.peak_hz:.0f} Hz")
print_contrast(behind)

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5))
above.plot(hertz, contrast(bare), label="without a mirror")
above.plot(hertz, contrast(behind), label="behind the mirror")
above.set(xlabel="speed of the wheels [Hz]", ylabel="contrast (MTF)")
above.legend()
below.loglog(own.frequency_hz, own.sensitivity)
below.axhline(1.0, color="grey", lw=0.8)
below.set(xlabel="frequency [Hz]", ylabel="behind / before")
figure.tight_layout()

# %% [markdown]
# The mirror is worse than none for what is faster than its crossing, and these modes are. It is for slow motion: it nearly removes the noise
# of the attitude loop. A faster guidance sensor moves the crossing up.

# %%
for outcome, found in (("without a mirror", bare), ("behind the mirror", behind)):
    print(f"{outcome}: {found.outputs['line_of_sight0_x'].rms / arcsec:.4f} arcsec rms of noise")
for period, gain in [("1 ms", 0.25), ("1 ms", 0.1), ("0.5 ms", 0.25)]:
    other = stabilised.with_({"line_of_sight[0].mirror.period": period, "line_of_sight[0].mirror.gain": gain})
    found = spectrum(other)
    own = found.mirrors[0]
    sharp = (contrast(found) > 0.9).mean()
    print(
        f"{period}, gain {gain}: crossing {own.crossing_hz:.0f} Hz, peak {own.peak:.2f}, sharp at {sharp:.0%}"
    )

# %% [markdown]
# ## The answer
#
# The picture is sharp but where the wheels meet the modes: `speed_bias` keeps them away. The mirror costs contrast at high speeds, and buys an image that
# stays in its place from exposure to exposure.

# %%
for outcome, found in (("without a mirror", bare), ("behind the mirror", behind)):
    good = contrast(found) > 0.9
    edges = hertz[np.flatnonzero(good[1:] != good[:-1])]
    print(
        f"{outcome}: contrast above 0.9 at {good.mean():.0%} of the speeds, crossed at {np.round(edges, 1)} Hz"
    )

# %% [markdown]
# Next: a [requirement](../scenario/targets.md#requirement) on the RPE and its [budget](budget.md), and [what else shakes](../noise.md).
