//! What a field, a parameter and a friction law that were added tell: a map of them, written to the
//! path that is given.

use std::sync::Arc;

use slipmap::maps::maker::make_in_memory;
use slipmap::sweep::described::root::Provenance;
use slipmap::setting::SweepSpec;
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

fn main() {
    let path = std::env::args().nth(1).expect("a path");
    let spec: SweepSpec = SWEEP.parse().expect("a sweep");
    let plan = Arc::new(Plan::new(spec).expect("a plan"));
    let provenance = Provenance::default();
    make_in_memory(&plan, path.as_ref(), 1, &provenance).expect("a map");
}
