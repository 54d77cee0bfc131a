//! The rows of contacts solved all at once, on the set of them that sweeps find: which points bear, which surfaces stick and
//! which way others slide.
//!
//! In two dimensions Coulomb's law is one of three linear ones: u_t = 0, or λ_t = ±μ(λ_0 + λ_1). What slides pushes along
//! n ± μt, so that its rows are unsymmetric; the same holds for what rolls against all the resistance that it has.

use super::direct::{Block as Square, BodyFactor, Link, Rows, Triple, on_ground};
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::Real;

/// How contacts are taken to stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guess {
    /// As sweeps left them.
    Swept,
    /// The same, and what has no impulse bears where it approaches faster than its target or parts no faster than this beyond it (m/s).
    Cold(Real),
    /// By velocities alone: what is within this (m/s) of its target bears or sticks.
    Touching(Real),
}

/// How a contact stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mode {
    /// Points that bear.
    bears: [bool; 2],
    /// Whether it sticks.
    sticks: bool,
    /// λ_t/(λ_0 + λ_1) of one that slides.
    slides: Real,
    /// Whether it does not roll.
    holds: bool,
    /// λ_r/(λ_0 + λ_1) (m) of one that rolls.
    rolls: Real,
}

impl Mode {
    fn of(block: &Block, closed: [bool; 2]) -> Self {
        let bears = [0, 1].map(|k| block.on[k] && block.impulse[k] > 0.0);
        if bears == [false, false] {
            return Self { bears: closed, ..Self::default() };
        }
        let sticks = !block.sliding && block.response[5] > 0.0;
        let slides = if block.sliding && block.impulse[2] != 0.0 {
            block.friction.sliding * block.impulse[2].signum()
        } else {
            0.0
        };
        let bound = block.rolling_resistance * (block.impulse[0] + block.impulse[1]);
        let holds = block.rolling.abs() < bound;
        let rolls = if holds || block.rolling == 0.0 {
            0.0
        } else {
            block.rolling_resistance * block.rolling.signum()
        };
        Self { bears, sticks, slides, holds, rolls }
    }

    /// By the velocities along its rows.
    fn touching(block: &Block, along: &[Real; 3], slow: Real) -> Self {
        let near = |k: usize| (along[k] - block.target[k]).abs() <= slow;
        let bears = [0, 1].map(|k| block.on[k] && near(k));
        let sticks = near(2) && block.response[5] > 0.0 && bears != [false; 2];
        let slides = if sticks { 0.0 } else { Self::of(block, [false; 2]).slides };
        Self { bears, sticks, slides, ..Self::of(block, bears) }
    }

    fn pushes(&self) -> bool {
        self.slides != 0.0 || self.rolls != 0.0
    }
}

/// The contacts of an island and the factors of their rows, with those of others that are solved along.
#[derive(Clone, Debug, Default)]
pub struct Newton {
    factor: BodyFactor,
    links: Vec<Link>,
    /// Rows of the links: those of contacts, one against rolling for each that has one, then those of others.
    pub rows: Vec<Rows>,
    pushes: Vec<[Square; 2]>,
    modes: Vec<Mode>,
    /// What each row lacks.
    pub wanted: Vec<Triple>,
    /// What was found.
    pub solved: Vec<Triple>,
    /// Contacts, and links of contacts.
    blocks: usize,
    contacts: usize,
    /// The bodies of each contact, in order.
    pairs: Vec<(Option<u32>, Option<u32>)>,
    factored: Option<Real>,
}

/// Work of a step around the factors, for each link.
const AROUND: Real = 8.0;

const OFF: Rows = Rows { jacobian: [[[0.0; 3]; 3]; 2], compliance: [0.0; 3], on: [false; 3] };

impl Newton {
    /// Takes the graph: contacts, and links of others.
    pub fn analyse(&mut self, bodies: &[Velocity], blocks: &[Block], others: &[Link]) {
        let ends = |block: &Block| on_ground(&block.bodies.map(Some), bodies);
        self.links.clear();
        self.links.extend(blocks.iter().map(ends));
        self.links.extend(blocks.iter().filter(|block| block.rolling_resistance > 0.0).map(ends));
        (self.blocks, self.contacts) = (blocks.len(), self.links.len());
        self.links.extend_from_slice(others);
        self.modes.clear();
        self.factored = None;
        let loaded = |k: usize| blocks.get(k).is_none_or(|block| block.impulse != [0.0; 3]);
        let bearing = self.links.iter().enumerate().filter_map(|(k, link)| match link {
            [Some(a), Some(b)] if a != b && loaded(k) => Some([*a, *b]),
            _ => None,
        });
        self.factor.expect(bodies.len(), bearing);
    }

    /// Number of links of contacts: those of others follow.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.contacts
    }

    /// Work of a step, with factors that were made for it or not, in products of blocks.
    pub fn cost(&mut self, made: bool) -> Real {
        let own = AROUND * self.links.len() as Real;
        if made { own + self.factor.work() } else { own }
    }

    /// Takes how the contacts stand; whether that is as it was when the rows were factored last.
    fn take_modes(
        &mut self,
        bodies: &[Velocity],
        blocks: &[Block],
        (epsilon, guess): (Real, Guess),
    ) -> bool {
        let mut same = self.factored == Some(epsilon);
        self.modes.resize(blocks.len(), Mode::default());
        for (mode, block) in self.modes.iter_mut().zip(blocks) {
            let along = || block.velocity(block.bodies.map(|slot| &bodies[slot as usize]));
            let now = match guess {
                Guess::Cold(slow) if block.impulse == [0.0; 3] => {
                    let along = along();
                    let closed = |k: usize| block.on[k] && along[k] <= block.target[k] + slow;
                    Mode::of(block, [0, 1].map(closed))
                }
                Guess::Touching(slow) => Mode::touching(block, &along(), slow),
                _ => Mode::of(block, [false; 2]),
            };
            same &= *mode == now;
            *mode = now;
        }
        same
    }

    /// Whether two bodies, or one and the ground, meet in more contacts than one.
    #[must_use]
    pub fn meets_twice(&mut self) -> bool {
        let pairs = &mut self.pairs;
        pairs.clear();
        pairs.extend(self.links[..self.blocks].iter().map(|[a, b]| (*a.min(b), *a.max(b))));
        pairs.sort_unstable();
        pairs.windows(2).any(|pair| pair[0] == pair[1])
    }

    /// Factors of the rows as the contacts stand, and of `others`, unless they are those that it has. Whether they had to be
    /// made.
    pub fn factor(
        &mut self,
        (bodies, blocks): (&[Velocity], &[Block]),
        others: Option<&[Rows]>,
        (epsilon, guess): (Real, Guess),
    ) -> bool {
        let same = self.take_modes(bodies, blocks, (epsilon, guess));
        if same && others.is_none() {
            return false;
        }
        self.factored = Some(epsilon);
        if let Some(others) = others {
            self.rows.resize(self.contacts, OFF);
            self.rows.extend_from_slice(others);
        } else {
            self.rows.resize(self.links.len(), OFF);
        }
        let pushing = self.modes.iter().any(Mode::pushes);
        if pushing {
            self.pushes.clear();
            self.pushes.extend(self.rows.iter().map(|rows| rows.jacobian));
            self.pushes.resize(self.links.len(), [[[0.0; 3]; 3]; 2]);
        }
        let mut rolling = blocks.len();
        for (k, (block, mode)) in blocks.iter().zip(&self.modes).enumerate() {
            self.rows[k] = rows_of(block, mode);
            if pushing {
                self.pushes[k] = pushes_of(&self.rows[k], mode);
            }
            if block.rolling_resistance > 0.0 {
                let turns = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
                let jacobian = turns.map(|row| [row, [0.0; 3], [0.0; 3]]);
                self.rows[rolling] = Rows { jacobian, on: [mode.holds, false, false], ..OFF };
                if pushing {
                    self.pushes[rolling] = jacobian;
                }
                rolling += 1;
            }
        }
        let pushes = pushing.then_some(&self.pushes[..]);
        self.factor.factor(bodies, &self.links, (&self.rows, pushes), epsilon);
        true
    }

    /// Writes what the contacts' rows lack; what others lack is theirs to write.
    pub fn lack(&mut self, bodies: &[Velocity], blocks: &[Block]) {
        self.wanted.clear();
        self.wanted.resize(self.links.len(), [0.0; 3]);
        self.solved.resize(self.links.len(), [0.0; 3]);
        let mut rolling = blocks.len();
        for (k, block) in blocks.iter().enumerate() {
            let pair = block.bodies.map(|slot| &bodies[slot as usize]);
            let along = block.velocity(pair);
            self.wanted[k] = [0, 1, 2].map(|r| block.target[r] - along[r]);
            if block.rolling_resistance > 0.0 {
                self.wanted[rolling][0] = pair[0].twist.angular - pair[1].twist.angular;
                rolling += 1;
            }
        }
    }

    /// Solves the rows for what they lack, and gives the bodies of the contacts the impulses. What others get is left in
    /// [`Newton::solved`]. Returns the largest change of velocity (m/s) that a contact's impulses make along its own rows; none where the
    /// solution is not made of numbers, and nothing is given.
    pub fn solve(&mut self, bodies: &mut [Velocity], blocks: &mut [Block]) -> Option<Real> {
        self.factor.solve(&self.wanted, &mut self.solved);
        if !self.solved.iter().flatten().all(|x| x.is_finite()) {
            return None;
        }
        let mut largest: Real = 0.0;
        let mut rolling = blocks.len();
        for ((block, mode), solved) in blocks.iter_mut().zip(&self.modes).zip(&self.solved) {
            let [p, q, mut t] = *solved;
            t += mode.slides * (p + q);
            let pair = super::sweep::pair(bodies, block.bodies);
            block.push(pair, [p, q, t]);
            largest = largest.max(super::sweep::along(block, &[p, q, t]));
            for (sum, change) in block.impulse.iter_mut().zip([p, q, t]) {
                *sum += change;
            }
            if block.rolling_resistance > 0.0 {
                let turn = self.solved[rolling][0] + mode.rolls * (p + q);
                super::sweep::turn(super::sweep::pair(bodies, block.bodies), turn);
                block.rolling += turn;
                rolling += 1;
            }
        }
        Some(largest)
    }
}

/// The rows of a contact as it stands.
fn rows_of(block: &Block, mode: &Mode) -> Rows {
    let (n, t) = (block.normal, block.tangent());
    let row = |k: usize, side: usize| {
        let d = if k < 2 { n } else { t };
        let sign = if side == 0 { -1.0 } else { 1.0 };
        [sign * d.x, sign * d.y, sign * block.arms[k][side]]
    };
    let [p, q] = mode.bears;
    Rows {
        jacobian: [0, 1].map(|side| [0, 1, 2].map(|k| row(k, side))),
        compliance: [0.0; 3],
        on: [p, q, mode.sticks],
    }
}

/// What slides and rolls pushes along n ± μt, and turns.
fn pushes_of(rows: &Rows, mode: &Mode) -> [Square; 2] {
    let mut pushes = rows.jacobian;
    for (side, sign) in pushes.iter_mut().zip([-1.0, 1.0]) {
        let tangent = side[2];
        for row in side.iter_mut().take(2) {
            for (to, t) in row.iter_mut().zip(tangent) {
                *to += mode.slides * t;
            }
            row[2] += sign * mode.rolls;
        }
    }
    pushes
}
