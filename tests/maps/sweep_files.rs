//! Sweep files: what is understood, and that every mistake is pointed at.

use slipmap::linear::MarginalTolerance;
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::{CaseSpec, Field, Parameter, SweepSpec};
use slipmap::sweep::Plan;

const GOOD: &str = "\
title = \"all of it\"
fields = [\"delay_margin\", \"n_unstable\"]
boundaries = true
degree_of_stability = [0.05, 1]

[axes]
v0 = { from = 1e-2, to = 1e1, points = 4, spacing = \"log\" }
tau = [0, 0.5, 2]
alpha_n = { from = -8, to = 1, points = 10 }

[fixed]
alpha_v = -0.1
mass = 2

[friction]
law = \"weakening\"
mu0 = 0.5
v_s = 0.5

[units]
force = \"N\"
length = \"mm\"
time = \"s\"

[tolerance]
marginal = 1e-12
";

/// What pictures show is no matter of the cells: the same plan.
#[test]
fn the_picture_is_no_part_of_the_plan() {
    let plain: SweepSpec = GOOD.parse().unwrap();
    assert_eq!(plain.picture, None);
    let named = format!("picture = \"delay_margin\"\n{GOOD}");
    let named: SweepSpec = named.parse().unwrap();
    assert_eq!(named.picture, Some(Field::DelayMargin));
    let hash = |spec| Plan::new(spec).unwrap().hash();
    assert_eq!(hash(plain), hash(named));
}

#[test]
fn everything_is_understood() {
    let spec: SweepSpec = GOOD.parse().unwrap();
    assert_eq!(spec.title, "all of it");
    assert_eq!(spec.fields, [Field::NUnstable, Field::DelayMargin]);
    assert_eq!(spec.boundaries, Some(true));
    assert_eq!(spec.degrees_of_stability, [0.05, 1.0]);
    assert_eq!(spec.tolerance, MarginalTolerance(1e-12));
    let order: Vec<_> = spec
        .axes
        .iter()
        .map(|a| a.parameter.known().unwrap())
        .collect();
    assert_eq!(order, [Parameter::V0, Parameter::Tau, Parameter::AlphaN]);
    assert_eq!(spec.axes[1].values, [0.0, 0.5, 2.0]);
    assert_eq!(spec.axes[2].values.len(), 10);
    assert_eq!(
        spec.fixed.law(),
        Some(&LawKind::named("weakening").unwrap())
    );
    assert_eq!(spec.fixed.get(Parameter::Mass), 2.0);
    assert_eq!(spec.fixed.get(Parameter::MuS), 1.0);
    assert_eq!(spec.units.of_parameter(Parameter::AlphaN), "N mm-1");
    assert_eq!(spec.units.of_parameter(Parameter::Mass), "N mm-1 s2");
    assert_eq!(spec.units.of_parameter(Parameter::MuS), "1");
    assert_eq!(spec.units.angular_frequency(), "rad s-1");
    assert_eq!(spec.text, GOOD);
}

#[test]
fn the_sweeps_that_come_with_slipmap_are_valid() {
    for entry in std::fs::read_dir("sweeps").unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        // Those without axes are single cases.
        if !text.contains("[axes]") {
            let case: Result<CaseSpec, _> = text.parse();
            case.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            continue;
        }
        let spec: SweepSpec = text
            .parse()
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        Plan::new(spec).unwrap();
    }
}

/// A sweep that is wrong in one way: the text, where the error points, and what it says.
const BAD: &[(&str, &str, &str)] = &[
    ("", "", "at least one axis"),
    ("[axes]\n", "axes", "at least one axis"),
    ("[axes", "", "unclosed table"),
    ("axis = 1", "axis", "unknown key `axis`"),
    ("[axes]\ntou = [1]\n", "tou", "unknown key `axes.tou`"),
    (
        "[axes]\ntau = 3\n",
        "3",
        "expected an array, found a whole number",
    ),
    ("[axes]\ntau = [1]\ntau = [2]\n", "tau", "duplicate key"),
    (
        "[axes]\ntau = []\nmu_prime = [1]",
        "[]",
        "the list is empty",
    ),
    (
        "[axes]\ntau = [1, \"x\"]\n",
        "\"x\"",
        "expected a number, found a string",
    ),
    (
        "[axes]\ntau = [2, 1]\nmu_prime = [1]",
        "[2, 1]",
        "values of tau must be strictly increasing",
    ),
    (
        "[axes]\nalpha_v = [2, 1, 1]\n",
        "[2, 1, 1]",
        "strictly increasing or strictly decreasing",
    ),
    (
        "[axes]\ntau = [-1, 1]\n",
        "-1",
        "tau = -1 is outside its range: 0 or more",
    ),
    (
        "best = 1\n[axes]\nalpha_v = [0, 1]\ntau = [1, 2]\n[fixed]\nmu_prime = 1\n",
        "1",
        "expected true or false, found a whole number",
    ),
    (
        "best = true\n[axes]\nmu_prime = [0, 1]\ntau = [1, 2]\n[fixed]\nalpha_v = 1\n",
        "best",
        "best needs an axis of a gain and one of the delay",
    ),
    (
        "best = true\n[axes]\nalpha_n = [0, 1]\n[fixed]\nmu_prime = 1\ntau = 2\n",
        "best",
        "best needs an axis of a gain and one of the delay",
    ),
    (
        "best = true\n[axes]\nalpha_n = [1]\ntau = [1, 2]\n[fixed]\nmu_prime = 1\n",
        "best",
        "with two points or more",
    ),
    ("[axes]\ntau = [nan]\n", "nan", "finite number"),
    ("[axes]\ntau = [1, inf]\n", "inf", "finite number"),
    ("[axes]\ntau = [1e999]\n", "1e999", "number"),
    (
        "[axes]\nmass = [0.0]\n",
        "0.0",
        "mass = 0 is outside its range: greater than 0",
    ),
    (
        "[axes]\nmass = [-2]\n",
        "-2",
        "mass = -2 is outside its range",
    ),
    ("[axes]\nmu_prime = [1e300]\n", "1e300", "at most 1e12"),
    (
        "[axes]\ntau = { from = 1, to = 0, points = 5 }\n",
        "{ from = 1, to = 0, points = 5 }",
        "empty or reversed",
    ),
    (
        "[axes]\ntau = { from = 1, to = 1, points = 5 }\n",
        "{ from = 1, to = 1, points = 5 }",
        "empty or reversed",
    ),
    (
        "[axes]\ntau = { from = -1, to = 1, points = 5 }\n",
        "{ from = -1, to = 1, points = 5 }",
        "tau = -1",
    ),
    (
        "[axes]\ntau = { from = nan, to = 1, points = 5 }\n",
        "nan",
        "finite number",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = 0 }\n",
        "{ from = 0, to = 1, points = 0 }",
        "points = 0 is outside its range",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = -3 }\n",
        "-3",
        "whole number between 0",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = 2.5 }\n",
        "2.5",
        "expected a whole number",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = 99999999999 }\n",
        "{ from = 0, to = 1, points = 99999999999 }",
        "outside its range",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1 }\n",
        "{ from = 0, to = 1 }",
        "points is missing",
    ),
    (
        "[axes]\ntau = { from = 0, points = 3 }\n",
        "{ from = 0, points = 3 }",
        "to is missing",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = 3, step = 1 }\n",
        "step",
        "unknown key `axes.tau.step`",
    ),
    (
        "[axes]\ntau = { from = 0, to = 1, points = 3, spacing = \"log\" }\n",
        "{ from = 0, to = 1, points = 3, spacing = \"log\" }",
        "same side of 0",
    ),
    (
        "[axes]\ntau = { from = 1, to = 2, points = 3, spacing = \"cubic\" }\n",
        "\"cubic\"",
        "unknown spacing",
    ),
    (
        "fields = [\"n_stable\"]\n[axes]\ntau = [1]",
        "\"n_stable\"",
        "unknown field",
    ),
    (
        "picture = \"v_smoth\"\n[axes]\ntau = [1]",
        "\"v_smoth\"",
        "unknown field \"v_smoth\"",
    ),
    (
        "picture = \"abscissa\"\nfields = [\"n_unstable\"]\n[axes]\ntau = [1]\nmu_prime = [1]",
        "\"abscissa\"",
        "picture: abscissa is not among the fields",
    ),
    (
        "picture = true\n[axes]\ntau = [1]",
        "true",
        "expected a string, found true or false",
    ),
    (
        "fields = [\"abscissa_9\"]\n[axes]\ntau = [1]",
        "\"abscissa_9\"",
        "unknown field \"abscissa_9\"",
    ),
    (
        "fields = [\"abscissa\", \"abscissa_1\"]\n[axes]\ntau = [1]",
        "\"abscissa_1\"",
        "unknown field",
    ),
    ("fields = []\n[axes]\ntau = [1]", "[]", "the list is empty"),
    (
        "fields = [\"n_unstable\", \"n_unstable\"]\n[axes]\ntau = [1]",
        "\"n_unstable\"",
        "listed twice",
    ),
    (
        "degree_of_stability = 0.1\n[axes]\ntau = [1]",
        "0.1",
        "degree_of_stability: expected an array, found a number",
    ),
    (
        "degree_of_stability = []\n[axes]\ntau = [1]",
        "[]",
        "0 values; 1 to 16 are allowed",
    ),
    (
        "degree_of_stability = [1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]\n[axes]\ntau = [1]",
        "[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]",
        "17 values; 1 to 16 are allowed",
    ),
    (
        "degree_of_stability = [0.1, 0.0]\n[axes]\ntau = [1]",
        "0.0",
        "0 is outside its range: greater than 0",
    ),
    (
        "degree_of_stability = [-0.1]\n[axes]\ntau = [1]",
        "-0.1",
        "-0.1 is outside its range",
    ),
    (
        "degree_of_stability = [inf]\n[axes]\ntau = [1]",
        "inf",
        "finite number",
    ),
    (
        "degree_of_stability = [0.2, 0.2]\n[axes]\ntau = [1]",
        "0.2",
        "the values must be strictly increasing",
    ),
    (
        "boundaries = false\ndegree_of_stability = [0.1]\n[axes]\ntau = [1, 2]\nalpha_v = [1, 2]\n[fixed]\nmu_prime = -1",
        "degree_of_stability",
        "traced with the boundaries, and boundaries = false",
    ),
    (
        "degree_of_stability = [0.1]\n[axes]\ntau = [1]\nalpha_v = [1, 2]\n[fixed]\nmu_prime = -1",
        "degree_of_stability",
        "there is no plane for its curves",
    ),
    (
        "boundaries = 1\n[axes]\ntau = [1]",
        "1",
        "expected true or false",
    ),
    ("[axes]\ntau = [1]\n", "axes", "mu_prime is not given"),
    ("[axes]\nmu_prime = [1]\n", "axes", "tau is not given"),
    (
        "[axes]\ntau = [1]\n[fixed]\ntau = 2\n",
        "tau",
        "tau is given twice",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\nv0 = 2\n",
        "v0",
        "v0 needs a friction law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\n[[programme]]\nat = 1\nv0 = 2\n",
        "programme",
        "`programme` does not belong here",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\nmu_s = 2\n",
        "mu_s",
        "`fixed.mu_s` does not belong here",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmass = \"heavy\"\n",
        "\"heavy\"",
        "expected a number",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmass = 0\n",
        "0",
        "mass = 0 is outside its range",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"glue\"\n",
        "\"glue\"",
        "unknown friction law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nmu0 = 0.5\n",
        "friction",
        "needs a law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"coulomb\"\n",
        "\"coulomb\"",
        "mu0 is not given",
    ),
    (
        "[axes]\ntau = [1]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n",
        "\"coulomb\"",
        "v0 is not given",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\nmu_prime = 2\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n",
        "mu_prime",
        "no meaning with the coulomb law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\nv_s = 1\n",
        "v_s",
        "no meaning with the coulomb law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"coulomb\"\nmu0 = 1.5\n",
        "mu0",
        "at most mu_s",
    ),
    (
        "[axes]\ntau = [1]\nmu0 = [0.5, 2]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"coulomb\"\n",
        "mu0",
        "at most mu_s",
    ),
    (
        "[axes]\ntau = [1]\nv0 = [0.0, 1]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n",
        "0.0",
        "v0 = 0 is outside its range",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nmu_k = [1, 1]\n",
        "\"table\"",
        "speeds is not given",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\n",
        "\"table\"",
        "mu_k is not given",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [1]\n",
        "mu_k",
        "2 speeds and 1 values of mu_k",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 2, 1]\nmu_k = [1, 1, 1]\n",
        "1",
        "speeds = 1 is outside its range: speeds increase",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [-3, 1]\nmu_k = [1, 1]\n",
        "-3",
        "speeds = -3 is outside its range",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [0.5, 0.0]\n",
        "0.0",
        "mu_k = 0 is outside its range",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, \"x\"]\nmu_k = [1, 1]\n",
        "\"x\"",
        "friction.speeds[1]: expected a number",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [1.5, 0.5]\n",
        "1.5",
        "mu_k = 1.5 is outside its range: at most mu_s",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"table\"\nspeeds = [0, 1]\nmu_k = [1, 0.5]\nmu0 = 1\n",
        "mu0",
        "mu0 has no meaning with the table law",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nv0 = 1\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\nspeeds = [0, 1]\n",
        "speeds",
        "speeds has no meaning with the coulomb law",
    ),
    (
        "[axes]\ntau = [1]\n[units]\nforce = \"N\"\n",
        "units",
        "all three",
    ),
    (
        "[axes]\ntau = [1]\n[units]\nforce = \"N m\"\n",
        "\"N m\"",
        "one word",
    ),
    (
        "[axes]\ntau = [1]\n[units]\nforce = \"abcdefghijklmnopqrstu\"\n",
        "\"abcdefghijklmnopqrstu\"",
        "1 to 20 letters",
    ),
    (
        "[axes]\ntau = [1]\n[tolerance]\nmarginal = 0.5\n",
        "0.5",
        "outside its range",
    ),
    (
        "[axes]\ntau = [1]\n[tolerance]\nmarginal = -1\n",
        "-1",
        "outside its range",
    ),
    // Dashpots are of numbers that are not negative, in units of the three that all are made of.
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\ndamping = -0.1\n",
        "-0.1",
        "damping = -0.1 is outside its range",
    ),
    (
        "[axes]\ntau = [1]\nviscous = [0, -1]\n[fixed]\nmu_prime = 1\n",
        "-1",
        "viscous",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\ndamping = \"0.1 kg\"\n",
        "\"0.1 kg\"",
        "fixed.damping",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\nviscous = { value = 1, unit = \"N\" }\n",
        "{ value = 1, unit = \"N\" }",
        "fixed.viscous: expected a number",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\ndamping = 0.1\n[units]\ndamping = \"kg\"\n",
        "damping",
        "unknown key `units.damping`",
    ),
    (
        "[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\nviscous = 0.1\n[units]\nforce = \"N\"\n",
        "units",
        "force, length and time are needed",
    ),
];

#[test]
fn every_mistake_is_pointed_at() {
    for (text, place, says) in BAD {
        let error = text.parse::<SweepSpec>().expect_err(text);
        assert!(
            error.message.contains(says),
            "{text}\n says: {}",
            error.message
        );
        let span = error.span.unwrap_or(0..0);
        if !place.is_empty() {
            assert_eq!(&text[span], *place, "{text}\n {}", error.message);
        }
    }
}

#[test]
fn a_certificate_comes_with_every_abscissa() {
    let fields = |list: &str| -> Vec<&str> {
        let text = format!("fields = [{list}]\n[axes]\ntau = [1]\n[fixed]\nmu_prime = 1\n");
        let spec: SweepSpec = text.parse().unwrap();
        spec.fields.iter().map(|f| f.name()).collect()
    };
    let both = ["abscissa", "certificate_margin"];
    assert_eq!(fields("\"abscissa\""), both);
    assert_eq!(fields("\"certificate_margin\", \"abscissa\""), both);
    assert_eq!(fields("\"frequency_8\""), ["frequency_8"]);
}

#[test]
fn absurdly_large_maps_are_refused() {
    let axis = "{ from = 0, to = 1, points = 10000000 }";
    let text = format!("[axes]\nmu_prime = {axis}\nalpha_v = {axis}\ntau = [1]\n");
    let error = Plan::new(text.parse().unwrap()).unwrap_err();
    assert!(
        error.message.contains("at most 10000000000000 are allowed"),
        "{}",
        error.message
    );
    let axes = "mass = {}\nstiffness = {}\nnormal_load = {}\n"
        .replace("{}", "{ from = 1, to = 2, points = 10000000 }");
    let text = format!("[axes]\nmu_prime = {axis}\ntau = [1]\n{axes}");
    assert!(text.parse::<SweepSpec>().and_then(Plan::new).is_err());
}

#[test]
fn equal_plans_have_equal_hashes_and_others_not() {
    let hash = |text: &str| Plan::new(text.parse().unwrap()).unwrap().hash();
    let base = "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.1\nalpha_v = 0.5\n";
    assert_eq!(
        hash(base),
        hash("# the same\n[axes]\ntau = [1.0, 2.0]\n[fixed]\nalpha_v = 5e-1\nmu_prime = -0.1\n")
    );
    for other in [
        "[axes]\ntau = [1, 3]\n[fixed]\nmu_prime = -0.1\nalpha_v = 0.5\n",
        "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.1\nalpha_v = 0.6\n",
        "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.1\nalpha_n = 0.5\n",
        "fields = [\"delay_margin\"]\n[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.1\nalpha_v = 0.5\n",
        "[axes]\ntau = [1, 2]\nmu_prime = [-0.1]\n[fixed]\nalpha_v = 0.5\n",
        "[axes]\ntau = [1, 2]\n[fixed]\nmu_prime = -0.1\nalpha_v = 0.5\n[tolerance]\nmarginal = 1e-10\n",
    ] {
        assert_ne!(hash(base), hash(other), "{other}");
    }
}

#[test]
fn a_table_is_part_of_the_plan() {
    let plan = |mu: &str| {
        let text = format!(
            "[axes]\nv0 = [0.5, 1]\ntau = [1]\n[friction]\nlaw = \"table\"\nmu_k = [0.5, {mu}]\nspeeds = [0.0, 2]\n"
        );
        Plan::new(text.parse().unwrap()).unwrap()
    };
    assert_eq!(plan("0.4").hash(), plan("4e-1").hash());
    assert_ne!(plan("0.4").hash(), plan("0.3").hash());
    let sliding = plan("0.4").setting(&[0, 0]).sliding_point().unwrap();
    assert!((sliding.mu_k - 0.475).abs() < 1e-15, "{sliding:?}");
    assert!((sliding.mu_prime + 0.05).abs() < 1e-15, "{sliding:?}");
}
