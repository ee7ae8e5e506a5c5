//! Shares of starts that reach sliding under two methods of control: slipmap's beside those of the
//! referee's own motions, from starts of its own.

use std::sync::Arc;

use slipmap::explore::comparison::{At, Compared, Over, Question, ReachedShare};
use slipmap::model::MapModel;
use slipmap::setting::CaseSpec;
use slipmap::sweep::events::Attended;

use super::asked;
use super::block::{Block, Event, Mode};
use super::random::Chance;
use super::setting::Setting;
use super::steps::Pace;

/// Starts of the referee under the return map, and under delayed feedback, which takes it longer;
/// for how long they are followed.
const STARTS: [u32; 2] = [240, 48];
const HORIZON: f64 = 80.0;

/// The letter's Fig. 3(b) under the return map, or under delayed feedback with limits where `sample_time` is 0.
pub(super) fn under(sample_time: f64, amplitude: f64) -> Setting {
    let delayed = Setting::fig3b();
    match sample_time > 0.0 {
        true => Setting {
            alpha_n: 1.0,
            tau: sample_time,
            sample_time,
            amplitude,
            ..delayed
        },
        false => Setting {
            of_load: [1.0 - amplitude, 1.0 + amplitude],
            ..delayed
        },
    }
}

/// Whether the referee's block reaches sliding.
fn reaches(mut block: Block, until: f64) -> bool {
    let (v0, from) = (block.setting.v0, block.setting.switch_on);
    let late = until - 0.25 * (until - from);
    let mut stopped = false;
    while block.t < until {
        match block.advance(until) {
            Some(Event::Stick | Event::Reversal) => stopped |= block.t >= late,
            Some(Event::LiftOff) => return false,
            _ => {}
        }
    }
    !stopped && block.mode != Mode::Stick && (block.u / v0 - 1.0).abs() < 1e-3
}

/// The referee's share, with its standard error.
fn share(setting: &Setting, stick_slip: bool) -> [f64; 2] {
    let mut chance = Chance::of(0x5a7e, 1);
    let (rest, period) = (0.5 / 1.2, 3.44600138 + 15.85555061);
    let mut reached = 0.0;
    let starts = STARTS[usize::from(setting.amplitude == 0.0)];
    for _ in 0..starts {
        let pace = Pace::of(2.0);
        let block = if stick_slip {
            let switch_on = chance.between(0.0, period);
            let setting = Setting {
                switch_on,
                ..setting.clone()
            };
            Block::at_rest_or_sliding(setting, pace, 0.0, 1.0)
        } else {
            let (u, a) = (chance.between(0.0, 0.2), chance.between(-0.1, 0.1));
            Block::at_rest_or_sliding(setting.clone(), pace, u, rest + a)
        };
        let until = block.setting.switch_on + HORIZON;
        reached += f64::from(u8::from(reaches(block, until)));
    }
    let n = f64::from(starts);
    let share = reached / n;
    [share, (share * (1.0 - share) / n).sqrt()]
}

#[test]
fn shares_are_those_of_the_referee() {
    let text = asked::law_and_parameters(&Setting::fig3b());
    let spec: CaseSpec = text.parse().unwrap();
    for (sample_time, amplitude, stick_slip) in [
        (0.0, 0.1, false),
        (0.0, 0.5, true),
        (0.9, 0.1, false),
        (0.5, 0.5, false),
        (0.9, 0.5, false),
        (1.5, 0.5, false),
        (1.0, 0.5, true),
        (1.5, 0.9, true),
    ] {
        let at = At {
            amplitude,
            slope: 0.0,
            noise: 0.0,
        };
        let question = Question {
            case: spec.case.clone(),
            over: Over::Amplitude,
            at: vec![at],
            sample_times: [sample_time].into_iter().filter(|h| *h > 0.0).collect(),
            model: MapModel::EXACT,
            starts: 1024,
            seed: 0,
            horizon: HORIZON,
        };
        let stop = Arc::default();
        let found = question.answer(2, Attended::silently(&stop)).unwrap();
        let of = |of: &Compared| -> ReachedShare {
            if stick_slip {
                of.stick_slip[0]
            } else {
                of.near[0]
            }
        };
        let found = of(found.methods.last().unwrap());
        let [share, error] = share(&under(sample_time, amplitude), stick_slip);
        let off = (found.share - share).abs();
        let within = 3.5 * (error * error + found.error * found.error).sqrt() + 2.0 / 48.0;
        println!(
            "h = {sample_time}, amplitude {amplitude}, stick-slip {stick_slip}: {} ± {}, \
             {share} ± {error}",
            found.share, found.error
        );
        assert!(off < within, "{found:?} {share} {error}");
    }
}
