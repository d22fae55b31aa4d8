//! Elementary functions on a straight path: without a branch and without a call, so that a loop over lanes becomes vectors.
//!
//! Each has the bits of the function of `libm` with its name wherever `is_straight…` says so, which is wherever flights go;
//! elsewhere (at infinity, at the rounding of multiples of $\pi / 2$, near overflow) the one of `libm` is asked. What flies one
//! by one asks `libm` everywhere: one equation in two forms, compared bit by bit in the tests.
//!
//! # Source
//! `libm`, a translation of FreeBSD's msun, which is FDLIBM:
//!
//! Copyright (C) 1993 and 2004 by Sun Microsystems, Inc. All rights reserved. Permission to use, copy, modify, and distribute this
//! software is freely granted, provided that this notice is preserved.

#![allow(
    clippy::excessive_precision,
    clippy::approx_constant,
    reason = "coefficients as their source prints them"
)]
#![allow(clippy::float_cmp, reason = "quarters of a turn are counted in whole numbers")]

/// The high word of a number's bits.
const HIGH: u64 = 0xFFFF_FFFF_0000_0000;
/// 2^52: a whole number added to it stands in its low bits.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// 1.5 · 2^52, for whole numbers of both signs.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// True where [`atan2`] has the bits of `libm`.
#[inline(always)]
#[must_use]
pub fn is_straight_atan2(y: f64, x: f64) -> bool {
    // 2^60; NaN is not straight.
    (y / x).abs() < 1_152_921_504_606_846_976.0
}

/// The angle of the point (x, y), rad.
#[inline(always)]
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    const PI: f64 = 3.141_592_653_589_793_115_997_963_468_54;
    const PI_LOW: f64 = 1.224_646_799_147_353_177_2e-16;
    let right = atan_of_size((y / x).abs());
    let angle = if x < 0.0 { PI - (right - PI_LOW) } else { right };
    angle.copysign(y)
}

/// The arc tangent of a number that is not negative.
#[inline(always)]
fn atan_of_size(t: f64) -> f64 {
    const AT: [f64; 11] = [
        3.333_333_333_333_293_180_27e-01,
        -1.999_999_999_987_648_324_76e-01,
        1.428_571_427_250_346_637_11e-01,
        -1.111_111_040_546_235_578_80e-01,
        9.090_887_133_436_506_561_96e-02,
        -7.691_876_205_044_829_994_95e-02,
        6.661_073_137_387_531_206_69e-02,
        -5.833_570_133_790_573_486_45e-02,
        4.976_877_994_615_932_360_17e-02,
        -3.653_157_274_421_691_552_70e-02,
        1.628_582_011_536_578_236_23e-02,
    ];
    // Of each interval: what is divided by what, and the angle in its middle, in two parts.
    let mut part = [-1.0, t, 1.570_796_326_794_896_558_00e+00, 6.123_233_995_736_766_035_87e-17];
    let mut within = |below: f64, other: [f64; 4]| {
        let take = t < below;
        for (value, other) in part.iter_mut().zip(other) {
            *value = if take { other } else { *value };
        }
    };
    let (a, b, c) = (t - 1.5, 1.0 + 1.5 * t, 9.827_937_232_473_290_540_82e-01);
    within(2.4375, [a, b, c, 1.390_331_103_123_099_845_16e-17]);
    let (a, b, c) = (t - 1.0, t + 1.0, 7.853_981_633_974_482_789_99e-01);
    within(1.1875, [a, b, c, 3.061_616_997_868_383_017_93e-17]);
    let (a, b, c) = (2.0 * t - 1.0, 2.0 + t, 4.636_476_090_008_060_935_15e-01);
    within(0.6875, [a, b, c, 2.269_877_745_296_168_709_24e-17]);
    within(0.4375, [t, 1.0, 0.0, 0.0]);
    let [above, below, high, low] = part;
    let x = above / below;
    let z = x * x;
    let w = z * z;
    let s1 = z * (AT[0] + w * (AT[2] + w * (AT[4] + w * (AT[6] + w * (AT[8] + w * AT[10])))));
    let s2 = w * (AT[1] + w * (AT[3] + w * (AT[5] + w * (AT[7] + w * AT[9]))));
    high - (x * (s1 + s2) - low - x)
}

/// True where [`sin_cos`] has the bits of `libm`: up to 45 degrees, but not at 0, whose sign it would lose.
#[inline(always)]
#[must_use]
pub fn is_straight_sin_cos(angle_rad: f64) -> bool {
    let size = angle_rad.abs();
    size > 0.0 && size < f64::from_bits(0x3FE9_21FC_0000_0000)
}

/// Sine and cosine of an angle within an eighth of a turn.
#[inline(always)]
#[must_use]
pub fn sin_cos(angle_rad: f64) -> (f64, f64) {
    let (x, z) = (angle_rad, angle_rad * angle_rad);
    let v = z * x;
    (x + v * (S[0] + z * sine_rest(z)), cosine(x, 0.0))
}

const S: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-01,
    8.333_333_333_322_489_461_24e-03,
    -1.984_126_982_985_794_931_34e-04,
    2.755_731_370_707_006_767_89e-06,
    -2.505_076_025_340_686_341_95e-08,
    1.589_690_995_211_550_102_21e-10,
];

#[inline(always)]
fn sine_rest(z: f64) -> f64 {
    let w = z * z;
    S[1] + z * (S[2] + z * S[3]) + z * w * (S[4] + z * S[5])
}

/// Sine of `x + y`, where y is what x leaves out.
#[inline(always)]
fn sine(x: f64, y: f64) -> f64 {
    let z = x * x;
    let (r, v) = (sine_rest(z), z * x);
    x - ((z * (0.5 * y - v * r) - y) - v * S[0])
}

/// Cosine of `x + y`, where y is what x leaves out.
#[inline(always)]
fn cosine(x: f64, y: f64) -> f64 {
    const C: [f64; 6] = [
        4.166_666_666_666_660_190_37e-02,
        -1.388_888_888_887_410_957_49e-03,
        2.480_158_728_947_672_941_78e-05,
        -2.755_731_435_139_066_330_35e-07,
        2.087_572_321_298_174_827_90e-09,
        -1.135_964_755_778_819_482_65e-11,
    ];
    let z = x * x;
    let w = z * z;
    let r = z * (C[0] + z * (C[1] + z * C[2])) + w * w * (C[3] + z * (C[4] + z * C[5]));
    let hz = 0.5 * z;
    let w = 1.0 - hz;
    w + (((1.0 - w) - hz) + (z * r - x * y))
}

/// True where [`cos_of_turn`] has the bits of `libm`: from 0 to 9/8 of a turn, but near a multiple of a quarter.
#[inline(always)]
#[must_use]
pub fn is_straight_cos_of_turn(angle_rad: f64) -> bool {
    let high = angle_rad.to_bits() >> 32;
    let at = |word: u64| high == word;
    let at_quarter = at(0x3FF9_21FB) | at(0x4009_21FB) | at(0x4012_D97C) | at(0x4019_21FB);
    !at_quarter & (angle_rad >= 0.0) & (high <= 0x401C_463B)
}

/// Cosine of an angle from 0 to 9/8 of a turn.
#[inline(always)]
#[must_use]
pub fn cos_of_turn(angle_rad: f64) -> f64 {
    const QUARTER: f64 = 1.570_796_326_734_125_614_17e+00;
    const QUARTER_LOW: f64 = 6.077_100_506_506_192_249_32e-11;
    let high = angle_rad.to_bits() >> 32;
    let beyond = |word: u64| if high > word { 1.0 } else { 0.0 };
    let quarters =
        beyond(0x3FE9_21FB) + beyond(0x4002_D97C) + beyond(0x400F_6A7A) + beyond(0x4015_FDBC);
    let z = angle_rad - quarters * QUARTER;
    let low = quarters * QUARTER_LOW;
    let x = z - low;
    let y = (z - x) - low;
    let (s, c) = (sine(x, y), cosine(x, y));
    let even = if quarters == 2.0 { -c } else { c };
    let odd = if quarters == 1.0 { -s } else { s };
    if (quarters == 1.0) | (quarters == 3.0) { odd } else { even }
}

/// $\ln x$ of a normal positive number, everywhere with the bits of `libm`.
#[inline(always)]
#[must_use]
pub fn ln_of_normal(x: f64) -> f64 {
    const LG: [f64; 7] = [
        6.666_666_666_666_735_130e-01,
        3.999_999_999_940_941_908e-01,
        2.857_142_874_366_239_149e-01,
        2.222_219_843_214_978_396e-01,
        1.818_357_216_161_805_012e-01,
        1.531_383_769_920_937_332e-01,
        1.479_819_860_511_658_591e-01,
    ];
    const LN2_HIGH: f64 = 6.931_471_803_691_238_164_90e-01;
    const LN2_LOW: f64 = 1.908_214_929_270_587_700_02e-10;
    let shifted = x.to_bits().wrapping_add((0x3FF0_0000 - 0x3FE6_A09E) << 32);
    let k = f64::from_bits(TWO_52.to_bits() | (shifted >> 52)) - TWO_52 - 1023.0;
    let part = (shifted & 0x000F_FFFF_FFFF_FFFF).wrapping_add(0x3FE6_A09E << 32);
    let f = f64::from_bits(part) - 1.0;
    let hfsq = 0.5 * f * f;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let t1 = w * (LG[1] + w * (LG[3] + w * LG[5]));
    let t2 = z * (LG[0] + w * (LG[2] + w * (LG[4] + w * LG[6])));
    let r = t2 + t1;
    s * (hfsq + r) + k * LN2_LOW - hfsq + f + k * LN2_HIGH
}

/// True where [`pow`] has the bits of `libm`, for powers that are no multiple of a half and within ±100: of numbers from a
/// hundredth to a hundred, where no answer is near overflow.
#[inline(always)]
#[must_use]
pub fn is_straight_pow(x: f64) -> bool {
    (x > 0.01) & (x < 100.0)
}

/// $x^p$.
#[inline(always)]
#[must_use]
pub fn pow(x: f64, power: f64) -> f64 {
    let [t1, t2] = log2_in_two(x);
    let high = cut(power);
    let p_l = (power - high) * t1 + power * t2;
    power_of_two([high * t1, p_l])
}

/// A number without the low word of its bits.
#[inline(always)]
fn cut(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & HIGH)
}

/// $\log_2 x$ in two parts.
#[inline(always)]
fn log2_in_two(x: f64) -> [f64; 2] {
    const L: [f64; 6] = [
        5.999_999_999_999_946_487_25e-01,
        4.285_714_285_785_501_842_52e-01,
        3.333_333_298_183_774_329_18e-01,
        2.727_281_238_085_340_064_89e-01,
        2.306_607_457_755_617_540_67e-01,
        2.069_750_178_003_384_177_84e-01,
    ];
    const CP: f64 = 9.617_966_939_259_755_543_29e-01;
    const CP_HIGH: f64 = 9.617_967_009_544_372_558_59e-01;
    const CP_LOW: f64 = -7.028_461_650_952_758_265_16e-09;
    const DP_HIGH: f64 = 5.849_624_872_207_641_601_56e-01;
    const DP_LOW: f64 = 1.350_039_202_129_748_971_28e-08;
    let bits = x.to_bits();
    let mantissa = bits & 0x000F_FFFF_FFFF_FFFF;
    // Around 1, around 1.5, around 2.
    let middle = (mantissa > 0x0003_988E_FFFF_FFFF) & (mantissa < 0x000B_B67A << 32);
    let upper = mantissa >= 0x000B_B67A << 32;
    let (centre, dp_h, dp_l) = if middle { (1.5, DP_HIGH, DP_LOW) } else { (1.0, 0.0, 0.0) };
    let exponent = f64::from_bits(TWO_52.to_bits() | (bits >> 52)) - TWO_52 - 1023.0;
    let n = exponent + if upper { 1.0 } else { 0.0 };
    let one: u64 = if upper { 0x3FE0_0000 << 32 } else { 0x3FF0_0000 << 32 };
    let ax = f64::from_bits(mantissa | one);

    let u = ax - centre;
    let v = 1.0 / (ax + centre);
    let ss = u * v;
    let s_h = cut(ss);
    let half = ((ax.to_bits() >> 33) | 0x2000_0000) + 0x0008_0000;
    let t_h = f64::from_bits((half + if middle { 1 << 18 } else { 0 }) << 32);
    let t_l = ax - (t_h - centre);
    let s_l = v * ((u - s_h * t_h) - s_h * t_l);
    let s2 = ss * ss;
    let mut r =
        s2 * s2 * (L[0] + s2 * (L[1] + s2 * (L[2] + s2 * (L[3] + s2 * (L[4] + s2 * L[5])))));
    r += s_l * (s_h + ss);
    let s2 = s_h * s_h;
    let t_h = cut(3.0 + s2 + r);
    let t_l = r - ((t_h - 3.0) - s2);
    let u = s_h * t_h;
    let v = s_l * t_h + t_l * ss;
    let p_h = cut(u + v);
    let p_l = v - (p_h - u);
    let z_h = CP_HIGH * p_h;
    let z_l = CP_LOW * p_h + p_l * CP + dp_l;
    let t1 = cut(((z_h + z_l) + dp_h) + n);
    [t1, z_l - (((t1 - n) - dp_h) - z_h)]
}

/// $2^{h + l}$.
#[inline(always)]
fn power_of_two([mut p_h, p_l]: [f64; 2]) -> f64 {
    const P: [f64; 5] = [
        1.666_666_666_666_660_190_37e-01,
        -2.777_777_777_701_559_338_42e-03,
        6.613_756_321_437_934_361_17e-05,
        -1.653_390_220_546_525_153_90e-06,
        4.138_136_797_057_238_460_39e-08,
    ];
    const LG2: f64 = 6.931_471_805_599_452_862_27e-01;
    const LG2_HIGH: f64 = 6.931_471_824_645_996_093_75e-01;
    const LG2_LOW: f64 = -1.904_654_299_957_768_045_25e-09;
    let sum = p_l + p_h;
    // The nearest whole number, of the high word alone.
    let size = cut(sum).abs();
    let raised = size + 0.5;
    let nearest = (raised + TWO_52) - TWO_52;
    let below = if nearest > raised { nearest - 1.0 } else { nearest };
    let n = (if size > 0.5 { below } else { 0.0 }).copysign(sum);
    p_h -= n;
    let t = cut(p_l + p_h);
    let u = t * LG2_HIGH;
    let v = (p_l - (t - p_h)) * LG2 + t * LG2_LOW;
    let z = u + v;
    let w = v - (z - u);
    let t = z * z;
    let t1 = z - t * (P[0] + t * (P[1] + t * (P[2] + t * (P[3] + t * P[4]))));
    let r = (z * t1) / (t1 - 2.0) - (w + z * w);
    let answer = 1.0 - (r - z);
    f64::from_bits(answer.to_bits().wrapping_add((n + ROUND).to_bits() << 52))
}

/// True where the root of [`hypot_squared`] has the bits of `libm`.
#[inline(always)]
#[must_use]
pub fn is_straight_hypot(x: f64, y: f64) -> bool {
    let (x, y) = (x.abs(), y.abs());
    let (more, less) = if x < y { (y, x) } else { (x, y) };
    (more < 1e150) & (less > 1e-130) & (more < less * 1e18)
}

/// $x^2 + y^2$ as the length of (x, y) is the root of.
#[inline(always)]
#[must_use]
pub fn hypot_squared(x: f64, y: f64) -> f64 {
    let (x, y) = (x.abs(), y.abs());
    let (more, less) = if x < y { (y, x) } else { (x, y) };
    let square = |x: f64| {
        let split = x * 134_217_729.0;
        let high = x - split + split;
        let low = x - high;
        let rounded = x * x;
        (rounded, high * high - rounded + 2.0 * high * low + low * low)
    };
    let ((hx, lx), (hy, ly)) = (square(more), square(less));
    ly + lx + hy + hx
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that depend on a seed alone: the generator of Steele, Lea and Flood (2014).
    struct Random(u64);

    impl Random {
        fn bits(&mut self) -> u64 {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        }

        fn between(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// Of every size, and half the time of one that flights have.
        fn any(&mut self) -> f64 {
            let bits = self.bits();
            if bits & 1 == 0 { f64::from_bits(bits) } else { self.between(-300.0, 300.0) }
        }
    }

    const DRAWS: usize = 400_000;

    fn same(what: &str, inputs: [f64; 2], [straight, known]: [f64; 2]) {
        assert_eq!(straight.to_bits(), known.to_bits(), "{what} of {inputs:?}");
    }

    /// What draws do not hit.
    const EDGES: [f64; 24] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.4375,
        0.6875,
        1.1875,
        2.4375,
        0.5,
        1.5,
        2.0,
        1e-9,
        -1e-9,
        1e-310,
        1e18,
        -1e300,
        1e300,
        3.0,
        -0.25,
        7.5e-9,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MIN_POSITIVE,
    ];

    fn pairs(random: &mut Random) -> impl Iterator<Item = [f64; 2]> {
        let drawn = (0..DRAWS).map(|_| [random.any(), random.any()]);
        let near = EDGES.iter().flat_map(|&a| EDGES.iter().map(move |&b| [a, b]));
        drawn.chain(near)
    }

    #[test]
    fn angles_and_lengths_have_the_bits_of_libm_wherever_they_are_straight() {
        let mut straight = [0; 2];
        for [y, x] in pairs(&mut Random(1)) {
            if is_straight_atan2(y, x) {
                straight[0] += 1;
                same("atan2", [y, x], [atan2(y, x), libm::atan2(y, x)]);
            }
            if is_straight_hypot(x, y) {
                straight[1] += 1;
                let length = libm::sqrt(hypot_squared(x, y));
                same("hypot", [x, y], [length, libm::hypot(x, y)]);
            }
        }
        assert!(straight.iter().all(|&count| count > DRAWS / 5), "{straight:?}");
    }

    #[test]
    fn sine_and_cosine_have_the_bits_of_libm_wherever_they_are_straight() {
        let mut random = Random(2);
        for draw in 0..DRAWS {
            let size = if draw % 2 == 0 { 0.8 } else { 1e-7 };
            let x = random.between(-size, size);
            if is_straight_sin_cos(x) {
                let ((s, c), (sine, cosine)) = (sin_cos(x), libm::sincos(x));
                same("sine", [x, x], [s, sine]);
                same("cosine", [x, x], [c, cosine]);
            }
        }
        let ends = [0.785_398_163_397_448, 0.785_398_4, 1e-9, 7e-9, 1.1e-8, -0.5, 1e-310];
        for x in ends.into_iter().filter(|&x| is_straight_sin_cos(x)) {
            same("sine", [x, x], [sin_cos(x).0, libm::sincos(x).0]);
            same("cosine", [x, x], [sin_cos(x).1, libm::sincos(x).1]);
        }
        assert!(!is_straight_sin_cos(0.0) && !is_straight_sin_cos(0.8));
    }

    #[test]
    fn what_noise_is_made_of_has_the_bits_of_libm() {
        let mut random = Random(3);
        let mut straight = 0;
        for _ in 0..DRAWS {
            let (x, share) = (
                random.between(0.0, 1.0) + 1.0 / 9_007_199_254_740_992.0,
                random.between(0.0, 1.0),
            );
            same("logarithm", [x, x], [ln_of_normal(x), libm::log(x)]);
            let angle = core::f64::consts::TAU * share;
            if is_straight_cos_of_turn(angle) {
                straight += 1;
                same("cosine", [angle, share], [cos_of_turn(angle), libm::cos(angle)]);
            }
        }
        assert!(straight > DRAWS - 20, "{straight}");
        // On both sides of where the path bends: eighths of a turn.
        for eighth in 0..=8_u32 {
            let at = f64::from(eighth) * core::f64::consts::FRAC_PI_4;
            for step in -3000..=3000_i64 {
                let angle =
                    f64::from_bits((at.to_bits() as i64 + step * 700_001_003).max(0) as u64);
                if is_straight_cos_of_turn(angle) {
                    same("cosine", [angle, at], [cos_of_turn(angle), libm::cos(angle)]);
                }
            }
        }
        for x in
            [1.0, 0.5, 2.0, 1.0 / 9_007_199_254_740_992.0, 0.999_999_999, 1.414_213_562_373_095]
        {
            same("logarithm", [x, x], [ln_of_normal(x), libm::log(x)]);
        }
    }

    #[test]
    fn powers_have_the_bits_of_libm_wherever_they_are_straight() {
        let mut random = Random(4);
        let mut straight = 0;
        for draw in 0..DRAWS {
            let x =
                if draw % 4 == 0 { random.between(0.0, 100.0) } else { random.between(0.6, 1.6) };
            let power = match draw % 3 {
                0 => 9.806_65 / 287.052_87 / 0.0065,
                1 => random.between(-7.0, 7.0),
                _ => random.between(-100.0, 100.0),
            };
            if is_straight_pow(x) {
                straight += 1;
                same("power", [x, power], [pow(x, power), libm::pow(x, power)]);
            }
        }
        assert!(straight > DRAWS / 2, "{straight}");
        same("power", [1.0, 5.2], [pow(1.0, 5.2), libm::pow(1.0, 5.2)]);
    }
}
