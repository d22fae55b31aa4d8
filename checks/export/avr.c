/* A step alone, for the size of a whole program (-DSTEP_ALONE); else the cycles of a step on an AVR, counted by its own timer; printed through the serial port, then asleep for ever, which ends
   the simulation. */
#ifdef STEP_ALONE
#include "fspid.h"

int main(void)
{
    static fspid_state state;
    static volatile fspid_sample sample;
    static volatile float command_rad;
    fspid_answer answer;
    fspid_reset(&fspid_design, &state);
    for (;;) {
        fspid_sample now = sample;
        fspid_step(&fspid_design, &state, &now, &answer);
        command_rad = answer.command_rad;
    }
}
#else
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdio.h>

#include "fspid.h"

static volatile uint16_t overflows;

ISR(TIMER1_OVF_vect)
{
    ++overflows;
}

static int sent(char letter, FILE *stream)
{
    (void)stream;
    while (!(UCSR0A & (1 << UDRE0))) {
    }
    UDR0 = (uint8_t)letter;
    return 0;
}

static FILE port = FDEV_SETUP_STREAM(sent, NULL, _FDEV_SETUP_WRITE);

int main(void)
{
    static const float pitches_rad[8] = { 0.0f, 0.03f, -0.05f, 0.1f, 0.02f, -0.11f, 0.07f, -0.01f };
    fspid_state state;
    fspid_answer answer;
    uint32_t most = 0;
    UCSR0B = 1 << TXEN0;
    stdout = &port;
    fspid_reset(&fspid_design, &state);
    TIMSK1 = 1 << TOIE1;
    TCCR1B = 1 << CS10;
    sei();
    for (uint8_t k = 0; k < 80; ++k) {
        fspid_sample sample = { .setpoint_rad = 0.1f, .measurement_rad = pitches_rad[k % 8] };
        overflows = 0;
        TCNT1 = 0;
        fspid_step(&fspid_design, &state, &sample, &answer);
        uint32_t cycles = TCNT1 + ((uint32_t)overflows << 16);
        most = cycles > most ? cycles : most;
    }
    printf("cycles of a step: %lu\n", (unsigned long)most);
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
#endif
