//! Joints in the contact step: rows that persist by the midpoint rule, springs, limits and motors in one sparse
//! solve, and gaps closed by positions.
//!
//! A row that holds gets Jv⁺ = −(J − J₀)v⁻, J in the middle of the substep and J₀ at its start: what the curve turned
//! comes back, so that J(v⁻ + v⁺) = 0 and no energy is lost on smooth motion, and what violates the joint does not (a body
//! that was hit, a velocity that was set).

mod active;
mod close;
mod impact;
mod load;
mod motors;
mod prepare;
mod together;

pub use active::{ROUNDS, Row, State, TOGETHER, TURN, solve};
pub use close::close;
pub use load::{take_loads, turning_rate};
pub use prepare::{against, prepare, reach};

use super::Group;
use crate::constraints::joint::{self, Action, Law, Pair, Rates, Rows};
use crate::constraints::{Place, Velocity};
use crate::forces::Ledger;
use crate::joint::ROWS;
use crate::math::{Real, Rot, Twist, Vec2, Wrench, cross, vec2};
use crate::solvers::direct::{self, Link, Triple, on_ground};
use crate::solvers::links::LinkSolver;

/// A joint of a group.
#[derive(Clone, Debug)]
pub struct Tie {
    /// What it does and where it holds.
    pub law: Law,
    /// Slots of its bodies; none: the world.
    pub slots: [Option<u32>; 2],
    /// Where places are counted from (m).
    pub origin: Vec2,
    /// From A's centre of mass to B's at the start of the step (m).
    pub apart: Vec2,
    /// Where the joint is kept.
    pub place: u32,
    /// Impulses of the last substep.
    pub impulses: [Real; ROWS],
    /// What B got in the step so far: impulse (N·s), and its moment about B's anchor (N·m·s).
    pub given: Wrench,
    /// Force that it bore in the last step (N).
    pub load: Vec2,
    /// Its rows in the middle of the substep, and at its end, which is the start of the next.
    middle: Rows,
    end: Rows,
    /// Where its rows begin among those of all ties, and its nodes among those of the factor.
    first_row: usize,
    first_node: usize,
}

impl Tie {
    /// A joint between slots, with what it remembers.
    #[must_use]
    pub fn new(law: Law, slots: [Option<u32>; 2], place: u32, impulses: [Real; ROWS]) -> Self {
        Self {
            law,
            slots,
            origin: vec2(0.0, 0.0),
            apart: vec2(0.0, 0.0),
            place,
            impulses,
            given: Wrench::ZERO,
            load: vec2(0.0, 0.0),
            middle: Rows::NONE,
            end: Rows::NONE,
            first_row: 0,
            first_node: 0,
        }
    }
}

/// The joints of a group, and the columns in which their rows are solved.
#[derive(Clone, Debug, Default)]
pub struct Ties {
    /// The joints.
    pub list: Vec<Tie>,
    /// Solves the rows; kept apart for each group between steps, since the graph rarely changes.
    pub solver: LinkSolver,
    rows: Vec<Row>,
    links: Vec<Link>,
    nodes: Vec<direct::Rows>,
    /// Rows that the solver has; nothing where they are none of the present geometry.
    prepared: Option<Vec<[bool; 3]>>,
    /// Rows whose gaps are closed.
    closing: Vec<[bool; 3]>,
    /// Velocities at the start of the substep.
    before: Vec<Twist>,
    /// Where the bodies are (m).
    positions: Vec<Option<Vec2>>,
    /// Sums over the springs of each slot.
    rates: Vec<Rates>,
    wanted: Vec<Triple>,
    solved: Vec<Triple>,
    change: Vec<Twist>,
    /// What a unit of impulse of each row of a contact gives each slot, with what joints carry along.
    carried: [Vec<Twist>; 3],
}

impl Ties {
    /// Forgets all but the memory.
    pub fn clear(&mut self) {
        self.list.clear();
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

/// Motion and place of a slot; of the world, none.
struct Bodies<'a> {
    velocities: &'a [Velocity],
    places: &'a [Place],
    angles: &'a [Real],
}

impl Bodies<'_> {
    fn twist(&self, slot: Option<u32>) -> Twist {
        slot.map_or(Twist::ZERO, |slot| self.velocities[slot as usize].twist)
    }

    /// The bodies of a joint as they are.
    fn pair(&self, tie: &Tie) -> Pair {
        let way = |slot: Option<u32>| {
            slot.map_or_else(|| vec2(0.0, 0.0), |slot| self.places[slot as usize].way)
        };
        let [a, b] = tie.slots;
        Pair {
            origin: tie.origin,
            centers: [way(a), tie.apart + way(b)],
            rots: tie.slots.map(|slot| slot.map_or(Rot::IDENTITY, |s| self.places[s as usize].rot)),
            angles: tie.slots.map(|slot| {
                slot.map_or(0.0, |s| self.angles[s as usize] + self.places[s as usize].turn)
            }),
            twists: tie.slots.map(|slot| self.twist(slot)),
        }
    }
}

/// Begins a step.
pub fn start(group: &mut Group) {
    let Group { ties, velocities, places, angles, .. } = group;
    let Ties { list, links, solver, rows, .. } = ties;
    if list.is_empty() {
        return;
    }
    let bodies = Bodies { velocities, places, angles };
    links.clear();
    rows.clear();
    for tie in &mut *list {
        tie.law.write_rows(&bodies.pair(tie), &mut tie.end);
        (tie.first_row, tie.first_node) = (rows.len(), links.len());
        rows.resize(tie.first_row + tie.end.count, Row::default());
        let link = on_ground(&tie.slots, velocities);
        links.extend(std::iter::repeat_n(link, tie.end.count.div_ceil(3)));
    }
    solver.analyse(velocities.len(), links);
}

/// Begins a substep.
pub fn remember(group: &mut Group) {
    let Group { ties, velocities, .. } = group;
    ties.before.clear();
    if !ties.list.is_empty() {
        ties.before.extend(velocities.iter().map(|velocity| velocity.twist));
    }
}

/// Geometry of the middle of the substep.
pub fn place(group: &mut Group) {
    let Group { ties, velocities, places, angles, .. } = group;
    let bodies = Bodies { velocities, places, angles };
    for tie in &mut ties.list {
        tie.law.write_rows(&bodies.pair(tie), &mut tie.middle);
    }
    ties.prepared = None;
}

/// Books what joints did in the substep, and returns what they gave the bodies that give way (J). With the velocities at
/// the start of the substep, its kicks and the present ones an impulse p does the work p·½J(v⁻ + v⁺), as
/// with contacts. What motors and bodies with given motion do is work.
pub fn book(group: &mut Group, h: Real, ledger: &mut Ledger) -> Real {
    let Group { ties, velocities, places, free, .. } = group;
    let mean = |slot: u32| {
        let (now, free) = (&velocities[slot as usize].twist, &free[slot as usize]);
        let kick = places[slot as usize].kick(h);
        Twist::new(
            (now.linear + free.linear - kick.linear) * 0.5,
            (now.angular + free.angular - kick.angular) * 0.5,
        )
    };
    let Ties { list, rows, .. } = ties;
    let mut gained = 0.0;
    for tie in list {
        let twists = tie.slots.map(|slot| slot.map_or(Twist::ZERO, mean));
        let driver = [0, 1].map(|side| match tie.slots[side] {
            Some(slot) if velocities[slot as usize].is_fixed() => twists[side],
            _ => Twist::ZERO,
        });
        for k in 0..tie.middle.count {
            let (now, row) = (&tie.middle.rows[k], &mut rows[tie.first_row + k]);
            tie.impulses[k] = row.impulse;
            row.work = row.impulse * now.velocity([&twists[0], &twists[1]]);
            let given = -row.impulse * now.velocity([&driver[0], &driver[1]]);
            gained += row.work + given;
            ledger.work += given;
            book_row(now, row, ledger);
            tie.given += on_b(tie, now, row.impulse, places);
        }
    }
    gained
}

/// Books the work of a row by what it is.
pub fn book_row(now: &joint::Row, row: &Row, ledger: &mut Ledger) {
    match now.action {
        Action::Drive(speed) if speed != 0.0 => ledger.work += row.work,
        // What draws with a bounded force is driven by whoever moves it.
        Action::Hold if now.bound < Real::INFINITY => ledger.work += row.work,
        Action::Hold | Action::Limit | Action::Drive(_) => ledger.dissipated -= row.work,
        Action::Spring(_) | Action::Off => {}
    }
}

/// What an impulse of a row gives B, about its anchor.
fn on_b(tie: &Tie, row: &joint::Row, impulse: Real, places: &[Place]) -> Wrench {
    let [x, y, turn] = row.jacobian[1];
    let push = vec2(x, y) * impulse;
    let arm = tie.slots[1]
        .map_or_else(Vec2::zeros, |slot| places[slot as usize].rot.apply(tie.law.arms[1]));
    Wrench::new(push, turn * impulse - cross(arm, push))
}

/// Books what dampers took at the end of a substep: what their springs' rows did, less what the springs now hold. Springs
/// without a damper take nothing, so that what the step gets wrong shows.
pub fn book_dampers(group: &Group, ledger: &mut Ledger) {
    let ties = &group.ties;
    for tie in &ties.list {
        for (k, now) in tie.end.as_slice().iter().enumerate() {
            book_damper(now, &ties.rows[tie.first_row + k], ledger);
        }
    }
}

/// The same of one row, which ends at `now`.
pub fn book_damper(now: &joint::Row, row: &Row, ledger: &mut Ledger) {
    if let Action::Spring(spring) = now.action
        && spring.damping > 0.0
    {
        let (from, to) = (row.from, now.position);
        let kept = 0.5 * spring.stiffness * (to - from) * (to + from);
        ledger.dissipated -= row.work + kept;
    }
}

/// Rows of joints between rigid bodies, for a solve of all rows of a group with matter.
impl Ties {
    /// Those that are solved, not at a bound: by joint and row.
    pub fn solved(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all =
            self.list.iter().enumerate().flat_map(|(t, tie)| {
                (0..tie.middle.count).map(move |k| ((t, k), tie.first_row + k))
            });
        all.filter(|(_, row)| self.rows[*row].state == State::Solved).map(|(at, _)| at)
    }

    /// A row, and what it asks for.
    #[must_use]
    pub fn row(&self, (t, k): (usize, usize)) -> (&Tie, &joint::Row, &Row) {
        let tie = &self.list[t];
        (tie, &tie.middle.rows[k], &self.rows[tie.first_row + k])
    }

    /// Adds to the impulse of a row.
    pub fn add_to(&mut self, (t, k): (usize, usize), impulse: Real) {
        let first = self.list[t].first_row;
        self.rows[first + k].impulse += impulse;
    }

    /// Impulses of all rows, to go back to.
    pub fn impulses(&self) -> impl Iterator<Item = Real> + '_ {
        self.rows.iter().map(|row| row.impulse)
    }

    /// Goes back to them.
    pub fn set_impulses(&mut self, impulses: &[Real]) {
        self.rows.iter_mut().zip(impulses).for_each(|(row, impulse)| row.impulse = *impulse);
    }
}
