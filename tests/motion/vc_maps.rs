//! Maps of the critical velocity: cells against `vc`, regimes, the slope at rest, threads and
//! tiles, the sample, mistakes.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::program::{self, Folder, err, out};
use slipmap::critical::GRAZE_PRECISION;
use slipmap::linear::status::{DISAGREE, NOT_CONVERGED, SAMPLED};
use slipmap::model::stop::Stop;
use slipmap::setting::field::OUTCOMES;
use slipmap::setting::{Field, Parameter, SweepSpec};
use slipmap::store::MapFile;
use slipmap::store::source::InMemory;
use slipmap::sweep::events::Attended;
use slipmap::sweep::{Plan, RunError, Todo, engine};

use crate::map::write;

const LAW: &str = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
const VC: &str =
    "\"vc\", \"outcome\", \"method\", \"v_liftoff\", \"stick_time\", \"slip_time\", \"windows\"";

/// Load control; velocity control in physical units, without v0; switched on at phases.
fn sweeps() -> [String; 3] {
    [
        format!(
            "fields = [\"n_unstable\", \"regime\", \"v_smooth\", {VC}]\nverify = 0.5\n[axes]\nalpha_n = [-10, -3, 2]\n\
             v0 = [0.02, 0.3]\ntau = [0.3, 0.5, 2]\n[fixed]\nmass = 1\n{LAW}"
        ),
        format!(
            "fields = [{VC}]\n[axes]\ntau = [2.0, 6]\nalpha_v = [-0.4, -0.2]\n[fixed]\nmass = 4\nstiffness = 2\n\
             normal_load = 3\n{LAW}"
        ),
        format!(
            "fields = [{VC}]\nprotocol = \"switch-on\"\n[axes]\nswitch_on_phase = [0.0, 4.2]\ntau = [4.15]\n\
             [fixed]\nalpha_v = -0.33\n{LAW}"
        ),
    ]
}

fn plan(text: &str) -> Plan {
    Plan::new(text.parse().unwrap()).unwrap()
}

/// The cells of a field as bits.
fn bits(path: &Path, name: &str) -> Vec<u64> {
    let cells = hdf5::File::open(path).unwrap().dataset(name).unwrap();
    match cells.dtype().unwrap().size() {
        1 => {
            let cells = cells.read_raw::<u8>().unwrap();
            cells.into_iter().map(u64::from).collect()
        }
        2 => {
            let cells = cells.read_raw::<u16>().unwrap();
            cells.into_iter().map(u64::from).collect()
        }
        _ => {
            let cells = cells.read_raw::<f64>().unwrap();
            cells.into_iter().map(f64::to_bits).collect()
        }
    }
}

fn names(path: &Path, field: Field) -> Vec<&'static str> {
    let kinds = field.kinds().unwrap();
    let numbers = bits(path, field.name()).into_iter();
    numbers.map(|n| kinds[n as usize]).collect()
}

fn values(path: &Path, name: &str) -> Vec<f64> {
    bits(path, name).into_iter().map(f64::from_bits).collect()
}

/// The flags of `slipmap vc` for a cell.
fn flags(plan: &Plan, mut cell: usize) -> Vec<String> {
    let mut index = vec![0; plan.shape().len()];
    for axis in (0..index.len()).rev() {
        index[axis] = cell % plan.shape()[axis];
        cell /= plan.shape()[axis];
    }
    let setting = plan.setting(&index);
    let mut flags: Vec<String> = ["vc", "--json", "--friction", "weakening"]
        .map(String::from)
        .to_vec();
    for p in Parameter::ALL {
        let value = setting.get(p);
        match p {
            Parameter::SwitchOnPhase if setting.uses(p) => {
                flags.push(format!("--protocol=switch-on\n--phase={value:?}"));
            }
            Parameter::V0 => {}
            _ if setting.uses(p) => {
                let name = p.name().replace('_', "-");
                flags.push(format!("--{name}={value:?}"));
            }
            _ => {}
        }
    }
    flags
        .iter()
        .flat_map(|f| f.split('\n'))
        .map(String::from)
        .collect()
}

#[test]
fn every_cell_is_what_vc_says() {
    let folder = Folder::new();
    let map = folder.path().join("map.h5");
    for text in sweeps() {
        let plan = plan(&text);
        write(&plan, 2, &map);
        let (outcomes, methods) = (names(&map, Field::Outcome), names(&map, Field::Method));
        let (status, windows) = (bits(&map, "status"), bits(&map, "windows"));
        for cell in 0..plan.cells() as usize {
            let flags = flags(&plan, cell);
            let said = folder.run(&flags.iter().map(String::as_str).collect::<Vec<_>>());
            assert_eq!(err(&said), "", "{flags:?}");
            let said = program::json(&said);
            assert_eq!(said["outcome"], outcomes[cell], "{flags:?}");
            assert_eq!(said["method"], methods[cell], "{flags:?}");
            assert_eq!(
                said["windows"].as_array().unwrap().len() as u64,
                windows[cell]
            );
            let undecided = status[cell] & u64::from(NOT_CONVERGED) != 0;
            assert_eq!(said["decided"], !undecided, "{flags:?}");
            for name in ["vc", "v_liftoff", "stick_time", "slip_time"] {
                let value = values(&map, name)[cell];
                // A graze that starts from its neighbour's orbit is known to that; a slip at its
                // end is longer by a root.
                let allowed = match name {
                    "vc" | "v_liftoff" => GRAZE_PRECISION,
                    _ => 10.0 * GRAZE_PRECISION,
                };
                let expected = said[name].as_f64().unwrap_or(f64::NAN);
                let near = (expected - value).abs() <= allowed * value.abs();
                assert!(near || expected.is_nan() && value.is_nan(), "{flags:?}");
            }
        }
    }
}

#[test]
fn maps_do_not_depend_on_threads_or_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one.h5", "two.h5"].map(|name| folder.path().join(name));
    // Long enough for blocks in which cells start from their neighbours, the last one a short one.
    let long = format!(
        "fields = [{VC}]\n[axes]\ntau = {{ from = 0.5, to = 4.5, points = 75 }}\nalpha_n = [-1.5, -0.4]\n\
         [fixed]\nalpha_v = -0.2\n{LAW}"
    );
    for text in sweeps().into_iter().chain([long]) {
        let spec: SweepSpec = text.parse().unwrap();
        let plan = Plan::new(spec.clone()).unwrap();
        write(&plan, 1, &one);
        for (threads, cells) in [(2, 64), (2, 2), (1, 1000)] {
            let plan = Plan::with_tiles_of(cells, spec.clone()).unwrap();
            write(&plan, threads, &two);
            for field in plan.spec.fields.iter().map(|f| f.name()).chain(["status"]) {
                assert_eq!(bits(&one, field), bits(&two, field), "{field}");
            }
        }
    }
}

/// Critical velocities do not depend on v0, and are searched for once for all of its values. A map
/// with an axis v0, wherever it stands, has the cells of maps of one v0 each.
#[test]
fn an_axis_of_v0_shares_critical_velocities() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map.h5");
    let v0s = [0.02, 0.1, 0.3];
    let text = |v0s: &[f64], place: usize| {
        let mut axes = vec!["alpha_n = [-10, -3, 2]".to_owned(), "tau = [0.3, 2]".into()];
        axes.insert(place, format!("v0 = {v0s:?}"));
        let axes = axes.join("\n");
        format!(
            "fields = [\"abscissa\", \"regime\", \"v_smooth\", {VC}]\nverify = 0\n[axes]\n{axes}\n{LAW}"
        )
    };
    let names = |plan: &Plan| {
        let fields = plan.spec.fields.iter().map(|field| field.name());
        fields.chain(["status"]).collect::<Vec<_>>()
    };
    let alone = v0s.map(|v0| {
        let plan = plan(&text(&[v0], 0));
        write(&plan, 1, &map);
        names(&plan)
            .into_iter()
            .map(|name| bits(&map, name))
            .collect::<Vec<_>>()
    });
    for (place, stride) in [(0, 6), (1, 2), (2, 1)] {
        let plan = plan(&text(&v0s, place));
        assert_eq!(plan.tiles.tile_shape()[place], v0s.len());
        write(&plan, 2, &map);
        for (field, name) in names(&plan).into_iter().enumerate() {
            for (cell, found) in bits(&map, name).into_iter().enumerate() {
                let v0 = cell / stride % v0s.len();
                let other = cell / (stride * v0s.len()) * stride + cell % stride;
                assert_eq!(found, alone[v0][field][other], "{name} {place} {cell}");
            }
        }
    }
}

/// Classes follow from the count, v_c and v0; every other cell or so was recomputed, to the same
/// answer.
#[test]
fn regimes_and_samples() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map.h5");
    let plan = plan(&sweeps()[0]);
    write(&plan, 2, &map);
    let (vc, smooth) = (values(&map, "vc"), values(&map, "v_smooth"));
    let lift_off = values(&map, "v_liftoff");
    let (counts, classes) = (bits(&map, "n_unstable"), names(&map, Field::Regime));
    let outcomes = names(&map, Field::Outcome);
    let mut seen = std::collections::HashSet::new();
    for (cell, regime) in classes.into_iter().enumerate() {
        let v0 = [0.02, 0.3][cell / 3 % 2];
        let expected = match outcomes[cell] {
            _ if counts[cell] > 0 => "unstable",
            "lift-off" if v0 >= lift_off[cell] => "lift-off",
            "lift-off" | "persists" => "bistable",
            _ if v0 > vc[cell] => "stable",
            _ => "bistable",
        };
        assert_eq!(regime, expected, "{cell}");
        assert!(smooth[cell].is_nan() || smooth[cell] >= vc[cell], "{cell}");
        if regime == "stable" && !smooth[cell].is_nan() {
            assert!(smooth[cell] < v0 || smooth[cell] > vc[cell], "{cell}");
        }
        seen.insert(regime);
    }
    assert!(seen.len() >= 3, "{seen:?}");
    // The letter's Fig. 3(b): α_N = −10, τ = 0.5.
    assert!((vc[1] - 0.021540).abs() < 1e-6, "{}", vc[1]);
    let status = bits(&map, "status");
    let having = |flag: u8| status.iter().filter(|s| *s & u64::from(flag) != 0).count();
    assert!((4..=14).contains(&having(SAMPLED)), "{}", having(SAMPLED));
    let counts = MapFile::open(&map)
        .unwrap()
        .status_counts()
        .unwrap()
        .flagged;
    assert_eq!(counts[5], having(SAMPLED) as u64);
    for s in &status {
        let both = u64::from(SAMPLED | DISAGREE);
        assert_ne!(s & both, u64::from(DISAGREE), "only sampled cells disagree");
    }
}

/// What maps of the protocol `follow` hold is what brute force tells: v0 raised in small steps by a
/// program of its own, by two ramps (steps of 6 % with 12 stops at each, of 2 % with 40) that agree
/// to 2e-6. By load control at α_N = 2, τ = 2 the block lifts off at the start, however slowly it
/// is pulled.
#[test]
fn critical_velocities_are_those_of_brute_force() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map.h5");
    let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 2e-5;
    write(&plan(&sweeps()[0]), 2, &map);
    let (vc, v_liftoff) = (values(&map, "vc"), values(&map, "v_liftoff"));
    let (outcomes, windows) = (names(&map, Field::Outcome), bits(&map, "windows"));
    let lost = [
        (0, 0.102_963_2),
        (1, 0.021_539_67),
        (6, 0.685_284_6),
        (7, 0.331_802_7),
    ];
    let lifted = [
        (2, 0.059_997_19),
        (8, 0.203_250_4),
        (12, 0.745_191_9),
        (13, 0.086_017_5),
    ];
    for (first, expected) in lost {
        for cell in [first, first + 3] {
            assert!(
                near(vc[cell], expected) && v_liftoff[cell].is_nan(),
                "{cell}"
            );
            assert_eq!((outcomes[cell], windows[cell]), ("grazing", 1), "{cell}");
        }
    }
    for (first, expected) in lifted {
        for cell in [first, first + 3] {
            assert!(
                near(v_liftoff[cell], expected) && vc[cell].is_nan(),
                "{cell}"
            );
            assert_eq!((outcomes[cell], windows[cell]), ("lift-off", 1), "{cell}");
        }
    }
    for cell in [14, 17] {
        assert!(v_liftoff[cell] < 1e-5 && vc[cell].is_nan(), "{cell}");
        assert_eq!((outcomes[cell], windows[cell]), ("lift-off", 0), "{cell}");
    }
    write(&plan(&sweeps()[1]), 2, &map);
    let expected = [1.285_709_6, 1.534_720_8, 0.567_968_3, 0.417_365_3];
    for (found, expected) in values(&map, "vc").into_iter().zip(expected) {
        assert!(near(found, expected), "{found} {expected}");
    }
}

/// μ0 and v_s can be given through the slope at rest: the same cells and counts.
#[test]
fn the_slope_at_rest_stands_for_v_s_or_mu0() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map.h5");
    let mut found = Vec::new();
    for (axis, fixed) in [
        ("v_s = [0.25, 0.5]", "mu0 = 0.5"),
        ("mu_prime_rest = [-2, -1]", "mu0 = 0.5"),
        ("mu0 = [0.25, 0.5]", "v_s = 0.5"),
        ("mu_prime_rest = [-0.5, -1]", "v_s = 0.5"),
    ] {
        let text = format!(
            "fields = [\"vc\", \"n_unstable\", \"regime\"]\nboundaries = false\n[axes]\n{axis}\ntau = [0.5, 1]\n\
             [fixed]\nalpha_n = -8\nv0 = 0.3\n[friction]\nlaw = \"weakening\"\n{fixed}\n"
        );
        write(&plan(&text), 1, &map);
        found.push(["vc", "n_unstable", "regime"].map(|name| bits(&map, name)));
    }
    assert_eq!(found[0], found[1]);
    assert_eq!(found[2], found[3]);
    let folder = Folder::new();
    let said = ["--v-s=0.25", "--mu-prime-rest=-2"].map(|flag| {
        let start = ["vc", "--friction=weakening", "--mu0=0.5", "--alpha-n=-8"];
        let told = out(&folder.run(&[&start[..], &["--tau=0.5", flag]].concat()));
        // The inputs alone are others.
        let (mut lines, all) = (Vec::new(), told.lines().count());
        lines.extend(told.lines().filter(|line| !line.starts_with("inputs: ")));
        assert_eq!(lines.len() + 1, all, "{told}");
        lines.join("\n")
    });
    assert!(!said[0].is_empty() && said[0] == said[1]);
}

/// What stands around the numbers: one table of flags, the protocol with its limits, the map's
/// summary.
#[test]
fn a_map_says_what_it_holds() {
    let folder = Folder::with(&[("sweep.toml", &sweeps()[2])]);
    let done = folder.run(&["run", "sweep.toml"]);
    assert_eq!(done.status.code(), Some(0), "{}", err(&done));
    let file = hdf5::File::open(folder.path().join("sweep.h5")).unwrap();
    let outcome = file.dataset("outcome").unwrap();
    let values = outcome
        .attr("flag_values")
        .unwrap()
        .read_raw::<u8>()
        .unwrap();
    assert_eq!(values.len(), OUTCOMES.len());
    let vc = file.dataset("vc").unwrap();
    let number = |name: &str| vc.attr(name).unwrap().read_raw::<f64>().unwrap()[0];
    assert_eq!((number("v_max"), number("precision")), (10.0, 1e-7));
    assert!(vc.attr("protocol").is_ok());
    assert!(!file.link_exists("v0"), "it means nothing here");
    drop((outcome, vc, file));
    let info = out(&folder.run(&["info", "sweep.h5"]));
    assert!(info.contains("2 lost"), "{info}");
    let map = folder.path().join("sweep.h5");
    // The letter's Fig. 3(a), just released; and where the block stops, where survival is
    // re-entrant.
    assert!((values_of(&map)[0] - 0.233773).abs() < 2e-6);
}

fn values_of(map: &Path) -> Vec<f64> {
    values(map, "vc")
}

#[test]
fn a_stop_is_heeded_between_cells() {
    let plan = Arc::new(plan(&sweeps()[2]));
    let stop = Arc::new(AtomicBool::new(true));
    let mut pieces = InMemory::default();
    let stopped = engine::run(
        &plan,
        Todo::all(plan.pieces()),
        1,
        &mut pieces,
        Attended::silently(&stop),
    );
    assert!(matches!(stopped, Err(RunError::Interrupted)));
    let mut worker = engine::Worker::new(&plan);
    let stop = Stop::when(&stop);
    assert!(!worker.compute(&plan.tiles.tile(0), &stop));
}

#[test]
fn mistakes_are_shown_in_place() {
    let folder = Folder::new();
    let mut shown = String::new();
    let tail = "[axes]\ntau = [1, 2]\n[fixed]\nalpha_n = -1\n";
    let weakening = "[friction]\nlaw = \"weakening\"\n";
    for text in [
        "fields = [\"vc\"]\n[axes]\ntau = [1]\n[fixed]\nmu_prime = -1\n".to_owned(),
        format!("fields = [\"vc\", \"n_min\"]\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\n{tail}v0 = 0.1\n{LAW}"),
        format!("fields = [\"vc\", \"regime\"]\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\n{tail}x_dot0 = 0.1\n{LAW}"),
        format!("fields = [\"vc\"]\n{tail}{LAW}[simulation]\nsteps = 10\n"),
        format!("fields = [\"vc\"]\n{tail}switch_on_phase = 1.0\n{LAW}"),
        format!("fields = [\"vc\"]\nphase = \"worst\"\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\nprotocol = \"switch-on\"\nphase = 0.5\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\nprotocol = \"switch-on\"\nverify = 0.1\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\nprotocol = \"switched\"\n{tail}{LAW}"),
        format!("fields = [\"vc\"]\nverify = 2\n{tail}{LAW}"),
        format!("protocol = \"follow\"\n{tail}v0 = 1\n{LAW}"),
        format!("fields = [\"vc\"]\n[axes]\ntau = [0, 1]\n[fixed]\nalpha_n = -1\n{LAW}"),
        format!("fields = [\"vc\"]\n{tail}{LAW}mu_prime_rest = -1\n"),
        format!("fields = [\"vc\"]\n{tail}{weakening}mu_prime_rest = -1\n"),
        format!("fields = [\"vc\"]\n{tail}{weakening}mu0 = 0.5\nmu_prime_rest = 1\n"),
        format!(
            "fields = [\"vc\"]\n{tail}[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\nmu_prime_rest = -1\n"
        ),
        format!("fields = [\"vc\"]\n{tail}{weakening}v_s = 0.5\nmu_prime_rest = -3\n"),
    ] {
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        let output = folder.run(&["run", "sweep.toml"]);
        assert_eq!(output.status.code(), Some(2), "{}", out(&output));
        shown += &err(&output);
    }
    insta::assert_snapshot!("mistakes", shown);
}

/// The worst of 32 phases in a map is what `vc` says, and no phase of its own is worse.
#[test]
fn the_worst_phase_in_a_map() {
    let folder = Folder::new();
    let map = folder.path().join("map.h5");
    let sweep = |phase: &str, start: &str| {
        format!(
            "fields = [\"vc\", \"outcome\", \"windows\"]\nprotocol = \"switch-on\"\n{phase}[axes]\n{start}\
             tau = [0.5]\n[fixed]\nalpha_n = -10\n{LAW}"
        )
    };
    write(&plan(&sweep("phase = \"worst\"\n", "")), 1, &map);
    let (worst, ends) = (values_of(&map)[0], names(&map, Field::Outcome));
    assert_eq!(ends, ["lost"]);
    let flags = [
        "vc",
        "--json",
        "--protocol=switch-on",
        "--phase=worst",
        "--tau=0.5",
    ];
    let law = [
        "--friction=weakening",
        "--mu0=0.5",
        "--v-s=0.5",
        "--alpha-n=-10",
    ];
    let said = folder.run(&[&flags[..], &law].concat());
    let said = program::json(&said);
    assert!((said["vc"].as_f64().unwrap() - worst).abs() <= 1e-15 * worst);
    write(
        &plan(&sweep("", "switch_on_phase = [0.0, 2.0, 3.5]\n")),
        1,
        &map,
    );
    for one in values_of(&map) {
        // The phases of the worst case are 32 of its own, so one between them may be a little
        // worse.
        assert!(one <= worst * 1.01, "{one} {worst}");
    }
}

/// What is wrong is said by the flag that gives it, in numbers of readable length.
#[test]
fn vc_names_flags() {
    let tables = [
        ("large.csv", "0 0.5\n1e300 0.4\n"),
        ("small.csv", "0 0.5\n1 1e-300\n"),
    ];
    let folder = Folder::with(&tables);
    let weakening = "--friction weakening --mu0 0.5 --v-s 0.5";
    let mut shown = String::new();
    for flags in [
        format!("{weakening} --alpha-v=-0.3"),
        format!("{weakening} --alpha-v=-0.3 --tau 0"),
        format!("{weakening} --alpha-v=-0.3 --tau=-1"),
        format!("{weakening} --alpha-v=-1e300 --tau 1"),
        format!("{weakening} --mu-prime-rest=-1"),
        format!("{weakening} --mu-prime 0.1"),
        format!("{weakening} --gamma 0.1"),
        "--friction weakening --mu0 2 --v-s 0.5".into(),
        "--friction weakening --v-s 0.5".into(),
        "--friction weakening --v-s 0.5 --mu-prime-rest=-3".into(),
        "--friction coulomb --mu0 0.5 --v-s 0.5".into(),
        "--friction table --table large.csv".into(),
        "--friction table --table small.csv".into(),
        "--protocol limit --gamma=-1 --mu-ratio 0.5".into(),
        "--protocol limit --gamma 0.5 --mu-ratio 2".into(),
    ] {
        let arguments: Vec<&str> = std::iter::once("vc").chain(flags.split(' ')).collect();
        let said = folder.run(&arguments);
        assert_eq!(
            (said.status.code(), out(&said).as_str()),
            (Some(2), ""),
            "{flags}"
        );
        shown += &format!("vc {flags}\n{}", err(&said));
    }
    insta::assert_snapshot!("vc_names_flags", shown);
}

/// Without gains there is no feedback, so no delay is asked for.
#[test]
fn vc_needs_no_delay_without_control() {
    let folder = Folder::new();
    let coulomb = ["vc", "--json", "--friction=coulomb", "--mu0=0.5"];
    let answer = |more: &[&str]| {
        let mut value = program::json(&folder.run(&[&coulomb[..], more].concat()));
        let inputs = value.as_object_mut().unwrap().remove("inputs").unwrap();
        (inputs["tau"].as_f64().unwrap(), value)
    };
    let (without, value) = answer(&[]);
    assert_eq!((without, &value["outcome"]), (0.0, &"persists".into()));
    assert_eq!(answer(&["--alpha-v=0", "--tau=3"]), (3.0, value));
}
