"""Parts in Python by their roles in a scenario."""

from __future__ import annotations

from collections.abc import Mapping
from operator import index
from typing import Any, TypeAlias

from flexsc import parts

# Laws by the names of modes, or by the numbers of stages.
_StageLaws: TypeAlias = (
    "Mapping[str, parts.Law | parts.ThreeAxisLaw] | Mapping[int, parts.Law | parts.ThreeAxisLaw]"
)


def by_role(
    law: parts.Law | parts.ThreeAxisLaw | _StageLaws | None,
    estimator: parts.Estimator | None,
    adaptation: parts.Adaptation | None,
    actuator: parts.Actuator | Mapping[int, parts.Actuator] | None,
    sensor: parts.Sensor | Mapping[int, parts.Sensor] | None,
    disturbance: parts.DisturbanceModel | Mapping[int, parts.DisturbanceModel] | None,
    guidance: parts.Guidance | Mapping[str, parts.Guidance] | None,
) -> list[tuple[str, object]]:
    """Return the parts that are given, each with its role, such as `sensor 0` or `law point`.

    Raises:
        TypeError: An object is not of the class of its role.
    """
    sensors, actuators, disturbances = (
        each if isinstance(each, Mapping) else {} if each is None else {0: each}
        for each in (sensor, actuator, disturbance)
    )
    laws = {f"law {name}": each for name, each in law.items()} if isinstance(law, Mapping) else {"law": law}
    guides = (
        {f"guidance {name}": each for name, each in guidance.items()}
        if isinstance(guidance, Mapping)
        else {"guidance": guidance}
    )
    given: list[tuple[str, type[Any], object]] = [
        *(
            (role, parts.ThreeAxisLaw if isinstance(each, parts.ThreeAxisLaw) else parts.Law, each)
            for role, each in laws.items()
        ),
        ("estimator", parts.Estimator, estimator),
        ("adaptation", parts.Adaptation, adaptation),
        *((f"actuator {index(place)}", parts.Actuator, each) for place, each in actuators.items()),
        *((f"sensor {index(place)}", parts.Sensor, each) for place, each in sensors.items()),
        *(
            (f"disturbance {index(place)}", parts.DisturbanceModel, each)
            for place, each in disturbances.items()
        ),
        *((role, parts.Guidance, each) for role, each in guides.items()),
    ]
    brought = []
    for role, kind, part in given:
        if part is None:
            continue
        if not isinstance(part, kind):
            is_class = isinstance(part, type) and issubclass(part, kind)
            name = part.__name__ if isinstance(part, type) else type(part).__name__
            found = f"the class {name}; write {name}()" if is_class else name
            raise TypeError(f"{role} must be an object of a flexsc.{kind.__name__}, got {found}")
        brought.append((role, part))
    return brought
