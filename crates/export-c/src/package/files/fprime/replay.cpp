// Replays the calls of a run through the ports of the component, on the stub of its base class, and compares every output by bits.
// Then it sends commands, and calls `run` without new inputs.

#include "Components/COMPONENT/COMPONENT.hpp"

#include <cstdio>

namespace {

std::FILE* vectors;
bool isWhole = true;

std::uint64_t readWord() {
    unsigned char bytes[8] = {0};
    std::uint64_t word = 0;
    isWhole = std::fread(bytes, 1, 8, vectors) == 8 && isWhole;
    for (std::size_t index = 8; index > 0; --index) {
        word = word << 8 | bytes[index - 1];
    }
    return word;
}

// Reads members.
struct Reader {
    static void read(F64& value) {
        const std::uint64_t word = readWord();
        std::memcpy(&value, &word, sizeof value);
    }

    static void read(I64& value) { value = static_cast<I64>(readWord()); }

    static void read(bool& value) { value = readWord() != 0; }

    template <typename Element, U32 COUNT>
    static void read(MODULE::StubArray<Element, COUNT>& values) {
        for (U32 i = 0; i < COUNT; i++) {
            read(values[i]);
        }
    }
};

// True if two words are equal; all NaN are one value.
bool isEqual(std::uint64_t a, std::uint64_t b, char kind) {
    const std::uint64_t infinity = UINT64_C(0x7ff0000000000000);
    const std::uint64_t size = UINT64_C(0x7fffffffffffffff);
    return a == b || (kind == 'R' && (a & size) > infinity && (b & size) > infinity);
}

int fail(unsigned long call, const char* what) {
    std::fprintf(stderr, "call %lu: %s\n", call, what);
    return 1;
}

// Reads the expected outputs, of these kinds, and compares; true if all are equal.
bool hasOutputs(const MODULE::COMPONENTComponentBase& component, const char* port, const char* kinds) {
    bool isSame = component.m_sent.size() == 1 && component.m_sent[0].first == port;
    for (std::size_t word = 0; kinds[word] != '\0'; ++word) {
        const std::uint64_t expected = readWord();
        isSame = isSame && word < component.m_sent[0].second.list().size() &&
                 isEqual(component.m_sent[0].second.list()[word], expected, kinds[word]);
    }
    return isSame && isWhole;
}

}  // namespace

int main(int argc, char** argv) {
    vectors = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
    if (vectors == nullptr || readWord() != UINT64_C(0x3156637378656c66)) {
        std::fprintf(stderr, "usage: replay vectors.bin\n");
        return 2;
    }
    const unsigned long count = static_cast<unsigned long>(readWord());
    static MODULE::COMPONENT component("control");
    U32 calls[CALL_COUNT] = {0};
    for (unsigned long number = 0; number < count; ++number) {
        const std::uint64_t index = readWord();
        I64 now_whole = 0;
        I64 now_part = 0;
        Reader::read(now_whole);
        Reader::read(now_part);
        component.m_sent.clear();
        if (index >= CALL_COUNT) {
            return fail(number, "no file of vectors");
        }
        calls[index]++;
CASES    }
    std::fclose(vectors);
    component.m_sent.clear();
    component.call_run();
    component.call_NOOP();
    if (!component.m_sent.empty() || component.m_telemetry["WakeUps"] != calls[CALL_COUNT - 1] + 1 ||
        component.m_telemetry["MissedInputs"] != 1 || component.m_events["NoInputs"] != 1 ||
        component.m_events["Exported"] != 1CALL_COUNTERS) {
        return fail(count, "other telemetry or events");
    }
    component.call_RESET_COUNTERS();
    component.call_RESTART();
    if (component.m_telemetry["WakeUps"] != 0 || component.m_telemetry["MissedInputs"] != 0 ||
        component.m_events["CountersReset"] != 1 || component.m_events["Restarted"] != 1 || component.m_answered.size() != 3) {
        return fail(count, "other telemetry or events after the commands");
    }
PARAMETERS    std::printf("%lu calls equal through ports\n", count);
    return 0;
}
