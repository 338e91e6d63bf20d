/* Replays the calls of a run through the messages of the app, on the stub of a software bus, and compares every output by bits.
 * Then it sends faulty messages and commands, and compares the counters.
 */

#include "bus.h"

#include "LOWER_app.h"
#include "LOWER_app_eventids.h"
#include "LOWER_app_msgids.h"

#include <stdio.h>
#include <string.h>

/* Member of a payload: R doubles, I integers, F truth values. */
typedef struct {
    const char *name;
    char kind;
    size_t offset;
    size_t count;
} member;

/* Message with the inputs or outputs of a function. */
typedef struct {
    CFE_SB_MsgId_Atom_t id;
    size_t size;
    size_t payload;
    const member *members;
    size_t count;
} message_kind;

TABLESstatic union {
    CFE_SB_Buffer_t buffer;
    uint8 bytes[MOST_BYTES];
} sent, received;

static FILE *vectors;
static uint64_t left;
static unsigned long replayed;
static unsigned long calls[CALLS];
static size_t expected_call;
static uint64_t expected[MOST_WORDS];
static uint64_t now[2];
static unsigned received_count;
static enum { NOTHING, WAKE_UP, OUTPUTS } awaited;
static unsigned fault;
static int failures;

static uint64_t read_word(void)
{
    uint8 bytes[8] = { 0 };
    uint64_t word = 0;
    if (fread(bytes, 1, 8, vectors) != 8) {
        left = 0;
    }
    for (size_t index = 8; index > 0; --index) {
        word = word << 8 | bytes[index - 1];
    }
    return word;
}

static void fail(const char *what)
{
    fprintf(stderr, "message after call %lu: %s\n", replayed, what);
    ++failures;
}

static void prepare(CFE_SB_MsgId_Atom_t id, size_t size)
{
    memset(&sent, 0, sizeof sent);
    CFE_MSG_Init(&sent.buffer.Msg, CFE_SB_ValueToMsgId(id), size);
}

/* Returns true if two words are equal; all NaN are one value. */
static bool is_equal(uint64_t a, uint64_t b, char kind)
{
    const uint64_t infinity = UINT64_C(0x7ff0000000000000);
    const uint64_t size = UINT64_C(0x7fffffffffffffff);
    return a == b || (kind == 'R' && (a & size) > infinity && (b & size) > infinity);
}

/* Compares the outputs that the app has published. */
static void compare(void)
{
    const message_kind *kind = &outputs[expected_call];
    const uint8 *payload = received.bytes + kind->payload;
    size_t word = 0;
    if (received_count != 1 || received.buffer.Msg.MsgId != kind->id || received.buffer.Msg.Size != kind->size) {
        fail("the app published something else than the outputs");
        return;
    }
    for (size_t index = 0; index < kind->count; ++index) {
        const member *own = &kind->members[index];
        for (size_t element = 0; element < own->count; ++element) {
            uint64_t found = 0;
            if (own->kind == 'F') {
                found = payload[own->offset + element];
            } else {
                memcpy(&found, payload + own->offset + 8 * element, 8);
            }
            if (!is_equal(found, expected[word], own->kind)) {
                fail(own->name);
            }
            ++word;
        }
    }
    ++calls[expected_call];
    ++replayed;
}

/* Writes the inputs of the next call. */
static void send_inputs(void)
{
    expected_call = (size_t)read_word();
    if (expected_call >= CALLS) {
        fail("no file of vectors");
        left = 0;
        expected_call = 0;
    }
    now[0] = read_word();
    now[1] = read_word();
    const message_kind *kind = &inputs[expected_call];
    prepare(kind->id, kind->size);
    uint8 *payload = sent.bytes + kind->payload;
#ifdef HAS_TIME
    /* The time comes first in a payload. */
    memcpy(payload, now, sizeof now);
#endif
    for (size_t index = 0; index < kind->count; ++index) {
        const member *own = &kind->members[index];
        for (size_t element = 0; element < own->count; ++element) {
            const uint64_t word = read_word();
            if (own->kind == 'F') {
                payload[own->offset + element] = word != 0;
            } else {
                memcpy(payload + own->offset + 8 * element, &word, 8);
            }
        }
    }
    size_t words = 0;
    for (size_t index = 0; index < outputs[expected_call].count; ++index) {
        words += outputs[expected_call].members[index].count;
    }
    for (size_t word = 0; word < words; ++word) {
        expected[word] = read_word();
    }
}

/* Compares the counters that the app has sent. */
static void compare_counters(const UPPER_APP_HkTlm_Payload_t *expect)
{
    UPPER_APP_HkTlm_t found;
    if (received_count != 1 || received.buffer.Msg.MsgId != UPPER_APP_HK_TLM_MID || received.buffer.Msg.Size != sizeof found) {
        fail("no counters");
        return;
    }
    memcpy(&found, &received, sizeof found);
    if (memcmp(&found.Payload, expect, sizeof *expect) != 0) {
        fail("other counters");
    }
}

#ifdef HAS_PARAMETERS
static LOWER_parameters changed;

/* Loads a table that the app must refuse, and one that it must take. */
static void load_tables(void)
{
    double *numbers = (double *)&changed;
    const size_t count = sizeof changed / sizeof *numbers;
    size_t first = 0;
    changed = LOWER_default_parameters;
    /* a parameter of 0 stays 0 when it is multiplied */
    while (first + 1 < count && numbers[first] == 0.0) {
        ++first;
    }
    const double number = numbers[first];
    numbers[first] = number == 0.0 ? 100.0 : 100.0 * number;
    if (CFE_TBL_Load(UPPER_APP_Data.Table, CFE_TBL_SRC_ADDRESS, &changed) == CFE_SUCCESS) {
        fail("a table beyond the limits was taken");
    }
    numbers[first] = number == 0.0 ? 0.5 : 1.5 * number;
    if (CFE_TBL_Load(UPPER_APP_Data.Table, CFE_TBL_SRC_ADDRESS, &changed) != CFE_SUCCESS) {
        fail("a table was refused");
    }
}

/* The parameters of the table hold after a restart too. */
static void compare_parameters(void)
{
    if (memcmp(&UPPER_APP_Data.Parameters, &changed, sizeof changed) != 0) {
        fail("other parameters");
    }
}
#else
static void load_tables(void)
{
}
static void compare_parameters(void)
{
}
#endif

/* Sends the next faulty message or command; returns false after the last. */
static bool send_fault(void)
{
    UPPER_APP_HkTlm_Payload_t expect;
    memset(&expect, 0, sizeof expect);
    if (fault != 9 && fault != 12 && received_count != 0) {
        fail("the app published after a fault");
    }
    switch (fault++) {
        case 0:
            prepare(UPPER_APP_CMD_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            sent.buffer.Msg.FcnCode = UPPER_APP_NOOP_CC;
            return true;
        case 1:
            prepare(UPPER_APP_CMD_MID, sizeof(UPPER_APP_NoArgsCmd_t) + 1);
            return true;
        case 2:
            prepare(UPPER_APP_CMD_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            sent.buffer.Msg.FcnCode = 99;
            return true;
        case 3:
            prepare(inputs[0].id, inputs[0].size - 1);
            return true;
        case 4:
            prepare(inputs[CALLS - 1].id, inputs[CALLS - 1].size + 8);
            return true;
        case 5:
            prepare(UPPER_APP_WAKE_UP_MID, sizeof(UPPER_APP_NoArgsCmd_t) + 2);
            return true;
        case 6:
            prepare(UPPER_APP_WAKE_UP_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            return true;
        case 7:
            prepare(UPPER_APP_HK_TLM_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            return true;
        case 8:
            load_tables();
            prepare(UPPER_APP_SEND_HK_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            return true;
        case 9:
            for (size_t call = 0; call < CALLS; ++call) {
                expect.Calls[call] = (uint32)calls[call];
            }
            expect.WakeUps = (uint32)calls[CALLS - 1] + 1;
            expect.MissedInputs = 1;
            expect.RefusedMessages = 5;
            expect.CommandCounter = 1;
            expect.CommandErrorCounter = 2;
            compare_counters(&expect);
            prepare(UPPER_APP_CMD_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            sent.buffer.Msg.FcnCode = UPPER_APP_RESET_COUNTERS_CC;
            return true;
        case 10:
            prepare(UPPER_APP_CMD_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            sent.buffer.Msg.FcnCode = UPPER_APP_RESTART_CC;
            return true;
        case 11:
            prepare(UPPER_APP_SEND_HK_MID, sizeof(UPPER_APP_NoArgsCmd_t));
            return true;
        case 12:
            compare_parameters();
            expect.CommandCounter = 1;
            compare_counters(&expect);
            return false;
        default:
            return false;
    }
}

CFE_SB_Buffer_t *bus_next_message(void)
{
    if (awaited == WAKE_UP) {
        /* The inputs of the law wait for this message. */
        if (received_count != 0) {
            fail("the app decided before it was woken up");
        }
        awaited = OUTPUTS;
        prepare(UPPER_APP_WAKE_UP_MID, sizeof(UPPER_APP_NoArgsCmd_t));
        return &sent.buffer;
    }
    if (awaited == OUTPUTS) {
        compare();
        awaited = NOTHING;
        received_count = 0;
    }
    if (failures > 0) {
        return NULL;
    }
    if (left > 0) {
        --left;
        send_inputs();
        awaited = expected_call == CALLS - 1 ? WAKE_UP : OUTPUTS;
        return &sent.buffer;
    }
    const bool is_more = send_fault();
    received_count = 0;
    return is_more ? &sent.buffer : NULL;
}

void bus_take_message(const CFE_MSG_Message_t *message)
{
    ++received_count;
    if (message->Size <= sizeof received) {
        memcpy(&received, message, message->Size);
    }
}

int main(int argc, char **argv)
{
    vectors = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (vectors == NULL || read_word() != UINT64_C(0x3156637378656c66)) {
        fprintf(stderr, "usage: replay vectors.bin\n");
        return 2;
    }
    left = read_word();
    const uint64_t count = left;
    UPPER_APP_Main();
    fclose(vectors);
    for (size_t call = 0; call < CALLS; ++call) {
        if (!bus_is_subscribed(inputs[call].id)) {
            fail("the app does not subscribe to the inputs");
        }
    }
    if (!bus_is_subscribed(UPPER_APP_WAKE_UP_MID) || !bus_is_subscribed(UPPER_APP_SEND_HK_MID)
        || !bus_is_subscribed(UPPER_APP_CMD_MID)) {
        fail("the app does not subscribe to its commands");
    }
    if (bus_events(UPPER_APP_INIT_EID) != 1 || bus_events(UPPER_APP_NOOP_EID) != 1 || bus_events(UPPER_APP_RESET_EID) != 1
        || bus_events(UPPER_APP_RESTART_EID) != 1 || bus_events(UPPER_APP_CODE_ERR_EID) != 1
        || bus_events(UPPER_APP_LENGTH_ERR_EID) != 4 || bus_events(UPPER_APP_MESSAGE_ERR_EID) != 1
        || bus_events(UPPER_APP_MISSED_ERR_EID) != 1 || bus_exit_status() != CFE_ES_RunStatus_APP_RUN) {
        fail("other events");
    }
    if (replayed != count || failures > 0) {
        return 1;
    }
    printf("%lu calls equal through messages; faulty messages are refused\n", replayed);
    return 0;
}
