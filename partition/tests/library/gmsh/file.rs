//! A mesh as MSH files of both versions and all encodings, spelled out number by number.

/// Encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    Ascii,
    Binary { big_endian: bool },
}

pub const FORMS: [Form; 3] = [
    Form::Ascii,
    Form::Binary { big_endian: false },
    Form::Binary { big_endian: true },
];

/// Bytes of a file that grow number by number.
struct File {
    form: Form,
    bytes: Vec<u8>,
}

impl File {
    fn new(version: &str, form: Form) -> Self {
        let mut file = Self {
            form,
            bytes: Vec::new(),
        };
        let binary = form != Form::Ascii;
        file.text(&format!("$MeshFormat\n{version} {} 8\n", i32::from(binary)));
        if binary {
            file.int(1);
            file.text("\n");
        }
        file.text("$EndMeshFormat\n");
        file
    }

    fn text(&mut self, text: &str) {
        self.bytes.extend(text.bytes());
    }

    fn number<const N: usize>(&mut self, word: String, le: [u8; N]) {
        let mut bytes = le;
        match self.form {
            Form::Ascii => return self.text(&format!("{word} ")),
            Form::Binary { big_endian: true } => bytes.reverse(),
            Form::Binary { big_endian: false } => {}
        }
        self.bytes.extend(bytes);
    }

    fn int(&mut self, value: i32) {
        self.number(value.to_string(), value.to_le_bytes());
    }

    fn size(&mut self, value: u64) {
        self.number(value.to_string(), value.to_le_bytes());
    }

    fn sizes(&mut self, values: &[u64]) {
        values.iter().for_each(|&v| self.size(v));
    }

    fn real(&mut self, value: f64) {
        self.number(value.to_string(), value.to_le_bytes());
    }

    fn reals(&mut self, values: &[f64]) {
        values.iter().for_each(|&v| self.real(v));
    }

    fn end(&mut self, section: &str) {
        self.text(&format!("\n$End{section}\n"));
    }
}

const NAMES: &str = "$PhysicalNames\n4\n0 5 \"corner\"\n1 3 \"left crack\"\n2 9 \"block\"\n\
                     2 4 \"upper half\"\n$EndPhysicalNames\n";

/// A unit square of two triangles, the second clockwise; tags with gaps, in no order; node 77 is
/// an orphan and node 8 has a parametric coordinate.
const NODES: [(u64, [f64; 3]); 5] = [
    (40, [1.0, 1.0, 0.25]),
    (8, [0.0, 0.0, 0.25]),
    (77, [9.0, 9.0, 3.0]),
    (12, [1.0, 0.0, 0.25]),
    (10, [0.0, 1.0, 0.25]),
];

/// The square in MSH 4.1.
pub fn version_4_1(form: Form) -> Vec<u8> {
    let mut file = File::new("4.1", form);
    file.text("$Comments\nnothing $EndNodes here\n$EndComments\n");
    file.text(NAMES);
    file.text("$Entities\n");
    file.sizes(&[1, 2, 2, 0]);
    file.int(1);
    file.reals(&[0.0, 0.0, 0.25]);
    file.size(1);
    file.int(5);
    for (tag, groups) in [(6, vec![-3]), (7, vec![7])] {
        file.int(tag);
        file.reals(&[0.0; 6]);
        file.size(groups.len() as u64);
        groups.iter().for_each(|&g| file.int(g));
        file.size(2);
        file.int(1);
        file.int(-1);
    }
    for (tag, groups) in [(1, vec![9]), (2, vec![4, 9])] {
        file.int(tag);
        file.reals(&[0.0; 6]);
        file.size(groups.len() as u64);
        groups.iter().for_each(|&g| file.int(g));
        file.size(0);
    }
    file.end("Entities");
    file.text("$Nodes\n");
    file.sizes(&[2, 5, 8, 77]);
    let (parametric, plain) = NODES.split_at(2);
    for (nodes, flag, dim) in [(parametric, 1, 1), (plain, 0, 2)] {
        file.int(dim);
        file.int(6);
        file.int(flag);
        file.size(nodes.len() as u64);
        nodes.iter().for_each(|node| file.size(node.0));
        for node in nodes {
            file.reals(&node.1);
            if flag == 1 {
                file.real(0.5);
            }
        }
    }
    file.end("Nodes");
    file.text("$Periodic\n0\n$EndPeriodic\n");
    file.text("$Elements\n");
    file.sizes(&[5, 5, 1, 90]);
    let blocks: [(i32, i32, i32, &[u64]); 5] = [
        (2, 2, 2, &[90, 8, 10, 40]),
        (0, 1, 15, &[1, 8]),
        (2, 1, 2, &[20, 8, 12, 40]),
        (1, 6, 1, &[4, 10, 8]),
        (1, 7, 1, &[3, 8, 12]),
    ];
    for (dim, entity, code, element) in blocks {
        file.int(dim);
        file.int(entity);
        file.int(code);
        file.size(1);
        file.sizes(element);
    }
    file.end("Elements");
    file.bytes
}

/// The same square in MSH 2.2, where the cell of two groups is listed twice.
pub fn version_2_2(form: Form) -> Vec<u8> {
    let mut file = File::new("2.2", form);
    file.text(NAMES);
    file.text("$ParametricNodes\n5\n");
    for (tag, point) in NODES {
        file.int(tag as i32);
        file.reals(&point);
        file.int(1);
        file.int(6);
        file.real(0.5);
        if form == Form::Ascii {
            file.text("\n");
        }
    }
    file.end("ParametricNodes");
    file.text("$Elements\n6\n");
    let elements: [(i32, i32, i32, &[i32]); 6] = [
        (91, 2, 4, &[40, 10, 8]),
        (1, 15, 5, &[8]),
        (90, 2, 9, &[8, 10, 40]),
        (20, 2, 9, &[8, 12, 40]),
        (4, 1, -3, &[10, 8]),
        (3, 1, 7, &[8, 12]),
    ];
    for (tag, code, group, nodes) in elements {
        match form {
            Form::Ascii => [tag, code, 2].map(|v| file.int(v)).to_vec(),
            Form::Binary { .. } => [code, 1, 2, tag].map(|v| file.int(v)).to_vec(),
        };
        file.int(group);
        file.int(1);
        nodes.iter().for_each(|&node| file.int(node));
        if form == Form::Ascii {
            file.text("\n");
        }
    }
    file.end("Elements");
    file.bytes
}
