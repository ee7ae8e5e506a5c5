//! The forces of a trace: Newton's law between samples, a block that sticks, Coulomb's law by hand,
//! and traces from before forces were stored.

use crate::program::{Folder, expect, out};

const FIG3A: &str = include_str!("../../sweeps/fig3a.toml");

/// The columns of a trace.
struct Columns {
    file: hdf5::File,
    mode: Vec<u8>,
}

impl Columns {
    /// Follows a case.
    fn of(folder: &Folder, name: &str) -> Self {
        expect(&folder.run(&["simulate", &format!("{name}.toml")]), 0, name);
        let file = hdf5::File::open(folder.path().join(format!("{name}.h5"))).unwrap();
        let mode = file.dataset("mode").unwrap().read_raw().unwrap();
        Self { file, mode }
    }

    fn read(&self, name: &str) -> Vec<f64> {
        self.file.dataset(name).unwrap().read_raw().unwrap()
    }
}

/// Differences of the velocity from sample to sample know nothing of the forces: mass times them is
/// the impulse of pull, friction and the dashpot to the ground.
#[test]
fn forces_accelerate_the_block() {
    let fixed = "[fixed]\nmass = 2\nstiffness = 8\nnormal_load = 3\ndamping = 0.2\nviscous = 0.1\n";
    let text = FIG3A
        .replace("[fixed]\n", fixed)
        .replace("[trace]", "[trace]\ninterval = 0.002");
    let folder = Folder::with(&[("damped.toml", &text)]);
    let trace = Columns::of(&folder, "damped");
    let [t, x_dot, a, v, load] = ["t", "x_dot", "a", "v", "N"].map(|name| trace.read(name));
    let [pull, friction] = ["pulling_force", "friction_force"].map(|name| trace.read(name));
    let (mut slips, mut sticks) = (0, 0);
    for i in 0..t.len() - 1 {
        if trace.mode[i] == 0 {
            sticks += 1;
            // At rest the dashpot beside the spring is stretched with the pulling velocity.
            let needed = 8.0 * a[i] + 0.2 * v[i];
            assert!(
                (pull[i] - needed).abs() < 1e-12 && friction[i] == pull[i],
                "{}",
                t[i]
            );
            // μ_S = 1.
            assert!(friction[i].abs() < load[i] * (1.0 + 1e-9), "{}", t[i]);
            continue;
        }
        let dt = t[i + 1] - t[i];
        if trace.mode[i + 1] != trace.mode[i] || dt < 1e-6 {
            continue;
        }
        slips += 1;
        let force = |i: usize| pull[i] - friction[i] - 0.1 * x_dot[i];
        let mean = 0.5 * (force(i) + force(i + 1));
        let found = 2.0 * (x_dot[i + 1] - x_dot[i]) / dt;
        assert!((found - mean).abs() < 2e-3, "{}: {found} {mean}", t[i]);
    }
    assert!(slips > 10_000 && sticks > 1000, "{slips} {sticks}");
}

#[test]
fn coulomb_by_hand() {
    let text = "horizon = 30\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n[fixed]\nv0 = 0.1\n\
                stiffness = 4\nnormal_load = 3\n[start]\nx_dot0 = -1\na0 = 0\n\
                [trace]\nuntil = 20\n";
    let folder = Folder::with(&[("c.toml", text)]);
    let trace = Columns::of(&folder, "c");
    let [a, pull, friction] = ["a", "pulling_force", "friction_force"].map(|n| trace.read(n));
    let mut seen = [false; 3];
    for (i, mode) in trace.mode.iter().enumerate() {
        seen[usize::from(*mode)] = true;
        assert_eq!(pull[i], 4.0 * a[i]);
        assert_eq!(friction[i], [pull[i], 1.5, -1.5][usize::from(*mode)]);
    }
    assert_eq!(seen, [true; 3], "it sticks, and slips both ways");
}

/// What a trace without forces leaves out follows from the rest.
#[test]
fn older_traces_are_read() {
    let folder = Folder::with(&[("fig3a.toml", FIG3A)]);
    expect(&folder.run(&["simulate", "fig3a.toml"]), 0, "fig3a.h5");
    let csv = |to: &str| {
        expect(&folder.run(&["export", "fig3a.h5", "-o", to]), 0, to);
        std::fs::read_to_string(folder.path().join(to)).unwrap()
    };
    let new = csv("new.csv");
    assert!(new.contains("pulling_force") && new.contains("friction_force"));
    let file = hdf5::File::open_rw(folder.path().join("fig3a.h5")).unwrap();
    file.unlink("pulling_force").unwrap();
    file.unlink("friction_force").unwrap();
    file.close().unwrap();
    assert_eq!(csv("old.csv"), new);
    expect(
        &folder.run(&["plot", "fig3a.h5", "-o", "old.svg"]),
        0,
        "old.svg",
    );
    let svg = std::fs::read_to_string(folder.path().join("old.svg")).unwrap();
    assert!(svg.contains("friction force"));
    let verified = folder.run(&["verify", "fig3a.h5"]);
    assert_eq!(verified.status.code(), Some(0), "{}", out(&verified));
}
