"""The gallery: pictures that the build draws, each from a scenario by commands that are shown beside it.

`python3 site/gallery.py` draws `docs/images/cubesat.svg`, the picture of the README, anew.
"""

from __future__ import annotations

import hashlib
import html
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
SCENARIOS = ROOT / "scenarios"
CUBESAT = "cubesat-day"
# The picture of the README, in docs/.
README = "images/cubesat.svg"
COMMAND = shutil.which("flexsc", path=str(Path(sys.executable).parent)) or shutil.which("flexsc") or "flexsc"
# Verbs that draw, and how they draw for a tile.
DRAWING = ("plot", "margins", "spectrum", "worst", "budget", "map", "plan")
FOR_A_TILE = ("--width", "66", "--font", "6")
# SHA-256 of the log of each scenario, once its pictures are drawn.
SHA256: dict[str, str] = {}
# The drawing of the spacecraft, in a page of `flexsc report`.
DRAWN = re.compile(r'<svg [^>]*aria-label="the spacecraft.*?</svg>', re.DOTALL)


class Tile(NamedTuple):
    """One picture: title, scenario, the commands that draw it, the file they write, the page about it."""

    title: str
    scenario: str
    commands: tuple[str, ...]
    picture: str
    page: str
    # A page that the commands write too and that the picture opens; empty for the picture itself.
    opens: str = ""

    @property
    def name(self) -> str:
        """Name of the picture's file, without its ending."""
        stem = Path(self.picture).stem
        return stem if stem.startswith(self.scenario) else f"{self.scenario}-{stem}"


def figure(title: str, scenario: str, what: str, page: str, options: str = "") -> Tile:
    """A figure of a full log."""
    plot = f"flexsc plot {scenario}.mcap --what {what}{options}"
    return Tile(
        title, scenario, (f"flexsc simulate {scenario}.toml --log full", plot), f"{scenario}-{what}.svg", page
    )


def explorer(title: str, scenario: str, command: str, what: str, metric: str) -> Tile:
    """A page that explores the directory `runs` of a command, behind a figure of it."""
    commands = (
        command,
        f"flexsc plot runs --what {what} --metric {metric}",
        "flexsc plot runs -o explorer.html",
    )
    return Tile(
        title,
        scenario,
        commands,
        f"runs/{scenario}-{what}-{metric}.svg",
        "figures.md#campaigns",
        "explorer.html",
    )


def analysis(title: str, scenario: str, command: str, what: str, page: str) -> Tile:
    """A figure of a verb, `VERB OPTIONS`, that analyses a scenario."""
    verb, _, options = command.partition(" ")
    line = " ".join(filter(None, ("flexsc", verb, f"{scenario}.toml", options, "-o .")))
    return Tile(title, scenario, (line,), f"{scenario}-{what}.svg", page)


TILES = [
    figure("A day in orbit, with a failed star tracker", "cubesat-day", "pointing", "scenario/modes.md"),
    Tile(
        "A CubeSat, drawn from its scenario",
        "cubesat-day",
        ("flexsc report cubesat-day.toml --runs 0 -o review.html",),
        "review.html",
        "figures.md#a-page-for-a-design-review",
    ),
    figure("A slew of 54 degrees", "earth-observer", "pointing", "scenario/targets.md"),
    analysis(
        "Margins of three loops, and a mask that they keep",
        "earth-observer",
        "margins --mask '6 dB, 30 deg' --what nichols",
        "nichols",
        "linear-models.md#margins",
    ),
    analysis(
        "Lines of unbalanced wheels through the modes",
        "wheel-run-up",
        "spectrum --speeds 30:115:86",
        "waterfall_pitch",
        "noise.md#lines-of-wheels",
    ),
    Tile(
        "200 runs against a limit",
        "half-turn",
        (
            "flexsc simulate half-turn.toml --runs 200 -o runs",
            "flexsc plot runs --what distribution --metric 'requirement_values[0]'",
        ),
        "runs/half-turn-distribution-pointing.svg",
        "campaigns.md",
    ),
    analysis("The worst case, found", "half-turn", "worst", "worst", "campaigns.md#worst-cases"),
    analysis(
        "A pointing budget",
        "slew-wheel-lqg",
        "budget --runs 60",
        "budget-stability",
        "campaigns.md#pointing-budgets",
    ),
    figure("Phase plane of a relay", "relay-adaptive", "phase-plane", "theory/relay.md"),
    explorer(
        "A sweep to explore: drag over points",
        "earth-observer",
        "flexsc sweep earth-observer.toml --vary law.attitude.bandwidth=0.05:0.3:12 "
        "--vary law.attitude.damping=0.4:1.2:9 -o runs",
        "region",
        "pointing_error_end_rad",
    ),
    figure("A gain that learns to keep the panels quiet", "relay-adaptive", "gain", "scenario/adaptation.md"),
    explorer(
        "A campaign to explore: drag over points",
        "half-turn",
        "flexsc simulate half-turn.toml --runs 200 -o runs",
        "scatter",
        "pointing_rms_rad",
    ),
    Tile(
        "Where it is quiet: a map over two keys",
        "relay-fixed",
        (
            "flexsc sweep relay-fixed.toml --vary law.relay.k_t=0.28:0.40:61 "
            "--vary law.relay.weak=5e-7:2e-6:31 -o sweep",
            "flexsc plot sweep --metric envelope_late_mean_rad",
        ),
        "sweep/relay-fixed-region-envelope_late_mean_rad.svg",
        "campaigns.md",
    ),
    Tile(
        "A band of instability",
        "wheel-unstable-band",
        ("flexsc map wheel-unstable-band.toml --frequency 0.05:0.2:31 --period 5:20:16 --figures .",),
        "wheel-unstable-band-map.svg",
        "sampled-loops.md#stability-map",
    ),
    analysis(
        "A plan that leaves the modes at rest", "rotation-robust", "plan", "plan-torque", "manoeuvres.md"
    ),
    analysis(
        "Poles of a loop as its gain grows",
        "earth-observer",
        "margins --what root-locus",
        "root-locus",
        "linear-models.md#margins",
    ),
    figure("Solar wings ring down, damped by jets", "iss-ringdown", "energy", "active-damping.md"),
    figure("Frequencies identified in flight", "iss-manoeuvre", "tracking", "theory/adaptive-observers.md"),
    figure("A star tracker blinded by the Sun", "blinded-tracker", "consistency", "scenario/sensors.md"),
    figure("Wheels of a camera that follows a ground site", "site-pass", "wheel", "scenario/targets.md"),
    figure("Control moment gyros turn a spacecraft", "agile-observer", "gimbals", "scenario/actuators.md"),
    figure("Panels that unfold", "panel-deployment", "hinges", "scenario/spacecraft.md"),
    figure("Panels that follow the Sun over an orbit", "sun-tracking", "drives", "scenario/spacecraft.md"),
    figure("Magnetorquers stop a tumble", "detumble-and-point", "magnetorquers", "theory/magnetic.md"),
]


def run(command: str, folder: Path) -> None:
    """Runs a command, drawing for a tile. Exit code 3 is a requirement that is not met."""
    words = shlex.split(command)
    is_page = words[-1].endswith(".html")
    if words[1] in DRAWING and not is_page:
        words += FOR_A_TILE
    if words[1] in ("plot", "worst", "budget") and not is_page:
        words += ("--format", "svg")
    done = subprocess.run([COMMAND, *words[1:]], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        raise SystemExit(f"{command}\n{done.stderr}")


def folder_pictures(scenario: str) -> dict[str, str]:
    """The pictures of all tiles of a scenario, by their paths on the site; with the README's."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copyfile(SCENARIOS / f"{scenario}.toml", folder / f"{scenario}.toml")
        own = [tile for tile in TILES if tile.scenario == scenario]
        for command in dict.fromkeys(command for tile in own for command in tile.commands):
            run(command, folder)
        made = {}
        for tile in own:
            path = folder / tile.picture
            if not path.is_file():
                files = sorted(str(other.relative_to(folder)) for other in folder.rglob("*.*"))
                raise SystemExit(f"{tile.title}: {tile.picture} is not made, but {files}")
            text = path.read_text("utf-8")
            if tile.opens:
                made[f"gallery/{tile.name}.html"] = (folder / tile.opens).read_text("utf-8")
            made[f"gallery/{tile.name}.svg"] = DRAWN.findall(text)[0] if path.suffix == ".html" else text
        if scenario == CUBESAT:
            plot = f"flexsc plot {CUBESAT}.mcap --what pointing --format svg -o wide"
            subprocess.run([COMMAND, *plot.split()[1:]], cwd=folder, capture_output=True, check=True)
            wide = (folder / f"wide/{CUBESAT}-pointing.svg").read_text("utf-8")
            made[README] = side_by_side(made[f"gallery/{CUBESAT}-review.svg"], wide)
        # The log of the command alone, which the playground compares with its own.
        simulate = ("simulate", f"{scenario}.toml", "-o", "events")
        subprocess.run([COMMAND, *simulate], cwd=folder, capture_output=True, check=False)
        SHA256[scenario] = hashlib.sha256((folder / f"events/{scenario}.mcap").read_bytes()).hexdigest()
    return made


def known() -> dict[str, dict[str, str]]:
    """The title of each scenario of the gallery, and the SHA-256 of the log that the command writes of it."""
    titles = {tile.scenario: tile.title for tile in reversed(TILES)}
    return {
        name: {"title": titles[name], "sha256": SHA256[name]}
        for name in dict.fromkeys(t.scenario for t in TILES)
    }


def pictures() -> dict[str, str]:
    """The pictures of all tiles, and that of the README, by their paths on the site."""
    with ThreadPoolExecutor(2) as pool:
        folders = list(pool.map(folder_pictures, dict.fromkeys(tile.scenario for tile in TILES)))
    return {path: svg for folder in folders for path, svg in folder.items()}


def page(playground: bool) -> str:
    """The gallery as HTML: under each picture its title, its scenario, its commands and where to go."""
    made = []
    for tile in TILES:
        commands = html.escape("\n".join(tile.commands))
        links = [f'<a href="examples/{tile.scenario}.html">{tile.scenario}</a>']
        if playground:
            links.append(f'<a href="playground.html#{tile.scenario}">open</a>')
        path, _, anchor = tile.page.partition("#")
        page_of = path.replace(".md", ".html") + (f"#{anchor}" if anchor else "")
        links.append(f'<a href="{page_of}">explained</a>')
        made.append(
            f'<figure><a href="gallery/{tile.name}.{"html" if tile.opens else "svg"}">'
            f'<img src="gallery/{tile.name}.svg" '
            f'alt="{html.escape(tile.title)}" loading="lazy"></a>'
            f"<figcaption>{html.escape(tile.title)}<span>{' · '.join(links)}</span>"
            f"<details><summary>command</summary><pre><code>{commands}</code></pre></details></figcaption></figure>"
        )
    return '<div class="gallery">' + "".join(made) + "</div>"


def side_by_side(drawing: str, figure: str) -> str:
    """The CubeSat beside its pointing error."""

    def placed(svg: str, x: int, y: int, width: int, height: int) -> str:
        first, rest = re.sub(r"<\?xml.*?\?>", "", svg).lstrip().split(">", 1)
        first = re.sub(r' (width|height|x|y)="[^"]*"', "", first)
        return f'{first} x="{x}" y="{y}" width="{width}" height="{height}" overflow="visible">{rest}'

    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1200 420" width="1200" height="420">\n'
        '<rect width="1200" height="420" fill="#fff"/>\n'
        f"{placed(figure, 460, 0, 740, 411)}{placed(drawing, 10, 30, 420, 354)}</svg>\n"
    )


if __name__ == "__main__":
    (ROOT / "docs" / README).write_text(folder_pictures(CUBESAT)[README], "utf-8")
