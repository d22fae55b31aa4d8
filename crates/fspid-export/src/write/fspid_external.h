/* A controller as fspid flies it from outside: five functions of a shared library.
 * Version 1. Angles are radians, times are seconds; a positive command turns the nose up.
 * Build: cc -shared -fPIC -O2 -ffp-contract=off controller.c -o controller.so
 * Licence: MIT or Apache-2.0, at your choice. */
#ifndef FSPID_EXTERNAL_H
#define FSPID_EXTERNAL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FSPID_EXTERNAL_VERSION 1U

/* What the controller sees at a sample. */
typedef struct {
    /* Commanded pitch, rad. */
    double setpoint_rad;
    /* Measured pitch, rad. */
    double measurement_rad;
    /* Measured pitch rate, rad/s. */
    double rate_rad_s;
} fspid_external_sample;

/* What it answers. All but the command is for people, and 0 before the call. */
typedef struct {
    /* The command, rad; NaN before the call, and one that is not finite ends the flight. */
    double command_rad;
    /* Gains: command per error; 1/s; s. */
    double kp;
    double ki;
    double kd;
    /* 1 where a limit of the controller has cut the command. */
    uint32_t saturated;
    /* Faults latched so far: 1 sample not finite, 2 beyond the guard, 4 overflow, 8 supervisor out of range,
     * 16 supervisor underflow. Other bits are left out. */
    uint32_t faults;
} fspid_external_answer;

/* FSPID_EXTERNAL_VERSION. */
uint32_t fspid_external_version(void);
/* Time from sample to sample, s; 0 for a controller that is the same at every period. */
double fspid_external_period_s(void);
/* How much memory the controller needs, in bytes; it is aligned for every type. */
size_t fspid_external_state_bytes(void);
/* Takes a controller to rest; called before its first sample. */
void fspid_external_reset(void *state);
/* Answers one sample. */
void fspid_external_step(void *state, const fspid_external_sample *sample, fspid_external_answer *answer);

#ifdef __cplusplus
}
#endif

#endif
