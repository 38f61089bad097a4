//! How much of the mesh belongs to each subdomain.

use crate::error::InputError;
use crate::problem::dataset::Dataset;

/// Numbers of points, cells and connectivity entries of every subdomain.
pub(super) struct Sizes {
    pub points: Vec<usize>,
    pub cells: Vec<usize>,
    pub connectivity: Vec<usize>,
}

impl Sizes {
    /// Reads them and checks the shapes of the mesh's datasets against them.
    pub fn read(file: &hdf5::File) -> Result<Self, InputError> {
        let points = Dataset::column(file, "/VTKHDF/NumberOfPoints", None)?;
        let count = points.rows();
        if count == 0 {
            return Err(points.error("is empty; expected at least one subdomain"));
        }
        let of = |name| Dataset::column(file, name, Some(count));
        let cells = of("/VTKHDF/NumberOfCells")?;
        let connectivity = of("/VTKHDF/NumberOfConnectivityIds")?;
        let table = Dataset::table(file, "/VTKHDF/Points", None, 3)?;
        let types = Dataset::column(file, "/VTKHDF/Types", None)?;
        let nodes = Dataset::column(file, "/VTKHDF/Connectivity", None)?;
        let sizes = Self {
            points: counts(&points, table.rows(), "/VTKHDF/Points")?,
            cells: counts(&cells, types.rows(), "/VTKHDF/Types")?,
            connectivity: counts(&connectivity, nodes.rows(), "/VTKHDF/Connectivity")?,
        };
        Dataset::column(file, "/VTKHDF/Offsets", Some(types.rows() + count))?;
        Dataset::column(file, "/VTKHDF/PointData/GlobalNodeId", Some(table.rows()))?;
        Dataset::column(file, "/VTKHDF/CellData/Material", Some(types.rows()))?;
        Ok(sizes)
    }
}

/// Positive numbers whose sum is the number of rows of the dataset `of`.
fn counts(dataset: &Dataset, total: usize, of: &str) -> Result<Vec<usize>, InputError> {
    let mut sum = 0usize;
    let mut counts = Vec::with_capacity(dataset.rows());
    for (row, value) in dataset.all_integers()?.into_iter().enumerate() {
        match usize::try_from(value) {
            Ok(n) if (1..=total - sum.min(total)).contains(&n) => {
                sum += n;
                counts.push(n);
            }
            _ => {
                return Err(dataset.row_error(
                    row,
                    &format!(
                        "{value}; expected positive numbers with the sum {total}, the rows of {of}"
                    ),
                ));
            }
        }
    }
    if sum != total {
        return Err(dataset.error(&format!(
            "the sum is {sum}; expected {total}, the rows of {of}"
        )));
    }
    Ok(counts)
}
