/* Numbers of a processor. */
#ifndef UPPER_APP_PLATFORM_CFG_H
#define UPPER_APP_PLATFORM_CFG_H

/* Messages that wait at most. */
#define UPPER_APP_PIPE_DEPTH 32
/* Name of the pipe, of at most 19 characters. */
#define UPPER_APP_PIPE_NAME "PIPE_NAME"

#endif
