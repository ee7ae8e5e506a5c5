//! Manual pages and completions.

use crate::program::{Folder, expect, out};

#[test]
fn manual_pages_name_every_flag() {
    let folder = Folder::new();
    let page = out(&folder.run(&["man"]));
    assert!(page.contains(".TH slipmap 1"), "{page}");
    for command in ["run", "point", "vc", "margins", "completions"] {
        assert!(
            page.contains(&format!("slipmap\\-{command}(1)")),
            "{command}"
        );
    }
    assert!(!page.contains("read\\-map"), "hidden");
    let page = out(&folder.run(&["man", "vc"]));
    for flag in ["friction", "alpha\\-n", "protocol", "json"] {
        assert!(page.contains(&format!("\\-\\-{flag}")), "{flag}");
    }
    expect(&folder.run(&["man", "vz"]), 2, "there is no command vz");
    expect(&folder.run(&["man", "-o", "nowhere"]), 1, "nowhere");
    std::fs::create_dir(folder.path().join("pages")).unwrap();
    expect(&folder.run(&["man", "-o", "pages"]), 0, "");
    let pages = std::fs::read_dir(folder.path().join("pages"))
        .unwrap()
        .count();
    assert!(pages > 15, "{pages}");
    assert!(folder.path().join("pages/slipmap-run.1").exists());
    assert!(folder.path().join("pages/slipmap.1").exists());
}

/// bash reads its script and knows what it completes.
#[test]
fn completions_are_read_by_their_shell() {
    let folder = Folder::new();
    for (shell, says) in [
        ("bash", "complete -F _slipmap"),
        ("zsh", "#compdef slipmap"),
        ("fish", "complete -c slipmap"),
    ] {
        let script = out(&folder.run(&["completions", shell]));
        assert!(script.contains(says), "{shell}");
        std::fs::write(folder.path().join(shell), script).unwrap();
    }
    expect(&folder.run(&["completions", "cmd"]), 2, "possible values");
    let asked = "source ./bash; COMP_WORDS=(slipmap ve); COMP_CWORD=1; \
                 _slipmap slipmap ve slipmap; echo \"${COMPREPLY[@]}\"";
    let answer = std::process::Command::new("bash")
        .args(["-c", asked])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(out(&answer).trim(), "verify");
}
