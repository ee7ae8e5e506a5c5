//! Maps as other people's programs read them: xarray, h5py, netCDF4, ncdump, h5dump, Octave, R and
//! Julia. A test whose program is missing fails; `scripts/test.sh` leaves such a test out and says
//! so.
//!
//! Each map comes from the program itself; what must be in it comes from the library, cell by cell,
//! and is handed to the Python programs in `readers/` as a folder with `expected.json` and raw
//! arrays.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Map, Value, json};
use slipmap::linear::rightmost::Rightmost;
use slipmap::linear::status::{CERTIFIED, FLAGS, MARGINAL};
use slipmap::linear::{Crossings, MarginalTolerance};
use slipmap::model::{FrictionLaw, Groups};
use slipmap::setting::axis::{Spacing, spaced};
use tempfile::TempDir;

/// The groups of a cell and its unit of time, from the values of the axes.
type GroupsAt = fn(&[f64]) -> (Groups, f64);

/// A sweep, and what the map of it must hold.
struct Case {
    title: &'static str,
    /// The sweep file without its axes.
    head: &'static str,
    /// Name, unit, values and how the sweep file writes them.
    axes: Vec<Axis>,
    /// Name, unit and value of every parameter that is no axis and has a meaning.
    scalars: &'static [(&'static str, &'static str, f64)],
    margin_unit: &'static str,
    omega_unit: &'static str,
    /// The parameter that spans the planes of the crossing curves, with the delay.
    plane: &'static str,
    groups_at: GroupsAt,
}

struct Axis {
    name: &'static str,
    unit: &'static str,
    values: Vec<f64>,
    toml: String,
}

impl Axis {
    fn list(name: &'static str, unit: &'static str, values: &[f64]) -> Self {
        Self {
            name,
            unit,
            values: values.to_vec(),
            toml: format!("{values:?}"),
        }
    }

    fn range(name: &'static str, unit: &'static str, ends: (f64, f64), points: u64) -> Self {
        Self::spaced(name, unit, ends, points, Spacing::Linear)
    }

    fn log(name: &'static str, unit: &'static str, ends: (f64, f64), points: u64) -> Self {
        Self::spaced(name, unit, ends, points, Spacing::Log)
    }

    fn spaced(
        name: &'static str,
        unit: &'static str,
        (from, to): (f64, f64),
        points: u64,
        spacing: Spacing,
    ) -> Self {
        let word = match spacing {
            Spacing::Linear => "linear",
            Spacing::Log => "log",
        };
        Self {
            name,
            unit,
            values: spaced(from, to, points, spacing).expect("a good axis"),
            toml: format!(
                "{{ from = {from:?}, to = {to:?}, points = {points}, spacing = \"{word}\" }}"
            ),
        }
    }
}

/// Three axes of different lengths, one of them falling; everything dimensionless.
fn load_control() -> Case {
    Case {
        title: "Load control with some velocity control",
        head: "",
        axes: vec![
            Axis::list("mu_prime", "1", &[0.1, -0.1, -0.2, -0.5]),
            Axis::range("alpha_n", "1", (-6.0, 1.0), 29),
            Axis::range("tau", "1", (0.0, 9.0), 61),
        ],
        scalars: &[
            ("alpha_v", "1", 0.15),
            ("mu_k", "1", 1.0),
            ("mass", "1", 1.0),
            ("stiffness", "1", 1.0),
            ("normal_load", "1", 1.0),
        ],
        margin_unit: "1",
        omega_unit: "1",
        plane: "alpha_n",
        groups_at: |at| (Groups::new(at[0], 0.15, at[1]), 1.0),
    }
}

/// The delay first and logarithmic, so that its lines are strided, over more tiles than one.
fn delay_first() -> Case {
    Case {
        title: "Delay first",
        head: "",
        axes: vec![
            Axis::log("tau", "1", (0.01, 50.0), 701),
            Axis::range("alpha_v", "1", (-1.5, 0.5), 403),
            Axis::list("mu_prime", "1", &[-0.3, -0.1]),
        ],
        scalars: &[
            ("alpha_n", "1", -0.5),
            ("mu_k", "1", 1.0),
            ("mass", "1", 1.0),
            ("stiffness", "1", 1.0),
            ("normal_load", "1", 1.0),
        ],
        margin_unit: "1",
        omega_unit: "1",
        plane: "alpha_v",
        groups_at: |at| (Groups::new(at[2], at[1], -0.5), 1.0),
    }
}

/// A friction law over the pulling velocity, with units; b, a_v and a_n from their definitions.
fn friction_law() -> Case {
    Case {
        title: "A weakening law in millimetres",
        head: "[friction]\nlaw = \"weakening\"\nmu0 = 0.4\nv_s = 0.5\nmu_s = 0.9\n\n\
               [units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n",
        axes: vec![
            Axis::log("v0", "mm s-1", (0.05, 5.0), 5),
            Axis::range("alpha_v", "s-1", (-2.0, 1.0), 31),
            Axis::range("tau", "s", (0.0, 6.0), 47),
        ],
        scalars: &[
            ("alpha_n", "N mm-1", -1.25),
            ("mass", "N mm-1 s2", 0.5),
            ("stiffness", "N mm-1", 2.0),
            ("normal_load", "N", 3.0),
            ("mu0", "1", 0.4),
            ("v_s", "mm s-1", 0.5),
            ("mu_s", "1", 0.9),
        ],
        margin_unit: "s",
        omega_unit: "rad s-1",
        plane: "alpha_v",
        groups_at: |at| {
            let (mass, stiffness, load) = (0.5_f64, 2.0_f64, 3.0_f64);
            let law = FrictionLaw::weakening(0.4, 0.5, 0.9).expect("a good law");
            let unit = (mass / stiffness).sqrt();
            let b = law.mu_prime(at[0]) * load / (stiffness * mass).sqrt();
            let groups = Groups::new(b, at[1] * unit, law.mu_k(at[0]) * -1.25 / stiffness);
            (groups, unit)
        },
    }
}

impl Case {
    fn sweep(&self) -> String {
        let fixed: String = self
            .scalars
            .iter()
            .filter(|(name, ..)| !["mu0", "v_s", "mu_s"].contains(name))
            .map(|(name, _, value)| format!("{name} = {value:?}\n"))
            .collect();
        let axes: String = self
            .axes
            .iter()
            .map(|axis| format!("{} = {}\n", axis.name, axis.toml))
            .collect();
        format!(
            "title = \"{}\"\nfields = [\"n_unstable\", \"delay_margin\"]\nboundaries = true\n\n\
             [axes]\n{axes}\n[fixed]\n{fixed}\n{}",
            self.title, self.head
        )
    }

    fn shape(&self) -> Vec<usize> {
        self.axes.iter().map(|axis| axis.values.len()).collect()
    }

    fn cells(&self) -> usize {
        self.shape().iter().product()
    }

    /// The values of the axes at cell number `cell`, the last axis fastest.
    fn at(&self, cell: usize) -> Vec<f64> {
        let mut rest = cell;
        let mut at: Vec<f64> = self
            .axes
            .iter()
            .rev()
            .map(|axis| {
                let value = axis.values[rest % axis.values.len()];
                rest /= axis.values.len();
                value
            })
            .collect();
        at.reverse();
        at
    }

    fn tau_axis(&self) -> usize {
        let tau = self.axes.iter().position(|axis| axis.name == "tau");
        tau.expect("every case has delays")
    }

    /// Count of unstable roots, delay margin and whether marginal, at these values of the axes.
    fn cell(&self, at: &[f64]) -> (u16, f64, bool) {
        let (groups, unit) = (self.groups_at)(at);
        let crossings = Crossings::of(groups).in_physical_time(unit);
        let tau = at[self.tau_axis()];
        let count = crossings.count(tau, MarginalTolerance::default());
        let n = u16::try_from(count.n_unstable).expect("small counts");
        (n, crossings.delay_margin(tau), count.marginal)
    }

    /// Points off the grid, by a quarter of the step to the next value, with the count at the cell
    /// next to them.
    fn picks(&self) -> Vec<Value> {
        (0..12)
            .map(|i| (i * 7919 + 13) % self.cells())
            .map(|cell| {
                let at = self.at(cell);
                let mut near = Map::new();
                for (axis, &value) in self.axes.iter().zip(&at) {
                    let i = axis.values.iter().position(|v| *v == value).unwrap();
                    let neighbour = axis.values[if i > 0 { i - 1 } else { i + 1 }];
                    let shifted = value + 0.25 * (neighbour - value);
                    near.insert(axis.name.into(), json!(shifted));
                }
                json!({ "near": near, "n_unstable": self.cell(&at).0 })
            })
            .collect()
    }
}

/// A folder with a map, made by the program, and what must be in it.
struct Written {
    case: Case,
    folder: TempDir,
}

impl Written {
    fn new(case: Case) -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        let written = Self { case, folder };
        std::fs::write(written.file("sweep.toml"), written.case.sweep()).unwrap();
        run(&mut written.slipmap(["run", "--quiet", "sweep.toml", "-o", "map.h5"]));
        written.write_expected();
        written
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn slipmap<const N: usize>(&self, arguments: [&str; N]) -> Command {
        command(env!("CARGO_BIN_EXE_slipmap"), self.folder.path(), arguments)
    }

    fn write_expected(&self) {
        let case = &self.case;
        let (mut n, mut margin, mut status) = (Vec::new(), Vec::new(), Vec::new());
        for cell in 0..case.cells() {
            let (n_unstable, delay_margin, marginal) = case.cell(&case.at(cell));
            n.extend(n_unstable.to_le_bytes());
            margin.extend(delay_margin.to_le_bytes());
            status.push(if marginal { MARGINAL } else { 0 });
        }
        std::fs::write(self.file("n_unstable.u16"), n).unwrap();
        std::fs::write(self.file("delay_margin.f64"), margin).unwrap();
        std::fs::write(self.file("status.u8"), status).unwrap();
        let axes = case
            .axes
            .iter()
            .map(|axis| json!({ "name": axis.name, "units": axis.unit, "values": axis.values }));
        let scalars = case
            .scalars
            .iter()
            .map(|(name, unit, value)| json!({ "name": name, "units": unit, "value": value }));
        let expected = json!({
            "title": case.title,
            "sweep": case.sweep(),
            "axes": axes.collect::<Vec<_>>(),
            "scalars": scalars.collect::<Vec<_>>(),
            "units": { "n_unstable": "1", "delay_margin": case.margin_unit, "omega": case.omega_unit },
            "flags": FLAGS.map(|(mask, name)| json!({ "name": name, "mask": mask })),
            "plane": case.plane,
            "picks": case.picks(),
        });
        std::fs::write(self.file("expected.json"), expected.to_string()).unwrap();
    }

    fn python(&self, program: &str, arguments: &[&str]) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(program);
        run(python(self.folder.path()).arg(path).args(arguments));
    }

    /// The counts as the library computes them.
    fn counts(&self) -> Vec<u16> {
        (0..self.case.cells())
            .map(|cell| self.case.cell(&self.case.at(cell)).0)
            .collect()
    }
}

fn command<const N: usize>(program: &str, folder: &Path, arguments: [&str; N]) -> Command {
    let mut command = Command::new(program);
    command.current_dir(folder).args(arguments);
    command
}

/// The Python that has the packages of `scripts/requirements-readers.txt`.
fn python(folder: &Path) -> Command {
    let program = std::env::var("SLIPMAP_PYTHON").unwrap_or_else(|_| "python3".into());
    let mut command = command(&program, folder, []);
    command
        .env("MPLBACKEND", "agg")
        .env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

/// Runs to the end; a program that is missing or fails fails the test, with what it said.
fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| {
        panic!("{} cannot be run: {error}", command.get_program().display())
    });
    assert!(
        output.status.success(),
        "{command:?} ended with {}\n{}{}",
        output.status,
        text(&output.stdout),
        text(&output.stderr),
    );
    output
}

fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

#[test]
fn python_reads_load_control() {
    let written = Written::new(load_control());
    for reader in ["xarray", "h5py", "netcdf4"] {
        written.python(&format!("tests/readers/check_{reader}.py"), &[]);
    }
}

#[test]
fn python_reads_strided_tiles() {
    let written = Written::new(delay_first());
    for reader in ["xarray", "h5py", "netcdf4"] {
        written.python(&format!("tests/readers/check_{reader}.py"), &[]);
    }
}

#[test]
fn python_reads_friction_laws_with_units() {
    let written = Written::new(friction_law());
    for reader in ["xarray", "h5py", "netcdf4"] {
        written.python(&format!("tests/readers/check_{reader}.py"), &[]);
    }
}

/// A map of roots in physical units, with lines without delay, where all but the rightmost root are
/// at −∞.
#[test]
fn python_reads_roots() {
    let folder = TempDir::new().unwrap();
    let (mass, stiffness) = (4.0_f64, 9.0_f64);
    let unit = (mass / stiffness).sqrt();
    let gains = spaced(-9.0, 3.0, 7, Spacing::Linear).unwrap();
    let delays = spaced(0.0, 4.0, 81, Spacing::Linear).unwrap();
    let units = [
        ("abscissa", "s-1"),
        ("abscissa_2", "s-1"),
        ("frequency", "rad s-1"),
        ("frequency_2", "rad s-1"),
        ("relaxation_time", "s"),
    ];
    let sweep = format!(
        "fields = {:?}\n[axes]\nalpha_n = {{ from = -9, to = 3, points = 7 }}\n\
         tau = {{ from = 0, to = 4, points = 81 }}\n[fixed]\nmu_prime = -0.6\nmass = {mass}\nstiffness = {stiffness}\n\
         [units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n",
        units.map(|(name, _)| name)
    );
    std::fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    let arguments = ["run", "--quiet", "sweep.toml", "-o", "map.h5"];
    let program = env!("CARGO_BIN_EXE_slipmap");
    run(&mut command(program, folder.path(), arguments));
    let mut columns: [Vec<u8>; 5] = Default::default();
    for gain in &gains {
        for delay in &delays {
            let groups = Groups::new(-0.6 / (stiffness * mass).sqrt(), 0.0, gain / stiffness);
            let count = Crossings::of(groups).count(delay / unit, MarginalTolerance::default());
            let found = Rightmost::at(groups, delay / unit, 2, count);
            let part = |i: usize| found.roots.get(i).map(|root| root.lambda / unit);
            let (first, second) = (part(0).expect("a root"), part(1));
            let relaxation = if first.re < 0.0 {
                -1.0 / first.re
            } else {
                f64::INFINITY
            };
            let values = [
                first.re,
                second.map_or(f64::NEG_INFINITY, |z| z.re),
                first.im,
                second.map_or(f64::NAN, |z| z.im),
                relaxation,
            ];
            for (column, value) in columns.iter_mut().zip(values) {
                column.extend(value.to_le_bytes());
            }
        }
    }
    for ((name, _), column) in units.iter().zip(&columns) {
        std::fs::write(folder.path().join(format!("{name}.f64")), column).unwrap();
    }
    let expected = json!({
        "axes": { "alpha_n": gains, "tau": delays },
        "units": units.into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        "stable": { "alpha_n": -9.0, "tau": 0.5 },
    });
    std::fs::write(folder.path().join("expected.json"), expected.to_string()).unwrap();
    let checks = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers/check_roots.py");
    run(python(folder.path()).arg(checks));
}

/// Numbers of the text, whatever stands between them.
fn numbers(text: &str) -> Vec<u16> {
    text.split(|c: char| !c.is_ascii_digit())
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().expect("a count"))
        .collect()
}

#[test]
fn ncdump_prints_the_counts() {
    let written = Written::new(load_control());
    let header = run(&mut command(
        "ncdump",
        written.folder.path(),
        ["-h", "map.h5"],
    ));
    let header = text(&header.stdout);
    for line in [
        "mu_prime = 4 ;",
        "alpha_n = 29 ;",
        "tau = 61 ;",
        "ushort n_unstable(mu_prime, alpha_n, tau) ;",
        "double delay_margin(mu_prime, alpha_n, tau) ;",
        "ubyte status(mu_prime, alpha_n, tau) ;",
        "group: boundaries {",
        "double tau(vertex) ;",
        "int vertex_count(curve) ;",
    ] {
        assert!(header.contains(line), "`{line}` is missing:\n{header}");
    }
    let data = run(&mut command(
        "ncdump",
        written.folder.path(),
        ["-v", "n_unstable", "map.h5"],
    ));
    let data = text(&data.stdout);
    let (_, data) = data.split_once("data:").expect("a data section");
    let (_, data) = data.split_once("n_unstable =").expect("the counts");
    let (data, _) = data.split_once(';').expect("an end");
    assert_eq!(numbers(data), written.counts());
}

#[test]
fn h5dump_writes_the_counts() {
    let written = Written::new(friction_law());
    let header = run(&mut command(
        "h5dump",
        written.folder.path(),
        ["-H", "map.h5"],
    ));
    let header = text(&header.stdout);
    for line in [
        "DATASET \"n_unstable\"",
        "DATASET \"delay_margin\"",
        "DATASET \"status\"",
        "GROUP \"boundaries\"",
        "DATASET \"v0\"",
        "ATTRIBUTE \"DIMENSION_LIST\"",
    ] {
        assert!(header.contains(line), "`{line}` is missing:\n{header}");
    }
    let arguments = [
        "-d",
        "/n_unstable",
        "-b",
        "LE",
        "-o",
        "counts.bin",
        "map.h5",
    ];
    run(&mut command("h5dump", written.folder.path(), arguments));
    let bytes = std::fs::read(written.file("counts.bin")).unwrap();
    let counts: Vec<u8> = written
        .counts()
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    assert_eq!(bytes, counts);
}

/// Octave has the dimensions in reverse order, and the values of whole arrays in the same order as
/// the file.
#[test]
fn octave_loads_the_map() {
    let written = Written::new(load_control());
    let script = "load('-hdf5', 'map.h5'); \
                  printf('size %s\\n', mat2str(size(n_unstable))); \
                  printf('class %s\\n', class(n_unstable)); \
                  printf('taus %d, last %.17g\\n', numel(tau), tau(end)); \
                  printf('cell %d\\n', n_unstable(40, 3, 4)); \
                  printf('vertices %d of %d\\n', sum(boundaries.vertex_count), numel(boundaries.omega)); \
                  printf('counts '); printf('%d ', n_unstable);";
    let arguments = [
        "--no-gui",
        "--no-history",
        "--norc",
        "--quiet",
        "--eval",
        script,
    ];
    let output = run(&mut command("octave-cli", written.folder.path(), arguments));
    let said = text(&output.stdout);
    let case = &written.case;
    let (cell, _, _) = case.cell(&[-0.5, case.axes[1].values[2], case.axes[2].values[39]]);
    for line in [
        "size [61 29 4]".to_owned(),
        "class uint16".to_owned(),
        "taus 61, last 9".to_owned(),
        format!("cell {cell}"),
    ] {
        assert!(
            said.contains(&line),
            "`{line}` is missing:\n{said}{}",
            text(&output.stderr)
        );
    }
    let (_, vertices) = said.split_once("vertices ").expect("a number of vertices");
    let vertices = numbers(vertices.lines().next().unwrap_or_default());
    assert!(
        vertices[0] > 0 && vertices[0] == vertices[1],
        "{vertices:?}"
    );
    let (_, counts) = said.split_once("counts ").expect("the counts");
    assert_eq!(numbers(counts), written.counts());
}

fn plot_script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/plot_fig2.py")
}

/// The letter's Fig. 2 from the two sweeps that come with the program.
#[test]
fn the_letters_figure_is_drawn_from_its_maps() {
    let folder = TempDir::new().unwrap();
    let sweeps = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps");
    for name in ["fig2a.toml", "fig2b.toml"] {
        let sweep = sweeps.join(name);
        let slipmap = env!("CARGO_BIN_EXE_slipmap");
        run(command(slipmap, folder.path(), ["run", "--quiet"]).arg(sweep));
    }
    for (name, magic, least) in [
        ("fig2.png", &b"\x89PNG\r\n\x1a\n"[..], 50_000),
        ("fig2.pdf", &b"%PDF-"[..], 20_000),
        ("fig2.svg", &b"<?xml"[..], 50_000),
    ] {
        let arguments = ["fig2a.h5", "fig2b.h5", "-o", name];
        run(python(folder.path()).arg(plot_script()).args(arguments));
        let bytes = std::fs::read(folder.path().join(name)).unwrap();
        assert!(bytes.starts_with(magic), "{name} is no such file");
        let size = bytes.len();
        assert!(
            (least..3_000_000).contains(&size),
            "{name} has {size} bytes"
        );
    }
}

#[test]
fn the_figure_refuses_what_is_no_such_map() {
    let written = Written::new(delay_first());
    std::fs::write(written.file("text.h5"), "no map").unwrap();
    for (maps, message) in [
        (["text.h5", "map.h5"], "text.h5"),
        (["map.h5", "missing.h5"], "missing.h5"),
        (["expected.json", "map.h5"], "expected.json"),
    ] {
        let output = python(written.folder.path())
            .arg(plot_script())
            .args(maps)
            .args(["-o", "figure.png"])
            .output()
            .expect("Python runs");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{maps:?}: {said}");
        assert!(
            said.contains(message) && !said.contains("Traceback"),
            "{maps:?}: {said}"
        );
        assert!(!written.file("figure.png").exists());
    }
}

/// A shipped sweep with other numbers of points, run.
fn run_coarse(folder: &Path, name: &str, points: &[(&str, &str)]) {
    let sweep = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("sweeps/{name}.toml"));
    let mut text = std::fs::read_to_string(sweep).unwrap();
    for (from, to) in points {
        assert!(text.contains(from), "{name} {from}");
        text = text.replace(from, to);
    }
    let file = format!("{name}.toml");
    std::fs::write(folder.join(&file), text).unwrap();
    let slipmap = env!("CARGO_BIN_EXE_slipmap");
    run(command(slipmap, folder, ["run", "--quiet"]).arg(file));
}

/// The figures of the critical velocity, from coarse maps.
#[test]
fn python_draws_figures_of_the_critical_velocity() {
    let folder = tempfile::tempdir().expect("a folder");
    let coarse = [
        ("points = 173", "points = 19"),
        ("points = 41", "points = 7"),
    ];
    run_coarse(folder.path(), "coulomb_load", &coarse);
    run_coarse(folder.path(), "fig4", &[]);
    for control in ["robust_velocity", "robust_load"] {
        let coarse = [
            ("points = 31", "points = 5"),
            ("[-0.5, -1.0, -2.0]", "[-1.0]"),
        ];
        run_coarse(folder.path(), control, &coarse);
    }
    let script = |name: &str| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut python = python(folder.path());
        python.env("SLIPMAP", env!("CARGO_BIN_EXE_slipmap"));
        python.arg(root.join(format!("scripts/plot_{name}.py")));
        python
    };
    for (name, maps) in [
        ("coulomb_load", ["coulomb_load.h5", "fig4.h5"]),
        ("robustness", ["robust_velocity.h5", "robust_load.h5"]),
    ] {
        let picture = format!("{name}.png");
        run(script(name).args(maps).args(["-o", &picture]));
        let bytes = std::fs::read(folder.path().join(picture)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 50_000);
        let [first, second] = maps;
        let refused = script(name).args([second, first]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(&refused.stderr).contains("this figure needs"));
    }
}

/// Traces in xarray, netCDF4 and ncdump; the publication figures from them and from the map of Fig.
/// 4.
/// Tables as text against the same file as other people's programs read it.
#[test]
fn pandas_reads_tables_as_xarray_reads_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let slipmap = |args: &[&str]| {
        let program = env!("CARGO_BIN_EXE_slipmap");
        run(command(program, folder.path(), []).args(args));
    };
    let sweep = "title = \"Some #1 map\"\nfields = [\"n_unstable\", \"delay_margin\", \
        \"outcome\", \"settle_time\"]\n[axes]\ntau = { from = 0.5, to = 3, points = 4 }\n\
        alpha_n = [-2, -1, 0.1]\n[fixed]\nv0 = 0.2\nx_dot0 = 0\n[friction]\n\
        law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    std::fs::write(folder.path().join("map.toml"), sweep).unwrap();
    slipmap(&["run", "--quiet", "map.toml"]);
    let case = root.join("sweeps/fig3a.toml");
    slipmap(&["simulate", case.to_str().unwrap(), "-o", "trace.h5"]);
    for (file, table) in [
        ("map", "cells"),
        ("map", "boundaries"),
        ("trace", "samples"),
        ("trace", "events"),
    ] {
        let (from, to) = (format!("{file}.h5"), format!("{table}.csv"));
        slipmap(&["export", &from, "--table", table, "--comments", "-o", &to]);
    }
    run(python(folder.path()).arg(root.join("tests/readers/check_csv.py")));
}

#[test]
fn python_reads_traces_and_draws_figures_3_and_4() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let slipmap = env!("CARGO_BIN_EXE_slipmap");
    for name in ["fig3a", "fig3b"] {
        let case = root.join(format!("sweeps/{name}.toml"));
        let said = run(command(slipmap, folder.path(), ["simulate", "--json"]).arg(case));
        std::fs::write(folder.path().join(format!("{name}.json")), said.stdout).unwrap();
        run(python(folder.path())
            .arg(root.join("tests/readers/check_trace.py"))
            .arg(name));
        let header = run(&mut command(
            "ncdump",
            folder.path(),
            ["-h", &format!("{name}.h5")],
        ));
        assert!(text(&header.stdout).contains("double x_dot(t)"));
    }
    run(command(slipmap, folder.path(), ["run", "--quiet"]).arg(root.join("sweeps/fig4.toml")));
    for (name, arguments) in [
        ("fig3", &["fig3a.h5", "fig3b.h5"][..]),
        ("fig4", &["fig4.h5"]),
    ] {
        let script = root.join(format!("scripts/plot_{name}.py"));
        let picture = format!("{name}.png");
        let mut python = python(folder.path());
        run(python.arg(script).args(arguments).args(["-o", &picture]));
        let bytes = std::fs::read(folder.path().join(picture)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 50_000);
    }
    for (name, arguments) in [
        ("fig3", &["fig3a.h5", "fig3a.json"][..]),
        ("fig4", &["fig3a.json"]),
    ] {
        let script = root.join(format!("scripts/plot_{name}.py"));
        let mut python = python(folder.path());
        let refused = python.arg(script).args(arguments).output().unwrap();
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(&refused.stderr).contains("fig3a.json"));
    }
}

/// The example of a language in `scripts/read`, with arguments `map.h5` and `picture.png`, reads a
/// real map.
///
/// It prints the axes' values and the abscissa of a cell after "nearest", an interpolated abscissa
/// after "interpolated" where it can do that, and the numbers of certified cells and of cells of a
/// plane after "certified"; each is told by other means here.
fn check_example(interpolates: bool, example: impl FnOnce(&Path, PathBuf) -> Command) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = TempDir::new().expect("a temporary folder");
    let sweep = std::fs::read_to_string(root.join("sweeps/decay_load.toml")).unwrap();
    let coarse = sweep.replace("points = 251", "points = 91");
    let coarse = coarse.replace("points = 301", "points = 111");
    assert_ne!(sweep, coarse);
    std::fs::write(folder.path().join("sweep.toml"), coarse).unwrap();
    let slipmap = env!("CARGO_BIN_EXE_slipmap");
    let arguments = ["run", "--quiet", "sweep.toml", "-o", "map.h5"];
    run(&mut command(slipmap, folder.path(), arguments));

    let said = run(&mut example(folder.path(), root.join("scripts/read")));
    let said = text(&said.stdout);
    let after = |word: &str| -> Vec<f64> {
        let line = said.lines().find_map(|line| line.strip_prefix(word));
        let line = line.unwrap_or_else(|| panic!("no line of {word}:\n{said}"));
        let words = line.split_whitespace();
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let gains = spaced(-3.0, 1.0, 91, Spacing::Linear).unwrap();
    let delays = spaced(0.01, 10.0, 111, Spacing::Linear).unwrap();
    let abscissa = |i: usize, j: usize| abscissa_at(folder.path(), gains[i], delays[j]);
    let nearest = after("nearest");
    let (gain, delay) = (nearest_to(&gains, -1.5), nearest_to(&delays, 0.8));
    let expected = [-0.3, gains[gain], delays[delay], abscissa(gain, delay)];
    assert_eq!(nearest.len(), 4, "{said}");
    for (found, expected) in nearest.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{expected}: {said}");
    }
    if interpolates {
        let (i, j) = (before(&gains, -1.5), before(&delays, 0.8));
        let between = |axis: &[f64], i: usize, at: f64| (at - axis[i]) / (axis[i + 1] - axis[i]);
        let (x, y) = (between(&gains, i, -1.5), between(&delays, j, 0.8));
        let along = |i: usize| (1.0 - y) * abscissa(i, j) + y * abscissa(i, j + 1);
        let expected = (1.0 - x) * along(i) + x * along(i + 1);
        let found = after("interpolated")[0];
        assert!((found - expected).abs() < 1e-12, "{expected}: {said}");
    }
    let map = hdf5::File::open(folder.path().join("map.h5")).unwrap();
    let status: Vec<u8> = map.dataset("status").unwrap().read_raw().unwrap();
    let plane = &status[2 * gains.len() * delays.len()..][..gains.len() * delays.len()];
    let certified = plane.iter().filter(|status| *status & CERTIFIED != 0);
    let expected = [certified.count() as f64, plane.len() as f64];
    assert_eq!(after("certified"), expected, "{said}");
    check_picture(&folder.path().join("picture.png"));
}

fn nearest_to(axis: &[f64], value: f64) -> usize {
    let distance = |i: &usize| (axis[*i] - value).abs();
    let closer = |a: &usize, b: &usize| distance(a).total_cmp(&distance(b));
    (0..axis.len()).min_by(closer).unwrap()
}

/// The last value of a growing axis that is not beyond this one, and has another one after it.
fn before(axis: &[f64], value: f64) -> usize {
    axis.partition_point(|v| *v <= value)
        .clamp(1, axis.len() - 1)
        - 1
}

/// The abscissa as `slipmap point` tells it.
fn abscissa_at(folder: &Path, alpha_n: f64, tau: f64) -> f64 {
    let (alpha_n, tau) = (format!("--alpha-n={alpha_n}"), format!("--tau={tau}"));
    let arguments = ["point", "--json", "--mu-prime=-0.3", &alpha_n, &tau];
    let said = run(&mut command(
        env!("CARGO_BIN_EXE_slipmap"),
        folder,
        arguments,
    ));
    let point: Value = serde_json::from_slice(&said.stdout).expect("JSON");
    point["abscissa"].as_f64().expect("an abscissa")
}

/// A picture of colours, not an empty frame.
fn check_picture(path: &Path) {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("a picture"));
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size()];
    let info = reader.next_frame(&mut pixels).expect("a whole PNG");
    assert!(info.width > 400 && info.height > 300, "{info:?}");
    let samples = info.color_type.samples();
    let colours: std::collections::HashSet<&[u8]> = pixels.chunks_exact(samples).collect();
    let coloured = pixels.chunks_exact(samples).filter(|p| p[0] != p[2]);
    let (different, coloured) = (colours.len(), coloured.count());
    assert!(different > 100, "{different} colours");
    let all = (info.width * info.height) as usize;
    assert!(coloured > all / 4, "{coloured} of {all} pixels have a hue");
}

fn python_example(name: &'static str) -> impl FnOnce(&Path, PathBuf) -> Command {
    move |folder, examples| {
        let mut python = python(folder);
        python
            .arg(examples.join(name))
            .args(["map.h5", "picture.png"]);
        python
    }
}

#[test]
fn the_example_for_xarray_reads_a_map() {
    check_example(true, python_example("read_xarray.py"));
}

#[test]
fn the_example_for_h5py_reads_a_map() {
    check_example(false, python_example("read_h5py.py"));
}

#[test]
fn the_example_for_octave_reads_a_map() {
    check_example(true, |folder, examples| {
        let script = "path = 'map.h5'; picture = 'picture.png'; read_map";
        let arguments = ["--no-gui", "--no-history", "--norc", "--quiet", "--path"];
        let mut octave = command("octave-cli", folder, arguments);
        octave.arg(examples).args(["--eval", script]);
        // Without a window.
        octave.env_remove("DISPLAY");
        octave
    });
}

#[test]
fn the_example_for_r_reads_a_map() {
    check_example(true, |folder, examples| {
        let mut r = command("Rscript", folder, []);
        r.arg(examples.join("read_map.R"))
            .args(["map.h5", "picture.png"]);
        r
    });
}

#[test]
fn the_example_for_julia_reads_a_map() {
    check_example(true, |folder, examples| {
        let mut julia = command("julia", folder, []);
        julia
            .arg(examples.join("read_map.jl"))
            .args(["map.h5", "picture.png"]);
        julia
    });
}

/// Every kind of map, against the CF conventions: cells that are counted, roots, best settings and
/// degrees of stability, motions in units, critical velocities. The conventions want a title, which
/// a sweep need not have.
#[test]
fn the_compliance_checker_finds_nothing() {
    let checker = std::env::var("SLIPMAP_CF_CHECKER");
    let checker = checker.unwrap_or_else(|_| "compliance-checker".into());
    let motions = "title = \"Motions\"\nfields = [\"outcome\", \"settle_time\", \"n_min\"]\n[axes]\n\
                   alpha_v = [-0.4, 0.4]\ntau = [0.5, 1, 2]\n[fixed]\nv0 = 0.3\n[start]\na0 = 0\n\
                   [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
                   [units]\nforce = \"N\"\nlength = \"m\"\ntime = \"s\"\n";
    let roots = "title = \"Roots\"\nbest = true\ndegree_of_stability = [0.05]\n\
                 fields = [\"n_unstable\", \"delay_margin\", \"abscissa\", \"abscissa_2\"]\n\
                 [axes]\nalpha_v = { from = -1, to = 0.2, points = 25 }\n\
                 tau = { from = 0, to = 9, points = 40 }\n[fixed]\nmu_prime = -0.3\n";
    let velocities = "title = \"Velocities\"\nfields = [\"vc\", \"method\", \"regime\"]\n[axes]\nalpha_n = [-4, 0.4]\n\
                      v0 = [0.1, 1]\ntau = [0.5, 1]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n";
    let folder = TempDir::new().unwrap();
    for (number, sweep) in [&load_control().sweep(), motions, roots, velocities]
        .iter()
        .enumerate()
    {
        let map = format!("map{number}.nc");
        std::fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
        let arguments = ["run", "--quiet", "sweep.toml", "-o", &map];
        run(&mut command(
            env!("CARGO_BIN_EXE_slipmap"),
            folder.path(),
            arguments,
        ));
        // That one looks for a dimension `time` in every map with groups, and fails without.
        let broken = "check_invalid_same_named_dimension_across_groups";
        let arguments = [
            "--test",
            "cf:1.11",
            "--criteria",
            "strict",
            "-s",
            broken,
            &map,
        ];
        let report = run(&mut command(&checker, folder.path(), arguments));
        let report = text(&report.stdout);
        assert!(report.contains("All tests passed!"), "{sweep}\n{report}");
    }
}

/// What every command prints with `--json`, each kind of answer once.
const ANSWERS: [(&str, &str); 25] = [
    (
        "point.plain",
        "point --mu-prime=-0.3 --alpha-v=-0.33 --tau 4.15",
    ),
    ("point.idle", "point --mu-prime 0.3 --units SI"),
    (
        "vc.follow",
        "vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-n=-7 --tau 1",
    ),
    (
        "vc.worst",
        "vc --friction coulomb --mu0 0.5 --alpha-n=-7 --tau 1 --protocol switch-on --phase worst",
    ),
    (
        "vc.limit",
        "vc --protocol limit --gamma 0.25 --mu-ratio 0.5",
    ),
    (
        "basin.state",
        "basin --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.1 --alpha-n=-10 --tau 0.5 --starts 64",
    ),
    (
        "basin.phase",
        "basin --friction coulomb --mu0 0.5 --v0 0.1 --alpha-n=-1 --tau 0.5 --starts 64 --over phase",
    ),
    ("best.velocity", "best --mu-prime=-0.3 --control velocity"),
    ("best.none", "best --mu-prime=-2 --control velocity"),
    ("best.memory", "best --mu-prime=-0.3 --memory 0.2"),
    ("best.system", "best --system turning --search width"),
    ("measure.velocity", "measure experiment.toml"),
    ("simulate.case", "simulate case.toml"),
    ("plan.sweep", "plan sweep.toml"),
    (
        "margins.law",
        "margins --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.35 --alpha-v -0.33 --tau 4.15",
    ),
    (
        "margins.unstable",
        "margins --mu-prime -0.3 --alpha-n -0.1 --tau 0.465",
    ),
    (
        "best.robust",
        "best --mu-prime -0.3 --control load --robust 0.05",
    ),
    ("plan.case", "plan case.toml"),
    ("info.map", "info sweep.h5"),
    ("info.trace", "info case.h5"),
    ("jobs.queue", "jobs queue"),
    ("status.map", "status sweep.h5"),
    ("status.maps", "status sweep.h5 case.h5"),
    ("verify.map", "verify sweep.h5"),
    ("reproduce.quick", "reproduce --quick"),
];

#[test]
fn json_is_as_its_schema_says() {
    let folder = TempDir::new().unwrap();
    let file = |name: &str| folder.path().join(name);
    let sweep = "best = true\nfields = [\"n_unstable\", \"abscissa\", \"vc\", \"outcome\"]\n\
                 [axes]\nalpha_n = [-7, 1]\ntau = [0.2, 0.5, 1]\n[fixed]\nv0 = 0.118\n[friction]\n\
                 law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    let case = "units = \"SI\"\n[fixed]\nv0 = 0.35\nalpha_v = -0.33\ntau = 4.15\n[friction]\n\
                law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    std::fs::write(file("sweep.toml"), sweep).unwrap();
    std::fs::write(file("case.toml"), case).unwrap();
    let experiment = "[experiment]\nv0 = [0.05, 0.5]\ncontrol = \"velocity\"\n[friction]\n\
                      law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    std::fs::write(file("experiment.toml"), experiment).unwrap();
    let slipmap = |words: &str| {
        let mut command = command(env!("CARGO_BIN_EXE_slipmap"), folder.path(), []);
        run(command.args(words.split(' ')))
    };
    slipmap("run --quiet sweep.toml");
    slipmap("submit sweep.toml --to queue");
    for (name, words) in ANSWERS {
        let answer = slipmap(&format!("{words} --json"));
        std::fs::write(file(&format!("{name}.json")), answer.stdout).unwrap();
    }
    let verified = slipmap("verify case.h5 --json");
    std::fs::write(file("verify.trace.json"), verified.stdout).unwrap();
    for (name, _) in ANSWERS {
        let command = name.split('.').next().unwrap();
        let schema = slipmap(&format!("schema {command}"));
        std::fs::write(file(&format!("{command}.schema.json")), schema.stdout).unwrap();
    }
    let checker = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers/check_schemas.py");
    run(python(folder.path()).arg(checker).arg(folder.path()));
}
