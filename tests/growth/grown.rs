//! What a field, a parameter and a friction law that were added tell: a map of them, written to the
//! path that is given; and the command line with a command that was added.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use slipmap::maps::maker::make_in_memory;
use slipmap::setting::SweepSpec;
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::Plan;

/// Without control, at c = 0 and above.
const SWEEP: &str = "
fields = [\"outcome\", \"period\", \"abscissa\"]
[axes]
viscosity = [0.0, 0.3]
tau = [1.0]
[fixed]
v0 = 0.2
x_dot0 = 0.0
[friction]
law = \"viscous\"
mu0 = 0.5
";

fn main() -> ExitCode {
    let path = std::env::args().nth(1).expect("a path, or a command");
    if Path::new(&path).extension().is_none() {
        return slipmap::cli::main();
    }
    let spec: SweepSpec = SWEEP.parse().expect("a sweep");
    let plan = Arc::new(Plan::new(spec).expect("a plan"));
    let provenance = Provenance::default();
    make_in_memory(&plan, path.as_ref(), 1, &provenance).expect("a map");
    ExitCode::SUCCESS
}
