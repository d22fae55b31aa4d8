//! Bounds of sums and products against exact whole numbers.

use super::*;
use crate::rest::drawn::Dice;

/// The sum of all magnitudes, in order and in whole numbers, which floating point has exactly.
#[test]
fn the_spread_of_a_number_is_at_least_its_parts_and_no_more_than_rounding_above() {
    for count in 0..40_usize {
        let parts = (0..count).map(|at| if at % 3 == 0 { -(at as f64) } else { at as f64 });
        let whole = (0..count).sum::<usize>() as f64;
        let number = Affine { parts: parts.collect(), ..Affine::default() };
        assert_eq!(number.parts.each().len(), count);
        let spread = number.spread();
        assert!(spread >= whole && spread <= whole * (1.0 + 1e-12) + 1e-300, "{count}: {spread}");
        let wider = number.clone().and_noise(0.75, &mut || count + 2);
        let spread = wider.spread();
        assert!(spread >= whole + 0.75 && spread <= (whole + 0.75) * (1.0 + 1e-12), "{count}");
        assert_eq!(wider.parts.of(count + 2).to_bits(), 0.75_f64.to_bits());
    }
}

/// Terms of different length, each of which has unknowns that others have not.
#[test]
fn sums_and_products_hold_what_their_terms_make_of_any_unknowns() {
    let long = Affine { centre: 2.0, parts: vec![0.5, -0.25, 0.125].into(), ..Affine::default() };
    let short = Affine { centre: -1.0, parts: vec![0.25].into(), ..Affine::default() };
    let at = |number: &Affine, unknowns: &[f64; 3]| {
        let parts = number.parts.each().iter().zip(unknowns).map(|(part, it)| part * it);
        number.centre + parts.sum::<f64>()
    };
    let three = Interval::point(3.0);
    for (one, other) in [(&long, &short), (&short, &long)] {
        let sum = Affine::sum([(three, one), (-Interval::ONE, other)]);
        let (product, beside) = one.product(other);
        for corner in 0..8_u8 {
            let unknowns = [0, 1, 2].map(|bit: u8| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 });
            let [x, y] = [one, other].map(|number| at(number, &unknowns));
            assert!((at(&sum, &unknowns) - (3.0 * x - y)).abs() <= sum.off + 1e-15);
            assert!((at(&product, &unknowns) - x * y).abs() <= beside + product.off + 1e-15);
        }
        assert!(sum.off < 1e-14 && beside <= 0.25 * 0.875 + 1e-12, "{sum:?} {beside}");
    }
}

/// Half of the distance of floats beyond 1.
const HALF_A_DIGIT: f64 = 0.5 * f64::EPSILON;

/// A whole number of $2^{-52}$ between -1 and 1.
fn drawn(dice: &mut Dice) -> f64 {
    2.0 * dice.part() - 1.0
}

/// A number in whole $2^{-52}$, for products that are exact.
fn digits(value: f64) -> i128 {
    libm::ldexp(value, 52) as i128
}

/// A number in whole $2^{-104}$, as products of two are, rounded towards zero.
fn units(value: f64) -> i128 {
    libm::ldexp(value, 104) as i128
}

fn from_units(units: i128) -> f64 {
    libm::ldexp(units as f64, -104)
}

fn number(centre: f64, parts: &[f64]) -> Affine {
    Affine { centre, parts: parts.to_vec().into(), ..Affine::default() }
}

fn drawn_number(dice: &mut Dice, parts: usize) -> Affine {
    let centre = drawn(dice);
    Affine { centre, parts: (0..parts).map(|_| drawn(dice)).collect(), ..Affine::default() }
}

/// Centre and parts in whole $2^{-52}$.
fn all_digits(number: &Affine) -> Vec<i128> {
    [number.centre].iter().chain(number.parts.each()).map(|it| digits(*it)).collect()
}

/// How far a number may be from an exact one, centre before parts, when each unknown is at its worse end.
fn error(number: &Affine, exact: &[i128]) -> f64 {
    assert_eq!(number.parts.each().len() + 1, exact.len());
    let found = [number.centre].into_iter().chain(number.parts.each().iter().copied());
    from_units(found.zip(exact).map(|(found, exact)| (units(found) - exact).abs()).sum())
}

fn is_within_its_spread(number: &Affine) -> bool {
    let parts: i128 = number.parts.each().iter().map(|part| units(*part).abs()).sum();
    parts <= units(number.spread()) + i128::from(number.spread() > 0.0)
}

/// Terms with all digits, one after the other or each against one that is nearly its opposite.
#[test]
fn a_sum_holds_the_exact_sum_of_its_terms_rounding_included() {
    for seed in 0..600 {
        let dice = &mut Dice::new(seed);
        let count = 1 + seed as usize % 9;
        let mut terms: Vec<(f64, Affine)> =
            (0..count).map(|at| (drawn(dice), drawn_number(dice, (3 * at + 5) % 13))).collect();
        if seed % 3 == 0 {
            let opposite = |(factor, term): &(f64, Affine)| (f64::EPSILON - factor, term.clone());
            terms.extend(terms.iter().map(opposite).collect::<Vec<_>>());
        }
        let longest = terms.iter().map(|(_, term)| term.parts.each().len()).max();
        let mut exact = vec![0_i128; longest.unwrap() + 1];
        let mut sizes = 0.0;
        for (factor, term) in &terms {
            for (sum, part) in exact.iter_mut().zip(all_digits(term)) {
                *sum += digits(*factor) * part;
            }
            sizes += factor.abs() * (term.centre.abs() + term.spread());
        }
        let sum = Affine::sum(terms.iter().map(|(factor, it)| (Interval::point(*factor), it)));
        let error = error(&sum, &exact);
        assert!(error <= sum.off && is_within_its_spread(&sum), "{seed}: {error:e} {sum:?}");
        // Twice what it may be at the worst.
        let most = (terms.len() as f64 + 2.0) * f64::EPSILON * sizes;
        assert!(sum.off <= most * (1.0 + 1e-12) + 1e-300, "{seed}: {:e} {most:e}", sum.off);
    }
}

/// A large term and many that are lost in it, each half a digit: the worst that a sum can meet.
#[test]
fn a_sum_holds_terms_that_rounding_drops_one_after_the_other() {
    let large = number(1.0, &[0.0, 1.0]);
    for lost in [number(HALF_A_DIGIT, &[]), number(0.0, &[0.0, HALF_A_DIGIT])] {
        for count in 1..300_usize {
            let terms = [&large].into_iter().chain(std::iter::repeat_n(&lost, count));
            let sum = Affine::sum(terms.map(|term| (Interval::ONE, term)));
            assert_eq!(sum.centre.to_bits(), 1.0_f64.to_bits());
            let error = count as f64 * HALF_A_DIGIT;
            assert!(sum.off >= error && sum.off <= 4.0 * error + 16.0 * f64::EPSILON, "{count}");
        }
    }
}

/// What is raised is as much as sums that lose half a digit with each of their terms, and a few times that at most.
#[test]
fn a_raised_sum_is_above_what_rounding_drops_of_its_terms_and_not_far() {
    for terms in 0..500_usize {
        let beyond = (raised(1.0, terms) - 1.0) / HALF_A_DIGIT;
        let most = terms as f64 + 4.0;
        assert!(beyond >= most && beyond <= 4.0 * most + 2.0, "{terms}: {beyond}");
    }
    assert!(raised(0.0, 1) > 0.0 && raised(0.0, 1) < 1e-300);
}

/// Coefficients that are not known, numbers that are off and balls, of whole numbers: all of them together and each alone.
#[test]
fn a_sum_is_off_by_what_its_coefficients_and_terms_are() {
    let sizes = [0.0, 0.25, 3.0];
    let all = || combinations([&sizes[..]; 6]);
    let count = all().count() as u64;
    for (at, [middle, wide, centre, part, off, of_ball]) in all().enumerate() {
        let factor = Interval::between(-middle - wide, wide - middle);
        let parts = Parts::from(vec![0.0, -part]);
        let term = Affine { centre: -centre, parts, off, of_ball };
        let known = middle * off + wide * (centre + part + off);
        let [ball, size] = [(middle + wide) * of_ball, middle * (centre + part)];
        let other = Affine { centre: 0.5, off: 2.0, of_ball: 0.125, ..Affine::default() };
        // An own number of terms each, so that a bound cannot be right by what there are.
        let others = (at as u64 * 7 % count % 3) as usize;
        let terms = std::iter::repeat_n((Interval::ONE, &other), others);
        let sum = Affine::sum([(factor, &term)].into_iter().chain(terms));
        let beside = others as f64;
        let (known, ball) = (known + 2.0 * beside, ball + 0.125 * beside);
        let rounding = (beside + 3.0) * f64::EPSILON * (size + 0.5 * beside);
        let is = |found: f64, exact: f64, more: f64| {
            found >= exact && found <= exact * (1.0 + 1e-13) + 1.01 * more + 1e-300
        };
        assert!(is(sum.off, known, rounding), "{factor:?} {term:?}: {} {known}", sum.off);
        assert!(is(sum.of_ball, ball, 0.0), "{factor:?} {term:?}: {} {ball}", sum.of_ball);
        assert_eq!(sum.of_ball > 0.0, ball > 0.0, "without a ball there is none");
    }
}

/// All choices of one of each.
fn combinations<const N: usize>(of: [&[f64]; N]) -> impl Iterator<Item = [f64; N]> {
    (0..of.iter().map(|it| it.len()).product::<usize>()).map(move |mut at| {
        of.map(|it| {
            let one = it[at % it.len()];
            at /= it.len();
            one
        })
    })
}

/// Balls that are lost in a large one, each half a digit of it, and likewise what terms are off.
#[test]
fn the_own_of_a_sum_holds_what_rounding_drops_and_not_much_more() {
    let ball = |own: f64| Affine { off: own, of_ball: own, ..Affine::default() };
    let (large, lost) = (ball(1.0), ball(HALF_A_DIGIT));
    for count in 1..300_usize {
        let terms = [&large].into_iter().chain(std::iter::repeat_n(&lost, count));
        let sum = Affine::sum(terms.map(|term| (Interval::ONE, term)));
        let lost = count as f64;
        for own in [sum.off, sum.of_ball] {
            let beyond = (own - 1.0) / HALF_A_DIGIT;
            assert!(beyond >= lost && beyond <= 9.0 * lost + 60.0, "{count}: {beyond}");
        }
    }
}

#[test]
fn a_product_holds_the_exact_product_rounding_included() {
    for seed in 0..600 {
        let dice = &mut Dice::new(seed);
        // Centre and parts of either all but zero in turn, so that each rounding is once the only one.
        let size = |place: u64| if seed >> place & 1 == 0 { 1.0 } else { f64::EPSILON };
        let mut scaled = |parts: usize, place: u64| {
            let drawn = drawn_number(dice, parts);
            let parts = drawn.parts.each().iter();
            let parts = parts.map(|it| rounded(it * size(place)));
            Affine {
                centre: rounded(drawn.centre * size(place + 1)),
                parts: parts.collect(),
                ..Affine::default()
            }
        };
        let [one, other] = [scaled(seed as usize % 7, 0), scaled(seed as usize % 5, 2)];
        let (linear, beside) = one.product(&other);
        let [p, q] = [&one, &other].map(all_digits);
        let longest = p.len().max(q.len());
        let at = |of: &[i128], place: usize| of.get(place).copied().unwrap_or(0);
        let exact = |place: usize| match place {
            0 => p[0] * q[0],
            _ => p[0] * at(&q, place) + q[0] * at(&p, place),
        };
        let exact: Vec<i128> = (0..longest).map(exact).collect();
        let error = error(&linear, &exact);
        assert!(error <= linear.off && is_within_its_spread(&linear), "{seed}: {error:e}");
        let [own, theirs] = [one.centre.abs(), other.centre.abs()];
        let sizes = own * theirs + own * other.spread() + theirs * one.spread();
        assert!(linear.off <= 4.1 * f64::EPSILON * sizes + 1e-300, "{seed}: {linear:?} {sizes:e}");
        let magnitudes = |of: &[i128]| of[1..].iter().map(|it| it.abs()).sum::<i128>();
        let left = from_units(magnitudes(&p) * magnitudes(&q));
        assert!(beside >= left && beside <= left * (1.0 + 1e-13) + 1e-300, "{seed}: {beside:e}");
    }
}

/// To whole $2^{-52}$.
fn rounded(value: f64) -> f64 {
    libm::ldexp(digits(value) as f64, -52)
}

/// Whole numbers: all of them together and each alone.
#[test]
fn a_product_is_off_by_what_its_factors_are() {
    let some = &[0.0, 0.25, 3.0][..];
    for [own, of_self, self_off, theirs, of_other, off, of_ball] in combinations([some; 7]) {
        let one = Affine { off: self_off, ..number(-own, &[of_self]) };
        let other = Affine { off, of_ball, ..number(theirs, &[0.0, -of_other]) };
        let (linear, beside) = one.product(&other);
        let most = own + of_self + self_off;
        let exact = most * off + (theirs + of_other) * self_off;
        let sizes = own * theirs + own * of_other + theirs * of_self;
        let is = |found: f64, exact: f64, more: f64| {
            found >= exact && found <= exact * (1.0 + 1e-13) + more + 1e-300
        };
        let named = || format!("{one:?} {other:?} {linear:?} {exact}");
        assert!(is(linear.off, exact, 4.1 * f64::EPSILON * sizes), "{}", named());
        assert!(is(linear.of_ball, most * of_ball, 0.0), "{}", named());
        assert!(is(beside, of_self * of_other, 0.0), "{}", named());
        assert_eq!(linear.of_ball > 0.0, of_ball > 0.0, "without a ball there is none");
    }
}

/// Ends with all digits, some of them neighbours, so that the middle is not theirs.
#[test]
fn an_unknown_reaches_both_of_its_ends_and_not_much_further() {
    for seed in 0..900 {
        let dice = &mut Dice::new(seed);
        let lower = drawn(dice);
        let wide = [f64::EPSILON, 1e-12, 0.5][seed as usize % 3] * dice.part();
        let upper = rounded(lower + f64::EPSILON + wide);
        let scale = libm::ldexp(1.0, [-40, 0, 40][seed as usize / 3 % 3]);
        let found = Affine::unknown([lower * scale, upper * scale], seed as usize % 4);
        let (centre, radius) = (found.centre / scale, found.parts.of(seed as usize % 4) / scale);
        let [least, most] = [units(lower), units(upper)];
        let reach = (units(centre) - least).max(most - units(centre));
        let wide = format!("{seed}: {centre} {radius:e} {:e}", from_units(reach));
        assert!(units(radius) >= reach, "{wide}");
        let allowed = 0.5 * (upper - lower) + 1.1 * f64::EPSILON * lower.abs().max(upper.abs());
        assert!(radius <= allowed * (1.0 + 1e-13), "{wide}");
        assert!(found.off <= 0.0 && found.of_ball <= 0.0);
    }
    let point = Affine::unknown([0.3, 0.3], 2);
    assert!(point.radius() < 1e-300 && point.centre.to_bits() == 0.3_f64.to_bits());
}

/// Neighbours among them: their middle is one of them, a whole digit from the other.
#[test]
fn a_constant_is_off_by_all_of_its_interval() {
    let next = 1.0_f64.next_up();
    for (lower, upper) in [(1.0, next), (-next, -1.0), (next, next.next_up()), (-0.3, 0.7)] {
        let number = Affine::constant(Interval::between(lower, upper));
        let [below, above] = [number.centre - lower, upper - number.centre];
        let reach = below.max(above);
        assert!(number.off >= reach && number.off <= reach * (1.0 + 1e-15), "{lower} {upper}");
        assert!(number.spread() <= 0.0 && number.of_ball <= 0.0);
    }
    assert!(Affine::constant(Interval::point(0.1)).off <= 0.0);
}

#[test]
fn a_radius_counts_parts_and_what_is_off_and_the_ball() {
    for [part, off, of_ball] in combinations([&[0.0, 0.25, 2.0][..]; 3]) {
        let whole = Affine { off, of_ball, ..number(-1.0, &[part]) };
        let exact = part + off + of_ball;
        let is = |found: f64, exact: f64| {
            found >= exact && found <= exact * (1.0 + 1e-13) + f64::EPSILON
        };
        assert!(is(whole.radius(), exact), "{whole:?}");
        assert!(is(whole.magnitude(), 1.0 + exact), "{whole:?}");
        let range = whole.range();
        assert!(is(range.upper() + 1.0, exact) || exact <= 0.0, "{whole:?}: {range:?}");
        assert!(is(-1.0 - range.lower(), exact), "{whole:?}: {range:?}");
        let owned = whole.clone().owned();
        assert!(is(owned.off, off + of_ball) && owned.of_ball <= 0.0, "{owned:?}");
        assert!(is(whole.clone().and_off(0.5).off, off + 0.5));
    }
}

/// A width that the sum with the centre drops.
#[test]
fn a_range_holds_what_is_less_than_a_digit_of_its_middle() {
    for centre in [1.0, -1.0, 1.0_f64.next_up(), 0.75] {
        let range = number(centre, &[0.1 * f64::EPSILON]).range();
        assert!(range.lower() < centre && range.upper() > centre, "{range:?}");
        assert!(range.width() <= 6.0 * f64::EPSILON, "{range:?}");
    }
    // Of a large middle a digit is large, and of a small one small.
    for centre in [1024.0, 1.0 / 1024.0] {
        let range = number(centre, &[0.1 * f64::EPSILON * centre]).range();
        assert!(range.lower() < centre && range.upper() > centre, "{range:?}");
        assert!(range.width() <= 6.0 * f64::EPSILON * centre, "{range:?}");
    }
}

#[test]
fn noise_upon_a_part_holds_what_rounding_drops_of_it() {
    let noise = HALF_A_DIGIT;
    let whole = number(0.0, &[1.0]).and_noise(noise, &mut || 0);
    assert_eq!(whole.parts.of(0).to_bits(), 1.0_f64.to_bits(), "lost");
    assert!(whole.off >= noise && whole.off <= 5.0 * noise, "{}", whole.off);
}

/// In whole numbers.
#[test]
fn numbers_are_added_and_taken_off_and_put_in_place_of_an_unknown() {
    let (one, other) = (number(3.0, &[1.0, -2.0]), number(-1.0, &[0.5, 0.0, 4.0]));
    for (found, centre, parts) in [
        (one.plus(&other), 2.0, [1.5, -2.0, 4.0]),
        (one.less(&other), 4.0, [0.5, -2.0, -4.0]),
        (one.with(1, &other), 5.0, [0.0, 0.0, -8.0]),
        (other.with(1, &one), -1.0, [0.5, 0.0, 4.0]),
        (other.times(Interval::point(-2.0)), 2.0, [-1.0, 0.0, -8.0]),
    ] {
        assert!((found.centre - centre).abs() <= 0.0, "{found:?} {centre}");
        assert!(found.off < 1e-13, "{found:?}");
        for (at, part) in parts.into_iter().enumerate() {
            assert!((found.parts.of(at) - part).abs() <= 0.0, "{found:?} {parts:?}");
        }
    }
}

#[test]
fn noise_is_an_unknown_unless_it_is_next_to_nothing() {
    let mut asked = 0;
    let mut symbol = || {
        asked += 1;
        1
    };
    let nothing = number(1.0, &[0.5]).and_noise(SMALLEST.next_down(), &mut symbol);
    assert!(nothing.off >= SMALLEST.next_down() && nothing.parts.each().len() == 1);
    let least = number(1.0, &[0.5]).and_noise(SMALLEST, &mut symbol);
    assert!(least.parts.of(1) >= SMALLEST && asked == 1, "{asked}");
}

/// Each of a thousand products, of which rounding takes half of the smallest float there is.
#[test]
fn products_that_underflow_are_within_what_rounding_may_be_off() {
    let small = libm::ldexp(1.0, -537);
    let parts = vec![small; 1000];
    let lost = libm::ldexp(1000.0, -1074);
    for off in [
        Affine::sum([(Interval::point(1.5 * small), &number(small, &parts))]).off,
        number(1.5 * small, &[]).product(&number(small, &parts)).0.off,
    ] {
        assert!(off >= lost && off < 1e-300, "{off:e}");
    }
}
