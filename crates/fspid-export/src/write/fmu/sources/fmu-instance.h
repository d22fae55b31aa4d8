/* What both versions of the standard share: an instance, its variables, its time, its state as bytes.
 * fmu-model.h, which is written for each controller, stands before this file; so does the type `reference`. */
#ifndef FSPID_INSTANCE_H
#define FSPID_INSTANCE_H

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As fmi2Status and fmi3Status number them. */
enum status { status_ok = 0, status_discard = 2, status_error = 3 };
/* Modes are bits, so that a function can name those in which it may be called. */
enum mode { mode_instantiated = 1, mode_initializing = 2, mode_stepping = 4, mode_over = 8, mode_any = 15 };
enum category { log_events, log_discard, log_error, category_count };

static const char *const category_names[category_count] = { "logEvents", "logStatusDiscard", "logStatusError" };

/* An instant this part of a period before a sample counts as on it: clocks of importers that add steps up drift. */
#define ON_IT 1e-3
/* A step that holds more samples is taken for a mistake: some three hours at 10 ms. */
#define MOST_SAMPLES 1048576.0

struct instance {
    struct memory now;
    char *name;
    void *environment;
    log_function log;
    uint8_t is_logged[category_count];
};

/* Hands a message to the importer; each version has its own way. */
static void tell(struct instance *it, enum status status, enum category category, const char *message);

/* A call that changes nothing and may be made again with other values. */
static enum status refused(struct instance *it, const char *message)
{
    if (it->is_logged[log_discard]) { tell(it, status_discard, log_discard, message); }
    return status_discard;
}

/* A call that may not be made like this: the instance is over until it is reset or takes a state. */
static enum status failed(struct instance *it, const char *message)
{
    it->now.mode = mode_over;
    tell(it, status_error, log_error, message);
    return status_error;
}

static enum status failed_with_null(struct instance *it)
{
    return failed(it, "a pointer is null that must not be");
}

static int is_allowed(struct instance *it, unsigned modes, const char *function)
{
    char message[120];
    if (it == NULL) { return 0; }
    if ((it->now.mode & modes) != 0U) { return 1; }
    (void)snprintf(message, sizeof message, "%s may not be called in this state", function);
    (void)failed(it, message);
    return 0;
}

/* As before the first good sample, with the parameters as they are; faults stay latched. */
static void settle(struct memory *memory)
{
    uint8_t latched = memory->answer.faults;
    model_reset(&memory->configuration, &memory->state);
    memset(&memory->answer, 0, sizeof memory->answer);
    model_hold(&memory->configuration, &memory->state, &memory->answer, latched);
}

static void begin(struct memory *memory)
{
    memset(memory, 0, sizeof *memory);
    memory->configuration = model_design;
    memory->mode = mode_instantiated;
    settle(memory);
}

static struct instance *instantiated(const char *name, void *environment, log_function log, int is_logged)
{
    struct instance *it = (struct instance *)calloc(1U, sizeof *it);
    size_t length = strlen(name) + 1U;
    if (it == NULL) { return NULL; }
    it->name = (char *)malloc(length);
    if (it->name == NULL) {
        free(it);
        return NULL;
    }
    memcpy(it->name, name, length);
    it->environment = environment;
    it->log = log;
    memset(it->is_logged, is_logged != 0, sizeof it->is_logged);
    begin(&it->now);
    return it;
}

static int is_blank(const char *text)
{
    return text == NULL || text[strspn(text, " \t\r\n")] == '\0';
}

static void freed(struct instance *it)
{
    if (it != NULL) {
        free(it->name);
        free(it);
    }
}

static enum status logging(struct instance *it, int is_on, size_t count, const char *const names[])
{
    size_t k;
    int category;
    if (count == 0U) { memset(it->is_logged, is_on != 0, sizeof it->is_logged); }
    if (count > 0U && names == NULL) { return failed_with_null(it); }
    for (k = 0U; k < count; ++k) {
        for (category = 0; category < category_count; ++category) {
            if (names[k] != NULL && strcmp(names[k], category_names[category]) == 0) { break; }
        }
        if (category == category_count) { return failed(it, "there is no log category of this name"); }
        it->is_logged[category] = is_on != 0;
    }
    return status_ok;
}

static int is_finite(double number)
{
    return number >= -DBL_MAX && number <= DBL_MAX;
}

static double real_at(const struct memory *memory, size_t offset)
{
    real number;
    memcpy(&number, (const char *)memory + offset, sizeof number);
    return (double)number;
}

static void put_real(struct memory *memory, size_t offset, double value)
{
    real number = (real)value;
    memcpy((char *)memory + offset, &number, sizeof number);
}

static const struct variable *variable_of(reference which, enum type type)
{
    if (which >= VARIABLE_COUNT || variables[which].type != type) { return NULL; }
    return &variables[which];
}

/* The first pair of parameters that are in the wrong order, or null. */
static const struct order *disorder(const struct memory *memory)
{
    size_t k;
    for (k = 0U; k < order_count; ++k) {
        double below = real_at(memory, variables[orders[k].below].offset);
        double above = real_at(memory, variables[orders[k].above].offset);
        if (!(orders[k].may_be_equal ? below <= above : below < above)) { return &orders[k]; }
    }
    return NULL;
}

static const char *disordered(const struct order *order, char message[200])
{
    (void)snprintf(message, 200U, "%s must %s %s; nothing was changed", variables[order->below].name,
        order->may_be_equal ? "not be above" : "be below", variables[order->above].name);
    return message;
}

/* Sets all or, where one of them may not be, none. */
static enum status set_reals(struct instance *it, const reference which[], size_t count, const double values[])
{
    char message[200];
    struct memory next;
    const struct order *order;
    size_t k;
    if (count > 0U && (which == NULL || values == NULL)) { return failed_with_null(it); }
    next = it->now;
    for (k = 0U; k < count; ++k) {
        const struct variable *variable = variable_of(which[k], type_real);
        double kept;
        if (variable == NULL) { return failed(it, "there is no real variable of this value reference"); }
        if (variable->role != role_input && variable->role != role_parameter) {
            return failed(it, "neither an input nor a parameter: it cannot be set");
        }
        put_real(&next, variable->offset, values[k]);
        kept = real_at(&next, variable->offset);
        if (variable->role == role_parameter && !(kept >= variable->lowest && kept <= variable->highest)) {
            (void)snprintf(message, sizeof message, "%s may not be %.17g; allowed is %.17g to %.17g; nothing was changed",
                variable->name, values[k], variable->lowest, variable->highest);
            return refused(it, message);
        }
    }
    /* Before, parameters may come one by one; they are looked at together when initialization ends. */
    order = it->now.mode == mode_stepping ? disorder(&next) : NULL;
    if (order != NULL) { return refused(it, disordered(order, message)); }
    it->now = next;
    /* What is remembered follows from the parameters until a good sample has written it. */
    if (it->now.mode != mode_stepping || !model_has_begun(&it->now.state)) { settle(&it->now); }
    return status_ok;
}

static enum status get_reals(struct instance *it, const reference which[], size_t count, double values[])
{
    size_t k;
    if (count > 0U && (which == NULL || values == NULL)) { return failed_with_null(it); }
    for (k = 0U; k < count; ++k) {
        const struct variable *variable = variable_of(which[k], type_real);
        if (variable == NULL) { return failed(it, "there is no real variable of this value reference"); }
        values[k] = variable->role == role_time ? it->now.time_s : real_at(&it->now, variable->offset);
    }
    return status_ok;
}

/* One whole number or truth; -1 where there is none. */
static int byte_of(const struct instance *it, reference which, enum type type)
{
    const struct variable *variable = variable_of(which, type);
    return variable == NULL ? -1 : *((const uint8_t *)&it->now + variable->offset);
}

/* What is asked of variables of a type that this model has none of. */
static enum status none_of(struct instance *it, unsigned modes, const char *function, size_t count)
{
    if (!is_allowed(it, modes, function)) { return status_error; }
    return count == 0U ? status_ok : failed(it, "there is no variable of this type that this could be done with");
}

static enum status set_up(struct instance *it, double start_s, int has_stop, double stop_s)
{
    if (!is_finite(start_s) || (has_stop && !(stop_s >= start_s && stop_s <= DBL_MAX))) {
        return failed(it, "the experiment must begin at a finite time and end after that");
    }
    it->now.start_s = start_s;
    it->now.time_s = start_s;
    it->now.stop_s = has_stop ? stop_s : 0.0;
    it->now.has_stop = has_stop != 0;
    return status_ok;
}

static enum status initialized(struct instance *it)
{
    char message[200];
    const struct order *order = disorder(&it->now);
    if (order != NULL) { return failed(it, disordered(order, message)); }
    it->now.mode = mode_stepping;
    return status_ok;
}

/* A sample is taken at each multiple of the period that lies in the step, its end excluded; the command is held between. */
static enum status stepped(struct instance *it, double from_s, double step_s)
{
    char message[120];
    struct memory *now = &it->now;
    double end_s = from_s + step_s;
#ifdef MODEL_IS_ASKED_EACH_STEP
    double period_s = step_s;
    double due = (double)now->samples + 1.0;
#else
    double period_s = MODEL_PERIOD_S;
    double due = (end_s - now->start_s) / period_s - ON_IT;
#endif
    uint64_t count;
    uint8_t before = now->answer.faults;
    if (!(step_s > 0.0) || !is_finite(end_s)) { return failed(it, "a step must be longer than 0, and finite"); }
    if (!(from_s - now->time_s <= ON_IT * period_s && now->time_s - from_s <= ON_IT * period_s)) {
        (void)snprintf(message, sizeof message, "the step begins at %.17g, this instance stands at %.17g", from_s, now->time_s);
        return failed(it, message);
    }
    if (now->has_stop && end_s - now->stop_s > ON_IT * period_s) { return failed(it, "the step leads beyond the stop time"); }
    if (!(due - (double)now->samples <= MOST_SAMPLES)) {
        (void)snprintf(message, sizeof message, "the step holds more than %.0f samples", MOST_SAMPLES);
        return failed(it, message);
    }
    count = due > 0.0 ? (uint64_t)due : 0U;
    if ((double)count < due) { ++count; }
    for (; now->samples < count; ++now->samples) {
        model_step(&now->configuration, &now->state, &now->sample, &now->answer);
    }
    now->time_s = end_s;
    if (now->answer.faults != before && it->is_logged[log_events]) {
        (void)snprintf(message, sizeof message, "faults latched until %.17g: %u", end_s, (unsigned)now->answer.faults);
        tell(it, status_ok, log_events, message);
    }
    return status_ok;
}

/* A state is the memory of an instance. */
static enum status state_got(struct instance *it, void **state)
{
    if (state == NULL) { return failed_with_null(it); }
    if (*state == NULL) { *state = calloc(1U, sizeof it->now); }
    if (*state == NULL) { return failed(it, "no memory is left"); }
    memcpy(*state, &it->now, sizeof it->now);
    return status_ok;
}

static enum status state_set(struct instance *it, const void *state)
{
    if (state == NULL) { return failed_with_null(it); }
    memcpy(&it->now, state, sizeof it->now);
    return status_ok;
}

static enum status state_freed(struct instance *it, void **state)
{
    if (state == NULL) { return failed_with_null(it); }
    free(*state);
    *state = NULL;
    return status_ok;
}

/* Bytes of a state: the mark of this model, then words of 64 bits, the lowest byte first. */
#define MARK_SIZE 16U
#define STATE_SIZE (MARK_SIZE + 8U * (6U + (VARIABLE_COUNT - 1U) + REMEMBERED_COUNT))

struct carrier { uint8_t *at; int is_read; int is_good; };

static uint64_t carried(struct carrier *carrier, uint64_t word)
{
    unsigned k;
    uint64_t read = 0U;
    for (k = 0U; k < 8U; ++k, ++carrier->at) {
        if (carrier->is_read) {
            read |= (uint64_t)*carrier->at << (8U * k);
        } else {
            *carrier->at = (uint8_t)(word >> (8U * k));
        }
    }
    return carrier->is_read ? read : word;
}

static uint8_t carried_byte(struct carrier *carrier, uint8_t byte, uint8_t most)
{
    uint64_t word = carried(carrier, byte);
    carrier->is_good = carrier->is_good && word <= most;
    return (uint8_t)word;
}

static double carried_number(struct carrier *carrier, double number, int may_be_anything)
{
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    word = carried(carrier, word);
    memcpy(&number, &word, sizeof word);
    carrier->is_good = carrier->is_good && (may_be_anything || is_finite(number));
    return number;
}

static void carry_place(struct carrier *carrier, struct memory *memory, enum type type, size_t offset, int may_be_anything)
{
    uint8_t *byte = (uint8_t *)memory + offset;
    if (type == type_real) {
        put_real(memory, offset, carried_number(carrier, real_at(memory, offset), may_be_anything));
        carrier->is_good = carrier->is_good && (may_be_anything || is_finite(real_at(memory, offset)));
    } else {
        *byte = carried_byte(carrier, *byte, type == type_truth ? 1U : UINT8_MAX);
    }
}

static void carry(struct carrier *carrier, struct memory *memory)
{
    size_t k;
    memory->time_s = carried_number(carrier, memory->time_s, 0);
    memory->start_s = carried_number(carrier, memory->start_s, 0);
    memory->stop_s = carried_number(carrier, memory->stop_s, 0);
    memory->samples = carried(carrier, memory->samples);
    memory->mode = carried_byte(carrier, memory->mode, mode_over);
    memory->has_stop = carried_byte(carrier, memory->has_stop, 1U);
    for (k = 1U; k < VARIABLE_COUNT; ++k) {
        carry_place(carrier, memory, variables[k].type, variables[k].offset, variables[k].role == role_input);
    }
    for (k = 0U; k < REMEMBERED_COUNT; ++k) { carry_place(carrier, memory, remembered[k].type, remembered[k].offset, 0); }
}

/* Whether an instance can have got to where these bytes say that it stands. */
static int is_possible(const struct memory *memory)
{
    size_t k;
    for (k = 1U; k < VARIABLE_COUNT; ++k) {
        double value;
        if (variables[k].role != role_parameter) { continue; }
        value = real_at(memory, variables[k].offset);
        if (!(value >= variables[k].lowest && value <= variables[k].highest)) { return 0; }
    }
    if (memory->mode == mode_stepping && disorder(memory) != NULL) { return 0; }
    return memory->mode != 0U && (memory->mode & (memory->mode - 1U)) == 0U && memory->samples < (UINT64_C(1) << 53);
}

static enum status state_size(struct instance *it, const void *state, size_t *size)
{
    if (state == NULL || size == NULL) { return failed_with_null(it); }
    *size = STATE_SIZE;
    return status_ok;
}

static enum status state_written(struct instance *it, const void *state, void *bytes, size_t size)
{
    struct memory memory;
    struct carrier carrier;
    if (state == NULL || bytes == NULL) { return failed_with_null(it); }
    if (size < STATE_SIZE) { return failed(it, "the state has more bytes than that"); }
    memcpy(&memory, state, sizeof memory);
    memcpy(bytes, model_mark, MARK_SIZE);
    carrier.at = (uint8_t *)bytes + MARK_SIZE;
    carrier.is_read = 0;
    carrier.is_good = 1;
    carry(&carrier, &memory);
    return status_ok;
}

static enum status state_read(struct instance *it, const void *bytes, size_t size, void **state)
{
    uint8_t copy[STATE_SIZE];
    struct memory memory;
    struct carrier carrier;
    if (state == NULL || bytes == NULL) { return failed_with_null(it); }
    if (size != STATE_SIZE || memcmp(bytes, model_mark, MARK_SIZE) != 0) {
        return failed(it, "these bytes are no state of this model");
    }
    memcpy(copy, bytes, sizeof copy);
    begin(&memory);
    carrier.at = copy + MARK_SIZE;
    carrier.is_read = 1;
    carrier.is_good = 1;
    carry(&carrier, &memory);
    if (!carrier.is_good || !is_possible(&memory)) { return failed(it, "the bytes of this state are damaged"); }
    if (*state == NULL) { *state = calloc(1U, sizeof memory); }
    if (*state == NULL) { return failed(it, "no memory is left"); }
    memcpy(*state, &memory, sizeof memory);
    return status_ok;
}

#endif
