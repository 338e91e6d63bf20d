/* App of cFS around the control system of ORIGIN, exported by flexsc VERSION.
 *
 * Messages with the inputs of MEASURED call their function when they arrive. The inputs of `LOWER_LAW` wait for the
 * message that wakes the app up; its outputs are published. A message of another length than its struct is refused.
 */

#include "LOWER_app.h"

#include "LOWER_app_eventids.h"
#include "LOWER_app_msgids.h"
#include "LOWER_app_perfids.h"
#include "LOWER_app_platform_cfg.h"

#include <string.h>

UPPER_APP_Data_t UPPER_APP_Data;

FUNCTIONS/* Decides with the inputs that came since the last decision; without them nothing is published. */
static void UPPER_APP_WakeUp(void)
{
    UPPER_APP_Data.HkTlm.Payload.WakeUps++;
    if (UPPER_APP_Data.Has_LAW_Input) {
        UPPER_APP_Data.Has_LAW_Input = false;
        UPPER_APP_LAW(&UPPER_APP_Data.LAW_Input.Payload);
    } else {
        UPPER_APP_Data.HkTlm.Payload.MissedInputs++;
        CFE_EVS_SendEvent(UPPER_APP_MISSED_ERR_EID, CFE_EVS_EventType_ERROR, "UPPER: no inputs since the last decision");
    }
}

/* Sends the counters. */
static void UPPER_APP_SendHk(void)
{
MANAGED    CFE_SB_TimeStampMsg(CFE_MSG_PTR(UPPER_APP_Data.HkTlm.TelemetryHeader));
    CFE_SB_TransmitMsg(CFE_MSG_PTR(UPPER_APP_Data.HkTlm.TelemetryHeader), true);
}

/* True if a message has the length of its struct. Else it counts as refused. */
static bool UPPER_APP_HasLength(const CFE_MSG_Message_t *Message, size_t Expected)
{
    CFE_MSG_Size_t Length = 0;
    CFE_SB_MsgId_t MsgId = CFE_SB_INVALID_MSG_ID;

    CFE_MSG_GetSize(Message, &Length);
    if (Length == Expected) {
        return true;
    }
    CFE_MSG_GetMsgId(Message, &MsgId);
    UPPER_APP_Data.HkTlm.Payload.RefusedMessages++;
    CFE_EVS_SendEvent(UPPER_APP_LENGTH_ERR_EID, CFE_EVS_EventType_ERROR,
        "UPPER: message 0x%X has %lu bytes, not %lu", (unsigned int)CFE_SB_MsgIdToValue(MsgId), (unsigned long)Length,
        (unsigned long)Expected);
    return false;
}

/* Executes a command from the ground. */
static void UPPER_APP_Command(const CFE_MSG_Message_t *Message)
{
    CFE_MSG_FcnCode_t Code = 0;

    CFE_MSG_GetFcnCode(Message, &Code);
    if (!UPPER_APP_HasLength(Message, sizeof(UPPER_APP_NoArgsCmd_t))) {
        UPPER_APP_Data.HkTlm.Payload.CommandErrorCounter++;
        return;
    }
    switch (Code) {
        case UPPER_APP_NOOP_CC:
            UPPER_APP_Data.HkTlm.Payload.CommandCounter++;
            CFE_EVS_SendEvent(UPPER_APP_NOOP_EID, CFE_EVS_EventType_INFORMATION,
                "UPPER: control system, exported by flexsc VERSION");
            break;
        case UPPER_APP_RESET_COUNTERS_CC:
            memset(&UPPER_APP_Data.HkTlm.Payload, 0, sizeof(UPPER_APP_Data.HkTlm.Payload));
            CFE_EVS_SendEvent(UPPER_APP_RESET_EID, CFE_EVS_EventType_INFORMATION, "UPPER: counters are zero");
            break;
        case UPPER_APP_RESTART_CC:
            BEGIN_STATE
            UPPER_APP_Data.Has_LAW_Input = false;
            UPPER_APP_Data.HkTlm.Payload.CommandCounter++;
            CFE_EVS_SendEvent(UPPER_APP_RESTART_EID, CFE_EVS_EventType_INFORMATION,
                "UPPER: the control system starts again");
            break;
        default:
            UPPER_APP_Data.HkTlm.Payload.CommandErrorCounter++;
            CFE_EVS_SendEvent(UPPER_APP_CODE_ERR_EID, CFE_EVS_EventType_ERROR, "UPPER: no command has code %u",
                (unsigned int)Code);
            break;
    }
}

/* Treats a message. */
static void UPPER_APP_Receive(const CFE_SB_Buffer_t *Buffer)
{
    const CFE_MSG_Message_t *Message = &Buffer->Msg;
    CFE_SB_MsgId_t MsgId = CFE_SB_INVALID_MSG_ID;

    CFE_MSG_GetMsgId(Message, &MsgId);
    switch (CFE_SB_MsgIdToValue(MsgId)) {
CASES        case UPPER_APP_WAKE_UP_MID:
            if (UPPER_APP_HasLength(Message, sizeof(UPPER_APP_NoArgsCmd_t))) {
                UPPER_APP_WakeUp();
            }
            break;
        case UPPER_APP_SEND_HK_MID:
            if (UPPER_APP_HasLength(Message, sizeof(UPPER_APP_NoArgsCmd_t))) {
                UPPER_APP_SendHk();
            }
            break;
        case UPPER_APP_CMD_MID:
            UPPER_APP_Command(Message);
            break;
        default:
            UPPER_APP_Data.HkTlm.Payload.RefusedMessages++;
            CFE_EVS_SendEvent(UPPER_APP_MESSAGE_ERR_EID, CFE_EVS_EventType_ERROR, "UPPER: message 0x%X is not for this app",
                (unsigned int)CFE_SB_MsgIdToValue(MsgId));
            break;
    }
}

/* Prepares the control system, the messages and the pipe. */
static CFE_Status_t UPPER_APP_Init(void)
{
    static const CFE_SB_MsgId_Atom_t Subscribed[] = {
        SUBSCRIBED, UPPER_APP_WAKE_UP_MID, UPPER_APP_SEND_HK_MID, UPPER_APP_CMD_MID
    };
    /* Faults that come back at each message are reported 16 times. */
    static const CFE_EVS_BinFilter_t Filters[] = {
        { UPPER_APP_LENGTH_ERR_EID, CFE_EVS_FIRST_16_STOP },
        { UPPER_APP_MESSAGE_ERR_EID, CFE_EVS_FIRST_16_STOP },
        { UPPER_APP_MISSED_ERR_EID, CFE_EVS_FIRST_16_STOP }
    };
    CFE_Status_t Status;

    memset(&UPPER_APP_Data, 0, sizeof(UPPER_APP_Data));
    UPPER_APP_Data.RunStatus = CFE_ES_RunStatus_APP_RUN;
DEFAULTS    BEGIN_STATE
INITIALISED    CFE_MSG_Init(CFE_MSG_PTR(UPPER_APP_Data.HkTlm.TelemetryHeader), CFE_SB_ValueToMsgId(UPPER_APP_HK_TLM_MID),
        sizeof(UPPER_APP_Data.HkTlm));
    Status = CFE_EVS_Register(Filters, sizeof(Filters) / sizeof(Filters[0]), CFE_EVS_EventFilter_BINARY);
    if (Status != CFE_SUCCESS) {
        CFE_ES_WriteToSysLog("UPPER: events are not registered, status 0x%08lX\n", (unsigned long)Status);
        return Status;
    }
    Status = CFE_SB_CreatePipe(&UPPER_APP_Data.Pipe, UPPER_APP_PIPE_DEPTH, UPPER_APP_PIPE_NAME);
    for (size_t Index = 0; Status == CFE_SUCCESS && Index < sizeof(Subscribed) / sizeof(Subscribed[0]); Index++) {
        Status = CFE_SB_Subscribe(CFE_SB_ValueToMsgId(Subscribed[Index]), UPPER_APP_Data.Pipe);
    }
    if (Status != CFE_SUCCESS) {
        CFE_EVS_SendEvent(UPPER_APP_SUBSCRIBE_ERR_EID, CFE_EVS_EventType_ERROR,
            "UPPER: no pipe or no subscription, status 0x%08lX", (unsigned long)Status);
        return Status;
    }
    CFE_EVS_SendEvent(UPPER_APP_INIT_EID, CFE_EVS_EventType_INFORMATION,
        "UPPER: control system, exported by flexsc VERSION");
    return CFE_SUCCESS;
}

void UPPER_APP_Main(void)
{
    CFE_SB_Buffer_t *Buffer = NULL;

    CFE_ES_PerfLogEntry(UPPER_APP_PERF_ID);
    if (UPPER_APP_Init() != CFE_SUCCESS) {
        UPPER_APP_Data.RunStatus = CFE_ES_RunStatus_APP_ERROR;
    }
    while (CFE_ES_RunLoop(&UPPER_APP_Data.RunStatus)) {
        CFE_ES_PerfLogExit(UPPER_APP_PERF_ID);
        const CFE_Status_t Status = CFE_SB_ReceiveBuffer(&Buffer, UPPER_APP_Data.Pipe, CFE_SB_PEND_FOREVER);
        CFE_ES_PerfLogEntry(UPPER_APP_PERF_ID);
        if (Status == CFE_SUCCESS) {
            UPPER_APP_Receive(Buffer);
        } else {
            CFE_EVS_SendEvent(UPPER_APP_PIPE_ERR_EID, CFE_EVS_EventType_ERROR, "UPPER: the pipe fails, status 0x%08lX",
                (unsigned long)Status);
            UPPER_APP_Data.RunStatus = CFE_ES_RunStatus_APP_ERROR;
        }
    }
    CFE_ES_PerfLogExit(UPPER_APP_PERF_ID);
    CFE_ES_ExitApp(UPPER_APP_Data.RunStatus);
}
