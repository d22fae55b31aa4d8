//! stub
pub(super) fn spanning(points: &[[f64; 3]], _t: f64) -> Vec<[f64; 3]> {
    let mut chosen = std::collections::BTreeSet::new();
    let n = 400;
    let spread: [f64;3] = core::array::from_fn(|g| { let v: Vec<f64> = points.iter().map(|p| p[g]).collect(); let a=v.iter().cloned().fold(f64::INFINITY,f64::min); let b=v.iter().cloned().fold(f64::NEG_INFINITY,f64::max); if b>a {b-a} else {1.0}});
    for i in 0..n {
        let z = 1.0 - 2.0*(i as f64+0.5)/n as f64; let r=(1.0-z*z).sqrt(); let phi = 2.399963229728653*i as f64;
        let d=[r*libm::cos(phi)/spread[0], r*libm::sin(phi)/spread[1], z/spread[2]];
        let best = points.iter().enumerate().max_by(|a,b| { let f=|p:&[f64;3]| p[0]*d[0]+p[1]*d[1]+p[2]*d[2]; f(a.1).total_cmp(&f(b.1))}).map(|x| x.0);
        chosen.extend(best);
    }
    chosen.into_iter().map(|i| points[i]).collect()
}
