# %% [markdown]
# # Flight code on a processor
#
# **The question.** Does the control system that was studied fly on a Cortex-M4, and does it compute the same? Here the filter and the law of
# `earth-observer` become C99, and an emulated board replays a run.
#
# You need a C compiler and make for the first half, and for the second `arm-none-eabi-gcc` and `qemu-system-arm`; without them the cells say so.

# %%
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import flexsc
import matplotlib.pyplot as plt
import numpy as np

folder = Path(tempfile.mkdtemp())


def terminal(line: str) -> None:
    """Runs a command line and prints the end of what it says."""
    words = shlex.split(line)
    if words[0] == "flexsc":
        words = [sys.executable, "-m", *words]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    said = f"{done.stdout}{done.stderr}".rstrip().splitlines()
    print("\n".join([f"$ {line}", *said[-12:]]))


terminal("flexsc examples earth-observer")
terminal("flexsc simulate earth-observer.toml")

# %% [markdown]
# ## Export
#
# The directory has the code, a driver, a Makefile, two boards, and the inputs and outputs of the calls in a run.

# %%
terminal("flexsc export-c earth-observer.toml -o flight --name aocs --calls 400")
header = (folder / "flight" / "aocs.h").read_text("utf-8")
print(
    "\n".join(line for line in header.splitlines() if line.startswith("void aocs_") or "aocs_step(" in line)
)

# %% [markdown]
# ## This machine
#
# `make check` replays the calls and compares every output by bits, then a million extreme inputs by a hash.

# %%
if shutil.which("make") and shutil.which("gcc"):
    terminal("make -C flight check-gcc LEVELS=-O2")
else:
    print("no gcc or make here: nothing was compared")

# %% [markdown]
# ## A Cortex-M4 under QEMU
#
# The board has no operating system. It needs IEEE doubles; where the processor has none, a library does.

# %%
HAS_BOARD = all(map(shutil.which, ("make", "arm-none-eabi-gcc", "qemu-system-arm")))
if HAS_BOARD:
    terminal("make -C flight check-m4 LEVELS=-O2")
    terminal("make -C flight size")
else:
    print("no arm-none-eabi-gcc or qemu-system-arm here: nothing was compared")

# %% [markdown]
# ## What the board decides
#
# The vectors are the calls of a run, so the torques of the board are those of this figure, to the last bit.

# %%
run = flexsc.Scenario.load(folder / "earth-observer.toml").simulate(log="full")
figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
pointing = run["pointing"]
for axis in ("roll", "pitch", "yaw"):
    axes.plot(pointing["time_s"], 3600 * np.degrees(pointing[f"{axis}_error_rad"]), linewidth=0.9, label=axis)
axes.set(xlabel="time [s]", ylabel="pointing error [arcsec]")
_ = axes.legend()
plt.show()

# %% [markdown]
# ## What is left to write
#
# The code has no clock, no bus and no drivers. [Flight code](../flight-code.md) has the order of the calls in a main loop, and the size and instructions of
# every law; [flight guests](../flight-guests.md) has the same code as an app of cFS and a component of F Prime; [lockstep](../serve.md) runs your
# flight software against the scenario.
