//! Comparison of messages with expected ones.

/// Fails unless a message contains the parts of `expected`, separated by `…`, in their order.
#[track_caller]
pub fn says(message: &str, expected: &str) {
    let mut rest = message;
    for part in expected.split(" … ") {
        let found = rest.split_once(part);
        assert!(found.is_some(), "{message}\nlacks '{part}'");
        rest = found.unwrap().1;
    }
}
