//! Stacks and other structures, which should stand.

use super::{Hard, Should};
use crate::error::Result;
use crate::math::Real;
use crate::scenes::stacks::{boxes, bricks, house, pyramid, tower};
use crate::world::World;

/// A structure of boxes of 1 m.
const STANDING: Hard = Hard {
    id: "K1",
    name: "stack of 20",
    about: "boxes of 1 m",
    build: || tower::<20>(false, 0.0),
    should: Should::Stand,
    size: 1.0,
    seconds: 10.0,
    tempo: 1.0,
    varies: false,
};

pub static TWENTY: Hard = STANDING;

pub static HUNDRED: Hard =
    Hard { name: "stack of 100", build: || tower::<100>(false, 0.0), ..STANDING };

pub static PYRAMID: Hard = Hard {
    id: "K9",
    name: "pyramid of 20",
    about: "210 boxes of 1 m, 1 cm apart in their rows",
    build: || pyramid::<20>(false, 0.0),
    ..STANDING
};

pub static TOP_HEAVY: Hard = Hard {
    id: "K2",
    name: "top-heavy stack",
    about: "10 boxes, the top one 100 times as heavy",
    build: || stack(10, |level| if level == 9 { 100.0 } else { 1.0 }),
    ..STANDING
};

pub static DOUBLING: Hard = Hard {
    id: "X1",
    name: "doubling stack",
    about: "10 boxes, each twice as heavy as the one below",
    build: || stack(10, |level| Real::from(1_u32 << level)),
    ..STANDING
};

pub static THOUSAND: Hard = Hard {
    id: "K3",
    name: "1000 on 1",
    about: "a box on one of a thousandth of its mass",
    build: || stack(2, |level| if level == 1 { 1e3 } else { 1.0 }),
    ..STANDING
};

pub static MILLION: Hard = Hard {
    name: "10⁶ on 1",
    about: "a box on one of a millionth of its mass",
    build: || stack(2, |level| if level == 1 { 1e6 } else { 1.0 }),
    ..THOUSAND
};

pub static CARDS: Hard = Hard {
    id: "K5",
    name: "house of cards",
    about: "five storeys of cards of 1 m, 25° from the vertical",
    build: || house(5, 0.6),
    ..STANDING
};

pub static OVERHANG: Hard = Hard {
    id: "K6",
    name: "overhang",
    about: "ten bricks of 1 m that reach 1.435 m beyond the edge, 0.98 of the most",
    build: || bricks(11, 0.98),
    ..STANDING
};

fn stack(levels: u32, density: impl Fn(u32) -> Real) -> Result<World> {
    boxes(levels, density, (false, 0.0))
}
