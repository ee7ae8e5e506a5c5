//! What the elongation was: cubic Hermite polynomials between the ends of steps.

use std::cell::Cell;

/// The end of a step: time, elongation, and its rate just before and just after.
#[derive(Debug, Clone, Copy)]
struct Node {
    t: f64,
    a: f64,
    before: f64,
    after: f64,
}

/// The elongation up to now; before the first node, and beyond the last one, it goes on evenly.
#[derive(Debug, Clone)]
pub(crate) struct Past {
    nodes: Vec<Node>,
    /// Where it was looked up last: the next look-up is near.
    place: Cell<usize>,
}

impl Past {
    /// An elongation that has grown to `a` at time `t` at a constant rate.
    pub(crate) fn rising(t: f64, a: f64, rate: f64) -> Self {
        let node = Node {
            t,
            a,
            before: rate,
            after: rate,
        };
        Self {
            nodes: vec![node],
            place: Cell::new(0),
        }
    }

    /// The next step sets out at this rate.
    pub(crate) fn leave(&mut self, rate: f64) {
        if let Some(last) = self.nodes.last_mut() {
            last.after = rate;
        }
    }

    /// A step has ended.
    pub(crate) fn arrive(&mut self, t: f64, a: f64, rate: f64) {
        self.nodes.push(Node {
            t,
            a,
            before: rate,
            after: rate,
        });
    }

    /// The end of the last step.
    pub(crate) fn last(&self) -> f64 {
        self.nodes.last().map_or(f64::NEG_INFINITY, |node| node.t)
    }

    /// The elongation at a time, and its rate.
    pub(crate) fn at(&self, t: f64) -> (f64, f64) {
        let i = self.find(t);
        let first = &self.nodes[i];
        if t < first.t {
            return (first.a + first.before * (t - first.t), first.before);
        }
        let Some(next) = self.nodes.get(i + 1) else {
            return (first.a + first.after * (t - first.t), first.after);
        };
        let h = next.t - first.t;
        let q = (t - first.t) / h;
        let p = 1.0 - q;
        let rise = next.a - first.a;
        // The chord, and what the rates at its ends add to it.
        let value = first.a
            + rise * q * q * (1.0 + 2.0 * p)
            + h * q * p * (first.after * p - next.before * q);
        let rate = 6.0 * q * p * rise / h
            + first.after * p * (1.0 - 3.0 * q)
            + next.before * q * (1.0 - 3.0 * p);
        (value, rate)
    }

    /// The rates just before and just after a time.
    pub(crate) fn rates_beside(&self, t: f64, beside: f64) -> [f64; 2] {
        [t - beside, t + beside].map(|t| self.at(t).1)
    }

    /// The end of the `ahead`-th step from `t` on; infinite where there are fewer.
    pub(crate) fn end_of_step(&self, t: f64, ahead: usize) -> f64 {
        let i = self.find(t);
        self.nodes.get(i + ahead).map_or(f64::INFINITY, |n| n.t)
    }

    /// The last node not after `t`, or the first one.
    fn find(&self, t: f64) -> usize {
        let nodes = &self.nodes;
        let mut i = self.place.get().min(nodes.len() - 1);
        while i > 0 && nodes[i].t > t {
            i -= 1;
        }
        while i + 1 < nodes.len() && nodes[i + 1].t <= t {
            i += 1;
        }
        self.place.set(i);
        i
    }

    /// Forgets what was long before `t`, now and then.
    pub(crate) fn forget_before(&mut self, t: f64) {
        let unused = self.find(t);
        if unused > 1000 && 2 * unused > self.nodes.len() {
            self.nodes.drain(..unused);
            self.place.set(0);
        }
    }
}
