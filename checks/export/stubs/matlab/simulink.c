/* Not MathWorks' file: what Octave's mex needs to link, where Simulink would ask the S-function. */
#include "mex.h"
void mexFunction(int answers, mxArray *answer[], int given, const mxArray *argument[])
{
    (void)answers; (void)answer; (void)given; (void)argument;
    (void)mdlInitializeSizes; (void)mdlInitializeSampleTimes; (void)mdlInitializeConditions;
    (void)mdlOutputs; (void)mdlUpdate; (void)mdlTerminate;
}
