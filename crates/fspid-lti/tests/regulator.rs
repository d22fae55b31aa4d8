//! Optimal feedback for the Navion of Nelson's book, against numbers computed independently.

use fspid_lti::{LtiError, Matrix, eigenvalues, regulator};

/// Angle of attack, pitch rate, pitch; a positive elevator lowers the nose. Rounded derivatives in ft, s.
fn navion() -> Result<(Matrix, Matrix), LtiError> {
    let (u0, z_w, m_w, m_w_rate, m_q) = (176.0, -2.02, -0.05, -0.0051, -2.05);
    let (z_elevator, m_elevator) = (-28.15, -11.874);
    let a = Matrix::from_rows(&[
        [z_w, 1.0, 0.0],
        [u0 * (m_w + m_w_rate * z_w), m_q + u0 * m_w_rate, 0.0],
        [0.0, 1.0, 0.0],
    ])?;
    let b = Matrix::from_rows(&[[z_elevator / u0], [m_elevator + m_w_rate * z_elevator], [0.0]])?;
    Ok((a, b))
}

#[test]
fn the_optimal_gains_and_poles_are_those_of_the_handbook() -> Result<(), LtiError> {
    let printed = [
        (1.0, [0.305200, -0.174906, -1.000000], [-1.282832, -2.843836, 3.084267]),
        (50.0, [0.525692, -0.834968, -7.071068], [-1.899391, -6.389333, 6.574945]),
        (500.0, [0.570446, -1.692882, -22.360680], [-1.922145, -11.406231, 11.513119]),
    ];
    let (a, b) = navion()?;
    for (weight, gain, [real, re, im]) in printed {
        let mut q = Matrix::zeros(3, 3);
        q.set(2, 2, weight)?;
        let found = regulator(&a, &b, &q, &Matrix::identity(1))?;
        for (found, printed) in found.gain.data().iter().zip(gain) {
            assert!((found - printed).abs() < 5.1e-7, "{found} is not {printed}");
        }
        let poles = eigenvalues(&a.sum(&b.product(&found.gain)?.scaled(-1.0))?)?;
        let parts = [poles[2].re, poles[1].re, poles[1].im];
        for (found, printed) in parts.iter().zip([real, re, im]) {
            assert!((found - printed).abs() < 5.1e-7, "{found} is not {printed}");
        }
    }
    Ok(())
}
