/* STUB of cFE: a software bus that brings the app one message after another, and events that are counted. See cfe.h. */

#include "bus.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MOST_SUBSCRIBED = 32, MOST_EVENTS = 32 };

static CFE_SB_MsgId_Atom_t subscribed[MOST_SUBSCRIBED];
static size_t subscriptions;
static unsigned long events[MOST_EVENTS];
static CFE_SB_Buffer_t *waiting;
static uint32 exit_status;

bool bus_is_subscribed(CFE_SB_MsgId_Atom_t message)
{
    for (size_t index = 0; index < subscriptions; ++index) {
        if (subscribed[index] == message) {
            return true;
        }
    }
    return false;
}

unsigned long bus_events(uint16 event)
{
    return event < MOST_EVENTS ? events[event] : 0;
}

uint32 bus_exit_status(void)
{
    return exit_status;
}

CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t MsgId, CFE_MSG_Size_t Size)
{
    MsgPtr->MsgId = (uint16)MsgId.Value;
    MsgPtr->FcnCode = 0;
    MsgPtr->Size = (uint32)Size;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t *MsgId)
{
    MsgId->Value = MsgPtr->MsgId;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Size_t *Size)
{
    *Size = MsgPtr->Size;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetFcnCode(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_FcnCode_t *FcnCode)
{
    *FcnCode = MsgPtr->FcnCode;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *PipeIdPtr, uint16 Depth, const char *PipeName)
{
    *PipeIdPtr = 1;
    return Depth > 0 && strlen(PipeName) < 20 ? CFE_SUCCESS : -1;
}

static struct {
    CFE_TBL_CallbackFuncPtr_t validate;
    size_t size;
    bool is_updated;
    double numbers[1024];
} table;

CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t *TblHandlePtr, const char *Name, size_t Size, uint16 TblOptionFlags,
    CFE_TBL_CallbackFuncPtr_t TblValidationFuncPtr)
{
    *TblHandlePtr = 7;
    table.validate = TblValidationFuncPtr;
    table.size = Size;
    return strlen(Name) < 16 && TblOptionFlags == CFE_TBL_OPT_DEFAULT && Size <= sizeof table.numbers ? CFE_SUCCESS : -1;
}

CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t TblHandle, int SrcType, const void *SrcDataPtr)
{
    double numbers[1024];
    memcpy(numbers, SrcDataPtr, table.size);
    if (TblHandle != 7 || SrcType != CFE_TBL_SRC_ADDRESS || table.validate(numbers) != CFE_SUCCESS) {
        return -1;
    }
    memcpy(table.numbers, numbers, table.size);
    table.is_updated = true;
    return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t TblHandle)
{
    return TblHandle == 7 ? CFE_SUCCESS : -1;
}

CFE_Status_t CFE_TBL_GetAddress(void **TblPtr, CFE_TBL_Handle_t TblHandle)
{
    const CFE_Status_t status = table.is_updated ? (CFE_Status_t)CFE_TBL_INFO_UPDATED : CFE_SUCCESS;
    *TblPtr = table.numbers;
    table.is_updated = false;
    return TblHandle == 7 ? status : -1;
}

CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t TblHandle)
{
    return TblHandle == 7 ? CFE_SUCCESS : -1;
}

CFE_Status_t CFE_SB_Subscribe(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId)
{
    if (PipeId != 1 || subscriptions == MOST_SUBSCRIBED || bus_is_subscribed(MsgId.Value)) {
        return -1;
    }
    subscribed[subscriptions++] = MsgId.Value;
    return CFE_SUCCESS;
}

bool CFE_ES_RunLoop(uint32 *RunStatus)
{
    if (*RunStatus != CFE_ES_RunStatus_APP_RUN) {
        return false;
    }
    waiting = bus_next_message();
    return waiting != NULL;
}

CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **BufPtr, CFE_SB_PipeId_t PipeId, int32_t TimeOut)
{
    *BufPtr = waiting;
    return PipeId == 1 && TimeOut == CFE_SB_PEND_FOREVER ? CFE_SUCCESS : -1;
}

CFE_Status_t CFE_SB_TransmitMsg(const CFE_MSG_Message_t *MsgPtr, bool IsOrigination)
{
    (void)IsOrigination;
    bus_take_message(MsgPtr);
    return CFE_SUCCESS;
}

void CFE_SB_TimeStampMsg(CFE_MSG_Message_t *MsgPtr)
{
    (void)MsgPtr;
}

CFE_Status_t CFE_EVS_Register(const void *Filters, uint16 NumEventFilters, uint16 FilterScheme)
{
    (void)FilterScheme;
    return Filters != NULL || NumEventFilters == 0 ? CFE_SUCCESS : -1;
}

CFE_Status_t CFE_EVS_SendEvent(uint16 EventID, uint16 EventType, const char *Spec, ...)
{
    char text[256];
    va_list arguments;

    (void)EventType;
    va_start(arguments, Spec);
    vsnprintf(text, sizeof(text), Spec, arguments);
    va_end(arguments);
    if (EventID < MOST_EVENTS) {
        events[EventID]++;
    }
    return CFE_SUCCESS;
}

CFE_Status_t CFE_ES_WriteToSysLog(const char *SpecStringPtr, ...)
{
    fputs(SpecStringPtr, stderr);
    return CFE_SUCCESS;
}

void CFE_ES_ExitApp(uint32 ExitStatus)
{
    exit_status = ExitStatus;
}
