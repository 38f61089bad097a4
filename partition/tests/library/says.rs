//! Messages that say what they should.

/// Fails unless a message has what is expected, whose parts are set apart by `…`.
#[track_caller]
pub fn says(message: &str, expected: &str) {
    let mut rest = message;
    for part in expected.split(" … ") {
        let Some((_, after)) = rest.split_once(part) else {
            panic!("{message}\nlacks '{part}'");
        };
        rest = after;
    }
}
