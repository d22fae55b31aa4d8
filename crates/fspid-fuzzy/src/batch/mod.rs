//! Many inferences at once: the answers of [`Supervisor::infer`] bit by bit, several times as fast.
//!
//! Inputs and answers are arrays, one number after the other. As many inferences as the machine has
//! lanes in a vector go side by side, through the same equations as a single one. Which instructions
//! a machine has is found out while the program runs, so one program serves all of them; its answers
//! do not depend on it. Nothing is allocated.
//!
//! For controllers that fly this is of no use: they ask one question at a time. It is for surfaces,
//! campaigns and proofs.
//!
//! ```
//! use fspid_fuzzy::{Answers, Defuzzifier, OutOfRange, RuleTable, Supervisor};
//! # let rows = "ZO ZO ZO ZO ZO ZO PB\n".repeat(7);
//! # let table = RuleTable::parse([&rows, &rows, &rows])?;
//!
//! let supervisor = Supervisor::new(&table, 5.0_f64, Defuzzifier::Exact, OutOfRange::Clamp)?;
//! let (error, change) = ([0.0, 1.0, 7.0], [1.0, -2.0, 0.5]);
//! let (mut kp, mut ki, mut kd) = ([0.0; 3], [0.0; 3], [0.0; 3]);
//! let (mut clamped, mut underflowed) = ([false; 3], [false; 3]);
//! let answers = Answers {
//!     kp: &mut kp,
//!     ki: &mut ki,
//!     kd: &mut kd,
//!     clamped: &mut clamped,
//!     underflowed: &mut underflowed,
//! };
//! supervisor.infer_many(&error, &change, answers)?;
//! assert_eq!(kd[1].to_bits(), supervisor.infer(1.0, -2.0)?.delta.kd.to_bits());
//! assert_eq!(clamped, [false, false, true]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use core::fmt;
use core::ops::Range;

use fearless_simd::{Simd, SimdFloat, SimdMask, dispatch};

use crate::inference::{Inference, InferenceError};
use crate::supervisor::{OutOfRange, Supervisor};
use fspid_numeric::{InstructionSet, Real, Vector};

/// Where a batch of answers is to be put: arrays as long as those of the inputs.
#[derive(Debug)]
pub struct Answers<'a, R> {
    /// Increments of the proportional gain, as in [`Increments`](crate::Increments).
    pub kp: &'a mut [R],
    /// Increments of the integral gain.
    pub ki: &'a mut [R],
    /// Increments of the derivative gain.
    pub kd: &'a mut [R],
    /// As [`Inference::clamped`].
    pub clamped: &'a mut [bool],
    /// As [`Inference::underflowed`].
    pub underflowed: &'a mut [bool],
}

/// Why a batch was not answered, or not to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BatchError {
    /// An array is not as long as that of the errors. Nothing has been answered.
    Length {
        /// Which array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Length of the array of errors.
        expected: usize,
    },
    /// The first inputs that have no answer. All before them have been answered; what stands at
    /// their place and behind it means nothing.
    Refused {
        /// Place of the inputs, from 0.
        index: usize,
        /// Why there is no answer.
        error: InferenceError,
    },
}

impl fmt::Display for BatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { what, found, expected } => {
                write!(f, "{what} has a length of {found}; allowed is that of error, {expected}")
            }
            Self::Refused { index, error } => write!(f, "inputs {index}: {error}"),
        }
    }
}

impl core::error::Error for BatchError {}

impl<R: Real> Supervisor<R> {
    /// Increments of the gains for many errors and their changes: in each place the bits and flags
    /// of [`infer`](Self::infer).
    ///
    /// Inputs beyond the range cost no time under [`OutOfRange::Clamp`]; under
    /// [`OutOfRange::Evaluate`] each is answered by itself.
    ///
    /// # Errors
    /// [`BatchError::Length`] for arrays of different lengths, [`BatchError::Refused`] for the first
    /// inputs that [`infer`](Self::infer) refuses.
    pub fn infer_many(
        &self,
        error: &[R],
        change: &[R],
        answers: Answers<'_, R>,
    ) -> Result<(), BatchError> {
        self.infer_many_by(InstructionSet::best(), error, change, answers)
    }

    /// [`infer_many`](Self::infer_many) by instructions of choice, for tests and measurements: the
    /// answers are the same.
    ///
    /// # Errors
    /// As [`infer_many`](Self::infer_many).
    pub fn infer_many_by(
        &self,
        instructions: InstructionSet,
        error: &[R],
        change: &[R],
        answers: Answers<'_, R>,
    ) -> Result<(), BatchError> {
        let mut batch = Batch { supervisor: self, error, change, answers };
        batch.check_lengths()?;
        dispatch!(instructions.level(), simd => batch.answer(simd))
    }
}

/// What is to be answered, and where.
struct Batch<'a, R> {
    supervisor: &'a Supervisor<R>,
    error: &'a [R],
    change: &'a [R],
    answers: Answers<'a, R>,
}

impl<R: Real> Batch<'_, R> {
    fn check_lengths(&self) -> Result<(), BatchError> {
        let expected = self.error.len();
        let Answers { kp, ki, kd, clamped, underflowed } = &self.answers;
        for (what, found) in [
            ("change", self.change.len()),
            ("kp", kp.len()),
            ("ki", ki.len()),
            ("kd", kd.len()),
            ("clamped", clamped.len()),
            ("underflowed", underflowed.len()),
        ] {
            if found != expected {
                return Err(BatchError::Length { what, found, expected });
            }
        }
        Ok(())
    }

    /// Answers everything in turn: which four numbers of a table are looked up differs from lane to lane.
    fn answer_one_by_one(&mut self) -> Result<(), BatchError> {
        let Self { supervisor, error, change, answers } = self;
        for (index, (&error, &change)) in error.iter().zip(*change).enumerate() {
            let refused = |error| BatchError::Refused { index, error };
            let Inference { delta, clamped, underflowed } =
                supervisor.infer(error, change).map_err(refused)?;
            (answers.kp[index], answers.ki[index], answers.kd[index]) =
                (delta.kp, delta.ki, delta.kd);
            (answers.clamped[index], answers.underflowed[index]) = (clamped, underflowed);
        }
        Ok(())
    }

    /// Answers everything with the vectors of an instruction set.
    #[inline(always)]
    fn answer<S: Simd>(&mut self, simd: S) -> Result<(), BatchError> {
        self.answer_by::<S, R::Vector<S>>(simd)
    }

    #[inline(always)]
    fn answer_by<S: Simd, V: SimdFloat<S, Element = R>>(
        &mut self,
        simd: S,
    ) -> Result<(), BatchError> {
        let Some(beside) = self.supervisor.beside() else {
            return self.answer_one_by_one();
        };
        let high = V::simd_from(simd, self.supervisor.range());
        let low = V::simd_from(simd, -self.supervisor.range());
        let mut begin = 0;
        while begin < self.error.len() {
            let places = begin..self.error.len().min(begin + V::LEN);
            let error = load::<S, V>(simd, &self.error[places.clone()]);
            let change = load::<S, V>(simd, &self.change[places.clone()]);
            let inside = error.abs().simd_le(high) & change.abs().simd_le(high);

            let error = Vector::new(error.max(low).min(high));
            let change = Vector::new(change.max(low).min(high));
            let [kp, ki, kd] = self.supervisor.increments_in_lanes(&beside, error, change);
            store(kp.0, &mut self.answers.kp[places.clone()]);
            store(ki.0, &mut self.answers.ki[places.clone()]);
            store(kd.0, &mut self.answers.kd[places.clone()]);
            self.answers.clamped[places.clone()].fill(false);
            self.answers.underflowed[places.clone()].fill(false);
            if inside.any_false() {
                self.answer_outside(places)?;
            }
            begin += V::LEN;
        }
        Ok(())
    }

    /// Sets right what has been answered for inputs beyond the range as if they were at its ends.
    #[cold]
    #[inline(never)]
    fn answer_outside(&mut self, places: Range<usize>) -> Result<(), BatchError> {
        let Self { supervisor, error, change, answers } = self;
        for index in places {
            let (error, change) = (error[index], change[index]);
            if supervisor.holds(error) && supervisor.holds(change) {
                continue;
            }
            let refused = |error| BatchError::Refused { index, error };
            if supervisor.out_of_range() == OutOfRange::Clamp {
                supervisor.refuse_any(error, change).map_err(refused)?;
                answers.clamped[index] = true;
                continue;
            }
            let Inference { delta, clamped, underflowed } =
                supervisor.infer(error, change).map_err(refused)?;
            (answers.kp[index], answers.ki[index], answers.kd[index]) =
                (delta.kp, delta.ki, delta.kd);
            (answers.clamped[index], answers.underflowed[index]) = (clamped, underflowed);
        }
        Ok(())
    }
}

/// A vector of numbers; zeros where there are too few.
#[inline(always)]
fn load<S: Simd, V: SimdFloat<S>>(simd: S, numbers: &[V::Element]) -> V
where
    V::Element: Real,
{
    if numbers.len() == V::LEN {
        return V::from_slice(simd, numbers);
    }
    let mut vector = V::simd_from(simd, V::Element::ZERO);
    for (lane, &number) in vector.as_mut_slice().iter_mut().zip(numbers) {
        *lane = number;
    }
    vector
}

/// The first numbers of a vector, as many as there is place for.
#[inline(always)]
fn store<S: Simd, V: SimdFloat<S>>(vector: V, places: &mut [V::Element])
where
    V::Element: Real,
{
    if places.len() == V::LEN {
        return vector.store_slice(places);
    }
    for (place, &lane) in places.iter_mut().zip(vector.as_slice()) {
        *place = lane;
    }
}
