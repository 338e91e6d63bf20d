"""Reads logs with Rerun: `pip install rerun-sdk`, then `python check_rerun.py LOG... [--pictures DIR]`.

Each log is checked, converted and verified by Rerun's own command. Every topic must have been decoded by the
schema in the file, what viewers know as what they know: frames as Transform3D, lines of the log as TextLog.

`--pictures` opens each log in Rerun's viewer and keeps a picture of it: on a machine without a screen, in
`xvfb-run -s "-screen 0 1600x1000x24"` with a software Vulkan (Debian: xvfb, mesa-vulkan-drivers).
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

KNOWN = {
    "/tf": {
        "Transform3D:child_frame",
        "Transform3D:parent_frame",
        "Transform3D:quaternion",
        "Transform3D:translation",
    },
    "/log": {"TextLog:level", "TextLog:text"},
    "/scene": {"foxglove.SceneUpdate:message"},
    "/plumes": {"foxglove.SceneUpdate:message"},
}


def rerun(*arguments: str | Path) -> str:
    command = shutil.which("rerun") or str(Path(sys.executable).parent / "rerun")
    done = subprocess.run([command, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"rerun {' '.join(map(str, arguments))}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def components(recording: Path) -> dict[str, set[str]]:
    """The components of each entity, without those that describe the channel."""
    found: dict[str, set[str]] = {}
    for entity, columns in re.findall(
        r" - (/\S*) - data columns: \[(.*)\]", rerun("rrd", "print", recording)
    ):
        of = found.setdefault(entity, set())
        of.update(c for c in columns.split() if not c.startswith(("McapChannel:", "McapSchema:")))
    return {entity: of for entity, of in found.items() if not entity.startswith("/__")}


def check(log: Path, directory: Path) -> None:
    said = rerun("mcap", "check", log)
    assert not re.search(r"^(error|warn)", said, re.MULTILINE), said
    recording = directory / f"{log.stem}.rrd"
    rerun("mcap", "convert", log, "-o", recording)
    assert "without error" in rerun("rrd", "verify", recording)
    found = components(recording)
    for entity, of in found.items():
        expected = KNOWN.get(entity)
        if expected is None:
            [component] = of
            assert re.fullmatch(r"flexsc\.v1\.\w+:message", component), f"{entity}: {of}"
        else:
            assert of == expected, f"{entity}: {of}"
    print(f"{log}: {len(found)} topics, all decoded: good")


# What pictures show of the motion: topic, and fields as Rerun selects them.
PLOTS = {
    "/attitude": ["angle_rad", "rigid_rad"],
    "/modes": ["elastic_rad"],
    "/torque": ["applied_nm"],
    "/envelope": ["envelope_rad"],
    "/estimator": ["frequency_rad_s", "true_frequency_rad_s"],
    "/pointing": ["roll_error_rad", "pitch_error_rad", "yaw_error_rad"],
    "/energy": ["elastic_j"],
    "/jets": ["fuel_kg"],
}


def blueprint(recording: Path) -> Path:
    """Plots of the motion, and the log."""
    import rerun as rr
    import rerun.blueprint as rrb
    from rerun.blueprint.encodings import ComponentSourceKind, VisualizerComponentMapping

    said = rerun("rrd", "print", "-v", recording)
    ends = rrb.TimeRangeBoundary.infinite()
    whole_run = rrb.TimeAxis(view_range=rrb.TimeRange(start=ends, end=ends))
    plots = []
    for topic in PLOTS.keys() & components(recording).keys():
        [component] = components(recording)[topic]
        lines = []
        for field in PLOTS[topic]:
            source = VisualizerComponentMapping(
                "Scalars:scalars",
                ComponentSourceKind.SourceComponent,
                source_component=component,
                selector=f".{field}",
            )
            lines.append(rr.SeriesLines(names=field).visualizer(mappings=[source]))
        plots.append(
            rrb.TimeSeriesView(
                origin=topic, contents=topic, name=topic, overrides={topic: lines}, axis_x=whole_run
            )
        )
    lines_of_log = rrb.TextLogView(origin="/log", name="/log")
    views = rrb.Grid(*sorted(plots, key=lambda plot: str(plot.name)), lines_of_log, grid_columns=2)
    path = recording.with_suffix(".rbl")
    identity = re.search(r'StoreId\(\s*Recording,\s*"([^"]+)"', said)
    assert identity, said[:500]
    rrb.Blueprint(views, collapse_panels=True).save(identity[1], str(path))
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description="Reads logs with Rerun.")
    parser.add_argument("logs", nargs="+", type=Path)
    parser.add_argument("--pictures", type=Path, metavar="DIR")
    arguments = parser.parse_args()
    rerun("analytics", "disable")
    with tempfile.TemporaryDirectory() as directory:
        for log in arguments.logs:
            check(log, Path(directory))
            if arguments.pictures:
                arguments.pictures.mkdir(parents=True, exist_ok=True)
                picture = arguments.pictures / f"{log.stem}.png"
                recording = Path(directory) / f"{log.stem}.rrd"
                size = ("--window-size", "1600x1000", "--bind", "127.0.0.1")
                rerun("--screenshot-to", picture, *size, recording, blueprint(recording))
                print(f"{log}: {picture}")


if __name__ == "__main__":
    main()
