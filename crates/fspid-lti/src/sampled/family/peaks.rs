//! The highest points of closed-loop responses of a loop of a family.

use super::bowl::{self, Point};
use super::member::{Member, Sample, height, nearness};

/// A place whose parabola ends this much above the lowest point found, relative to it, is looked at more closely.
const RIVAL: f64 = 1.05;

/// Place and height of the highest peak of $|T - t_0|$.
pub(super) fn highest(member: &Member<'_>, samples: &[Sample], centre: f64) -> Option<Point> {
    let function = |place: f64| nearness(member.at(place), centre);
    let values: Vec<f64> = samples.iter().map(|sample| nearness(sample.response, centre)).collect();
    let point = |index: usize| (samples[index].place, values[index]);
    let mut best = (0, f64::INFINITY);
    for (index, value) in values.iter().enumerate() {
        if value.is_nan() {
            return None;
        }
        if *value < best.1 {
            best = (index, *value);
        }
    }
    let mut lowest = around(best.0, samples.len())
        .map_or(point(best.0), |triple| bowl::lowest(function, triple.map(point), 0.0));
    for index in 1..samples.len() - 1 {
        let triple = [index - 1, index, index + 1].map(point);
        let [before, here, after] = triple;
        if index != best.0 && here.1 < before.1 && here.1 <= after.1 {
            let promise = bowl::vertex(here, before, after).map_or(0.0, |(_, promise)| promise);
            if here.1 - promise < RIVAL * lowest.1 {
                let rival = bowl::lowest(function, triple, 0.0);
                if rival.1 < lowest.1 {
                    lowest = rival;
                }
            }
        }
    }
    Some((lowest.0, height(member.at(lowest.0), centre)))
}

/// A place and its neighbours, if it has two.
fn around(index: usize, count: usize) -> Option<[usize; 3]> {
    (index > 0 && index + 1 < count).then(|| [index - 1, index, index + 1])
}
