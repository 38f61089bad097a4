//! Comparison of output with the output shown on a page.

/// The placeholder for any text.
const ANYTHING: char = '…';

/// True if `printed` agrees with the page. `…` matches any text within a line, and as a line any number of
/// lines; trailing blanks and empty lines at the end are ignored.
pub fn is_shown(shown: &str, printed: &str) -> bool {
    lines_match(&lines(shown), &lines(printed))
}

fn lines(text: &str) -> Vec<&str> {
    text.trim_end().lines().map(str::trim_end).collect()
}

fn lines_match(shown: &[&str], printed: &[&str]) -> bool {
    match (shown, printed) {
        ([], _) => printed.is_empty(),
        ([first, rest @ ..], _) if first.trim() == "…" => {
            (0..=printed.len()).any(|skipped| lines_match(rest, &printed[skipped..]))
        }
        ([first, rest @ ..], [line, others @ ..]) => {
            line_matches(first, line) && lines_match(rest, others)
        }
        ([_, ..], []) => false,
    }
}

fn line_matches(shown: &str, printed: &str) -> bool {
    let Some((head, mut tail)) = shown.split_once(ANYTHING) else {
        return shown == printed;
    };
    let Some(mut rest) = printed.strip_prefix(head) else {
        return false;
    };
    // The first match of each piece leaves most text for the following ones; the last piece has to match the end.
    while let Some((piece, more)) = tail.split_once(ANYTHING) {
        let Some((_, after)) = rest.split_once(piece) else {
            return false;
        };
        (rest, tail) = (after, more);
    }
    rest.ends_with(tail)
}

/// A test: the texts that `…` matches, and some that it doesn't.
pub fn dots() {
    for (shown, printed) in [
        ("a\nb", "a\nb\n"),
        ("a …", "a 1.5"),
        ("a … s, … MB", "a 1.5 s, 3 MB"),
        ("…\nb", "a\na\nb"),
        ("a\n…", "a"),
        ("a\n…\nc\n…", "a\nb\nc\nc\nd"),
    ] {
        assert!(is_shown(shown, printed), "{shown:?} {printed:?}");
    }
    for (shown, printed) in [
        ("a", "a\nb"),
        ("a\nb", "a"),
        ("a … s", "a 1.5 ms, 3"),
        ("…\nb", "a\nc"),
        ("", "a"),
        ("ab…b", "ab"),
    ] {
        assert!(!is_shown(shown, printed), "{shown:?} {printed:?}");
    }
}
