@ STUB of the framework of F Prime: the part of its model that the component uses. This is no part of F Prime.
type FwChanIdType = U32
type FwDpIdType = U32
type FwDpPriorityType = U32
type FwEventIdType = U32
type FwIndexType = I32
type FwOpcodeType = U32
type FwPacketDescriptorType = U32
type FwPrmIdType = U32
type FwSignedSizeType = I64
type FwSizeType = U64
type FwSizeStoreType = U16
type FwTimeBaseStoreType = U16
type FwTimeContextStoreType = U8
type FwTlmPacketizeIdType = U16
type FwTraceIdType = U32

module Fw {
  type CmdArgBuffer
  type CmdString
  type LogBuffer
  type ParamBuffer
  type TextLogString
  type Time
  type TlmBuffer
  enum CmdResponse { OK, INVALID_OPCODE, VALIDATION_ERROR, FORMAT_ERROR, EXECUTION_ERROR, BUSY }
  enum ParamValid { UNINIT, VALID, INVALID, DEFAULT }
  enum LogSeverity { FATAL, WARNING_HI, WARNING_LO, COMMAND, ACTIVITY_HI, ACTIVITY_LO, DIAGNOSTIC }
  port Cmd(opCode: FwOpcodeType, cmdSeq: U32, ref args: Fw.CmdArgBuffer)
  port CmdReg(opCode: FwOpcodeType)
  port CmdResponse(opCode: FwOpcodeType, cmdSeq: U32, response: Fw.CmdResponse)
  port Log($id: FwEventIdType, ref timeTag: Fw.Time, $severity: LogSeverity, ref args: LogBuffer)
  port LogText($id: FwEventIdType, ref timeTag: Fw.Time, $severity: LogSeverity, ref $text: Fw.TextLogString)
  port PrmGet($id: FwPrmIdType, ref val: Fw.ParamBuffer) -> Fw.ParamValid
  port PrmSet($id: FwPrmIdType, ref val: Fw.ParamBuffer)
  port Time(ref $time: Fw.Time)
  port Tlm($id: FwChanIdType, ref timeTag: Fw.Time, ref val: TlmBuffer)
}

module Svc {
  port Sched(context: U32)
}
