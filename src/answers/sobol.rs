//! Points of a Sobol sequence, scrambled by Owen's method; the only file that imports sobol_burley.

use crate::model::elementary::normals;

/// A coordinate of a point, in [0, 1); every seed is a scrambling of its own.
pub(super) fn part(number: u32, dimension: u32, seed: u32) -> f64 {
    f64::from(sobol_burley::sample(number, dimension, seed))
}

/// Two independent numbers of the standard normal distribution from the first two coordinates.
pub(super) fn normal(number: u32, seed: u32) -> [f64; 2] {
    normals([0, 1].map(|dimension| part(number, dimension, seed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_normal() {
        let draws: Vec<[f64; 2]> = (0..1000).map(|n| normal(n, 0)).collect();
        let mean = |of: &dyn Fn(&[f64; 2]) -> f64| draws.iter().map(of).sum::<f64>() / 1000.0;
        for i in 0..2 {
            assert!(mean(&|z| z[i]).abs() < 0.01);
            assert!((mean(&|z| z[i] * z[i]) - 1.0).abs() < 0.02);
            // 95 % lie within 1.96.
            let within = mean(&|z| f64::from(u8::from(z[i].abs() < 1.959_964)));
            assert!((within - 0.95).abs() < 0.01, "{within}");
        }
        assert!(mean(&|z| z[0] * z[1]).abs() < 0.02);
    }
}
