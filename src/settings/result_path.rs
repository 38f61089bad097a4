//! The name of a result file.

use std::path::{Path, PathBuf};

/// The result file that belongs to `problem`: the same stem with the extension `vtkhdf`.
///
/// A problem that has this extension itself gets a result beside it, never on top of it.
pub fn default_result_path(problem: &Path) -> PathBuf {
    let result = problem.with_extension("vtkhdf");
    if result == problem {
        problem.with_extension("result.vtkhdf")
    } else {
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_result_lies_beside_its_problem() {
        for (problem, result) in [
            ("demo/problem.h5", "demo/problem.vtkhdf"),
            ("problem", "problem.vtkhdf"),
            ("granite.8.h5", "granite.8.vtkhdf"),
            ("granite.vtkhdf", "granite.result.vtkhdf"),
        ] {
            assert_eq!(default_result_path(Path::new(problem)), Path::new(result));
        }
    }
}
