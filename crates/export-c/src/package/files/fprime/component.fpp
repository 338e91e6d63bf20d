@ Control system of ORIGIN, exported by flexsc VERSION
module MODULE {

TYPES  @ Ports of MEASURED call their function. The inputs of LOWER_LAW wait for the port `run`, which decides
  @ and sends its outputs.
  passive component COMPONENT {

    @ Decides with the inputs that came since the last decision
    guarded input port run: Svc.Sched

PORTS    @ Reports the version
    guarded command NOOP

    @ Sets the counters to zero
    guarded command RESET_COUNTERS

    @ Sets the state of the control system as before its first call
    guarded command RESTART

    @ Calls of the port `run`
    telemetry WakeUps: U32

    @ Calls of the port `run` without new inputs
    telemetry MissedInputs: U32

COUNTERSPARAMETERS    @ Answer to NOOP
    event Exported severity activity high format "control system, exported by flexsc VERSION"

    @ The counters are zero
    event CountersReset severity activity high format "counters are zero"

    @ The control system starts again
    event Restarted severity activity high format "the control system starts again"

    @ The port `run` was called without new inputs
    event NoInputs severity warning high format "no inputs since the last decision" throttle 16

    command recv port cmdIn

    command reg port cmdRegOut

    command resp port cmdResponseOut

    event port eventOut

    text event port textEventOut

    telemetry port tlmOut

    time get port timeGetOut

  }

}
