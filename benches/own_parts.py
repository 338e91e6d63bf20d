"""Measures what a law in Python costs beside the same law of the engine: CPU time of a run, side by side.

pip install . scipy
python3 benches/own_parts.py
"""

import sys
import time
from pathlib import Path

import flexsc

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "python"))
from own import Relay

PASSES = 50


def main() -> None:
    engine = flexsc.Scenario.example("relay-fixed")
    studies = {"engine": engine, "Python": engine.with_parts(law=Relay.of(engine))}
    least = dict.fromkeys(studies, float("inf"))
    for _ in range(PASSES):
        for name, study in studies.items():
            began = time.process_time()
            study.simulate(log="none")
            least[name] = min(least[name], time.process_time() - began)
    calls = int(engine.simulate(log="none").metrics["switchings"])
    for name, taken in least.items():
        print(f"{name:>8}: {1e3 * taken:.2f} ms of CPU for 20 000 s, {calls} switchings")
    print(f"a call: {1e6 * (least['Python'] - least['engine']) / calls:.2f} us")


if __name__ == "__main__":
    main()
