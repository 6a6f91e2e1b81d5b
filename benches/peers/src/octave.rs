//! Octave's lsqnonlin, as a MATLAB user calls it: `octave.m` runs in one `octave-cli` for the whole race, and asks for each residual here.

use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use crate::course::Course;
use crate::outside;

/// A running Octave with its package `optim`.
pub struct Octave {
    /// The versions of both.
    pub versions: [String; 2],
    child: Child,
    pipes: RefCell<Pipes>,
}

struct Pipes {
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Pipes {
    fn send(&mut self, numbers: &[f64]) {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
        self.to.write_all(&bytes).expect("Octave reads");
    }

    /// What is asked for (1 residuals, 2 the Jacobian too, -1 nothing more), and for which parameters.
    fn receive(&mut self) -> (f64, [f64; 6]) {
        let mut numbers = [0.0; 7];
        for number in &mut numbers {
            let mut bytes = [0; 8];
            self.from.read_exact(&mut bytes).expect("Octave writes");
            *number = f64::from_ne_bytes(bytes);
        }
        (numbers[0], std::array::from_fn(|k| numbers[k + 1]))
    }
}

impl Octave {
    /// None where `octave-cli` or its package is not installed.
    pub fn begin() -> Option<Self> {
        let mut child = Command::new("octave-cli")
            .args(["--norc", "--quiet"])
            .arg(outside::beside("src/octave.m"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .ok()?;
        let to = child.stdin.take()?;
        let mut from = BufReader::new(child.stdout.take()?);
        let mut line = String::new();
        from.read_line(&mut line).ok()?;
        let Some((octave, optim)) = line.trim().split_once(' ') else {
            child.wait().ok()?;
            return None;
        };
        Some(Octave {
            versions: [octave, optim].map(str::to_string),
            child,
            pipes: RefCell::new(Pipes { to, from }),
        })
    }

    /// One fit from a start within the bounds, with Octave's own tolerances; the course counts and notes what it asks for.
    pub fn lsqnonlin(&self, course: &Course, start: &[f64; 6]) {
        let mut pipes = self.pipes.borrow_mut();
        let rows = course.rows() as f64;
        pipes.send(&[&[rows], &course.lower[..], &course.upper, start].concat());
        let (mut asked, mut linearized) = (0, 0.0);
        loop {
            let (wanted, x) = pipes.receive();
            if wanted < 0.0 {
                // It asks for one Jacobian an iteration, so it takes ours, not differences; a fit that was cut off, as by the end of the race, says -1.
                assert!(x[0] == linearized || x[0] < 0.0, "lsqnonlin leaves the Jacobian out");
                assert!(asked > 0, "lsqnonlin does not begin");
                return;
            }
            asked += 1;
            let mut answer = vec![f64::from(u8::from(!course.is_over()))];
            if wanted == 2.0 {
                let (residuals, gradients) = course.linearized(&x);
                answer.extend(residuals);
                (0..6).for_each(|k| answer.extend(gradients.iter().map(|gradient| gradient[k])));
                linearized += 1.0;
            } else {
                answer.extend(course.residuals(&x));
            }
            pipes.send(&answer);
        }
    }
}

impl Drop for Octave {
    fn drop(&mut self) {
        // It waits for the next fit, and has nothing to save.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
