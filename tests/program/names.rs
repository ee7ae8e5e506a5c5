//! Names of a system's parameters: whatever else a map holds, parameters of any name are written,
//! read back and verified. What cannot be written is refused before anything is computed.

use std::collections::BTreeSet;

use crate::map;
use crate::program::{Folder, err, expect, out};
use slipmap::setting::SweepSpec;
use slipmap::setting::map_names;
use slipmap::store::MapFile;
use slipmap::sweep::Plan;
use slipmap::sweep::described::group_names::other_names;
use slipmap::text::SpecError;

/// A sweep of a system with the parameters `first` and `second`; the latter spans the planes of
/// curves with the delay.
fn sweep(first: &str, second: &str) -> String {
    format!(
        "fields = [\"n_unstable\"]\n[system]\nP = \"s^2 + 0.1*s + 1 + {first}\"\nQ = \"-{second}\"\n\
         [system.parameters]\n{first} = 0\n{second} = 0.2\n[axes]\n{first} = [0.0, 0.5]\n\
         {second} = {{ from = 0.1, to = 0.9, points = 5 }}\n\
         tau = {{ from = 0.5, to = 9.5, points = 7 }}\n"
    )
}

/// The map of a sweep, which is sound, and its curves as text: the names, and the rows.
fn made(text: &str) -> (Folder, Vec<String>, String) {
    let folder = Folder::with(&[("sweep.toml", text)]);
    expect(
        &folder.run(&["run", "sweep.toml", "-o", "map.h5", "-q"]),
        0,
        "map.h5",
    );
    expect(&folder.run(&["verify", "map.h5"]), 0, "0 differ");
    let table = folder.run(&["export", "map.h5", "--table", "boundaries"]);
    expect(&table, 0, "");
    let table = out(&table);
    let (head, rows) = table.split_once('\n').unwrap();
    (
        folder,
        head.split(',').map(str::to_owned).collect(),
        rows.to_owned(),
    )
}

/// Every name in the group of curves, and every one that would be such a name with `corner_`
/// before it.
fn names_in_curves() -> BTreeSet<&'static str> {
    let names = other_names();
    let behind = names.iter().filter_map(|name| name.strip_prefix("corner_"));
    let all: BTreeSet<&str> = names.iter().copied().chain(behind).collect();
    assert!(
        all.contains("omega") && all.contains("branch_upper") && all.len() > 20,
        "{all:?}"
    );
    all
}

#[test]
fn parameters_may_be_called_as_what_stands_beside_them() {
    let (plain_folder, plain_head, rows) = made(&sweep("stiffness", "width"));
    let plain = map::datasets(&plain_folder.path().join("map.h5"));
    assert!(rows.lines().count() > 100, "{}", rows.lines().count());
    let all = names_in_curves();
    let names = all.iter().map(|&name| [name, "width"]);
    let others = all.iter().map(|&name| ["width", name]);
    let pairs = [
        ["x", "corner_x"],
        ["corner_x", "x"],
        ["omega", "parameter_omega"],
    ];
    for names in names.chain(others).chain(pairs) {
        let (folder, head, same_rows) = made(&sweep(names[0], names[1]));
        assert_eq!(same_rows, rows, "{names:?}");
        let unique: BTreeSet<&String> = head.iter().collect();
        assert_eq!(unique.len(), plain_head.len(), "{head:?}");
        let path = folder.path().join("map.h5");
        let datasets = map::datasets(&path);
        assert_eq!(datasets.len(), plain.len(), "{names:?}");
        let map = MapFile::open(&path).unwrap();
        assert!(
            map.axes()
                .iter()
                .map(|axis| axis.parameter.name())
                .eq([names[0], names[1], "tau"])
        );
        let columns = map.names_in_curves();
        drop(map);
        for (old, (new, name)) in ["stiffness", "width"].iter().zip(columns.iter().zip(names)) {
            for form in ["", "corner_"] {
                let of = |name: &str| format!("/boundaries/{form}{name}");
                assert_eq!(datasets[&of(new)], plain[&of(old)], "{names:?}");
                let said = map::edit(&path, |file| {
                    let attribute = file.dataset(&of(new)).unwrap().attr("parameter").ok()?;
                    Some(
                        attribute
                            .read_scalar::<hdf5::types::FixedUnicode<64>>()
                            .unwrap(),
                    )
                });
                let said = said.map(|text| text.to_string());
                assert_eq!(said.as_deref(), (new != name).then_some(name), "{names:?}");
            }
        }
    }
}

/// What a text of a sweep is refused for, and the text at the place.
fn refused(text: &str) -> (SpecError, &str) {
    let read = text.parse::<SweepSpec>().and_then(Plan::new);
    let error = read.unwrap_err();
    let place = error.span.clone().unwrap();
    (error, &text[place])
}

#[test]
fn names_that_a_map_has_already_are_refused_with_one_that_works() {
    let mut taken = 0;
    for name in map_names::taken() {
        for [first, second] in [[name, "width"], ["width", name]] {
            let text = sweep(first, second);
            let (error, place) = refused(&text);
            assert_eq!(place, name, "{error}");
            let help = error.help.unwrap();
            let other = help
                .strip_prefix("call it ")
                .unwrap()
                .split(',')
                .next()
                .unwrap();
            let [first, second] = [first, second].map(|of| if of == name { other } else { of });
            sweep(first, second)
                .parse::<SweepSpec>()
                .and_then(Plan::new)
                .unwrap();
        }
        taken += 1;
    }
    assert!(taken > 50, "{taken}");
    for name in ["status", "n_unstable", "boundaries", "s", "sqrt"] {
        let folder = Folder::with(&[("sweep.toml", &sweep(name, "width"))]);
        for command in ["plan", "run"] {
            let output = folder.run(&[command, "sweep.toml"]);
            expect(&output, 2, &format!("{name} is reserved"));
            assert!(err(&output).contains("sweep.toml:6:1"), "{}", err(&output));
        }
        assert_eq!(folder.files(), ["sweep.toml"]);
    }
}

/// A sweep of a system with this many axes, the last of them the delay.
fn many_axes(axes: usize) -> String {
    let names: Vec<String> = (1..axes).map(|i| format!("a{i}")).collect();
    let each = |form: &dyn Fn(&String) -> String| names.iter().map(form).collect::<String>();
    format!(
        "[system]\nP = \"s^2 + s + 1{}\"\nQ = \"-0.5\"\n[system.parameters]\n{}[axes]\n{}tau = [1.0]\n",
        each(&|name| format!(" + {name}")),
        each(&|name| format!("{name} = 0\n")),
        each(&|name| format!("{name} = [0.25]\n")),
    )
}

#[test]
fn a_map_has_as_many_axes_as_hdf5_has_dimensions() {
    let folder = Folder::with(&[("most.toml", &many_axes(32)), ("more.toml", &many_axes(33))]);
    expect(&folder.run(&["run", "most.toml", "-q"]), 0, "most.h5");
    expect(&folder.run(&["verify", "most.h5"]), 0, "1 agree, 0 differ");
    let text = many_axes(33);
    let (error, place) = refused(&text);
    assert_eq!(place, "tau", "{error}");
    for command in ["plan", "run"] {
        let output = folder.run(&[command, "more.toml"]);
        expect(
            &output,
            2,
            "axes.tau is one axis too many: a map has 32 at most",
        );
    }
    assert!(!folder.path().join("more.h5").exists());
}
