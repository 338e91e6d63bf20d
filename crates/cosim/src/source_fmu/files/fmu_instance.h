/* Instance of the FMU: the exported control system, the values of its variables, and the times at which its functions are due. */
#ifndef FMU_INSTANCE_H
#define FMU_INSTANCE_H

#include "fmu_model.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Functions of the interface have a prefix if a program links several FMUs. */
#define FMU_PASTE(a, b) a##b
#define FMU_PASTED(a, b) FMU_PASTE(a, b)
#if defined(_WIN32)
#define FMU_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define FMU_EXPORT __attribute__((visibility("default")))
#else
#define FMU_EXPORT
#endif

/* Time: whole seconds, plus 0 to 10^15 - 1 femtoseconds. */
typedef struct {
    int64_t whole;
    int64_t part;
} fmu_ticks;

/* Time that never comes. */
#define FMU_NEVER INT64_MAX

/* Phase of an instance. */
typedef enum { FMU_INSTANTIATED, FMU_INITIALIZATION, FMU_STEPS, FMU_TERMINATED } fmu_phase;

/* Everything that changes in a run. A copy is a snapshot: there are no pointers in it. */
typedef struct {
    FMU_STATE state;
    /* Value of each variable, by its value reference. */
    double values[FMU_VALUES];
    /* Value of each input that acts when it changes, as it was seen last. */
    double watched[FMU_WATCHED];
    /* Time of the last reading of each sensor that was seen; before 0 s without one. */
    fmu_ticks seen[FMU_SENSORS];
    /* Time of the start, also in seconds. */
    fmu_ticks start;
    double start_time;
    /* Times at which conditions of modes, wheels' unloading, samples of a period and laws are due. */
    fmu_ticks next_test;
    fmu_ticks next_unload;
    fmu_ticks next_sample;
    fmu_ticks next_step;
    /* Period of the laws. */
    fmu_ticks period;
    /* Current communication point (s). */
    double time;
    fmu_phase phase;
} fmu_run;

/* Kinds of variables. */
enum { FMU_FLOAT, FMU_INTEGER };

/* What an importer may set. */
enum { FMU_OUTPUT, FMU_INPUT, FMU_PARAMETER };

/* Kind, access and start value of a variable. */
typedef struct {
    unsigned char kind;
    unsigned char access;
    double start;
} fmu_variable;

extern const fmu_variable fmu_variables[FMU_VALUES];

bool fmu_is_before(fmu_ticks a, fmu_ticks b);
fmu_ticks fmu_sum(fmu_ticks a, fmu_ticks b);
/* Returns a - b (s). */
double fmu_since(fmu_ticks a, fmu_ticks b);
/* Returns true once for each reading: the sensor's time has changed. */
bool fmu_is_new(const fmu_run *run, int sensor, size_t time_reference, fmu_ticks *at);
/* Returns true if inputs that act when they change have changed, and remembers their values. */
bool fmu_has_changed(fmu_run *run, size_t watched, size_t reference, size_t count);

/* Sets all values to those of the start. */
void fmu_reset(fmu_run *run);
/* Moves from one phase to another; returns a message, or NULL. */
const char *fmu_move(fmu_run *run, fmu_phase from, fmu_phase to);
/* Begins at the start time; returns a message, or NULL. */
const char *fmu_begin(fmu_run *run);
/* Advances by a step (s); returns a message, or NULL. */
const char *fmu_step(fmu_run *run, double from, double size);
/* Reads or sets a value of a kind; returns a message, or NULL. */
const char *fmu_get(const fmu_run *run, size_t reference, unsigned char kind, double *value);
const char *fmu_set(fmu_run *run, size_t reference, unsigned char kind, double value);

/* A serialised run has the token of the FMU first: another FMU refuses it. */
enum { FMU_TOKEN_SIZE = sizeof FMU_TOKEN, FMU_BYTES = FMU_TOKEN_SIZE + sizeof(fmu_run) };
/* Write and read a serialised run; return a message, or NULL. */
const char *fmu_pack(const fmu_run *run, unsigned char *bytes, size_t size);
const char *fmu_unpack(fmu_run *run, const unsigned char *bytes, size_t size);

/* Of fmu_calls.c, which is written for each control system. Starts it; returns a message, or NULL. */
const char *fmu_start(fmu_run *run, fmu_ticks now);
/* Takes new readings, and calls the functions that are due. */
void fmu_act(fmu_run *run, fmu_ticks now);

#endif
