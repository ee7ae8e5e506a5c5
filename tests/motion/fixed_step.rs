//! Another integrator of the same equations: Runge–Kutta's classical method with small steps of one length, delayed
//! elongation by cubic Hermite interpolation between steps, events by bisection of the step that holds one.

use slipmap::slip::motion::{Event, Parameters};

/// Time, elongation, and its rate just after.
type Node = (f64, f64, f64);

struct Run<'a> {
    p: &'a Parameters,
    /// Ends of steps; the rate at the end of one step may differ from that at the start of the next.
    from: Vec<Node>,
    to: Vec<Node>,
    a0: f64,
    t: f64,
    u: f64,
    a: f64,
    /// 0 in stick.
    direction: f64,
}

impl Run<'_> {
    fn delayed(&self, t: f64) -> f64 {
        let t = t - self.p.tau;
        let after = self.from.partition_point(|node| node.0 <= t);
        if after == 0 {
            return self.a0;
        }
        let (p, q) = (self.from[after - 1], self.to[after - 1]);
        let h = q.0 - p.0;
        let x = (t - p.0) / h;
        let y = 1.0 - x;
        p.1 * y * y * (1.0 + 2.0 * x)
            + q.1 * x * x * (1.0 + 2.0 * y)
            + h * x * y * (p.2 * y - q.2 * x)
    }

    fn controls(&self, t: f64, a: f64, on: bool) -> (f64, f64) {
        if !on {
            return (self.p.v0, 1.0);
        }
        let difference = a - self.delayed(t);
        (
            self.p.v0 + self.p.alpha_v * difference,
            1.0 + self.p.alpha_n * difference,
        )
    }

    /// u̇ and ȧ.
    fn rates(&self, t: f64, u: f64, a: f64, on: bool) -> (f64, f64) {
        let (v, n) = self.controls(t, a, on);
        if self.direction == 0.0 {
            return (0.0, v);
        }
        let speed = (self.direction * u * self.p.velocity_unit).max(0.0);
        (a - self.direction * self.p.law.mu_k(speed) * n, v - u)
    }

    fn step(&self, h: f64, on: bool) -> (f64, f64) {
        let (t, u, a) = (self.t, self.u, self.a);
        let k1 = self.rates(t, u, a, on);
        let k2 = self.rates(t + h / 2.0, u + h / 2.0 * k1.0, a + h / 2.0 * k1.1, on);
        let k3 = self.rates(t + h / 2.0, u + h / 2.0 * k2.0, a + h / 2.0 * k2.1, on);
        let k4 = self.rates(t + h, u + h * k3.0, a + h * k3.1, on);
        (
            u + h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0),
            a + h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1),
        )
    }

    /// What the state at the end of a step of length h has run into.
    fn met(&self, h: f64, on: bool) -> Option<Event> {
        let (u, a) = self.step(h, on);
        let n = self.controls(self.t + h, a, on).1;
        if n <= 0.0 {
            Some(Event::LiftOff)
        } else if self.direction == 0.0 {
            (a.abs() >= self.p.law.mu_s() * n).then_some(Event::Release)
        } else {
            (self.direction * u < 0.0).then_some(Event::Stick)
        }
    }

    fn accept(&mut self, h: f64, on: bool) {
        let start = (self.t, self.a, self.rates(self.t, self.u, self.a, on).1);
        (self.u, self.a) = self.step(h, on);
        self.t += h;
        let end = (self.t, self.a, self.rates(self.t, self.u, self.a, on).1);
        if h > 0.0 {
            self.from.push(start);
            self.to.push(end);
        }
    }

    /// Passes `event`, and says what it turned out to be.
    fn pass(&mut self, event: Event, on: bool) -> Event {
        let n = self.controls(self.t, self.a, on).1;
        let holds = self.a.abs() < self.p.law.mu_s() * n;
        if event != Event::LiftOff {
            self.u = 0.0;
        }
        match event {
            Event::Stick if holds => {
                self.direction = 0.0;
                Event::Stick
            }
            Event::Stick => {
                self.direction = self.a.signum();
                Event::Reversal
            }
            Event::Release => {
                self.direction = self.a.signum();
                Event::Release
            }
            other => other,
        }
    }
}

/// Events (but switch-on) until `end` with steps of `h`, from velocity `u` and elongation `a`.
pub fn events(p: &Parameters, u: f64, a: f64, end: f64, h: f64) -> Vec<(Event, f64)> {
    let mut run = Run {
        p,
        from: Vec::new(),
        to: Vec::new(),
        a0: a,
        t: 0.0,
        u,
        a,
        direction: u.signum(),
    };
    let mut events = Vec::new();
    while run.t < end {
        let on = run.t >= p.switch_on - 1e-12;
        let limit = if on { end } else { p.switch_on };
        let h = h.min(limit - run.t);
        let Some(_) = run.met(h, on) else {
            run.accept(h, on);
            continue;
        };
        let (mut before, mut after) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (before + after);
            if run.met(middle, on).is_some() {
                after = middle;
            } else {
                before = middle;
            }
        }
        let event = run.met(after, on).expect("an event");
        run.accept(after, on);
        let event = run.pass(event, on);
        events.push((event, run.t));
        if event == Event::LiftOff {
            break;
        }
    }
    events
}
