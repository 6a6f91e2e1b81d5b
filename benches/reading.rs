//! Reading of files on one core: bytes a second, each format at two sizes, which tell that the time grows no faster than the file.
//!
//! The time is that of the thread, so that other work on the machine counts little.
//!
//! `cargo bench --bench reading`, or as a table `cargo bench --bench reading -- --table > benches/results/reading.md`;
//! `-- --table wavelengths` has the formats of such a name only.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use brdfit::input::{self, ReadOptions};
use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use rustix::time::{ClockId, clock_gettime};

/// Rows of the smaller file; the larger has four times as many.
const ROWS: usize = 20_000;

/// One made-up row: theta_i, theta_s and BRDF with the digits that instruments write.
fn row(k: usize) -> (usize, f64, f64) {
    let (theta_i, theta_s) = (k / 1601, (k % 1601) as f64 / 10.0 - 80.0);
    (theta_i, theta_s, 0.01 + ((k * 7919) % 99_991) as f64 * 1e-6)
}

/// A table with this between its cells and at the ends of its lines.
fn table(rows: usize, between: &str, end: &str) -> Vec<u8> {
    let mut text = format!("theta_i_deg{between}theta_s_deg{between}brdf_per_sr{end}");
    for (theta_i, theta_s, f) in (0..rows).map(row) {
        let _ = write!(text, "{theta_i}{between}{theta_s:.1}{between}{f:.6}{end}");
    }
    text.into_bytes()
}

/// A table whose rows each have a wavelength of their own, and their directions in all of them.
fn wavelengths(rows: usize) -> Vec<u8> {
    let mut text = String::from("wavelength_nm,theta_i,theta_s,brdf\n");
    for theta_s in [-40, 20] {
        for k in 0..rows / 2 {
            let _ = writeln!(text, "{},30,{theta_s},{:.6}", 400.0 + k as f64 / 100.0, row(k).2);
        }
    }
    text.into_bytes()
}

/// Few rows of many columns, one for each wavelength.
fn columns(cells: usize) -> Vec<u8> {
    let mut text = String::from("theta_i,theta_s");
    (0..cells / 4).for_each(|k| text += &format!(",{} nm", 400.0 + k as f64 / 100.0));
    for theta_s in [-40, -20, 20, 40] {
        let _ = write!(text, "\n30,{theta_s}");
        (0..cells / 4).for_each(|k| text += &format!(",{:.6}", row(k).2));
    }
    text.into_bytes()
}

/// A matrix of 20 angles of incidence.
fn matrix(cells: usize) -> Vec<u8> {
    let mut text = String::from("theta_s");
    (0..20).for_each(|k| text += &format!("\t{}", 4 * k));
    for k in 0..cells / 20 {
        let _ = write!(text, "\n{:.4}", k as f64 * 3200.0 / cells as f64 - 80.0);
        (0..20).for_each(|i| text += &format!("\t{:.6}", row(k * 20 + i).2));
    }
    text.into_bytes()
}

fn astm(rows: usize) -> Vec<u8> {
    let mut text = format!("LAB_NAME none\nNUM_POINTS {rows}\nVARS theta_i,phi_i,theta_s,phi_s,Integrated\n\n");
    for (theta_i, theta_s, f) in (0..rows).map(row) {
        let phi = if theta_s < 0.0 { 0.0 } else { std::f64::consts::PI };
        let (i, s) = ((theta_i as f64).to_radians(), theta_s.abs().to_radians());
        let _ = writeln!(text, "{i:.6},0.000000,{s:.6},{phi:.6},{f:.6}");
    }
    text.into_bytes()
}

/// Rows of a look-up table in JSON.
fn openmaterial(rows: usize) -> Vec<u8> {
    let mut text = String::from("{\"metadata\": {}, \"brdf\": {\"wavelengths\": [5.5e-07], \"lookupTable\": [\n");
    for (k, (theta_i, theta_s, f)) in (0..rows).map(row).enumerate() {
        let phi = if theta_s < 0.0 { 0.0 } else { std::f64::consts::PI };
        let (i, s) = ((theta_i as f64).to_radians(), theta_s.abs().to_radians());
        let comma = if k == 0 { "" } else { ",\n" };
        let _ = write!(text, "{comma}[5.5e-07, {i:.6}, {s:.6}, {phi}, {f:.6}]");
    }
    (text + "]}}\n").into_bytes()
}

/// A grid of 40 azimuths at 9 angles of incidence.
fn zemax(cells: usize) -> Vec<u8> {
    let radials = cells / 360;
    let list = |count: usize, step: f64| -> String {
        let each = (0..count).map(|k| format!("{:.4}", k as f64 * step));
        each.collect::<Vec<_>>().join("\t")
    };
    let mut text = format!(
        "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n\
         AngleOfIncidence 9\n{}\nScatterAzimuth 40\n{}\nScatterRadial {radials}\n{}\n\nMonochrome\nDataBegin\n",
        list(9, 8.0),
        list(40, 4.5),
        list(radials, 20.0 / radials as f64)
    );
    for incidence in 0..9 {
        text += "TIS 0.1\n";
        for azimuth in 0..40 {
            let values = (0..radials).map(|k| format!("{:.3e}", row(incidence * 7 + azimuth * 11 + k).2));
            text += &(values.collect::<Vec<_>>().join("\t") + "\n");
        }
    }
    (text + "DataEnd\n").into_bytes()
}

/// Angles of incidence of the files below, degrees.
const INCIDENCE: [usize; 4] = [10, 30, 50, 70];

/// Scattering angles of so many rows at each angle of incidence, with a BRDF each.
fn sweeps(rows: usize) -> impl Iterator<Item = (usize, Vec<(f64, f64)>)> {
    let count = rows / INCIDENCE.len();
    let step = 160.0 / count as f64;
    INCIDENCE.into_iter().map(move |theta_i| {
        let each = (0..count).map(|k| (k as f64 * step - 80.0, row(theta_i * count + k).2));
        (theta_i, each.collect())
    })
}

fn fred(rows: usize) -> Vec<u8> {
    let mut text = String::from("type bsdf_data\nformat angles=deg bsdf=value scale=1\n");
    for (theta_i, sweep) in sweeps(rows) {
        let _ = writeln!(text, "{theta_i}\t0");
        for (theta_s, f) in sweep {
            let _ = writeln!(text, "{theta_s:.5}\t0\t{f:.6}");
        }
    }
    text.into_bytes()
}

fn lumos(rows: usize) -> Vec<u8> {
    let mut text = String::from("# phi_i     theta_i     phi_o     theta_o     brdf\n");
    for (theta_i, sweep) in sweeps(rows) {
        for (theta_s, f) in sweep {
            let _ = writeln!(text, "{theta_i}     -180.00     {theta_s:.5}     0.00     {f:.5e}");
        }
    }
    text.into_bytes()
}

/// One angle of incidence, as the format has it.
fn pabopto(rows: usize) -> Vec<u8> {
    let mut text = String::from("#data written using a test\n#format: theta phi BRDF\n#intheta 30\n#inphi 0\n");
    for k in 0..rows {
        let _ = writeln!(text, "{:.5} 180 {:.6}", k as f64 * 80.0 / rows as f64, row(k).2);
    }
    text.into_bytes()
}

/// Scattering angles and two azimuths at each angle of incidence.
fn ssdd(cells: usize) -> Vec<u8> {
    let count = cells / (2 * INCIDENCE.len());
    let mut text = String::from(
        "VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\nREDUCTION_TYPE bilateral_symmetry\nPARAM0_LIST",
    );
    INCIDENCE.iter().for_each(|theta_i| text += &format!(" {theta_i}"));
    text += "\nPARAM1_LIST 0\nPARAM2_LIST";
    (0..count).for_each(|k| text += &format!(" {:.5}", k as f64 * 80.0 / count as f64));
    text += "\nPARAM3_LIST 0 180\nDATA ascii\n";
    (0..cells).for_each(|k| text += &format!("{:.6} ", row(k).2));
    (text + "\n").into_bytes()
}

/// Scattering angles and three azimuths at one angle of incidence.
fn lighttools(cells: usize) -> Vec<u8> {
    let count = cells / 3;
    let mut text = format!(
        "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 3\n0 90 180\nScatterRadial {count}\n"
    );
    (0..count).for_each(|k| text += &format!("{:.5} ", k as f64 * 80.0 / count as f64));
    text += "\nDataBegin\nAOI 30\nPOI 90\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.5\n";
    for line in 0..3 {
        (0..count).for_each(|k| text += &format!("{:.6} ", row(line * count + k).2));
        text.push('\n');
    }
    (text + "DataEnd\n").into_bytes()
}

/// Scattering angles and four azimuths at one angle of incidence.
fn speos(cells: usize) -> Vec<u8> {
    let count = cells / 4;
    let mut text = format!(
        "OPTIS - brdf surface file v8.0\n0\nmade up\n5\n-----\n1\t1\n1\n1\t1\n30\n550\n20\n{count}\t4\n\t0\t90\t180\t270\n"
    );
    for k in 0..count {
        let _ = write!(text, "{:.5}", k as f64 * 80.0 / count as f64);
        (0..4).for_each(|azimuth| text += &format!("\t{:.6}", row(k * 4 + azimuth).2));
        text.push('\n');
    }
    (text + "End of file\n").into_bytes()
}

/// Columns of numbers in JSON.
fn bird(rows: usize) -> Vec<u8> {
    let list = |of: &dyn Fn(usize) -> f64| -> String {
        let values: Vec<String> = (0..rows).map(|k| format!("{:.6}", of(k))).collect();
        values.join(", ")
    };
    let column = |name: &str, kind: &str, unit: &str, values: String| {
        format!("\"{name}\": {{\"type\": \"{kind}\", \"unit\": \"{unit}\", \"values\": [{values}]}}")
    };
    let columns = [
        column("theta_i", "independent", "deg", list(&|k| row(k).0 as f64)),
        column("phi_i", "independent", "deg", list(&|_| 0.0)),
        column("theta_r", "independent", "deg", list(&|k| row(k).1.abs())),
        column(
            "phi_r",
            "independent",
            "deg",
            list(&|k| if row(k).1 < 0.0 { 0.0 } else { 180.0 }),
        ),
        column("BRDF", "dependent", "sr^-1", list(&|k| row(k).2)),
    ];
    let schema =
        "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/brdf_json_schema_v1.0.json";
    format!(
        "{{\"metadata\": {{\"schema\": \"{schema}\", \"type\": \"BRDF\"}}, \"data\": {{{}}}}}\n",
        columns.join(",\n")
    )
    .into_bytes()
}

/// Time of this thread on a processor.
struct ThreadTime;

impl ThreadTime {
    fn now() -> Duration {
        let now = clock_gettime(ClockId::ThreadCPUTime);
        Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec as u32)
    }
}

impl Measurement for ThreadTime {
    type Intermediate = Duration;
    type Value = Duration;

    fn start(&self) -> Duration {
        ThreadTime::now()
    }
    fn end(&self, start: Duration) -> Duration {
        ThreadTime::now() - start
    }
    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }
    fn zero(&self) -> Duration {
        Duration::ZERO
    }
    fn to_f64(&self, value: &Duration) -> f64 {
        value.as_nanos() as f64
    }
    fn formatter(&self) -> &dyn ValueFormatter {
        WallTime.formatter()
    }
}

type Written = fn(usize) -> Vec<u8>;

/// The formats, with what makes a file of so many numbers.
const FILES: [(&str, Written); 17] = [
    ("CSV", |rows| table(rows, ",", "\n")),
    ("CSV, CR LF", |rows| table(rows, ",", "\r\n")),
    ("CSV, CR", |rows| table(rows, ",", "\r")),
    ("spaces", |rows| table(rows, "  ", "\n")),
    ("wavelengths in rows", wavelengths),
    ("wavelengths in columns", columns),
    ("matrix", matrix),
    ("ASTM", astm),
    ("OpenMATERIAL", openmaterial),
    ("Zemax", zemax),
    ("BiRD", bird),
    ("FRED", fred),
    ("LUMOS", lumos),
    ("pab-opto", pabopto),
    ("SSDD", ssdd),
    ("LightTools", lighttools),
    ("Speos", speos),
];

fn read(name: &str, bytes: &[u8]) {
    let options = ReadOptions {
        drop_invalid: true,
        ..ReadOptions::default()
    };
    let read = input::parse("file", black_box(bytes), &options);
    black_box(read.unwrap_or_else(|error| panic!("{name}: {error}")));
}

fn reading(criterion: &mut Criterion<ThreadTime>) {
    let mut group = criterion.benchmark_group("reading");
    for (name, file) in FILES {
        for rows in [ROWS, 4 * ROWS] {
            let bytes = file(rows);
            group.throughput(Throughput::Bytes(bytes.len() as u64));
            group.bench_function(BenchmarkId::new(name, rows), |b| b.iter(|| read(name, &bytes)));
        }
    }
    group.finish();
}

/// The least of many times at each size: what disturbs makes them longer only.
fn print_table(wanted: &str) {
    const TIMES: usize = 15;
    println!("# Reading\n");
    println!("Files in memory, read on one thread to samples; the least thread time of {TIMES} readings.");
    println!("Regenerate: `cargo bench --bench reading -- --table > benches/results/reading.md`.\n");
    println!("The last column is the time a byte at the larger size over that at the smaller: 1 is linear.");
    println!(
        "MERL and RGL files have one size, and of workbooks each sheet is read as the table that it would be as CSV.\n"
    );
    println!("| format | MB | MB/s | MB | MB/s | time a byte |");
    println!("|---|--:|--:|--:|--:|--:|");
    for (name, file) in FILES.into_iter().filter(|(name, _)| name.contains(wanted)) {
        let [small, large] = [ROWS, 4 * ROWS].map(|rows| {
            let bytes = file(rows);
            let times = (0..TIMES).map(|_| {
                let begun = ThreadTime::now();
                read(name, &bytes);
                ThreadTime::now() - begun
            });
            let size = bytes.len() as f64 / 1e6;
            (size, size / times.min().unwrap_or_default().as_secs_f64())
        });
        println!(
            "| {name} | {:.2} | {:.0} | {:.2} | {:.0} | {:.2} |",
            small.0,
            small.1,
            large.0,
            large.1,
            small.1 / large.1
        );
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ThreadTime).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(2)).sample_size(10);
    targets = reading
}

fn main() {
    let mut arguments = std::env::args();
    if arguments.any(|argument| argument == "--table") {
        let wanted = arguments.find(|argument| !argument.starts_with('-'));
        return print_table(&wanted.unwrap_or_default());
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
