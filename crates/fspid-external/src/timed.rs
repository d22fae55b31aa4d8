//! A conversation with an end: a time for an answer in all, and not for each of its bytes.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

/// A stream on which reading and writing together take no longer than a time.
pub(crate) struct Timed<'a> {
    stream: &'a UnixStream,
    until: Instant,
}

impl<'a> Timed<'a> {
    pub(crate) fn new(stream: &'a UnixStream, limit: Duration) -> Self {
        Self { stream, until: Instant::now() + limit }
    }

    fn left(&self) -> io::Result<Option<Duration>> {
        // A limit of zero would be none.
        let left = self.until.checked_duration_since(Instant::now()).filter(|it| !it.is_zero());
        left.map(Some).ok_or_else(|| io::ErrorKind::TimedOut.into())
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Duration = Duration::from_millis(20);

    #[test]
    fn one_byte_after_the_other_makes_no_answer_longer_than_its_limit() {
        let (ours, mut theirs) = UnixStream::pair().expect("a socket");
        let drip = std::thread::spawn(move || {
            while theirs.write_all(&[0]).is_ok() {
                std::thread::sleep(SHORT / 4);
            }
        });
        let read = io::copy(&mut Timed::new(&ours, SHORT), &mut io::sink());
        assert!(read.is_err());
        drop(ours);
        drip.join().expect("ended");
    }

    #[test]
    fn writing_to_one_who_does_not_read_ends() {
        let (ours, _theirs) = UnixStream::pair().expect("a socket");
        let written = io::copy(&mut io::repeat(0), &mut Timed::new(&ours, SHORT));
        assert!(written.is_err());
    }
}
