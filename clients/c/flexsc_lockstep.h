/* A control program in lockstep with `flexsc serve`: the sensors of each cycle in, its commands out.
 *
 * C99 and the sockets of POSIX; no memory is allocated. A client is used like this:
 *
 *     static flexsc_client client;
 *     if (flexsc_connect(&client, FLEXSC_UDP, "127.0.0.1", 5010, 0) != 0) { puts(client.error); return 1; }
 *     const int rate = flexsc_find(&client, "estimate.rate");
 *     while (flexsc_receive(&client) == 1) {
 *         double torque[3];
 *         for (int axis = 0; axis < 3; axis++) torque[axis] = -10.0 * flexsc_number(&client, rate, axis);
 *         flexsc_command(&client, torque, FLEXSC_TORQUE);
 *     }
 *     flexsc_close(&client);
 */
#ifndef FLEXSC_LOCKSTEP_H
#define FLEXSC_LOCKSTEP_H

#include <stddef.h>
#include <stdint.h>

#define FLEXSC_VERSION 1
#define FLEXSC_MOST_FIELDS 512
#define FLEXSC_LONGEST_PACKET 60000
#define FLEXSC_LONGEST_NAME 64

enum { FLEXSC_UDP, FLEXSC_TCP };

/* Quantities of commands: N m, rad/s, rad/s^2, A m^2; the last one stands for no command. */
enum { FLEXSC_TORQUE, FLEXSC_RATE_CHANGE, FLEXSC_ACCELERATION, FLEXSC_MOMENT, FLEXSC_HOLD };

/* Values of a field such as `gyro.status`: no reading yet, no new one since the last cycle, a new one. */
enum { FLEXSC_NONE, FLEXSC_HELD, FLEXSC_NEW };

/* Ends of a run. */
enum { FLEXSC_COMPLETE, FLEXSC_INTERRUPTED, FLEXSC_FAILED };

/* Field of the packet with the sensors. */
typedef struct {
    char name[FLEXSC_LONGEST_NAME];
    char unit[16];
    char type; /* 'b' of 8 bits, 'w' of 32, 'u' of 64 without a sign, 'i' of 64 with one, 'd' a double */
    int count; /* number of components */
    size_t offset;
} flexsc_field;

typedef struct {
    /* Agreed with the server. */
    int axes;            /* number of axes with commands: 1 or 3 */
    int64_t period_s;    /* period of the cycles: whole seconds, and femtoseconds past them */
    int64_t period_fs;
    uint64_t layout;     /* identity of the packets */
    int pace;            /* 0 free, 1 in real time, 2 by requests of the client */
    int field_count;
    flexsc_field fields[FLEXSC_MOST_FIELDS];
    /* Of the present cycle. */
    uint64_t cycle;      /* number of the cycle, from 0 */
    int64_t time_s;      /* simulated time: whole seconds, and femtoseconds past them */
    int64_t time_fs;
    /* Set by the user between connecting and receiving, if another value than 10 s is wanted. */
    int timeout_ms;      /* longest silence of the server */
    /* Results. */
    int end;             /* how the run has ended, once `flexsc_receive` has returned 0 */
    char error[256];     /* text of the last error */
    /* Internal. */
    int socket;
    int transport;
    int has_cycle;
    uint32_t session;
    uint16_t counts[8];
    size_t content_length;
    size_t answer_length; /* 0 if the cycle has no answer yet */
    size_t stream_length;
    unsigned char content[FLEXSC_LONGEST_PACKET];
    unsigned char answer[64];
    unsigned char received[FLEXSC_LONGEST_PACKET];
    unsigned char stream[FLEXSC_LONGEST_PACKET];
} flexsc_client;

/* Connects to a server, which refuses a client that expects another layout of the packets; 0 for any. Returns 0, or -1 with
 * the text `error`. */
int flexsc_connect(flexsc_client *client, int transport, const char *host, uint16_t port, uint64_t layout);

/* Waits for the next cycle. Returns 1 for a cycle, 0 at the end of the run, and -1 with the text `error`. */
int flexsc_receive(flexsc_client *client);

/* Returns the index of a field such as "gyro.rate"; -1 if the scenario has no such field. */
int flexsc_find(const flexsc_client *client, const char *name);

/* Returns a component of a field of the present cycle as a double; NaN if there is none. */
double flexsc_number(const flexsc_client *client, int field, int component);

/* Returns a component of an integer field of the present cycle; 0 if there is none. */
int64_t flexsc_integer(const flexsc_client *client, int field, int component);

/* Reads the first numbers of a field of the present cycle by its name; NaN where there are none. */
void flexsc_read(const flexsc_client *client, const char *name, double *numbers, int count);

/* Returns true if a reading of a sensor, such as "gyro", has come since the last cycle. */
int flexsc_is_new(const flexsc_client *client, const char *sensor);

/* Answers the present cycle with commands of one quantity about all axes. Returns 0, or -1 with the text `error`. */
int flexsc_command(flexsc_client *client, const double *values, int quantity);

/* Answers the present cycle with commands of a quantity for each axis. */
int flexsc_command_each(flexsc_client *client, const double *values, const int *quantities);

/* Answers the present cycle without commands: those in force stay, and the run goes on as if the cycle had not been. */
int flexsc_hold(flexsc_client *client);

/* Closes the connection. */
void flexsc_close(flexsc_client *client);

#endif
