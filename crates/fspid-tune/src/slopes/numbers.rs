//! What the coordinates of a point do to the numbers of the controller, by differences of its construction.

use fspid_sim::Controller;
use fspid_sim::gradient::{NUMBERS, numbers};
use rayon::prelude::*;

use crate::flights::{Flights, FlownCase};

/// Width of the differences, of the cube: numbers of a controller are smooth, and known to 10⁻¹⁵.
const STEP: f64 = 1e-6;
/// Width for cells of a grid of numbers, which are straight lines rounded to a few digits, and for weights of a network.
const GRID_STEP: f64 = 0.25;
/// Two points at which controllers of different cases are compared; no search begins there.
const PROBES: [f64; 2] = [0.381_966_011_25, 0.723_606_797_75];

/// Which flights have the same controller, and how each kind of coordinate is followed.
#[derive(Debug)]
pub(super) struct Construction {
    /// The first flight with each controller.
    first: Vec<usize>,
    /// Number of the controller of each flight.
    class: Vec<usize>,
    /// For each controller the columns of cells of grids and of weights, which never change.
    straight: Vec<Vec<Option<Vec<f64>>>>,
    /// Coordinates that are cells of a grid or weights.
    is_cell: Vec<bool>,
    /// Case and run of the first flight with each controller.
    jobs: Vec<(usize, usize)>,
}

/// The controllers at a point.
pub(super) struct Built {
    pub(super) controllers: Vec<Controller>,
    pub(super) class: Vec<usize>,
    /// For each controller and each coordinate, what the coordinate does to its numbers.
    pub(super) columns: Vec<Vec<Vec<f64>>>,
}

impl Construction {
    pub(super) fn new(flights: &Flights, jobs: &[(&FlownCase, usize)]) -> Result<Self, String> {
        let space = flights.space();
        let dimension = space.dimension();
        let probes: Vec<Vec<f64>> = PROBES
            .iter()
            .map(|probe| (0..dimension).map(|n| (probe * (n + 1) as f64).fract()).collect())
            .chain([space.start()])
            .collect();
        let at_probes = |&(case, run): &(&FlownCase, usize)| -> Vec<Option<[f64; NUMBERS]>> {
            let at = |point: &Vec<f64>| built(flights, (case, run), point);
            probes.iter().map(|point| at(point).map(|it| numbers(&it))).collect()
        };
        let seen: Vec<Vec<Option<[f64; NUMBERS]>>> = jobs.par_iter().map(at_probes).collect();
        let (mut first, mut class) = (Vec::<usize>::new(), Vec::with_capacity(jobs.len()));
        for (job, numbers) in seen.iter().enumerate() {
            let same = |other: &usize| bits(&seen[*other]) == bits(numbers);
            let place = first.iter().position(same).unwrap_or(first.len());
            if place == first.len() {
                first.push(job);
            }
            class.push(place);
        }
        let mut is_cell = vec![false; dimension];
        for (range, is_straight) in super::coordinates_of(space) {
            is_cell[range].fill(is_straight);
        }
        let mut jobs_of = Vec::with_capacity(first.len());
        for job in &first {
            let (case, run) = jobs[*job];
            let place = flights.cases().iter().position(|it| std::ptr::eq(it, case));
            jobs_of.push((place.unwrap_or(0), run));
        }
        let mut construction = Self { straight: Vec::new(), first, class, is_cell, jobs: jobs_of };
        let start = space.start();
        for class in 0..construction.first.len() {
            let columns = (0..dimension).into_par_iter().map(|n| match construction.is_cell[n] {
                false => Ok(None),
                true => construction
                    .column(flights, class, (&start, None), n)
                    .map(Some)
                    .ok_or_else(|| format!("{}, which cannot be moved", space.names()[n])),
            });
            let columns: Vec<Result<Option<Vec<f64>>, String>> = columns.collect();
            construction.straight.push(columns.into_iter().collect::<Result<_, _>>()?);
        }
        Ok(construction)
    }

    /// The controllers at a point with their columns; none where one cannot be built.
    pub(super) fn built(&self, flights: &Flights, point: &[f64]) -> Option<Built> {
        let (mut controllers, mut columns) = (Vec::new(), Vec::new());
        for (class, &(case, run)) in self.jobs.iter().enumerate() {
            let controller = built(flights, (&flights.cases()[case], run), point)?;
            let here = numbers(&controller);
            let of_class =
                (0..point.len()).into_par_iter().map(|n| match &self.straight[class][n] {
                    Some(column) => Some(column.clone()),
                    None => self.column(flights, class, (point, Some(&here)), n),
                });
            columns.push(of_class.collect::<Option<Vec<_>>>()?);
            controllers.push(controller);
        }
        Some(Built { controllers, class: self.class.clone(), columns })
    }

    /// What a coordinate does to the numbers of a controller, from what they are here if that is known.
    fn column(
        &self,
        flights: &Flights,
        class: usize,
        (point, here): (&[f64], Option<&[f64; NUMBERS]>),
        coordinate: usize,
    ) -> Option<Vec<f64>> {
        let step = if self.is_cell[coordinate] { GRID_STEP } else { STEP };
        let (case, run) = self.jobs[class];
        let case = &flights.cases()[case];
        let at = point[coordinate];
        let to = if at + step <= 1.0 { at + step } else { at - step };
        let moved = |to: f64| {
            let mut moved = point.to_vec();
            moved[coordinate] = to;
            built(flights, (case, run), &moved).map(|it| numbers(&it))
        };
        let before = match here {
            Some(here) => *here,
            None => moved(at)?,
        };
        let after = moved(to)?;
        let slope = |(after, before): (&f64, &f64)| {
            let slope = (after - before) / (to - at);
            // Limits that are infinite stay where they are.
            if slope.is_finite() { slope } else { 0.0 }
        };
        Some(after.iter().zip(&before).map(slope).collect())
    }
}

fn built(flights: &Flights, (case, run): (&FlownCase, usize), point: &[f64]) -> Option<Controller> {
    let study = flights.study(point, case, run).ok()?;
    study.scenario.controllers.first().map(|named| named.controller)
}

fn bits(probes: &[Option<[f64; NUMBERS]>]) -> Vec<Option<Vec<u64>>> {
    let of = |it: &Option<[f64; NUMBERS]>| it.map(|it| it.iter().map(|n| n.to_bits()).collect());
    probes.iter().map(of).collect()
}
