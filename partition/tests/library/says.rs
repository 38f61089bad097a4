//! Messages that say what they should.

/// Fails unless a message has what is expected, whose parts are set apart by `…`.
#[track_caller]
pub fn says(message: &str, expected: &str) {
    let mut rest = message;
    for part in expected.split(" … ") {
        let found = rest.split_once(part);
        assert!(found.is_some(), "{message}\nlacks '{part}'");
        rest = found.unwrap().1;
    }
}
