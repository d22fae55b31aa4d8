//! Regions above a level and lines along it, on a rectangular grid.
//!
//! Each cell is split into two triangles, in which the value is linear; so there are no saddles to decide.

use std::collections::BTreeMap;

/// A corner: place on the canvas and value.
type Corner = (f64, f64, f64);

/// A grid of values whose nodes have places on the canvas.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub(super) xs: Vec<f64>,
    pub(super) ys: Vec<f64>,
    /// `values[i][j]` belongs to `xs[j]`, `ys[i]`.
    pub(super) values: Vec<Vec<f64>>,
}

impl Grid {
    fn corner(&self, i: usize, j: usize) -> Option<Corner> {
        let value = *self.values.get(i)?.get(j)?;
        let (x, y) = (*self.xs.get(j)?, *self.ys.get(i)?);
        (value.is_finite() && x.is_finite() && y.is_finite()).then_some((x, y, value))
    }

    /// Corners of a cell in order around it; `None` where one is missing.
    pub(super) fn cell(&self, i: usize, j: usize) -> Option<[Corner; 4]> {
        Some([
            self.corner(i, j)?,
            self.corner(i, j + 1)?,
            self.corner(i + 1, j + 1)?,
            self.corner(i + 1, j)?,
        ])
    }

    /// Number of cells down and across.
    pub(super) fn cells(&self) -> (usize, usize) {
        (self.ys.len().saturating_sub(1), self.xs.len().saturating_sub(1))
    }

    /// Polygons that cover where the value is at least `level`.
    pub(super) fn region(&self, level: f64) -> Vec<Vec<(f64, f64)>> {
        let (rows, columns) = self.cells();
        let mut polygons = Vec::new();
        for i in 0..rows {
            let mut run: Option<(Corner, Corner)> = None;
            for j in 0..columns {
                let Some(cell) = self.cell(i, j) else {
                    continue;
                };
                let whole = cell.iter().all(|corner| corner.2 >= level);
                if !whole {
                    polygons.extend(run.take().map(block));
                    polygons.extend(
                        triangles(&cell).iter().map(|t| above(t, level)).filter(|p| p.len() > 2),
                    );
                    continue;
                }
                // Whole cells in a row become one block.
                let joined = run.filter(|(_, end)| end.0.total_cmp(&cell[0].0).is_eq());
                if joined.is_none() {
                    polygons.extend(run.take().map(block));
                }
                run = Some((joined.map_or(cell[0], |(start, _)| start), cell[2]));
            }
            polygons.extend(run.map(block));
        }
        polygons
    }

    /// Lines along `level`, joined to chains as long as possible.
    pub(super) fn lines(&self, level: f64) -> Vec<Vec<(f64, f64)>> {
        let (rows, columns) = self.cells();
        let mut segments = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let Some(cell) = self.cell(i, j) else {
                    continue;
                };
                segments.extend(triangles(&cell).iter().filter_map(|t| crossing(t, level)));
            }
        }
        chains(&segments)
    }
}

fn triangles(cell: &[Corner; 4]) -> [[Corner; 3]; 2] {
    let [a, b, c, d] = *cell;
    [[a, b, c], [a, c, d]]
}

fn block((start, end): (Corner, Corner)) -> Vec<(f64, f64)> {
    vec![(start.0, start.1), (end.0, start.1), (end.0, end.1), (start.0, end.1)]
}

/// Where the edge between two corners crosses `level`; the same for both directions.
fn cut(a: Corner, b: Corner, level: f64) -> (f64, f64) {
    let (a, b) = if (a.0, a.1) <= (b.0, b.1) { (a, b) } else { (b, a) };
    let part = ((level - a.2) / (b.2 - a.2)).clamp(0.0, 1.0);
    (a.0 + (b.0 - a.0) * part, a.1 + (b.1 - a.1) * part)
}

/// The part of a triangle where the value is at least `level`.
fn above(triangle: &[Corner; 3], level: f64) -> Vec<(f64, f64)> {
    let mut polygon = Vec::new();
    for (a, b) in edges(triangle) {
        if a.2 >= level {
            polygon.push((a.0, a.1));
        }
        if (a.2 >= level) != (b.2 >= level) {
            polygon.push(cut(a, b, level));
        }
    }
    polygon
}

/// The line along `level` through a triangle.
fn crossing(triangle: &[Corner; 3], level: f64) -> Option<[(f64, f64); 2]> {
    let mut cuts = edges(triangle)
        .into_iter()
        .filter(|(a, b)| (a.2 >= level) != (b.2 >= level))
        .map(|(a, b)| cut(a, b, level));
    Some([cuts.next()?, cuts.next()?])
}

fn edges([a, b, c]: &[Corner; 3]) -> [(Corner, Corner); 3] {
    [(*a, *b), (*b, *c), (*c, *a)]
}

/// A place to a thousandth of a pixel, by which ends are recognised.
fn key(point: (f64, f64)) -> (i64, i64) {
    ((point.0 * 1e3).round() as i64, (point.1 * 1e3).round() as i64)
}

/// Joins segments that share ends.
fn chains(segments: &[[(f64, f64); 2]]) -> Vec<Vec<(f64, f64)>> {
    let mut at: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    for (n, ends) in segments.iter().enumerate().filter(|(_, ends)| key(ends[0]) != key(ends[1])) {
        for end in ends {
            at.entry(key(*end)).or_default().push(n);
        }
    }
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    // Open chains first, from their ends; what is left are loops.
    let open = at.iter().filter(|(_, found)| found.len() == 1).map(|(key, _)| *key);
    let starts: Vec<(i64, i64)> = open.chain(at.keys().copied()).collect();
    for start in starts {
        let mut chain: Vec<(f64, f64)> = Vec::new();
        let mut here = start;
        while let Some(&n) = at.get(&here).and_then(|found| found.iter().find(|n| !used[**n])) {
            used[n] = true;
            let [a, b] = segments[n];
            let (from, to) = if key(a) == here { (a, b) } else { (b, a) };
            if chain.is_empty() {
                chain.push(from);
            }
            chain.push(to);
            here = key(to);
        }
        if chain.len() > 1 {
            chains.push(chain);
        }
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone() -> Grid {
        let nodes: Vec<f64> = (-10..=10).map(f64::from).collect();
        let values =
            nodes.iter().map(|y| nodes.iter().map(|x| -(x * x + y * y).sqrt()).collect()).collect();
        Grid { xs: nodes.clone(), ys: nodes, values }
    }

    #[test]
    fn a_level_of_a_cone_is_one_closed_loop() {
        let lines = cone().lines(-5.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(key(lines[0][0]), key(lines[0][lines[0].len() - 1]));
        assert!(lines[0].iter().all(|p| ((p.0 * p.0 + p.1 * p.1).sqrt() - 5.5).abs() < 0.1));
    }

    #[test]
    fn the_region_above_a_level_has_the_area_of_a_disc() {
        let area = |polygon: &Vec<(f64, f64)>| {
            let next = polygon.iter().cycle().skip(1);
            polygon.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>().abs() / 2.0
        };
        let total: f64 = cone().region(-5.5).iter().map(area).sum();
        assert!((total - std::f64::consts::PI * 5.5 * 5.5).abs() < 1.5, "{total}");
    }

    #[test]
    fn holes_in_the_data_stay_holes() {
        let mut grid = cone();
        grid.values[10][10] = f64::NAN;
        assert!(grid.cell(10, 10).is_none());
        assert_eq!(
            Grid { xs: Vec::new(), ys: Vec::new(), values: Vec::new() }.region(0.0).len(),
            0
        );
    }
}
