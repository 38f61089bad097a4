//! What travels: any type of serde, in the encoding of postcard.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// The bytes of a value.
pub(super) fn encode<T: Serialize>(value: &T) -> postcard::Result<Vec<u8>> {
    postcard::to_stdvec(value)
}

/// The value that `bytes` stand for, all of them.
pub(super) fn decode<T: DeserializeOwned>(bytes: &[u8]) -> postcard::Result<T> {
    match postcard::take_from_bytes(bytes)? {
        (value, []) => Ok(value),
        _ => Err(postcard::Error::DeserializeBadEncoding),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_short_or_too_long_is_an_error() {
        let sent = (7usize, vec![1.5, -0.0], String::from("a name"));
        let bytes = encode(&sent).unwrap();
        assert_eq!(decode::<(usize, Vec<f64>, String)>(&bytes).unwrap(), sent);
        for length in 0..bytes.len() {
            assert!(decode::<(usize, Vec<f64>, String)>(&bytes[..length]).is_err());
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(decode::<(usize, Vec<f64>, String)>(&longer).is_err());
    }
}
