"""Positions of the public element sets, by python-sgp4: `python3 tests/golden/foreign/public_orbits.py`.

    pip install sgp4

Writes public_orbits.csv: file, line of the elements (0 in an OMM), seconds since the epoch, position (km,
TEME, WGS 72), or `checksum` where the last digit of a line is wrong.
"""

from itertools import pairwise
from pathlib import Path

from sgp4 import omm
from sgp4.api import WGS72, Satrec

PUBLIC = Path(__file__).parent / "public"
TIMES = (0.0, 1800.0, 7200.0)


def right(line: str) -> bool:
    """Whether the last digit is the sum of the digits, a minus being one, modulo ten."""
    digits = sum(int(c) if c.isdigit() else c == "-" for c in line[:68])
    return line[68:69] == str(digits % 10)


def rows(name: str, line: int, satellite: Satrec) -> list[str]:
    found = []
    for t in TIMES:
        # From the epoch in minutes, without the rounding of a date.
        error, place, _ = satellite.sgp4_tsince(t / 60.0)
        assert not error, (name, line)
        found.append(f"{name},{line},{t:g}," + ",".join(f"{x:.9f}" for x in place))
    return found


def main() -> None:
    table = ["file,line,t,x,y,z"]
    lines = (PUBLIC / "python-sgp4" / "SGP4-VER.TLE").read_text(encoding="ascii").splitlines()
    for number, (first, second) in enumerate(pairwise(lines), 1):
        if first.startswith("1 ") and second.startswith("2 "):
            name = "python-sgp4/SGP4-VER.TLE"
            if right(first) and right(second):
                table += rows(name, number, Satrec.twoline2rv(first[:69], second[:69], WGS72))
            else:
                table.append(f"{name},{number},0,checksum,,")
    for path in sorted((PUBLIC / "oem").glob("[0-9]*.omm")):
        fields = dict(line.split(" = ") for line in path.read_text().splitlines() if " = " in line)
        satellite = Satrec()
        omm.initialize(satellite, {key.strip(): value.strip() for key, value in fields.items()})
        table += rows(f"oem/{path.name}", 0, satellite)
    (PUBLIC.parent / "public_orbits.csv").write_text("\n".join(table) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
