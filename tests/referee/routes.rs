//! How low v0 may fall before sliding is lost: slipmap's routes beside the referee's own motions.

use slipmap::explore::comparison::{At, Over, Question};
use slipmap::explore::route::Route;
use slipmap::model::stop::Stop;
use slipmap::model::{MapModel, Record};
use slipmap::setting::CaseSpec;

use super::block::{Block, Event};
use super::setting::{Corner, Setting};
use super::shares::under;
use super::steps::Pace;

const ROUTE: &str = include_str!("../../sweeps/return_map_route.toml");
const AMPLITUDES: [f64; 2] = [0.1, 0.5];
/// When v0 is at its end.
const UNTIL: f64 = 3000.0;

/// The v0 at which the referee's block first stops; none where it slides to the end.
fn lost(setting: Setting, map_made_once: bool) -> Option<f64> {
    let setting = Setting {
        damping: 0.2,
        v0: 0.7,
        programme: vec![Corner {
            at: UNTIL,
            v0: 0.01,
            ramp: true,
        }],
        ..setting
    };
    let (v0, rest) = (setting.v0, 0.5 / (1.0 + 2.0 * setting.v0));
    let mut block = Block::at_rest_or_sliding(setting, Pace::of(1.0), 1.01 * v0, rest);
    block.map_of = map_made_once.then_some(v0);
    while block.t < UNTIL {
        let event = block.advance(UNTIL);
        if let Some(Event::Stick | Event::Reversal | Event::LiftOff) = event {
            return Some(block.unperturbed(block.t).0);
        }
    }
    None
}

/// slipmap's routes with a model of the return map.
fn route(model: MapModel, seed: u32) -> Route {
    let spec: CaseSpec = ROUTE.parse().unwrap();
    let at = AMPLITUDES.map(|amplitude| At {
        amplitude,
        slope: 0.0,
        noise: 0.0,
    });
    let question = Question {
        case: spec.case,
        over: Over::Amplitude,
        at: at.to_vec(),
        sample_times: vec![0.5, 0.9],
        model,
        starts: 64,
        seed,
        horizon: 200.0,
    };
    question.route(&Stop::default()).unwrap().unwrap()
}

#[test]
fn sliding_is_lost_where_the_referee_loses_it() {
    for held in route(MapModel::EXACT, 0).methods {
        let setting = match (held.amplitude, held.sample_time) {
            (None, _) => Setting {
                switch_on: f64::INFINITY,
                ..under(0.0, 0.5)
            },
            (Some(amplitude), sample_time) => under(sample_time.unwrap_or(0.0), amplitude),
        };
        let referee = lost(setting, false);
        println!("{held:?}: {referee:?}");
        assert_eq!(held.held, Some(referee.is_none()), "{held:?} {referee:?}");
        let off = held.lost_at.unwrap_or(0.0) - referee.unwrap_or(0.0);
        assert!(off.abs() < 1e-7, "{held:?} {referee:?}");
    }
}

/// A map that is reconstructed from a record is that of the first v0, but for the size of the
/// pulses, which shows the more the lower v0 falls: it loses sliding where the referee's map of the
/// first v0 does.
#[test]
fn maps_made_once_lose_sliding_where_the_referees_does() {
    const SEEDS: u32 = 8;
    let mut means = [0.0; 2];
    for seed in 0..SEEDS {
        let model = MapModel::Reconstructed(Record {
            readings: Record::READINGS,
            pulse: Record::PULSE,
        });
        let found = route(model, seed);
        let methods = found
            .methods
            .iter()
            .filter(|held| held.sample_time == Some(0.9));
        for (mean, held) in means.iter_mut().zip(methods) {
            *mean += held.lost_at.unwrap() / f64::from(SEEDS);
        }
    }
    for ((mean, amplitude), within) in means.into_iter().zip(AMPLITUDES).zip([0.005, 0.05]) {
        let referee = lost(under(0.9, amplitude), true).unwrap();
        println!("amplitude {amplitude}: {mean}, {referee}");
        assert!((mean / referee - 1.0).abs() < within, "{mean} {referee}");
    }
}
