//! Curves as programs and people write them, each read or refused with advice.

use super::*;

fn options(columns: &str) -> CurveOptions {
    CurveOptions {
        columns: match columns {
            "" => Columns::default(),
            columns => Columns::read(columns).unwrap(),
        },
        ..CurveOptions::default()
    }
}

fn curve(text: &str, options: &CurveOptions) -> Measured {
    Measured::read(text, options).unwrap_or_else(|error| panic!("{text}: {error:?}"))
}

/// Speeds and coefficients of the table.
fn table(text: &str, options: &CurveOptions) -> (Vec<f64>, Vec<f64>) {
    let table = curve(text, options).table().unwrap();
    (table.speeds().to_vec(), table.mu_k().to_vec())
}

#[test]
fn two_columns_are_read_however_they_are_written() {
    for text in [
        "0,0.5\n0.25,0.4\n",
        "speed; mu_k\n0; 0.5\n 0.25;0.4",
        "\u{feff}0,0.5\n\n0.25,0.4",
        "v mu\n# measured\n\n0\t0.5\r\n0.25  0.4\r\n",
        "0;0,5\n0,25;0,4\n",
        "0\t0,5\n0,25\t0,4\n",
        "\"mu\",\"v\"\n\"0,5\",\"0\"\n\"0,4\",\"0,25\"\n",
        "Run 7, belt 3\n\nmu,v\n-,m/s\n0.4,0.25\n0.5,0\n",
        "sep=;\nv;mu\n0;0,5;\n0,25;0,4;\n",
        "time;v;mu\n1;0;0,5\n2;0,25;0,4\n",
    ] {
        let expected = (vec![0.0, 0.25], vec![0.5, 0.4]);
        assert_eq!(table(text, &options("")), expected, "{text}");
    }
}

#[test]
fn columns_are_chosen_by_name_and_number() {
    let text = "n,belt,a,b\n1,0,3,9\n2,0.25,2,9\n";
    let expected = (vec![0.0, 0.25], vec![3.0, 2.0]);
    for columns in ["speed=2,mu=3", "speed=belt,mu=a", "mu=A, speed=2"] {
        assert_eq!(table(text, &options(columns)), expected, "{columns}");
    }
    let by_column = options("speed=belt,force=3,load=b");
    assert_eq!(table(text, &by_column).1, [3.0 / 9.0, 2.0 / 9.0]);
    let fixed = CurveOptions {
        normal_load: Some(4.0),
        ..options("speed=belt,force=3")
    };
    assert_eq!(table(text, &fixed).1, [0.75, 0.5]);
    // A load in a column of its own, whose unit stands below.
    for title in ["F_n", "F_N", "N", "normal force"] {
        let text = format!("v;F;{title}\nm/s;N;N\n0;3;6\n0,25;2;5\n");
        let expected = (vec![0.0, 0.25], vec![0.5, 0.4]);
        assert_eq!(table(&text, &options("")), expected, "{title}");
    }
    // A force that is asked for counts more than the title of a coefficient.
    let text = "v,mu,F\n0,0.5,3\n1,0.4,2\n";
    let force = CurveOptions {
        normal_load: Some(4.0),
        ..options("force=F")
    };
    assert_eq!(table(text, &force).1, [0.75, 0.5]);
    assert_eq!(table(text, &options("")).1, [0.5, 0.4]);
}

#[test]
fn what_was_done_is_told() {
    let told = |text: &str| {
        let remarks = curve(text, &options("")).remarks;
        remarks
            .iter()
            .map(Remark::to_string)
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert_eq!(told("v,mu\n0,0.5\n1,0.4\n"), "");
    let left_out = "2 rows are left out: they are no numbers; the first is line 3";
    assert_eq!(told("v,mu\n0,0.5\nstuck,0\n1,0.4\n,\n2,nan\n"), left_out);
    let first = "line 2 is left out: it is no numbers";
    assert_eq!(told("v,mu\n-,0.5\n0,0.5\n1,0.4\n"), first);
    assert!(told("a,b\n0,0.5\n1,0.4\n").contains("column 1 (a) is taken as the speed"));
    assert!(told("v,b\n0,0.5\n1,0.4\n").contains("column 2 (b) as the friction"));
    assert!(told("v (mm/s),mu\n0,0.5\n1,0.4\n").contains("--units SI"));
    assert!(told("v,mu\n0,0.5\n1,0.4\n1,0.4\n").starts_with("2 readings at the same"));
    assert!(told("v,mu\n-1,-0.5\n1,0.5\n").ends_with("mu_k is the same there"));
}

#[test]
fn speeds_are_converted_into_the_units_of_the_setting() {
    let read = |text: &str, unit: Option<&str>, units: &str| {
        let options = CurveOptions {
            speed_unit: unit.map(|unit| SpeedUnit::read(unit).unwrap()),
            units: Units::read(units).unwrap(),
            ..options("")
        };
        let speeds = |curve: Measured| curve.points.iter().map(|p| p.speed).collect::<Vec<_>>();
        Measured::read(text, &options).map(speeds)
    };
    let [plain, titled] = ["v,mu\n70,0.5\n300,0.4\n", "v (mm/s),mu\n70,0.5\n300,0.4\n"];
    assert_eq!(read(plain, Some("mm/s"), "SI"), Ok(vec![0.07, 0.3]));
    assert_eq!(read(titled, None, "SI"), Ok(vec![0.07, 0.3]));
    assert_eq!(read(titled, Some("m/s"), "SI"), Ok(vec![70.0, 300.0]));
    assert_eq!(read(plain, None, "SI"), Ok(vec![70.0, 300.0]));
    let below = "v,mu\nmm/s,-\n70,0.5\n300,0.4\n";
    assert_eq!(read(below, None, "SI"), Ok(vec![0.07, 0.3]));
    let error = read(plain, Some("mm/s"), "dimensionless").unwrap_err();
    assert_eq!(error.help.unwrap(), "say --units SI");
    let error = read("v (rpm),mu\n70,0.5\n300,0.4\n", None, "SI").unwrap_err();
    assert!(
        error
            .message
            .contains("column 1 (v (rpm)): rpm is no known unit"),
        "{error}"
    );
    assert_eq!(error.help.unwrap(), "say the unit: --speed-unit mm/s");
}

/// A text, columns that are given, the place of the mistake, what is said of it, and the advice.
type Mistake = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static str,
);

const MISTAKES: &[Mistake] = &[
    ("", "", "", "no line has two numbers", "0.1, 0.52"),
    ("v\n0.5\n", "", "v", "no line has two numbers", ""),
    ("0,0.5\n", "", "", "only 1 point: 2 to 4096 are needed", ""),
    ("0,0.5\n1,x\n", "", "", "only 1 point", "line 2 is left out"),
    (
        "0,0.5\n1,-4\n",
        "",
        "-4",
        "line 2, column 2: friction is greater",
        "sign",
    ),
    (
        "v,mu\n-1e13,0.5\n1,0.4\n",
        "",
        "-1e13",
        "line 2, column 1 (v): speeds =",
        "",
    ),
    (
        "0,1.5\n1,0.4\n",
        "",
        "1.5",
        "at most mu_s = 1 (not given",
        "",
    ),
    (
        "0;0.5\n1;0,4\n",
        "",
        "0,4",
        "has another decimal mark than 0.5",
        "decimal point",
    ),
    (
        "v;mu\n1,000;0\n2,000;0\n",
        "",
        "1,000",
        "may be 1.000 or 1000",
        "decimal point",
    ),
    (
        "v;mu\n1.000,5;0\n2;0\n",
        "",
        "1.000,5",
        "separators of thousands",
        "1000",
    ),
    (
        "0,1,0,5\n0,2,0,4\n",
        "",
        "0,1,0,5",
        "not clear which column",
        "decimal ones",
    ),
    (
        "v,mu\n1,2\n3,4\n0,1,5\n",
        "",
        "0,1,5",
        "line 4 has 3 columns",
        "decimal ones",
    ),
    (
        "a,b,c\n1,0,0.5\n",
        "",
        "a,b,c",
        "is the speed",
        "1 a, 2 b, 3 c; say which: --columns",
    ),
    (
        "v,F_n\n0,5\n1,4\n",
        "",
        "v,F_n",
        "not clear which column is mu_k",
        "--columns mu=2",
    ),
    (
        "v,F\n0,5\n1,4\n",
        "",
        "v,F",
        "column 2 (F) is a force",
        "--normal-load 12.5",
    ),
    (
        "v,F,x\n0,5,1\n",
        "speed=w",
        "v,F,x",
        "there is no column w",
        "columns: 1 v, 2 F, 3 x",
    ),
    (
        "v,F,x\n0,5,1\n",
        "speed=4",
        "v,F,x",
        "there is no column 4",
        "columns: 1 v",
    ),
    (
        "v,F,fortce\n0,5,1\n",
        "force=force",
        "v,F,fortce",
        "no column force",
        "`fortce`",
    ),
    (
        "v set,v,mu\n0,0,1\n",
        "",
        "v set,v,mu",
        "may both be the speed",
        "--columns speed",
    ),
    (
        "v,F,x\n0,5,1\n",
        "speed=1,mu=v",
        "v,F,x",
        "given as the speed and as the friction",
        "columns: 1 v",
    ),
    (
        "v,F,N\n1,2,3\n2,3,0\n",
        "load=N,force=F",
        "0",
        "line 3, column 3 (N): a load",
        "",
    ),
];

#[test]
fn mistakes_are_pointed_at_with_advice() {
    for &(text, columns, place, says, advises) in MISTAKES {
        let read = Measured::read(text, &options(columns));
        let error = read.and_then(|curve| curve.table_of_law(None)).unwrap_err();
        assert!(error.message.contains(says), "{text}: {error}");
        let help = error.help.clone().unwrap_or_default();
        assert!(help.contains(advises), "{text}: {help}");
        let found = error.span.clone().map_or("", |span| &text[span]);
        assert_eq!(found, place, "{text}: {error}");
    }
    let keys = CurveOptions {
        spoken: Spoken::Keys,
        ..options("")
    };
    let error = Measured::read("v,F\n0,5\n1,4\n", &keys).unwrap_err();
    assert!(
        error
            .help
            .unwrap()
            .contains("normal_load = 12.5 in [fixed]")
    );
}

#[test]
fn forces_are_turned_into_the_unit_of_the_load() {
    let of = |text: &str| {
        let options = CurveOptions {
            normal_load: Some(2.0),
            units: Units::preset("SI").unwrap(),
            ..options("")
        };
        Measured::read(text, &options).map(|curve| {
            let remarks: Vec<String> = curve.remarks.iter().map(Remark::to_string).collect();
            (curve.points[0].mu_k, remarks.join("; "))
        })
    };
    let milli = "forces are in mN by their title, and turned into N";
    for (text, mu_k, told) in [
        ("v,F (N)\n1,1\n2,1\n", 0.5, ""),
        ("v,F (mN)\n1,700\n2,1\n", 0.35, milli),
        ("v,F (mN),load (N)\n1,700,2\n2,1,1\n", 0.35, milli),
        ("v,F (mN),load (mN)\n1,1,2\n2,1,1\n", 0.5, ""),
        ("v,F (V),load (V)\n1,1,2\n2,1,1\n", 0.5, ""),
        ("v,F,load (V)\n1,1,2\n2,1,1\n", 0.5, ""),
        ("v,mu (V)\n1,0.5\n2,0.5\n", 0.5, ""),
    ] {
        assert_eq!(of(text), Ok((mu_k, told.to_owned())), "{text}");
    }
    for text in ["v,F (V)\n1,1\n2,1\n", "v,F (N),load (kg)\n1,1,1\n2,1,1\n"] {
        let error = of(text).unwrap_err();
        assert!(error.message.starts_with("the force is in "), "{error}");
        assert!(error.help.unwrap().starts_with("give both in one unit"));
    }
}

/// As `slipmap measure` writes it: the error is no friction, and what did not settle is left out.
#[test]
fn rows_that_did_not_settle_are_left_out() {
    let text = "v0,mu_k,mu_k_error,settled\n0.1,0.5,0.001,true\n0.2,0.9,0,false\n\
        0.3,,,false\n0.4,0.3,0.002,true\n";
    let read = curve(text, &options(""));
    let found = read.table().unwrap();
    assert_eq!(
        (found.speeds(), found.mu_k()),
        (&[0.1, 0.4][..], &[0.5, 0.3][..])
    );
    let told: Vec<String> = read.remarks.iter().map(ToString::to_string).collect();
    assert_eq!(
        told,
        ["2 rows are left out: they did not settle; the first is line 3"]
    );
    let none = "v,mu,settled\n0.1,0.5,no\n0.2,0.9,0\n0.3,0.2,yes\n";
    let error = curve(none, &options("")).table().unwrap_err();
    assert!(error.help.unwrap().contains("did not settle"));
}
