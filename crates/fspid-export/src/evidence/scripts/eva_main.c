/* From any memory within its bounds and for any finite sample: nothing overflows, and the memory is within
   the same bounds afterwards. What is asked of the exponential, @SWEPT@. */
#include "@PREFIX@.h"
@EXPONENTIAL@
#include "@PREFIX@.c"

/*@ assigns \result \from \nothing; ensures \is_finite(\result); */
extern @REAL@ any_number(void);
/*@ assigns \result \from \nothing; */
extern int any_choice(void);

static @REAL@ between(@REAL@ least, @REAL@ most)
{
    @REAL@ number = any_number();
    if (!(least <= number && number <= most)) {
        number = least;
    }
    return number;
}

int main(void)
{
    @PREFIX@_state state;
    @PREFIX@_sample sample;
    @PREFIX@_answer answer;
    @PREFIX@_init(&state);
@BEGINS@
@MEMORY@
@SAMPLE@
    switch (any_choice()) {
    case 0:
        @PREFIX@_hold(&@PREFIX@_design, &state, &answer, 1U);
        break;
    case 1:
        @PREFIX@_track(&@PREFIX@_design, &state, &sample, &answer, any_number());
        break;
    default:
        @PREFIX@_step(&@PREFIX@_design, &state, &sample, &answer);
        break;
    }
@GOES_ON@
@LIMITS@
    /*@ assert finite: \is_finite(answer.@COMMAND@); */
    return 0;
}
