/* STUB of cFE: the part of its interface that the app calls, so that the app is compiled and run without cFS.
 *
 * This is no part of cFS, and no text of it. A mission builds the app with the headers of cFE instead.
 */
#ifndef STUB_CFE_H
#define STUB_CFE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint8_t uint8;
typedef uint16_t uint16;
typedef uint32_t uint32;
typedef int64_t int64;

typedef int32_t CFE_Status_t;
#define CFE_SUCCESS ((CFE_Status_t)0)

/* Messages: a head of 8 bytes for commands, of 16 for telemetry. */
typedef size_t CFE_MSG_Size_t;
typedef uint16 CFE_MSG_FcnCode_t;
typedef uint32 CFE_SB_MsgId_Atom_t;
typedef struct {
    CFE_SB_MsgId_Atom_t Value;
} CFE_SB_MsgId_t;
typedef struct {
    uint16 MsgId;
    uint16 FcnCode;
    uint32 Size;
} CFE_MSG_Message_t;
typedef struct {
    CFE_MSG_Message_t Msg;
} CFE_MSG_CommandHeader_t;
typedef struct {
    CFE_MSG_Message_t Msg;
    uint8 Time[8];
} CFE_MSG_TelemetryHeader_t;
typedef union {
    CFE_MSG_Message_t Msg;
    int64 Aligned;
    double AlignedReal;
} CFE_SB_Buffer_t;
#define CFE_SB_INVALID_MSG_ID ((CFE_SB_MsgId_t){ 0 })
#define CFE_MSG_PTR(header) (&(header).Msg)

CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t MsgId, CFE_MSG_Size_t Size);
CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t *MsgId);
CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Size_t *Size);
CFE_Status_t CFE_MSG_GetFcnCode(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_FcnCode_t *FcnCode);

/* Software bus. */
typedef uint32 CFE_SB_PipeId_t;
#define CFE_SB_PEND_FOREVER (-1)
CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *PipeIdPtr, uint16 Depth, const char *PipeName);
CFE_Status_t CFE_SB_Subscribe(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId);
CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **BufPtr, CFE_SB_PipeId_t PipeId, int32_t TimeOut);
CFE_Status_t CFE_SB_TransmitMsg(const CFE_MSG_Message_t *MsgPtr, bool IsOrigination);
void CFE_SB_TimeStampMsg(CFE_MSG_Message_t *MsgPtr);
static inline CFE_SB_MsgId_Atom_t CFE_SB_MsgIdToValue(CFE_SB_MsgId_t MsgId)
{
    return MsgId.Value;
}
static inline CFE_SB_MsgId_t CFE_SB_ValueToMsgId(CFE_SB_MsgId_Atom_t Value)
{
    return (CFE_SB_MsgId_t){ Value };
}

/* Events. */
enum { CFE_EVS_EventType_INFORMATION = 2, CFE_EVS_EventType_ERROR = 3 };
enum { CFE_EVS_EventFilter_BINARY = 0 };
#define CFE_EVS_FIRST_16_STOP 0xFFF0
typedef struct {
    uint16 EventID;
    uint16 Mask;
} CFE_EVS_BinFilter_t;
CFE_Status_t CFE_EVS_Register(const void *Filters, uint16 NumEventFilters, uint16 FilterScheme);
CFE_Status_t CFE_EVS_SendEvent(uint16 EventID, uint16 EventType, const char *Spec, ...) __attribute__((format(printf, 3, 4)));

/* Executive. */
enum { CFE_ES_RunStatus_APP_RUN = 1, CFE_ES_RunStatus_APP_ERROR = 3 };
bool CFE_ES_RunLoop(uint32 *RunStatus);
void CFE_ES_ExitApp(uint32 ExitStatus);
CFE_Status_t CFE_ES_WriteToSysLog(const char *SpecStringPtr, ...) __attribute__((format(printf, 1, 2)));
#define CFE_ES_PerfLogEntry(id) ((void)(id))
#define CFE_ES_PerfLogExit(id) ((void)(id))

/* Tables: the app has one. */
typedef int16_t CFE_TBL_Handle_t;
typedef int32_t (*CFE_TBL_CallbackFuncPtr_t)(void *TblPtr);
enum { CFE_TBL_OPT_DEFAULT = 0, CFE_TBL_SRC_ADDRESS = 1, CFE_TBL_INFO_UPDATED = 0x4c000c00 };
CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t *TblHandlePtr, const char *Name, size_t Size, uint16 TblOptionFlags,
    CFE_TBL_CallbackFuncPtr_t TblValidationFuncPtr);
CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t TblHandle, int SrcType, const void *SrcDataPtr);
CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_GetAddress(void **TblPtr, CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t TblHandle);
/* A table in a file of its own. */
#define CFE_TBL_FILEDEF(ObjName, TblName, Desc, Filename) \
    extern const char *const ObjName##_file[]; \
    const char *const ObjName##_file[] = { #TblName, #Desc, #Filename };

/* Numbers of messages. */
#define CFE_PLATFORM_CMD_TOPICID_TO_MIDV(topic) (0x1800 | (topic))
#define CFE_PLATFORM_TLM_TOPICID_TO_MIDV(topic) (0x0800 | (topic))

#endif
