"""What readers type into the search for a page that has other words.

A synonym becomes a tag of the page or of the section: the search finds tags first.
"""

from __future__ import annotations

from typing import Any

# Addresses of pages and sections, with the words for them.
SYNONYMS = {
    "flight-code.html": "STM32 Cortex-M embedded microcontroller onboard code generation",
    "noise.html#lines-of-wheels": "waterfall Campbell diagram jitter of wheels",
    "campaigns.html": "percentile Monte Carlo dispersion confidence",
    "serve.html": "ROS hardware in the loop HIL SIL software in the loop",
    "scenario/environment.html": "RAAN LTAN orbit altitude sun-synchronous",
    "read-metrics.html#warnings": "wheel saturation full wheels",
    "other-programs.html": "compare two runs diff export interface",
    "data-sheets.html": "CubeSat panel mass size parts",
    "tutorials/cubesat.html": "CubeSat nanosatellite smallsat",
    "own-parts.html": "own law custom controller plugin",
    "linear-models.html#margins": "Bode Nichols Nyquist gain margin phase margin root locus",
    "import.html": "Nastran CalculiX Abaqus FEM finite element mesh",
    "fmi.html": "Simulink FMU Modelica co-simulation",
    "stepping.html": "reinforcement learning gym agent",
    "viewers.html": "3D animation Foxglove Rerun",
    "install.html": "pip download setup",
    "figures.html#a-page-for-a-design-review": "design review report PDF HTML",
    "validity.html": "limitations accuracy verification validation",
    "scenario/actuators.html": "RCS CMG torque rods",
    "scenario/sensors.html": "star tracker gyro IMU magnetometer Sun sensor",
    "scenario/modes.html": "state machine safe mode",
}


def add_synonyms(entries: list[dict[str, Any]]) -> None:
    """Adds the synonyms to the entries of the index.

    Raises:
        SystemExit: A page or a section is not there.
    """
    by_place = {entry["location"]: entry for entry in entries}
    for place, words in SYNONYMS.items():
        if place not in by_place:
            raise SystemExit(f"site/search.py: there is no {place}")
        by_place[place]["tags"] = [words]
