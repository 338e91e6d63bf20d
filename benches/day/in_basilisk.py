"""The study of nadir.toml in Basilisk: CPU time (s) of its run, pointing and wheels at its end, as JSON.

python3 benches/day/in_basilisk.py WMM.COF [STEP]   # pip install bsk; STEP (s) of integration: 0.5
"""

import json
import sys
import time
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
    exponentialAtmosphere,
    facetDragDynamicEffector,
    magneticFieldWMM,
    magnetometer,
    reactionWheelStateEffector,
    simpleNav,
    spacecraft,
)
from Basilisk.utilities import (
    RigidBodyKinematics,
    SimulationBaseClass,
    macros,
    orbitalMotion,
    simIncludeGravBody,
    simIncludeRW,
)

STUDY = tomllib.loads((Path(__file__).parent / "nadir.toml").read_text())
IDENTITY = [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0]
# Rows: x forward, y against the orbit's normal, z to the Earth, in Basilisk's axes of radius, flight, normal.
NADIR = np.array([[0.0, 1, 0], [0, 0, -1], [-1, 0, 0]])


def main():
    field, step = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.5
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

    body, inertia = STUDY["spacecraft"], np.array(STUDY["spacecraft"]["inertia"])
    craft = add(spacecraft.Spacecraft(), "craft", 1)
    craft.hub.mHub = body["mass"]
    craft.hub.IHubPntBc_B = inertia.tolist()
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
    [plate] = drag["plates"]
    facet = add(facetDragDynamicEffector.FacetDragDynamicEffector(), "drag")
    facet.addFacet(plate["area"], drag["coefficient"], np.array(plate["normal"]), np.array(plate["at"]))
    facet.atmoDensInMsg.subscribeTo(air.envOutMsgs[0])
    craft.addDynamicEffector(facet)
    earths = add(magneticFieldWMM.MagneticFieldWMM(), "field")
    earths.configureWMMFile(field)
    date = STUDY["epoch"]
    epoch = messaging.EpochMsgPayload(year=date.year, month=date.month, day=date.day, hours=date.hour)
    epoch_message = messaging.EpochMsg().write(epoch)
    earths.epochInMsg.subscribeTo(epoch_message)
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
    mean = float(np.trace(inertia)) / 3
    law.K = 4 * mean * gains["bandwidth"] ** 2
    law.P = 2 * mean * gains["damping"] * gains["bandwidth"]
    law.Ki, law.integralLimit = -1.0, 0.0
    law.guidInMsg.subscribeTo(error.attGuidOutMsg)
    vehicle = messaging.VehicleConfigMsg().write(
        messaging.VehicleConfigMsgPayload(ISCPntB_B=inertia.flatten().tolist())
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
    outputs = (craft.scStateOutMsg, error.attGuidOutMsg, cluster.rwSpeedOutMsg, earths.envOutMsgs[0])
    rows = [message.recorder(every) for message in outputs]
    for row in rows:
        simulation.AddModelToTask("dynamics", row)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(STUDY["duration"]))
    began = time.process_time()
    simulation.ExecuteSimulation()
    cpu = time.process_time() - began
    states, errors, speeds, fields = rows
    momenta = spec["inertia"] * speeds.wheelSpeeds[:, :3]
    found = {
        "cpu_s": cpu,
        "rows": len(states.times()),
        "position_m": states.r_BN_N[-1].tolist(),
        "error_rad": float(4 * np.linalg.norm(errors.sigma_BR[-1])),
        "momentum_nm_s": float(np.linalg.norm(momenta[-1])),
        "momentum_peak_nm_s": float(np.linalg.norm(momenta, axis=1).max()),
        "field_start_t": fields.magField_N[1].tolist(),
    }
    print(json.dumps(found))


main()
