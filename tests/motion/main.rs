//! Motions and what is made of them: outcomes, shares of starts, critical velocities, switching on.

#[path = "../common/chance.rs"]
mod chance;
#[path = "../common/chance_problem.rs"]
mod chance_problem;
#[path = "../common/map.rs"]
mod map;
#[path = "../common/program.rs"]
mod program;
#[path = "../common/signal.rs"]
mod signal;

mod basin;
mod basins;
mod critical;
mod feedback;
mod forces;
mod held;
mod integrator;
mod letter_vc;
mod limit;
mod measure;
mod simulate;
mod switch_on;
mod times;
mod vc_maps;
