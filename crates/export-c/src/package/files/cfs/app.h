/* App of cFS around the control system of ORIGIN, exported by flexsc VERSION. */
#ifndef UPPER_APP_H
#define UPPER_APP_H

#include "cfe.h"

#include "LOWER.h"
#include "LOWER_app_msg.h"

/* Data of the app. */
typedef struct {
    LOWER_state State;
    /* Inputs of the next decision, and true from their arrival to the decision. */
    UPPER_APP_LAW_Input_t LAW_Input;
    bool Has_LAW_Input;
OUTPUTS    UPPER_APP_HkTlm_t HkTlm;
    CFE_SB_PipeId_t Pipe;
    uint32 RunStatus;
} UPPER_APP_Data_t;

extern UPPER_APP_Data_t UPPER_APP_Data;

/* Runs the app, until the executive ends it. */
void UPPER_APP_Main(void);

#endif
