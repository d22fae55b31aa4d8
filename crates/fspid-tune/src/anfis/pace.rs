//! The length of the steps.

/// How much longer a step becomes, and how much shorter.
const LONGER: f64 = 1.1;
const SHORTER: f64 = 0.9;

/// The length of the steps, which follows the errors.
///
/// # Source
/// Jang (1993), section IV: ten per cent more after four errors that fall in a row, ten per cent less after two rises that
/// each come with a fall.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    step: f64,
    /// The error before, none at first.
    last: Option<f64>,
    /// Which of the last changes were falls, the newest last; four at most.
    falls: Vec<bool>,
}

impl Pace {
    pub(super) fn new(step: f64) -> Self {
        Self { step, last: None, falls: Vec::new() }
    }

    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// Takes the error of an epoch in.
    pub(super) fn see(&mut self, error: f64) {
        let Some(last) = self.last.replace(error) else { return };
        if self.falls.len() == 4 {
            self.falls.remove(0);
        }
        self.falls.push(error < last);
        let factor = match self.falls.as_slice() {
            [true, true, true, true] => LONGER,
            [true, false, true, false] | [false, true, false, true] => SHORTER,
            _ => return,
        };
        self.step *= factor;
        // The same changes do not count twice.
        self.falls.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(errors: &[f64]) -> f64 {
        let mut pace = Pace::new(1.0);
        errors.iter().for_each(|&error| pace.see(error));
        pace.step()
    }

    #[test]
    fn four_falls_in_a_row_make_the_step_longer_once() {
        assert_eq!(after(&[5.0, 4.0, 3.0, 2.0]), 1.0);
        assert_eq!(after(&[5.0, 4.0, 3.0, 2.0, 1.0]), 1.1);
        assert_eq!(after(&[5.0, 4.0, 3.0, 2.0, 1.0, 0.5, 0.4, 0.3]), 1.1);
    }

    #[test]
    fn two_rises_that_alternate_with_falls_make_it_shorter() {
        assert_eq!(after(&[1.0, 2.0, 1.0, 2.0, 1.0]), 0.9);
        assert_eq!(after(&[2.0, 1.0, 2.0, 1.0, 2.0]), 0.9);
        assert_eq!(after(&[1.0, 2.0, 3.0, 2.0, 1.0, 2.0]), 1.0);
    }
}
