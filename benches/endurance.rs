//! Prints what a batch of 100 000 files needs, interrupted after a minute and resumed, and what a file of a million rows needs: `cargo run --release --example endurance > benches/results/endurance.md`. For Linux.
//!
//! With arguments this is the program `brdfit` itself, so that its memory is that of a process of its own.

use std::env;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Write as _, stderr, stdin, stdout};
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use brdfit::cli;
use brdfit::interrupt;
use brdfit::streams::Streams;
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;

/// Files of each batch; the last is the one that the report is about.
const FILES: [usize; 3] = [1_000, 10_000, 100_000];
/// The long batch is interrupted after this.
const PATIENCE: Duration = Duration::from_secs(60);
/// Rows of one large file.
const ROWS: usize = 1_000_000;

fn main() -> ExitCode {
    if env::args_os().len() > 1 {
        interrupt::listen();
        return ExitCode::from(cli::run(
            env::args_os(),
            &mut Streams {
                input: &mut stdin(),
                output: &mut stdout(),
                errors: &mut stderr(),
                progress: false,
                color: false,
                quiet: false,
            },
        ));
    }
    let root = tempfile::tempdir().expect("a folder");
    println!("# Endurance\n");
    println!(
        "Scans of 41 samples each, one file a scan, all with other parameters and 2 % noise; the default search, results as CSV, on {} threads of this machine.",
        std::thread::available_parallelism().map_or(1, usize::from)
    );
    println!(
        "A batch that takes longer than {} s is interrupted then and resumed, until it is done.",
        PATIENCE.as_secs()
    );
    println!("Memory is the largest resident set of the process.");
    println!("Regenerate: `cargo run --release --example endurance > benches/results/endurance.md`.\n");
    println!("| files | run | ended | files done | time, s | memory, MB |");
    println!("|--:|--:|---|--:|--:|--:|");
    for files in FILES {
        batch(root.path(), files);
    }
    println!("\nOne file of {ROWS} rows, diffuse term only:\n");
    println!("| size of the file, MB | time, s | memory, MB |");
    println!("|--:|--:|--:|");
    large(root.path());
    ExitCode::SUCCESS
}

/// Runs a batch until it is done.
fn batch(root: &Path, files: usize) {
    let folder = root.join(files.to_string());
    fs::create_dir(&folder).expect("a folder");
    for index in 0..files {
        fs::write(folder.join(format!("{index:06}.csv")), scan(index)).expect("a file");
    }
    let out = root.join(format!("{files}.csv"));
    for run in 1.. {
        let mut command = Command::new(env::current_exe().expect("this program"));
        command.args(["batch", "--resume", "--out"]).arg(&out).arg(&folder);
        let ran = measured(&mut command);
        let done = match fs::File::open(&out) {
            Ok(_) => rows(&out) - 1,
            Err(_) => rows(&root.join(format!("{files}.csv.partial"))) - 1,
        };
        println!(
            "| {files} | {run} | {} | {done} | {:.1} | {:.1} |",
            if ran.code == 0 { "done" } else { "interrupted" },
            ran.time.as_secs_f64(),
            ran.memory
        );
        match ran.code {
            0 => break,
            130 => {}
            code => panic!("exit code {code}: {}", ran.errors),
        }
    }
    assert_eq!(rows(&out), files + 1, "a head and one row a file");
}

/// Fits a file of many rows.
fn large(root: &Path) {
    let path = root.join("large.csv");
    let mut file = BufWriter::new(File::create(&path).expect("a file"));
    writeln!(file, "theta_i_deg,theta_s_deg,brdf_per_sr").expect("room");
    for row in 0..ROWS {
        let theta_s = -80.0 + 160.0 * row as f64 / ROWS as f64;
        writeln!(file, "45,{theta_s:.6},{:.9}", 0.03 * (1.0 + 0.02 * noise(row, 7))).expect("room");
    }
    drop(file);
    let size = fs::metadata(&path).expect("the file").len();
    let mut command = Command::new(env::current_exe().expect("this program"));
    command
        .arg("fit")
        .arg(&path)
        .args(["--terms", "diffuse", "--format", "json"]);
    let ran = measured(&mut command);
    assert_eq!(ran.code, 0, "{}", ran.errors);
    println!(
        "| {:.1} | {:.1} | {:.1} |",
        size as f64 / 1e6,
        ran.time.as_secs_f64(),
        ran.memory
    );
}

/// A scan at 45 degrees with parameters of its own.
fn scan(index: usize) -> String {
    let part = |step: f64| (index as f64 * step).fract();
    let params = Params {
        rho_d: 0.02 + 0.2 * part(0.618_033_988_749),
        rho_s: 1.0 + 20.0 * part(0.754_877_666_246),
        rho_v: 0.0,
        m: 0.08 + 0.2 * part(0.569_840_290_998),
        n: 1.4 + part(0.819_172_513_396),
        kappa: 0.0,
    };
    let brdf = Brdf::<f64, ALL>::new(&params);
    let mut text = String::from("theta_i_deg,theta_s_deg,brdf_per_sr\n");
    for theta_s in (-80i32..=80).step_by(4) {
        let angles = [45.0, f64::from(theta_s)].map(f64::to_radians);
        let geometry = Geometry::new(angles[0], angles[1], f64::PI).expect("above the horizon");
        let f = Real::portable_exp(brdf.ln_f(&geometry)) * (1.0 + 0.02 * noise(index, theta_s as usize));
        let _ = writeln!(text, "45,{theta_s},{f:.6e}");
    }
    text
}

/// From -1 to 1.
fn noise(a: usize, b: usize) -> f64 {
    let mixed = (a as u64 ^ (b as u64).rotate_left(32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    2.0 * f64::unit(mixed ^ mixed >> 32) - 1.0
}

fn rows(path: &Path) -> usize {
    let bytes = fs::read(path).unwrap_or_default();
    bytes.iter().filter(|&&byte| byte == b'\n').count()
}

/// How a process ended.
struct Ran {
    code: i32,
    time: Duration,
    /// The largest resident set, MB.
    memory: f64,
    errors: String,
}

/// Runs a process, and interrupts it when patience ends.
fn measured(command: &mut Command) -> Ran {
    let begun = Instant::now();
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a process");
    let status = format!("/proc/{}/status", child.id());
    let (mut memory, mut asked) = (0.0, false);
    let code = loop {
        // A process that has ended has no memory any more.
        let high = fs::read_to_string(&status).unwrap_or_default();
        let high = high
            .lines()
            .find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB")?.trim().parse().ok());
        memory = f64::max(memory, high.map_or(0.0, |kilobytes: f64| kilobytes * 1024.0 / 1e6));
        if let Some(status) = child.try_wait().expect("a child") {
            break status.code().unwrap_or(-1);
        }
        if begun.elapsed() > PATIENCE && !asked {
            asked = true;
            let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
            assert!(sent.expect("kill").success());
        }
        sleep(Duration::from_millis(20));
    };
    let mut errors = String::new();
    let _ = child.stderr.take().expect("a pipe").read_to_string(&mut errors);
    Ran {
        code,
        time: begun.elapsed(),
        memory,
        errors,
    }
}
