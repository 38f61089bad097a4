//! Tables of replacements in a text with the expected messages.

/// A text, its replacement, and in the line below the message; `\n` is the end of a line.
pub fn cases(table: &str) -> impl Iterator<Item = (String, String, String)> {
    let lines: Vec<&str> = table.trim().lines().collect();
    let pairs: Vec<_> = lines.as_chunks::<2>().0.to_vec();
    pairs.into_iter().map(|[replaced, expected]| {
        let (from, to) = replaced.split_once(" =>").unwrap();
        let texts = [from, to.trim_start(), expected.trim()];
        texts.map(|text| text.replace("\\n", "\n")).into()
    })
}
