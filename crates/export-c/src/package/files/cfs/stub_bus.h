/* STUB of cFE: a software bus for one app. See cfe.h. */
#ifndef STUB_BUS_H
#define STUB_BUS_H

#include "cfe.h"

/* Returns the next message for the app; NULL ends the app. */
CFE_SB_Buffer_t *bus_next_message(void);

/* Takes a message that the app sends. */
void bus_take_message(const CFE_MSG_Message_t *message);

/* True if the app subscribes to a message. */
bool bus_is_subscribed(CFE_SB_MsgId_Atom_t message);

/* Returns how often an event was sent. */
unsigned long bus_events(uint16 event);

/* Returns the status with which the app ended. */
uint32 bus_exit_status(void);

#endif
