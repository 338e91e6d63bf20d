// Component of F Prime around the control system of ORIGIN, exported by flexsc VERSION.
#ifndef MODULE_COMPONENT_HPP
#define MODULE_COMPONENT_HPP

#include "Components/COMPONENT/COMPONENTComponentAc.hpp"

extern "C" {
#include "LOWER.h"
}

namespace MODULE {

class COMPONENT : public COMPONENTComponentBase {
  public:
    explicit COMPONENT(const char* compName);
    ~COMPONENT();

  private:
    // Decides with the inputs that came since the last decision; without them nothing is sent.
    void run_handler(FwIndexType portNum, U32 context) override;

HANDLERS    void NOOP_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) override;
    void RESET_COUNTERS_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) override;
    void RESTART_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) override;

PARAMETERSFUNCTIONS    LOWER_state m_state;
    // Inputs of the next decision, and true from their arrival to the decision.
    LOWER_LAW_input m_input;
TIME    bool m_hasInput;
    U32 m_wakeUps;
    U32 m_missedInputs;
MEMBERS};

}  // namespace MODULE

#endif
