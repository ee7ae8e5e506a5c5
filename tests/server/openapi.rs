//! The description of the interface against what the server answers.

use std::collections::BTreeSet;

use crate::program::{self, Folder};
use crate::server::{Serving, decoded};
use serde_json::Value;

const METHODS: [&str; 4] = ["get", "post", "patch", "delete"];

/// What is described.
pub(crate) struct Described(Value);

impl Described {
    pub(crate) fn of(serving: &Serving) -> Self {
        let bearer = serving.bearer();
        let answer = serving.request(
            "GET /api/v1/openapi.json",
            &[("Authorization", &bearer)],
            "",
        );
        assert_eq!(answer.status, 200);
        Self(answer.json())
    }

    /// Addresses with their methods and what is said of them.
    fn operations(&self) -> Vec<(&str, &str, &Value)> {
        let paths = self.0["paths"].as_object().unwrap().iter();
        let all = paths.flat_map(|(path, methods)| {
            let methods = methods.as_object().unwrap().iter();
            methods.map(move |(method, about)| (path.as_str(), method.as_str(), about))
        });
        all.collect()
    }

    /// What is said of the answer to a request.
    pub(crate) fn answer(&self, path: &str, method: &str, status: &str) -> &Value {
        let content = &self.0["paths"][path][method]["responses"][status]["content"];
        let (_, content) = content.as_object().unwrap().iter().next().unwrap();
        &content["schema"]
    }

    fn schema<'s>(&'s self, schema: &'s Value) -> &'s Value {
        match schema["$ref"].as_str() {
            Some(name) => {
                let name = name.strip_prefix("#/components/schemas/").unwrap();
                &self.0["components"]["schemas"][name]
            }
            None => schema,
        }
    }

    /// Everything that a schema says of an object's properties.
    fn properties<'s>(
        &'s self,
        schema: &'s Value,
        found: &mut Vec<(&'s str, &'s Value)>,
        required: &mut BTreeSet<&'s str>,
    ) {
        let schema = self.schema(schema);
        for part in schema["allOf"].as_array().into_iter().flatten() {
            self.properties(part, found, required);
        }
        let own = schema["properties"].as_object().into_iter().flatten();
        found.extend(own.map(|(name, of)| (name.as_str(), of)));
        let needed = schema["required"].as_array().into_iter().flatten();
        required.extend(needed.filter_map(Value::as_str));
    }

    /// Whether an object has all that its schema needs.
    fn has_needed(&self, schema: &Value, value: &Value) -> bool {
        let (mut known, mut required) = (Vec::new(), BTreeSet::new());
        self.properties(schema, &mut known, &mut required);
        required.into_iter().all(|name| value.get(name).is_some())
    }

    /// A value is what its schema says: with all that it needs, and nothing that is not named.
    pub(crate) fn check(&self, schema: &Value, value: &Value, at: &str) {
        let schema = self.schema(schema);
        if let Some(choices) = schema["oneOf"].as_array() {
            let fits = |of: &&Value| {
                let of = self.schema(of);
                kinds(value).iter().any(|kind| has(of, kind))
                    || (of.get("allOf").is_some() && self.has_needed(of, value))
            };
            let fitting = choices.iter().find(fits);
            let fitting = fitting.unwrap_or_else(|| panic!("{at}: {value} is none of {schema}"));
            return self.check(fitting, value, at);
        }
        if schema.get("allOf").is_none() {
            let fits = kinds(value).iter().any(|kind| has(schema, kind));
            assert!(fits, "{at} is {value}, described as {schema}");
        }
        match value {
            Value::Object(entries) => {
                let (mut known, mut required) = (Vec::new(), BTreeSet::new());
                self.properties(schema, &mut known, &mut required);
                for name in required {
                    assert!(entries.contains_key(name), "{at}.{name} is missing");
                }
                for (name, value) in entries {
                    let of = known.iter().find(|(known, _)| known == name);
                    let of = of.map(|(_, of)| *of);
                    let of = of.or(schema.get("additionalProperties"));
                    let of = of.unwrap_or_else(|| panic!("{at}.{name} is not described"));
                    self.check(of, value, &format!("{at}.{name}"));
                }
            }
            Value::Array(values) => {
                for value in values {
                    self.check(&schema["items"], value, &format!("{at}[]"));
                }
            }
            _ => {}
        }
    }
}

/// The types that a value has.
fn kinds(value: &Value) -> &'static [&'static str] {
    match value {
        Value::Object(_) => &["object"],
        Value::Array(_) => &["array"],
        Value::String(_) => &["string"],
        Value::Bool(_) => &["boolean"],
        Value::Null => &["null"],
        Value::Number(number) if number.is_f64() => &["number"],
        Value::Number(_) => &["number", "integer"],
    }
}

/// Whether a schema allows values of this type.
fn has(schema: &Value, kind: &str) -> bool {
    match &schema["type"] {
        Value::Array(kinds) => kinds.iter().any(|of| of == kind),
        of => of == kind,
    }
}

#[test]
fn the_description_is_as_it_was() {
    let folder = Folder::new();
    let described = Described::of(&Serving::new(&folder));
    let version = format!("\"{}\"", slipmap::VERSION);
    let text = serde_json::to_string_pretty(&described.0).unwrap();
    insta::assert_snapshot!(text.replace(&version, "\"[version]\""));
}

/// A key whose value may be missing is there with null. Only problems, arrays without runs or kinds,
/// and requests leave keys out.
#[test]
fn keys_are_always_there() {
    let folder = Folder::new();
    let described = Described::of(&Serving::new(&folder));
    let optional = [
        ("Array", "runs"),
        ("FieldHead", "gaps"),
        ("FieldHead", "kinds"),
        ("FieldHead", "shown"),
        ("JobChange", "first"),
        ("JobChange", "state"),
        ("Problem", "detail"),
        ("Problem", "help"),
        ("Problem", "span"),
    ];
    let schemas = described.0["components"]["schemas"].as_object().unwrap();
    let mut checked = 0;
    for (name, schema) in schemas {
        let parts = schema["allOf"].as_array().into_iter().flatten();
        for part in parts.chain([schema]) {
            let required = part["required"].as_array().into_iter().flatten();
            let required: BTreeSet<_> = required.filter_map(Value::as_str).collect();
            for key in part["properties"].as_object().into_iter().flatten() {
                let key = key.0.as_str();
                let always = !optional.contains(&(name.as_str(), key));
                assert_eq!(required.contains(key), always, "{name}.{key}");
                checked += 1;
            }
        }
    }
    assert!(checked > 200, "{checked}");
}

/// Its own examples are answered with what it says.
#[test]
fn answers_have_the_fields_that_are_named() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let described = Described::of(&serving);
    let bearer = serving.bearer();
    let mut checked = 0;
    for (path, method, about) in described.operations() {
        // What is in a folder is another test's.
        let of_folder = ["/api/v1/maps", "/api/v1/jobs", "/api/v1/events"];
        if of_folder.iter().any(|of| path.starts_with(of)) {
            continue;
        }
        let body = &about["requestBody"]["content"]["application/toml"]["example"];
        let mut headers = vec![("Authorization", &*bearer)];
        headers.extend(body.as_str().map(|_| ("Content-Type", "application/toml")));
        let line = format!("{} {path}", method.to_uppercase());
        let answer = serving.request(&line, &headers, body.as_str().unwrap_or(""));
        assert_eq!(answer.status, 200, "{line}");
        let content = about["responses"]["200"]["content"].as_object().unwrap();
        let (kind, of) = content.iter().next().unwrap();
        assert!(answer.head.contains(&format!("content-type: {kind}")));
        let head = match path {
            "/api/v1/chart" => Some("ChartHead"),
            "/api/v1/motion" => Some("MotionHead"),
            _ => None,
        };
        match head {
            Some(name) => {
                let schema = &described.0["components"]["schemas"][name];
                described.check(schema, &decoded(&answer.body).0, path);
            }
            None => described.check(&of["schema"], &answer.json(), path),
        }
        checked += 1;
    }
    assert!(checked >= 6, "{checked}");
    let of_system = serving.ask("point", "system = \"turning\"\n[fixed]\ntau = 1\n");
    let schema = described.answer("/api/v1/point", "post", "200");
    described.check(schema, &of_system.json(), "a point of a system");
    let problem = serving.ask("point", "[fixed]\ntau = -1\n");
    let schema = &described.0["components"]["schemas"]["Problem"];
    described.check(schema, &problem.json(), "problem");
}

const SWEEP: &str = "title = \"a map\"\nboundaries = true\nfields = [\"n_unstable\", \"relaxation_time\", \
    \"outcome\"]\n[axes]\nalpha_v = { from = -1.0, to = 0.2, points = 5 }\ntau = [0.5, 1.0, 4.15]\n[fixed]\n\
    v0 = 0.35\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";

/// So are answers about a map, and about one that is none.
#[test]
fn answers_about_maps_have_the_fields_that_are_named() {
    let folder = Folder::with(&[("sweep.toml", SWEEP), ("odd.h5", "no map")]);
    let made = folder.run(&["run", "sweep.toml"]);
    assert!(made.status.success(), "{}", program::err(&made));
    let serving = Serving::new(&folder);
    let described = Described::of(&serving);
    let bearer = serving.bearer();
    let ask = |path: &str| {
        let line = format!("GET /api/v1/maps{path}");
        serving.request(&line, &[("Authorization", &bearer)], "")
    };
    let schema = |path: &str| {
        let about = &described.0["paths"][format!("/api/v1/maps{path}")]["get"];
        let content = about["responses"]["200"]["content"].as_object().unwrap();
        content.values().next().unwrap()["schema"].clone()
    };
    let list = ask("").json();
    described.check(&schema(""), &list, "list");
    let maps = list["maps"].as_array().unwrap();
    assert_eq!(maps.len(), 2, "{list}");
    let map = maps.iter().find(|map| map["state"] == "complete").unwrap();
    let id = map["id"].as_str().unwrap();
    described.check(&schema("/{id}"), &ask(&format!("/{id}")).json(), "map");
    for at in ["alpha_v:0,tau:0", "alpha_v:4,tau:2"] {
        let cell = ask(&format!("/{id}/cell?at={at}")).json();
        described.check(&schema("/{id}/cell"), &cell, "cell");
    }
    for (asked, head) in [
        (
            "window?field=n_unstable&x=alpha_v&y=tau&w=7&h=9",
            "WindowHead",
        ),
        (
            "window?field=outcome&x=tau&at=alpha_v:2&xscale=log",
            "WindowHead",
        ),
        ("curves?x=alpha_v&y=tau", "CurvesHead"),
    ] {
        let answer = ask(&format!("/{id}/{asked}"));
        assert_eq!(answer.status, 200, "{asked}");
        let schema = &described.0["components"]["schemas"][head];
        described.check(schema, &decoded(&answer.body).0, asked);
    }
    assert_eq!(ask(&format!("/{id}/sweep")).body, SWEEP.as_bytes());
    let problem = &described.0["components"]["schemas"]["Problem"];
    for (asked, status) in [
        ("/0123456789abcdef", 404),
        (&format!("/{id}/window?field=none&x=tau"), 422),
        (&format!("/{id}/window?x=tau"), 422),
    ] {
        let answer = ask(asked);
        assert_eq!(answer.status, status, "{asked}");
        described.check(problem, &answer.json(), asked);
    }
}

/// So are answers about a trace.
#[test]
fn answers_about_traces_have_the_fields_that_are_named() {
    let case = include_str!("../../sweeps/fig3a.toml");
    let folder = Folder::with(&[("case.toml", case)]);
    let made = folder.run(&["simulate", "case.toml", "-o", "trace.h5"]);
    assert!(made.status.success(), "{}", program::err(&made));
    let serving = Serving::new(&folder);
    let described = Described::of(&serving);
    let list = serving.get("/api/v1/maps").json();
    described.check(
        described.answer("/api/v1/maps", "get", "200"),
        &list,
        "list",
    );
    let address = format!("/api/v1/maps/{}", list["maps"][0]["id"].as_str().unwrap());
    let schema = described.answer("/api/v1/maps/{id}", "get", "200");
    described.check(schema, &serving.get(&address).json(), "trace");
    let motion = serving.get(&format!("{address}/motion"));
    let head = &described.0["components"]["schemas"]["MotionHead"];
    described.check(head, &decoded(&motion.body).0, "motion of a trace");
}

/// Every address of the interface is described, with every parameter where it is.
#[test]
fn nothing_is_left_out() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let described = Described::of(&serving);
    let known: BTreeSet<_> = described
        .operations()
        .iter()
        .map(|of| of.0.to_owned())
        .collect();
    for name in described
        .0
        .to_string()
        .split("\"$ref\":\"#/components/schemas/")
        .skip(1)
    {
        let name = name.split('"').next().unwrap();
        assert!(
            described.0["components"]["schemas"][name].is_object(),
            "{name}"
        );
    }
    let mut named = BTreeSet::new();
    let mut folders = vec![std::path::PathBuf::from("src/serve")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.extension() {
                _ if path.is_dir() => folders.push(path),
                Some(kind) if kind == "rs" => {
                    let text = std::fs::read_to_string(path).unwrap();
                    let strings = text.split('"').filter(|part| part.starts_with("/api/"));
                    named.extend(strings.map(str::to_owned));
                }
                _ => {}
            }
        }
    }
    assert!(named.remove("/api/v1/openapi.json"));
    assert_eq!(named, known);
    let bearer = serving.bearer();
    for (path, method, about) in described.operations() {
        assert!(METHODS.contains(&method), "{path} {method}");
        for parameter in about["parameters"].as_array().into_iter().flatten() {
            let name = parameter["name"].as_str().unwrap();
            let place = match path.contains(&format!("{{{name}}}")) {
                true => "path",
                false => "query",
            };
            assert_eq!(parameter["in"], place, "{path} {name}");
        }
        assert!(about["responses"]["401"].is_object(), "{path}");
        let line = format!("{} {path}", method.to_uppercase());
        assert_eq!(serving.request(&line, &[], "").status, 401, "{line}");
        let line = format!("PUT {path}");
        let refused = serving.request(&line, &[("Authorization", &bearer)], "");
        assert_eq!(refused.status, 405, "{line}");
    }
}

/// The guide lists every request, with its body and its query.
#[test]
fn the_guide_names_every_request() {
    let page = std::fs::read_to_string("doc/guide/reference/server.md").unwrap();
    let listed: BTreeSet<&str> = page
        .lines()
        .filter(|line| line.contains(" /api/v1/"))
        .collect();
    let folder = Folder::new();
    let serving = Serving::submitting(&folder, &[]);
    let described = Described::of(&serving);
    let row = |(path, method, about): (&str, &str, &Value)| {
        let code = |name: &str| format!("`{name}`");
        let body = about["requestBody"]["content"].as_object().into_iter();
        let body: Vec<String> = body.flatten().map(|(kind, _)| code(kind)).collect();
        let query = about["parameters"].as_array().into_iter().flatten();
        let query = query.filter(|of| of["in"] == "query");
        let query: Vec<String> = query.map(|of| code(of["name"].as_str().unwrap())).collect();
        let summary = about["summary"].as_str().unwrap();
        let (method, body, query) = (method.to_uppercase(), body.join(", "), query.join(", "));
        format!("| `{method} {path}` | {summary} | {body} | {query} |")
    };
    let rows: Vec<String> = described.operations().into_iter().map(row).collect();
    let expected: BTreeSet<&str> = rows.iter().map(String::as_str).collect();
    let listed: BTreeSet<&str> = listed
        .into_iter()
        .filter(|line| line.starts_with('|'))
        .collect();
    assert_eq!(listed, expected);
}
