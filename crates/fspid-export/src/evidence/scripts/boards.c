/* Instructions of a step over the vectors and of the self test, for an emulator that takes one nanosecond for each: the
   timer has 25 MHz, so that of forty steps each tick is one instruction of one. Instructions, not cycles. */
#include <stdint.h>
#include <stdio.h>

#include "@PREFIX@.h"

#define TIMER ((volatile uint32_t *)0xE000E010U)

static uint32_t seed = 1U;

static double drawn(void)
{
    seed = seed * 1664525U + 1013904223U;
    return (double)(seed >> 8) / 16777216.0 - 0.5;
}

int main(void)
{
    uint32_t least = UINT32_MAX, most = 0U, sum = 0U;
    const uint32_t count = 300U;
    TIMER[1] = 0xFFFFFFU;
    TIMER[2] = 0U;
    TIMER[0] = 5U;
    for (uint32_t k = 0U; k < count; ++k) {
        static @PREFIX@_sample sample;
        @PREFIX@_state state;
        @PREFIX@_answer answer;
        /* Every third beyond limits. */
        const double size = k % 3U == 0U ? 2.0 : 0.2;
        sample.@SETPOINT@ = size * drawn();
        sample.@MEASUREMENT@ = 0.02 * drawn();
        @PREFIX@_init(&state);
        @PREFIX@_step(&@PREFIX@_design, &state, &sample, &answer);
        sample.@MEASUREMENT@ += 0.002 * drawn();
        const uint32_t begin = TIMER[2];
        for (int i = 0; i < 40; ++i) {
            @PREFIX@_state copy = state;
            @PREFIX@_step(&@PREFIX@_design, &copy, &sample, &answer);
        }
        const uint32_t instructions = (begin - TIMER[2]) & 0xFFFFFFU;
        least = instructions < least ? instructions : least;
        most = instructions > most ? instructions : most;
        sum += instructions;
    }
    const uint32_t begin = TIMER[2];
    const unsigned wrong = @PREFIX@_selftest(&@PREFIX@_design);
    const uint32_t ticks = (begin - TIMER[2]) & 0xFFFFFFU;
    printf("step %u to %u, mean %u; self test %u (in steps of 40), which answers %u (0: nothing is wrong)\n", (unsigned)least, (unsigned)most,
           (unsigned)(sum / count), (unsigned)(40U * ticks), wrong);
    return 0;
}
