//! Makes a problem file from a scene and its mesh, or from a built-in scene.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::element::ElementKind;
use contact_dd_partition::error::{InputError, OutputError};
use contact_dd_partition::example::{self, EXAMPLES};
use contact_dd_partition::mesh::{Mesh, gmsh};
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::scene::Scene;

/// Splits a scene into subdomains and writes the problem file that contact-dd-mpi solves.
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES_OF_USE)]
struct Args {
    /// The scene
    #[arg(value_name = "SCENE.toml", required_unless_present_any = ["example", "list_examples"])]
    scene: Option<PathBuf>,

    /// Number of subdomains; without it a number that suits the size
    #[arg(short = 'n', long, value_name = "N", allow_negative_numbers = true)]
    subdomains: Option<usize>,

    /// Problem file to write [default: the scene's name with the ending .h5]
    #[arg(short, long, value_name = "FILE.h5")]
    output: Option<PathBuf>,

    /// Take a built-in scene
    #[arg(long, value_name = "NAME", conflicts_with = "scene")]
    example: Option<String>,

    /// Halve the mesh size of the built-in scene K times
    #[arg(
        long,
        value_name = "K",
        requires = "example",
        conflicts_with = "scene",
        default_value_t = 0
    )]
    refine: u32,

    /// Cells of the built-in scene: triangle3, triangle6, quad4, quad8 or quad9; where the mesh
    /// size changes, there are triangles between quadrilaterals [default: triangle3]
    #[arg(long, value_name = "KIND", requires = "example", conflicts_with = "scene",
          value_parser = element)]
    element: Option<ElementKind>,

    /// Write scene.toml and mesh.msh of the built-in scene into DIR, to start from; the problem
    /// file is then written only with -o
    #[arg(
        long,
        value_name = "DIR",
        requires = "example",
        conflicts_with = "scene"
    )]
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

/// The kind of cells of a name.
fn element(name: &str) -> Result<ElementKind, String> {
    const KINDS: [(&str, ElementKind); 5] = [
        ("triangle3", ElementKind::Triangle3),
        ("triangle6", ElementKind::Triangle6),
        ("quad4", ElementKind::Quad4),
        ("quad8", ElementKind::Quad8),
        ("quad9", ElementKind::Quad9),
    ];
    let found = KINDS.iter().find(|(known, _)| *known == name);
    found.map(|&(_, kind)| kind).ok_or_else(|| {
        let names = KINDS.map(|(known, _)| known);
        format!("expected one of {}", names.join(", "))
    })
}

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
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(usage) if !usage.use_stderr() => usage.exit(),
        Err(usage) => {
            eprintln!("{} (--help tells more)", in_one_line(&usage.to_string()));
            return ExitCode::from(2);
        }
    };
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}

/// What clap says but for the usage and where to read of it.
fn in_one_line(message: &str) -> String {
    let said = message.lines().map(str::trim);
    let said = said.take_while(|line| {
        !line.starts_with("Usage:") && !line.starts_with("For more information")
    });
    let words: Vec<&str> = said.filter(|line| !line.is_empty()).collect();
    words.join(" ").replace(" tip: ", "; ")
}

fn run(args: &Args) -> Result<(), Failure> {
    if args.list_examples {
        for example in EXAMPLES {
            say(&format!("{:<10} {}", example.name, example.about));
        }
        return Ok(());
    }
    let Some(source) = read(args)? else {
        return Ok(());
    };
    let in_scene = |error: InputError| match &args.scene {
        Some(path) => error.in_file(path),
        None => error,
    };
    let model = Model::new(&source.scene, source.mesh).map_err(in_scene)?;
    let decomposition = Decomposition::new(&model, source.subdomains).map_err(in_scene)?;
    let mut problem = Problem::new(&model, &decomposition).map_err(in_scene)?;
    // The user's own partition keeps its numbers.
    if model.prescribed_subdomains.is_none() {
        problem = problem.in_order_of_hierarchy();
    }
    problem.write(&source.output)?;
    report(&problem, &source.output);
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
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        let output = output(args, Path::new(stem));
        keep(path, &output)?;
        keep(&scene.mesh, &output)?;
        return Ok(Some(Source {
            mesh: gmsh::read(&scene.mesh)?,
            scene,
            subdomains: args.subdomains,
            output,
        }));
    }
    let example = example::find(args.example.as_deref().unwrap_or_default())?;
    let mesh = match args.element {
        Some(kind) => example.mesh_of(kind, args.refine)?,
        None => example.mesh(args.refine)?,
    };
    if let Some(directory) = &args.write_scene {
        let scene = example.write(&mesh, directory)?;
        if let Some(output) = &args.output {
            keep(&scene, output)?;
            keep(&directory.join(example::MESH), output)?;
        }
        say(&format!("scene         {}", scene.display()));
        if args.output.is_none() {
            say(&format!(
                "next          contact-dd-partition {}",
                scene.display()
            ));
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

/// Refuses to write over what the problem file is made from.
fn keep(input: &Path, output: &Path) -> Result<(), InputError> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(one), Ok(other)) if one == other => Err(InputError::new(
            "the problem file would take the place of what it is made from; \
             expected another name behind -o",
        )
        .in_file(output)),
        _ => Ok(()),
    }
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
fn report(problem: &Problem, output: &Path) {
    say(&format!("title         {}", problem.catalog.title));
    say(&problem.summary().to_string());
    for warning in &problem.catalog.warnings {
        say(&format!("warning       {warning}"));
    }
    let output = output.display();
    say(&format!("written       {output}"));
    say(&format!(
        "next          mpirun -n 2 contact-dd-mpi {output}"
    ));
}

/// Prints a line. Where nobody reads any more, as behind `| head`, there is nobody to tell.
fn say(line: &str) {
    let _ = writeln!(io::stdout(), "{line}");
}
