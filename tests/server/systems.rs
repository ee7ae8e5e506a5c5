//! Systems from files over real connections: points of them and of cells of their maps, and what
//! is told of one from its text, against the command line.

use crate::program::{self, Folder, expect};
use crate::server::Serving;
use serde_json::Value;

/// A system that is no part of the program, in feedback form.
const OWN: &str = "title = \"Mine\"\nB = \"s^2 + c*s + 1\"\nA = \"k\"\n[parameters]\n\
    c = { default = 0.4, minimum = 0, unit = \"N s\" }\nk = { long_name = \"gain\" }\n";

/// The answer of the server without what is about it.
fn bare(mut answer: Value) -> Value {
    let object = answer.as_object_mut().unwrap();
    for key in ["command", "warning", "schema_version", "inputs"] {
        object.remove(key);
    }
    answer
}

/// What a command says in JSON.
fn told(folder: &Folder, command: &str) -> Value {
    let words: Vec<&str> = command.split(' ').skip(1).collect();
    bare(program::json(
        &folder.run(&[&words[..], &["--json"]].concat()),
    ))
}

#[test]
fn points_of_systems_are_what_the_command_says() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let text = "system = \"turning\"\n[fixed]\nzeta = 0.04\nwidth = 0.3\ntau = 8.5\n";
    let answer = serving.ask("point", text).json();
    let command = "slipmap point --system=turning --set=zeta=0.04 --set=width=0.3 --tau=8.5";
    assert_eq!(answer["command"], format!("{command} --roots=16"));
    assert_eq!(
        told(&folder, answer["command"].as_str().unwrap()),
        bare(answer)
    );
    // One that is no part of the program is in the text of the request.
    let table = OWN.replace("[parameters]", "[system.parameters]");
    let text =
        format!("[system]\n{table}[fixed]\nk = -0.3\ntau = 2\nlatency = 0.25\nmemory = 0.5\n");
    let answer = serving.ask("point", &text).json();
    std::fs::write(folder.path().join("point.toml"), &text).unwrap();
    assert_eq!(
        told(&folder, answer["command"].as_str().unwrap()),
        bare(answer.clone())
    );
    assert_eq!(
        [
            &answer["memory"],
            &answer["latency"],
            &answer["parameters"]["c"]
        ],
        [&Value::from(0.5), &0.25.into(), &0.4.into()]
    );
    let mistake = serving.ask("point", &text.replace("\"k\"", "\"kk\""));
    let [start, _] = [0, 1].map(|end| mistake.json()["span"][end].as_u64().unwrap() as usize);
    assert_eq!(mistake.status, 422);
    assert!(text[start..].starts_with('k'), "{start}");
}

/// The text of a cell is read as the cell's own setting, in its units.
#[test]
fn a_cell_of_a_map_of_a_system_is_a_point() {
    let rest = "fields = [\"n_unstable\", \"delay_margin\"]\n[axes]\nk = [-0.9, -0.1, 0.3]\n\
        tau = [0.5, 2.0, 7.0]\n[fixed]\nlatency = 0.125\n\
        [units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n";
    let folder = Folder::with(&[
        ("own.toml", OWN),
        ("sweep.toml", &format!("system = \"own.toml\"\n{rest}")),
    ]);
    expect(&folder.run(&["run", "sweep.toml", "-o", "map.h5"]), 0, "");
    let serving = Serving::new(&folder);
    let list = serving.get("/api/v1/maps").json();
    let id = list["maps"][0]["id"].as_str().unwrap();
    for (k, tau) in [(0, 0), (1, 1), (2, 2)] {
        let cell = format!("/api/v1/maps/{id}/cell?at=k:{k},tau:{tau}");
        let cell = serving.get(&cell).json();
        let text = cell["point"].as_str().unwrap();
        assert!(cell["vc"].is_null() && cell["motion"].is_null(), "{cell}");
        assert!(text.ends_with("[units]\nforce = \"N\"\nlength = \"mm\"\ntime = \"s\"\n"));
        let point = serving.ask("point", text).json();
        assert_eq!(point["n_unstable"], cell["fields"]["n_unstable"]);
        let margin = match point["delay_margin_kind"].as_str().unwrap() {
            "infinite" => "inf".into(),
            _ => point["delay_margin"].clone(),
        };
        assert_eq!(margin, cell["fields"]["delay_margin"]);
        let [k, tau] = ["k", "tau"].map(|axis| cell["axes"][axis].as_f64().unwrap());
        let command = format!("slipmap point --map map.h5 --at k={k} --at tau={tau} --roots=16");
        assert_eq!(told(&folder, &command), bare(point));
    }
}

/// A map tells the speed of a delay that is a period, where there is a unit of time for it.
#[test]
fn the_speed_along_a_map_is_told() {
    let sweep = "system = \"turning\"\n[axes]\nwidth = [0.1]\ntau = [0.02, 0.03]\n";
    let si = format!("units = \"SI\"\n{sweep}").replace("tau = [0.02, 0.03]", "rpm = [2000, 3000]");
    let folder = Folder::with(&[("plain.toml", sweep), ("si.toml", &si)]);
    for name in ["plain", "si"] {
        let (sweep, map) = (format!("{name}.toml"), format!("{name}.h5"));
        expect(&folder.run(&["run", &sweep, "-o", &map]), 0, "");
    }
    let serving = Serving::new(&folder);
    let list = serving.get("/api/v1/maps").json();
    for map in list["maps"].as_array().unwrap() {
        let id = map["id"].as_str().unwrap();
        let axes = serving.get(&format!("/api/v1/maps/{id}")).json()["axes"].clone();
        assert!(axes[0]["speed"].is_null());
        assert_eq!(axes[1]["values"], serde_json::json!([0.02, 0.03]));
        let speed = match map["name"].as_str().unwrap() {
            "si.h5" => serde_json::json!({"name": "spindle speed", "unit": "rpm", "turn": 60.0}),
            _ => Value::Null,
        };
        assert_eq!(axes[1]["speed"], speed, "{map}");
    }
    let point = |fixed: &str| {
        let text = format!("system = \"turning\"\nunits = \"SI\"\n[fixed]\n{fixed}\n");
        bare(serving.ask("point", &text).json())
    };
    assert_eq!(point("rpm = 3000"), point("tau = 0.02"));
}

/// What the page offers of a system is what texts take of it.
#[test]
fn systems_are_told_by_name_and_by_text() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    let known = serving.get("/api/v1/parameters").json();
    let systems = known["systems"].as_array().unwrap();
    let turning = systems.iter().find(|of| of["name"] == "turning").unwrap();
    let mut by_text = serving
        .ask("system", turning["toml"].as_str().unwrap())
        .json();
    assert!(by_text["name"].is_null());
    for key in ["name", "value"] {
        by_text[key] = turning[key].clone();
    }
    assert_eq!(by_text, *turning);
    let own = serving.ask("system", OWN).json();
    assert_eq!(
        own["others"],
        serde_json::json!(["tau", "memory", "latency"])
    );
    assert_eq!(own["own"][0]["unit"], "N s");
    assert_eq!(
        own["own"][0]["page"]["slider"],
        serde_json::json!([0.0, 0.8])
    );
    let chart = format!(
        "system = {}\n[axes]\n{} = [0.1, 0.2]\ntau = [1, 2]\n",
        own["value"].as_str().unwrap(),
        own["own"][1]["name"].as_str().unwrap()
    );
    assert_eq!(serving.ask("chart", &chart).status, 200);
    // Each field that is offered can be asked for, and no other one.
    for field in known["fields"].as_array().unwrap() {
        let text = format!("fields = [{}]\n{chart}", field["name"]);
        let offered = own["fields"].as_array().unwrap().contains(&field["name"]);
        let answer = serving.ask("chart", &text);
        assert_eq!(answer.status == 200, offered, "{field}");
    }
    let mistake = serving.ask("system", &OWN.replace("c*s", "c*t")).json();
    let [start, end] = [0, 1].map(|end| mistake["span"][end].as_u64().unwrap() as usize);
    assert_eq!(&OWN.replace("c*s", "c*t")[start..end], "t");
    // A file is not opened for who asks.
    std::fs::write(folder.path().join("own.toml"), OWN).unwrap();
    let text = "system = \"own.toml\"\n[fixed]\ntau = 1\n";
    assert_eq!(serving.ask("point", text).status, 422);
}
