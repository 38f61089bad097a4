//! Expressions of x, y and z, with the precedence of mathematics: −x^2 is −(x²), 2^3^2 is 2^9.

use super::suggest::hint_and_known;

/// Largest length and nesting of an expression, so that no text can exhaust the stack.
const LONGEST: usize = 4096;
const DEEPEST: usize = 64;

const VARIABLES: [&str; 3] = ["x", "y", "z"];
const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("PI", std::f64::consts::PI)];
type Unary = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

const UNARY: [(&str, Unary); 16] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sqrt", f64::sqrt),
    ("cbrt", f64::cbrt),
    ("abs", f64::abs),
    ("sign", sign),
];
const BINARY: [(&str, Binary); 4] = [
    ("min", f64::min),
    ("max", f64::max),
    ("atan2", f64::atan2),
    ("hypot", f64::hypot),
];

/// The sign: −1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// A step of an expression in postfix order.
#[derive(Clone, Copy, Debug)]
enum Step {
    Number(f64),
    Variable(usize),
    Unary(Unary),
    Binary(Binary),
}

/// An expression of x, y and z.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    steps: Vec<Step>,
    is_constant: bool,
    /// The position of its first z.
    z_at: Option<usize>,
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Expression {
    /// Parses `text`: numbers, `x`, `y`, `z`, `pi`, `+ - * / ^` (or `**`), parentheses, and the functions sin, cos,
    /// tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, log10, sqrt, cbrt, abs, sign, min, max, atan2, hypot.
    ///
    /// # Errors
    /// Invalid text, and the first invalid character.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut parser = Parser {
            text,
            at: 0,
            depth: 0,
            expression: Self {
                text: text.to_owned(),
                steps: Vec::new(),
                is_constant: true,
                z_at: None,
            },
        };
        parser
            .whole()
            .map_err(|reason| located(text, parser.at, &reason))?;
        Ok(parser.expression)
    }

    /// Value at a point; not finite where it is undefined.
    pub fn value(&self, at: [f64; 3]) -> f64 {
        // A nesting level holds at most an operand of each of the four precedences.
        let mut stack = [0.0; 4 * DEEPEST];
        let mut top = 0;
        for step in &self.steps {
            match *step {
                Step::Number(value) => {
                    stack[top] = value;
                    top += 1;
                }
                Step::Variable(axis) => {
                    stack[top] = at[axis];
                    top += 1;
                }
                Step::Unary(apply) => stack[top - 1] = apply(stack[top - 1]),
                Step::Binary(apply) => {
                    top -= 1;
                    stack[top - 1] = apply(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The error of an expression in the plane: it contains z.
    pub fn fault_in_plane(&self) -> Option<String> {
        let at = self.z_at?;
        Some(located(
            &self.text,
            at,
            "'z' isn't known in the plane; expected x and y",
        ))
    }

    /// True if it is independent of position.
    pub fn is_constant(&self) -> bool {
        self.is_constant
    }

    /// True if it contains z.
    pub fn has_z(&self) -> bool {
        self.z_at.is_some()
    }
}

/// An error at a byte of an expression.
fn located(text: &str, at: usize, reason: &str) -> String {
    let shown: String = text.chars().take(60).collect();
    let place = text[..at].chars().count() + 1;
    format!("expression '{shown}', character {place}: {reason}")
}

/// Recursive-descent parser of an expression.
struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    expression: Expression,
}

impl Parser<'_> {
    fn whole(&mut self) -> Result<(), String> {
        if self.text.len() > LONGEST {
            return Err(format!("an expression has at most {LONGEST} characters"));
        }
        self.sum()?;
        match self.peek() {
            None => Ok(()),
            Some(found) if found.is_alphabetic() => Err(format!(
                "expected an operator, found '{found}'; a number has no unit, a product a '*'"
            )),
            Some(',') if self.text[self.at..].contains(|c: char| c.is_ascii_digit()) => {
                Err("expected an operator, found ','; numbers have a decimal point".into())
            }
            Some(found) => Err(format!("expected an operator, found '{found}'")),
        }
    }

    /// The next character that isn't white space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, symbol: &str) -> bool {
        self.peek();
        let found = self.text[self.at..].starts_with(symbol);
        if found {
            self.at += symbol.len();
        }
        found
    }

    fn expect(&mut self, symbol: char) -> Result<(), String> {
        match self.peek() {
            Some(found) if found == symbol => {
                self.at += symbol.len_utf8();
                Ok(())
            }
            Some(found) => Err(format!("expected '{symbol}', found '{found}'")),
            None => Err(format!("expected '{symbol}', found the end")),
        }
    }

    fn push(&mut self, step: Step) {
        self.expression.steps.push(step);
    }

    fn sum(&mut self) -> Result<(), String> {
        self.chain(Self::product, [("+", |a, b| a + b), ("-", |a, b| a - b)])
    }

    fn product(&mut self) -> Result<(), String> {
        self.chain(Self::signed, [("*", |a, b| a * b), ("/", |a, b| a / b)])
    }

    /// Operands between operators of the same precedence, applied from left to right.
    fn chain(
        &mut self,
        operand: fn(&mut Self) -> Result<(), String>,
        operators: [(&str, Binary); 2],
    ) -> Result<(), String> {
        operand(self)?;
        while let Some((_, apply)) = operators.into_iter().find(|(sign, _)| self.take(sign)) {
            operand(self)?;
            self.push(Step::Binary(apply));
        }
        Ok(())
    }

    fn signed(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("nested deeper than {DEEPEST} levels"));
        }
        if self.take("-") {
            self.signed()?;
            self.push(Step::Unary(|a| -a));
        } else if self.take("+") {
            self.signed()?;
        } else {
            self.power()?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn power(&mut self) -> Result<(), String> {
        self.atom()?;
        if self.take("^") || self.take("**") {
            self.signed()?;
            self.push(Step::Binary(f64::powf));
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), String> {
        match self.peek() {
            Some('(') => {
                self.expect('(')?;
                self.sum()?;
                self.expect(')')
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.word(),
            Some(found) => Err(format!("expected a number, x, y or z, found '{found}'")),
            None => Err("expected a number, x, y or z, found the end".into()),
        }
    }

    fn number(&mut self) -> Result<(), String> {
        let rest = &self.text.as_bytes()[self.at..];
        let digits = |from: usize| {
            rest[from..]
                .iter()
                .take_while(|c| c.is_ascii_digit())
                .count()
        };
        let mut end = digits(0);
        if rest.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(rest.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(end + 1), Some(b'+' | b'-')));
            end += 1 + sign + digits(end + 1 + sign);
        }
        let text = &self.text[self.at..self.at + end];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += end;
                self.push(Step::Number(value));
                Ok(())
            }
            Ok(_) => Err(format!("'{text}' is too large for a number")),
            Err(_) => Err(format!("'{text}' isn't a number")),
        }
    }

    fn word(&mut self) -> Result<(), String> {
        let rest = &self.text[self.at..];
        let end = rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        let (word, start) = (&rest[..end], self.at);
        self.at += end;
        if let Some(axis) = VARIABLES.iter().position(|&name| name == word) {
            self.expression.is_constant = false;
            if axis == 2 {
                self.expression.z_at.get_or_insert(start);
            }
            self.push(Step::Variable(axis));
        } else if let Some(&(_, value)) = CONSTANTS.iter().find(|c| c.0 == word) {
            self.push(Step::Number(value));
        } else if let Some(&(_, apply)) = UNARY.iter().find(|f| f.0 == word) {
            self.expect('(')?;
            self.sum()?;
            self.expect(')')?;
            self.push(Step::Unary(apply));
        } else if let Some(&(_, apply)) = BINARY.iter().find(|f| f.0 == word) {
            self.expect('(')?;
            self.sum()?;
            self.expect(',')?;
            self.sum()?;
            self.expect(')')?;
            self.push(Step::Binary(apply));
        } else {
            self.at = start;
            let names = VARIABLES
                .into_iter()
                .chain(CONSTANTS.map(|c| c.0))
                .chain(UNARY.map(|f| f.0))
                .chain(BINARY.map(|f| f.0));
            return Err(format!(
                "'{word}' isn't known{}",
                hint_and_known(word, names)
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
