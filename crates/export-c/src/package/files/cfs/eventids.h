/* Events of the app. */
#ifndef UPPER_APP_EVENTIDS_H
#define UPPER_APP_EVENTIDS_H

#define UPPER_APP_INIT_EID          1
#define UPPER_APP_NOOP_EID          2
#define UPPER_APP_RESET_EID         3
#define UPPER_APP_RESTART_EID       4
#define UPPER_APP_CODE_ERR_EID      5
#define UPPER_APP_LENGTH_ERR_EID    6
#define UPPER_APP_MESSAGE_ERR_EID   7
#define UPPER_APP_MISSED_ERR_EID    8
#define UPPER_APP_SUBSCRIBE_ERR_EID 9
#define UPPER_APP_PIPE_ERR_EID      10

#endif
