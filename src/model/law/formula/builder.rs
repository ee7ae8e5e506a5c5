//! Makes a formula node by node. What does not depend on the speed is worked out at once.

use super::{Formula, MOST_NODES, Node, Number};

/// The largest whole exponent of a power by products, which has up to 31 of them.
const MOST_WHOLE: f64 = 65536.0;

/// A part of a formula: a number, or a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operand {
    Number(f64),
    Node(u8),
}

/// The nodes so far.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    nodes: Vec<Node>,
    is_full: bool,
}

impl Builder {
    /// Adds a node, or finds it among those that are there.
    fn add(&mut self, node: Node) -> Operand {
        if let Some(place) = self.nodes.iter().position(|known| *known == node) {
            return Operand::Node(place as u8);
        }
        self.is_full |= self.nodes.len() == MOST_NODES;
        if !self.is_full {
            self.nodes.push(node);
        }
        Operand::Node((self.nodes.len() - 1) as u8)
    }

    /// v.
    pub(crate) fn speed(&mut self) -> Operand {
        self.add(Node::Linear(1.0, 0.0))
    }

    /// `a` times a number, plus another one.
    fn affine(&mut self, a: u8, by: f64, plus: f64) -> Operand {
        match self.nodes[usize::from(a)] {
            _ if by == 1.0 && plus == 0.0 => Operand::Node(a),
            Node::Linear(first, second) => self.add(Node::Linear(by * first, by * second + plus)),
            Node::Affine(b, first, second) => {
                self.add(Node::Affine(b, by * first, by * second + plus))
            }
            Node::Over(number, b) if plus == 0.0 => self.add(Node::Over(by * number, b)),
            _ => self.add(Node::Affine(a, by, plus)),
        }
    }

    pub(crate) fn sum(&mut self, a: Operand, b: Operand) -> Operand {
        match (a, b) {
            (Operand::Number(a), Operand::Number(b)) => Operand::Number(a + b),
            (Operand::Number(plus), Operand::Node(a))
            | (Operand::Node(a), Operand::Number(plus)) => self.affine(a, 1.0, plus),
            (Operand::Node(a), Operand::Node(b)) => self.add(Node::Sum(a, b)),
        }
    }

    pub(crate) fn difference(&mut self, a: Operand, b: Operand) -> Operand {
        match (a, b) {
            (Operand::Node(a), Operand::Node(b)) => self.add(Node::Difference(a, b)),
            (Operand::Number(plus), Operand::Node(b)) => self.affine(b, -1.0, plus),
            (a, Operand::Number(b)) => self.sum(a, Operand::Number(-b)),
        }
    }

    pub(crate) fn negative(&mut self, a: Operand) -> Operand {
        self.product(Operand::Number(-1.0), a)
    }

    pub(crate) fn product(&mut self, a: Operand, b: Operand) -> Operand {
        match (a, b) {
            (Operand::Number(a), Operand::Number(b)) => Operand::Number(a * b),
            (Operand::Number(by), Operand::Node(a)) | (Operand::Node(a), Operand::Number(by)) => {
                self.affine(a, by, 0.0)
            }
            (Operand::Node(a), Operand::Node(b)) => self.add(Node::Product(a, b)),
        }
    }

    /// A quotient. Powers of cosh and 1 + exp, which grow beyond all numbers, are not divided by:
    /// 1/cosh and tanh stand in their place.
    pub(crate) fn quotient(&mut self, a: Operand, b: Operand) -> Operand {
        if let Operand::Node(of) = b
            && let Some(inverse) = self.inverse_of_growth(of)
        {
            return self.product(a, inverse);
        }
        match (a, b) {
            (Operand::Number(a), Operand::Number(b)) => Operand::Number(a / b),
            (Operand::Node(a), Operand::Number(b)) => self.affine(a, 1.0 / b, 0.0),
            (Operand::Number(a), Operand::Node(b)) => self.add(Node::Over(a, b)),
            (Operand::Node(a), Operand::Node(b)) => self.add(Node::Quotient(a, b)),
        }
    }

    /// 1 over a node that grows as an exponential; none of other nodes.
    fn inverse_of_growth(&mut self, of: u8) -> Option<Operand> {
        let node = |place: u8| self.nodes[usize::from(place)];
        match node(of) {
            Node::Cosh(a) => {
                let Operand::Node(tanh) = self.add(Node::Tanh(a)) else {
                    return None;
                };
                Some(self.add(Node::Sech(a, tanh)))
            }
            Node::Product(a, b) => {
                let (one, other) = (self.inverse_of_growth(a)?, self.inverse_of_growth(b)?);
                Some(self.product(one, other))
            }
            Node::Affine(exp, by, plus) if by * plus > 0.0 => {
                let Node::Exp(a, rate) = node(exp) else {
                    return None;
                };
                // 1/(q + p e^y) = (1 − tanh((y + ln(p/q))/2))/(2q).
                let half = self.affine(a, 0.5 * rate, 0.5 * Number::ln(by / plus));
                let tanh = self.function(half, Number::tanh, Node::Tanh);
                let fall = self.difference(Operand::Number(1.0), tanh);
                Some(self.product(fall, Operand::Number(0.5 / plus)))
            }
            _ => None,
        }
    }

    /// A function of a number, or of a node.
    pub(crate) fn function(
        &mut self,
        a: Operand,
        of_number: fn(f64) -> f64,
        of_node: fn(u8) -> Node,
    ) -> Operand {
        match a {
            Operand::Number(a) => Operand::Number(of_number(a)),
            Operand::Node(a) => self.add(of_node(a)),
        }
    }

    pub(crate) fn exp(&mut self, a: Operand) -> Operand {
        match a {
            Operand::Number(a) => Operand::Number(Number::exp(a)),
            Operand::Node(a) => match self.nodes[usize::from(a)] {
                Node::Affine(b, by, 0.0) => self.add(Node::Exp(b, by)),
                _ => self.add(Node::Exp(a, 1.0)),
            },
        }
    }

    /// A power; with an exponent that depends on the speed, e to the exponent times the logarithm.
    pub(crate) fn power(&mut self, a: Operand, exponent: Operand) -> Operand {
        match (a, exponent) {
            (Operand::Number(a), Operand::Number(n)) => Operand::Number(Number::power(a, n)),
            (Operand::Node(a), Operand::Number(n)) => self.known_power(a, n),
            _ => {
                let logarithm = self.function(a, Number::ln, Node::Ln);
                let product = self.product(exponent, logarithm);
                self.exp(product)
            }
        }
    }

    /// A power with a known exponent. Whole ones are products, which are analytic also where the
    /// node is 0 or less; above [`MOST_WHOLE`] they would need too many nodes.
    fn known_power(&mut self, a: u8, exponent: f64) -> Operand {
        if exponent.trunc() != exponent || exponent.abs() > MOST_WHOLE {
            return self.add(Node::Power(a, exponent));
        }
        let (mut square, mut left) = (Operand::Node(a), exponent.abs() as u32);
        let mut product = Operand::Number(1.0);
        while left > 0 {
            if left % 2 == 1 {
                product = self.product(product, square);
            }
            left /= 2;
            if left > 0 {
                square = self.product(square, square);
            }
        }
        match exponent < 0.0 {
            true => self.quotient(Operand::Number(1.0), product),
            false => product,
        }
    }

    /// The formula whose value is `last`; none of more than [`MOST_NODES`] nodes.
    pub(crate) fn finish(mut self, last: Operand) -> Option<Formula> {
        let last = match last {
            Operand::Number(value) => self.add(Node::Linear(0.0, value)),
            node @ Operand::Node(_) => node,
        };
        let Operand::Node(last) = last else {
            return None;
        };
        let nodes = used(&self.nodes[..=usize::from(last)]);
        (!self.is_full).then(|| Formula {
            nodes: nodes.into(),
        })
    }
}

/// The nodes without those on which the last one does not depend.
fn used(nodes: &[Node]) -> Vec<Node> {
    let mut needed = vec![false; nodes.len()];
    for (i, node) in nodes.iter().enumerate().rev() {
        needed[i] |= i + 1 == nodes.len();
        let is_needed = needed[i];
        for operand in node.operands().into_iter().flatten() {
            needed[usize::from(operand)] |= is_needed;
        }
    }
    let before = |place: u8| needed[..usize::from(place)].iter().filter(|n| **n).count() as u8;
    let kept = nodes.iter().zip(&needed).filter(|(_, needed)| **needed);
    kept.map(|(node, _)| node.moved(before)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::FrictionLaw;

    /// 2 + (v − 1)^n.
    fn law(n: f64) -> FrictionLaw {
        let mut builder = Builder::default();
        let speed = builder.speed();
        let base = builder.difference(speed, Operand::Number(1.0));
        let power = builder.power(base, Operand::Number(n));
        let sum = builder.sum(power, Operand::Number(2.0));
        FrictionLaw::formula(builder.finish(sum).unwrap(), 4.0).unwrap()
    }

    #[test]
    fn whole_powers_of_negative_numbers_are_known() {
        for n in [2, 63, 64, 65, 66, 100, 1023, 1024, 65535, 65536, -2, -67] {
            let law = law(n.into());
            let off = if n < 0 { 0.8 } else { 1.5 / f64::from(n) };
            for v in [1.0 - off, 1.0 - 0.9 * off, 1.0 + off] {
                let near = |found: f64, expected: f64| {
                    let allowed = 1e-9 * (1.0 + expected.abs());
                    assert!(
                        (found - expected).abs() < allowed,
                        "{n} {v}: {found} {expected}"
                    );
                };
                let slope = |v: f64| f64::from(n) * (v - 1.0).powi(n - 1);
                near(law.mu_k(v), 2.0 + (v - 1.0).powi(n));
                near(law.mu_prime(v), slope(v));
                let to = v + 0.5 * off.min(0.1);
                let (low, high) = law.slopes_between(v, to);
                for v in [v, to] {
                    let (slope, rounding) = (slope(v), 1e-9 * slope(v).abs());
                    assert!(
                        low <= slope + rounding && slope <= high + rounding,
                        "{n} {v}"
                    );
                }
                assert!((high - low).is_finite(), "{n} {v}");
            }
        }
    }
}
