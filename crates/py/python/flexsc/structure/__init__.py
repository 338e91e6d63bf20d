"""Structures from elsewhere: state-space and assembled matrices, CSV files and Nastran, ready to run.

    >>> model = flexsc.from_state_space(A, B, C)
    >>> scenario = model.scenario(inertia, thrust=130.0, arm=20.0)
    >>> flexsc.structure.write_scenario(scenario, "station.toml")

`python -m flexsc.structure iss.mat --check` does so for a MATLAB file.
"""

from flexsc.structure._clamped import appendage_from_nastran
from flexsc.structure._craig_bampton import appendage_from_craig_bampton
from flexsc.structure._files import from_csv, write_scenario
from flexsc.structure._matrices import appendage_from_matrices
from flexsc.structure._matrix_file import read_matrices
from flexsc.structure._modal_model import StateSpace
from flexsc.structure._nastran import from_nastran
from flexsc.structure._state_space import from_state_space
from flexsc.structure._structure import Structure

__all__ = [
    "StateSpace",
    "Structure",
    "appendage_from_craig_bampton",
    "appendage_from_matrices",
    "appendage_from_nastran",
    "from_csv",
    "from_nastran",
    "from_state_space",
    "read_matrices",
    "write_scenario",
]
