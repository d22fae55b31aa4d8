/* The functions of FMI 3.0, around an instance; those of other interfaces than co-simulation say so. */
#include "fmu-model.h"
#include "fmi3Functions.h"

typedef fmi3ValueReference reference;
typedef fmi3LogMessageCallback log_function;
#include "fmu-instance.h"

/* The standard gives arguments to functions that need none here. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

static void tell(struct instance *it, enum status status, enum category category, const char *message)
{
    if (it->log != NULL) { it->log(it->environment, (fmi3Status)status, category_names[category], message); }
}

#define BEGIN(modes, name) \
    struct instance *it = (struct instance *)instance; \
    if (!is_allowed(it, (modes), name)) { return fmi3Error; }

FMI3_Export const char *fmi3GetVersion(void)
{
    return "3.0";
}

FMI3_Export fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories, const fmi3String categories[])
{
    BEGIN(mode_any, "fmi3SetDebugLogging")
    return (fmi3Status)logging(it, loggingOn, nCategories, categories);
}

static void not_instantiated(fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, const char *problem)
{
    if (log != NULL) { log(environment, fmi3Error, category_names[log_error], problem); }
}

FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[], size_t nRequiredIntermediateVariables,
    fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage, fmi3IntermediateUpdateCallback intermediateUpdate)
{
    const char *problem = NULL;
    if (is_blank(instanceName)) {
        problem = "an instance needs a name";
    } else if (instantiationToken == NULL || strcmp(instantiationToken, model_token) != 0) {
        problem = "the instantiation token is that of another model";
    } else if (eventModeUsed) {
        problem = "there is no event mode";
    } else if (nRequiredIntermediateVariables > 0U) {
        problem = "there are no intermediate variables";
    } else {
        struct instance *it = instantiated(instanceName, instanceEnvironment, logMessage, loggingOn);
        if (it != NULL) { return it; }
        problem = "no memory is left";
    }
    not_instantiated(instanceEnvironment, logMessage, problem);
    return NULL;
}

FMI3_Export fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage)
{
    not_instantiated(instanceEnvironment, logMessage, "this is an FMU for co-simulation");
    return NULL;
}

FMI3_Export fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
    fmi3ClockUpdateCallback clockUpdate, fmi3LockPreemptionCallback lockPreemption, fmi3UnlockPreemptionCallback unlockPreemption)
{
    not_instantiated(instanceEnvironment, logMessage, "this is an FMU for co-simulation");
    return NULL;
}

FMI3_Export void fmi3FreeInstance(fmi3Instance instance)
{
    freed((struct instance *)instance);
}

FMI3_Export fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
    fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    enum status status;
    BEGIN(mode_instantiated, "fmi3EnterInitializationMode")
    status = set_up(it, startTime, stopTimeDefined, stopTime);
    if (status == status_ok) { it->now.mode = mode_initializing; }
    return (fmi3Status)status;
}

FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    BEGIN(mode_initializing, "fmi3ExitInitializationMode")
    return (fmi3Status)initialized(it);
}

FMI3_Export fmi3Status fmi3Terminate(fmi3Instance instance)
{
    BEGIN(mode_stepping, "fmi3Terminate")
    it->now.mode = mode_over;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3Reset(fmi3Instance instance)
{
    BEGIN(mode_any, "fmi3Reset")
    begin(&it->now);
    return fmi3OK;
}

#define SETTABLE (mode_instantiated | mode_initializing | mode_stepping)
/* Every variable is a scalar. */
#define AS_MANY(values, references) \
    if ((values) != (references)) { return (fmi3Status)failed(it, "there must be as many values as value references"); }

FMI3_Export fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3Float64 values[], size_t nValues)
{
    BEGIN(mode_any, "fmi3GetFloat64")
    AS_MANY(nValues, nValueReferences)
    return (fmi3Status)get_reals(it, valueReferences, nValueReferences, values);
}

FMI3_Export fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Float64 values[], size_t nValues)
{
    BEGIN(SETTABLE, "fmi3SetFloat64")
    AS_MANY(nValues, nValueReferences)
    return (fmi3Status)set_reals(it, valueReferences, nValueReferences, values);
}

/* Whole numbers and truths lie in memory alike. */
#define BYTES(name, kind, type) \
FMI3_Export fmi3Status name(fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
    kind values[], size_t nValues) \
{ \
    size_t k; \
    BEGIN(mode_any, #name) \
    AS_MANY(nValues, nValueReferences) \
    if (nValues > 0U && (valueReferences == NULL || values == NULL)) { return (fmi3Status)failed_with_null(it); } \
    for (k = 0U; k < nValues; ++k) { \
        int byte = byte_of(it, valueReferences[k], type); \
        if (byte < 0) { return (fmi3Status)failed(it, "there is no variable of this value reference and type"); } \
        values[k] = (kind)byte; \
    } \
    return fmi3OK; \
}

BYTES(fmi3GetInt32, fmi3Int32, type_whole)
BYTES(fmi3GetBoolean, fmi3Boolean, type_truth)

/* Types of which there is no variable that could be had or set, and what an FMU of this kind does not do. */
#define NONE(name, modes, arguments) \
FMI3_Export fmi3Status name arguments { return (fmi3Status)none_of((struct instance *)instance, (modes), #name, nValueReferences); }
#define NO_GET(name, kind) NONE(name, mode_any, (fmi3Instance instance, const fmi3ValueReference valueReferences[], \
    size_t nValueReferences, kind values[], size_t nValues))
#define NO_SET(name, kind) NONE(name, SETTABLE, (fmi3Instance instance, const fmi3ValueReference valueReferences[], \
    size_t nValueReferences, const kind values[], size_t nValues))

NO_GET(fmi3GetFloat32, fmi3Float32)
NO_GET(fmi3GetInt8, fmi3Int8)
NO_GET(fmi3GetUInt8, fmi3UInt8)
NO_GET(fmi3GetInt16, fmi3Int16)
NO_GET(fmi3GetUInt16, fmi3UInt16)
NO_GET(fmi3GetUInt32, fmi3UInt32)
NO_GET(fmi3GetInt64, fmi3Int64)
NO_GET(fmi3GetUInt64, fmi3UInt64)
NO_GET(fmi3GetString, fmi3String)
NONE(fmi3GetBinary, mode_any, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    size_t valueSizes[], fmi3Binary values[], size_t nValues))
NONE(fmi3GetClock, mode_any, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Clock values[]))
NO_SET(fmi3SetFloat32, fmi3Float32)
NO_SET(fmi3SetInt8, fmi3Int8)
NO_SET(fmi3SetUInt8, fmi3UInt8)
NO_SET(fmi3SetInt16, fmi3Int16)
NO_SET(fmi3SetUInt16, fmi3UInt16)
NO_SET(fmi3SetInt32, fmi3Int32)
NO_SET(fmi3SetUInt32, fmi3UInt32)
NO_SET(fmi3SetInt64, fmi3Int64)
NO_SET(fmi3SetUInt64, fmi3UInt64)
NO_SET(fmi3SetBoolean, fmi3Boolean)
NO_SET(fmi3SetString, fmi3String)
NONE(fmi3SetBinary, SETTABLE, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const size_t valueSizes[], const fmi3Binary values[], size_t nValues))
NONE(fmi3SetClock, SETTABLE, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Clock values[]))

FMI3_Export fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    BEGIN(mode_any, "fmi3GetFMUState")
    return (fmi3Status)state_got(it, FMUState);
}

FMI3_Export fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState FMUState)
{
    BEGIN(mode_any, "fmi3SetFMUState")
    return (fmi3Status)state_set(it, FMUState);
}

FMI3_Export fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *FMUState)
{
    BEGIN(mode_any, "fmi3FreeFMUState")
    return (fmi3Status)state_freed(it, FMUState);
}

FMI3_Export fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState FMUState, size_t *size)
{
    BEGIN(mode_any, "fmi3SerializedFMUStateSize")
    return (fmi3Status)state_size(it, FMUState, size);
}

FMI3_Export fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    BEGIN(mode_any, "fmi3SerializeFMUState")
    return (fmi3Status)state_written(it, FMUState, serializedState, size);
}

FMI3_Export fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serializedState[], size_t size, fmi3FMUState *FMUState)
{
    BEGIN(mode_any, "fmi3DeserializeFMUState")
    return (fmi3Status)state_read(it, serializedState, size, FMUState);
}

FMI3_Export fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
    fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
    fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    enum status status;
    BEGIN(mode_stepping, "fmi3DoStep")
    if (eventHandlingNeeded == NULL || terminateSimulation == NULL || earlyReturn == NULL || lastSuccessfulTime == NULL) {
        return (fmi3Status)failed_with_null(it);
    }
    status = stepped(it, currentCommunicationPoint, communicationStepSize);
    *eventHandlingNeeded = fmi3False;
    *terminateSimulation = fmi3False;
    *earlyReturn = fmi3False;
    *lastSuccessfulTime = it->now.time_s;
    return (fmi3Status)status;
}

#define ABSENT(name, arguments) \
FMI3_Export fmi3Status name arguments { return (fmi3Status)none_of((struct instance *)instance, mode_any, #name, 1U); }

ABSENT(fmi3GetNumberOfVariableDependencies, (fmi3Instance instance, fmi3ValueReference valueReference, size_t *nDependencies))
ABSENT(fmi3GetVariableDependencies, (fmi3Instance instance, fmi3ValueReference dependent, size_t elementIndicesOfDependent[],
    fmi3ValueReference independents[], size_t elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[], size_t nDependencies))
ABSENT(fmi3GetDirectionalDerivative, (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity))
ABSENT(fmi3GetAdjointDerivative, (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity))
ABSENT(fmi3EnterConfigurationMode, (fmi3Instance instance))
ABSENT(fmi3ExitConfigurationMode, (fmi3Instance instance))
ABSENT(fmi3EnterEventMode, (fmi3Instance instance))
ABSENT(fmi3EnterStepMode, (fmi3Instance instance))
ABSENT(fmi3GetIntervalDecimal, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]))
ABSENT(fmi3GetIntervalFraction, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]))
ABSENT(fmi3GetShiftDecimal, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3Float64 shifts[]))
ABSENT(fmi3GetShiftFraction, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3UInt64 counters[], fmi3UInt64 resolutions[]))
ABSENT(fmi3SetIntervalDecimal, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Float64 intervals[]))
ABSENT(fmi3SetIntervalFraction, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))
ABSENT(fmi3SetShiftDecimal, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Float64 shifts[]))
ABSENT(fmi3SetShiftFraction, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]))
ABSENT(fmi3EvaluateDiscreteStates, (fmi3Instance instance))
ABSENT(fmi3UpdateDiscreteStates, (fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate, fmi3Boolean *terminateSimulation,
    fmi3Boolean *nominalsOfContinuousStatesChanged, fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
    fmi3Float64 *nextEventTime))
ABSENT(fmi3EnterContinuousTimeMode, (fmi3Instance instance))
ABSENT(fmi3CompletedIntegratorStep, (fmi3Instance instance, fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *enterEventMode,
    fmi3Boolean *terminateSimulation))
ABSENT(fmi3SetTime, (fmi3Instance instance, fmi3Float64 time))
ABSENT(fmi3SetContinuousStates, (fmi3Instance instance, const fmi3Float64 continuousStates[], size_t nContinuousStates))
ABSENT(fmi3GetContinuousStateDerivatives, (fmi3Instance instance, fmi3Float64 derivatives[], size_t nContinuousStates))
ABSENT(fmi3GetEventIndicators, (fmi3Instance instance, fmi3Float64 eventIndicators[], size_t nEventIndicators))
ABSENT(fmi3GetContinuousStates, (fmi3Instance instance, fmi3Float64 continuousStates[], size_t nContinuousStates))
ABSENT(fmi3GetNominalsOfContinuousStates, (fmi3Instance instance, fmi3Float64 nominals[], size_t nContinuousStates))
ABSENT(fmi3GetNumberOfEventIndicators, (fmi3Instance instance, size_t *nEventIndicators))
ABSENT(fmi3GetNumberOfContinuousStates, (fmi3Instance instance, size_t *nContinuousStates))
ABSENT(fmi3GetOutputDerivatives, (fmi3Instance instance, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Int32 orders[], fmi3Float64 values[], size_t nValues))
ABSENT(fmi3ActivateModelPartition, (fmi3Instance instance, fmi3ValueReference clockReference, fmi3Float64 activationTime))
