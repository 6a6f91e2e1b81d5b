//! What kind of file a scan is from, as far as its numbers need checks.

/// What kind of file it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A table of columns, whose units and signs are anybody's.
    Table,
    /// A matrix, the same.
    Matrix,
    /// A format that fixes units and signs.
    Own,
}
