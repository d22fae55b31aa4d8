//! Margins of sampled loops against numbers computed independently.

use fspid_lti::{
    LtiError, Matrix, SampledLoop, SampledMargins, Stability, TransferFunction, zero_order_hold,
};

type Outcome = Result<(), LtiError>;

const RAD_DEG: f64 = 180.0 / core::f64::consts::PI;

/// A continuous system, held and sampled, after a delay of whole samples.
fn sampled(
    system: &TransferFunction,
    dt_s: f64,
    delay_samples: usize,
) -> Result<SampledLoop, LtiError> {
    let model = system.to_state_space();
    let (held, input) = zero_order_hold(model.a(), model.b(), dt_s)?;
    let (states, order) = (model.states(), model.states() + delay_samples);
    let mut a = Matrix::zeros(order, order);
    let (mut b, mut c) = (vec![0.0; order], vec![0.0; order]);
    for row in 0..states {
        for column in 0..states {
            a.set(row, column, held.get(row, column).expect("inside"))?;
        }
        c[row] = model.c().get(0, row).expect("inside");
        let entry = input.get(row, 0).expect("inside");
        if delay_samples == 0 { b[row] = entry } else { a.set(row, states, entry)? }
    }
    for row in states..order.saturating_sub(1) {
        a.set(row, row + 1, 1.0)?;
    }
    if delay_samples > 0 {
        b[order - 1] = 1.0;
    }
    SampledLoop::new(a, b, c, dt_s)
}

fn stable(open: &SampledLoop) -> Result<Box<SampledMargins>, LtiError> {
    match open.margins()? {
        Stability::Stable(margins) => Ok(margins),
        Stability::Unstable { spectral_radius, .. } => {
            Err(LtiError::UnstableLoop { spectral_radius })
        }
    }
}

#[test]
fn a_sampled_plant_has_the_margins_of_the_documentation() -> Outcome {
    let open = sampled(&TransferFunction::new(&[2.0], &[1.0, 3.0, 2.0, 0.0])?, 0.05, 0)?;
    let found = stable(&open)?;
    println!("{found:#?} {}", RAD_DEG * found.phase_margin.unwrap().phase_margin_rad);
    println!("{:?}", open.zeros()?);
    println!("{:?}", open.real_crossings()?);
    println!("{:?}", open.bandwidth_rad_s());
    Ok(())
}
#[test]
fn paper_loop() -> Outcome {
    let plant = TransferFunction::new(
        &[1.69144, 0.84341, 0.0099096],
        &[1.0, 1.17103, 1.55405, 0.012538, 0.0072771],
    )?
    .series(&TransferFunction::new(&[20.0], &[1.0, 10.0])?)?;
    for (dt, delay) in [(1e-4, 0), (0.01, 0), (0.05, 0), (0.05, 1), (0.1, 0), (0.1, 1), (0.01, 20)]
    {
        match sampled(&plant, dt, delay)?.margins()? {
            Stability::Stable(f) => println!(
                "{dt} {delay}: {:.3} {:.3} {:.6} {:?} {}",
                20.0 * f.gain_high.unwrap().factor.log10(),
                RAD_DEG * f.phase_margin.unwrap().phase_margin_rad,
                f.disk.size,
                f.delay_margin_s,
                f.sensitivity_peak.value
            ),
            o => println!("{dt} {delay} {o:?}"),
        }
    }
    Ok(())
}
