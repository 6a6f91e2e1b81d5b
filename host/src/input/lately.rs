//! Answers to what was asked lately: the files of a batch have the same heads.

use std::borrow::Borrow;

/// Answers that are kept.
const KEPT: usize = 16;

/// The last questions with their answers.
pub struct Lately<Q, A> {
    list: Vec<(Q, A)>,
    /// The place of the oldest of [`KEPT`].
    oldest: usize,
}

impl<Q, A: Clone> Lately<Q, A> {
    /// Nothing yet.
    pub const fn new() -> Self {
        Lately {
            list: Vec::new(),
            oldest: 0,
        }
    }

    /// The answer to a question, which `find` finds if it was not asked lately.
    pub fn of<K: ?Sized + PartialEq + ToOwned<Owned = Q>>(&mut self, question: &K, find: impl FnOnce() -> A) -> A
    where
        Q: Borrow<K>,
    {
        let known = self.list.iter().find(|(known, _)| known.borrow() == question);
        if let Some((_, answer)) = known {
            return answer.clone();
        }
        let answer = find();
        let new = (question.to_owned(), answer.clone());
        if self.list.len() < KEPT {
            self.list.push(new);
        } else {
            self.list[self.oldest] = new;
            self.oldest = (self.oldest + 1) % KEPT;
        }
        answer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_asked_lately_is_not_found_again() {
        let mut lately: Lately<String, usize> = Lately::new();
        let mut found = 0;
        let mut ask = |question: &str| {
            lately.of(question, || {
                found += 1;
                question.len()
            })
        };
        assert_eq!((ask("one"), ask("three"), ask("one")), (3, 5, 3));
        for k in 0..KEPT {
            assert_eq!(ask(&k.to_string()), k.to_string().len());
        }
        assert_eq!((ask("one"), ask("one")), (3, 3));
        assert_eq!(found, 2 + KEPT + 1);
    }
}
