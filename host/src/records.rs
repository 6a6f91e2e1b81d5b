//! Fitted files kept one by one: the finished fits of a run that was interrupted, and the parts of a batch.

pub mod journal;
pub mod own;
pub mod record;
pub mod shard;
