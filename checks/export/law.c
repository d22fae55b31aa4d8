/* The law of law.py behind the functions of fspid_external.h, nose up positive. */
#include "fspid_external.h"

uint32_t fspid_external_version(void) { return FSPID_EXTERNAL_VERSION; }
double fspid_external_period_s(void) { return 0.0; }
size_t fspid_external_state_bytes(void) { return 0; }
void fspid_external_reset(void *state) { (void)state; }
void fspid_external_step(void *state, const fspid_external_sample *sample, fspid_external_answer *answer)
{
    (void)state;
    answer->command_rad = 0.8 * (sample->setpoint_rad - sample->measurement_rad) - 0.1 * sample->rate_rad_s;
}
