"""The study of nadir.toml in Basilisk: user CPU time (s) of its run and its rows, as JSON.

python3 benches/day/in_basilisk.py DURATION STEP [panels]    # pip install bsk; s, s of integration
"""

import json
import resource
import sys
from math import radians
from pathlib import Path

import numpy as np
import tomllib
from Basilisk.architecture import messaging
from Basilisk.fswAlgorithms import (
    attTrackingError,
    dipoleMapping,
    hillPoint,
    mrpFeedback,
    mtbFeedforward,
    mtbMomentumManagementSimple,
    rwMotorTorque,
    tamComm,
    torque2Dipole,
)
from Basilisk.simulation import (
    GravityGradientEffector,
    MtbEffector,
    eclipse,
    exponentialAtmosphere,
    facetDragDynamicEffector,
    facetSRPDynamicEffector,
    hingedRigidBodyStateEffector,
    magneticFieldWMM,
    magnetometer,
    planetEphemeris,
    reactionWheelStateEffector,
    simpleNav,
    spacecraft,
    zeroWindModel,
)
from Basilisk.utilities import (
    RigidBodyKinematics,
    SimulationBaseClass,
    macros,
    orbitalMotion,
    simIncludeGravBody,
    simIncludeRW,
)

HERE = Path(__file__).resolve().parent
STUDY = tomllib.loads((HERE / "nadir.toml").read_text())
FIELD = HERE.parent.parent / "tests" / "golden" / "foreign" / "public" / "pygeomag" / "WMM_2025.COF"
# Greenwich's sidereal angle and the Earth's true anomaly at the epoch, from mean elements of date (rad).
MERIDIAN, ANOMALY = 4.342758, radians(57.012)
TURN = 7.292115e-5
IDENTITY = [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0]
# Rows: x forward, y against the orbit's normal, z to the Earth, in Basilisk's axes of radius, flight, normal.
NADIR = np.array([[0.0, 1, 0], [0, 0, -1], [-1, 0, 0]])


def heavens():
    """The Earth at rest at the origin, turning, and the Sun that it sees."""
    model = planetEphemeris.PlanetEphemeris()
    model.setPlanetNames(planetEphemeris.StringVector(["earth", "sun"]))
    model.zeroBase = "earth"
    earth, sun = planetEphemeris.ClassicElements(), planetEphemeris.ClassicElements()
    earth.a, earth.e, earth.i = 149598023e3, 0.016703, radians(23.4358)
    earth.Omega, earth.omega, earth.f = 0.0, radians(103.405), ANOMALY
    sun.a = 1.0  # the Sun stays within a metre of itself
    model.planetElements = planetEphemeris.classicElementVector([earth, sun])
    model.rightAscension = planetEphemeris.DoubleVector([0.0, 0.0])
    model.declination = planetEphemeris.DoubleVector([np.pi / 2, np.pi / 2])
    model.lst0 = planetEphemeris.DoubleVector([MERIDIAN, 0.0])
    model.rotRate = planetEphemeris.DoubleVector([TURN, 0.0])
    return model


def panels(appendages):
    """The wings on springs: they stretch along -h1, and turn about h2."""
    for wing in appendages:
        mode, arm, (xx, yy, zz) = wing["modes"][0], wing["centre"][1], np.diag(wing["inertia"])
        side, about = np.sign(arm), xx + wing["mass"] * arm**2
        panel = hingedRigidBodyStateEffector.HingedRigidBodyStateEffector()
        panel.mass, panel.d = wing["mass"], abs(arm)
        panel.IPntS_S = np.diag([yy, xx, zz]).tolist()
        panel.r_HB_B = [[part] for part in wing["at"]]
        panel.dcm_HB = [[0.0, -side, 0.0], [side, 0.0, 0.0], [0.0, 0.0, 1.0]]
        panel.k = mode["frequency"] ** 2 * about
        panel.c = 2 * mode["damping"] * mode["frequency"] * about
        yield panel


def main():
    duration, step = float(sys.argv[1]), float(sys.argv[2])
    wings = tomllib.loads((HERE / "panels.toml").read_text()) if "panels" in sys.argv[3:] else None
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("day")
    period = STUDY["law"]["attitude"]["period"]
    for task, every in (("dynamics", step), ("flight", period)):
        process.addTask(simulation.CreateNewTask(task, macros.sec2nano(every)))

    def add(model, name, priority=-1, task="dynamics"):
        model.ModelTag = name
        simulation.AddModelToTask(task, model, priority)
        return model

    def fly(model, name):
        return add(model, name, task="flight")

    sky = add(heavens(), "sky", 4)
    body = STUDY["spacecraft"] | (wings["spacecraft"] if wings else {})
    craft = add(spacecraft.Spacecraft(), "craft", 1)
    craft.hub.mHub = body["mass"]
    craft.hub.IHubPntBc_B = body["inertia"]
    first = np.array(body["attitude"])
    craft.hub.sigma_BNInit = [[part] for part in first[1:] / (1 + first[0])]
    for panel in panels(wings["appendage"] if wings else []):
        add(panel, f"wing {panel.k}", 3)
        craft.addStateEffector(panel)
    bodies = simIncludeGravBody.gravBodyFactory()
    earth = bodies.createEarth()
    earth.isCentralBody = True
    bodies.addBodiesTo(craft)
    orbit, elements = STUDY["environment"]["orbit"], orbitalMotion.ClassicElements()
    elements.a, elements.e, elements.i = orbit["semi_major_axis"], 0.0, orbit["inclination"]
    elements.Omega, elements.omega, elements.f = orbit["node"], 0.0, 0.0
    craft.hub.r_CN_NInit, craft.hub.v_CN_NInit = orbitalMotion.elem2rv(earth.mu, elements)

    wheels, spec = simIncludeRW.rwFactory(), STUDY["actuator"]["wheels"]
    for axis in np.eye(3):
        wheels.create(
            "custom",
            axis,
            Js=spec["inertia"],
            u_max=spec["torque"],
            Omega_max=spec["momentum"] / spec["inertia"] * 60 / (2 * np.pi),
            RWModel=messaging.BalancedWheels,
            useRWfriction=False,
        )
    cluster = add(reactionWheelStateEffector.ReactionWheelStateEffector(), "wheels", 2)
    wheels.addToSpacecraft("craft", cluster, craft)
    parameters = wheels.getConfigMessage()

    gradient = add(GravityGradientEffector.GravityGradientEffector(), "gradient")
    gradient.addPlanetName(earth.planetName)
    craft.addDynamicEffector(gradient)
    drag = STUDY["environment"]["drag"]
    air = add(exponentialAtmosphere.ExponentialAtmosphere(), "air")
    air.planetRadius, air.scaleHeight = orbit["semi_major_axis"] - 5e5, drag["scale_height"]
    air.baseDensity = drag["density"] * np.exp(5e5 / drag["scale_height"])
    air.addSpacecraftToModel(craft.scStateOutMsg)
    wind = add(zeroWindModel.ZeroWindModel(), "wind")
    wind.planetPosInMsg.subscribeTo(sky.planetOutMsgs[0])
    wind.addSpacecraftToModel(craft.scStateOutMsg)
    facets = add(facetDragDynamicEffector.FacetDragDynamicEffector(), "drag")
    for plate in drag["plates"]:
        facets.addFacet(plate["area"], 2.2, np.array(plate["normal"]), np.array(plate["at"]))
    facets.atmoDensInMsg.subscribeTo(air.envOutMsgs[0])
    facets.windVelInMsg.subscribeTo(wind.envOutMsgs[0])
    craft.addDynamicEffector(facets)
    shadow = add(eclipse.Eclipse(), "shadow")
    shadow.sunInMsg.subscribeTo(sky.planetOutMsgs[1])
    shadow.addPlanetToModel(sky.planetOutMsgs[0])
    shadow.addSpacecraftToModel(craft.scStateOutMsg)
    light = add(facetSRPDynamicEffector.FacetSRPDynamicEffector(), "light")
    plates = STUDY["environment"]["solar_pressure"]["plates"]
    light.setNumFacets(len(plates))
    light.setNumArticulatedFacets(0)
    for plate in plates:
        normal, at = np.array(plate["normal"], dtype=float), np.array(plate["at"])
        light.addFacet(plate["area"], np.eye(3), normal, np.zeros(3), at, 0.0, plate["specular"])
    light.sunInMsg.subscribeTo(sky.planetOutMsgs[1])
    light.sunEclipseInMsg.subscribeTo(shadow.eclipseOutMsgs[0])
    craft.addDynamicEffector(light)
    earths = add(magneticFieldWMM.MagneticFieldWMM(), "field")
    earths.configureWMMFile(str(FIELD))
    date = STUDY["epoch"]
    epoch = messaging.EpochMsgPayload(year=date.year, month=date.month, day=date.day, hours=date.hour)
    epoch_message = messaging.EpochMsg().write(epoch)
    earths.epochInMsg.subscribeTo(epoch_message)
    earths.planetPosInMsg.subscribeTo(sky.planetOutMsgs[0])
    earths.addSpacecraftToModel(craft.scStateOutMsg)

    navigation = fly(simpleNav.SimpleNav(), "navigation")
    navigation.scStateInMsg.subscribeTo(craft.scStateOutMsg)
    meter = fly(magnetometer.Magnetometer(), "magnetometer")
    meter.scaleFactor, meter.senNoiseStd = 1.0, [0.0, 0.0, 0.0]
    meter.stateInMsg.subscribeTo(craft.scStateOutMsg)
    meter.magInMsg.subscribeTo(earths.envOutMsgs[0])
    measured = fly(tamComm.tamComm(), "measured")
    measured.dcm_BS = IDENTITY
    measured.tamInMsg.subscribeTo(meter.tamDataOutMsg)

    guidance = fly(hillPoint.hillPoint(), "guidance")
    guidance.transNavInMsg.subscribeTo(navigation.transOutMsg)
    error = fly(attTrackingError.attTrackingError(), "error")
    error.sigma_R0R = RigidBodyKinematics.C2MRP(NADIR.T).tolist()
    error.attNavInMsg.subscribeTo(navigation.attOutMsg)
    error.attRefInMsg.subscribeTo(guidance.attRefOutMsg)
    law, gains = fly(mrpFeedback.mrpFeedback(), "law"), STUDY["law"]["attitude"]
    mean = gains["inertia"][0][0]
    law.K = 4 * mean * gains["bandwidth"] ** 2
    law.P = 2 * mean * gains["damping"] * gains["bandwidth"]
    law.Ki, law.integralLimit = -1.0, 0.0
    law.guidInMsg.subscribeTo(error.attGuidOutMsg)
    vehicle = messaging.VehicleConfigMsg().write(
        messaging.VehicleConfigMsgPayload(ISCPntB_B=np.array(gains["inertia"]).flatten().tolist())
    )
    law.vehConfigInMsg.subscribeTo(vehicle)
    law.rwParamsInMsg.subscribeTo(parameters)
    law.rwSpeedsInMsg.subscribeTo(cluster.rwSpeedOutMsg)

    unloading = fly(mtbMomentumManagementSimple.mtbMomentumManagementSimple(), "unloading")
    unloading.Kp = spec["unloading"]["gain"]
    unloading.rwParamsInMsg.subscribeTo(parameters)
    unloading.rwSpeedsInMsg.subscribeTo(cluster.rwSpeedOutMsg)
    dipole = fly(torque2Dipole.torque2Dipole(), "dipole")
    dipole.tauRequestInMsg.subscribeTo(unloading.tauMtbRequestOutMsg)
    dipole.tamSensorBodyInMsg.subscribeTo(measured.tamOutMsg)
    bars = messaging.MTBArrayConfigMsgPayload()
    bars.numMTB, bars.GtMatrix_B = 3, IDENTITY
    bars.maxMtbDipoles = [spec["unloading"]["magnetorquers"]["moment"]] * 3
    bar_message = messaging.MTBArrayConfigMsg().write(bars)
    mapping = fly(dipoleMapping.dipoleMapping(), "mapping")
    mapping.steeringMatrix = IDENTITY
    mapping.dipoleRequestBodyInMsg.subscribeTo(dipole.dipoleRequestOutMsg)
    mapping.mtbArrayConfigParamsInMsg.subscribeTo(bar_message)
    forward = fly(mtbFeedforward.mtbFeedforward(), "forward")
    forward.vehControlInMsg.subscribeTo(law.cmdTorqueOutMsg)
    forward.dipoleRequestMtbInMsg.subscribeTo(mapping.dipoleRequestMtbOutMsg)
    forward.tamSensorBodyInMsg.subscribeTo(measured.tamOutMsg)
    forward.mtbArrayConfigParamsInMsg.subscribeTo(bar_message)
    motors = fly(rwMotorTorque.rwMotorTorque(), "motors")
    motors.controlAxes_B = IDENTITY
    motors.rwParamsInMsg.subscribeTo(parameters)
    motors.vehControlInMsg.subscribeTo(forward.vehControlOutMsg)
    cluster.rwMotorCmdInMsg.subscribeTo(motors.rwMotorTorqueOutMsg)
    bar = add(MtbEffector.MtbEffector(), "bars")
    bar.mtbCmdInMsg.subscribeTo(mapping.dipoleRequestMtbOutMsg)
    bar.mtbParamsInMsg.subscribeTo(bar_message)
    bar.magInMsg.subscribeTo(earths.envOutMsgs[0])
    craft.addDynamicEffector(bar)

    every = macros.sec2nano(STUDY["log"]["period"])
    outputs = (craft.scStateOutMsg, cluster.rwSpeedOutMsg)
    states, speeds = [message.recorder(every) for message in outputs]
    for row in (states, speeds):
        simulation.AddModelToTask("dynamics", row)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(duration))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    simulation.ExecuteSimulation()
    cpu = resource.getrusage(resource.RUSAGE_SELF).ru_utime - before
    square = (states.sigma_BN**2).sum(axis=1, keepdims=True)
    found = {
        "cpu_s": cpu,
        "attitude": (np.hstack([1 - square, 2 * states.sigma_BN]) / (1 + square)).tolist(),
        "position": states.r_BN_N.tolist(),
        "momentum": (spec["inertia"] * speeds.wheelSpeeds[:, :3]).tolist(),
    }
    print(json.dumps(found))


main()
