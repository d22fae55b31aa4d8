/* Instructions of a step, for an emulator that takes one nanosecond for each: the timer has 25 MHz, so that of forty
   steps each tick is one instruction of one. */
#include <stdint.h>
#include <stdio.h>

#include "fspid.h"

#define TIMER ((volatile uint32_t *)0xE000E010U)

static uint32_t seed = 1U;

static float drawn(void)
{
    seed = seed * 1664525U + 1013904223U;
    return (float)(seed >> 8) / 16777216.0f - 0.5f;
}

int main(void)
{
    uint32_t least = UINT32_MAX, most = 0U, sum = 0U;
    const uint32_t count = 300U;
    TIMER[1] = 0xFFFFFFU;
    TIMER[2] = 0U;
    TIMER[0] = 5U;
    for (uint32_t k = 0U; k < count; ++k) {
        fspid_state state;
        fspid_answer answer;
        fspid_sample sample = { .setpoint_rad = 0.2f * drawn(), .measurement_rad = 0.02f * drawn() };
        fspid_reset(&fspid_design, &state);
        fspid_step(&fspid_design, &state, &sample, &answer);
        sample.measurement_rad += 0.002f * drawn();
        uint32_t begin = TIMER[2];
        for (int i = 0; i < 40; ++i) {
            fspid_state copy = state;
            fspid_step(&fspid_design, &copy, &sample, &answer);
        }
        uint32_t instructions = (begin - TIMER[2]) & 0xFFFFFFU;
        least = instructions < least ? instructions : least;
        most = instructions > most ? instructions : most;
        sum += instructions;
    }
    printf("instructions of a step: %u to %u, mean %u\n", (unsigned)least, (unsigned)most,
           (unsigned)(sum / count));
    return 0;
}
