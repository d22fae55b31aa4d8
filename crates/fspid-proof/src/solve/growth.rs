//! Sequences of matrices whose product grows: lower bounds of the joint spectral radius.
//!
//! A set of stable matrices can have unstable products. At a hundred samples a second such a product has
//! tens or hundreds of factors, far beyond any enumeration. So short products are searched in breadth,
//! long ones by a flight: at every sample the matrix is taken under which the form of the solver's last
//! iterate grows most. What repeats in such a flight is cut out, its switching instants are moved to and
//! fro, and the eigenvalues of its product decide.
//!
//! # Source
//! R. Jungers, The Joint Spectral Radius, Springer 2009, chapter 2; G. Gripenberg, Computing the joint
//! spectral radius, Linear Algebra and its Applications 234 (1996) 43, for the pruning by a norm.

use fspid_lti::{Matrix, spectral_radius};

use super::Effort;
use super::dense::{Dense, dot};
use super::lyapunov::closest_form;
use super::words::{Word, keep_best, runs, shortest, with_run_changed};

/// Products kept at each length of the search in breadth.
const BEAM: usize = 24;
/// Longest product of the search in breadth.
const SHORT_MAX: usize = 10;
/// Samples for which a choice is held in thought when the flight compares the matrices.
const OUTLOOKS: [usize; 4] = [1, 4, 16, 64];
/// Longest period cut out of a flight, in samples.
const PERIOD_MAX: usize = 3000;
/// Periods of one flight whose products are formed.
const PERIODS_PER_FLIGHT: usize = 12;
/// Candidates whose switching instants are moved.
const POLISHED: usize = 4;
/// Rounds of moving all switching instants.
const ROUNDS_MAX: usize = 12;
/// Shifts tried for each switching instant, in samples.
const SHIFTS: [isize; 6] = [-8, -3, -1, 1, 3, 8];

/// A sequence whose product has an eigenvalue outside the unit circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// Numbers of the matrices in the order in which they act; to be repeated without end.
    pub sequence: Vec<usize>,
    /// Growth per sample: the spectral radius of the product to the power of one over its length.
    pub radius_per_step: f64,
    /// Spectral radius of the product of the whole sequence.
    pub spectral_radius_of_product: f64,
    /// State of unit length that grows at this rate when the sequence acts on it again and again.
    pub direction: Vec<f64>,
}

/// Looks for a sequence of the matrices whose product grows.
///
/// A single matrix that is unstable is returned before any longer sequence, the most unstable one first.
/// `None` proves nothing; it is also the answer to an empty set and to matrices that do not fit each other
/// or are not finite.
#[must_use]
pub fn growing_sequence(matrices: &[Matrix], effort: &Effort) -> Option<Growth> {
    let set = Set::new(matrices, effort)?;
    let mut best = set.singles();
    if best.first()?.grows() {
        return set.growth(best.swap_remove(0));
    }
    best.extend(set.short_products());
    best.extend(set.flights(effort));
    keep_best(&mut best, POLISHED);
    let mut polished: Vec<Word> = best.into_iter().map(|word| set.polished(word)).collect();
    keep_best(&mut polished, 1);
    polished.pop().filter(Word::grows).and_then(|word| set.growth(word))
}

/// The matrices in coordinates in which the form is the identity.
struct Set {
    matrices: Vec<Dense>,
    /// From these coordinates back to those of the caller.
    back: Dense,
}

/// A stretch of a flight.
struct Flight {
    letters: Vec<usize>,
    /// Unit vectors before each sample.
    states: Vec<Vec<f64>>,
}

impl Set {
    fn new(matrices: &[Matrix], effort: &Effort) -> Option<Self> {
        let lower = closest_form(matrices, effort)?.cholesky()?;
        let back = lower.lower_inverse().transpose();
        let upper = lower.transpose();
        let matrices =
            matrices.iter().map(|matrix| upper.times(&Dense::from(matrix)).times(&back)).collect();
        Some(Self { matrices, back })
    }

    fn size(&self) -> usize {
        self.back.rows
    }

    fn product(&self, letters: &[usize]) -> Dense {
        runs(letters).into_iter().fold(Dense::identity(self.size()), |product, (letter, count)| {
            power(&self.matrices[letter], count).times(&product)
        })
    }

    /// `None` when the product is not finite or its eigenvalues are not found.
    fn word(&self, letters: Vec<usize>) -> Option<Word> {
        let letters = shortest(&letters);
        let radius = spectral_radius(&self.product(&letters).to_matrix()?).ok()?;
        let rate = libm::log(radius) / letters.len() as f64;
        Some(Word { letters, radius, rate })
    }

    fn singles(&self) -> Vec<Word> {
        let mut words: Vec<Word> =
            (0..self.matrices.len()).filter_map(|letter| self.word(vec![letter])).collect();
        keep_best(&mut words, usize::MAX);
        words
    }

    /// Best product of each length up to [`SHORT_MAX`]; at each length the largest in norm are continued.
    fn short_products(&self) -> Vec<Word> {
        let mut found = Vec::new();
        let mut beam = vec![(vec![], Dense::identity(self.size()))];
        for _ in 0..SHORT_MAX {
            let mut longer: Vec<(Vec<usize>, Dense)> = Vec::new();
            for (letters, product) in &beam {
                for (letter, matrix) in self.matrices.iter().enumerate() {
                    let letters: Vec<usize> = letters.iter().copied().chain([letter]).collect();
                    longer.push((letters, matrix.times(product)));
                }
            }
            longer.sort_by(|left, right| right.1.norm().total_cmp(&left.1.norm()));
            longer.truncate(BEAM);
            let mut words: Vec<Word> =
                longer.iter().filter_map(|(letters, _)| self.word(letters.clone())).collect();
            keep_best(&mut words, 1);
            found.extend(words);
            beam = longer;
        }
        found
    }

    /// Periods of the flights of all outlooks and starts.
    fn flights(&self, effort: &Effort) -> Vec<Word> {
        let mut found = Vec::new();
        for outlook in OUTLOOKS {
            let ahead: Vec<Dense> =
                self.matrices.iter().map(|matrix| power(matrix, outlook)).collect();
            for start in 0..self.size() {
                if (effort.stops)() {
                    return Vec::new();
                }
                let flight = self.fly(&ahead, start, effort.flight_samples);
                found.extend(self.periods(&flight));
            }
            keep_best(&mut found, POLISHED);
        }
        found
    }

    /// Flies from a unit vector, always with the matrix that makes the state longest at the outlook.
    fn fly(&self, ahead: &[Dense], start: usize, samples: usize) -> Flight {
        let mut state: Vec<f64> =
            (0..self.size()).map(|i| if i == start { 1.0 } else { 0.1 }).collect();
        let mut flight = Flight { letters: vec![], states: vec![] };
        for _ in 0..samples {
            let Some(unit) = unit(&state) else { break };
            let longest = ahead
                .iter()
                .map(|ahead| squared_length(&ahead.times_vector(&unit)))
                .enumerate()
                .fold((0, f64::NEG_INFINITY), |best, (letter, length)| {
                    if length > best.1 { (letter, length) } else { best }
                });
            state = self.matrices[longest.0].times_vector(&unit);
            flight.letters.push(longest.0);
            flight.states.push(unit);
        }
        flight
    }

    /// Stretches from one change of the matrix to another after which the state points the same way.
    fn periods(&self, flight: &Flight) -> Vec<Word> {
        let letters = &flight.letters;
        let changes: Vec<usize> = (letters.len() / 2..letters.len())
            .filter(|&at| at > 0 && letters[at] != letters[at - 1])
            .collect();
        let mut stretches: Vec<(f64, usize, usize)> = Vec::new();
        for (number, &from) in changes.iter().enumerate().take(PERIODS_PER_FLIGHT) {
            let ends = changes[number + 1..].iter().take_while(|&&to| to - from <= PERIOD_MAX);
            for &to in ends.filter(|&&to| letters[to] == letters[from]) {
                let cosine = dot(&flight.states[from], &flight.states[to]).abs();
                stretches.push((cosine, from, to));
            }
        }
        stretches.sort_by(|left, right| right.0.total_cmp(&left.0).then(left.2.cmp(&right.2)));
        stretches.truncate(PERIODS_PER_FLIGHT);
        stretches
            .into_iter()
            .filter_map(|(_, from, to)| self.word(letters[from..to].to_vec()))
            .collect()
    }

    /// The word after moves of its switching instants, each of which made it faster.
    fn polished(&self, word: Word) -> Word {
        let mut best = word;
        for _ in 0..ROUNDS_MAX {
            let before = best.rate;
            while let Some(better) = self.steered(&best) {
                best = better;
            }
            for run in 0..runs(&best.letters).len() {
                for shift in SHIFTS {
                    let moved = with_run_changed(&best.letters, run, shift, 2 * PERIOD_MAX);
                    if let Some(moved) = moved.and_then(|letters| self.word(letters))
                        && moved.rate > best.rate
                    {
                        best = moved;
                    }
                }
            }
            if !(best.rate > before) {
                break;
            }
        }
        best
    }

    /// The word after an exchange of letters along the way of its own growing state.
    ///
    /// With the state $v_k$ and the costate $w_k$ before sample k, the letter in force is worth
    /// $w_{k+1}^T M v_k$; one that is worth more makes the product grow faster, to first order. `None`
    /// when no exchange does.
    fn steered(&self, word: &Word) -> Option<Word> {
        let product = self.product(&word.letters);
        let mut state = dominant(&product)?;
        let mut costate = dominant(&product.transpose())?;
        let mut costates = Vec::with_capacity(word.letters.len());
        for &letter in word.letters.iter().rev() {
            costates.push(costate.clone());
            costate = unit(&self.matrices[letter].transpose().times_vector(&costate))?;
        }
        let mut exchanges: Vec<(f64, usize, usize)> = Vec::new();
        for (at, (&letter, costate)) in word.letters.iter().zip(costates.iter().rev()).enumerate() {
            let worth = |matrix: &Dense| dot(costate, &matrix.times_vector(&state));
            let own = worth(&self.matrices[letter]);
            for (other, matrix) in self.matrices.iter().enumerate() {
                let gain = worth(matrix) / own - 1.0;
                if gain > 1e-12 {
                    exchanges.push((gain, at, other));
                }
            }
            state = unit(&self.matrices[letter].times_vector(&state))?;
        }
        self.exchanged(word, exchanges)
    }

    /// The word with as many of the most valuable exchanges as still make it faster.
    fn exchanged(&self, word: &Word, mut exchanges: Vec<(f64, usize, usize)>) -> Option<Word> {
        exchanges.sort_by(|left, right| left.0.total_cmp(&right.0).then(left.1.cmp(&right.1)));
        let mut count = exchanges.len();
        while count > 0 {
            let mut letters = word.letters.clone();
            for &(_, at, letter) in &exchanges[exchanges.len() - count..] {
                letters[at] = letter;
            }
            if let Some(better) = self.word(letters)
                && better.rate > word.rate
            {
                return Some(better);
            }
            count /= 4;
        }
        None
    }

    fn growth(&self, word: Word) -> Option<Growth> {
        let state = leading_state(&self.product(&word.letters))?;
        Some(Growth {
            radius_per_step: libm::exp(word.rate),
            spectral_radius_of_product: word.radius,
            direction: unit(&self.back.times_vector(&state))?,
            sequence: word.letters,
        })
    }
}

/// The matrix applied `count` times, by squaring.
fn power(matrix: &Dense, mut count: usize) -> Dense {
    let (mut power, mut square) = (Dense::identity(matrix.rows), matrix.clone());
    loop {
        if count % 2 == 1 {
            power = power.times(&square);
        }
        count /= 2;
        if count == 0 {
            return power;
        }
        square = square.times(&square);
    }
}

/// A vector of the direction or plane that grows most: whatever decays faster is gone from it.
fn leading_state(matrix: &Dense) -> Option<Vec<f64>> {
    // No symmetry of the states hides the direction from this one.
    let mut state: Vec<f64> = (0..matrix.rows).map(|i| 1.0 + 0.3 * i as f64).collect();
    for _ in 0..1000 {
        state = unit(&matrix.times_vector(&unit(&state)?))?;
    }
    Some(state)
}

/// Eigenvector of the largest eigenvalue; `None` when that is one of a pair.
fn dominant(matrix: &Dense) -> Option<Vec<f64>> {
    let state = leading_state(matrix)?;
    let next = unit(&matrix.times_vector(&state))?;
    (dot(&state, &next).abs() > 1.0 - 1e-9).then_some(state)
}

fn squared_length(x: &[f64]) -> f64 {
    dot(x, x)
}

/// The vector divided by its length; `None` when it has none.
fn unit(x: &[f64]) -> Option<Vec<f64>> {
    let length = squared_length(x).sqrt();
    (length > 0.0 && length.is_finite()).then(|| x.iter().map(|value| value / length).collect())
}
