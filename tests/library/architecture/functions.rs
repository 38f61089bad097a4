//! The functions of a file, and how large they are.

/// A function with a body.
#[derive(Debug, PartialEq)]
pub struct Function {
    pub name: String,
    /// Lines of its body that aren't blank.
    pub lines: usize,
    /// Number of arguments, `self` among them.
    pub arguments: usize,
}

/// The functions of a text without comments and strings, but those of tests at its end.
pub fn functions(code: &str) -> Vec<Function> {
    let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let starts = code.match_indices("fn ").map(|(at, _)| at);
    let is_word = |at: usize| code[..at].ends_with([' ', '\n', '(']) || at == 0;
    starts
        .filter(|&at| is_word(at))
        .filter_map(|at| function(&code[at + 3..]))
        .collect()
}

/// The function whose name a text begins with; `None` without a body.
fn function(text: &str) -> Option<Function> {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_')?;
    let open = end + text[end..].find('(')?;
    let list = enclosed(&text[open..], ['(', ')'])?;
    let rest = &text[open + list.len() + 2..];
    let body = rest.find(['{', ';'])?;
    if end == 0 || rest[body..].starts_with(';') {
        return None;
    }
    let body = enclosed(&rest[body..], ['{', '}'])?;
    Some(Function {
        name: text[..end].to_owned(),
        lines: body.lines().filter(|line| !line.trim().is_empty()).count(),
        arguments: arguments(list),
    })
}

/// The text between the bracket that it begins with and the one that closes it.
fn enclosed(text: &str, [open, close]: [char; 2]) -> Option<&str> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == open) - i32::from(c == close);
        if depth == 0 {
            return Some(&text[1..at]);
        }
    }
    None
}

/// The number of arguments in a list.
fn arguments(list: &str) -> usize {
    let mut depth = 0;
    let mut before = ' ';
    let parts = list.split(|c: char| {
        depth += match c {
            '(' | '[' | '{' | '<' => 1,
            // The arrow `->` isn't a closing bracket.
            '>' if before == '-' => 0,
            ')' | ']' | '}' | '>' => -1,
            _ => 0,
        };
        before = c;
        depth == 0 && c == ','
    });
    parts.filter(|part| !part.trim().is_empty()).count()
}

#[test]
fn lines_and_arguments_are_counted() {
    let code = "fn a(&self, f: impl Fn(u8, u8) -> u8, (x, y): (u8, u8),) -> u8 {\n    x\n\n    + y\n}\nfn b();\n";
    let found = functions(code);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].lines, found[0].arguments), (2, 3));
}
