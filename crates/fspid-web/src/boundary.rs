//! What the page calls: numbers alone cross over, texts and columns lie in memory that this side owns.
//!
//! `fspid_room(n)` answers where a question of `n` bytes is to be written, `fspid_ask()` answers it, and the answer lies
//! at `fspid_answer_at()`, `fspid_answer_bytes()` long: [`Answer::bytes`] says how. Both rooms are kept until the next
//! question.
//!
//! The one module with `unsafe`: a function that is called by its name from outside needs `#[unsafe(no_mangle)]`, as two
//! of one name would be linked with each other. No pointer is followed.

#![allow(unsafe_code, reason = "names that are called from outside; no pointer is followed")]

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::{Answer, answer};

static QUESTION: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn held(room: &'static Mutex<Vec<u8>>) -> MutexGuard<'static, Vec<u8>> {
    room.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for a question of so many bytes, and answers where.
#[unsafe(no_mangle)]
pub extern "C" fn fspid_room(bytes: usize) -> *const u8 {
    let mut question = held(&QUESTION);
    question.clear();
    question.resize(bytes, 0);
    question.as_ptr()
}

/// Answers the question that was written into the room.
#[unsafe(no_mangle)]
pub extern "C" fn fspid_ask() {
    let question = held(&QUESTION);
    let found = match std::str::from_utf8(&question) {
        Ok(question) => answer(question),
        Err(_) => Answer::refused("the question is not UTF-8"),
    };
    *held(&ANSWER) = found.bytes();
}

/// Where the last answer lies.
#[unsafe(no_mangle)]
pub extern "C" fn fspid_answer_at() -> *const u8 {
    held(&ANSWER).as_ptr()
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn fspid_answer_bytes() -> usize {
    held(&ANSWER).len()
}
