//! Commands on their way to the servos of all lanes.

use super::lane::Lanes;

/// A ring of as many samples as the longest delay.
#[derive(Clone, Debug)]
pub(super) struct Queue<const W: usize> {
    ring: Vec<Lanes<W>>,
    delay_samples: [usize; W],
    longest: usize,
}

impl<const W: usize> Queue<W> {
    pub(super) fn new(delay_samples: [usize; W]) -> Self {
        let longest = delay_samples.iter().copied().max().unwrap_or(0);
        Self { ring: vec![[0.0; W]; longest + 1], delay_samples, longest }
    }

    /// Takes the commands of sample `k` and answers those that arrive.
    #[inline(always)]
    pub(super) fn pass(&mut self, k: usize, command_rad: &Lanes<W>) -> Lanes<W> {
        if self.longest == 0 {
            return *command_rad;
        }
        let size = self.ring.len();
        self.ring[k % size] = *command_rad;
        let mut arrived_rad = [0.0; W];
        for lane in 0..W {
            // Before its first command a servo is commanded to rest, as the ring is filled.
            arrived_rad[lane] = self.ring[(k + size - self.delay_samples[lane]) % size][lane];
        }
        arrived_rad
    }

    /// Lets a parked lane begin with this delay, before sample `k`.
    pub(super) fn begin(&mut self, lane: usize, delay_samples: usize, k: usize) {
        self.delay_samples[lane] = delay_samples;
        if delay_samples > self.longest {
            let old = std::mem::replace(&mut self.ring, vec![[0.0; W]; delay_samples + 1]);
            let newest = |ring: &[Lanes<W>], age: usize| (k + ring.len() - 1 - age) % ring.len();
            for age in 0..old.len() {
                let place = newest(&self.ring, age);
                self.ring[place] = old[newest(&old, age)];
            }
            self.longest = delay_samples;
        }
    }

    pub(super) fn park(&mut self, lane: usize) {
        self.ring.iter_mut().for_each(|commands| commands[lane] = 0.0);
    }
}
