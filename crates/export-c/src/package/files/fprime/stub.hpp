// STUB of the class that F Prime generates of COMPONENT.fpp: its ports, telemetry, events and commands, so that the component is
// compiled and run without F Prime. This is no part of F Prime, and no text of it.
#ifndef STUB_COMPONENT_COMPONENTAC_HPP
#define STUB_COMPONENT_COMPONENTAC_HPP

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

typedef double F64;
typedef std::int32_t I32;
typedef std::int64_t I64;
typedef std::uint32_t U32;
typedef std::int32_t FwIndexType;
typedef U32 FwOpcodeType;
typedef U32 FwPrmIdType;

namespace Fw {
struct CmdResponse {
    enum T { OK };
};
struct ParamValid {
    enum T { INVALID, VALID };
    ParamValid(T valid) : e(valid) {}
    T e;
};
}  // namespace Fw

namespace MODULE {

// Array of COUNT elements.
template <typename Element, U32 COUNT>
class StubArray {
  public:
    StubArray() : m_elements() {}
    Element& operator[](const U32 i) { return this->m_elements[i]; }
    const Element& operator[](const U32 i) const { return this->m_elements[i]; }

  private:
    Element m_elements[COUNT];
};

ARRAYS
// Words of outputs.
class Words {
  public:
    void add(F64 value) {
        std::uint64_t word;
        std::memcpy(&word, &value, sizeof word);
        this->m_words.push_back(word);
    }
    void add(I64 value) { this->m_words.push_back(static_cast<std::uint64_t>(value)); }
    void add(bool value) { this->m_words.push_back(value ? 1 : 0); }
    template <typename Element, U32 COUNT>
    void add(const StubArray<Element, COUNT>& values) {
        for (U32 i = 0; i < COUNT; i++) {
            this->add(values[i]);
        }
    }
    const std::vector<std::uint64_t>& list() const { return this->m_words; }

  private:
    std::vector<std::uint64_t> m_words;
};

class COMPONENTComponentBase {
  public:
    explicit COMPONENTComponentBase(const char* compName) : m_name(compName) {}
    virtual ~COMPONENTComponentBase() {}

    // Calls of the ports from outside.
    void call_run() { this->run_handler(0, 0); }
CALLS    void call_NOOP() { this->NOOP_cmdHandler(1, 7); }
    void call_RESET_COUNTERS() { this->RESET_COUNTERS_cmdHandler(2, 8); }
    void call_parameterUpdated(const char* name, F64 value) {
        this->m_numbers[name] = value;
        this->parameterUpdated(0);
    }
    void call_RESTART() { this->RESTART_cmdHandler(3, 9); }

    // What the component sent: outputs by the name of the port, telemetry, events, and the opcodes of commands that it answered.
    std::vector<std::pair<std::string, Words>> m_sent;
    std::map<std::string, U32> m_telemetry;
    std::map<std::string, U32> m_events;
    std::vector<FwOpcodeType> m_answered;

  protected:
    virtual void parameterUpdated(FwPrmIdType id) { (void)id; }
    virtual void parametersLoaded() {}
    void lock() {}
    void unLock() {}
    virtual void run_handler(FwIndexType portNum, U32 context) = 0;
HANDLERS    virtual void NOOP_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) = 0;
    virtual void RESET_COUNTERS_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) = 0;
    virtual void RESTART_cmdHandler(FwOpcodeType opCode, U32 cmdSeq) = 0;

OUTPUTS    void tlmWrite_WakeUps(U32 value) { this->m_telemetry["WakeUps"] = value; }
    void tlmWrite_MissedInputs(U32 value) { this->m_telemetry["MissedInputs"] = value; }
TELEMETRY    void log_ACTIVITY_HI_Exported() { this->m_events["Exported"]++; }
    void log_ACTIVITY_HI_CountersReset() { this->m_events["CountersReset"]++; }
    void log_ACTIVITY_HI_Restarted() { this->m_events["Restarted"]++; }
PARAMETERS    void log_WARNING_HI_ParametersRefused(I32 place) { this->m_events["ParametersRefused"] += place > 0 ? 1 : 0; }
    void log_WARNING_HI_NoInputs() { this->m_events["NoInputs"]++; }
    void log_WARNING_HI_NoInputs_ThrottleClear() { this->m_events["NoInputs cleared"]++; }
    void cmdResponse_out(FwOpcodeType opCode, U32 cmdSeq, Fw::CmdResponse::T response) {
        if (response == Fw::CmdResponse::OK && cmdSeq == opCode + 6) {
            this->m_answered.push_back(opCode);
        }
    }

  private:
    std::map<std::string, F64> m_numbers;
    std::string m_name;
};

}  // namespace MODULE

#endif
