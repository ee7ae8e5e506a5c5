//! A programme of the pulling velocity: v0 in time, in steps and ramps.
//!
//! v0 is that of the case until the first corner. At a corner it jumps, or it comes there on a
//! straight line from the corner before; the first line begins at t = 0 with the v0 of the case.
//! After the last corner it stays.

use crate::model::ModelError;

/// The most corners of a programme.
pub const MOST_CORNERS: usize = 1000;

/// A corner of a programme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// When; later than the corner before, and than 0.
    pub at: f64,
    /// v0 from then on; greater than 0, within the limits of the actuator.
    pub v0: f64,
    /// Whether v0 comes there on a straight line from the corner before, rather than by a jump.
    pub ramp: bool,
}

impl Corner {
    /// The slope of v0 on the way here from `v0` at the time `from`.
    pub(super) fn slope_from(&self, (from, v0): (f64, f64)) -> f64 {
        match self.ramp {
            true => (self.v0 - v0) / (self.at - from),
            false => 0.0,
        }
    }
}

/// What is wrong with a corner.
#[derive(Debug, Clone, PartialEq)]
pub struct WrongCorner {
    /// Its index.
    pub index: usize,
    /// The error, of `programme.at` or `programme.v0`.
    pub error: ModelError,
}

/// The corners of a programme in the order of time; none for a v0 that stays what it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Programme(pub Vec<Corner>);

impl Programme {
    /// The name of the time of a corner in errors.
    pub const AT: &'static str = "programme.at";
    /// The name of the v0 of a corner in errors.
    pub const V0: &'static str = "programme.v0";

    /// The last corner.
    #[must_use]
    pub fn last(&self) -> Option<&Corner> {
        self.0.last()
    }

    /// The corners in units of `time` and `velocity`.
    pub(super) fn over(&self, time: f64, velocity: f64) -> Box<[Corner]> {
        let over = |corner: &Corner| Corner {
            at: corner.at / time,
            v0: corner.v0 / velocity,
            ramp: corner.ramp,
        };
        self.0.iter().map(over).collect()
    }

    /// Checks that times increase from 0 on, and that every v0 is greater than 0 and within the
    /// `limits` of the actuator.
    ///
    /// # Errors
    /// The first corner that is wrong.
    pub fn check(&self, [least, most]: [f64; 2]) -> Result<(), WrongCorner> {
        let mut before = 0.0;
        for (index, corner) in self.0.iter().enumerate() {
            let wrong = |error| WrongCorner { index, error };
            let Corner { at, v0, .. } = *corner;
            let later = match index {
                0 => "later than 0; v0 itself says where it begins",
                _ => "later than the entry before",
            };
            ModelError::check(Self::AT, at, later, at > before).map_err(wrong)?;
            ModelError::positive(Self::V0, v0).map_err(wrong)?;
            let within = least < v0 && v0 < most;
            let allowed = "within the limits of the actuator, v_min and v_max";
            ModelError::check(Self::V0, v0, allowed, within).map_err(wrong)?;
            before = at;
        }
        let few = self.0.len() <= MOST_CORNERS;
        let number = self.0.len() as f64;
        let counted = ModelError::check("programme", number, "at most 1000 entries", few);
        counted.map(drop).map_err(|error| WrongCorner {
            index: MOST_CORNERS,
            error,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    fn steps(of: &[(f64, f64)]) -> Programme {
        let corner = |&(at, v0)| Corner {
            at,
            v0,
            ramp: false,
        };
        Programme(of.iter().map(corner).collect())
    }

    #[test]
    fn corners_are_in_order_and_within_limits() {
        let good = steps(&[(1.0, 0.2), (2.0, 0.1), (2.5, 0.3)]);
        assert_eq!(good.check(FREE), Ok(()));
        assert_eq!(Programme::default().check(FREE), Ok(()));
        for (corners, limits, index, name) in [
            (vec![(0.0, 1.0)], FREE, 0, "programme.at"),
            (vec![(-1.0, 1.0)], FREE, 0, "programme.at"),
            (vec![(f64::INFINITY, 1.0)], FREE, 0, "programme.at"),
            (vec![(1.0, 1.0), (1.0, 2.0)], FREE, 1, "programme.at"),
            (
                vec![(1.0, 1.0), (3.0, 2.0), (2.0, 2.0)],
                FREE,
                2,
                "programme.at",
            ),
            (vec![(1.0, 1.0), (2.0, 0.0)], FREE, 1, "programme.v0"),
            (vec![(1.0, f64::NAN)], FREE, 0, "programme.v0"),
            (vec![(1.0, 0.3), (2.0, 0.5)], [0.1, 0.5], 1, "programme.v0"),
            (vec![(1.0, 0.05)], [0.1, 0.5], 0, "programme.v0"),
        ] {
            let wrong = steps(&corners).check(limits).unwrap_err();
            assert_eq!((wrong.index, wrong.error.parameter), (index, name));
        }
        let many: Vec<_> = (1..=1001).map(|i| (f64::from(i), 1.0)).collect();
        assert_eq!(steps(&many[..MOST_CORNERS]).check(FREE), Ok(()));
        let wrong = steps(&many).check(FREE).unwrap_err();
        assert_eq!(wrong.error.parameter, "programme");
    }

    #[test]
    fn a_ramp_has_the_slope_from_the_corner_before() {
        let corner = |ramp| Corner {
            at: 5.0,
            v0: 3.0,
            ramp,
        };
        assert_eq!(corner(true).slope_from((1.0, 1.0)), 0.5);
        assert_eq!(corner(false).slope_from((1.0, 1.0)), 0.0);
    }
}
