/* Not MathWorks' file: a program that asks two blocks, one after the other in each sample, for the answers to vectors.csv. The
 * outputs are asked twice a sample, as a solver may. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void block(SimStruct *S)
{
    memset(S, 0, sizeof *S);
    mdlInitializeSizes(S);
    mdlInitializeSampleTimes(S);
    S->input = calloc((size_t)S->inputs, sizeof(real_T));
    S->output = calloc((size_t)S->outputs, sizeof(real_T));
    S->work = malloc((size_t)S->work_bytes);
    mdlInitializeConditions(S);
}

int main(void)
{
    SimStruct one, other;
    char line[1024];
    unsigned samples = 0U, different = 0U;
    FILE *file = fopen("vectors.csv", "r");
    if (file == NULL || fgets(line, sizeof line, file) == NULL) {
        return 2;
    }
    block(&one);
    block(&other);
    while (fgets(line, sizeof line, file) != NULL) {
        char *rest = line;
        int same = 1;
        for (int_T k = 0; k < one.inputs; ++k, ++rest) {
            one.input[k] = sizeof(NUMBER) == 4 ? (real_T)strtof(rest, &rest) : strtod(rest, &rest);
            other.input[k] = 0.5 * one.input[k];
        }
        mdlOutputs(&one, 0);
        mdlOutputs(&other, 0);
        mdlOutputs(&one, 0);
        for (int_T k = 0; k < one.outputs; ++k, ++rest) {
            const real_T expected = sizeof(NUMBER) == 4 ? (real_T)strtof(rest, &rest) : strtod(rest, &rest);
            same = same && expected == one.output[k] && signbit(expected) == signbit(one.output[k]);
        }
        mdlUpdate(&one, 0);
        mdlUpdate(&other, 0);
        ++samples;
        different += !same;
    }
    mdlTerminate(&one);
    printf("%u samples, %u different, a sample every %g s\n", samples, different, one.period);
    return different == 0U && samples > 0U ? 0 : 1;
}
