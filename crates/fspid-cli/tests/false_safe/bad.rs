//! Loops that are bad by construction: that they are is known from closed forms, and from nothing that judges them.

use std::f64::consts::PI;

/// A loop that nobody may call good.
pub(crate) struct Bad {
    /// Why it is bad.
    pub(crate) family: &'static str,
    /// The scenario.
    pub(crate) text: String,
    /// Whether it is bad at rest; otherwise only its flight is.
    pub(crate) at_rest: bool,
}

/// Numbers of a counter: splitmix64.
pub(crate) struct Drawn(pub(crate) u64);

impl Drawn {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }

    pub(crate) fn below(&mut self, count: u64) -> u64 {
        self.bits() % count
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between two powers of ten.
    fn size(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, low + (high - low) * self.unit())
    }

    fn one_of<'a>(&mut self, values: &[&'a str]) -> &'a str {
        values[self.below(values.len() as u64) as usize]
    }
}

/// Everything that is bad.
pub(crate) const FAMILIES: [fn(&mut Drawn) -> Bad; 9] = [
    late_integrator,
    late_sensor,
    slow_growth,
    cancelled,
    integral_of_the_wrong_sign,
    plant_of_the_wrong_sign,
    self_tuner_without_integral,
    held_command,
    ground,
];

/// The ground takes a nonlinear flight of seconds: one in so many draws.
const GROUND_EVERY: u64 = 200;

pub(crate) fn any(drawn: &mut Drawn) -> Bad {
    if drawn.below(GROUND_EVERY) == 0 {
        return ground(drawn);
    }
    FAMILIES[drawn.below(FAMILIES.len() as u64 - 1) as usize](drawn)
}

/// What limits at the controller and the servo do at rest: nothing.
fn limits(drawn: &mut Drawn) -> String {
    let mut lines = String::new();
    let limit = drawn.size(-1.0, 1.5);
    if drawn.below(3) == 0 {
        lines += &format!("output_limits_deg = [-{limit:?}, {limit:?}]\n");
    }
    if drawn.below(3) == 0 {
        lines += &format!("slew_limit_deg_s = {limit:?}\n");
    }
    if drawn.below(3) == 0 {
        lines += &format!("integral = {:?}\n", drawn.one_of(&["bumpless", "literal"]));
    }
    lines
}

struct Loop {
    plant: String,
    actuator: String,
    dt_s: f64,
    controller: String,
}

impl Loop {
    fn bad(self, family: &'static str) -> Bad {
        let Self { plant, actuator, dt_s, controller } = self;
        let duration_s = 40.0 * dt_s;
        let text = format!(
            "schema = 1\nname = \"{family}\"\n[plant]\n{plant}{actuator}[loop]\nsample_period_s = {dt_s:?}\nduration_s = {duration_s:?}\n[setpoint]\nkind = \"step\"\namplitude_deg = 1.0\n[[controller]]\nname = \"C\"\n{controller}[[requirement]]\nmeasure = \"stable\"\n"
        );
        Bad { family, text, at_rest: true }
    }
}

fn plant(numerator: &[f64], denominator: &[f64]) -> String {
    format!(
        "numerator = {numerator:?}\ndenominator = {denominator:?}\nelevator_sign = \"nose-up-positive\"\n"
    )
}

fn pid(drawn: &mut Drawn, [kp, ki, kd]: [f64; 3]) -> String {
    let limits = limits(drawn);
    format!("kind = \"pid\"\nkp = {kp:?}\nki = {ki:?}\nkd = {kd:?}\n{limits}")
}

/// By how much a loop is beyond its limit: by a hair, or by far. Less than that moves a pole by less than 10⁻⁹, which
/// nobody calls anything.
fn beyond(drawn: &mut Drawn) -> f64 {
    drawn.size(-5.0, 0.5)
}

/// How many samples a loop is late; few of them take a matrix of hundreds of states, or are too many for one.
fn samples(drawn: &mut Drawn) -> u64 {
    match drawn.below(400) {
        0 => 401 + drawn.below(4000),
        1..=3 => drawn.below(120),
        _ => drawn.below(20),
    }
}

/// $\theta_{k+1} = \theta_k - g \theta_{k-n}$ is stable below $g = 2 \sin (\pi / (4 n + 2))$ and unstable above, as it is
/// below 0 (S. A. Levin, R. M. May, Theoretical Population Biology 9 (1976) 178).
fn too_much_gain(drawn: &mut Drawn, samples: u64) -> f64 {
    let limit = 2.0 * libm::sin(PI / (4.0 * samples as f64 + 2.0));
    match drawn.below(5) {
        0 => -limit * drawn.size(-4.0, 0.0),
        _ => limit * (1.0 + beyond(drawn)),
    }
}

fn late_integrator(drawn: &mut Drawn) -> Bad {
    let (dt_s, samples) = (drawn.size(-3.0, -0.5), samples(drawn));
    let kp = too_much_gain(drawn, samples) / dt_s;
    let controller = pid(drawn, [kp, 0.0, 0.0]);
    let actuator = format!("[actuator]\ndelay_samples = {samples}\n");
    Loop { plant: plant(&[1.0], &[1.0, 0.0]), actuator, dt_s, controller }.bad("late integrator")
}

/// The same, late in the command and in the sensor, whose scale is off, too.
fn late_sensor(drawn: &mut Drawn) -> Bad {
    let dt_s = 0.01;
    let (command, seen) = (samples(drawn), samples(drawn));
    let scale_error = 0.1 * (drawn.unit() - 0.5);
    let kp = too_much_gain(drawn, command + seen) / (dt_s * (1.0 + scale_error));
    let controller = pid(drawn, [kp, 0.0, 0.0]);
    let delay_s = seen as f64 * dt_s;
    let actuator = format!(
        "[actuator]\ndelay_samples = {command}\n[sensor]\npreset = \"ideal\"\npitch = {{ delay_s = {delay_s:?}, scale_error_pct = {:?} }}\n",
        100.0 * scale_error
    );
    Loop { plant: plant(&[1.0], &[1.0, 0.0]), actuator, dt_s, controller }.bad("late sensor")
}

/// $b / (s - \sigma)$ needs a gain of $\sigma / b$, and gets less: in minutes or in weeks it is lost.
fn too_weak(drawn: &mut Drawn) -> (f64, f64, f64) {
    let (sigma, b) = (drawn.size(-4.0, 0.3), drawn.size(-1.0, 1.0));
    (sigma, b, sigma / b * (1.0 - drawn.size(-3.0, 0.0)))
}

fn slow_growth(drawn: &mut Drawn) -> Bad {
    let (sigma, b, kp) = too_weak(drawn);
    let controller = pid(drawn, [kp, 0.0, 0.0]);
    let (plant, dt_s) = (plant(&[b], &[1.0, -sigma]), drawn.size(-2.5, -1.0));
    Loop { plant, actuator: String::new(), dt_s, controller }.bad("slow growth")
}

/// Coefficients of a product of factors $s + p$, highest power first.
fn product(factors: &[f64]) -> Vec<f64> {
    factors.iter().fold(vec![1.0], |product, p| {
        let mut longer = vec![0.0; product.len() + 1];
        for (place, value) in product.iter().enumerate() {
            longer[place] += value;
            longer[place + 1] += p * value;
        }
        longer
    })
}

/// An unstable pole under a zero: nothing that the controller sees tells of it.
fn cancelled(drawn: &mut Drawn) -> Bad {
    let a = drawn.size(-3.0, -0.3);
    let stable = [drawn.size(-0.5, 0.7), drawn.size(-0.5, 0.7)];
    let plant = plant(&product(&[-a]), &product(&[-a, stable[0], stable[1]]));
    let gains = [drawn.size(-2.0, 0.3), drawn.size(-3.0, 0.0), 0.0];
    let (controller, dt_s) = (pid(drawn, gains), drawn.size(-2.5, -1.0));
    Loop { plant, actuator: String::new(), dt_s, controller }.bad("cancelled")
}

/// Poles of a plant that holds by itself.
fn stable(drawn: &mut Drawn) -> Vec<f64> {
    let factors: Vec<f64> = (0..=drawn.below(3)).map(|_| drawn.size(-1.0, 1.0)).collect();
    product(&factors)
}

/// At z = 1 the characteristic polynomial has the sign of $k_i G(0)$, and far to the right it is above 0: with an
/// integral of the wrong sign there is a pole between, whatever the other gains are.
fn wrong_integral(drawn: &mut Drawn, sign: f64) -> ([f64; 3], String) {
    let gains =
        [drawn.size(-3.0, 0.0) * sign, -drawn.size(-3.0, 0.0), drawn.size(-3.0, -1.0) * sign];
    let servo = match drawn.below(2) {
        0 => String::new(),
        _ => format!("[actuator]\ntime_constant_s = {:?}\n", drawn.size(-1.5, 0.0)),
    };
    (gains, servo)
}

fn integral_of_the_wrong_sign(drawn: &mut Drawn) -> Bad {
    let (gains, actuator) = wrong_integral(drawn, 1.0);
    let (plant, dt_s) = (plant(&[drawn.size(-1.0, 1.0)], &stable(drawn)), drawn.size(-2.5, -1.0));
    let controller = pid(drawn, gains);
    Loop { plant, actuator, dt_s, controller }.bad("integral of the wrong sign")
}

/// The same with good gains, of a plant whose elevator has the other sign.
fn plant_of_the_wrong_sign(drawn: &mut Drawn) -> Bad {
    let ([kp, ki, kd], actuator) = wrong_integral(drawn, 1.0);
    let plant = plant(&[drawn.size(-1.0, 1.0)], &stable(drawn)).replace("nose-up", "nose-down");
    let (controller, dt_s) = (pid(drawn, [kp, -ki, kd]), drawn.size(-2.5, -1.0));
    Loop { plant, actuator, dt_s, controller }.bad("plant of the wrong sign")
}

/// A self-tuner whose largest gain is too small for its plant, and which has no integral.
fn self_tuner_without_integral(drawn: &mut Drawn) -> Bad {
    let (sigma, b, kp) = too_weak(drawn);
    // Rules conclude at most 5.
    let room = (sigma / b - kp) / 5.0;
    let scale = room * 0.9 * drawn.unit();
    let table = drawn.one_of(&["mirrored", "printed"]);
    let (error, change) = (drawn.size(-1.0, 1.0), drawn.size(-1.0, 1.0));
    let controller = format!(
        "kind = \"fspid\"\nnominal = {{ kp = {kp:?}, ki = 0.0, kd = 0.0 }}\nsupervisor = {{ table = \"{table}\", range = 5.0, error_scale = {error:?}, change_scale = {change:?}, output_scale = {{ kp = {scale:?}, ki = 0.0, kd = 0.0 }} }}\n"
    );
    let (plant, dt_s) = (plant(&[b], &[1.0, -sigma]), drawn.size(-2.5, -1.0));
    Loop { plant, actuator: String::new(), dt_s, controller }.bad("self-tuner without integral")
}

/// A self-tuner on $1/s$ whose kp, or whose ki of a literal integral, follows the error, at once or leaking:
/// $\Delta_k = \rho \Delta_{k-1} + \sigma e_k$ with $\sigma$ per rad.
struct Following {
    dt_s: f64,
    kp: f64,
    ki: f64,
    /// What a gain keeps from sample to sample; 0 without memory.
    kept: f64,
}

impl Following {
    fn drawn(drawn: &mut Drawn) -> Self {
        let dt_s = drawn.size(-2.5, -1.0);
        let kp = drawn.size(-0.5, 0.5);
        let kept = [0.0, drawn.unit()][drawn.below(3).min(1) as usize];
        Self { dt_s, kp, ki: kp * kp * drawn.size(-2.0, -0.5), kept }
    }

    /// The least $G$ that makes the loop grow. A held part H of the command, $(b - 1) r$ of the proportional term or the sum
    /// $T \sum e$ that carries a load, moves with its gain: with $G = -\sigma H$ small motions have
    ///
    /// $(z - 1)^2 (z - \rho) + T (k_p (z - 1)(z - \rho) + k_i T z (z - \rho) - G z (z - 1)) = 0,$
    ///
    /// $z^3 + a_2 z^2 + a_1 z + a_0$ with $a_2 = c_2 - T G$ and $a_1 = c_1 + T G$, and a cubic whose roots are all within the
    /// unit circle has $|a_1 - a_0 a_2| < 1 - a_0^2$ (E. I. Jury, J. Blanchard, Proc. IRE 49 (1961) 1947).
    fn limit(&self) -> f64 {
        let Self { dt_s, kp, ki, kept } = *self;
        let [proportional, integral] = [kp * dt_s, ki * dt_s * dt_s];
        let c2 = proportional + integral - 2.0 - kept;
        let c1 = 1.0 + 2.0 * kept - proportional * (1.0 + kept) - integral * kept;
        let a0 = kept * (proportional - 1.0);
        (1.0 - a0 * a0 - c1 + a0 * c2) / (dt_s * (1.0 + a0))
    }

    /// The loop at this share of the limit.
    fn at(&self, share: f64, drawn: &mut Drawn) -> Bad {
        let Self { dt_s, kp, ki, kept } = *self;
        let held_deg = drawn.size(-0.3, 1.0);
        let literal = drawn.below(2) == 1;
        let per_deg = share * self.limit() / held_deg;
        // Under a load d the sum is -d / ki.
        let [of_kp, of_ki] = if literal { [0.0, per_deg * ki] } else { [per_deg, 0.0] };
        let (law, per_sample) = match kept == 0.0 {
            true => ("law = \"memoryless\"\n".to_owned(), 1.0),
            false => (
                format!("law = \"accumulating\"\nleakage_per_s = {:?}\n", (1.0 - kept) / dt_s),
                dt_s,
            ),
        };
        let held = match literal {
            true => "integral = \"literal\"\n".to_owned(),
            false => format!("setpoint_weights = {{ proportional = 0.0 }}\n{}", limits(drawn)),
        };
        // Rows of numbers from -1 at an error of -5 to 1 at 5.
        let rows = |scale: f64| {
            let row = |i: i32| format!("{:?}", [scale * f64::from(i - 3) / 3.0; 7]);
            format!("[{}]", (0..7).map(row).collect::<Vec<_>>().join(", "))
        };
        let [numbers, still] = [rows(1.0), rows(0.0)];
        let scales = [5.0 * of_kp / per_sample, 5.0 * of_ki / per_sample];
        let controller = format!(
            "kind = \"fspid\"\n{law}nominal = {{ kp = {kp:?}, ki = {ki:?}, kd = 0.0 }}\n{held}supervisor = {{ numbers = {{ delta_kp = {numbers}, delta_ki = {numbers}, delta_kd = {still} }}, range = 5.0, error_scale = 1.0, change_scale = 1.0, output_scale = {{ kp = {:?}, ki = {:?}, kd = 0.0 }} }}\n",
            scales[0], scales[1]
        );
        let plant = plant(&[1.0], &[1.0, 0.0]);
        let mut found =
            Loop { plant, actuator: String::new(), dt_s, controller }.bad("held command");
        let [setpoint, load] = if literal { [0.0, held_deg] } else { [held_deg, 0.0] };
        found.text =
            found.text.replace("amplitude_deg = 1.0", &format!("amplitude_deg = {setpoint:?}"));
        found.text += &format!(
            "[[disturbance]]\nenters_at = \"servo\"\nkind = \"step\"\namplitude_deg = {load:?}\n"
        );
        found
    }
}

fn held_command(drawn: &mut Drawn) -> Bad {
    let beyond = 1.0 + beyond(drawn);
    Following::drawn(drawn).at(beyond, drawn)
}

/// The same within its limit, which holds.
#[cfg(test)]
pub(crate) fn held_command_within(drawn: &mut Drawn) -> Bad {
    let within = 1.0 - drawn.size(-5.0, -0.5);
    Following::drawn(drawn).at(within, drawn)
}

/// An aircraft that is told to descend where there is no room: 10 deg below its path for half a minute from 100 ft.
fn ground(drawn: &mut Drawn) -> Bad {
    let (altitude_ft, pitch_deg) = (20.0 + 80.0 * drawn.unit(), -8.0 - 4.0 * drawn.unit());
    let text = format!(
        "schema = 1\nname = \"ground\"\n[aircraft]\nname = \"navion\"\nairspeed_ft_s = 176.0\naltitude_ft = {altitude_ft:?}\n[actuator]\ntime_constant_s = 0.1\n[loop]\nsample_period_s = 0.02\nduration_s = 30.0\n[setpoint]\nkind = \"step\"\namplitude_deg = {pitch_deg:?}\n[[controller]]\nname = \"C\"\nkind = \"pid\"\nkp = 0.82\nki = 0.43\nkd = 0.165\nderivative_filter_s = 0.05\n"
    );
    Bad { family: "ground", text, at_rest: false }
}
