//! Loops as products of short polynomials, and the same loops as state matrices.

use fspid_lti::{Complex, Matrix, SampledLoop};

/// A quotient of two polynomials of degree 1 or 2 in ζ = z − 1, lowest power first; the denominator's leading
/// coefficient is 1, the numerator's coefficient of the same power 0 or 1.
#[derive(Debug, Clone)]
pub(crate) struct FactorSection {
    pub(crate) numerator: [f64; 3],
    pub(crate) denominator: [f64; 3],
    pub(crate) order: usize,
}

/// A product of sections with a gain and a dead time of whole samples.
#[derive(Debug, Clone)]
pub(crate) struct Factored {
    pub(crate) sections: Vec<FactorSection>,
    pub(crate) gain: f64,
    pub(crate) delay: usize,
    pub(crate) dt_s: f64,
}

/// Numerator and denominator at a place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Value {
    pub(crate) over: Complex,
    pub(crate) under: Complex,
}

/// ζ on the unit circle.
pub(crate) fn zeta(angle_rad: f64) -> Complex {
    let (sin, cos) = libm::sincos(0.5 * angle_rad);
    Complex::new(-2.0 * sin * sin, 2.0 * sin * cos)
}

impl FactorSection {
    /// The last coefficient of the denominator before the leading one stands in the matrix as its distance from 1;
    /// rounded so that the matrix holds it exactly.
    pub(crate) fn new(numerator: [f64; 3], mut denominator: [f64; 3], order: usize) -> Self {
        let damping = &mut denominator[order - 1];
        *damping = 1.0 - (1.0 - *damping);
        Self { numerator, denominator, order }
    }

    fn at(&self, zeta: Complex) -> Value {
        let horner = |p: &[f64; 3]| (zeta * p[2] + p[1]) * zeta + p[0];
        Value { over: horner(&self.numerator), under: horner(&self.denominator) }
    }
}

impl Factored {
    pub(crate) fn at(&self, zeta: Complex) -> Value {
        let mut value = Value { over: Complex::new(self.gain, 0.0), under: Complex::new(1.0, 0.0) };
        for section in &self.sections {
            let own = section.at(zeta);
            value = Value { over: value.over * own.over, under: value.under * own.under };
        }
        for _ in 0..self.delay {
            value.under *= zeta + 1.0;
        }
        value
    }

    pub(crate) fn at_angle(&self, angle_rad: f64) -> Value {
        self.at(zeta(angle_rad))
    }

    /// The sections and the dead time one after another, the gain at the output.
    pub(crate) fn realised(&self) -> SampledLoop {
        let (rows, input, c) = self.parts();
        let a = Matrix::from_rows(&rows).expect("finite entries");
        SampledLoop::new(a, input, c, self.dt_s).expect("a well formed loop")
    }

    /// The same as rows of the state matrix, input and output.
    pub(crate) fn parts(&self) -> (Vec<Vec<f64>>, Vec<f64>, Vec<f64>) {
        let mut chain = Chain::default();
        for section in &self.sections {
            chain.append(section);
        }
        for _ in 0..self.delay {
            // z⁻¹ = 1/(1 + ζ).
            chain.append(&FactorSection {
                numerator: [1.0, 0.0, 0.0],
                denominator: [1.0, 1.0, 0.0],
                order: 1,
            });
        }
        let c = chain.output.iter().map(|value| self.gain * value).collect();
        (chain.rows_square(), chain.input, c)
    }
}

/// A state-space system that grows by sections in series.
#[derive(Default)]
struct Chain {
    rows: Vec<Vec<f64>>,
    input: Vec<f64>,
    output: Vec<f64>,
    through: Option<f64>,
}

impl Chain {
    fn append(&mut self, section: &FactorSection) {
        let (n, d, order) = (&section.numerator, &section.denominator, section.order);
        let through = self.through.unwrap_or(1.0);
        for row in 0..order {
            // Phase variables: only the last one hears the input.
            let last = row + 1 == order;
            let mut entries: Vec<f64> =
                self.output.iter().map(|value| if last { *value } else { 0.0 }).collect();
            entries.extend((0..order).map(|column| {
                let own = if row == column { 1.0 } else { 0.0 };
                let next = if column == row + 1 { 1.0 } else { 0.0 };
                own + next - if last { d[column] } else { 0.0 }
            }));
            self.rows.push(entries);
            self.input.push(if last { through } else { 0.0 });
        }
        let lead = n[order];
        let output = self.output.iter().map(|value| lead * value);
        self.output = output.chain((0..order).map(|column| n[column] - lead * d[column])).collect();
        self.through = Some(through * lead);
    }

    fn rows_square(&self) -> Vec<Vec<f64>> {
        let order = self.rows.len();
        let padded = self.rows.iter().map(|row| {
            let mut row = row.clone();
            row.resize(order, 0.0);
            row
        });
        padded.collect()
    }
}
