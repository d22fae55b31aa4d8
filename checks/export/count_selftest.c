/* Instructions of the self test, for an emulator that takes one nanosecond for each: the timer has 25 MHz, so that a
   tick is forty instructions. */
#include <stdint.h>
#include <stdio.h>

#include "fspid.h"

#define TIMER ((volatile uint32_t *)0xE000E010U)

int main(void)
{
    TIMER[1] = 0xFFFFFFU;
    TIMER[2] = 0U;
    TIMER[0] = 5U;
    uint32_t begin = TIMER[2];
    unsigned wrong = fspid_selftest(&fspid_design);
    uint32_t ticks = (begin - TIMER[2]) & 0xFFFFFFU;
    printf("self test: %u, instructions: %u\n", wrong, (unsigned)(40U * ticks));
    return 0;
}
