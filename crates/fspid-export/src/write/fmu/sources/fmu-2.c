/* The functions of FMI 2.0 for co-simulation, around an instance. */
#include "fmu-model.h"
#include "fmi2Functions.h"

typedef fmi2ValueReference reference;
typedef fmi2CallbackLogger log_function;
#include "fmu-instance.h"

/* The standard gives arguments to functions that need none here. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

static void tell(struct instance *it, enum status status, enum category category, const char *message)
{
    if (it->log != NULL) { it->log(it->environment, it->name, (fmi2Status)status, category_names[category], message); }
}

#define BEGIN(modes, name) \
    struct instance *it = (struct instance *)c; \
    if (!is_allowed(it, (modes), name)) { return fmi2Error; }

FMI2_Export const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

FMI2_Export const char *fmi2GetVersion(void)
{
    return "2.0";
}

FMI2_Export fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean loggingOn, size_t nCategories, const fmi2String categories[])
{
    BEGIN(mode_any, "fmi2SetDebugLogging")
    return (fmi2Status)logging(it, loggingOn, nCategories, categories);
}

FMI2_Export fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID, fmi2String fmuResourceLocation,
    const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean loggingOn)
{
    const char *problem = NULL;
    fmi2CallbackLogger log = functions == NULL ? NULL : functions->logger;
    void *environment = functions == NULL ? NULL : functions->componentEnvironment;
    if (is_blank(instanceName)) {
        problem = "an instance needs a name";
    } else if (fmuType != fmi2CoSimulation) {
        problem = "this is an FMU for co-simulation";
    } else if (fmuGUID == NULL || strcmp(fmuGUID, model_token) != 0) {
        problem = "the GUID is that of another model";
    } else {
        struct instance *it = instantiated(instanceName, environment, log, loggingOn);
        if (it != NULL) { return it; }
        problem = "no memory is left";
    }
    if (log != NULL) { log(environment, instanceName == NULL ? "" : instanceName, fmi2Error, category_names[log_error], problem); }
    return NULL;
}

FMI2_Export void fmi2FreeInstance(fmi2Component c)
{
    freed((struct instance *)c);
}

FMI2_Export fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance, fmi2Real startTime,
    fmi2Boolean stopTimeDefined, fmi2Real stopTime)
{
    BEGIN(mode_instantiated, "fmi2SetupExperiment")
    return (fmi2Status)set_up(it, startTime, stopTimeDefined, stopTime);
}

FMI2_Export fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    BEGIN(mode_instantiated, "fmi2EnterInitializationMode")
    it->now.mode = mode_initializing;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    BEGIN(mode_initializing, "fmi2ExitInitializationMode")
    return (fmi2Status)initialized(it);
}

FMI2_Export fmi2Status fmi2Terminate(fmi2Component c)
{
    BEGIN(mode_stepping, "fmi2Terminate")
    it->now.mode = mode_over;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2Reset(fmi2Component c)
{
    BEGIN(mode_any, "fmi2Reset")
    begin(&it->now);
    return fmi2OK;
}

#define READABLE (mode_initializing | mode_stepping | mode_over)
#define SETTABLE (mode_instantiated | mode_initializing | mode_stepping)

FMI2_Export fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    BEGIN(READABLE, "fmi2GetReal")
    return (fmi2Status)get_reals(it, vr, nvr, value);
}

/* Whole numbers and truths lie in memory alike. */
static fmi2Status get_bytes(struct instance *it, const fmi2ValueReference vr[], size_t nvr, int value[], enum type type)
{
    size_t k;
    if (nvr > 0U && (vr == NULL || value == NULL)) { return (fmi2Status)failed_with_null(it); }
    for (k = 0U; k < nvr; ++k) {
        int byte = byte_of(it, vr[k], type);
        if (byte < 0) { return (fmi2Status)failed(it, "there is no variable of this value reference and type"); }
        value[k] = byte;
    }
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Integer value[])
{
    BEGIN(READABLE, "fmi2GetInteger")
    return get_bytes(it, vr, nvr, value, type_whole);
}

FMI2_Export fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Boolean value[])
{
    BEGIN(READABLE, "fmi2GetBoolean")
    return get_bytes(it, vr, nvr, value, type_truth);
}

FMI2_Export fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2String value[])
{
    return (fmi2Status)none_of((struct instance *)c, READABLE, "fmi2GetString", nvr);
}

FMI2_Export fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[])
{
    BEGIN(SETTABLE, "fmi2SetReal")
    return (fmi2Status)set_reals(it, vr, nvr, value);
}

FMI2_Export fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer value[])
{
    return (fmi2Status)none_of((struct instance *)c, SETTABLE, "fmi2SetInteger", nvr);
}

FMI2_Export fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Boolean value[])
{
    return (fmi2Status)none_of((struct instance *)c, SETTABLE, "fmi2SetBoolean", nvr);
}

FMI2_Export fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2String value[])
{
    return (fmi2Status)none_of((struct instance *)c, SETTABLE, "fmi2SetString", nvr);
}

FMI2_Export fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    BEGIN(mode_any, "fmi2GetFMUstate")
    return (fmi2Status)state_got(it, FMUstate);
}

FMI2_Export fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate FMUstate)
{
    BEGIN(mode_any, "fmi2SetFMUstate")
    return (fmi2Status)state_set(it, FMUstate);
}

FMI2_Export fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *FMUstate)
{
    BEGIN(mode_any, "fmi2FreeFMUstate")
    return (fmi2Status)state_freed(it, FMUstate);
}

FMI2_Export fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate FMUstate, size_t *size)
{
    BEGIN(mode_any, "fmi2SerializedFMUstateSize")
    return (fmi2Status)state_size(it, FMUstate, size);
}

FMI2_Export fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate FMUstate, fmi2Byte serializedState[], size_t size)
{
    BEGIN(mode_any, "fmi2SerializeFMUstate")
    return (fmi2Status)state_written(it, FMUstate, serializedState, size);
}

FMI2_Export fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte serializedState[], size_t size, fmi2FMUstate *FMUstate)
{
    BEGIN(mode_any, "fmi2DeSerializeFMUstate")
    return (fmi2Status)state_read(it, serializedState, size, FMUstate);
}

FMI2_Export fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference vUnknown_ref[], size_t nUnknown,
    const fmi2ValueReference vKnown_ref[], size_t nKnown, const fmi2Real dvKnown[], fmi2Real dvUnknown[])
{
    return (fmi2Status)none_of((struct instance *)c, READABLE, "fmi2GetDirectionalDerivative", nUnknown);
}

FMI2_Export fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
    const fmi2Real value[])
{
    return (fmi2Status)none_of((struct instance *)c, SETTABLE, "fmi2SetRealInputDerivatives", nvr);
}

FMI2_Export fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Integer order[],
    fmi2Real value[])
{
    return (fmi2Status)none_of((struct instance *)c, READABLE, "fmi2GetRealOutputDerivatives", nvr);
}

FMI2_Export fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
    fmi2Boolean noSetFMUStatePriorToCurrentPoint)
{
    BEGIN(mode_stepping, "fmi2DoStep")
    return (fmi2Status)stepped(it, currentCommunicationPoint, communicationStepSize);
}

FMI2_Export fmi2Status fmi2CancelStep(fmi2Component c)
{
    BEGIN(0U, "fmi2CancelStep")
    return fmi2Error;
}

FMI2_Export fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind s, fmi2Status *value)
{
    BEGIN(mode_stepping | mode_over, "fmi2GetStatus")
    return (fmi2Status)refused(it, "no step is ever pending");
}

FMI2_Export fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind s, fmi2Real *value)
{
    BEGIN(mode_stepping | mode_over, "fmi2GetRealStatus")
    if (value == NULL) { return (fmi2Status)failed_with_null(it); }
    if (s != fmi2LastSuccessfulTime) { return (fmi2Status)refused(it, "there is no such status"); }
    *value = it->now.time_s;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind s, fmi2Integer *value)
{
    BEGIN(mode_stepping | mode_over, "fmi2GetIntegerStatus")
    return (fmi2Status)refused(it, "there is no such status");
}

FMI2_Export fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind s, fmi2Boolean *value)
{
    BEGIN(mode_stepping | mode_over, "fmi2GetBooleanStatus")
    if (value == NULL) { return (fmi2Status)failed_with_null(it); }
    if (s != fmi2Terminated) { return (fmi2Status)refused(it, "there is no such status"); }
    *value = fmi2False;
    return fmi2OK;
}

FMI2_Export fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind s, fmi2String *value)
{
    BEGIN(mode_stepping | mode_over, "fmi2GetStringStatus")
    return (fmi2Status)refused(it, "there is no such status");
}
