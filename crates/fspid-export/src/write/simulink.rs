//! A level-2 S-function around the C, and what builds it.

use super::Heading;
use crate::program::{Part, Precision, Program};

/// The S-function in C, which is asked once every `period_s`: in 64 bits, as Simulink keeps time.
#[must_use]
pub fn simulink(program: &Program, prefix: &str, period_s: f64, heading: &Heading<'_>) -> String {
    let real = match heading.precision {
        Precision::Single => "float",
        Precision::Double => "double",
    };
    let inputs = program.members(Part::Sample);
    let [reals, marks] = program.answers();
    let names = |names: Vec<&str>| names.join(", ");
    let sample: String = inputs
        .iter()
        .enumerate()
        .map(|(index, member)| format!("    sample->{} = ({real})input[{index}];\n", member.name))
        .collect();
    let all: Vec<&str> = reals.into_iter().chain(marks).collect();
    let answer: String = all
        .iter()
        .enumerate()
        .map(|(index, name)| format!("    output[{index}] = (real_T)answer.{name};\n"))
        .collect();
    let text = SFUNCTION
        .replace("READS\n", &sample)
        .replace("WRITES\n", &answer)
        .replace("INPUTS", &inputs.len().to_string())
        .replace("OUTPUTS", &all.len().to_string())
        .replace("IN_NAMES", &names(inputs.iter().map(|it| it.name.as_str()).collect()))
        .replace("OUT_NAMES", &names(all))
        .replace("PERIOD", &format!("{period_s:?}"))
        .replace("PREFIX", prefix);
    let head = heading.lines().join("\n * ");
    format!("/* {head}\n{text}")
}

const SFUNCTION: &str = " *
 * A level-2 S-function for Simulink. Build it with build.m, or: mex PREFIX_sfun.c PREFIX.c
 * In: IN_NAMES. Out: OUT_NAMES.
 * Samples once every PERIOD s; any number of blocks side by side. */
#define S_FUNCTION_NAME PREFIX_sfun
#define S_FUNCTION_LEVEL 2

#include <string.h>
#include \"simstruc.h\"
#include \"PREFIX.h\"

static void mdlInitializeSizes(SimStruct *S)
{
    ssSetNumSFcnParams(S, 0);
    if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) {
        return;
    }
    ssSetNumContStates(S, 0);
    ssSetNumDiscStates(S, 0);
    if (!ssSetNumInputPorts(S, 1)) {
        return;
    }
    ssSetInputPortWidth(S, 0, INPUTS);
    ssSetInputPortRequiredContiguous(S, 0, 1);
    ssSetInputPortDirectFeedThrough(S, 0, 1);
    if (!ssSetNumOutputPorts(S, 1)) {
        return;
    }
    ssSetOutputPortWidth(S, 0, OUTPUTS);
    ssSetNumSampleTimes(S, 1);
    /* The state's bytes: each block has its own, and Simulink may save and restore them. */
    ssSetNumDWork(S, 1);
    ssSetDWorkWidth(S, 0, (int_T)sizeof(PREFIX_state));
    ssSetDWorkDataType(S, 0, SS_UINT8);
    ssSetOptions(S, 0);
}

static void mdlInitializeSampleTimes(SimStruct *S)
{
    ssSetSampleTime(S, 0, PERIOD);
    ssSetOffsetTime(S, 0, 0.0);
}

#define MDL_INITIALIZE_CONDITIONS
static void mdlInitializeConditions(SimStruct *S)
{
    PREFIX_state state;
    memset(&state, 0, sizeof state);
    PREFIX_reset(&PREFIX_design, &state);
    memcpy(ssGetDWork(S, 0), &state, sizeof state);
}

static void read_sample(SimStruct *S, PREFIX_sample *sample)
{
    const real_T *input = (const real_T *)ssGetInputPortSignal(S, 0);
READS
}

/* May be asked more than once a sample, so that it works on a copy of the state. */
static void mdlOutputs(SimStruct *S, int_T tid)
{
    real_T *output = (real_T *)ssGetOutputPortSignal(S, 0);
    PREFIX_state state;
    PREFIX_sample sample;
    PREFIX_answer answer;
    (void)tid;
    memcpy(&state, ssGetDWork(S, 0), sizeof state);
    read_sample(S, &sample);
    PREFIX_step(&PREFIX_design, &state, &sample, &answer);
WRITES
}

/* Once a sample, when the inputs are final. */
#define MDL_UPDATE
static void mdlUpdate(SimStruct *S, int_T tid)
{
    PREFIX_state state;
    PREFIX_sample sample;
    PREFIX_answer answer;
    (void)tid;
    memcpy(&state, ssGetDWork(S, 0), sizeof state);
    read_sample(S, &sample);
    PREFIX_step(&PREFIX_design, &state, &sample, &answer);
    memcpy(ssGetDWork(S, 0), &state, sizeof state);
}

static void mdlTerminate(SimStruct *S)
{
    (void)S;
}

#ifdef MATLAB_MEX_FILE
#include \"simulink.c\"
#else
#include \"cg_sfun.h\"
#endif
";

/// `build.m`.
#[must_use]
pub fn simulink_build(prefix: &str) -> String {
    BUILD.replace("PREFIX", prefix)
}

const BUILD: &str = "\
% Builds the S-function PREFIX_sfun. Products and sums are rounded one by one, which compilers of the GNU family must be told.
if ispc
    mex PREFIX_sfun.c PREFIX.c
else
    mex CFLAGS='$CFLAGS -std=c99 -ffp-contract=off' PREFIX_sfun.c PREFIX.c
end
";
