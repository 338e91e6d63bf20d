/* Time and values of an instance. */
#include "fmu_instance.h"

#include <math.h>
#include <string.h>

#define SECOND INT64_C(1000000000000000)

/* A function is due at a communication point within half a nanosecond: sums of doubles are not exact. */
static const fmu_ticks tolerance = {0, INT64_C(500000)};

bool fmu_is_before(fmu_ticks a, fmu_ticks b)
{
    return a.whole < b.whole || (a.whole == b.whole && a.part < b.part);
}

fmu_ticks fmu_sum(fmu_ticks a, fmu_ticks b)
{
    fmu_ticks sum = {a.whole + b.whole, a.part + b.part};
    if (sum.part >= SECOND) {
        sum.part -= SECOND;
        sum.whole += 1;
    }
    return sum;
}

double fmu_since(fmu_ticks a, fmu_ticks b)
{
    int64_t whole = a.whole - b.whole;
    int64_t part = a.part - b.part;
    if (part < 0) {
        part += SECOND;
        whole -= 1;
    }
    /* Short spans are rounded once. */
    if (whole > -9000 && whole < 9000) {
        return (double)(whole * SECOND + part) / (double)SECOND;
    }
    return (double)whole + (double)part / (double)SECOND;
}

static fmu_ticks ticks_of(double seconds)
{
    const double whole = floor(seconds);
    fmu_ticks ticks = {(int64_t)whole, (int64_t)floor((seconds - whole) * (double)SECOND + 0.5)};
    if (ticks.part >= SECOND) {
        ticks.part -= SECOND;
        ticks.whole += 1;
    }
    return ticks;
}

bool fmu_is_new(const fmu_run *run, int sensor, size_t time_reference, fmu_ticks *at)
{
    const double whole = run->values[time_reference];
    const double part = run->values[time_reference + 1];
    if (!(whole >= 0.0 && whole < 1e15 && part >= 0.0 && part < (double)SECOND)) {
        return false;
    }
    at->whole = (int64_t)whole;
    at->part = (int64_t)part;
    return at->whole != run->seen[sensor].whole || at->part != run->seen[sensor].part;
}

bool fmu_has_changed(fmu_run *run, size_t watched, size_t reference, size_t count)
{
    const size_t size = count * sizeof(double);
    if (memcmp(&run->watched[watched], &run->values[reference], size) == 0) {
        return false;
    }
    memcpy(&run->watched[watched], &run->values[reference], size);
    return true;
}

void fmu_reset(fmu_run *run)
{
    memset(run, 0, sizeof *run);
    for (size_t reference = 0; reference < FMU_VALUES; ++reference) {
        run->values[reference] = fmu_variables[reference].start;
    }
}

/* Returns the time at which a function is due next. */
static fmu_ticks next(const fmu_run *run)
{
    fmu_ticks first = run->next_step;
    const fmu_ticks others[] = {run->next_test, run->next_unload, run->next_sample};
    for (size_t index = 0; index < 3; ++index) {
        if (fmu_is_before(others[index], first)) {
            first = others[index];
        }
    }
    return first;
}

/* Calls the functions that are due at a time, and counts the event. */
static void respond(fmu_run *run, fmu_ticks now)
{
    run->values[FMU_EVENTS] += 1.0;
    run->values[FMU_EVENT_WHOLE] = (double)now.whole;
    run->values[FMU_EVENT_PART] = (double)now.part;
    fmu_act(run, now);
}

static void set_time(fmu_run *run, double time, fmu_ticks now)
{
    run->time = time;
    run->values[FMU_TIME] = time;
    run->values[FMU_TIME_WHOLE] = (double)now.whole;
    run->values[FMU_TIME_PART] = (double)now.part;
}

const char *fmu_move(fmu_run *run, fmu_phase from, fmu_phase to)
{
    if (run->phase != from) {
        return "the function may not be called now";
    }
    run->phase = to;
    return NULL;
}

const char *fmu_begin(fmu_run *run)
{
    const char *refused = fmu_move(run, FMU_INITIALIZATION, FMU_STEPS);
    if (refused != NULL) {
        return refused;
    }
    if (!(fabs(run->start_time) < 1e15)) {
        return "the start time must be a number below 1e15 s";
    }
    const fmu_ticks never = {FMU_NEVER, 0};
    run->start = ticks_of(run->start_time);
    set_time(run, run->start_time, run->start);
    for (size_t sensor = 0; sensor < FMU_SENSORS; ++sensor) {
        run->seen[sensor].whole = -1;
    }
    run->next_test = never;
    run->next_unload = never;
    run->next_sample = never;
    run->next_step = never;
    return fmu_start(run, run->start);
}

const char *fmu_step(fmu_run *run, double from, double size)
{
    const double end = from + size;
    if (run->phase != FMU_STEPS) {
        return "the function may not be called now";
    }
    if (!(fabs(from - run->time) <= 1e-9 + 8.0 * 2.3e-16 * fabs(from))) {
        return "the step does not begin where the last one ended";
    }
    if (!(size >= 0.0) || !(fabs(end) < 1e15)) {
        return "the size of a step must be a time";
    }
    const fmu_ticks point = ticks_of(from);
    fmu_ticks due = next(run);
    if (fmu_is_before(fmu_sum(point, tolerance), due)) {
        fmu_act(run, point);
    } else {
        respond(run, due);
    }
    const fmu_ticks last = ticks_of(end);
    for (due = next(run); fmu_is_before(due, last) && fmu_is_before(fmu_sum(due, tolerance), last); due = next(run)) {
        respond(run, due);
    }
    const bool is_exact = due.whole != FMU_NEVER && !fmu_is_before(fmu_sum(last, tolerance), due);
    set_time(run, end, is_exact ? due : last);
    return NULL;
}

static const char *find(size_t reference, unsigned char kind)
{
    if (reference >= FMU_VALUES) {
        return "there is no variable with this value reference";
    }
    return fmu_variables[reference].kind == kind ? NULL : "the variable is of another type";
}

const char *fmu_get(const fmu_run *run, size_t reference, unsigned char kind, double *value)
{
    const char *refused = find(reference, kind);
    if (refused == NULL) {
        *value = run->values[reference];
    }
    return refused;
}

const char *fmu_set(fmu_run *run, size_t reference, unsigned char kind, double value)
{
    const char *refused = find(reference, kind);
    if (refused != NULL) {
        return refused;
    }
    if (fmu_variables[reference].access == FMU_OUTPUT) {
        return "the variable is no input and no parameter";
    }
    if (fmu_variables[reference].access == FMU_PARAMETER && run->phase >= FMU_STEPS) {
        return "a parameter is set before the end of the initialization";
    }
    run->values[reference] = value;
    return NULL;
}

const char *fmu_pack(const fmu_run *run, unsigned char *bytes, size_t size)
{
    if (size < FMU_BYTES) {
        return "there is no room for the state";
    }
    memcpy(bytes, FMU_TOKEN, FMU_TOKEN_SIZE);
    memcpy(bytes + FMU_TOKEN_SIZE, run, sizeof *run);
    return NULL;
}

const char *fmu_unpack(fmu_run *run, const unsigned char *bytes, size_t size)
{
    if (size != FMU_BYTES || memcmp(bytes, FMU_TOKEN, FMU_TOKEN_SIZE) != 0) {
        return "the serialised state is that of another FMU";
    }
    memcpy(run, bytes + FMU_TOKEN_SIZE, sizeof *run);
    return NULL;
}
