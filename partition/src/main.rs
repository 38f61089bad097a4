//! `contact-dd-partition`: makes a problem file from a scene and its mesh, or from a built-in scene.

use std::ffi::{c_int, c_void};
use std::fs::File;
use std::io::stdout;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::ptr::null_mut;

use clap::{CommandFactory, Parser};
use contact_dd_partition::allocator::Allocator;
use contact_dd_partition::command_line::{CommandLine, MANUAL};
use contact_dd_partition::deck;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::destination;
use contact_dd_partition::error::{InputError, OutputError};
use contact_dd_partition::example::{self, EXAMPLES};
use contact_dd_partition::explanation::{Explanation, with_name};
use contact_dd_partition::hierarchy::work::Work;
use contact_dd_partition::info::Info;
use contact_dd_partition::manual::Answer;
use contact_dd_partition::mesh::{self, Mesh};
use contact_dd_partition::message::{self, WARNING};
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::{Problem, trial};
use contact_dd_partition::scene::Scene;
use rustix::stdio::dup2_stdout;

/// Reason why no problem file was written.
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

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

fn main() -> ExitCode {
    if let Some(code) = trial::answer() {
        return code;
    }
    let args = match CommandLine::try_parse() {
        Ok(args) => args,
        Err(error) => {
            return Answer::of(&error).print();
        }
    };
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            message::error(&failure.to_string());
            failure.exit_code()
        }
    }
}

fn run(args: &CommandLine) -> Result<(), Failure> {
    if let Some(document) = args.generate {
        return Ok(message::print(
            &MANUAL.write(document, CommandLine::command()),
        )?);
    }
    if let Some(name) = &args.explain {
        return Ok(message::print(&Explanation::named(name)?.text())?);
    }
    if args.list_examples {
        for example in EXAMPLES {
            print_line(&format!("{:<10} {}", example.name, example.about))?;
        }
        return Ok(());
    }
    if let Some(path) = &args.info {
        trial::check(path, || false)?;
        print_line(&Info::read(path)?.to_string())?;
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
    let mut problem = without_stdout(|| split(&model, source.subdomains)).map_err(in_scene)?;
    if args.clusters.is_some() {
        problem.catalog.choose_clusters(args.clusters);
    }
    problem.write(&source.output)?;
    report(&problem, &model.found, &source.output)?;
    Ok(())
}

/// Splits a model into subdomains.
fn split(model: &Model, subdomains: Option<usize>) -> Result<Problem, InputError> {
    let decomposition = Decomposition::new(model, subdomains)?;
    Problem::new(model, &decomposition)
}

/// Runs `work` with the output of C libraries discarded: METIS writes remarks to stdout.
fn without_stdout<T>(work: impl FnOnce() -> T) -> T {
    unsafe extern "C" {
        fn fflush(stream: *mut c_void) -> c_int;
    }
    let kept = rustix::io::dup(stdout());
    let nowhere = File::options().write(true).open("/dev/null");
    let (Ok(kept), Ok(nowhere)) = (kept, nowhere) else {
        return work();
    };
    // If stdout can't be redirected, the remarks are printed.
    let _ = dup2_stdout(nowhere);
    let done = work();
    // SAFETY: with a null pointer fflush flushes the buffers of all streams of the C library.
    unsafe { fflush(null_mut()) };
    let _ = dup2_stdout(kept);
    done
}

/// Sources of the problem file, and its destination.
struct Source {
    scene: Scene,
    mesh: Mesh,
    subdomains: Option<usize>,
    output: PathBuf,
}

/// Reads or makes scene and mesh; `None` if nothing else was requested.
fn read(args: &CommandLine) -> Result<Option<Source>, Failure> {
    if let Some(path) = args.scene.as_ref().filter(|path| deck::is_one(path)) {
        return read_deck(args, path);
    }
    if let Some(path) = &args.scene {
        if args.write_scene.is_some() {
            let message = "is a scene already; expected a deck, or --example, beside --write-scene";
            return Err(InputError::new(message).in_file(path).into());
        }
        if args.write_prints.is_some() {
            let message =
                "is a scene, which requests no tables; expected a deck beside --write-prints";
            return Err(InputError::new(message).in_file(path).into());
        }
        let scene = Scene::read(path)?;
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        let output = output(args, Path::new(stem));
        keep(path, &output)?;
        for file in mesh::files(&scene.mesh, &output) {
            keep(&file, &output)?;
        }
        return Ok(Some(Source {
            mesh: mesh::read(&scene.mesh)?.along_curve(),
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
        if !goes_on(args, &scene)? {
            return Ok(None);
        }
    }
    Ok(Some(Source {
        scene: Scene::parse(example.scene)?,
        mesh,
        subdomains: (args.subdomains).or((args.refine == 0).then_some(example.subdomains)),
        output: output(args, Path::new(example.name)),
    }))
}

/// Reads a deck, and writes its scene and mesh if requested.
fn read_deck(args: &CommandLine, path: &Path) -> Result<Option<Source>, Failure> {
    let translation = deck::read(path)?;
    if let Some(file) = &args.write_prints {
        let text = serde_json::to_string(&translation.prints)
            .map_err(|error| destination::failure(file, error))?;
        destination::write_bytes(file, |out| out.write_all(text.as_bytes()))?;
    }
    if let Some(directory) = &args.write_scene {
        if !translation.mesh.has_modes.is_empty() {
            let message = "has elements with incompatible modes, which Gmsh's format can't express; expected C3D8, CPE4 or \
                           CPS4 beside --write-scene";
            return Err(InputError::new(message).in_file(path).into());
        }
        let scene = translation.write(directory)?;
        if !goes_on(args, &scene)? {
            return Ok(None);
        }
    }
    let output = output(
        args,
        Path::new(path.file_stem().unwrap_or(path.as_os_str())),
    );
    for file in &translation.files {
        keep(file, &output)?;
    }
    let mut scene = Scene::parse(&translation.scene).map_err(|error| {
        let message = format!("as a scene, which --write-scene writes: {error}");
        InputError::new(message).in_file(path)
    })?;
    // Errors of the mesh name the file that the user has.
    scene.mesh = path.to_path_buf();
    Ok(Some(Source {
        scene,
        mesh: translation.mesh.along_curve(),
        subdomains: args.subdomains,
        output,
    }))
}

/// Prints where a scene was written and, without a requested problem file, the next command; true if a problem file was
/// requested.
fn goes_on(args: &CommandLine, scene: &Path) -> Result<bool, Failure> {
    if let Some(output) = &args.output {
        keep(scene, output)?;
        keep(&scene.with_file_name(example::MESH), output)?;
    }
    let scene = scene.display();
    print_line(&format!("scene         {scene}"))?;
    if args.output.is_none() {
        print_line(&format!("next          contact-dd-partition {scene}"))?;
    }
    Ok(args.output.is_some())
}

/// Refuses to overwrite an input of the problem file.
fn keep(input: &Path, output: &Path) -> Result<(), InputError> {
    match (input.canonicalize(), output.canonicalize()) {
        (Ok(one), Ok(other)) if one == other => Err(InputError::new(
            "the problem file would overwrite its input; expected another name behind -o",
        )
        .in_file(output)),
        _ => Ok(()),
    }
}

fn output(args: &CommandLine, stem: &Path) -> PathBuf {
    let chosen = args.output.clone();
    chosen.unwrap_or_else(|| {
        let mut name = stem.as_os_str().to_os_string();
        name.push(".h5");
        name.into()
    })
}

/// Prints the content of the problem file, the contacts that were `found`, and the next command.
fn report(problem: &Problem, found: &[String], output: &Path) -> Result<(), OutputError> {
    if !problem.catalog.title.is_empty() {
        print_line(&format!("title         {}", problem.catalog.title))?;
    }
    print_line(&problem.summary().to_string())?;
    if !problem.catalog.solver.is_empty() {
        print_line(&format!("settings      {}", problem.catalog.solver))?;
    }
    for contact in found {
        print_line(&format!("found         {contact}"))?;
    }
    for warning in &problem.catalog.warnings {
        let warning = with_name(warning);
        print_line(&format!("{WARNING}warning{WARNING:#}       {warning}"))?;
    }
    let output = output.display();
    print_line(&format!("written       {output}"))?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let launcher = match Work::new(&problem.catalog).useful_ranks().min(cores) {
        1 => String::new(),
        ranks => format!("mpirun -n {ranks} "),
    };
    print_line(&format!("next          {launcher}contact-dd-mpi {output}"))
}

/// Prints a line.
fn print_line(line: &str) -> Result<(), OutputError> {
    message::print(&format!("{line}\n"))
}
