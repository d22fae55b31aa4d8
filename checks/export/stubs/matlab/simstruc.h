/* Not MathWorks' header: our own declarations of the few public names that an S-function of fspid uses, so that it can be
 * compiled and run where there is no Simulink. One input port and one output port of doubles, one work vector. */
#ifndef STUB_SIMSTRUC_H
#define STUB_SIMSTRUC_H

typedef double real_T;
typedef int int_T;
typedef struct {
    int_T parameters, inputs, outputs, work_bytes;
    real_T period, offset;
    real_T *input, *output;
    void *work;
} SimStruct;

enum { SS_UINT8 = 3 };

#define ssSetNumSFcnParams(S, n) ((S)->parameters = (n))
#define ssGetNumSFcnParams(S) ((S)->parameters)
#define ssGetSFcnParamsCount(S) 0
#define ssSetNumContStates(S, n) ((void)(S), (void)(n))
#define ssSetNumDiscStates(S, n) ((void)(S), (void)(n))
#define ssSetNumInputPorts(S, n) ((void)(S), (n) == 1)
#define ssSetInputPortWidth(S, port, n) ((void)(port), (S)->inputs = (n))
#define ssSetInputPortRequiredContiguous(S, port, yes) ((void)(S), (void)(port), (void)(yes))
#define ssSetInputPortDirectFeedThrough(S, port, yes) ((void)(S), (void)(port), (void)(yes))
#define ssSetNumOutputPorts(S, n) ((void)(S), (n) == 1)
#define ssSetOutputPortWidth(S, port, n) ((void)(port), (S)->outputs = (n))
#define ssSetNumSampleTimes(S, n) ((void)(S), (void)(n))
#define ssSetNumDWork(S, n) ((void)(S), (void)(n))
#define ssSetDWorkWidth(S, vector, n) ((void)(vector), (S)->work_bytes = (n))
#define ssSetDWorkDataType(S, vector, type) ((void)(S), (void)(vector), (void)(type))
#define ssSetOptions(S, options) ((void)(S), (void)(options))
#define ssSetSampleTime(S, index, time) ((void)(index), (S)->period = (time))
#define ssSetOffsetTime(S, index, time) ((void)(index), (S)->offset = (time))
#define ssGetInputPortSignal(S, port) ((void)(port), (const void *)(S)->input)
#define ssGetOutputPortSignal(S, port) ((void)(port), (void *)(S)->output)
#define ssGetDWork(S, vector) ((void)(vector), (S)->work)

#endif
