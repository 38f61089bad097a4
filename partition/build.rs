//! Lists the built-in scenes: each is a folder of `src/example` with a `mesh.rs`.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("src/example");
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut meshes: Vec<(String, PathBuf)> = Vec::new();
    for entry in fs::read_dir(&folder)? {
        let entry = entry?;
        let mesh = entry.path().join("mesh.rs");
        if mesh.is_file() {
            meshes.push((entry.file_name().to_string_lossy().into_owned(), mesh));
        }
    }
    meshes.sort();
    let mut code = String::new();
    for (name, mesh) in &meshes {
        let module = module(name);
        code += &format!("#[path = {mesh:?}]\nmod {module};\n");
    }
    code += "/// The built-in scenes.\npub const EXAMPLES: &[Example] = &[\n";
    for (name, mesh) in &meshes {
        let module = module(name);
        code += &format!(
            "Example {{ name: {name:?}, about: {module}::ABOUT, subdomains: {module}::SUBDOMAINS, \
             scene: include_str!({:?}), shape: {module}::SHAPE }},\n",
            mesh.with_file_name("scene.toml")
        );
    }
    code += "];\n";
    fs::write(Path::new(&env::var("OUT_DIR")?).join("scenes.rs"), code)?;
    Ok(())
}

/// The module of a scene.
fn module(name: &str) -> String {
    name.replace('-', "_")
}
