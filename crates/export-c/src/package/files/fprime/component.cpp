// Component of F Prime around the control system of ORIGIN, exported by flexsc VERSION.

#include "COMPONENT.hpp"

namespace MODULE {

COMPONENT ::COMPONENT(const char* const compName)
    : COMPONENTComponentBase(compName), m_state(), m_input(), INITIALm_hasInput(false), m_wakeUps(0), m_missedInputs(0)ZEROS {
    BEGIN_STATE
}

COMPONENT ::~COMPONENT() {}

void COMPONENT ::run_handler(FwIndexType portNum, U32 context) {
    (void)portNum;
    (void)context;
    this->tlmWrite_WakeUps(++this->m_wakeUps);
    if (this->m_hasInput) {
        this->m_hasInput = false;
        this->LAW(GIVENthis->m_input);
    } else {
        this->tlmWrite_MissedInputs(++this->m_missedInputs);
        this->log_WARNING_HI_NoInputs();
    }
}

PARAMETERSFUNCTIONSvoid COMPONENT ::NOOP_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) {
    this->log_ACTIVITY_HI_Exported();
    this->cmdResponse_out(opCode, cmdSeq, Fw::CmdResponse::OK);
}

void COMPONENT ::RESET_COUNTERS_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) {
    this->m_wakeUps = 0;
    this->m_missedInputs = 0;
    this->tlmWrite_WakeUps(0);
    this->tlmWrite_MissedInputs(0);
RESETS    this->log_WARNING_HI_NoInputs_ThrottleClear();
    this->log_ACTIVITY_HI_CountersReset();
    this->cmdResponse_out(opCode, cmdSeq, Fw::CmdResponse::OK);
}

void COMPONENT ::RESTART_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) {
    BEGIN_STATE
    this->m_hasInput = false;
    this->log_ACTIVITY_HI_Restarted();
    this->cmdResponse_out(opCode, cmdSeq, Fw::CmdResponse::OK);
}

}  // namespace MODULE
