//! Makes a problem file from a scene and its mesh, or from a built-in scene.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::error::{InputError, OutputError};
use contact_dd_partition::example::{self, EXAMPLES};
use contact_dd_partition::mesh::{Mesh, gmsh};
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::scene::Scene;

/// Splits a scene into subdomains and writes the problem file that contact-dd-mpi solves.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, after_help = EXAMPLES_OF_USE)]
struct Args {
    /// The scene
    #[arg(value_name = "SCENE.toml", required_unless_present_any = ["example", "list_examples"])]
    scene: Option<PathBuf>,

    /// Number of subdomains; without it a number that suits the size
    #[arg(short = 'n', long, value_name = "N")]
    subdomains: Option<usize>,

    /// Problem file to write [default: the scene's name with the ending .h5]
    #[arg(short, long, value_name = "FILE.h5")]
    output: Option<PathBuf>,

    /// Take a built-in scene
    #[arg(long, value_name = "NAME", conflicts_with = "scene")]
    example: Option<String>,

    /// Halve the mesh size of the built-in scene K times
    #[arg(long, value_name = "K", requires = "example", default_value_t = 0)]
    refine: u32,

    /// Write scene.toml and mesh.msh of the built-in scene into DIR, to start from; the problem
    /// file is then written only with -o
    #[arg(long, value_name = "DIR", requires = "example")]
    write_scene: Option<PathBuf>,

    /// List the built-in scenes
    #[arg(long, exclusive = true)]
    list_examples: bool,
}

const EXAMPLES_OF_USE: &str = "\
Examples:
  contact-dd-partition scene.toml -n 8 -o problem.h5
  contact-dd-partition --example granite --refine 2 -n 8 -o granite.h5
  contact-dd-partition --example junction --write-scene my-scene

Exit codes: 0 done, 2 bad usage or input, 5 the output can't be written.";

/// Why no problem file was written.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Failure {
    fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) => ExitCode::from(2),
            Self::Output(_) => ExitCode::from(5),
        }
    }
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    if args.list_examples {
        for example in EXAMPLES {
            println!("{:<10} {}", example.name, example.about);
        }
        return Ok(());
    }
    let Some(source) = read(args)? else {
        return Ok(());
    };
    let model = Model::new(&source.scene, source.mesh)?;
    let decomposition = Decomposition::new(&model, source.subdomains)?;
    let problem = Problem::new(&model, &decomposition)?;
    problem.write(&source.output)?;
    report(&model, &problem, &source.output);
    Ok(())
}

/// What the problem file is made from, and where it goes.
struct Source {
    scene: Scene,
    mesh: Mesh,
    subdomains: Option<usize>,
    output: PathBuf,
}

/// Reads or makes scene and mesh; `None` where nothing but these was asked for.
fn read(args: &Args) -> Result<Option<Source>, Failure> {
    if let Some(path) = &args.scene {
        let scene = Scene::read(path)?;
        let mesh = gmsh::read(&scene.mesh)?;
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        return Ok(Some(Source {
            scene,
            mesh,
            subdomains: args.subdomains,
            output: output(args, Path::new(stem)),
        }));
    }
    let example = example::find(args.example.as_deref().unwrap_or_default())?;
    let mesh = example.mesh(args.refine)?;
    if let Some(directory) = &args.write_scene {
        let scene = example.write(&mesh, directory)?;
        println!("scene         {}", scene.display());
        if args.output.is_none() {
            println!("next          contact-dd-partition {}", scene.display());
            return Ok(None);
        }
    }
    Ok(Some(Source {
        scene: Scene::parse(example.scene)?,
        mesh,
        subdomains: args.subdomains.or(Some(example.subdomains)),
        output: output(args, Path::new(example.name)),
    }))
}

fn output(args: &Args, stem: &Path) -> PathBuf {
    let chosen = args.output.clone();
    chosen.unwrap_or_else(|| {
        let mut name = stem.as_os_str().to_os_string();
        name.push(".h5");
        name.into()
    })
}

/// Prints what the problem file holds and what to do with it.
fn report(model: &Model, problem: &Problem, output: &Path) {
    let catalog = &problem.catalog;
    let cells = catalog.subdomains.iter().map(|s| s.cells);
    let mean = cells.clone().sum::<usize>() as f64 / catalog.subdomains.len().max(1) as f64;
    let balance = cells.max().unwrap_or_default() as f64 / mean;
    let (nodes, dim) = (model.mesh.points.len(), catalog.dim);
    let conditions: usize = catalog.groups.iter().sum();

    println!("title         {}", catalog.title);
    println!(
        "mesh          {nodes} nodes, {} cells",
        model.mesh.cells.len()
    );
    println!("dofs          {}", nodes * dim);
    println!(
        "subdomains    {}, {} in contact",
        catalog.subdomains.len(),
        catalog
            .subdomains
            .iter()
            .filter(|s| s.group.is_some())
            .count()
    );
    println!("balance       {balance:.2} (largest subdomain over the mean, by cells)");
    println!(
        "interface     {} nodes, {} dofs",
        catalog.interface_nodes,
        catalog.interface_nodes * dim
    );
    println!("contact       {conditions} conditions");
    for contact in &catalog.contacts {
        println!(
            "              {:>6} on {}",
            contact.conditions, contact.name
        );
    }
    println!("groups        {}", groups(problem));
    for warning in &catalog.warnings {
        println!("warning       {warning}");
    }
    println!("written       {}", output.display());
    println!(
        "next          mpirun -n 2 contact-dd-mpi {}",
        output.display()
    );
}

/// How many subdomains the groups in contact have, in words.
fn groups(problem: &Problem) -> String {
    let mut sizes = vec![0; problem.catalog.groups.len()];
    for subdomain in &problem.catalog.subdomains {
        if let Some(group) = subdomain.group {
            sizes[group] += 1;
        }
    }
    let count = |wanted: fn(usize) -> bool| sizes.iter().filter(|&&size| wanted(size)).count();
    let words = [
        (count(|size| size == 1), "single"),
        (count(|size| size == 2), "in pairs"),
        (count(|size| size > 2), "larger"),
    ];
    let words: Vec<String> = words
        .into_iter()
        .filter(|&(count, _)| count > 0)
        .map(|(count, word)| format!("{count} {word}"))
        .collect();
    match words.is_empty() {
        true => "none".into(),
        false => words.join(", "),
    }
}
