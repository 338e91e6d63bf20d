/* FMI 2.0 for co-simulation around an instance. Types and functions are those of the standard, declared here as far as needed. All
 * variables are reals. */
#include "fmu_instance.h"

#include <stdlib.h>
#include <string.h>

#if defined(FMI2_FUNCTION_PREFIX) && !defined(FMI2_OVERRIDE_FUNCTION_PREFIX)
#define NAME(name) FMU_PASTED(FMI2_FUNCTION_PREFIX, name)
#else
#define NAME(name) name
#endif

typedef enum { OK = 0, DISCARD = 2, ERROR = 3 } status;
typedef unsigned int reference;

/* Functions of the importer. */
typedef struct {
    void (*log)(void *environment, const char *name, status state, const char *category, const char *message, ...);
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*finish)(void *environment, status state);
    void *environment;
} callbacks;

typedef struct {
    fmu_run run;
    const callbacks *functions;
    char name[64];
} instance;

static status result(const instance *own, const char *refused)
{
    if (refused == NULL) {
        return OK;
    }
    if (own->functions != NULL && own->functions->log != NULL) {
        own->functions->log(own->functions->environment, own->name, ERROR, "logStatusError", "%s", refused);
    }
    return ERROR;
}

FMU_EXPORT const char *NAME(fmi2GetTypesPlatform)(void)
{
    return "default";
}

FMU_EXPORT const char *NAME(fmi2GetVersion)(void)
{
    return "2.0";
}

FMU_EXPORT status NAME(fmi2SetDebugLogging)(void *own, int is_on, size_t count, const char *const categories[])
{
    (void)own;
    (void)is_on;
    (void)count;
    (void)categories;
    return OK;
}

FMU_EXPORT void *NAME(fmi2Instantiate)(const char *name, int type, const char *token, const char *resources,
    const callbacks *functions, int is_visible, int is_logging)
{
    (void)resources;
    (void)is_visible;
    (void)is_logging;
    instance *own = calloc(1, sizeof *own);
    if (own == NULL) {
        return NULL;
    }
    own->functions = functions;
    if (name != NULL) {
        strncpy(own->name, name, sizeof own->name - 1);
    }
    fmu_reset(&own->run);
    /* Type 1 is co-simulation. */
    if (type != 1 || token == NULL || strcmp(token, FMU_TOKEN) != 0) {
        (void)result(own, "the GUID is that of another FMU, or the type is not co-simulation");
        free(own);
        return NULL;
    }
    return own;
}

FMU_EXPORT void NAME(fmi2FreeInstance)(void *own)
{
    free(own);
}

FMU_EXPORT status NAME(fmi2SetupExperiment)(void *own, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    instance *all = own;
    (void)has_tolerance;
    (void)tolerance;
    (void)has_stop;
    (void)stop;
    all->run.start_time = start;
    return result(all, fmu_move(&all->run, FMU_INSTANTIATED, FMU_INSTANTIATED));
}

FMU_EXPORT status NAME(fmi2EnterInitializationMode)(void *own)
{
    instance *all = own;
    return result(all, fmu_move(&all->run, FMU_INSTANTIATED, FMU_INITIALIZATION));
}

FMU_EXPORT status NAME(fmi2ExitInitializationMode)(void *own)
{
    instance *all = own;
    return result(all, fmu_begin(&all->run));
}

FMU_EXPORT status NAME(fmi2DoStep)(void *own, double from, double size, int is_final)
{
    instance *all = own;
    (void)is_final;
    return result(all, fmu_step(&all->run, from, size));
}

FMU_EXPORT status NAME(fmi2Terminate)(void *own)
{
    instance *all = own;
    return result(all, fmu_move(&all->run, FMU_STEPS, FMU_TERMINATED));
}

FMU_EXPORT status NAME(fmi2Reset)(void *own)
{
    fmu_reset(&((instance *)own)->run);
    return OK;
}

static unsigned char kind_of(reference place)
{
    return place < FMU_VALUES ? fmu_variables[place].kind : (unsigned char)FMU_FLOAT;
}

FMU_EXPORT status NAME(fmi2GetReal)(void *own, const reference places[], size_t count, double values[])
{
    instance *all = own;
    const char *refused = NULL;
    for (size_t index = 0; refused == NULL && index < count; ++index) {
        refused = fmu_get(&all->run, places[index], kind_of(places[index]), &values[index]);
    }
    return result(all, refused);
}

FMU_EXPORT status NAME(fmi2SetReal)(void *own, const reference places[], size_t count, const double values[])
{
    instance *all = own;
    const char *refused = NULL;
    for (size_t index = 0; refused == NULL && index < count; ++index) {
        refused = fmu_set(&all->run, places[index], kind_of(places[index]), values[index]);
    }
    return result(all, refused);
}

FMU_EXPORT status NAME(fmi2GetFMUstate)(void *own, void **state)
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

FMU_EXPORT status NAME(fmi2SetFMUstate)(void *own, void *state)
{
    memcpy(&((instance *)own)->run, state, sizeof(fmu_run));
    return OK;
}

FMU_EXPORT status NAME(fmi2FreeFMUstate)(void *own, void **state)
{
    (void)own;
    free(*state);
    *state = NULL;
    return OK;
}

FMU_EXPORT status NAME(fmi2SerializedFMUstateSize)(void *own, void *state, size_t *size)
{
    (void)own;
    (void)state;
    *size = FMU_BYTES;
    return OK;
}

FMU_EXPORT status NAME(fmi2SerializeFMUstate)(void *own, void *state, char bytes[], size_t size)
{
    return result(own, fmu_pack(state, (unsigned char *)bytes, size));
}

FMU_EXPORT status NAME(fmi2DeSerializeFMUstate)(void *own, const char bytes[], size_t size, void **state)
{
    const status copied = NAME(fmi2GetFMUstate)(own, state);
    return copied == OK ? result(own, fmu_unpack(*state, (const unsigned char *)bytes, size)) : copied;
}

/* Functions for what this FMU does not have: they return an error, or discard the question. */
#define ABSENT(name, answer)                                                                                                   \
    FMU_EXPORT status NAME(name)(void *own)                                                                                    \
    {                                                                                                                          \
        (void)own;                                                                                                             \
        return answer;                                                                                                         \
    }

ABSENT(fmi2CancelStep, ERROR)
ABSENT(fmi2GetBoolean, ERROR)
ABSENT(fmi2GetBooleanStatus, DISCARD)
ABSENT(fmi2GetDirectionalDerivative, ERROR)
ABSENT(fmi2GetInteger, ERROR)
ABSENT(fmi2GetIntegerStatus, DISCARD)
ABSENT(fmi2GetRealOutputDerivatives, ERROR)
ABSENT(fmi2GetRealStatus, DISCARD)
ABSENT(fmi2GetStatus, DISCARD)
ABSENT(fmi2GetString, ERROR)
ABSENT(fmi2GetStringStatus, DISCARD)
ABSENT(fmi2SetBoolean, ERROR)
ABSENT(fmi2SetInteger, ERROR)
ABSENT(fmi2SetRealInputDerivatives, ERROR)
ABSENT(fmi2SetString, ERROR)
