"""Laws as addresses of functions: in C, by numba, by ctypes."""

from __future__ import annotations

import ctypes
import pickle
import shutil
import subprocess
from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from conftest import shipped
from test_parts import SMALL, told

RELAY_IN_C = """
#include <math.h>
void relay(double now, double since, double cause, double angle, double rate,
           double goal_angle, double goal_rate, double *state, double *hold)
{
    const double zone = 5e-4, back = 5e-4 - 1e-4, strong = 4e-5, weak = 1e-6, k_t = 0.31;
    const double labels[] = {2, 3, 4, 5, 6, 7, 8};  /* W0, RACC, RBRK, W+, LACC, LBRK, W- */
    int phase = (int)state[0];
    if (phase == 1 || phase == 4) {
        hold[0] = phase == 1 ? strong : -strong;
        hold[1] = k_t * since;
        state[0] = phase + 1;
        hold[4] = labels[phase + 1];
        return;
    }
    if (phase == 2 || phase == 5 || (phase == 0 && fabs(angle) < zone)) {
        hold[0] = phase == 5 ? -weak : weak;
        hold[2] = zone;
        hold[3] = -zone;
        hold[4] = phase == 0 ? 2 : labels[phase + 1];
        state[0] = phase == 0 ? 3 : phase + 1;
        return;
    }
    int right = cause == 2.0 || (cause == 0.0 && angle > 0.0);
    hold[0] = right ? -strong : strong;
    hold[4] = labels[right ? 1 : 4];
    hold[right ? 3 : 2] = right ? back : -back;
    state[0] = right ? 1 : 4;
}
"""


def test_a_relay_in_c_switches_at_the_same_instants(tmp_path: Path) -> None:
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    (tmp_path / "relay.c").write_text(RELAY_IN_C)
    library = tmp_path / "relay.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-O2", "relay.c", "-o", library], cwd=tmp_path, check=True)
    scenario = shipped("relay-fixed")
    law = flexsc.CompiledLaw(ctypes.CDLL(str(library)).relay, states=[0.0], promise=6e-4, switches=True)
    own = scenario.with_parts(law=law)
    mine, theirs = own.simulate()["command"], scenario.simulate()["command"]
    for column in ("time_s", "time_fs", "state", "angle_rad", "torque_nm"):
        np.testing.assert_array_equal(mine[column], theirs[column])
    np.testing.assert_array_equal(own.simulate()["command"]["time_s"], theirs["time_s"])
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(own)
    with pytest.raises(ValueError, match="address must be the address of a function"):
        scenario.with_parts(law=flexsc.CompiledLaw(0))


def test_numba_makes_laws() -> None:
    numba: Any = pytest.importorskip("numba")
    double, several = numba.types.double, numba.types.CPointer(numba.types.double)

    @numba.cfunc(numba.types.void(*[double] * 7, several, several))
    def damper(now, since, cause, angle, rate, goal_angle, goal_rate, states, hold):  # type: ignore
        hold[0] = -4.0 * angle - 30.0 * rate

    scenario = flexsc.Scenario.parse(SMALL, "own")
    own = scenario.with_parts(law=flexsc.CompiledLaw(damper, period=0.25))
    pd = scenario.with_("law", {"pd": {"k_p": 4.0, "k_d": 30.0, "period": 0.25}})
    np.testing.assert_allclose(told(own), told(pd), rtol=1e-12)


def test_a_compiled_law_that_tells_no_number_ends_the_run() -> None:
    numbers = ctypes.POINTER(ctypes.c_double)
    kind = ctypes.CFUNCTYPE(None, *[ctypes.c_double] * 7, numbers, numbers)

    @kind  # type: ignore[untyped-decorator]
    def wrong(*arguments: Any) -> None:
        arguments[8][0] = float("inf") if arguments[0] > 3.0 else 0.0

    law = flexsc.CompiledLaw(wrong, period=1.0)
    with pytest.raises(RuntimeError, match="gave a torque of inf"):
        flexsc.Scenario.parse(SMALL, "own").with_parts(law=law).simulate()
