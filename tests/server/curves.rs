//! Measured curves pasted into the page: the same points, remarks and mistakes as those of files.

use crate::curve_files::{CURVES, MU_K, Read, SPEEDS, path, says};
use crate::program::Folder;
use crate::server::Serving;

/// The text of a file as a browser has it.
fn pasted(file: &str) -> String {
    let bytes = std::fs::read(path(file)).unwrap();
    match (&bytes[..2], String::from_utf8(bytes.clone())) {
        ([0xff, 0xfe], _) => {
            let pairs = bytes[2..].chunks(2);
            let units: Vec<u16> = pairs
                .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
                .collect();
            String::from_utf16(&units).unwrap()
        }
        (_, Ok(text)) => text,
        // What is used of Windows-1252 is in Latin-1 too.
        (_, Err(_)) => bytes.iter().copied().map(char::from).collect(),
    }
}

#[test]
fn the_page_reads_every_curve() {
    let folder = Folder::new();
    let serving = Serving::new(&folder);
    for curve in CURVES {
        let source = format!("text = {}", serde_json::json!(pasted(curve.file)));
        let answer = serving.ask("law", &curve.said.keys(&source));
        let told = answer.json();
        match curve.read {
            Read::Points(remark) => {
                let pairs: Vec<_> = SPEEDS
                    .into_iter()
                    .zip(MU_K)
                    .map(|(v, mu)| [v, mu])
                    .collect();
                assert_eq!(told["points"], serde_json::json!(pairs), "{}", curve.file);
                let remarks = told["remarks"].as_array().unwrap();
                assert_eq!(
                    remarks.is_empty(),
                    remark.is_empty(),
                    "{}: {told}",
                    curve.file
                );
                assert!(
                    remarks
                        .iter()
                        .all(|said| says(said.as_str().unwrap(), remark))
                );
            }
            Read::Refused(message, [_, advice]) => {
                assert_eq!(answer.status, 422, "{}: {told}", curve.file);
                assert!(says(told["detail"].as_str().unwrap(), message), "{told}");
                assert!(says(told["help"].as_str().unwrap(), advice), "{told}");
                let text = curve.said.keys(&source);
                let span = told["span"]
                    .as_array()
                    .map(|span| span[0].as_u64().unwrap() as usize);
                let at = span.map(|start| &text[start..=start]);
                assert_eq!(at, Some("\""), "{}: {told}", curve.file);
            }
        }
    }
}

/// A chart, a point and a motion take a pasted curve; files are not read for the page.
#[test]
fn every_request_takes_a_pasted_curve() {
    let folder = Folder::with(&[("curve.csv", "v,mu\n0,0.5\n1,0.4\n")]);
    let serving = Serving::new(&folder);
    let law = "[friction]\nlaw = \"table\"\ntable = { text = \"v,mu\\n0,0.5\\n1,0.4\" }\n";
    let fixed = "fixed = { v0 = 0.1, alpha_v = -0.1";
    for (request, text) in [
        ("chart", format!("axes.tau = [1, 2]\n{fixed} }}\n{law}")),
        ("point", format!("{fixed}, tau = 1 }}\n{law}")),
        (
            "motion",
            format!("horizon = 10\n{fixed}, tau = 1 }}\n{law}"),
        ),
    ] {
        assert_eq!(serving.ask(request, &text).status, 200, "{request}");
        // A mistake behind the curve is told at its place.
        let wrong = format!("{text}mu_s = -1\n");
        let span = serving.ask(request, &wrong).json()["span"].clone();
        let place = wrong.find("-1\n").unwrap();
        assert_eq!(
            span,
            serde_json::json!([wrong.len() - 3, wrong.len() - 1]),
            "{place}"
        );
        let file = text.replace("text = \"v,mu\\n0,0.5\\n1,0.4\"", "file = \"curve.csv\"");
        let answer = serving.ask(request, &file).json();
        assert!(
            says(answer["detail"].as_str().unwrap(), "it names a file"),
            "{answer}"
        );
    }
}
