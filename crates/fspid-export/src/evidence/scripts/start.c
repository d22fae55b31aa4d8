/* What a Cortex-M does before main: stack, floating-point unit, then the C library's own start. */
#include <stdint.h>

extern void _start(void);

/* The end of the memory, which begins at 0x20000000: of the boards mps2, if nothing else is said. */
#ifndef STACK_TOP
#define STACK_TOP 0x20400000U
#endif

static void stop(void)
{
    for (;;) {
    }
}

static void reset(void)
{
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xE000ED88U |= 0xFU << 20;
    __asm volatile("dsb\n isb");
#endif
    _start();
}

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    (const void *)STACK_TOP, (const void *)reset, (const void *)stop, (const void *)stop,
    (const void *)stop,        (const void *)stop,  (const void *)stop, 0, 0, 0, 0,
    (const void *)stop,        (const void *)stop,  0, (const void *)stop, (const void *)stop,
};
