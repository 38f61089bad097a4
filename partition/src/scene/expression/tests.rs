use super::*;

fn value(text: &str) -> f64 {
    Expression::parse(text).unwrap().value([3.0, 5.0, 7.0])
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("-x^2", -9.0),
        ("2*-x^2", -18.0),
        ("2^3^2", 512.0),
        ("2**-1", 0.5),
        ("8-3-2", 3.0),
        ("10/2/5", 1.0),
        ("1+2*y", 11.0),
        ("-(1 - y)*x", 12.0),
        ("--x", 3.0),
        ("-sin(pi/2)^2", -1.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn numbers_are_read_in_every_usual_notation() {
    for (text, expected) in [
        ("1e6", 1e6),
        ("-1e6*(1-x^2)", 8e6),
        ("1.5E+3", 1500.0),
        ("2.e-1", 0.2),
        (".5", 0.5),
        ("0.7e7", 0.7e7),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn functions_are_those_of_the_standard_library() {
    assert_eq!(value("max(x, y) + hypot(3, 4)"), 10.0);
    assert_eq!(value("exp(-x^2)"), (-9.0_f64).exp());
    assert_eq!(value("abs(x - y)*sign(0)"), 0.0);
    assert_eq!(value("atan2(x, sqrt(y))"), 3.0_f64.atan2(5.0_f64.sqrt()));
}

#[test]
fn what_is_wrong_is_named_with_its_character() {
    for (text, expected) in [
        ("1 + r", "character 5: 'r' isn't known"),
        ("sine(x)", "did you mean 'sin'"),
        ("2x", "character 2: expected an operator"),
        ("(1", "expected ')', found the end"),
        ("", "found the end"),
        ("x-", "found the end"),
        ("1e", "isn't a number"),
        ("1e999", "too large"),
        ("é", "isn't known"),
        ("min(1)", "expected ','"),
        (
            "1,5",
            "expected an operator, found ','; numbers have a decimal point",
        ),
    ] {
        let message = Expression::parse(text).unwrap_err();
        assert!(message.contains(expected), "{text}: {message}");
    }
}

#[test]
fn no_text_exhausts_the_stack() {
    assert!(Expression::parse(&"(".repeat(4000)).is_err());
    assert!(Expression::parse(&"-".repeat(4000)).is_err());
    assert!(Expression::parse(&"1^".repeat(2000)).is_err());
    let deepest = format!("{}x{}", "x+x*x^(".repeat(31), ")".repeat(31));
    assert!(Expression::parse(&deepest).unwrap().value([1.0; 3]) > 0.0);
    assert_eq!(value(&format!("0{}", "+1".repeat(2000))), 2000.0);
}
