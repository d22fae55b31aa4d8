//! What is refused, and by which sentence.

use fspid_structured_text::{Kind, Library, Mistake, Problem, Value, is_reserved};

/// A block with two reals, a list and a counter, and these statements.
fn block(body: &str) -> String {
    format!(
        "FUNCTION_BLOCK FB_test
        VAR_INPUT given : REAL; flag : BOOL; END_VAR
        VAR_OUTPUT taken : REAL; count : DINT; bits : BYTE; END_VAR
        VAR CONSTANT half : REAL := REAL#0.5; END_VAR
        VAR small : ARRAY[0..2] OF USINT := [USINT#1, USINT#2, USINT#3]; END_VAR
        VAR_TEMP later : REAL; index : DINT; END_VAR
        {body}
        END_FUNCTION_BLOCK"
    )
}

fn mistake(body: &str) -> Mistake {
    let read = Library::read(&block(body)).map(|_| ());
    read.expect_err("this is to be refused").mistake
}

/// What `taken` and `count` are behind one call with `given`.
fn run(body: &str, given: f32) -> Result<(Value, Value), Problem> {
    let text = block(body);
    let library = Library::read(&text)?;
    let mut instance = library.instance("fb_TEST")?;
    instance.set("given", Value::Real(given))?;
    instance.call()?;
    Ok((instance.get("taken")?, instance.get("count")?))
}

#[test]
fn statements_do_what_they_say() {
    let body = "FOR index := DINT#0 TO DINT#2 DO
            count := count + USINT_TO_DINT(small[index]);
        END_FOR;
        IF NOT (given < REAL#0.0) THEN (* a remark *)
            taken := -(half * given);
        ELSE
            taken := DINT_TO_REAL(count) - ABS(given);
            RETURN;
        END_IF;
        count := count * DINT#2;";
    assert_eq!(run(body, 3.0), Ok((Value::Real(-1.5), Value::Dint(12))));
    assert_eq!(run(body, -3.0), Ok((Value::Real(3.0), Value::Dint(6))));
}

#[test]
fn what_two_compilers_could_read_differently_is_refused() {
    assert_eq!(mistake("taken := given * half + half;"), Mistake::Brackets("+"));
    assert_eq!(mistake("taken := given * 0.5;"), Mistake::Untyped("0".to_owned()));
    assert_eq!(mistake("count := DINT#1 + 1;"), Mistake::Untyped("1".to_owned()));
    assert_eq!(mistake("taken := REAL#1;"), Mistake::Literal("REAL#1".to_owned()));
    assert_eq!(mistake("taken := REAL#1.0E39;"), Mistake::Literal("REAL#1.0E39".to_owned()));
    assert_eq!(mistake("taken := LREAL#1.0;"), Mistake::Type(Kind::Real, Kind::Lreal));
    assert_eq!(mistake("taken := count;"), Mistake::Type(Kind::Real, Kind::Dint));
    assert_eq!(mistake("taken := given * DINT#2;"), Mistake::Type(Kind::Real, Kind::Dint));
    assert_eq!(mistake("count := small[DINT#0];"), Mistake::Type(Kind::Dint, Kind::Usint));
    assert_eq!(mistake("count := count / DINT#2;"), Mistake::Operation(Kind::Dint, "/"));
    assert_eq!(mistake("flag := TRUE;"), Mistake::ReadOnly("FLAG".to_owned()));
    assert_eq!(mistake("half := given;"), Mistake::ReadOnly("HALF".to_owned()));
    let counted = "FOR index := DINT#0 TO DINT#2 DO index := DINT#1; END_FOR;";
    assert_eq!(mistake(counted), Mistake::ReadOnly("INDEX".to_owned()));
    assert_eq!(mistake("ge := given;"), Mistake::Reserved("GE".to_owned()));
    assert_eq!(mistake("a__b := given;"), Mistake::Name("A__B".to_owned()));
    assert_eq!(mistake("other := given;"), Mistake::Undeclared("OTHER".to_owned()));
    assert_eq!(mistake("(* a (* b *) *)"), Mistake::Remark);
    assert_eq!(
        mistake("IF flag THEN taken := given; END_IF"),
        missing("`;`", "END_FUNCTION_BLOCK")
    );
    assert_eq!(mistake("taken = given;"), missing("`:=`", "`=`"));
    assert_eq!(mistake("small := given;"), Mistake::Use("SMALL".to_owned()));
}

fn missing(expected: &str, found: &str) -> Mistake {
    Mistake::Missing { expected: expected.to_owned(), found: found.to_owned() }
}

#[test]
fn what_goes_wrong_while_it_runs_is_told_with_its_line() {
    let line = |body| run(body, 1.0).expect_err("this is to fail").to_string();
    assert_eq!(line("taken := later;"), "line 7: LATER is read before it is written");
    assert_eq!(
        line("\ncount := USINT_TO_DINT(small[DINT#3]);"),
        "line 8: index 3 of SMALL, which ends at 2"
    );
    let behind = "FOR index := DINT#0 TO DINT#2 DO count := index; END_FOR; count := index;";
    assert_eq!(line(behind), "line 7: INDEX is read before it is written");
    assert_eq!(
        line("count := DINT#2147483647 + DINT#1;"),
        "line 7: a whole number leaves its type"
    );
}

#[test]
fn what_is_temporary_is_forgotten_between_calls() {
    let text = block("IF flag THEN later := given; END_IF; taken := later;");
    let library = Library::read(&text).expect("a block");
    let mut instance = library.instance("FB_test").expect("the block");
    instance.set("flag", Value::Bool(true)).expect("an input");
    assert_eq!(instance.call(), Ok(()));
    instance.set("flag", Value::Bool(false)).expect("an input");
    assert!(instance.call().is_err());
}

#[test]
fn a_program_calls_its_blocks_with_every_input_once() {
    let program = |call: &str| {
        format!(
            "{} PROGRAM PRG_test VAR one : FB_test; seen : REAL; END_VAR {call} seen := one.taken; END_PROGRAM",
            block("taken := given * half;")
        )
    };
    let text = program("one(given := REAL#4.0, flag := FALSE);");
    let library = Library::read(&text).expect("a program");
    let mut running = library.instance("PRG_test").expect("the program");
    assert_eq!(running.call(), Ok(()));
    assert_eq!(running.get("seen"), Ok(Value::Real(2.0)));
    for call in ["one(given := REAL#4.0);", "one(given := REAL#4.0, given := REAL#4.0);"] {
        let read = Library::read(&program(call)).map(|_| ());
        assert_eq!(read.map_err(|it| it.mistake), Err(Mistake::Inputs("ONE".to_owned())));
    }
}

#[test]
fn reserved_words_are_known_in_any_case() {
    for word in ["ge", "Step", "LEFT", "limit", "x", "REAL_TO_WORD"] {
        assert!(is_reserved(word), "{word}");
    }
    assert!(!is_reserved("step_rate"));
}
