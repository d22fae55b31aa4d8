/* Every number of 32 bits, NaN and infinities too: what is asked of a sample says what its bits say, the magnitude
   is that of the bits, and the exponential of what is not above 0 lies in 0 to 1. */
#include <stdint.h>
#include <stdio.h>
#include "@PREFIX@.c"

static uint32_t bits_of(float number)
{
    union { float number; uint32_t bits; } both;
    both.number = number;
    return both.bits;
}

int main(void)
{
    unsigned long wrong = 0UL;
    uint32_t sum = 2166136261U, bits = 0U;
    do {
        union { uint32_t bits; float number; } both;
        both.bits = bits;
        const float number = both.number;
        const uint32_t size = bits & 0x7FFFFFFFU;
        const int finite = (-@LARGEST@ <= number) && (number <= @LARGEST@);
        const int believed = (-@GUARD@ <= number) && (number <= @GUARD@);
        wrong += finite != (size < 0x7F800000U);
        wrong += believed != (size <= bits_of(@GUARD@));
        if (size <= 0x7F800000U) {
            wrong += bits_of(@PREFIX@_magnitude(number)) != size;
        }
@EXPONENTIAL@
        ++bits;
    } while (bits != 0U);
    printf("4294967296 numbers, %lu wrong, sum %08lx\n", wrong, (unsigned long)sum);
    return wrong == 0UL ? 0 : 1;
}
