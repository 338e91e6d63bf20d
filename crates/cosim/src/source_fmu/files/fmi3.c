/* FMI 3.0 for co-simulation around an instance. Types and functions are those of the standard, declared here as far as needed. */
#include "fmu_instance.h"

#include <stdlib.h>
#include <string.h>

#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI3_OVERRIDE_FUNCTION_PREFIX)
#define NAME(name) FMU_PASTED(FMI3_FUNCTION_PREFIX, name)
#else
#define NAME(name) name
#endif

typedef enum { OK = 0, ERROR = 3 } status;
typedef uint32_t reference;
typedef void (*log_message)(void *environment, int state, const char *category, const char *message);

typedef struct {
    fmu_run run;
    log_message log;
    void *environment;
} instance;

static status result(const instance *own, const char *refused)
{
    if (refused == NULL) {
        return OK;
    }
    if (own->log != NULL) {
        own->log(own->environment, ERROR, "logStatusError", refused);
    }
    return ERROR;
}

FMU_EXPORT const char *NAME(fmi3GetVersion)(void)
{
    return "3.0";
}

FMU_EXPORT status NAME(fmi3SetDebugLogging)(void *own, bool is_on, size_t count, const char *const categories[])
{
    (void)own;
    (void)is_on;
    (void)count;
    (void)categories;
    return OK;
}

FMU_EXPORT void *NAME(fmi3InstantiateCoSimulation)(const char *name, const char *token, const char *resources, bool is_visible,
    bool is_logging, bool has_events, bool returns_early, const reference intermediate[], size_t count, void *environment,
    log_message log, void *update)
{
    (void)name;
    (void)resources;
    (void)is_visible;
    (void)is_logging;
    (void)has_events;
    (void)returns_early;
    (void)intermediate;
    (void)count;
    (void)update;
    if (token == NULL || strcmp(token, FMU_TOKEN) != 0) {
        if (log != NULL) {
            log(environment, ERROR, "logStatusError", "the instantiation token is that of another FMU");
        }
        return NULL;
    }
    instance *own = calloc(1, sizeof *own);
    if (own != NULL) {
        fmu_reset(&own->run);
        own->log = log;
        own->environment = environment;
    }
    return own;
}

FMU_EXPORT void NAME(fmi3FreeInstance)(void *own)
{
    free(own);
}

FMU_EXPORT status NAME(fmi3EnterInitializationMode)(void *own, bool has_tolerance, double tolerance, double start, bool has_stop,
    double stop)
{
    (void)has_tolerance;
    (void)tolerance;
    (void)has_stop;
    (void)stop;
    instance *all = own;
    all->run.start_time = start;
    return result(all, fmu_move(&all->run, FMU_INSTANTIATED, FMU_INITIALIZATION));
}

FMU_EXPORT status NAME(fmi3ExitInitializationMode)(void *own)
{
    instance *all = own;
    return result(all, fmu_begin(&all->run));
}

FMU_EXPORT status NAME(fmi3DoStep)(void *own, double from, double size, bool is_final, bool *needs_event, bool *terminates,
    bool *is_early, double *reached)
{
    instance *all = own;
    (void)is_final;
    *needs_event = false;
    *terminates = false;
    *is_early = false;
    const char *refused = fmu_step(&all->run, from, size);
    *reached = all->run.time;
    return result(all, refused);
}

FMU_EXPORT status NAME(fmi3Reset)(void *own)
{
    fmu_reset(&((instance *)own)->run);
    return OK;
}

/* Functions that move from one phase to another. */
#define MOVE(name, from, to)                                                                                                   \
    FMU_EXPORT status NAME(name)(void *own)                                                                                    \
    {                                                                                                                          \
        instance *all = own;                                                                                                   \
        return result(all, fmu_move(&all->run, from, to));                                                                     \
    }

MOVE(fmi3Terminate, FMU_STEPS, FMU_TERMINATED)
MOVE(fmi3EnterConfigurationMode, FMU_INSTANTIATED, FMU_INSTANTIATED)
MOVE(fmi3ExitConfigurationMode, FMU_INSTANTIATED, FMU_INSTANTIATED)
MOVE(fmi3EnterStepMode, FMU_STEPS, FMU_STEPS)

/* Reading and setting of the values of a type. */
#define ACCESS(type_name, type, kind)                                                                                          \
    FMU_EXPORT status NAME(fmi3Get##type_name)(void *own, const reference places[], size_t count, type values[], size_t size)  \
    {                                                                                                                          \
        instance *all = own;                                                                                                   \
        const char *refused = count == size ? NULL : "there are as many values as references";                                 \
        for (size_t index = 0; refused == NULL && index < count; ++index) {                                                    \
            double value = 0.0;                                                                                                \
            refused = fmu_get(&all->run, places[index], kind, &value);                                                         \
            values[index] = (type)value;                                                                                       \
        }                                                                                                                      \
        return result(all, refused);                                                                                           \
    }                                                                                                                          \
    FMU_EXPORT status NAME(fmi3Set##type_name)(                                                                                \
        void *own, const reference places[], size_t count, const type values[], size_t size)                                   \
    {                                                                                                                          \
        instance *all = own;                                                                                                   \
        const char *refused = count == size ? NULL : "there are as many values as references";                                 \
        for (size_t index = 0; refused == NULL && index < count; ++index) {                                                    \
            refused = fmu_set(&all->run, places[index], kind, (double)values[index]);                                          \
        }                                                                                                                      \
        return result(all, refused);                                                                                           \
    }

ACCESS(Float64, double, FMU_FLOAT)
ACCESS(Int64, int64_t, FMU_INTEGER)

FMU_EXPORT status NAME(fmi3GetFMUState)(void *own, void **state)
{
    if (*state == NULL) {
        *state = malloc(sizeof(fmu_run));
    }
    if (*state == NULL) {
        return result(own, "there is no memory for a state");
    }
    memcpy(*state, &((instance *)own)->run, sizeof(fmu_run));
    return OK;
}

FMU_EXPORT status NAME(fmi3SetFMUState)(void *own, void *state)
{
    memcpy(&((instance *)own)->run, state, sizeof(fmu_run));
    return OK;
}

FMU_EXPORT status NAME(fmi3FreeFMUState)(void *own, void **state)
{
    (void)own;
    free(*state);
    *state = NULL;
    return OK;
}

FMU_EXPORT status NAME(fmi3SerializedFMUStateSize)(void *own, void *state, size_t *size)
{
    (void)own;
    (void)state;
    *size = FMU_BYTES;
    return OK;
}

FMU_EXPORT status NAME(fmi3SerializeFMUState)(void *own, void *state, uint8_t bytes[], size_t size)
{
    return result(own, fmu_pack(state, bytes, size));
}

FMU_EXPORT status NAME(fmi3DeserializeFMUState)(void *own, const uint8_t bytes[], size_t size, void **state)
{
    const status copied = NAME(fmi3GetFMUState)(own, state);
    return copied == OK ? result(own, fmu_unpack(*state, bytes, size)) : copied;
}

/* Functions for what this FMU does not have: they return an error, and importers only look for them. */
#define ABSENT(name)                                                                                                           \
    FMU_EXPORT status NAME(name)(void *own)                                                                                    \
    {                                                                                                                          \
        return result(own, "this FMU has no such function");                                                                   \
    }

ABSENT(fmi3ActivateModelPartition)
ABSENT(fmi3CompletedIntegratorStep)
ABSENT(fmi3EnterContinuousTimeMode)
ABSENT(fmi3EnterEventMode)
ABSENT(fmi3EvaluateDiscreteStates)
ABSENT(fmi3GetAdjointDerivative)
ABSENT(fmi3GetBinary)
ABSENT(fmi3GetBoolean)
ABSENT(fmi3GetClock)
ABSENT(fmi3GetContinuousStateDerivatives)
ABSENT(fmi3GetContinuousStates)
ABSENT(fmi3GetDirectionalDerivative)
ABSENT(fmi3GetEventIndicators)
ABSENT(fmi3GetFloat32)
ABSENT(fmi3GetInt16)
ABSENT(fmi3GetInt32)
ABSENT(fmi3GetInt8)
ABSENT(fmi3GetIntervalDecimal)
ABSENT(fmi3GetIntervalFraction)
ABSENT(fmi3GetNominalsOfContinuousStates)
ABSENT(fmi3GetNumberOfContinuousStates)
ABSENT(fmi3GetNumberOfEventIndicators)
ABSENT(fmi3GetNumberOfVariableDependencies)
ABSENT(fmi3GetOutputDerivatives)
ABSENT(fmi3GetShiftDecimal)
ABSENT(fmi3GetShiftFraction)
ABSENT(fmi3GetString)
ABSENT(fmi3GetUInt16)
ABSENT(fmi3GetUInt32)
ABSENT(fmi3GetUInt64)
ABSENT(fmi3GetUInt8)
ABSENT(fmi3GetVariableDependencies)
ABSENT(fmi3SetBinary)
ABSENT(fmi3SetBoolean)
ABSENT(fmi3SetClock)
ABSENT(fmi3SetContinuousStates)
ABSENT(fmi3SetFloat32)
ABSENT(fmi3SetInt16)
ABSENT(fmi3SetInt32)
ABSENT(fmi3SetInt8)
ABSENT(fmi3SetIntervalDecimal)
ABSENT(fmi3SetIntervalFraction)
ABSENT(fmi3SetShiftDecimal)
ABSENT(fmi3SetShiftFraction)
ABSENT(fmi3SetString)
ABSENT(fmi3SetTime)
ABSENT(fmi3SetUInt16)
ABSENT(fmi3SetUInt32)
ABSENT(fmi3SetUInt64)
ABSENT(fmi3SetUInt8)
ABSENT(fmi3UpdateDiscreteStates)

FMU_EXPORT void *NAME(fmi3InstantiateModelExchange)(void)
{
    return NULL;
}

FMU_EXPORT void *NAME(fmi3InstantiateScheduledExecution)(void)
{
    return NULL;
}
