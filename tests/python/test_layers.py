"""The layers of the package: each module knows those below, and only drawing is looked up from below."""

import ast
from collections.abc import Iterator
from pathlib import Path

import flexsc

PACKAGE = Path(flexsc.__file__).parent

# From the lowest on.
LAYERS = {
    "engine": "_native _numpy",
    "values": """
        _analysis _answer _arrow _columns _compiled _deprecated _equality
        _fmi_library _handover _html _keys _laws _missing _modes
        _named _one_copy _own_part _part _part_reader _progress _quantities _requirement _roles _run_lock
        _sample_times _signal _signature _surroundings _topic _units _values parts scenario
    """,
    "results": """
        _axes_look _command _controllers _damping _design _drawable _ensemble
        _flight_code _frequency_response _linear _margins
        _model_state _noise _optimisation _plan _read _report _result _review_figures _sampled_loop
        papers results
    """,
    "scenario": """
        _campaign _comparison _copies _executor _log _own_parts_campaign _population _row _scenario
        _sensitivity _simulator _simulators _sources _table _threads
    """,
    "tools": """
        __init__ __main__ _episodes _explore _frequency_figures _stable_baselines _tutorials _vector_env
        basilisk dask gym lockstep plot structure
    """,
}
LAYER = {module: rank for rank, modules in enumerate(LAYERS.values()) for module in modules.split()}
# Results draw themselves by these, which import Matplotlib.
DRAWING = {"_frequency_figures", "plot"}


def imports(tree: ast.AST, within: bool = False) -> Iterator[tuple[str, bool]]:
    """The modules of the package that a tree imports at run time, and whether a function does it."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            for other in node.orelse:
                yield from imports(other, within)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "flexsc":
            parts = (node.module or "").split(".")
            for name in [parts[1]] if len(parts) > 1 else [each.name for each in node.names]:
                yield name, within
        else:
            yield from imports(node, within or isinstance(node, ast.FunctionDef))


def sources() -> Iterator[tuple[str, Path]]:
    for path in PACKAGE.rglob("*.py"):
        inside = path.relative_to(PACKAGE).parts
        if inside[0] != "tutorials":
            yield inside[0].removesuffix(".py"), path


def test_every_module_has_a_layer() -> None:
    assert {module for module, _ in sources()} | {"_native"} == set(LAYER)


def test_a_module_knows_only_layers_below() -> None:
    seen = 0
    for module, path in sources():
        for name, within in imports(ast.parse(path.read_text())):
            allowed = LAYER[name] <= LAYER[module] or (within and name in DRAWING)
            assert allowed, f"{module} imports {name}, which is of a layer above"
            seen += 1
    assert seen > 200
