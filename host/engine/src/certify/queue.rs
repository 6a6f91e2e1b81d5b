//! Tasks that wait, those with the least bound first, and of equal ones the oldest.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::branch::Task;

/// The tasks that wait.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    heap: BinaryHeap<Waiting>,
    pushed: u64,
    boxes: u64,
}

#[derive(Debug)]
struct Waiting {
    bound: f64,
    place: u64,
    task: Task,
}

impl Queue {
    pub fn push(&mut self, task: Task) {
        self.pushed += 1;
        self.boxes += task.regions.len() as u64;
        self.heap.push(Waiting {
            bound: task.bound(),
            place: self.pushed,
            task,
        });
    }

    /// Takes the first tasks, at most `count`.
    pub fn pop(&mut self, count: usize) -> Vec<Task> {
        let first: Vec<Task> = std::iter::from_fn(|| self.heap.pop())
            .take(count)
            .map(|waiting| waiting.task)
            .collect();
        self.boxes -= first.iter().map(|task| task.regions.len() as u64).sum::<u64>();
        first
    }

    /// The least bound, infinite if nothing waits.
    pub fn bound(&self) -> f64 {
        self.heap.peek().map_or(f64::INFINITY, |first| first.bound)
    }

    /// How many boxes wait.
    pub fn boxes(&self) -> u64 {
        self.boxes
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        // The heap gives the largest first.
        other.bound.total_cmp(&self.bound).then(other.place.cmp(&self.place))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
