//! Small sweeps of every kind of field, system, feedback and friction.

use slipmap::setting::SweepSpec;
use slipmap::sweep::Plan;

pub(crate) const SWEEPS: [&str; 12] = [
    "fields = [\"n_unstable\", \"abscissa\", \"delay_margin\"]\nboundaries = true\n\
     degree_of_stability = [0.05]\nbest = true\n[axes]\nmu_prime = [-0.1, -0.3]\n\
     alpha_v = [-1, -0.5, 0]\ntau = [0, 2, 4, 6]\n\
     [units]\nforce = \"N\"\nlength = \"m\"\ntime = \"s\"\n",
    "fields = [\"gain_margin_upper\", \"phase_margin\"]\nbest = true\n[axes]\n\
     alpha_n = [-1, -0.5]\ntau = [0.5, 1]\n[fixed]\nmu_prime = -0.3\n",
    "boundaries = true\n[axes]\nalpha_n = [-3, -1, 1]\nalpha_v = [-1, 1]\n[fixed]\ntau = 1\n\
     mu_prime = -0.3\n",
    "fields = [\"vc\", \"regime\", \"windows\", \"n_unstable\"]\n[axes]\nalpha_v = [-0.5, 0]\n\
     [fixed]\ntau = 4\nv0 = 0.35\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n",
    "fields = [\"basin_share\"]\n[axes]\ntau = [4, 5]\n[fixed]\nalpha_v = -0.33\nv0 = 0.35\n\
     [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n\
     [basin]\nstarts = 64\nx_dot0 = { from = 0.0, to = 0.5 }\n",
    "fields = [\"outcome\", \"settle_time\", \"n_min\"]\n[axes]\nalpha_v = [-0.33, 0]\ntau = [4, 5]\n\
     [fixed]\nv0 = 0.35\n[friction]\nlaw = \"table\"\nspeeds = [0, 0.2, 1]\nmu_k = [0.9, 0.7, 0.6]\n",
    "system = \"turning\"\nboundaries = true\n[axes]\nwidth = [0, 0.3]\ntau = [1, 4, 8]\n",
    "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\ndegree_of_stability = [0.02]\n\
     best = true\n[axes]\nalpha_v = [-0.6, -0.3]\ntau = [2, 4, 6]\n\
     [fixed]\nmu_prime = -0.3\nmemory = 0.4\n",
    "fields = [\"n_unstable\", \"latency_margin\"]\n[axes]\nalpha_n = [-0.6, -0.3]\n\
     tau = [2, 4]\n[fixed]\nmu_prime = -0.1\nlatency = 0.2\n",
    "fields = [\"n_unstable\", \"delay_margin\", \"gain_margin_lower\"]\n[axes]\n\
     load_lag = [0.1, 0.3]\ntau = [1, 4]\n[fixed]\nmu_prime = -0.1\nalpha_n = -0.4\n\
     velocity_lag = 0.2\nsensor_lag = 0.1\n",
    "fields = [\"n_unstable\", \"delay_margin\", \"d_abscissa_d_alpha_v\"]\nboundaries = true\n\
     best = true\n[axes]\nalpha_v = [-0.6, -0.3]\ndamping = [0.0, 0.2]\ntau = [1, 4]\n\
     [fixed]\nmu_prime = -0.6\nviscous = 0.1\n",
    "fields = [\"n_unstable\", \"stiffness_ratio\", \"essential_abscissa\"]\n[axes]\n\
     v0 = [0.05, 0.2]\ntau = [1, 4]\n[fixed]\nalpha_v = -0.3\n[friction]\n\
     law = \"rate-and-state\"\nmu0 = 0.6\nv_star = 0.1\ndirect_effect = 0.02\n\
     evolution_effect = 0.03\nslip_distance = 0.05\n",
];

/// The plan of a sweep.
pub(crate) fn plan(text: &str) -> Plan {
    Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap()
}
