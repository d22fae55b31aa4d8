//! Finite switching sequences of matrices, stored run-length encoded.

/// Least excess of a product's spectral radius over 1 that counts: well above the rounding of eigenvalues.
const EXCESS_MIN: f64 = 1e-7;

/// A finite sequence and the logarithm of its growth.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Word {
    pub(super) letters: Vec<usize>,
    pub(super) radius: f64,
    /// Logarithm of the growth per sample.
    pub(super) rate: f64,
}

impl Word {
    pub(super) fn grows(&self) -> bool {
        self.radius > 1.0 + EXCESS_MIN
    }
}

/// Leaves the fastest ones, in order, shorter ones first where they are equally fast.
pub(super) fn keep_best(words: &mut Vec<Word>, count: usize) {
    words.sort_by(|left, right| {
        right.rate.total_cmp(&left.rate).then(left.letters.len().cmp(&right.letters.len()))
    });
    words.dedup_by(|left, right| left.letters == right.letters);
    words.truncate(count);
}

/// Letters with the number of times each is repeated.
pub(super) fn runs(letters: &[usize]) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &letter in letters {
        match runs.last_mut() {
            Some((last, count)) if *last == letter => *count += 1,
            _ => runs.push((letter, 1)),
        }
    }
    runs
}

/// The shortest word that gives this one by repetition, turned so that it does not begin inside a run.
///
/// Neither changes the growth per sample.
pub(super) fn shortest(letters: &[usize]) -> Vec<usize> {
    let len = letters.len();
    let repeats = |&period: &usize| {
        len.is_multiple_of(period) && (period..len).all(|at| letters[at] == letters[at - period])
    };
    let period = (1..=len).find(repeats).unwrap_or(len);
    let mut word = letters[..period].to_vec();
    let first = (1..period).find(|&at| word[at] != word[at - 1]).unwrap_or(0);
    if word.first() == word.last() {
        word.rotate_left(first);
    }
    word
}

/// The same word with one run longer or shorter; `None` when nothing would be left.
pub(super) fn with_run_changed(
    letters: &[usize],
    run: usize,
    shift: isize,
    len_max: usize,
) -> Option<Vec<usize>> {
    let mut runs = runs(letters);
    let count = &mut runs.get_mut(run)?.1;
    *count = count.saturating_add_signed(shift);
    let letters: Vec<usize> =
        runs.iter().flat_map(|&(letter, count)| core::iter::repeat_n(letter, count)).collect();
    (!letters.is_empty() && letters.len() <= len_max).then_some(letters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_counted_and_changed() {
        let letters = [0, 0, 1, 1, 1, 0];
        assert_eq!(runs(&letters), vec![(0, 2), (1, 3), (0, 1)]);
        assert_eq!(with_run_changed(&letters, 1, -2, 9), Some(vec![0, 0, 1, 0]));
        assert_eq!(with_run_changed(&letters, 2, 2, 9), Some(vec![0, 0, 1, 1, 1, 0, 0, 0]));
        assert_eq!(with_run_changed(&letters, 2, 4, 9), None);
        assert_eq!(with_run_changed(&letters, 3, 1, 9), None);
        assert_eq!(with_run_changed(&[0], 0, -1, 9), None);
    }

    #[test]
    fn a_word_is_stripped_of_repetitions_and_turned_to_the_start_of_a_run() {
        assert_eq!(shortest(&[1, 0, 0, 1, 1, 0, 0, 1]), vec![0, 0, 1, 1]);
        assert_eq!(shortest(&[0, 1, 0]), vec![1, 0, 0]);
        assert_eq!(shortest(&[2, 2, 2]), vec![2]);
        assert_eq!(shortest(&[]), Vec::<usize>::new());
    }

    #[test]
    fn the_fastest_words_are_kept_and_the_shorter_of_two_equals_comes_first() {
        let word = |letters: &[usize], rate| Word { letters: letters.to_vec(), radius: 1.0, rate };
        let mut words =
            vec![word(&[0, 1, 0, 1], 0.2), word(&[0, 1], 0.2), word(&[1], 0.1), word(&[0], 0.3)];
        keep_best(&mut words, 2);
        assert_eq!(words, vec![word(&[0], 0.3), word(&[0, 1], 0.2)]);
    }
}
