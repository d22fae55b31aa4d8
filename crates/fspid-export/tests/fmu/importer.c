/* A small importer: plays an FMU against what the controller answers, and calls it as it must not be called.
 *
 *     importer LIBRARY WORDS
 *
 * FMI is 2 or 3. What the standard says of types and numbers is declared here anew, not taken from what is tested.
 * Prints what went wrong, a line each, and "N checks, M failed". */
#include <dlfcn.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void *handle;
enum { ok = 0, discard = 2, error = 3 };

static unsigned checks, failures, messages;
static void *library;
static char token[64];

#define CHECK(truth) \
    do { ++checks; if (!(truth)) { ++failures; printf("line %d: %s\n", __LINE__, #truth); } } while (0)

/* A function of the library under the type of the variable that it is put into. */
#define FUNCTION(variable, name) do { void *found = dlsym(library, name); memcpy(&variable, &found, sizeof found); CHECK(variable != NULL); } while (0)

#if FMI == 2
#define NAMED(name) "fmi2" name
#define STATE "FMUstate"
#define DESERIALIZE "fmi2DeSerializeFMUstate"
typedef int truth;
typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
struct callbacks { logger log; void *(*allocate)(size_t, size_t); void (*release)(void *); void (*finished)(void *, int); void *environment; };
static handle (*instantiate_)(const char *, int, const char *, const char *, const struct callbacks *, int, int);
static int (*set_up_)(handle, int, double, double, int, double);
static int (*enter_)(handle);
static int (*set_)(handle, const unsigned *, size_t, const double *);
static int (*get_)(handle, const unsigned *, size_t, double *);
static int (*get_whole_)(handle, const unsigned *, size_t, int *);
static int (*get_truth_)(handle, const unsigned *, size_t, truth *);
static int (*step_)(handle, double, double, int);

static void heard(void *environment, const char *instance, int status, const char *category, const char *message, ...)
{
    (void)environment; (void)instance; (void)status;
    if (category != NULL && message != NULL && message[0] != '\0') { ++messages; }
}
#else
#define NAMED(name) "fmi3" name
#define STATE "FMUState"
#define DESERIALIZE "fmi3DeserializeFMUState"
typedef bool truth;
typedef void (*logger)(void *, int, const char *, const char *);
static handle (*instantiate_)(const char *, const char *, const char *, bool, bool, bool, bool, const unsigned *, size_t, void *, logger, void *);
static int (*enter_)(handle, bool, double, double, bool, double);
static int (*set_)(handle, const unsigned *, size_t, const double *, size_t);
static int (*get_)(handle, const unsigned *, size_t, double *, size_t);
static int (*get_whole_)(handle, const unsigned *, size_t, int32_t *, size_t);
static int (*get_truth_)(handle, const unsigned *, size_t, truth *, size_t);
static int (*step_)(handle, double, double, bool, bool *, bool *, bool *, double *);

static void heard(void *environment, int status, const char *category, const char *message)
{
    (void)environment; (void)status;
    if (category != NULL && message != NULL && message[0] != '\0') { ++messages; }
}
#endif
static void (*free_)(handle);
static int (*exit_)(handle), (*terminate_)(handle), (*reset_)(handle);
static int (*get_state)(handle, void **), (*set_state)(handle, void *), (*free_state)(handle, void **);
static int (*state_size)(handle, void *, size_t *), (*write_state)(handle, void *, void *, size_t);
static int (*read_state)(handle, const void *, size_t, void **);
static int (*logging)(handle, truth, size_t, const char *const *);

static void load(const char *path)
{
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) { printf("%s\n", dlerror()); exit(2); }
    FUNCTION(enter_, NAMED("EnterInitializationMode"));
    FUNCTION(exit_, NAMED("ExitInitializationMode"));
    FUNCTION(terminate_, NAMED("Terminate"));
    FUNCTION(reset_, NAMED("Reset"));
    FUNCTION(free_, NAMED("FreeInstance"));
    FUNCTION(logging, NAMED("SetDebugLogging"));
    FUNCTION(get_truth_, NAMED("GetBoolean"));
    FUNCTION(step_, NAMED("DoStep"));
    FUNCTION(get_state, NAMED("Get" STATE));
    FUNCTION(set_state, NAMED("Set" STATE));
    FUNCTION(free_state, NAMED("Free" STATE));
    FUNCTION(state_size, NAMED("Serialized" STATE "Size"));
    FUNCTION(write_state, NAMED("Serialize" STATE));
    FUNCTION(read_state, DESERIALIZE);
#if FMI == 2
    FUNCTION(instantiate_, "fmi2Instantiate");
    FUNCTION(set_up_, "fmi2SetupExperiment");
    FUNCTION(set_, "fmi2SetReal");
    FUNCTION(get_, "fmi2GetReal");
    FUNCTION(get_whole_, "fmi2GetInteger");
#else
    FUNCTION(instantiate_, "fmi3InstantiateCoSimulation");
    FUNCTION(set_, "fmi3SetFloat64");
    FUNCTION(get_, "fmi3GetFloat64");
    FUNCTION(get_whole_, "fmi3GetInt32");
#endif
}

static handle instantiated(const char *name, const char *with_token)
{
#if FMI == 2
    static const struct callbacks callbacks = { heard, calloc, free, NULL, NULL };
    return instantiate_(name, 1, with_token, "", &callbacks, 0, 1);
#else
    return instantiate_(name, with_token, NULL, false, true, false, false, NULL, 0U, NULL, heard, NULL);
#endif
}

static int entered(handle it, double start, int has_stop, double stop)
{
#if FMI == 2
    int status = set_up_(it, 0, 0.0, start, has_stop, stop);
    return status == ok ? enter_(it) : status;
#else
    return enter_(it, false, 0.0, start, has_stop != 0, stop);
#endif
}

static int set_many(handle it, const unsigned *which, size_t count, const double *values)
{
#if FMI == 2
    return set_(it, which, count, values);
#else
    return set_(it, which, count, values, count);
#endif
}

static int set_one(handle it, unsigned which, double value)
{
    return set_many(it, &which, 1U, &value);
}

static int got(handle it, unsigned which, double *value)
{
#if FMI == 2
    return get_(it, &which, 1U, value);
#else
    return get_(it, &which, 1U, value, 1U);
#endif
}

static int whole_of(handle it, unsigned which)
{
#if FMI == 2
    int value = -1;
    (void)get_whole_(it, &which, 1U, &value);
#else
    int32_t value = -1;
    (void)get_whole_(it, &which, 1U, &value, 1U);
#endif
    return (int)value;
}

static int truth_of(handle it, unsigned which)
{
    truth value = 0;
#if FMI == 2
    (void)get_truth_(it, &which, 1U, &value);
#else
    (void)get_truth_(it, &which, 1U, &value, 1U);
#endif
    return value;
}

static int stepped(handle it, double from, double length)
{
#if FMI == 2
    return step_(it, from, length, 0);
#else
    bool events = true, ends = true, early = true;
    double reached = -1.0;
    int status = step_(it, from, length, false, &events, &ends, &early, &reached);
    if (status == ok) { CHECK(!events && !ends && !early && reached == from + length); }
    return status;
#endif
}

/* What the words say. */
static double period;
static unsigned inputs, samples, parameters, input_at[3], output_at[6], lower_at, upper_at;
static uint64_t *words;
static unsigned parameter_at[64];
static double parameter_values[64];

static double number_of(uint64_t bits)
{
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static uint64_t bits_of(double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static uint64_t word(FILE *file)
{
    unsigned long long read = 0U;
    if (fscanf(file, "%llx", &read) != 1) { printf("too few words\n"); exit(2); }
    return read;
}

/* In a row: inputs, command and gains, saturated, faults. */
#define ROW 9U

static void read_words(const char *path)
{
    FILE *file = fopen(path, "r");
    unsigned k;
    if (file == NULL || fscanf(file, "%63s", token) != 1) { printf("no words\n"); exit(2); }
    period = number_of(word(file));
    inputs = (unsigned)word(file);
    samples = (unsigned)word(file);
    parameters = (unsigned)word(file);
    for (k = 0U; k < inputs; ++k) { input_at[k] = (unsigned)word(file); }
    for (k = 0U; k < 6U; ++k) { output_at[k] = (unsigned)word(file); }
    lower_at = (unsigned)word(file);
    upper_at = (unsigned)word(file);
    for (k = 0U; k < parameters; ++k) {
        parameter_at[k] = (unsigned)word(file);
        parameter_values[k] = number_of(word(file));
    }
    words = malloc(2U * samples * ROW * sizeof *words);
    for (k = 0U; k < 2U * samples * ROW; ++k) { words[k] = word(file); }
    fclose(file);
}

/* The row of a sample, of the design or of the one with other parameters. */
static const uint64_t *row_of(int is_other, unsigned sample)
{
    return words + ((is_other ? samples : 0U) + sample) * ROW;
}

static void give(handle it, const uint64_t *row)
{
    unsigned k;
    for (k = 0U; k < inputs; ++k) { CHECK(set_one(it, input_at[k], number_of(row[k])) == ok); }
}

static int answers(handle it, const uint64_t *row)
{
    unsigned k;
    int is_same = 1;
    for (k = 0U; k < 4U; ++k) {
        double value = 0.0;
        CHECK(got(it, output_at[k], &value) == ok);
        is_same = is_same && bits_of(value) == row[3U + k];
    }
    return is_same && truth_of(it, output_at[4]) == (int)row[7] && whole_of(it, output_at[5]) == (int)row[8];
}

static void fly(handle it, int is_other, unsigned from, unsigned to)
{
    unsigned k, different = 0U;
    for (k = from; k < to; ++k) {
        const uint64_t *row = row_of(is_other, k);
        give(it, row);
        CHECK(stepped(it, k * period, period) == ok);
        different += !answers(it, row);
    }
    if (different > 0U) { printf("%u of samples %u to %u have other bits\n", different, from, to); }
    CHECK(different == 0U);
}

static handle ready(const char *name)
{
    handle it = instantiated(name, token);
    CHECK(it != NULL);
    CHECK(entered(it, 0.0, 0, 0.0) == ok);
    CHECK(exit_(it) == ok);
    return it;
}

static void two_side_by_side(void)
{
    handle first = ready("first"), second = ready("second");
    unsigned k, part = samples / 8U;
    for (k = 0U; k < 8U; ++k) {
        fly(first, 0, k * part, (k + 1U) * part);
        if (k > 0U) { fly(second, 0, (k - 1U) * part, k * part); }
    }
    CHECK(terminate_(first) == ok);
    CHECK(stepped(first, 0.0, period) == error);
    CHECK(reset_(first) == ok);
    CHECK(entered(first, 0.0, 1, 1e6) == ok && exit_(first) == ok);
    fly(first, 0, 0U, part);
    free_(first);
    fly(second, 0, 7U * part, samples);
    free_(second);
}

static void steps_back(void)
{
    handle it = ready("steps back"), other = instantiated("takes over", token);
    void *state = NULL, *copy = NULL;
    unsigned half = samples / 2U;
    size_t size = 0U, k;
    unsigned char *bytes, keep, time[8];
    fly(it, 0, 0U, half);
    CHECK(get_state(it, &state) == ok && state != NULL);
    fly(it, 0, half, samples);
    CHECK(set_state(it, state) == ok);
    fly(it, 0, half, samples);
    CHECK(state_size(it, state, &size) == ok && size > 0U);
    bytes = malloc(size);
    CHECK(write_state(it, state, bytes, size) == ok);
    CHECK(read_state(other, bytes, size, &copy) == ok);
    CHECK(set_state(other, copy) == ok);
    fly(other, 0, half, samples);
    /* Damaged bytes are refused or make a state that can be flown; nothing else may happen. */
    for (k = 0U; k < size; ++k) {
        void *damaged = NULL;
        bytes[k] ^= (unsigned char)(1U << (k % 8U));
        if (read_state(other, bytes, size, &damaged) == ok) {
            CHECK(set_state(other, damaged) == ok);
            (void)stepped(other, half * period, period);
        }
        bytes[k] ^= (unsigned char)(1U << (k % 8U));
        CHECK(free_state(other, &damaged) == ok);
        (void)reset_(other);
    }
    /* Behind the mark of 16 bytes: three times, the count of samples, the mode. */
    keep = bytes[48];
    bytes[48] = 3U;
    CHECK(read_state(other, bytes, size, &copy) == error && reset_(other) == ok);
    bytes[48] = keep;
    memcpy(time, bytes + 16, 8U);
    memset(bytes + 16, 0xff, 8U);
    CHECK(read_state(other, bytes, size, &copy) == error && reset_(other) == ok);
    memcpy(bytes + 16, time, 8U);
    /* An input may be anything. */
    CHECK(set_state(it, state) == ok && set_one(it, input_at[0], NAN) == ok && get_state(it, &state) == ok);
    CHECK(write_state(it, state, bytes, size) == ok && read_state(other, bytes, size, &copy) == ok);
    CHECK(read_state(other, bytes, size - 1U, &copy) == error);
    CHECK(reset_(other) == ok);
    CHECK(write_state(other, copy, bytes, size - 1U) == error);
    CHECK(free_state(it, &copy) == ok && copy == NULL);
    CHECK(free_state(it, &copy) == ok);
    CHECK(free_state(it, &state) == ok);
    free(bytes);
    free_(it);
    free_(other);
}

/* Steps of half a period, and of three with the inputs held. */
static void other_steps(void)
{
    handle halves = ready("halves"), one = ready("one"), three = ready("three");
    double by_one, by_three;
    unsigned k;
    for (k = 0U; k < 40U; ++k) {
        give(halves, row_of(0, k));
        CHECK(stepped(halves, k * period, 0.5 * period) == ok);
        CHECK(answers(halves, row_of(0, k)));
        /* Between samples nothing is seen. */
        give(halves, row_of(0, samples - 1U - k));
        CHECK(stepped(halves, (k + 0.5) * period, (k + 1U) * period - (k + 0.5) * period) == ok);
        CHECK(answers(halves, row_of(0, k)));
    }
    for (k = 0U; k < 30U; ++k) {
        give(one, row_of(0, k / 3U));
        CHECK(stepped(one, k * period, period) == ok);
        if (k % 3U == 2U) {
            give(three, row_of(0, k / 3U));
            CHECK(stepped(three, (k - 2U) * period, 3.0 * period) == ok);
            CHECK(got(one, output_at[0], &by_one) == ok && got(three, output_at[0], &by_three) == ok);
            CHECK(bits_of(by_one) == bits_of(by_three));
        }
    }
    free_(halves);
    free_(one);
    free_(three);
}

/* Ten minutes at 10 ms: a clock of 32 bits is a thousandth of a period ahead by then, and takes a sample too many. */
static void far_on(void)
{
    handle it = ready("far on");
    void *state = NULL;
    unsigned char *bytes;
    size_t size = 0U;
    unsigned k;
    uint64_t taken = 0U;
    give(it, row_of(0, 0U));
    for (k = 0U; k < 60000U; ++k) {
        if (stepped(it, k * period, period) != ok) { break; }
    }
    CHECK(get_state(it, &state) == ok && state_size(it, state, &size) == ok);
    bytes = malloc(size);
    CHECK(write_state(it, state, bytes, size) == ok);
    /* Behind the mark of 16 bytes and three times, the lowest byte first. */
    for (k = 8U; k > 0U; --k) { taken = taken << 8U | bytes[39U + k]; }
    CHECK(taken == 60000U);
    free(bytes);
    CHECK(free_state(it, &state) == ok);
    free_(it);
}

/* The parameters of another design make this one answer as that. */
static void takes_parameters(void)
{
    handle it = instantiated("other parameters", token);
    double value = 0.0;
    unsigned k;
    for (k = 0U; k < parameters; ++k) { CHECK(set_one(it, parameter_at[k], parameter_values[k]) == ok); }
    CHECK(entered(it, 0.0, 0, 0.0) == ok);
    for (k = 0U; k < parameters; ++k) {
        CHECK(got(it, parameter_at[k], &value) == ok && bits_of(value) == bits_of(parameter_values[k]));
    }
    CHECK(exit_(it) == ok);
    fly(it, 1, 0U, samples);
    CHECK(reset_(it) == ok);
    CHECK(entered(it, 0.0, 0, 0.0) == ok && exit_(it) == ok);
    /* At the first communication point too: gains that accumulate began from those of before. */
    CHECK(set_many(it, parameter_at, parameters, parameter_values) == ok);
    fly(it, 1, 0U, samples);
    CHECK(reset_(it) == ok);
    CHECK(entered(it, 0.0, 0, 0.0) == ok && exit_(it) == ok);
    /* And behind a sample that could not be used, which stays latched. */
    CHECK(set_one(it, input_at[0], NAN) == ok && stepped(it, 0.0, period) == ok);
    CHECK(set_many(it, parameter_at, parameters, parameter_values) == ok);
    CHECK(whole_of(it, output_at[5]) == 1);
    CHECK(reset_(it) == ok);
    CHECK(entered(it, 0.0, 0, 0.0) == ok && exit_(it) == ok);
    fly(it, 0, 0U, samples / 4U);
    /* In flight as well, all at once. */
    CHECK(set_many(it, parameter_at, parameters, parameter_values) == ok);
    CHECK(stepped(it, (samples / 4U) * period, period) == ok);
    free_(it);
}

static void refuses_parameters(void)
{
    static const double bad[] = { NAN, INFINITY, -INFINITY };
    handle it = ready("bad parameters");
    double before = 0.0, after = 0.0, lower = 0.0, upper = 0.0;
    double limits[2];
    unsigned k, both[2];
    for (k = 0U; k < 3U * parameters; ++k) {
        unsigned told = messages;
        CHECK(got(it, parameter_at[k / 3U], &before) == ok);
        CHECK(set_one(it, parameter_at[k / 3U], bad[k % 3U]) == discard && messages > told);
        CHECK(got(it, parameter_at[k / 3U], &after) == ok && bits_of(before) == bits_of(after));
    }
    if (lower_at != 0U && upper_at != 0U) {
        CHECK(got(it, lower_at, &lower) == ok && got(it, upper_at, &upper) == ok);
        CHECK(set_one(it, lower_at, upper) == discard);
        CHECK(set_one(it, lower_at, upper + 1.0) == discard);
        CHECK(got(it, lower_at, &after) == ok && bits_of(after) == bits_of(lower));
        both[0] = lower_at; both[1] = upper_at;
        limits[0] = 1000.0; limits[1] = 1001.0;
        CHECK(set_many(it, both, 2U, limits) == ok);
        fly(it, 0, 0U, 0U);
        CHECK(reset_(it) == ok);
        CHECK(set_one(it, lower_at, upper + 1.0) == ok);
        CHECK(entered(it, 0.0, 0, 0.0) == ok);
        CHECK(exit_(it) == error);
        /* Before the first sample the command is 0, or the limit next to it. */
        CHECK(reset_(it) == ok && entered(it, 0.0, 0, 0.0) == ok && set_many(it, both, 2U, limits) == ok);
        CHECK(got(it, output_at[0], &after) == ok && bits_of(after) == bits_of(limits[0]));
        CHECK(exit_(it) == ok && got(it, output_at[0], &after) == ok && bits_of(after) == bits_of(limits[0]));
    }
    free_(it);
}

static void wrong_calls(void)
{
    static const char *const unknown[] = { "logNothing" };
    static const char *const known[] = { "logStatusDiscard" };
    static const double bad[] = { 0.0, -1.0, NAN, INFINITY, 1e300 };
    handle it = instantiated("wrong calls", token);
    double value = 0.0;
    unsigned k, told = messages;
    CHECK(instantiated("x", "{00000000-0000-0000-0000-000000000000}") == NULL);
    CHECK(instantiated("", token) == NULL && instantiated(NULL, token) == NULL && instantiated("x", NULL) == NULL);
    CHECK(messages == told + 4U);
    CHECK(stepped(it, 0.0, period) == error && messages == told + 5U);
    CHECK(set_one(it, input_at[0], 0.0) == error);
    CHECK(entered(it, 0.0, 0, 0.0) == error);
    CHECK(reset_(it) == ok && exit_(it) == error);
    CHECK(reset_(it) == ok && terminate_(it) == error);
    CHECK(reset_(it) == ok && entered(it, NAN, 0, 0.0) == error);
    CHECK(reset_(it) == ok && entered(it, 1.0, 1, 0.0) == error);
    CHECK(reset_(it) == ok && logging(it, 1, 1U, unknown) == error);
    CHECK(reset_(it) == ok && logging(it, 1, 1U, NULL) == error);
    CHECK(reset_(it) == ok && logging(it, 0, 0U, NULL) == ok && logging(it, 1, 1U, known) == ok);
    for (k = 0U; k < 5U; ++k) {
        CHECK(reset_(it) == ok && entered(it, 0.0, 0, 0.0) == ok && exit_(it) == ok);
        CHECK(stepped(it, 0.0, bad[k]) == error);
        CHECK(stepped(it, 0.0, period) == error);
    }
    CHECK(reset_(it) == ok && entered(it, 0.0, 1, 10.5 * period) == ok && exit_(it) == ok);
    CHECK(stepped(it, 0.0, 10.0 * period) == ok);
    CHECK(stepped(it, 10.0 * period, period) == error);
    CHECK(reset_(it) == ok && entered(it, 5.0, 0, 0.0) == ok && exit_(it) == ok);
    CHECK(stepped(it, 4.0, period) == error);
    CHECK(reset_(it) == ok && entered(it, 5.0, 0, 0.0) == ok && exit_(it) == ok);
    give(it, row_of(0, 0U));
    CHECK(stepped(it, 5.0, period) == ok && answers(it, row_of(0, 0U)));
    CHECK(reset_(it) == ok && entered(it, 5.0, 0, 0.0) == ok && exit_(it) == ok);
    CHECK(set_one(it, input_at[0], NAN) == ok && stepped(it, 5.0, period) == ok && whole_of(it, output_at[5]) == 1);
    CHECK(set_one(it, output_at[0], 0.0) == error);
    CHECK(got(it, output_at[0], &value) == ok);
    CHECK(got(it, 4000000000U, &value) == error && got(it, output_at[5], &value) == error);
    CHECK(reset_(it) == ok && set_many(it, NULL, 1U, &value) == error);
    CHECK(reset_(it) == ok && set_many(it, input_at, 1U, NULL) == error);
    CHECK(reset_(it) == ok && set_many(it, NULL, 0U, NULL) == ok);
    CHECK(reset_(it) == ok && get_state(it, NULL) == error);
    CHECK(reset_(it) == ok && set_state(it, NULL) == error);
    CHECK(reset_(it) == ok && state_size(it, NULL, NULL) == error);
    CHECK(reset_(it) == ok && read_state(it, NULL, 0U, NULL) == error);
    CHECK(reset_(NULL) == error && stepped(NULL, 0.0, period) == error && set_many(NULL, NULL, 0U, NULL) == error);
    CHECK(get_state(NULL, NULL) == error && free_state(NULL, NULL) == error && got(NULL, 0U, &value) == error);
    free_(it);
    free_(NULL);
}

int main(int count, char **arguments)
{
    if (count != 3) { return 2; }
    load(arguments[1]);
    read_words(arguments[2]);
    two_side_by_side();
    steps_back();
    other_steps();
    far_on();
    takes_parameters();
    refuses_parameters();
    wrong_calls();
    free(words);
    dlclose(library);
    printf("%u checks, %u failed\n", checks, failures);
    return failures == 0U ? 0 : 1;
}
