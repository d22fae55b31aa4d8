/* What a Cortex-M does before main: stack, floating-point unit, then the C library's own start. */
#include <stdint.h>

extern void _start(void);

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

/* The boards have four megabytes of memory from 0x20000000 on. */
__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    (const void *)0x20400000U, (const void *)reset, (const void *)stop, (const void *)stop,
    (const void *)stop,        (const void *)stop,  (const void *)stop, 0, 0, 0, 0,
    (const void *)stop,        (const void *)stop,  0, (const void *)stop, (const void *)stop,
};
